/* See retex/cpu.h. */
#include <retex/cpu.h>

#if RETEX_CPU_X86
#include <cpuid.h>

/* Not every compiler knows its name. */
static int has_f16c(void)
{
    unsigned a, b, c, d;
    return __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C);
}
#endif

RetexCpuLevel retex_cpu_level(void)
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
