/* Building a compact set with given scales. Private to libretex. */
#ifndef RETEX_COMPACT_BUILD_H
#define RETEX_COMPACT_BUILD_H

#include "compact/clusters.h"
#include "compact/scales.h"

int retex_compact_build(RetexSet **result, const RetexCompactLight *light, const RetexCompactScales *scales,
                        int nthreads, RetexError *err);

/* Copy footprints, mixtures and terms of a set whose parts have the same numbers; but not the term of role PICTURE, as
 * what is stored with losses is no longer the sum that part 0 stands for. */
int retex_compact_copy_terms(RetexSet *copy, const RetexSet *set, RetexError *err);
/* A copy of a set without the denoising data. */
int retex_compact_copy_set(RetexSet **copy, const RetexSet *set, RetexError *err);
/* A copy of a set's properties, without parts, footprints, mixtures and terms. */
int retex_compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err);
int retex_compact_copy_part(RetexSet *set, const RetexSet *from, int part, int *index, RetexError *err);

#endif
