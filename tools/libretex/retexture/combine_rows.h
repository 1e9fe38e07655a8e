/* Rows of the picture that a set's terms give with its original textures. Private to libretex. */
#ifndef RETEX_RETEXTURE_COMBINE_ROWS_H
#define RETEX_RETEXTURE_COMBINE_ROWS_H

#include <retex/set.h>

/* 1 where the set has what its terms need, as far as that can be told without its samples; 0 where it has not; or
 * RETEX_ENOMEM. */
int retex_combine_check(const RetexSet *set, RetexError *err);

/* Rows y0 <= y < y1, RGB interleaved, with all terms: what retex_combine makes without samples. In this thread alone,
 * as packs do it, whose bands are spread over threads. */
int retex_combine_original_rows(float *out, const RetexSet *set, int y0, int y1, RetexError *err);

#endif
