/* See retex/host/cpu.h. */
#include <retex/host/cpu.h>

#if RETEX_CPU_X86
#include <stdatomic.h>
#include <cpuid.h>

/* Not every compiler knows its name. Asked once: virtual machines take microseconds to answer cpuid. */
static int has_f16c(void)
{
    static atomic_int known; /* 0 not yet, 1 no, 2 yes */
    int answer = atomic_load_explicit(&known, memory_order_relaxed);
    if (!answer) {
        unsigned a, b, c, d;
        answer = __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C) ? 2 : 1;
        atomic_store_explicit(&known, answer, memory_order_relaxed);
    }
    return answer == 2;
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
