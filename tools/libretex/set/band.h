/* Some rows of a set as a set of their own, so that not all of it has to be in memory. Private to libretex. */
#ifndef RETEX_SET_BAND_H
#define RETEX_SET_BAND_H

#include <retex/set.h>

typedef struct RetexSetBand RetexSetBand;

/* At most so many rows of `whole`, which stays the caller's. copies: 1 = the rows of parts in memory are copied too, so
 * that they may be changed; 0 = they are where they are. */
int retex_set_band_open(RetexSetBand **band, const RetexSet *whole, int most_rows, int copies, RetexError *err);
void retex_set_band_close(RetexSetBand **band); /* NULL and pointers to NULL are fine */

/* The rows from `first` on: a set with as many rows as its height says, the band's own until the next call. Of parts
 * that are no larger or smaller than the picture it has the rows, of others nothing. All else is as in `whole`. */
int retex_set_band_take(RetexSet **rows, RetexSetBand *band, int first, int count, int nthreads, RetexError *err);

/* Rows of one part, from wherever the set has them: as many as the image, which is allocated, has. */
int retex_set_part_rows(RetexImage *image, const RetexSet *set, int part, int first, RetexError *err);

#endif
