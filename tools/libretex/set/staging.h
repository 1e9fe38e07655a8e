/* Staging: parts to be written whose pixels are in another file that is open. They are copied before the first byte is
 * written, because the manifest, which stands first, has the checksums of all parts. Private to libretex. */
#ifndef RETEX_SET_STAGING_H
#define RETEX_SET_STAGING_H

#include "exr/io.h"
#include "set/transfer.h"

typedef struct RetexStaging {
    RetexBandStore *store; /* images as large as the picture */
    RetexImage *reduced; /* smaller images */
    RetexImageTransfer *images;
    int count;
} RetexStaging;

/* Prepare staging for at most `most` parts. */
int retex_staging_open(RetexStaging *staging, int most, RetexError *err);
void retex_staging_close(RetexStaging *staging); /* after the parts have been written */

/* Reserve the place where a part of the set, or the samples of a footprint, will be staged, and let the EXR part refer
 * to it; the other index is -1. The band store is created near the file to be written, and compressed as that file
 * is. */
int retex_staging_add(RetexStaging *staging, RetexExrPart *exr, int part, int footprint, int width, int height,
                      const char *near, RetexExrCompression compress, RetexError *err);
/* Copy all staged images. */
int retex_staging_fill(RetexStaging *staging, const RetexSet *set, const RetexSamples *samples, int nthreads,
                       RetexError *err);

#endif
