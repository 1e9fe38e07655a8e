/* Some rows of a set, as a set, so that not all of it must be in memory. Private to libretex. */
#ifndef RETEX_SET_STRIP_H
#define RETEX_SET_STRIP_H

#include "set/set.h"

typedef struct RetexSetStrip RetexSetStrip;

/* Open a strip of at most most_rows rows of `whole`, which stays the caller's. copies: 1 = rows of parts in memory are
 * copied, so that they may be changed; 0 = they are shared. */
int retex_set_strip_open(RetexSetStrip **strip, const RetexSet *whole, int most_rows, int copies, RetexError *err);
void retex_set_strip_close(RetexSetStrip **strip); /* NULL and pointers to NULL are fine */

/* Load rows first <= y < first + count: *rows is a set with count rows, owned by the strip and valid until the next
 * call. It has the rows of all parts that have the size of the picture, and no pixels of others. All else is as in
 * `whole`. */
int retex_set_strip_load(RetexSet **rows, RetexSetStrip *strip, int first, int count, int nthreads, RetexError *err);

/* The numbers of a part that is in memory, in its pixel number `at`. */
static inline float *retex_pixel_at(const RetexSet *rows, int part, size_t at)
{
    const RetexImage *im = &rows->parts[part].image;
    return im->pixels + at * (size_t)im->channels;
}

/* Read rows of one part, from `first` on, wherever the set keeps them: as many as the image, which is allocated,
 * has. */
int retex_set_part_rows(RetexImage *image, const RetexSet *set, int part, int first, RetexError *err);

#endif
