/* Rays through the picture. A kind of camera is a row of operations; what it shows where is POV-Ray's. */
#ifndef RENDERER_CAMERA_CAMERA_H
#define RENDERER_CAMERA_CAMERA_H

#include "base/arena.h"
#include "camera/cameras.h"
#include "shape/surface.h"

/* A point of a width by height picture. */
typedef struct CameraPoint {
    int width, height;
    double x, y;         /* in pixels: 0, 0 is the top left corner, pixel centres lie at + 0.5 */
    double u, v;         /* the same from -0.5 at the left and bottom to 0.5 */
    Vec2 place;          /* where the camera's `normal` is looked up: u, v, or what the kind of camera writes */
    const float *sample; /* two numbers in [0,1), for what is not the same in all samples of a pixel; or NULL */
} CameraPoint;

typedef enum CameraProperty {
    CAMERA_FLAT = 1, /* the length of `direction` gives the angle */
    CAMERA_MESH = 2  /* rays start on a mesh: direction, right and up do not say where to, and there is no lens */
} CameraProperty;

struct CameraOps {
    const char *name;
    unsigned properties; /* bits of CameraProperty */
    /* The ray, which has the camera's location already; its direction may have any length. 0: none goes through this
     * point, which stays black. */
    int (*ray)(const Camera *camera, CameraPoint *at, Ray *ray);
};

/* The ray through (x, y) of a width by height picture. sample: as in CameraPoint; NULL: through the middle of the lens.
 * A ray where the camera sees nothing has tmax < 0: it meets nothing, not even the sky. */
Ray camera_ray(const Camera *camera, int width, int height, double x, double y, const float *sample);
static inline int camera_ray_exists(const Ray *ray)
{
    return ray->tmax >= 0;
}
/* 1 if rays through one point of the picture differ. */
int camera_needs_sample(const Camera *camera);

/* lens.c: move a ray from the middle of the lens to the point of the lens that the sample chooses. */
void camera_through_lens(const Camera *camera, const float *sample, Ray *ray);
/* The density of points on the lens: size by size weights, the first row at the bottom; kept in the arena. NULL without
 * memory. */
const Bokeh *bokeh_create(Arena *arena, const float *weights, int size);

/* mesh.c: list the faces that rays start from. NULL without memory; no face is listed where no mesh has any. */
const MeshCamera *mesh_camera_create(Arena *arena, const MeshCamera *from);

#endif
