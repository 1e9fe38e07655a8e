/* What all kinds of camera share. */
#include "camera/camera.h"
#include "shade/normal.h"

Ray camera_ray(const Camera *camera, int width, int height, double x, double y, const float *sample)
{
    const double u = x / width - 0.5, v = 0.5 - y / height;
    CameraPoint at = {width, height, x, y, u, v, {u, v}, sample};
    Ray ray = {camera->location, {0, 0, 1}, 0, INFINITY};
    if (!camera->ops->ray(camera, &at, &ray)) {
        ray.tmax = -1;
        return ray;
    }
    if (camera->normal) {
        const Vec3 place = {at.place.u, at.place.v, 0};
        const Vec3 tilted = normal_tilted_ray(camera->normal, place, vec_normalize(ray.direction));
        ray.direction = vec_scale(tilted, vec_length(ray.direction)); /* the lens looks at the length */
    }
    if (sample && camera->lens.aperture != 0)
        camera_through_lens(camera, sample, &ray);
    ray.direction = vec_normalize(ray.direction);
    return ray;
}

int camera_needs_sample(const Camera *camera)
{
    return camera->lens.aperture != 0 || (camera->mesh && camera->mesh->rays > 1);
}
