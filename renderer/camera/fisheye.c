/* Round pictures: the angle from the direction of view grows with the distance from the middle. */
#include "camera/camera.h"

/* Along the direction, turned by an angle towards the side that (x, y) points to in the picture. */
static Vec3 turned(const Camera *camera, CameraPoint *at, double x, double y, double angle)
{
    const double side = atan2(y, x);
    at->place = (Vec2){side < -PI / 2 ? side + 2 * PI : side, angle};
    const double distance = sqrt(x * x + y * y), aside = distance > 0 ? sin(angle) / distance : 0;
    return vec_add(
        vec_scale(vec_normalize(camera->direction), cos(angle)),
        vec_add(vec_scale(vec_normalize(camera->right), aside * x), vec_scale(vec_normalize(camera->up), aside * y)));
}

/* `angle` is that of the circle of radius 1, in units of right and up. */
static int fisheye(const Camera *camera, CameraPoint *at, Ray *ray)
{
    const double x = 2 * at->u * vec_length(camera->right), y = 2 * at->v * vec_length(camera->up);
    const double distance = sqrt(x * x + y * y);
    if (distance > 1)
        return 0;
    ray->direction = turned(camera, at, x, y, distance * camera->angle * PI / 360);
    return 1;
}

/* A dome of 180 degrees. Wide pictures are cut below: the middle of the circle moves down until its edge touches the
 * sides of a picture whose sides are as 1.283458. */
static int omnimax(const Camera *camera, CameraPoint *at, Ray *ray)
{
    static const double widest = 1.283458;
    const double aspect = vec_length(camera->right) / vec_length(camera->up);
    double x = 2 * at->u, y = 2 * at->v;
    if (aspect <= 1)
        y /= aspect;
    else
        y = (y - 1) / fmin(aspect, widest) + 1;
    if (aspect > widest)
        x *= aspect / widest;
    const double distance = sqrt(x * x + y * y), squared = distance * distance;
    if (distance > 1)
        return 0;
    /* the projector's lens */
    const double angle = distance * (1.411269 + squared * (-0.09439 + squared * 0.25674));
    const double upwards = distance > 0 ? y / distance * sin(angle) : 0;
    if (upwards < -cos(angle)) /* what is more than 45 degrees below the direction is not seen */
        return 0;
    ray->direction = turned(camera, at, x, y, angle);
    return 1;
}

const CameraOps camera_fisheye = {.name = "fisheye", .ray = fisheye};
const CameraOps camera_omnimax = {.name = "omnimax", .ray = omnimax};
