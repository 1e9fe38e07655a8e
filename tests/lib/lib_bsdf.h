/* Samples of how a surface scatters light. */
#ifndef LIB_BSDF_H
#define LIB_BSDF_H

#include <stdint.h>

#include "shade/bsdf.h"

/* Sample number k of a sequence. Returns 0 if the sample carries no light. */
int test_bsdf_sample(const Bsdf *b, uint32_t sequence, int k, BsdfSample *s);

#endif
