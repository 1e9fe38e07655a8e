/* What becomes of a pixel's footprints when its light was filtered. Private to libretex. */
#ifndef RETEX_DENOISE_FOOTPRINTS_H
#define RETEX_DENOISE_FOOTPRINTS_H

#include "denoise/tile.h"

/* Pixels that are like the one in hand, itself among them (the first), and how much each counts, 0..1. */
typedef struct RetexNeighbour {
    int x, y;
    float weight;
} RetexNeighbour;

/* The clusters of a signal of layout footprints, and how its parts are used. Found once a call. */
typedef struct RetexDenoiseFootprints RetexDenoiseFootprints;
int retex_denoise_footprints_open(RetexDenoiseFootprints **footprints, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_footprints_close(RetexDenoiseFootprints **footprints);

/* Distribute light, the filtered sum of a signal's clusters at (x, y), to the clusters, into band. Sharp clusters keep
 * their places and the proportions of their light; where the pixel has none, those of the neighbour that counts most.
 * Broad ones are pooled over neighbours if params.footprints. Shares in light that meets targets again are kept or
 * pooled likewise; where they are all 0 they become those of the light. signal is one of denoiser->signals. */
void retex_denoise_share_light(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser,
                               const RetexSignal *signal, int x, int y, const RetexNeighbour *neighbours, int count,
                               const float light[3], RetexDenoisedRows *band);

/* Pool what no signal's clusters are: later footprints of all targets, in layout paper those of second and further
 * hits. */
void retex_denoise_pool_interreflections(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser, int x,
                                         int y, const RetexNeighbour *neighbours, int count, RetexDenoisedRows *band);

/* Which parts of the set these calls write: 1 in written[part]. */
void retex_denoise_mark_written(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser,
                                unsigned char *written);

#endif
