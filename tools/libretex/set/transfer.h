/* Images of a set and of samples, brought together from wherever they are, or made of it on the way. Private to
 * libretex. */
#ifndef RETEX_SET_TRANSFER_H
#define RETEX_SET_TRANSFER_H

#include "set/rows.h"

typedef struct RetexImageTransfer {
    int part, footprint; /* of the set, or -1; of the samples, or -1 */
    RetexImage *image;   /* of its size: where it goes if it has pixels, which are 0; */
    int store_image;         /* else its number in the band store */
} RetexImageTransfer;

/* Of these images every row. set, samples and store may be NULL where none of them needs it. */
int retex_transfer_images(const RetexImageTransfer *images, int count, const RetexSet *set, const RetexSamples *samples,
                          RetexBandStore *store, int nthreads, RetexError *err);

/* Makes rows y0 <= y < y1 of an image, into `to`, which is black; of what a reader has that is this call's alone. */
typedef int RetexComputeRows(void *context, RetexRowReader *reader, const RetexImageTransfer *image, int y0, int y1,
                             float *to, RetexError *err);

/* The same of rows that are made, in bands on all cores. */
int retex_compute_images(const RetexImageTransfer *images, int count, RetexComputeRows *make, void *context,
                         const RetexSet *set, const RetexSamples *samples, RetexBandStore *store, int nthreads,
                         RetexError *err);

#endif
