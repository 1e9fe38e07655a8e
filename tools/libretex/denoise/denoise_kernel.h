/* The inner loops of denoising: one tile, compared with itself at displacements within the window. Private to libretex.
 *
 * Planes are DENOISE_PITCH x DENOISE_ROWS floats: a tile of DENOISE_TILE pixels a side with DENOISE_HALO more on each
 * side. Sums and weights are DENOISE_TILE x DENOISE_TILE floats, for the tile alone. */
#ifndef RETEX_DENOISE_DENOISE_KERNEL_H
#define RETEX_DENOISE_DENOISE_KERNEL_H

#include <stddef.h>

#include <retex/host/denoise_data.h>

enum {
    DENOISE_TILE = 64,
    DENOISE_MARGIN = 4, /* pixels at each side of a tile that the next tile filters: here they only help to choose
                           the candidate */
    DENOISE_STEP = DENOISE_TILE - 2 * DENOISE_MARGIN,
    DENOISE_RADIUS_MAX = 10,
    DENOISE_PATCH = 3,                                   /* patches of 7x7 pixels are compared */
    DENOISE_WIDE = DENOISE_TILE + 2 * DENOISE_PATCH + 2, /* pixels of a row that are compared at a displacement */
    DENOISE_HALO = DENOISE_RADIUS_MAX + DENOISE_PATCH,
    DENOISE_PITCH = 96,
    DENOISE_ROWS = DENOISE_TILE + 2 * DENOISE_HALO,
    DENOISE_PLANE = DENOISE_PITCH * DENOISE_ROWS,
    DENOISE_PIXELS = DENOISE_TILE * DENOISE_TILE,
    DENOISE_CANDIDATES = 4, /* candidate filters */
    DENOISE_BATCH = 4,      /* displacements in one call, so that the sums stay in the cache */
    DENOISE_WEIGHTS = 16,   /* displacements whose weights are kept until images are filtered with them */
    DENOISE_NEAR = 20,      /* squared distance up to which all candidates look; further, what is left of a firefly gets
                               darker with them, but light gets no nearer to the truth */
    DENOISE_FEATURE_PLANES_MAX = 3 * RETEX_FEATURE_COUNT + RETEX_MAX_TARGETS, /* planes; targets have covers */
    DENOISE_FEATURES_MAX = RETEX_FEATURE_COUNT + RETEX_MAX_TARGETS
};

static inline size_t denoise_at(int x, int y)
{
    return (size_t)(y + DENOISE_HALO) * DENOISE_PITCH + (size_t)(x + DENOISE_HALO);
}

/* A feature: planes that are compared together. The weight of a neighbour follows the feature that differs most. strict
 * and loose are by pixel 1 / the squared difference at which the weight is 1/e. */
typedef struct RetexDenoiseFeature {
    int first, count;            /* index of the first plane; number of planes */
    const float *strict, *loose; /* scales */
    const float *normal[3];      /* or NULL; a position's difference counts along this direction only, divided by the
                                    distance in pixels */
} RetexDenoiseFeature;

typedef struct RetexDenoiseFeatures {
    float *valid; /* 1 for pixels that count: within the picture; else 0 */
    const float *planes[DENOISE_FEATURE_PLANES_MAX];
    int count;
    RetexDenoiseFeature of[DENOISE_FEATURES_MAX];
} RetexDenoiseFeatures;

/* Similarity, 0..1, of each pixel to the pixel at a displacement: 1 if both are in the picture, and by both scales of
 * the features. Beyond DENOISE_NEAR only the strict one is computed. */
typedef struct RetexDenoiseSimilarity {
    float valid[DENOISE_PIXELS], strict[DENOISE_PIXELS], loose[DENOISE_PIXELS];
} RetexDenoiseSimilarity;

void retex_denoise_features_kernel(RetexDenoiseSimilarity *alike, const RetexDenoiseFeatures *features, int dx, int dy,
                                   int scalar);

/* Weighted sums and sums of weights of one candidate filter, for both halves. */
typedef struct RetexDenoiseSums {
    float *sum[2][3], *norm[2];
} RetexDenoiseSums;

/* One signal. Its halves are independent estimates; each is filtered with the weights that the other half gives
 * (Rousselle et al. 2012). */
typedef struct RetexDenoiseSignal {
    const float *half[2][3];  /* divided by the modulation */
    const float *variance[3]; /* variance of a half, divided by the squared modulation */
    const float *kind;        /* 1 or -1: pixels of different kinds are not compared */
    const float *modulation;  /* mean over colours: the weight of a pixel in weighted sums */
    float epsilon;            /* added to the variance, so that invisible differences do not count */
    float strength;           /* squared parameter `strength`: differences of so many variances still count as
                                    similar */
    RetexDenoiseSums candidates[DENOISE_CANDIDATES];
    float *scratch; /* DENOISE_SCRATCH floats */
} RetexDenoiseSignal;
enum { DENOISE_SCRATCH = 3 * (DENOISE_TILE + 2 * DENOISE_PATCH) * DENOISE_TILE + DENOISE_BATCH * 2 * DENOISE_PIXELS };

typedef struct RetexDenoiseDisplacement {
    int dx, dy;
} RetexDenoiseDisplacement;

/* Displacements, with the similarity of features at each. weights (NULL: not wanted) receives the weights of the first
 * candidate, as the mean of both halves. */
typedef struct RetexDenoiseBatch {
    int count;
    RetexDenoiseDisplacement of[DENOISE_BATCH];
    const RetexDenoiseSimilarity *alike[DENOISE_BATCH];
    float *weights[DENOISE_BATCH];
} RetexDenoiseBatch;

/* Add the weighted pixels at these displacements to the sums of the signal. */
void retex_denoise_signal_kernel(const RetexDenoiseSignal *signal, const RetexDenoiseBatch *batch, int scalar);

/* Channels of images, filtered with weights that are known. */
typedef struct RetexDenoiseImages {
    int count;
    const float *const *planes;
    float *const *sums;
} RetexDenoiseImages;

/* Add the pixels of all planes at these displacements, times the weights of each, to the sums. The displacements are
 * many, because planes are larger than the cache. */
void retex_denoise_images_kernel(const RetexDenoiseImages *images, const RetexDenoiseDisplacement *displacements,
                                 const float *const *weights, int count, int scalar);

#endif
