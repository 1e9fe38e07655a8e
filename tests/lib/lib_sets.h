/* Samples made by hand, and comparisons of sets and samples. */
#ifndef LIB_SETS_H
#define LIB_SETS_H

#include "lib_test.h"

/* Samples for some of a set's footprints: every other one, or those of the first target. */
RetexSamples *make_samples(const RetexSet *set, int every);
void expect_equal_part(const RetexSet *a, int part_a, const RetexSet *b, int part_b);
void expect_equal_terms(const RetexSet *a, const RetexSet *b);
void expect_equal_mixtures(const RetexSet *a, const RetexSet *b);
void expect_equal_sets(const RetexSet *a, const RetexSet *b);
void expect_equal_samples(const RetexSamples *a, const RetexSamples *b);

#endif
