/* Sets of layout footprints for tests of compacting, and expected results. */
#ifndef LIB_COMPACT_H
#define LIB_COMPACT_H

#include "compact/compact.h"
#include "lib_footprints.h"

enum { WIDE = 50, HIGH = 37 }; /* no multiple of 8 */

float *at(RetexSet *set, int part, int x, int y);

/* Light over two decades, with a gradient and a region without light. */
void fill_light(RetexSet *set, int part, uint32_t *seed);

/* For each target: this number of sharp and broad clusters, two footprints of interreflection, and light with one and
 * two further hits. With several targets, also light with one more hit on any of them. */
RetexSet *whole_set(int ntargets, int count);
RetexSet *compacted(const RetexSet *set, int broad, int later, int gain);

/* The set's picture with constant textures, or the originals. */
RetexImage picture(const RetexSet *set, const float *constant);

/* Equal within a thousandth of the brightest value. Frees both. */
void expect_same_image(RetexImage one, RetexImage other);

/* As equal, with the same constant textures. */
void expect_same_picture(const RetexSet *a, const RetexSet *b, const float *constant);

/* The albedo that further hits have in a compact set where its gains are reduced: see retex-set(5). */
static const float grey[] = {0.6f, 0.6f, 0.6f};
static const float white[] = {1, 1, 1}, bright[] = {0.9f, 0.6f, 0.1f};

/* Rendered with a box filter, four sharp clusters per pixel. */
RetexSet *start_sharp_set(void);

/* A wall. The clusters of each pixel are its quarters. Their positions and light have errors of this many pixels and
 * this share, as from this number of samples of equal light. At x = 20 all have an error of a tenth of a pixel. */
RetexSet *set_of_wall(float noise, int samples);

#endif
