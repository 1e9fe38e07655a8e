/* One radiance for all terms of a kind, and the gain of each term. Private to libretex. */
#ifndef RETEX_COMPACT_GAINS_H
#define RETEX_COMPACT_GAINS_H

#include "compact/light.h"

/* All light of a kind and lamps, interreflections on RETEX_COMPACT_GREY, as an image of the set's size. */
int retex_compact_sum_light(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int lamps,
                            int nthreads, RetexError *err);

/* A kind's terms are numbered: single-hit light by lamps, then gains. */
static inline int retex_compact_term_lamps(const RetexCompactLight *light, const RetexCompactKind *kind,
                                           RetexCompactMixed mixed, int number)
{
    return number < light->nlamps ? number : kind->gains[mixed][number - light->nlamps].lamps;
}

/* The light of a term, as an image of the set's size. */
int retex_compact_term_light(RetexImage *image, const RetexCompactLight *light, const RetexCompactKind *kind,
                             RetexCompactMixed mixed, int number, RetexError *err);
/* The ratio of an image to another, RGB, at a scale. */
int retex_compact_share(RetexImage *share, const RetexImage *of, const RetexImage *all, int scale, int nthreads,
                        RetexError *err);

/* The same in strips: light->set has rows of the picture from `first` on; sum and gain are of the whole picture. */
void retex_compact_sum_rows(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int lamps,
                            int first, int nthreads);
int retex_compact_gain_begin(RetexImage *gain, const RetexCompactLight *light, int scale, RetexError *err);
int retex_compact_gain_rows(RetexImage *gain, const RetexCompactLight *light, const RetexCompactKind *kind,
                            const RetexImage *sum, int number, RetexCompactMixed mixed, int scale, int first,
                            int nthreads, RetexError *err);
int retex_compact_gain_end(RetexImage *gain, const RetexImage *sum, int scale, RetexError *err);

#endif
