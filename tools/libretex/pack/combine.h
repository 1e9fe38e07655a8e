/* Part 0 of a lossless pack as the difference from the recombination of the terms with the original textures, which is
 * 0 for denoised sets. Private to libretex; the arithmetic is part of the format to the bit: retex-pack(5). */
#ifndef RETEX_PACK_COMBINE_H
#define RETEX_PACK_COMBINE_H

#include <retex/set.h>

#include "pack/model.h"

/* 1 if part 0 is a picture and all parts that the terms need have its size and are not part 0; else 0, or RETEX_ENOMEM.
 * Samples are not read. */
int retex_pack_combine_fits(const RetexSet *set, RetexError *err);

/* 1 if all half parts that the terms need, which are in memory, hold values that halves can represent. */
int retex_pack_combine_is_stored(const RetexSet *set, int nthreads);

/* Subtract the recombined picture from the band, which has rows of part 0 from y0 on. *finite is cleared if a
 * recombined value is infinite or NaN. */
int retex_pack_combine_subtract(RetexPackModelBand *band, const RetexSet *set, int y0, int *finite, RetexError *err);
/* The inverse. Rows of the terms' parts come from memory or from the set's source. */
int retex_pack_combine_add(RetexPackModelBand *band, const RetexSet *set, int y0, RetexError *err);

#endif
