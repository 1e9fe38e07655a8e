/* Pictures on cylinders about the up or right vector: of `angle` degrees round, and as high, or wide, as that vector is
 * long. Of types 1 and 2 all rays come from the middle; those of 3 and 4 are perpendicular to the axis. */
#include "camera/camera.h"

/* In the plane of the direction and a side, turned from one towards the other. */
static Vec3 turned(const Camera *camera, Vec3 side, double angle)
{
    return vec_add(vec_scale(vec_normalize(camera->direction), cos(angle)), vec_scale(vec_normalize(side), sin(angle)));
}

/* The angle about the axis, of a place in the picture. */
static double angle_upright(const Camera *camera, CameraPoint *at)
{
    at->place = (Vec2){at->u * camera->angle * PI / 180, at->v * vec_length(camera->up)};
    return at->place.u;
}

static double angle_lying(const Camera *camera, CameraPoint *at)
{
    at->place = (Vec2){at->u * vec_length(camera->right), at->v * camera->angle * PI / 180};
    return at->place.v;
}

static int upright(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->direction = vec_add(turned(camera, camera->right, angle_upright(camera, at)), vec_scale(camera->up, at->v));
    return 1;
}

static int lying(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->direction = vec_add(turned(camera, camera->up, angle_lying(camera, at)), vec_scale(camera->right, at->u));
    return 1;
}

static int upright_parallel(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->origin = vec_add(camera->location, vec_scale(camera->up, at->v));
    ray->direction = turned(camera, camera->right, angle_upright(camera, at));
    return 1;
}

static int lying_parallel(const Camera *camera, CameraPoint *at, Ray *ray)
{
    ray->origin = vec_add(camera->location, vec_scale(camera->right, at->u));
    ray->direction = turned(camera, camera->up, angle_lying(camera, at));
    return 1;
}

const CameraOps camera_cylinder_1 = {.name = "cylinder 1", .ray = upright};
const CameraOps camera_cylinder_2 = {.name = "cylinder 2", .ray = lying};
const CameraOps camera_cylinder_3 = {.name = "cylinder 3", .ray = upright_parallel};
const CameraOps camera_cylinder_4 = {.name = "cylinder 4", .ray = lying_parallel};
