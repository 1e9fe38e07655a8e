/* Adaptive sampling: the number of samples of each pixel from an estimate of its noise. See adaptive.h. */
#include <stdlib.h>
#include "render/adaptive.h"

#define PIXELS_MAX 1024 /* pixels of a tile, at most */
#define DARK_SHARE 0.05 /* share of the tile's mean value that bounds the divisor of darker pixels */

struct Adaptive {
    PathContext context;
    PathWorker worker;
    Film *film; /* a film of one pixel, which counts what is dropped */
    FilmPixel *pixel;
    double mean[PIXELS_MAX], variance[PIXELS_MAX];
    int count;
};

int adaptive_create(Adaptive **out, const PathContext *context, const RenderVariant *variants, RetexError *err)
{
    const FilmParams film = {.width = 1, .height = 1, .spp = 1, .ntiles = 1};
    Adaptive *a = *out = calloc(1, sizeof *a);
    if (!a)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for adaptive sampling");
    a->context = *context;
    a->context.split = 0, a->context.nvariants = a->context.halves = 1;
    int code = film_create(&a->film, context->scene, &film, err);
    if (!code)
        code = film_pixel_create(&a->pixel, a->film, err);
    if (code)
        adaptive_close(out);
    else
        a->worker.context = &a->context, a->worker.pixel = a->pixel, a->worker.variants = variants;
    return code;
}

void adaptive_close(Adaptive **adaptive)
{
    if (!*adaptive)
        return;
    film_pixel_close(&(*adaptive)->pixel);
    film_close(&(*adaptive)->film);
    free(*adaptive);
    *adaptive = NULL;
}

PathWorker *adaptive_worker(Adaptive *adaptive)
{
    return &adaptive->worker;
}

void adaptive_pixel_end(Adaptive *a, const PathResult paths[ADAPTIVE_PILOT])
{
    double sum = 0, squares = 0;
    for (int i = 0; i < ADAPTIVE_PILOT; i++) {
        const double *light = paths[i].light;
        const double l = rgb_luminance(rgb((float)light[0], (float)light[1], (float)light[2]));
        sum += l, squares += l * l;
    }
    const double n = ADAPTIVE_PILOT, mean = sum / n, variance = (squares / n - mean * mean) * n / (n - 1);
    a->mean[a->count] = mean;
    a->variance[a->count++] = variance > 0 ? variance : 0;
}

int adaptive_tile_samples(Adaptive *a, double noise, int most)
{
    double all = 0, sum = 0;
    for (int k = 0; k < a->count; k++)
        all += a->mean[k];
    double dark = DARK_SHARE * all / a->count + 1e-4;
    for (int k = 0; k < a->count; k++)
        sum += a->variance[k] / (a->mean[k] + dark);
    double wanted = sum / a->count / (noise * noise);
    int packets = wanted < most ? (int)ceil(wanted / ACCEL_PACKET) : most, samples = packets * ACCEL_PACKET;
    a->count = 0;
    samples = samples > ADAPTIVE_LEAST ? samples : ADAPTIVE_LEAST;
    return samples < most ? samples : most;
}
