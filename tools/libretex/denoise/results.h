/* A tile's signal while it is filtered, and what becomes of it. Private to tile.c and results.c. */
#ifndef RETEX_DENOISE_RESULTS_H
#define RETEX_DENOISE_RESULTS_H

#include "denoise/denoiser.h"

#define NEIGHBOUR_STEP 3  /* footprints are pooled over a grid of pixels of this step, */
#define NEIGHBOUR_REACH 2 /* so many steps to each side */
#define NEIGHBOURS_MAX ((2 * NEIGHBOUR_REACH + 1) * (2 * NEIGHBOUR_REACH + 1))

/* The choices: the noisy pixel, and the candidates. */
enum { CHOICES = DENOISE_CANDIDATES + 1 };

/* Scratch memory of a tile for the signal that is being filtered. */
typedef struct RetexTileSignal {
    int nclusters, nplanes;
    int is_empty; /* no light around the tile: nothing to filter */
    float *half[2][3], *variance[3], *lost[3], *kind, *modulation[3], *mean_modulation; /* planes; lost: what fireflies
                                                                                         were lowered by */
    float **planes, **sums;   /* images to filter, by channel: the sum of all clusters if there are any, then the other
                               members */
    const float **lit_planes; /* those of them with light, where there are several images; */
    float **lit_sums;
    int nlit;
    RetexDenoiseSums candidates[DENOISE_CANDIDATES];
    float *chosen[CHOICES];            /* weight of each choice, by pixel */
    float *neighbours[NEIGHBOURS_MAX]; /* weights by neighbour, if there are clusters */
} RetexTileSignal;

/* Number of the neighbour at a displacement, or -1. */
int retex_tile_neighbour(const RetexDenoiser *denoiser, int dx, int dy);

/* Write the results of a signal of the tile that begins at column `left`; adds to its sums. */
void retex_tile_finish(const RetexTileSignal *r, const RetexDenoiser *denoiser, const RetexSignal *signal, int left,
                       RetexDenoisedRows *out, RetexSignalSums *sums);

/* Pool the footprints that no signal has. alike: by neighbour, how similar features are there; NULL for those outside
 * of the window. */
void retex_tile_pool(const RetexDenoiser *denoiser, const float *const alike[NEIGHBOURS_MAX], int left,
                     RetexDenoisedRows *out);

#endif
