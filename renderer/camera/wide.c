/* Wide pictures without a round edge. */
#include "camera/camera.h"

/* `angle` is that of the picture's width. */
static int ultra_wide_angle(const Camera *camera, CameraPoint *at, Ray *ray)
{
    const double x = at->u * camera->angle * PI / 180;
    const double y = at->v * camera->angle * PI / 180 * vec_length(camera->up) / vec_length(camera->right);
    at->place = (Vec2){x, y};
    ray->direction =
        vec_add(vec_scale(vec_normalize(camera->direction), cos(x) * cos(y)),
                vec_add(vec_scale(vec_normalize(camera->right), sin(x)), vec_scale(vec_normalize(camera->up), sin(y))));
    return 1;
}

/* Half a turn round, and all that is above and below; right, up and direction keep their lengths. */
static int panoramic(const Camera *camera, CameraPoint *at, Ray *ray)
{
    const double x = at->u * PI, y = at->v * PI;
    at->place = (Vec2){PI / 2 - x, y};
    ray->direction = vec_add(vec_scale(camera->direction, cos(x)),
                             vec_add(vec_scale(camera->right, sin(x)), vec_scale(camera->up, tan(y))));
    return 1;
}

/* v turned by an angle about an axis of any length. */
static Vec3 turned(Vec3 v, Vec3 axis, double angle)
{
    axis = vec_normalize(axis);
    return vec_add(vec_add(vec_scale(v, cos(angle)), vec_scale(vec_cross(axis, v), sin(angle))),
                   vec_scale(axis, vec_dot(axis, v) * (1 - cos(angle))));
}

/* Longitude and latitude, of two angles. */
static int spherical(const Camera *camera, CameraPoint *at, Ray *ray)
{
    const double x = at->u * camera->angle * PI / 180, y = at->v * camera->vertical_angle * PI / 180;
    at->place = (Vec2){x, y};
    ray->direction = turned(turned(camera->direction, camera->right, -y), camera->up, x);
    return 1;
}

const CameraOps camera_ultra_wide_angle = {.name = "ultra_wide_angle", .ray = ultra_wide_angle};
const CameraOps camera_panoramic = {.name = "panoramic", .ray = panoramic};
const CameraOps camera_spherical = {.name = "spherical", .ray = spherical};
