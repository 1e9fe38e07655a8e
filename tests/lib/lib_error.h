/* The expected error of retexturing and its input, for tests. */
#ifndef LIB_ERROR_H
#define LIB_ERROR_H

#include <retex/retex.h>

/* The expected error as a picture, to be freed. */
RetexImage test_error(const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads);

/* Lay the variance of textures within the footprints on a set in memory, in place of the textures. */
void test_lay_variances(RetexSet *set, const RetexTextureSpec *specs, int nspecs);

#endif
