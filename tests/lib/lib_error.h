/* The error to be expected of retextures, and what it comes of, as tests look at it. */
#ifndef LIB_ERROR_H
#define LIB_ERROR_H

#include <retex/retex.h>

/* The error to be expected, as a picture; samples may be NULL. To be freed. */
RetexImage test_error(const RetexSet *set, const RetexSamples *samples, const RetexTextureSpec *specs, int nspecs,
                      int nthreads);

/* How far textures scatter within the footprints of a set in memory, kept as samples keep colours. To be closed. */
RetexSamples *test_variances(const RetexSet *set, const RetexTextureSpec *specs, int nspecs);

#endif
