/* Parts of a file to be whose pixels are in another one that is open: taken from there before the first byte is
 * written, which the checksums of all come before. Private to libretex. */
#ifndef RETEX_SET_STAGING_H
#define RETEX_SET_STAGING_H

#include "exr/io.h"
#include "set/transfer.h"

typedef struct RetexStaging {
    RetexBandStore *store; /* what is as large as the picture */
    RetexImage *reduced; /* what is smaller */
    RetexImageTransfer *images;
    int count;
} RetexStaging;

/* At most so many parts. */
int retex_staging_open(RetexStaging *staging, int most, RetexError *err);
void retex_staging_close(RetexStaging *staging); /* once they are written */

/* Give an EXR part the place where a part of the set will be, or the samples of a footprint; the other is -1. The band
 * store is made near the file to be, and not compressed where that is not either. */
int retex_staging_add(RetexStaging *staging, RetexExrPart *exr, int part, int footprint, int width, int height,
                      const char *near, int compress, RetexError *err);
/* Bring all of them there. */
int retex_staging_fill(RetexStaging *staging, const RetexSet *set, const RetexSamples *samples, int nthreads,
                       RetexError *err);

#endif
