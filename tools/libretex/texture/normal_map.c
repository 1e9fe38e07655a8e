/* See normal_map.h. */
#include "texture/normal_map.h"

#include <math.h>
#include <string.h>

#include <retex/parallel.h>

/* Integers of 8 bits have no 0: of 127 and 128, either stands for it, and a map that is flat is to be flat. */
#define LEAST (1.001f / 255)

static float component(float value)
{
    const float x = 2 * value - 1;
    return fabsf(x) <= LEAST ? 0 : x;
}

/* From the texture to the surface: the opposite of its placement, without sizes. */
static void turn(const RetexTextureSpec *spec, const int mirrored[2], double n[2])
{
    const double angle = fmod(spec->rotate, 360) * M_PI / 180;
    const int is_exact = fmod(spec->rotate, 90) == 0;
    const double c = is_exact ? rint(cos(angle)) : cos(angle), s = is_exact ? rint(sin(angle)) : sin(angle);
    for (int axis = 0; axis < 2; axis++)
        n[axis] *= (spec->flip[axis] ? -1 : 1) * (mirrored[axis] ? -1 : 1);
    const double x = c * n[0] + s * n[1], y = c * n[1] - s * n[0];
    n[0] = copysign(1, spec->scale[0]) * x;
    n[1] = copysign(1, spec->scale[1]) * y;
}

void retex_normal_map_weights(const RetexTextureSpec *spec, int is_dx, const int mirrored[2], const float rgba[4],
                              float weights[RETEX_FINISHES_MAX])
{
    static const float flat[3] = {0, 0, 1};
    const double tilt = spec->normal_tilt * M_PI / 180;
    double n[3], square = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = (double)(rgba[3] * component(rgba[k]) + (1 - rgba[3]) * flat[k]); /* flat where the map is transparent */
        n[k] = k == 2 && n[k] < 0 ? 0 : n[k];
        square += n[k] * n[k];
    }
    if (!(square > 1e-12) || !isfinite(square)) /* it says nothing */
        n[0] = n[1] = 0, n[2] = square = 1;
    n[1] = is_dx ? -n[1] : n[1];
    turn(spec, mirrored, n);
    const double length = sqrt(square);
    weights[1] = (float)(n[0] / length / sin(tilt));
    weights[2] = (float)(n[1] / length / sin(tilt));
    weights[0] = (float)(n[2] / length) - (weights[1] + weights[2]) * (float)cos(tilt);
    weights[3] = 1 - weights[0] - weights[1] - weights[2];
}

void retex_normal_map_repeats(const RetexTextureSpec *spec, int repeats[2])
{
    for (int axis = 0; axis < 2; axis++)
        repeats[axis] = spec->wrap[axis] == RETEX_WRAP_MIRROR ? 2 : 1;
}

typedef struct WeighWork {
    const RetexTextureSpec *spec;
    const RetexImage *map;
    int is_dx, repeats[2];
    const RetexTexels *texels;
} WeighWork;

static void weigh_job(void *context, int y, int thread)
{
    const WeighWork *work = context;
    const int width = work->texels->width / work->repeats[0], height = work->texels->height / work->repeats[1];
    int mirrored[2];
    const int down = retex_normal_map_texel(1, y, height, work->repeats[1], &mirrored[1]);
    (void)thread;
    for (int x = 0; x < work->texels->width; x++) {
        const int across = retex_normal_map_texel(0, x, width, work->repeats[0], &mirrored[0]);
        const float *rgba = work->map->pixels + 4 * ((size_t)down * (size_t)width + (size_t)across);
        float weights[RETEX_FINISHES_MAX],
            *to = (float *)work->texels->texels + 4 * ((size_t)y * (size_t)work->texels->width + (size_t)x);
        retex_normal_map_weights(work->spec, work->is_dx, mirrored, rgba, weights);
        memcpy(to, weights + 1, 3 * sizeof *to);
        to[3] = 1;
    }
}

void retex_normal_map_weigh(const RetexTextureSpec *spec, const RetexImage *map, int is_dx, const RetexTexels *texels,
                            int nthreads)
{
    WeighWork work = {spec, map, is_dx, {1, 1}, texels};
    retex_normal_map_repeats(spec, work.repeats);
    retex_parallel(nthreads, texels->height, weigh_job, &work);
}
