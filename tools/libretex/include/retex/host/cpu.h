/* Which vector instructions a kernel may use, chosen at run time: the one place that asks the processor, and the one
 * way to compile a kernel for it. Builds run on any x86-64 or ARM; elsewhere than on x86-64 there is one level.
 *
 * A kernel is a table by level, NAME_by_level, of functions that give the same bits:
 *
 *     RETEX_CPU_INLINE void scale_body(float *v, int n) { ... }    // a plain loop that the compiler makes vectors of
 *     RETEX_CPU_KERNEL(scale, (float *v, int n), (v, n))           // scale_by_level: the body compiled for each level
 *
 *     scale_by_level[retex_cpu_level()](v, n);
 *
 * Kernels written with intrinsics, between #if RETEX_CPU_X86 and #endif, fill it by RETEX_CPU_TABLE with a function for
 * each level; the others are not looked at elsewhere. The function of RETEX_CPU_BASELINE is the reference that tests
 * compare the others with. */
#ifndef RETEX_HOST_CPU_H
#define RETEX_HOST_CPU_H

#if defined(__x86_64__) && defined(__GNUC__)
#define RETEX_CPU_X86 1
#else
#define RETEX_CPU_X86 0
#endif

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Each level has all that those before it have. */
typedef enum RetexCpuLevel {
    RETEX_CPU_BASELINE, /* what the compiler assumes by default */
#if RETEX_CPU_X86
    RETEX_CPU_AVX2,   /* with F16C */
    RETEX_CPU_AVX512, /* F, VL, BW and DQ */
#endif
    RETEX_CPU_LEVELS
} RetexCpuLevel;

/* The highest level that this machine has, or the lower one that RETEX_CPU names: baseline, avx2. */
RetexCpuLevel retex_cpu_level(void);

#define RETEX_CPU_INLINE static inline __attribute__((always_inline))

#if RETEX_CPU_X86
/* Attributes of functions that are compiled for a level. */
#define RETEX_CPU_TARGET_AVX2 __attribute__((target("avx2,f16c")))
#define RETEX_CPU_TARGET_AVX512 __attribute__((target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")))
/* The same for all functions up to RETEX_CPU_END. */
#define RETEX_CPU_BEGIN_AVX2 _Pragma("GCC push_options") _Pragma("GCC target(\"avx2,f16c\")")
#define RETEX_CPU_BEGIN_AVX512                                                                                         \
    _Pragma("GCC push_options")                                                                                        \
        _Pragma("GCC target(\"avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512\")")
#define RETEX_CPU_END _Pragma("GCC pop_options")

#define RETEX_CPU_TABLE(name, parameters, baseline, avx2, avx512)                                                      \
    static void(*const name##_by_level[RETEX_CPU_LEVELS]) parameters = {baseline, avx2, avx512};

#define RETEX_CPU_KERNEL(name, parameters, arguments)                                                                  \
    static void name##_baseline parameters { name##_body arguments; }                                                  \
    RETEX_CPU_TARGET_AVX2 static void name##_avx2 parameters { name##_body arguments; }                                \
    RETEX_CPU_TARGET_AVX512 static void name##_avx512 parameters { name##_body arguments; }                            \
    RETEX_CPU_TABLE(name, parameters, name##_baseline, name##_avx2, name##_avx512)
#else
#define RETEX_CPU_TABLE(name, parameters, baseline, avx2, avx512)                                                      \
    static void(*const name##_by_level[RETEX_CPU_LEVELS]) parameters = {baseline};

#define RETEX_CPU_KERNEL(name, parameters, arguments)                                                                  \
    static void name##_baseline parameters { name##_body arguments; }                                                  \
    RETEX_CPU_TABLE(name, parameters, name##_baseline, , )
#endif

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop

/* Options of GCC for one function, in quotes. */
#ifdef __clang__
#define RETEX_CPU_OPTIONS(options)
#else
#define RETEX_CPU_OPTIONS(options) __attribute__((optimize(options)))
#endif

/* Clang says the same in other words, and has no width to prefer. */
#if defined(__clang__) && RETEX_CPU_X86
#undef RETEX_CPU_TARGET_AVX512
#define RETEX_CPU_TARGET_AVX512 __attribute__((target("avx512f,avx512vl,avx512bw,avx512dq")))
#undef RETEX_CPU_BEGIN_AVX2
#define RETEX_CPU_BEGIN_AVX2                                                                                           \
    _Pragma("clang attribute push(__attribute__((target(\"avx2,f16c\"))), apply_to = function)")
#undef RETEX_CPU_BEGIN_AVX512
#define RETEX_CPU_BEGIN_AVX512                                                                                         \
  _Pragma("clang attribute push(__attribute__((target(\"avx512f,avx512vl,avx512bw,avx512dq\"))), apply_to = function)")
#undef RETEX_CPU_END
#define RETEX_CPU_END _Pragma("clang attribute pop")
#endif
#endif
