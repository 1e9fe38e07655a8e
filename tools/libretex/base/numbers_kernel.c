/* Whether any of many values is not finite: exponents of all ones. One look at each, without a branch. */
#include <stdint.h>
#include <string.h>

#include "base/numbers.h"

int retex_halves_are_odd(const void *samples, size_t count)
{
    const unsigned char *restrict at = samples;
    uint16_t odd = 0;

    for (size_t i = 0; i < count; i++) {
        uint16_t bits;
        memcpy(&bits, at + 2 * i, sizeof bits);
        odd |= (uint16_t) - ((bits & 0x7c00) == 0x7c00);
    }
    return odd != 0;
}

int retex_floats_are_odd(const void *samples, size_t count)
{
    const unsigned char *restrict at = samples;
    uint32_t odd = 0;

    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, at + 4 * i, sizeof bits);
        odd |= (uint32_t) - ((bits & 0x7f800000) == 0x7f800000);
    }
    return odd != 0;
}
