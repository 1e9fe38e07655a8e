/* A thin lens: what is at the focal distance along the direction of view stays sharp. */
#include "camera/camera.h"

/* ---- the density of points on the lens ---- */

/* Index of the step of a cumulative table that u falls into, and how far into it, from 0 to 1. */
static int find_step(const float *sums, int size, float u, float *rest)
{
    int low = 0, high = size - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (sums[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    const float from = low ? sums[low - 1] : 0, width = sums[low] - from;
    *rest = width > 0 ? fminf((u - from) / width, 0x1.fffffep-1f) : 0;
    return low;
}

/* Sums of weights that end at 1; equal steps where all weights are 0. Returns their sum. */
static double cumulate(float *sums, const float *weights, int size)
{
    double total = 0, sum = 0;
    for (int k = 0; k < size; k++)
        total += weights[k];
    for (int k = 0; k < size; k++) {
        sum += weights[k];
        sums[k] = (float)(total > 0 ? sum / total : (k + 1.0) / size);
    }
    sums[size - 1] = 1;
    return total;
}

const Bokeh *bokeh_create(Arena *arena, const float *weights, int size)
{
    const size_t cells = (size_t)size * (size_t)size;
    Bokeh *bokeh = arena_alloc(arena, sizeof *bokeh);
    float *totals = arena_alloc(arena, (size_t)size * sizeof *totals);
    if (!bokeh || !totals || !(bokeh->rows = arena_alloc(arena, (size_t)size * sizeof *bokeh->rows)) ||
        !(bokeh->cells = arena_alloc(arena, cells * sizeof *bokeh->cells)))
        return NULL;
    bokeh->size = size;
    for (int row = 0; row < size; row++)
        totals[row] = (float)cumulate(bokeh->cells + row * size, weights + row * size, size);
    cumulate(bokeh->rows, totals, size);
    return bokeh;
}

/* ---- rays ---- */

/* POV-Ray's samples lie in a disc of diameter 1, or with a bokeh pigment in the unit square, of which half the aperture
 * is the unit. */
static Vec2 point_on_lens(const CameraLens *lens, const float *sample)
{
    const Bokeh *b = lens->bokeh;
    if (!b) {
        const double radius = 0.5 * sqrt(sample[0]), angle = 2 * PI * sample[1];
        return (Vec2){radius * cos(angle), radius * sin(angle)};
    }
    float up, right;
    const int row = find_step(b->rows, b->size, sample[0], &up);
    const int cell = find_step(b->cells + row * b->size, b->size, sample[1], &right);
    return (Vec2){(cell + right) / b->size - 0.5, (row + up) / b->size - 0.5};
}

void camera_through_lens(const Camera *camera, const float *sample, Ray *ray)
{
    const CameraLens *lens = &camera->lens;
    const Vec2 point = point_on_lens(lens, sample);
    const Vec3 right = vec_normalize(vec_cross(camera->up, camera->direction));
    const Vec3 up = vec_normalize(vec_cross(camera->direction, right));
    const double unit = lens->aperture / 2, length = vec_length(camera->direction);
    const Vec3 aside = vec_add(vec_scale(right, point.u * unit), vec_scale(up, -point.v * unit));
    ray->origin = vec_add(ray->origin, aside);
    ray->direction = vec_sub(vec_scale(ray->direction, lens->focal_distance / length), aside);
}
