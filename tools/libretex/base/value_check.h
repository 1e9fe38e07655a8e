/* The values that a part may hold, and what readers do with others.
 *
 * Sets, samples, streams and packs: reading fails at the first value that is not finite, with the part and the pixel in
 * the message, because the value would spread over the picture; the tools never write such values. Only the part
 * "depth" may be infinite, where nothing is hit, but not NaN. Pictures that retex-diff compares are read unchecked. */
#ifndef RETEX_BASE_VALUE_CHECK_H
#define RETEX_BASE_VALUE_CHECK_H

#include <retex/set.h>

typedef enum RetexAllowedValues { RETEX_ALLOW_ANY, RETEX_ALLOW_INFINITE, RETEX_ALLOW_FINITE } RetexAllowedValues;

/* The values that a part of that name may hold. */
RetexAllowedValues retex_allowed_values(const char *name);

/* The index of the first of count samples, stored in this machine's byte order, that is not allowed; count where all
 * are allowed. The samples need not be aligned. */
size_t retex_find_disallowed(const void *samples, RetexPixelType type, size_t count, RetexAllowedValues allowed);

/* Fill err with a message about that value. file may be NULL; channel is a letter or a name. */
int retex_fail_disallowed(RetexError *err, const char *file, const char *part, const char *channel, int x, int y,
                          float value);

/* Check pixels x0 <= x < x1 of row y of a part; row points to pixel 0. */
int retex_check_row_values(const RetexPart *part, const float *row, int x0, int x1, int y, RetexError *err);

/* In value_check_kernel.c: 1 if any sample is infinite or NaN. */
int retex_halves_have_nonfinite(const void *samples, size_t count);
int retex_floats_have_nonfinite(const void *samples, size_t count);
/* 1 if any is not 0. */
int retex_floats_have_nonzero(const void *samples, size_t count);

#endif
