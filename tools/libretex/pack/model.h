/* Bands of whole numbers, predicted by a fit to their neighbours in all channels and coded by a model of how large the
 * residuals are: what lossless packs are made of. Private to libretex; described in retex-pack(5). */
#ifndef RETEX_PACK_MODEL_H
#define RETEX_PACK_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "pack/planes.h"

enum { PACK_MODEL_CHANNELS_MAX = 8 };

typedef struct PackModelBand {
    int width, rows, channels;
    int32_t *numbers[PACK_MODEL_CHANNELS_MAX];      /* width x rows of each channel */
    unsigned char *shifts[PACK_MODEL_CHANNELS_MAX]; /* numbers are multiples of 2^shift; NULL: of 1 */
} PackModelBand;

/* Room for the numbers, and for the shifts of those on a lattice: 1, or 0 without memory; free in both cases. */
int pack_model_alloc(PackModelBand *band, int width, int rows, int channels, const PackMap *maps);
void pack_model_free(PackModelBand *band);

/* Compress into *data, malloc'ed, which is NULL if all numbers are 0. Returns the bytes, or -1 without memory. */
long pack_model_encode(unsigned char **data, const PackModelBand *band);

/* And back, into the numbers: 1, 0 where the data is damaged, -1 without memory. */
int pack_model_decode(const PackModelBand *band, const unsigned char *data, size_t bytes);

#endif
