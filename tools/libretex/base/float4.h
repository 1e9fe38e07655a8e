/* A vector of four floats, for kernels; any x86-64 and ARM processor has such registers. Private to libretex. */
#ifndef RETEX_BASE_FLOAT4_H
#define RETEX_BASE_FLOAT4_H

#include <string.h>

typedef float RetexFloat4 __attribute__((vector_size(16)));

static inline RetexFloat4 load4(const float *p)
{
    RetexFloat4 v;
    memcpy(&v, p, sizeof v);
    return v;
}

#endif
