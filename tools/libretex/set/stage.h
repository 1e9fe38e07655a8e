/* Parts of a file to be whose pixels are in another one that is open: taken from there before the first byte is
 * written, which the checksums of all come before. Private to libretex. */
#ifndef RETEX_SET_STAGE_H
#define RETEX_SET_STAGE_H

#include "exr/io.h"
#include "set/gather.h"

typedef struct SetStage {
    RetexSpool *spool; /* what is as large as the picture */
    RetexImage *small; /* what is smaller */
    Gathered *images;
    int count;
} SetStage;

/* At most so many parts. */
int set_stage_open(SetStage *stage, int most, RetexError *err);
void set_stage_close(SetStage *stage); /* once they are written */

/* Give an EXR part the place where a part of the set will be, or the samples of a footprint; the other is -1. The spool
 * is made near the file to be, and not compressed where that is not either. */
int set_stage_add(SetStage *stage, RetexExrPart *exr, int part, int footprint, int width, int height, const char *near,
                  int compress, RetexError *err);
/* Bring all of them there. */
int set_stage_fill(SetStage *stage, const RetexSet *set, const RetexSamples *samples, int nthreads, RetexError *err);

#endif
