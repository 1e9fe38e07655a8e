/* The camera and its surroundings: cameras, the sky and the background, global_settings. */
#ifndef RENDERER_SDL_CAMERA_CAMERA_H
#define RENDERER_SDL_CAMERA_CAMERA_H

#include "sdl/texture/texture.h"

typedef struct ParsedSky {
    Rgb emission;
    Transform transform;
    int npigments;
    const ParsedPigment *pigments[16];
} ParsedSky;

typedef struct ParsedCamera {
    Camera camera; /* without aperture and bokeh */
    Vec3 look_at;
    double aperture;
    int blur;                   /* blur_samples is given: the aperture counts */
    const ParsedPigment *bokeh; /* or NULL */
    const char *name;           /* in the builder's list of cameras that are #declared: */
    const struct ParsedCamera *next;
} ParsedCamera;

typedef struct CameraState {
    ParsedCamera camera;
    const ParsedCamera *cameras; /* that are #declared, the last one first */
    const ParsedSky *sky;
    const ParsedPigment *bokeh; /* of the camera in use, or NULL */
} CameraState;

void camera_begin(Sdl *sdl);

static inline CameraState *cameras_of(Sdl *sdl)
{
    return builder_of(sdl)->camera;
}

/* camera.c, global.c */
const ParsedCamera *parse_camera(Sdl *sdl);
void camera_use(Sdl *sdl, const ParsedCamera *camera);
void camera_choose(Sdl *sdl); /* at the end of the scene: the one that is asked for */
void camera_finish(Sdl *sdl); /* what of it waits for the end of the scene */
void parse_global_settings(Sdl *sdl);
void parse_background(Sdl *sdl);
const ParsedSky *parse_sky_sphere(Sdl *sdl);

#endif
