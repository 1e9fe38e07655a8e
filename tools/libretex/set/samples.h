/* Samples, as the rooms that read and write them need them beyond <retex/samples.h>. Private to libretex. */
#ifndef RETEX_SET_SAMPLES_H
#define RETEX_SET_SAMPLES_H

#include <retex/samples.h>

enum { RETEX_SET_FOOTPRINTS_MAX = 512 }; /* of a set, and images of samples, in files */

/* Create samples with nimages images, all unallocated; the rest is 0. *samples is NULL after a failure. */
int retex_samples_alloc(RetexSamples **samples, int nimages, RetexError *err);

/* Check that numbers and sizes of the samples agree among themselves. */
int retex_samples_are_sound(const RetexSamples *samples, RetexError *err);

#endif
