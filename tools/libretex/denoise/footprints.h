/* The footprints of a pixel whose light was filtered. Private to libretex. */
#ifndef RETEX_DENOISE_FOOTPRINTS_H
#define RETEX_DENOISE_FOOTPRINTS_H

#include "denoise/pools.h"

/* A pixel that is similar to the one being filtered, which is the first of its own neighbours; weight 0..1. */
typedef struct RetexNeighbour {
    int x, y;
    float weight;
} RetexNeighbour;

/* Distribute light, the filtered sum of a signal's clusters at (x, y), to the clusters, into out. signal is one of
 * denoiser->signals. Sharp clusters keep their UV and the proportions of their light; where the pixel has none, those
 * of the neighbour with the largest weight are copied, or of the nearest pixel of the window. Broad clusters are pooled
 * over neighbours if params.footprints. Shares in interreflected light are kept or pooled in the same way; where all
 * shares are 0 they become those of the light. */
void retex_denoise_share_light(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser,
                               const RetexSignal *signal, int x, int y, const RetexNeighbour *neighbours, int count,
                               const float light[3], RetexDenoisedRows *out);

/* Distribute the footprints that are not clusters of a signal, of all targets. Those of interreflections stay, with
 * their shares; where the pixel has none, those of the neighbour with the largest weight that has any are copied. Those
 * of second and further hits, in layout paper, are pooled. */
void retex_denoise_share_later(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser, int x, int y,
                               const RetexNeighbour *neighbours, int count, RetexDenoisedRows *out);

#endif
