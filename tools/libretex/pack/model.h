/* Lossless coding of strips of integers, for lossless packs. Each number is predicted from its neighbours in all
 * channels by fitted weights; residuals are range-coded, in contexts of the residuals nearby. Private to libretex;
 * described in retex-pack(5). */
#ifndef RETEX_PACK_MODEL_H
#define RETEX_PACK_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "pack/planes.h"

enum { RETEX_PACK_MODEL_CHANNELS_MAX = 8 };

typedef struct RetexPackModelStrip {
    int width, rows, channels;
    int32_t *numbers[RETEX_PACK_MODEL_CHANNELS_MAX];      /* by channel: width x rows */
    unsigned char *shifts[RETEX_PACK_MODEL_CHANNELS_MAX]; /* each number is a multiple of 2^shift; NULL: shift 0 */
} RetexPackModelStrip;

/* Allocate the numbers, and the shifts of channels on a lattice. Returns 1, or 0 if memory runs out; call
 * retex_pack_model_free in both cases. */
int retex_pack_model_alloc(RetexPackModelStrip *strip, int width, int rows, int channels, const RetexPackMap *maps);
void retex_pack_model_free(RetexPackModelStrip *strip);

/* Encode into *data, malloc'ed, or NULL if all numbers are 0. Returns the number of bytes, or -1 if memory runs out. */
long retex_pack_model_encode(unsigned char **data, const RetexPackModelStrip *strip);

/* Decode into strip->numbers. Returns 1, 0 if the data is damaged, or -1 if memory runs out. */
int retex_pack_model_decode(const RetexPackModelStrip *strip, const unsigned char *data, size_t bytes);

#endif
