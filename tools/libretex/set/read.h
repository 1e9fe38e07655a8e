/* Sets, samples and streams of both, from EXR files that are open. Private to libretex. */
#ifndef RETEX_SET_READ_H
#define RETEX_SET_READ_H

#include <retex/samples.h>

#include "io/input.h"

/* As retex_set_read, or, with open, retex_set_open, from an input that is no pack: each of set and samples may be NULL.
 * *input is NULL afterwards where the set or the samples keep it. */
int retex_set_read_exr(RetexInput **input, RetexSet **set, RetexSamples **samples, int open, int nthreads,
                       RetexError *err);

/* As retex_set_check. */
int retex_set_check_exr(RetexInput *input, int nthreads, RetexError *err);

#endif
