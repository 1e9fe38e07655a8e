/* Reading sets, and samples, from EXR files. Private to libretex. */
#ifndef RETEX_SET_READ_H
#define RETEX_SET_READ_H

#include <retex/set.h>

#include "io/input.h"

/* Like retex_set_read, or with open = 1 like retex_set_open, for an input that is not a pack; also of samples. *input
 * is NULL afterwards where the set keeps it open. */
int retex_set_read_exr(RetexInput **input, RetexSet **set, int open, int nthreads, RetexError *err);

/* As retex_set_check. */
int retex_set_check_exr(RetexInput *input, int nthreads, RetexError *err);

#endif
