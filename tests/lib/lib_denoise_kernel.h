/* Random input of the inner loops of denoising. */
#ifndef LIB_DENOISE_KERNEL_H
#define LIB_DENOISE_KERNEL_H

#include "denoise/denoise_kernel.h"
#include "lib_test.h"

enum { PLANES = 9, FEATURES = 4, IMAGES = 6 };

/* The input of both kernels. */
typedef struct Room {
    float planes[PLANES][DENOISE_PLANE], scales[2 * FEATURES][DENOISE_PLANE], valid[DENOISE_PLANE];
    float half[2][3][DENOISE_PLANE], variance[3][DENOISE_PLANE], kind[DENOISE_PLANE], modulation[DENOISE_PLANE];
    float images[IMAGES][DENOISE_PLANE], scratch[DENOISE_SCRATCH];
    const float *image_planes[IMAGES];
    RetexDenoiseFeatures features;
    RetexDenoiseSimilarity alike[DENOISE_BATCH];
} Room;

/* The output of the kernels. */
typedef struct Sums {
    float sum[DENOISE_CANDIDATES][2][4][DENOISE_PIXELS], images[IMAGES][DENOISE_PIXELS],
        weight[DENOISE_BATCH][DENOISE_PIXELS];
    float *image_sums[IMAGES];
} Sums;

/* Three features and one of positions. They give weights from 0 to 1. To be freed. */
Room *open_room(uint32_t seed);
RetexDenoiseSignal signal_of(Room *r, Sums *sums);
RetexDenoiseImages images_of(const Room *r, Sums *sums);

#endif
