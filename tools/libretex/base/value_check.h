/* Numbers that are no colour, and what readers do with them.
 *
 * Sets, samples, streams and packs: a value that is not finite ends the reading, with the part and the place named, for
 * it would spread over the picture, and no tool writes one. Only depth is infinite where nothing is hit; NaN it is not.
 * Pictures, which retex-diff compares, are read as they are. */
#ifndef RETEX_BASE_VALUE_CHECK_H
#define RETEX_BASE_VALUE_CHECK_H

#include <retex/set.h>

typedef enum RetexAllowedValues { RETEX_ALLOW_ANY, RETEX_ALLOW_INFINITE, RETEX_ALLOW_FINITE } RetexAllowedValues;

/* What a part of that name may hold. */
RetexAllowedValues retex_allowed_values(const char *name);

/* The first of count samples, stored in this machine's byte order, that is not allowed; count where all are. They need
 * not be aligned. */
size_t retex_find_disallowed(const void *samples, RetexPixelType type, size_t count, RetexAllowedValues allowed);

/* That value, in words: file may be NULL; channel is a letter or a name. */
int retex_fail_disallowed(RetexError *err, const char *file, const char *part, const char *channel, int x, int y,
                          float value);

/* Check pixels x0 <= x < x1 of row y of a part, which row begins with pixel 0 of. */
int retex_check_row_values(const RetexPart *part, const float *row, int x0, int x1, int y, RetexError *err);

/* In value_check_kernel.c: whether any of them is infinite or NaN. */
int retex_halves_have_nonfinite(const void *samples, size_t count);
int retex_floats_have_nonfinite(const void *samples, size_t count);

#endif
