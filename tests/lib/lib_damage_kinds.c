/* Kinds of damage to a file: see lib_damage.h. */
#include "lib_damage.h"

#include <stdlib.h>
#include <string.h>

const char *const damage_kind_names[DAMAGE_KINDS] = {"bit",   "byte",  "number", "cut",   "lost",
                                                     "twice", "zeros", "swap",   "moved", "tail"};

static size_t below(size_t most, uint32_t *seed)
{
    return (size_t)(test_random(seed) * (double)most);
}

static uint32_t some_number(uint32_t *seed)
{
    static const uint32_t numbers[] = {0,          1,          2,          900000,     0x10000,
                                       0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000, 0x7fc00000};
    return numbers[below(sizeof numbers / sizeof *numbers, seed)];
}

/* The length of a run at this place, mostly short, and within the file. */
static size_t some_length(size_t left, uint32_t *seed)
{
    const size_t length = 1 + below((size_t)1 << below(13, seed), seed);
    return length < left ? length : left;
}

/* Exchange two runs that do not overlap. */
static void swap(unsigned char *a, unsigned char *b, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        const unsigned char kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

size_t damage_change(unsigned char *bytes, size_t size, DamageKind kind, uint32_t *seed)
{
    const size_t range = size > 8192 && test_random(seed) < 0.25 ? 8192 : size;
    const size_t at = below(range, seed), other = below(size, seed);
    const size_t length = some_length(size - (at > other ? at : other), seed);
    const size_t few = length < DAMAGE_ROOM ? length : DAMAGE_ROOM;
    const size_t apart = at > other ? at - other : other - at;
    const uint32_t number = some_number(seed);
    switch (kind) {
    case DAMAGE_BIT:
        bytes[at] ^= (unsigned char)(1 << below(8, seed));
        return size;
    case DAMAGE_BYTE:
        bytes[at] = (unsigned char)below(256, seed);
        return size;
    case DAMAGE_NUMBER:
        memcpy(bytes + at, &number, size - at < 4 ? size - at : 4);
        return size;
    case DAMAGE_CUT:
        return at;
    case DAMAGE_LOST:
        memmove(bytes + at, bytes + at + length, size - at - length);
        return size - length;
    case DAMAGE_TWICE:
        memmove(bytes + at + few, bytes + at, size - at);
        return size + few;
    case DAMAGE_ZEROS:
        memset(bytes + at, 0, length);
        return size;
    case DAMAGE_SWAP:
        swap(bytes + at, bytes + other, length < apart ? length : apart);
        return size;
    case DAMAGE_MOVED:
        memmove(bytes + at, bytes + other, length);
        return size;
    default:
        memset(bytes + size - length, (int)below(256, seed), length);
        return size;
    }
}
