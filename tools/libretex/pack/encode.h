/* A set's parts, encoded as a pack has them. Private to libretex. */
#ifndef RETEX_PACK_ENCODE_H
#define RETEX_PACK_ENCODE_H

#include "pack/plan.h"

/* Encoding one part. */
typedef struct RetexPackItem {
    const RetexPart *part;
    RetexPackPart *packed;
    unsigned char **chunks; /* malloc'ed each, but those of a JPEG, which lie in jpeg.data */
    RetexPackJpeg jpeg;
    uint32_t crc; /* of its samples */
    int code;
    RetexError err;
} RetexPackItem;

typedef struct RetexPackEncoded {
    const RetexSet *set;
    RetexPackPart *packed;
    RetexPackItem *items;
    int nitems;            /* one for each part, and one more where part 0 is tried in two ways: without the terms */
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
