/* Putting a compact set together. Private to libretex. */
#ifndef RETEX_LIBRETEX_COMPACT_BUILD_H
#define RETEX_LIBRETEX_COMPACT_BUILD_H

#include "compact_light.h"

/* How much smaller than the picture the images of each kind are. */
typedef struct CompactScales {
    int clusters[COMPACT_KINDS]; /* footprints and weights; those of later ones must be the same */
    int gains[COMPACT_KINDS];
    int split[COMPACT_KINDS]; /* 1: light that goes on has weights of its own */
} CompactScales;

int compact_build(RetexSet **result, const CompactLight *light, const CompactScales *scales, int nthreads,
                  RetexError *err);

/* A new set with all that another says of itself, and no parts. */
int compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err);
int compact_copy_part(RetexSet *set, const RetexPart *part, int *index, RetexError *err);

#endif
