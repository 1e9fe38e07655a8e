/* The kernels that undo EXR's predictors and interleave planes, compared with loops over single bytes. */
#include "lib_test.h"

#include <string.h>

#include <cmocka.h>

#include "base/value_check.h"
#include "exr/planes_kernel.h"
#include "exr/zip_kernel.h"

enum { MOST = 300, GUARD = 8 };

static void fill(unsigned char *bytes, size_t count, uint32_t *seed)
{
    for (size_t i = 0; i < count; i++)
        bytes[i] = (unsigned char)(test_random(seed) * 256);
}

/* OpenEXR's definition: each byte is the one before plus the difference minus 128. */
static void test_zip(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (size_t count = 1; count < MOST; count++) {
        unsigned char data[MOST + GUARD], differences[MOST], expected[MOST + GUARD];
        fill(data, sizeof data, &seed);
        memcpy(expected, data, sizeof data);
        for (size_t i = 1; i < count; i++)
            expected[i] = (unsigned char)(expected[i - 1] + data[i] - 128);
        retex_exr_zip_accumulate(data, count);
        assert_memory_equal(data, expected, sizeof data);
        retex_exr_zip_difference(differences, data, count);
        retex_exr_zip_accumulate(differences, count);
        assert_memory_equal(data, differences, count);
    }
}

/* OpenEXR's definition: sums of 24 bits, whose bytes are kept apart, the highest first. */
static void test_pxr24(void **state)
{
    (void)state;
    uint32_t seed = 4;
    for (size_t width = 1; width < MOST; width++) {
        unsigned char in[3 * MOST], raw[4 * MOST + GUARD], expected[4 * MOST + GUARD] = {0};
        uint32_t sum = 0;
        fill(in, sizeof in, &seed);
        memset(raw, 0, sizeof raw);
        for (size_t i = 0; i < width; i++) {
            sum += in[i] * 0x10000u + in[width + i] * 0x100u + in[2 * width + i];
            const uint32_t bits = (sum & 0xffffff) * 0x100u;
            memcpy(expected + 4 * i, &bits, sizeof bits);
        }
        retex_exr_pxr24_accumulate(raw, in, width);
        assert_memory_equal(raw, expected, sizeof raw);
    }
}

static void test_interleave(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int round = 0; round < 2000; round++) {
        const int channels = 1 + round % 5;
        const size_t count = (size_t)(round % 61);
        unsigned char memory[5][4 * 61 + 1];
        float out[5 * 61 + GUARD], expected[5 * 61 + GUARD];
        const void *planes[5];
        for (int i = 0; i < 5 * 61 + GUARD; i++)
            out[i] = expected[i] = (float)i;
        for (int c = 0; c < channels; c++) {
            fill(memory[c], sizeof memory[c], &seed);
            planes[c] = round % 7 == c ? NULL : memory[c] + round % 2; /* absent; unaligned */
            for (size_t i = 0; planes[c] && i < count; i++)
                memcpy(&expected[i * (size_t)channels + (size_t)c], (const char *)planes[c] + 4 * i, 4);
        }
        retex_planes_interleave(out, planes, channels, count);
        assert_memory_equal(out, expected, sizeof out);
    }
}

/* One value that is not 0, or none, anywhere. */
static void test_nonzero(void **state)
{
    (void)state;
    static const float kinds[] = {1, -1, 1e-45f, 0, -0.0f};
    float values[700];
    for (size_t at = 0; at < 700; at += 3)
        for (int kind = 0; kind < 5; kind++) {
            for (size_t i = 0; i < 700; i++)
                values[i] = i % 2 ? 0 : -0.0f;
            values[at] = kinds[kind];
            assert_int_equal(retex_floats_have_nonzero(values, 700), kind < 3);
            assert_int_equal(retex_floats_have_nonzero(values, at), 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_zip), cmocka_unit_test(test_pxr24),
                                       cmocka_unit_test(test_interleave), cmocka_unit_test(test_nonzero)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
