/* An open EXR file as the source of a set's parts. Private to libretex. */
#ifndef RETEX_SET_EXR_SOURCE_H
#define RETEX_SET_EXR_SOURCE_H

#include "exr/io.h"
#include "set/manifest.h"
#include "set/source.h"

/* The parts of a source. requests[i] names the channels that are read as part i, and its checksums. Rows are compared
 * with the checksums of their bands before they are returned. Where bands have none, the whole part is compared when
 * the first of its rows is read, on nthreads threads. */
typedef struct RetexExrSourceParts {
    RetexExr *exr;
    RetexInput *input;
    RetexExrRequest *requests;
    int count;
    RetexBandSums sums; /* requests point into it */
    int nthreads;
} RetexExrSourceParts;

/* Open a source. Takes ownership of exr, input, requests and sums, whatever it returns. */
int retex_exr_source_open(RetexSetSource **source, const RetexExrSourceParts *parts, RetexError *err);

#endif
