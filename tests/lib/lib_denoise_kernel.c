/* See lib_denoise_kernel.h. */
#include "lib_denoise_kernel.h"

#include <stdlib.h>

static void fill(float *plane, double low, double high, uint32_t *seed)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        plane[i] = (float)(low + (high - low) * test_random(seed));
}

Room *open_room(uint32_t seed)
{
    static const int counts[FEATURES] = {3, 1, 3, 2};
    Room *r = calloc(1, sizeof *r);
    int first = 0;
    for (int k = 0; k < PLANES; k++) {
        fill(r->planes[k], -1, 1, &seed);
        r->features.planes[k] = r->planes[k];
    }
    for (int k = 0; k < FEATURES; k++) {
        fill(r->scales[2 * k], 0.1, 3, &seed);
        fill(r->scales[2 * k + 1], 0.01, 0.3, &seed);
        r->features.of[k] = (RetexDenoiseFeature){
            .first = first, .count = counts[k], .strict = r->scales[2 * k], .loose = r->scales[2 * k + 1]};
        first += counts[k];
    }
    for (int k = 0; k < 3; k++)
        r->features.of[2].normal[k] = r->planes[k];
    r->features.count = FEATURES;
    r->features.valid = r->valid;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            fill(r->half[h][c], 0, 2, &seed);
    for (int c = 0; c < 3; c++)
        fill(r->variance[c], 0, 0.5, &seed);
    fill(r->modulation, 0.02, 1, &seed);
    for (int i = 0; i < DENOISE_PLANE; i++) {
        r->valid[i] = test_random(&seed) < 0.9;
        r->kind[i] = test_random(&seed) < 0.9 ? 1 : -1;
        if (test_random(&seed) < 0.1) /* dark */
            for (int c = 0; c < 3; c++)
                r->half[0][c][i] = r->half[1][c][i] = r->variance[c][i] = 0;
        if (test_random(&seed) < 0.01)
            r->half[0][1][i] *= 1e20f;
    }
    for (int k = 0; k < IMAGES; k++) {
        fill(r->images[k], 0, 1, &seed);
        r->image_planes[k] = r->images[k];
    }
    return r;
}

RetexDenoiseSignal signal_of(Room *r, Sums *sums)
{
    RetexDenoiseSignal s = {
        .kind = r->kind, .modulation = r->modulation, .epsilon = 1e-6f, .strength = 0.2f, .scratch = r->scratch};
    for (int c = 0; c < 3; c++) {
        s.variance[c] = r->variance[c];
        s.half[0][c] = r->half[0][c], s.half[1][c] = r->half[1][c];
    }
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        for (int h = 0; h < 2; h++) {
            s.candidates[k].norm[h] = sums->sum[k][h][3];
            for (int c = 0; c < 3; c++)
                s.candidates[k].sum[h][c] = sums->sum[k][h][c];
        }
    return s;
}

RetexDenoiseImages images_of(const Room *r, Sums *sums)
{
    for (int k = 0; k < IMAGES; k++)
        sums->image_sums[k] = sums->images[k];
    return (RetexDenoiseImages){IMAGES, r->image_planes, sums->image_sums};
}
