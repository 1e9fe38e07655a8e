/* Maps between samples and the integers of planes. See planes.h. */
#include <math.h>
#include <string.h>

#include "base/half.h"
#include "pack/planes.h"

const char *const retex_pack_map_names[RETEX_PACK_MAPS] = {"bits",  "lattice", "log",    "linear",
                                                           "angle", "step",    "palette"};

static const size_t PALETTE_SHARE = 64; /* samples a palette needs for each number: these take room in the manifest */

int retex_pack_map_is_coded(const RetexPackMap *map)
{
    return map->kind >= RETEX_PACK_MAP_LOG;
}

void retex_pack_map_fill(RetexPackMap *map)
{
    for (int c = 0; c < RETEX_PACK_CODES && retex_pack_map_is_coded(map); c++) {
        double value = c * map->first;
        if (map->kind == RETEX_PACK_MAP_LOG || map->kind == RETEX_PACK_MAP_STEP)
            value = c ? map->first * exp2((double)(c - 1) / map->per_octave) : 0;
        else if (map->kind == RETEX_PACK_MAP_ANGLE)
            value = sin(fmin(fmax((double)(c - 128) / map->per_octave, -1), 1) * acos(-1) / 2);
        map->value[c] = (float)value;
    }
}

/* 1: numbers are made of the bits of samples. */
static int has_bits(const RetexPackMap *map)
{
    return map->kind == RETEX_PACK_MAP_BITS || map->kind == RETEX_PACK_MAP_PALETTE;
}

static int32_t code_of(float sample, const RetexPackMap *map)
{
    const double v = (double)sample;
    if (map->kind == RETEX_PACK_MAP_LINEAR)
        return (int32_t)fmin(fmax(rint(v / map->first), v > 0), RETEX_PACK_CODES - 1);
    if (map->kind == RETEX_PACK_MAP_ANGLE)
        return 128 + (int32_t)rint(asin(fmin(fmax(v, -1), 1)) * 2 / acos(-1) * map->per_octave);
    if (!(v > 0))
        return 0;
    return 1 + (int32_t)fmin(fmax(rint(log2(v / map->first) * map->per_octave), 0), RETEX_PACK_CODES - 2);
}

/* Reorder float bits so that larger values have larger numbers; -0 becomes -1. */
static int32_t ordered(uint32_t bits, int width)
{
    const uint32_t sign = 1u << (width - 1);
    return bits & sign ? -(int32_t)(bits ^ sign) - 1 : (int32_t)bits;
}

static uint32_t unordered(int32_t number, int width)
{
    return number < 0 ? (uint32_t)(-(number + 1)) | 1u << (width - 1) : (uint32_t)number;
}

enum { HALVES = 256 }; /* samples converted at a time */

/* The place of a number in a palette, or where it would be. */
static int find_in_palette(const RetexPackMap *map, int32_t number)
{
    int low = 0, high = map->count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (map->palette[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void retex_pack_map_fill_palette(RetexPackMap *map, RetexPixelType type)
{
    const RetexPackMap bits = {.kind = RETEX_PACK_MAP_BITS};
    retex_pack_map_samples(map->value, 1, map->palette, RETEX_PACK_CODES, &bits, type);
}

void retex_pack_map_find_palette(RetexPackMap *map, const float *samples, size_t stride, size_t count,
                                 RetexPixelType type)
{
    const RetexPackMap bits = {.kind = RETEX_PACK_MAP_BITS};
    RetexPackMap made = {.kind = RETEX_PACK_MAP_PALETTE};
    int32_t numbers[HALVES];
    for (size_t begin = 0; begin < count; begin += HALVES) {
        const size_t n = count - begin < HALVES ? count - begin : HALVES;
        retex_pack_map_numbers(numbers, samples + begin * stride, stride, n, &bits, type);
        for (size_t i = 0; i < n; i++) {
            const int at = find_in_palette(&made, numbers[i]);
            if (at < made.count && made.palette[at] == numbers[i])
                continue;
            if (made.count == RETEX_PACK_CODES)
                return;
            memmove(&made.palette[at + 1], &made.palette[at], (size_t)(made.count++ - at) * sizeof *made.palette);
            made.palette[at] = numbers[i];
        }
    }
    if ((size_t)made.count * PALETTE_SHARE > count)
        return;
    *map = made;
    retex_pack_map_fill_palette(map, type);
}

void retex_pack_map_numbers(int32_t *numbers, const float *samples, size_t stride, size_t count,
                            const RetexPackMap *map, RetexPixelType type)
{
    uint16_t halves[HALVES];
    float run[HALVES];
    for (size_t begin = 0; begin < count; begin += HALVES) {
        const size_t n = count - begin < HALVES ? count - begin : HALVES;
        for (size_t i = 0; i < n; i++)
            run[i] = samples[(begin + i) * stride];
        for (size_t i = 0; i < n && map->kind == RETEX_PACK_MAP_STEP; i++)
            run[i] = hypotf(run[i], samples[(begin + i) * stride + 2]);
        if (has_bits(map) && type == RETEX_HALF)
            retex_half_from_float(halves, run, n);
        for (size_t i = 0; i < n; i++) {
            uint32_t bits;
            memcpy(&bits, &run[i], sizeof bits);
            numbers[begin + i] = map->kind == RETEX_PACK_MAP_LATTICE
                                     ? (int32_t)lrint(ldexp((double)run[i], RETEX_PACK_LATTICE_BITS))
                                 : !has_bits(map)     ? code_of(run[i], map)
                                 : type == RETEX_HALF ? ordered(halves[i], 16)
                                                      : ordered(bits, 32);
            if (map->kind == RETEX_PACK_MAP_PALETTE)
                numbers[begin + i] = find_in_palette(map, numbers[begin + i]);
        }
    }
}

void retex_pack_map_samples(float *samples, size_t stride, const int32_t *numbers, size_t count,
                            const RetexPackMap *map, RetexPixelType type)
{
    uint16_t halves[HALVES];
    float run[HALVES];
    const float lattice = 1.0f / (1 << RETEX_PACK_LATTICE_BITS);
    if (map->kind == RETEX_PACK_MAP_LATTICE) {
        for (size_t i = 0; i < count; i++)
            samples[i * stride] = (float)numbers[i] * lattice;
    } else if (map->kind != RETEX_PACK_MAP_BITS) {
        for (size_t i = 0; i < count; i++)
            samples[i * stride] = map->value[numbers[i] & (RETEX_PACK_CODES - 1)];
    } else if (type == RETEX_FLOAT) {
        for (size_t i = 0; i < count; i++) {
            const uint32_t bits = unordered(numbers[i], 32);
            memcpy(&samples[i * stride], &bits, sizeof bits);
        }
    } else {
        for (size_t begin = 0; begin < count; begin += HALVES) {
            const size_t n = count - begin < HALVES ? count - begin : HALVES;
            for (size_t i = 0; i < n; i++)
                halves[i] = (uint16_t)unordered(numbers[begin + i], 16);
            retex_half_to_float(run, halves, n);
            for (size_t i = 0; i < n; i++)
                samples[(begin + i) * stride] = run[i];
        }
    }
}

void retex_pack_map_codes(float *samples, size_t stride, const unsigned char *codes, size_t count,
                          const RetexPackMap *map)
{
    for (size_t i = 0; i < count; i++)
        samples[i * stride] = map->value[codes[i]];
}
