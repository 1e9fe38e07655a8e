/* The expected error of retexturing and its input, for tests. */
#ifndef LIB_ERROR_H
#define LIB_ERROR_H

#include <retex/retex.h>

/* The expected error as a picture; samples may be NULL. To be freed. */
RetexImage test_error(const RetexSet *set, const RetexSamples *samples, const RetexTextureSpec *specs, int nspecs,
                      int nthreads);

/* The standard deviation of textures within the footprints of a set in memory, stored as samples are. To be closed. */
RetexSamples *test_variances(const RetexSet *set, const RetexTextureSpec *specs, int nspecs);

#endif
