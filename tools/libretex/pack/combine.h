/* Part 0 of a lossless pack as what differs from the picture that the set's terms give with the original textures: of a
 * denoised set nothing does. Private to libretex; the arithmetic, to the bit, is part of the format: retex-pack(5). */
#ifndef RETEX_PACK_COMBINE_H
#define RETEX_PACK_COMBINE_H

#include <retex/set.h>

#include "pack/model.h"

/* 1: part 0 is a picture, and all that its terms need is there, of its size and not part 0 itself; else 0; or
 * RETEX_ENOMEM. Looks at what the set says of its parts, not at their samples. */
int retex_pack_combine_fits(const RetexSet *set, RetexError *err);

/* 1: the halves among what terms need, all of it in memory, are what will be read back: they have been rounded. */
int retex_pack_combine_is_stored(const RetexSet *set, int nthreads);

/* Take the numbers of the recombined picture from those of part 0, whose rows from y0 on the strip has. *finite is
 * cleared where a value of the picture is infinite or not a number. */
int retex_pack_combine_subtract(RetexPackModelStrip *strip, const RetexSet *set, int y0, int *finite, RetexError *err);
/* And back. Rows of the terms' parts come from memory, or else from the set's source. */
int retex_pack_combine_add(RetexPackModelStrip *strip, const RetexSet *set, int y0, RetexError *err);

#endif
