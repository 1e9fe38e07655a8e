/* What all kinds of camera share. */
#include "camera/camera.h"

Ray camera_ray(const Camera *camera, int width, int height, double x, double y, const float *sample)
{
    const CameraPoint at = {width, height, x, y, x / width - 0.5, 0.5 - y / height, sample};
    Ray ray = {camera->location, {0, 0, 1}, 0, INFINITY};
    if (!camera->ops->ray(camera, &at, &ray)) {
        ray.tmax = -1;
        return ray;
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
