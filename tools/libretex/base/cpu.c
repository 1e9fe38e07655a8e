/* See retex/host/cpu.h and cpu.h. */
#include "base/cpu.h"

#include <retex/host/cpu.h>

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#if RETEX_CPU_X86
#include <cpuid.h>

/* Not every compiler knows its name. */
static int has_f16c(void)
{
    unsigned a, b, c, d;
    return __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C);
}
#endif

static RetexCpuLevel highest_level(void)
{
#if RETEX_CPU_X86
    if (!__builtin_cpu_supports("avx2") || !has_f16c())
        return RETEX_CPU_BASELINE;
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                   __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq")
               ? RETEX_CPU_AVX512
               : RETEX_CPU_AVX2;
#else
    return RETEX_CPU_BASELINE;
#endif
}

static RetexCpuLevel find_level(void)
{
    static const char *const names[] = {"baseline", "avx2"};
    const RetexCpuLevel highest = highest_level();
    const char *most = getenv("RETEX_CPU");
    for (int k = 0; k < (int)highest && k < 2; k++)
        if (most && strcmp(most, names[k]) == 0)
            return (RetexCpuLevel)k;
    return highest;
}

RetexCpuLevel retex_cpu_level(void)
{
    static atomic_int known; /* 1 + the level; asked once: virtual machines take microseconds to answer cpuid */
    int level = atomic_load_explicit(&known, memory_order_relaxed) - 1;
    if (level < 0) {
        level = (int)find_level();
        atomic_store_explicit(&known, level + 1, memory_order_relaxed);
    }
    return (RetexCpuLevel)level;
}

void retex_cpu_clear_upper_halves(void)
{
#if RETEX_CPU_X86
    if (__builtin_cpu_supports("avx"))
        __asm__ volatile("vzeroupper");
#endif
}
