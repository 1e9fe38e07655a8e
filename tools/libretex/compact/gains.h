/* One radiance for all terms of a kind, and which share of it is each one's. Private to libretex. */
#ifndef RETEX_COMPACT_GAINS_H
#define RETEX_COMPACT_GAINS_H

#include "compact/light.h"

/* All light of a kind, further hits on RETEX_COMPACT_GREY, into an image of the set's size. */
int retex_compact_sum_light(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int nthreads,
                            RetexError *err);

/* The gain that makes a term, one of the kind's, or the light of all clusters (-1), of the sum: RGB at a scale. */
int retex_compact_make_gain(RetexImage *gain, const RetexCompactLight *light, const RetexCompactKind *kind,
                            const RetexImage *sum, int number, RetexCompactMixed mixed, int scale, int nthreads,
                            RetexError *err);

/* The same by rows of the picture, `first` and as many as light->set has; sums and gains are of the whole. */
void retex_compact_sum_rows(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int first,
                            int nthreads);
int retex_compact_gain_begin(RetexImage *gain, const RetexCompactLight *light, int scale, RetexError *err);
int retex_compact_gain_rows(RetexImage *gain, const RetexCompactLight *light, const RetexCompactKind *kind,
                            const RetexImage *sum, int number, RetexCompactMixed mixed, int scale, int first,
                            int nthreads, RetexError *err);
int retex_compact_gain_end(RetexImage *gain, RetexError *err);

#endif
