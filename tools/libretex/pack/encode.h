/* Encoding the parts of a set for a pack. Private to libretex. */
#ifndef RETEX_PACK_ENCODE_H
#define RETEX_PACK_ENCODE_H

#include "pack/plan.h"

/* One part, encoded. */
typedef struct RetexPackItem {
    const RetexPart *part;
    RetexPackPart *packed;
    unsigned char **chunks; /* each malloc'ed; those of a JPEG point into jpeg.data */
    RetexPackJpeg jpeg;
    uint32_t crc; /* of its samples */
    int code;
    RetexError err;
} RetexPackItem;

typedef struct RetexPackEncoded {
    const RetexSet *set;
    RetexPackPart *packed;
    RetexPackItem *items;
    int nitems;            /* one for each part, and one for the second encoding of part 0, if there is one */
    RetexPackJpeg picture; /* of a lossless pack: for viewers only */
    int *jobs;             /* pairs: part and band */
    int njobs;
    int *codes; /* by job */
} RetexPackEncoded;

/* Encode the parts of a set, compact or not. The set must outlive the result; free the result after failures too.
 * quantizer: NULL = every part keeps its bits. */
int retex_pack_encode(RetexPackEncoded *encoded, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                      RetexError *err);
void retex_pack_encoded_free(RetexPackEncoded *encoded); /* one that is all zeros is fine */

#endif
