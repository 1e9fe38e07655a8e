/* Copies or computes images of a set, into memory or into a band store. Private to libretex. */
#ifndef RETEX_SET_TRANSFER_H
#define RETEX_SET_TRANSFER_H

#include <retex/host/band_store.h>

#include "set/rows.h"

typedef struct RetexImageTransfer {
    int part;            /* of the set, which is copied or computed */
    RetexImage *image;   /* destination, of the image's size: its pixels, which are 0, if it has any; */
    int store_image;     /* else this image of the band store */
} RetexImageTransfer;

/* Copy all rows of these images from wherever they are. store may be NULL where no image needs it. */
int retex_transfer_images(const RetexImageTransfer *images, int count, const RetexSet *set, RetexBandStore *store,
                          int nthreads, RetexError *err);

/* Computes rows y0 <= y < y1 of an image into `to`, which is 0. `reader` belongs to this call alone. */
typedef int RetexComputeRows(void *context, RetexRowReader *reader, const RetexImageTransfer *image, int y0, int y1,
                             float *to, RetexError *err);

/* Compute all rows of these images, in bands on all threads. */
int retex_compute_images(const RetexImageTransfer *images, int count, RetexComputeRows *make, void *context,
                         const RetexSet *set, RetexBandStore *store, int nthreads, RetexError *err);

#endif
