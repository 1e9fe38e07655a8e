/* Encodes all parts of a set as slices of a pack. Private to libretex. */
#ifndef RETEX_PACK_ENCODE_H
#define RETEX_PACK_ENCODE_H

#include "pack/plan.h"

/* One part, encoded. */
typedef struct RetexPackItem {
    const RetexPart *part;
    RetexPackPart *packed;
    unsigned char **slices; /* malloc'ed each, except a JPEG's, which point into jpeg.data */
    RetexPackJpeg jpeg;
    RetexImage decoded; /* of light, while its gains are encoded */
    uint32_t crc;       /* of the part's samples */
    int code;
    RetexError err;
} RetexPackItem;

typedef struct RetexPackEncoded {
    const RetexSet *set;
    RetexPackPart *packed;
    RetexPackItem *items;
    RetexPackJpeg picture; /* for viewers, if the pack is lossless */
    int effort;            /* of compressing planes */
    int gains;             /* 1: gains are encoded, 0: all else */
    int *jobs;             /* pairs: part and strip */
    int njobs;
    int *codes; /* by job: error code */
} RetexPackEncoded;

/* Encode the parts of a set, compact or not. The set must outlive the result; free the result after failures too.
 * quantizer: NULL = lossless. */
int retex_pack_encode(RetexPackEncoded *encoded, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                      RetexError *err);
void retex_pack_encoded_free(RetexPackEncoded *encoded); /* accepts one that is all zeros */

/* Fill black pixels of an image with the mean of the other pixels of their 8 x 8 block. A mask restores them, so their
 * levels are free; the mean costs few bytes and avoids ringing at edges of black areas. */
void retex_pack_fill_black(float *levels, const RetexImage *im);
/* Make those pixels of what was decoded black, as the mask does. */
void retex_pack_keep_black(RetexImage *decoded, const RetexImage *im);

#endif
