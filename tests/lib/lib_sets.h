/* Textures laid by hand, and comparisons of sets. */
#ifndef LIB_SETS_H
#define LIB_SETS_H

#include "lib_test.h"

/* Let random colours be what textures show at every footprint, every other one and so on; 0: at none. */
void lay_random(RetexSet *set, int every);
void expect_equal_part(const RetexSet *a, int part_a, const RetexSet *b, int part_b);
void expect_equal_terms(const RetexSet *a, const RetexSet *b);
void expect_equal_mixtures(const RetexSet *a, const RetexSet *b);
void expect_equal_sets(const RetexSet *a, const RetexSet *b);
/* What is laid on them, and what says where. */
void expect_equal_laid(const RetexSet *a, const RetexSet *b);

#endif
