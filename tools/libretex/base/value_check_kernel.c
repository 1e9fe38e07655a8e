/* Looks for values of a kind among many, by their bits: infinities and NaN, whose exponent bits are all ones, and
 * values other than 0. One pass without branches. */
#include <stdint.h>
#include <string.h>

#include <retex/host/cpu.h>

#include "base/value_check.h"

RETEX_CPU_INLINE void nonfinite_halves_body(const unsigned char *restrict at, size_t count, uint32_t *found)
{
    uint16_t bad = 0;
    for (size_t i = 0; i < count; i++) {
        uint16_t bits;
        memcpy(&bits, at + 2 * i, sizeof bits);
        bad |= (uint16_t) - ((bits & 0x7c00) == 0x7c00);
    }
    *found = bad;
}
RETEX_CPU_KERNEL(nonfinite_halves, (const unsigned char *restrict at, size_t count, uint32_t *found),
                 (at, count, found))

RETEX_CPU_INLINE void nonfinite_floats_body(const unsigned char *restrict at, size_t count, uint32_t *found)
{
    uint32_t bad = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, at + 4 * i, sizeof bits);
        bad |= (uint32_t) - ((bits & 0x7f800000) == 0x7f800000);
    }
    *found = bad;
}
RETEX_CPU_KERNEL(nonfinite_floats, (const unsigned char *restrict at, size_t count, uint32_t *found),
                 (at, count, found))

RETEX_CPU_INLINE void nonzero_floats_body(const unsigned char *restrict at, size_t count, uint32_t *found)
{
    uint32_t any = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, at + 4 * i, sizeof bits);
        any |= bits & 0x7fffffff; /* -0 is 0 */
    }
    *found = any;
}
RETEX_CPU_KERNEL(nonzero_floats, (const unsigned char *restrict at, size_t count, uint32_t *found), (at, count, found))

int retex_halves_have_nonfinite(const void *samples, size_t count)
{
    uint32_t found;
    nonfinite_halves_by_level[retex_cpu_level()](samples, count, &found);
    return found != 0;
}

int retex_floats_have_nonfinite(const void *samples, size_t count)
{
    uint32_t found;
    nonfinite_floats_by_level[retex_cpu_level()](samples, count, &found);
    return found != 0;
}

int retex_floats_have_nonzero(const void *samples, size_t count)
{
    enum { RUN = 256 }; /* most rows have a value near their beginning */
    uint32_t found = 0;
    for (size_t i = 0; i < count && !found; i += RUN)
        nonzero_floats_by_level[retex_cpu_level()]((const unsigned char *)samples + 4 * i,
                                                   count - i < RUN ? count - i : RUN, &found);
    return found != 0;
}
