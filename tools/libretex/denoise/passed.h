/* What the first pass of denoising leaves for the second, and the second for the end. Private to libretex. */
#ifndef RETEX_DENOISE_PASSED_H
#define RETEX_DENOISE_PASSED_H

#include <retex/host/band_store.h>

#include "denoise/denoiser.h"
#include "set/set.h"

/* Offsets of the floats of a pixel. */
enum {
    DENOISE_PASSED_HALVES = 0, /* RGB of the first half of the samples, then of the second, divided by the modulation */
    DENOISE_PASSED_TOTAL = 6, /* RGB of the total that a signal's members add up to; then the factor of these members */
    DENOISE_PASSED = 9        /* floats a pixel */
};

/* Rows of pixels of the set's width. */
struct RetexDenoisePassed {
    int first, rows; /* rows of denoiser->set */
    float **of;      /* by signal: DENOISE_PASSED floats a pixel */
};

int retex_denoise_passed_open(RetexDenoisePassed *passed, const RetexDenoiser *denoiser, int rows, RetexError *err);
void retex_denoise_passed_close(RetexDenoisePassed *passed, const RetexDenoiser *denoiser);

static inline float *retex_denoise_passed_at(const RetexDenoisePassed *passed, const RetexDenoiser *d, int signal,
                                             int x, int y)
{
    return passed->of[signal] + DENOISE_PASSED * ((size_t)(y - passed->first) * (size_t)d->set->width + (size_t)x);
}

/* The same of a whole picture, in a temporary file. */
typedef struct RetexPassedStore {
    RetexBandStore *store;
    int *images; /* by signal, then by PassedImage */
} RetexPassedStore;

typedef enum RetexPassedImage {
    PASSED_FIRST_HALF,
    PASSED_SECOND_HALF,
    PASSED_TOTAL,
    PASSED_FACTOR,
    PASSED_IMAGES
} RetexPassedImage;

int retex_passed_store_open(RetexPassedStore *store, const RetexDenoiser *denoiser, RetexError *err);
void retex_passed_store_close(RetexPassedStore *store);
/* Write `count` rows, from `row` on, one image of all signals; they are those from y on of the picture, where a band
 * begins. */
int retex_passed_store_put(RetexPassedStore *store, const RetexDenoiser *denoiser, const RetexDenoisePassed *passed,
                           RetexPassedImage image, int row, int count, int y, RetexError *err);
/* Read one image of all signals into all rows of `passed`, of which the first is row y of the picture. */
int retex_passed_store_load(const RetexPassedStore *store, const RetexDenoiser *denoiser, RetexDenoisePassed *passed,
                            RetexPassedImage image, int y, RetexError *err);

#endif
