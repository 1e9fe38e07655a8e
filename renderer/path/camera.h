/* Rays through the picture. */
#ifndef RENDERER_PATH_CAMERA_H
#define RENDERER_PATH_CAMERA_H

#include "shape/surface.h"

/* The ray through (x, y) of a width by height picture: 0, 0 is its top left corner, pixel centres lie at + 0.5. */
static inline Ray camera_ray(const Camera *camera, int width, int height, double x, double y)
{
    Vec3 offset = vec_add(vec_scale(camera->right, x / width - 0.5), vec_scale(camera->up, 0.5 - y / height));
    Ray ray = {camera->location, {0, 0, 0}, 0, INFINITY};
    if (camera->kind == CAMERA_ORTHOGRAPHIC) {
        ray.origin = vec_add(camera->location, offset);
        ray.direction = vec_normalize(camera->direction);
    } else {
        ray.direction = vec_normalize(vec_add(camera->direction, offset));
    }
    return ray;
}

#endif
