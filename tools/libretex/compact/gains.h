/* One radiance for all terms of a kind, and which share of it is each one's. Private to libretex. */
#ifndef RETEX_COMPACT_GAINS_H
#define RETEX_COMPACT_GAINS_H

#include "compact/light.h"

/* All light of a kind, further hits on COMPACT_GREY, into an image of the set's size. */
int compact_sum_light(RetexImage *sum, const CompactLight *light, const CompactKind *kind, int nthreads,
                      RetexError *err);

/* The gain that makes a term, one of the kind's, or the light of all clusters (-1), of the sum: RGB at a scale. */
int compact_make_gain(RetexImage *gain, const CompactLight *light, const CompactKind *kind, const RetexImage *sum,
                      int number, CompactMixed mixed, int scale, int nthreads, RetexError *err);

/* The same by rows of the picture, `first` and as many as light->set has; sums and gains are of the whole. */
void compact_sum_rows(RetexImage *sum, const CompactLight *light, const CompactKind *kind, int first, int nthreads);
int compact_gain_begin(RetexImage *gain, const CompactLight *light, int scale, RetexError *err);
int compact_gain_rows(RetexImage *gain, const CompactLight *light, const CompactKind *kind, const RetexImage *sum,
                      int number, CompactMixed mixed, int scale, int first, int nthreads, RetexError *err);
int compact_gain_end(RetexImage *gain, RetexError *err);

#endif
