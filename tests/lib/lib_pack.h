/* Round trips of packs in memory. */
#ifndef LIB_PACK_H
#define LIB_PACK_H

#include "lib_pack_read.h"
#include "lib_test.h"

/* Pack a set into memory. */
unsigned char *pack(const RetexSet *set, const RetexPackParams *params, size_t *bytes, int nthreads);
RetexPackParams lossless(void);
/* Ground in perspective, which one target covers but for a round hole, in parallelograms of whole pixels; u is
 * periodic. */
RetexSet *set_of_axes(int width, int height);
RetexSet *unpack(const unsigned char *data, size_t bytes);

/* The largest difference between the values of two parts, relative to the largest of both values and `floor`. */
double part_difference(const RetexPart *a, const RetexPart *b, double floor);

#endif
