/* See retex/cpu.h. */
#include <retex/cpu.h>

RetexCpuLevel retex_cpu_level(void)
{
#if RETEX_CPU_X86
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("f16c"))
        return RETEX_CPU_BASELINE;
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                   __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq")
               ? RETEX_CPU_AVX512
               : RETEX_CPU_AVX2;
#else
    return RETEX_CPU_BASELINE;
#endif
}
