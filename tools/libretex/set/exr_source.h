/* An open EXR file as the source of a set's parts, and of samples. Private to libretex. */
#ifndef RETEX_SET_EXR_SOURCE_H
#define RETEX_SET_EXR_SOURCE_H

#include "exr/io.h"
#include "set/manifest.h"
#include "set/source.h"

/* What it is made of. requests[i] names the channels of what is read as part i, and its checksums: rows are compared
 * with those of their bands before anyone sees them. Where these are not known the whole part is, when the first of its
 * rows is wanted, by so many threads. */
typedef struct RetexExrSourceParts {
    RetexExr *exr;
    RetexInput *input;
    RetexExrRequest *requests;
    int count;
    RetexBandSums sums; /* that requests point to */
    int nthreads;
} RetexExrSourceParts;

/* Takes exr, input, requests and sums over, whatever it returns. */
int retex_exr_source_open(RetexSetSource **source, const RetexExrSourceParts *parts, RetexError *err);
/* The same for one more, who closes it too. */
RetexSetSource *retex_exr_source_retain(RetexSetSource *source);

#endif
