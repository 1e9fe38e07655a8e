/* Bands of whole numbers, predicted by a fit to their neighbours in all channels and coded by a model of how large the
 * residuals are: what lossless packs are made of. Private to libretex; described in retex-pack(5). */
#ifndef RETEX_PACK_MODEL_H
#define RETEX_PACK_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "pack/planes.h"

enum { RETEX_PACK_MODEL_CHANNELS_MAX = 8 };

typedef struct RetexPackModelBand {
    int width, rows, channels;
    int32_t *numbers[RETEX_PACK_MODEL_CHANNELS_MAX];      /* width x rows of each channel */
    unsigned char *shifts[RETEX_PACK_MODEL_CHANNELS_MAX]; /* numbers are multiples of 2^shift; NULL: of 1 */
} RetexPackModelBand;

/* Room for the numbers, and for the shifts of those on a lattice: 1, or 0 without memory; free in both cases. */
int retex_pack_model_alloc(RetexPackModelBand *band, int width, int rows, int channels, const RetexPackMap *maps);
void retex_pack_model_free(RetexPackModelBand *band);

/* Compress into *data, malloc'ed, which is NULL if all numbers are 0. Returns the bytes, or -1 without memory. */
long retex_pack_model_encode(unsigned char **data, const RetexPackModelBand *band);

/* And back, into the numbers: 1, 0 where the data is damaged, -1 without memory. */
int retex_pack_model_decode(const RetexPackModelBand *band, const unsigned char *data, size_t bytes);

#endif
