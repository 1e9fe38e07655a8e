/* The inner loops of denoising: displacements of the window over one tile. Private to libretex.
 *
 * Planes are DENOISE_PITCH x DENOISE_ROWS floats: a tile of DENOISE_TILE pixels a side and around it DENOISE_HALO more.
 * Sums and weights are DENOISE_TILE x DENOISE_TILE floats, of the tile alone. */
#ifndef RETEX_DENOISE_DENOISE_KERNEL_H
#define RETEX_DENOISE_DENOISE_KERNEL_H

#include <stddef.h>

enum {
    DENOISE_TILE = 64,
    DENOISE_MARGIN = 4, /* of a tile's pixels at each side, which the next tile makes: here they only help to choose */
    DENOISE_STEP = DENOISE_TILE - 2 * DENOISE_MARGIN,
    DENOISE_RADIUS_MAX = 10,
    DENOISE_PATCH = 3, /* patches of 7x7 pixels are compared */
    DENOISE_HALO = DENOISE_RADIUS_MAX + DENOISE_PATCH,
    DENOISE_PITCH = 96,
    DENOISE_ROWS = DENOISE_TILE + 2 * DENOISE_HALO,
    DENOISE_PLANE = DENOISE_PITCH * DENOISE_ROWS,
    DENOISE_PIXELS = DENOISE_TILE * DENOISE_TILE,
    DENOISE_CANDIDATES = 4, /* ways to weigh neighbours */
    DENOISE_BATCH = 4,      /* displacements at once: sums stay in the cache */
    DENOISE_FEATURES_MAX = 32,
    DENOISE_GROUPS_MAX = 16
};

static inline size_t denoise_at(int x, int y)
{
    return (size_t)(y + DENOISE_HALO) * DENOISE_PITCH + (size_t)(x + DENOISE_HALO);
}

/* Features that are compared together: the weight follows the group that differs most. Scales are 1 / squared
 * difference at which the weight is 1/e, by pixel. */
typedef struct RetexDenoiseFeatureGroup {
    int first, count;            /* of the planes */
    const float *strict, *loose; /* scales */
    const float *normal[3];      /* or NULL; the difference counts along this direction only, per pixel of distance */
} RetexDenoiseFeatureGroup;

typedef struct RetexDenoiseFeatures {
    const float *valid; /* 1 within the picture, else 0 */
    const float *planes[DENOISE_FEATURES_MAX];
    int ngroups;
    RetexDenoiseFeatureGroup groups[DENOISE_GROUPS_MAX];
} RetexDenoiseFeatures;

/* How alike pixels that lie some way apart are, 0..1: whatever their features, and by both scales of these. */
typedef struct RetexDenoiseSimilarity {
    float valid[DENOISE_PIXELS], strict[DENOISE_PIXELS], loose[DENOISE_PIXELS];
} RetexDenoiseSimilarity;

void retex_denoise_features_kernel(RetexDenoiseSimilarity *alike, const RetexDenoiseFeatures *features, int dx, int dy,
                                   int scalar);

/* What one way to weigh neighbours has brought, by half. */
typedef struct RetexDenoiseSums {
    float *sum[2][3], *norm[2];
} RetexDenoiseSums;

/* One signal. Halves are independent estimates; each is filtered with the weights that the other gives (Rousselle et
 * al. 2012). */
typedef struct RetexDenoiseSignal {
    const float *half[2][3];     /* over the modulation */
    const float *variance[3];    /* of a half, over the modulation squared */
    const float *kind;           /* 1 or -1: pixels of different kinds are not compared */
    const float *modulation;     /* its mean over colours: what a pixel counts */
    float epsilon;               /* variance below which no difference is seen */
    float strength;              /* squared: how many variances apart still count as alike */
    RetexDenoiseSums candidates[DENOISE_CANDIDATES];
    int nplanes;                 /* of images, */
    const float *const *planes;  /* channel by channel, that are filtered with the first candidate's weights */
    float *const *sums;          /* nplanes */
    float *scratch;              /* DENOISE_SCRATCH floats */
} RetexDenoiseSignal;
enum {
    DENOISE_SCRATCH =
        3 * (DENOISE_TILE + 2 * DENOISE_PATCH) * DENOISE_TILE + DENOISE_BATCH * 2 * DENOISE_PIXELS
};

/* Some displacements of one row, (dx, dy) to (dx + count - 1, dy): how alike pixels are at each, and where (may be
 * NULL) the first candidate's weights go, the mean of both halves. */
typedef struct RetexDenoiseBatch {
    int dx, dy, count;
    const RetexDenoiseSimilarity *alike[DENOISE_BATCH];
    float *weights[DENOISE_BATCH];
} RetexDenoiseBatch;

/* Add to the sums what pixels that far away give. */
void retex_denoise_signal_kernel(const RetexDenoiseSignal *signal, const RetexDenoiseBatch *batch, int scalar);

#endif
