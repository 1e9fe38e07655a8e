/* All of one render; private to setup.c, tiles.c, render.c, live.c and variants.c. */
#ifndef RENDERER_RENDER_INTERNAL_H
#define RENDERER_RENDER_INTERNAL_H

#include <stdatomic.h>
#include "film/bands.h"
#include "film/layout.h"
#include "render/adaptive.h"
#include "render/denoise_guides.h"
#include "render/first_hit.h"
#include "render/params.h"
#include "path/path.h"

#define TILE_WIDTH 32
#define TILE_HEIGHT BAND_LINES

typedef struct Render {
    const Scene *scene;
    RenderParams params;
    int width, height; /* of the whole picture */
    int x0, y0, w, h;  /* the part that is rendered */
    int tiles_x, tiles_y;
    Accel *accel;
    Lights *lights;
    struct Caustics *caustics; /* or NULL */
    RetexBandStore *store; /* for the film, which then owns it; or NULL */
    Film *film;
    FilmPixel **pixels;            /* by thread */
    ControlFilm *control;          /* of several variants, or NULL */
    ControlPixel **controls;       /* by thread */
    const RenderVariant *variants; /* or NULL: the original */
    const RetexImage *constants;   /* or NULL: by target, of the last variant */
    DenoiseGuides guides;
    int quick_guides; /* 1: from fewer sample points */
    PixelGuides **pixel_guides; /* by thread, of the pixels that it traces side by side; or NULL: no guides */
    char *resumed;              /* by band: finished by another render */
    int wanted;                 /* tiles, of all that are to be rendered */
    PathContext context;
    PathWorker *workers; /* by thread */
    Adaptive **pilots;   /* by thread, or NULL: all tiles get as many samples */
    atomic_int done;
    atomic_long paths;
} Render;

/* Is asked again and again by all threads. */
typedef struct StopAsked {
    int (*is_asked)(void *context);
    void *context;
} StopAsked;

typedef struct HalfSamples {
    int samples[2];
} HalfSamples;

/* ---- setup.c: what a render needs ---- */

/* The window, the ray structure and the lights. Close it even where this fails. */
int render_open(Render *render, const Scene *scene, const RenderParams *params, RetexError *err);
void render_close(Render *render);
/* What depends on the scene's camera and on the size of the picture: after either has changed. */
int render_look(Render *render, RetexError *err);
void render_close_films(Render *render);
/* For whatever traces paths: a guide to caustics where there may be some, the same for any part of the picture. */
int render_open_guide(Render *render, RetexError *err);
/* The film, and what each thread has. control: also a control film of all variants, with moments of 0 to 2 halves. */
int render_open_film(Render *render, int control, int halves, RetexError *err);
void render_drop_files(RenderParams *params); /* of a render beside the one that files are for */
void render_choose_matte(Render *render); /* after the guide is open: whether packets sample matte surfaces together */
FirstHitWindow render_window(const Render *render);
/* Another pass over the same picture, without files and progress: with the ray structure and the lights of `render`,
 * which it does not own: close no more than its films. */
Render render_pass(const Render *render);
const FilmLayout *render_layout(const RenderParams *params);
int render_is_stopped(const Render *render);
/* Whether a band is to be rendered: it was not done by another render. */
int render_is_wanted(const Render *render, int band);

/* ---- tiles.c: paths over pixels ---- */

/* Trace all, and count; started: by the clock. Fails where the render is stopped and tiles are missing. */
int render_paths(Render *render, RenderStats *stats, double started, RetexError *err);
void render_sample(Render *render, int x, int y, int sample); /* a single path, for --trace-pixel */
/* What the camera rays of these samples of a pixel of the whole picture meet, each in turn. */
typedef void RenderHitVisitor(void *context, const Ray *ray, const Hit *hit);
void render_camera_hits(const Render *render, int x, int y, int count, RenderHitVisitor *visit, void *context);
HalfSamples render_half_samples(const Render *render);        /* samples of each half */
int render_tile_pixels(const Render *render, int tile, int *x0, int *y0, int *across); /* how many */
/* Add the light of the samples from `from` to `to` - 1 of a tile's pixels to sums, row by row. Of renders of the light
 * alone. 0: it was told to stop. */
int render_tile_light(const Render *render, PathWorker *worker, int tile, int from, int to, double (*sums)[3],
                      const StopAsked *stop);
/* Give the film of a pass with spp 2 a tile's pixels: as samples the means of two halves of their light; and guides. */
void render_tile_halves(Render *pass, int thread, int tile, double (*const halves[2])[3], const StopAsked *stop);

/* ---- render.c ---- */

/* A set with a beauty, and what is known of it as a whole. */
int render_start_set(RetexSet **set, const Render *render, RetexError *err);

#endif
