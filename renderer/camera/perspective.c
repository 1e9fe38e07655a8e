/* Flat pictures: by rays through one point, or by parallel rays. */
#include "camera/camera.h"

static Vec3 offset(const Camera *camera, const CameraPoint *at)
{
    return vec_add(vec_scale(camera->right, at->u), vec_scale(camera->up, at->v));
}

static int perspective(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->direction = vec_add(camera->direction, offset(camera, at));
    return 1;
}

static int orthographic(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->origin = vec_add(camera->location, offset(camera, at));
    ray->direction = camera->direction;
    return 1;
}

const CameraOps camera_perspective = {.name = "perspective", .properties = CAMERA_FLAT, .ray = perspective};
const CameraOps camera_orthographic = {.name = "orthographic", .properties = CAMERA_FLAT, .ray = orthographic};
