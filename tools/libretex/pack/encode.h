/* A set's parts, encoded as a pack has them. Private to libretex. */
#ifndef RETEX_PACK_ENCODE_H
#define RETEX_PACK_ENCODE_H

#include "pack/plan.h"

/* Encoding one part. */
typedef struct PackItem {
    const RetexPart *part;
    PackPart *packed;
    unsigned char **chunks; /* malloc'ed each, but those of a JPEG, which lie in jpeg.data */
    PackJpeg jpeg;
    uint32_t crc; /* of its samples */
    int code;
    RetexError err;
} PackItem;

typedef struct PackEncoded {
    const RetexSet *set;
    PackPart *packed;
    PackItem *items;
    int nitems;       /* one for each part, and one more where part 0 is tried in two ways: without the terms */
    PackJpeg picture; /* of a lossless pack: for viewers only */
    int *jobs;        /* pairs: part and band */
    int njobs;
    int *codes; /* by job */
} PackEncoded;

/* Encode a set, compact or not, which is to stay as long as what comes of it; to be freed also after a failure. grain:
 * NULL = every part keeps its bits. */
int pack_encode(PackEncoded *encoded, const RetexSet *set, const PackGrain *grain, int nthreads, RetexError *err);
void pack_encoded_free(PackEncoded *encoded); /* one that is all zeros is fine */

#endif
