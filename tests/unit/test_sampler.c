/* Sobol' points: every pair of dimensions is a (0,m,2)-net of 2^m samples, keys differ, numbers stay below one. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "integrate/vertex_samples.h"

static void pairs_are_nets(void **state)
{
    (void)state;
    enum { M = 8, N = 1 << M };
    for (uint32_t pixel = 0; pixel < 5; pixel++)
        for (uint32_t dimension = 0; dimension < 7; dimension++)
            for (int split = 0; split <= M; split++) { /* boxes of 2^-split by 2^-(M-split) hold one sample each */
                unsigned char seen[N] = {0};
                for (uint32_t k = 0; k < N; k++) {
                    Sampler s = sampler_start(3, pixel, 9, k);
                    float u, v;
                    sampler_pair(&s, dimension, &u, &v);
                    assert_true(u >= 0 && u < 1 && v >= 0 && v < 1);
                    int box =
                        (int)(u * (float)(1 << split)) * (1 << (M - split)) + (int)(v * (float)(1 << (M - split)));
                    assert_int_equal(seen[box]++, 0);
                }
            }
}

static void keys_give_other_numbers(void **state)
{
    (void)state;
    float first[2], u, v;
    Sampler s = sampler_start(0, 10, 20, 5);
    sampler_pair(&s, 2, &first[0], &first[1]);
    const Sampler others[] = {sampler_start(1, 10, 20, 5), sampler_start(0, 11, 20, 5), sampler_start(0, 10, 21, 5),
                              sampler_start(0, 10, 20, 6)};
    for (size_t k = 0; k < 4; k++) {
        sampler_pair(&others[k], 2, &u, &v);
        assert_true(u != first[0] && v != first[1]);
    }
    sampler_pair(&s, 3, &u, &v);
    assert_true(u != first[0] && v != first[1]);
    sampler_pair(&s, 2, &u, &v);
    assert_true(u == first[0] && v == first[1]);
}

static void dimensions_do_not_correlate(void **state)
{
    (void)state;
    double sum = 0;
    enum { N = 4096 };
    for (uint32_t k = 0; k < N; k++) {
        Sampler s = sampler_start(0, 1, 2, k);
        float a, b, c, d;
        sampler_pair(&s, 4, &a, &b);
        sampler_pair(&s, 5, &c, &d);
        sum += (a - 0.5) * (c - 0.5) + (b - 0.5) * (d - 0.5);
    }
    assert_true(sum / N < 0.005 && sum / N > -0.005);
}

/* All of a vertex at once are the pairs one by one, with vectors or without; keys are kept from sample to sample and
 * forgotten with the pixel. */
static void vertices_are_pairs(void **state)
{
    (void)state;
    PixelKeys keys = {0}, plain_keys = {0};
    for (uint32_t k = 0; k < 400; k++) {
        Sampler s = sampler_start(5, k / 40, 3, k);
        for (unsigned vertex = 0; vertex < VERTEX_KEYS_MAX + 3; vertex++) {
            VertexSamples all, plain;
            float pair[VERTEX_NUMBERS];
            vertex_samples(&keys, &s, vertex, &all);
            vertex_samples_plain(&plain_keys, &s, vertex, &plain);
            for (uint32_t p = 0; p < DIMENSIONS_PER_VERTEX; p++)
                sampler_pair(&s, DIMENSION_PATH + vertex * DIMENSIONS_PER_VERTEX + p, &pair[p],
                             &pair[p + DIMENSIONS_PER_VERTEX]);
            assert_memory_equal(&all, pair, sizeof pair);
            assert_memory_equal(&plain, pair, sizeof pair);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pairs_are_nets), cmocka_unit_test(keys_give_other_numbers),
                                       cmocka_unit_test(dimensions_do_not_correlate),
                                       cmocka_unit_test(vertices_are_pairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
