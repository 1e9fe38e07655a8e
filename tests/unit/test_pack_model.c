/* Strips of numbers, predicted and coded by a model: every number is decoded exactly, the size is as small as it should
 * be, and damaged data does no harm. */
#include "lib_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pack/model.h"

enum { WIDTH = 61, ROWS = 29, ALL = WIDTH * ROWS };

static RetexPackModelStrip make_strip(int channels, int with_shifts)
{
    RetexPackModelStrip strip;
    const RetexPackMap maps[RETEX_PACK_MODEL_CHANNELS_MAX] = {
        {.kind = with_shifts ? RETEX_PACK_MAP_LATTICE : RETEX_PACK_MAP_BITS},
        {.kind = with_shifts ? RETEX_PACK_MAP_LATTICE : RETEX_PACK_MAP_BITS}};
    assert_true(retex_pack_model_alloc(&strip, WIDTH, ROWS, channels, maps));
    return strip;
}

/* The numbers after encoding and decoding are the numbers; returns the bytes between. */
static size_t there_and_back(const RetexPackModelStrip *strip)
{
    RetexPackModelStrip back = make_strip(strip->channels, strip->shifts[0] != NULL);
    unsigned char *data;
    const long bytes = retex_pack_model_encode(&data, strip);
    assert_true(bytes >= 0);
    for (int c = 0; c < strip->channels; c++)
        if (strip->shifts[c])
            memcpy(back.shifts[c], strip->shifts[c], ALL);
    assert_int_equal(retex_pack_model_decode(&back, data, (size_t)bytes), 1);
    for (int c = 0; c < strip->channels; c++)
        assert_memory_equal(back.numbers[c], strip->numbers[c], ALL * sizeof *strip->numbers[c]);
    free(data);
    retex_pack_model_free(&back);
    return (size_t)bytes;
}

static void test_any_numbers_come_back(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int round = 0; round < 96; round++) {
        const int channels = 1 + round % 4, kind = round / 4 % 4, holes = round / 16 % 3, steps = round / 48;
        RetexPackModelStrip strip = make_strip(channels, steps);
        for (int c = 0; c < channels; c++)
            for (int i = 0; i < ALL; i++) {
                const double noise = test_random(&seed), wide = ldexp(noise - 0.5, 32);
                const int32_t smooth = 40 + i % WIDTH + (c + 1) * (i / WIDTH) + (int)(9 * noise);
                int32_t n = kind == 0   ? (int32_t)fmax(wide, INT32_MIN)
                            : kind == 1 ? smooth
                                        : 1000 * (smooth / 7) - 9000;
                if (kind == 3 && c > 0) /* what the channel before says */
                    n = 3 * strip.numbers[c - 1][i] / 4 + 5;
                if (holes && test_random(&seed) < (holes == 1 ? 0.2 : 0.99))
                    n = 0;
                if (strip.shifts[c]) {
                    const int shift = strip.shifts[c][i] = (unsigned char)(13 * test_random(&seed));
                    n = (int32_t)((uint32_t)(n >> shift) << shift);
                }
                strip.numbers[c][i] = n;
            }
        assert_true(there_and_back(&strip) > 0);
        retex_pack_model_free(&strip);
    }
}

static void test_nothing_takes_no_bytes(void **state)
{
    (void)state;
    RetexPackModelStrip strip = make_strip(3, 0);
    for (int c = 0; c < 3; c++)
        memset(strip.numbers[c], 0, ALL * sizeof *strip.numbers[c]);
    assert_int_equal(there_and_back(&strip), 0);
    retex_pack_model_free(&strip);
}

/* Extremes, whose differences do not fit into a number. */
static void test_extremes_come_back(void **state)
{
    (void)state;
    uint32_t seed = 3;
    const int32_t extremes[] = {INT32_MIN, INT32_MAX, 0, -1, 1, INT32_MIN + 1};
    RetexPackModelStrip strip = make_strip(2, 0);
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < ALL; i++)
            strip.numbers[c][i] = extremes[(int)(6 * test_random(&seed))];
    there_and_back(&strip);
    retex_pack_model_free(&strip);
}

/* Noise takes its entropy; a channel that follows from the others, or from its neighbours, next to nothing; so do bits
 * that are always 0. */
static void test_what_can_be_predicted_is_small(void **state)
{
    (void)state;
    uint32_t seed = 5;
    RetexPackModelStrip strip = make_strip(1, 0), three = make_strip(3, 0);
    for (int i = 0; i < ALL; i++)
        strip.numbers[0][i] = 5000 + (int)(256 * test_random(&seed));
    const size_t noise = there_and_back(&strip);
    assert_in_range(noise, ALL, ALL * 112 / 100);
    for (int i = 0; i < ALL; i++) {
        three.numbers[0][i] = strip.numbers[0][i];
        three.numbers[1][i] = strip.numbers[0][i] + 77;
        three.numbers[2][i] = 2 * strip.numbers[0][i] - 300;
        strip.numbers[0][i] = 7 * (i % WIDTH) - 11 * (i / WIDTH);
    }
    assert_true(there_and_back(&three) < noise + 500);
    assert_true(there_and_back(&strip) < 300);
    for (int i = 0; i < ALL; i++)
        strip.numbers[0][i] = (int32_t)(32 * test_random(&seed)) << 20;
    assert_true(there_and_back(&strip) < ALL * 5 / 8 * 115 / 100);
    retex_pack_model_free(&strip);
    retex_pack_model_free(&three);
}

static void test_damaged_data_does_no_harm(void **state)
{
    (void)state;
    uint32_t seed = 7;
    RetexPackModelStrip strip = make_strip(3, 0);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < ALL; i++)
            strip.numbers[c][i] = (int32_t)(900 * test_random(&seed) * test_random(&seed)) - 60 * c;
    unsigned char *data;
    const long bytes = retex_pack_model_encode(&data, &strip);
    assert_true(bytes > 8);
    for (long cut = 1; cut < bytes; cut += 1 + cut / 8)
        assert_int_equal(retex_pack_model_decode(&strip, data, (size_t)(bytes - cut)), 0);
    for (int round = 0; round < 200; round++) {
        const size_t at = (size_t)((double)bytes * test_random(&seed));
        const unsigned char was = data[at];
        data[at] = (unsigned char)(256 * test_random(&seed));
        retex_pack_model_decode(&strip, data, (size_t)bytes);
        data[at] = was;
    }
    free(data);
    retex_pack_model_free(&strip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_numbers_come_back),     cmocka_unit_test(test_nothing_takes_no_bytes),
        cmocka_unit_test(test_extremes_come_back),        cmocka_unit_test(test_what_can_be_predicted_is_small),
        cmocka_unit_test(test_damaged_data_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
