/* Packs in memory, there and back. */
#ifndef LIB_PACK_H
#define LIB_PACK_H

#include "lib_test.h"

/* Pack a set into memory. */
unsigned char *pack(const RetexSet *set, const RetexPackParams *params, size_t *bytes);
RetexPackParams lossless(void);
RetexSet *unpack(const unsigned char *data, size_t bytes);

/* Largest difference between two parts' values as a share of the larger of them and `floor`. */
double part_difference(const RetexPart *a, const RetexPart *b, double floor);

#endif
