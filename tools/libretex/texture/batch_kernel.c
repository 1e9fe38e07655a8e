/* The kernels of batch_body.h, one for each width of vectors, and the choice between them at run time. */
#include "texture/batch.h"
#include <stdint.h>

#include "texture/texture_kernel.h"

#define INLINE static inline __attribute__((always_inline))

/* The widest that every machine has. */
#define LANES 4
#define NAME(name) name##_plain
#include "texture/batch_body.h"
#undef LANES
#undef NAME

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#pragma GCC push_options
#pragma GCC target("avx2")
#define LANES 8
#define NAME(name) name##_avx2
#include "texture/batch_body.h"
#undef LANES
#undef NAME
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw,prefer-vector-width=512")
#define LANES 16
#define NAME(name) name##_avx512
#include "texture/batch_body.h"
#undef LANES
#undef NAME
#pragma GCC pop_options

int retex_texture_batch_kernels(RetexTextureBatchKernel *kernels[3])
{
    int count = 0;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        kernels[count++] = filter_batch_avx512;
    if (__builtin_cpu_supports("avx2"))
        kernels[count++] = filter_batch_avx2;
    kernels[count++] = filter_batch_plain;
    return count;
}
#else
int retex_texture_batch_kernels(RetexTextureBatchKernel *kernels[3])
{
    kernels[0] = filter_batch_plain;
    return 1;
}
#endif
