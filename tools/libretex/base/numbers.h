/* Numbers that are no colour, and what readers do with them.
 *
 * Sets, samples, streams and packs: a value that is not finite ends the reading, with the part and the place named, for
 * it would spread over the picture, and no tool writes one. Only depth is infinite where nothing is hit; NaN it is not.
 * Pictures, which retex-diff compares, are read as they are. */
#ifndef RETEX_BASE_NUMBERS_H
#define RETEX_BASE_NUMBERS_H

#include <retex/set.h>

typedef enum RetexNumbers { RETEX_ANY_NUMBERS, RETEX_NO_NAN, RETEX_FINITE } RetexNumbers;

/* What a part of that name may hold. */
RetexNumbers retex_numbers_of_part(const char *name);

/* The first of count samples, stored in this machine's byte order, that is not allowed; count where all are. They need
 * not be aligned. */
size_t retex_numbers_find(const void *samples, RetexPixelType type, size_t count, RetexNumbers allowed);

/* That value, in words: file may be NULL; channel is a letter or a name. */
int retex_numbers_fail(RetexError *err, const char *file, const char *part, const char *channel, int x, int y,
                       float value);

/* Check pixels x0 <= x < x1 of row y of a part, which row begins with pixel 0 of. */
int retex_numbers_check_row(const RetexPart *part, const float *row, int x0, int x1, int y, RetexError *err);

/* In numbers_kernel.c: whether any of them is infinite or NaN. */
int retex_halves_are_odd(const void *samples, size_t count);
int retex_floats_are_odd(const void *samples, size_t count);

#endif
