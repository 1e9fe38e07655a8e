/* Recombination with the original textures, some rows at a time. Private to libretex. */
#ifndef RETEX_RETEXTURE_COMBINE_ROWS_H
#define RETEX_RETEXTURE_COMBINE_ROWS_H

#include <retex/set.h>

/* Returns 1 if the set has all parts that its terms need, as far as that is known without samples; 0 if it has not; or
 * RETEX_ENOMEM. */
int retex_combine_check(const RetexSet *set, RetexError *err);

/* Compute rows y0 <= y < y1, RGB interleaved, with all terms: the result of retex_combine without samples. Uses this
 * thread alone; packs call it from several threads. */
int retex_combine_original_rows(float *out, const RetexSet *set, int y0, int y1, RetexError *err);

#endif
