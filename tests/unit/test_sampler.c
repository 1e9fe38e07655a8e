/* Sobol' points: every pair of dimensions is a (0,m,2)-net of 2^m samples, keys differ, and numbers stay below one. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lib_plain.h"

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
    assert_true(fabs(sum / N) < 0.0005);
}

/* All numbers of a packet's vertices are the pairs one by one, with vectors or without, whatever pixels they are of. */
static void vertices_are_pairs(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 100; n++) {
        uint32_t sample[VERTEX_LANES], key[VERTEX_LANES];
        for (uint32_t lane = 0; lane < VERTEX_LANES; lane++) {
            sample[lane] = hash_pair(n, lane) >> (n % 32);
            key[lane] = sampler_start(5, n / 10 + lane / (1 + n % 16), 3, 0).key;
        }
        for (unsigned vertex = 0; vertex < 20; vertex++) {
            VertexSamples all, plain;
            vertex_samples(key, sample, vertex, &all);
            vertex_samples_plain(key, sample, vertex, &plain);
            assert_memory_equal(&all, &plain, sizeof all);
            const float *of[DIMENSIONS_PER_VERTEX][2] = {[VERTEX_LOBE] = {all.lobe, all.roulette},
                                                         [VERTEX_DIRECTION] = {all.direction_u, all.direction_v},
                                                         [VERTEX_LIGHT_CHOICE] = {all.light_choice, all.light_more},
                                                         [VERTEX_LIGHT_POINT] = {all.light_point_u, all.light_point_v}};
            for (uint32_t i = 0; i < VERTEX_LANES * DIMENSIONS_PER_VERTEX; i++) {
                uint32_t lane = i % VERTEX_LANES, pair = i / VERTEX_LANES;
                Sampler s = {key[lane], sample[lane]};
                float u, v;
                sampler_pair(&s, DIMENSION_PATH + vertex * DIMENSIONS_PER_VERTEX + pair, &u, &v);
                assert_true(u == of[pair][0][lane] && v == of[pair][1][lane]);
            }
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
