/* Checks many values for infinities and NaN, whose exponent bits are all ones. One pass without branches. */
#include <stdint.h>
#include <string.h>

#include "base/value_check.h"

int retex_halves_have_nonfinite(const void *samples, size_t count)
{
    const unsigned char *restrict at = samples;
    uint16_t bad = 0;

    for (size_t i = 0; i < count; i++) {
        uint16_t bits;
        memcpy(&bits, at + 2 * i, sizeof bits);
        bad |= (uint16_t) - ((bits & 0x7c00) == 0x7c00);
    }
    return bad != 0;
}

int retex_floats_have_nonfinite(const void *samples, size_t count)
{
    const unsigned char *restrict at = samples;
    uint32_t bad = 0;

    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, at + 4 * i, sizeof bits);
        bad |= (uint32_t) - ((bits & 0x7f800000) == 0x7f800000);
    }
    return bad != 0;
}
