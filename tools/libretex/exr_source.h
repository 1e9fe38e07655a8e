/* An open EXR file as the source of a set's parts, and of samples. Private to libretex. */
#ifndef LIBRETEX_EXR_SOURCE_H
#define LIBRETEX_EXR_SOURCE_H

#include "exr_io.h"
#include "set_source.h"

/* requests[i] names the channels of what is read as part i. Takes input, exr and requests over, whatever it returns. */
int exr_source_open(RetexSetSource **source, RetexInput *input, RetexExr *exr, RetexExrRequest *requests, int count,
                    RetexError *err);
/* The same for one more, who closes it too. */
RetexSetSource *exr_source_share(RetexSetSource *source);

#endif
