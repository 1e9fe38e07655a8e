/* Sets of layout footprints to be compacted, and what is expected of it. */
#ifndef LIB_COMPACT_H
#define LIB_COMPACT_H

#include "lib_footprints.h"

enum { WIDE = 50, HIGH = 37 }; /* no multiple of 8 */

float *at(RetexSet *set, int part, int x, int y);

/* Light of two decades, with a part that has none, and a gradient. */
void fill_light(RetexSet *set, int part, uint32_t *seed);

/* For each target: so many sharp and broad clusters, two later footprints, and light that goes on once and twice; with
 * several, once more to any of them. */
RetexSet *whole_set(int ntargets, int count);
RetexSet *compacted(const RetexSet *set, int broad, int later, int gain);

/* The set's picture with constant textures, or the originals. */
RetexImage picture(const RetexSet *set, const float *constant);

/* Within a thousandth of the brightest. */
void expect_same_picture(const RetexSet *a, const RetexSet *b, const float *constant);

/* What further hits are taken to meet where gains are too small to tell: see retex-set(5). */
static const float grey[] = {0.6f, 0.6f, 0.6f};
static const float white[] = {1, 1, 1}, bright[] = {0.9f, 0.6f, 0.1f};

/* Seen through a box filter, four sharp clusters a pixel. */
RetexSet *start_sharp_set(void);

/* A wall, each pixel in quarters whose places and light are off by so many pixels and shares, as so many samples of
 * equal light tell; at x = 20 all are off by a tenth of a pixel. */
RetexSet *set_of_wall(float noise, int samples);

#endif
