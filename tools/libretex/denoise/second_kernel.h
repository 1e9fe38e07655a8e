/* The inner loops of the second pass: one level of an edge-avoiding a-trous wavelet transform (Dammertz et al. 2010)
 * over a tile with the pixels around it. Private to libretex.
 *
 * Planes are those of denoise_kernel.h. A level reads pixels up to 2 steps away in both directions; what it writes is a
 * square that reaches `around` pixels beyond the tile to each side. */
#ifndef RETEX_DENOISE_SECOND_KERNEL_H
#define RETEX_DENOISE_SECOND_KERNEL_H

#include "denoise/denoise_kernel.h"

enum {
    DENOISE_LEVELS = 3,    /* of steps 1, 4 and 8 */
    DENOISE_TAPS_SIDE = 3, /* pixels across that a level reads */
    DENOISE_TAPS = DENOISE_TAPS_SIDE * DENOISE_TAPS_SIDE
};

/* The halves of a signal as one level leaves them, and their variance: that of one half. */
typedef struct RetexDenoiseLight {
    float *half[2][3], *variance[3];
} RetexDenoiseLight;

typedef struct RetexDenoiseLevel {
    int step, around;
    const RetexDenoiseFeatures *features; /* only strict scales count */
    int nsignals;
    const float *const *kinds;  /* by signal: pixels of different kinds are not mixed */
    const unsigned char *empty; /* by signal: 1 = without light, left as it is; NULL: none is */
    const float *epsilons;      /* by signal: added to the variance, so that invisible differences do not count */
    const RetexDenoiseLight *from;
    RetexDenoiseLight *to;
} RetexDenoiseLevel;

/* Each half becomes a mean with the weights that features and the other half give. */
void retex_denoise_level_kernel(const RetexDenoiseLevel *level, int scalar);

#endif
