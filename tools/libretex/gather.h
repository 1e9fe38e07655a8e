/* Images of a set and of samples, brought together from wherever they are. Private to libretex. */
#ifndef LIBRETEX_GATHER_H
#define LIBRETEX_GATHER_H

#include <retex/set.h>

typedef struct Gathered {
    int part, footprint; /* of the set, or -1; of the samples, or -1 */
    RetexImage *image;   /* of its size: where it goes if it has pixels, which are 0; */
    int spooled;         /* else its number in the spool */
} Gathered;

/* Of these images every row. set, samples and spool may be NULL where none of them needs it. */
int gather(const Gathered *images, int count, const RetexSet *set, const RetexSamples *samples, RetexSpool *spool,
           int nthreads, RetexError *err);

#endif
