/* See vertex_samples.h. Loops over lanes without branches: the compiler makes vectors of them. */
#include <retex/host/cpu.h>
#include "path/vertex_samples.h"

/* sampler_pair, of all lanes. */
RETEX_CPU_INLINE void pair_lanes(const uint32_t *restrict key, uint32_t dimension, const uint32_t *restrict sample,
                                 float *restrict u, float *restrict v)
{
    for (int k = 0; k < VERTEX_LANES; k++) {
        PairKeys keys = pair_keys(key[k], dimension);
        uint32_t index = reverse_bits(owen_reversed(reverse_bits(sample[k]), keys.order));
        uint32_t x = reverse_bits(owen_reversed(index, keys.u));
        uint32_t y = reverse_bits(owen_reversed(sobol_second(index), keys.v));
        u[k] = (float)(int32_t)(x >> 8) * 0x1p-24f; /* unit_float, by the conversion that all machines have */
        v[k] = (float)(int32_t)(y >> 8) * 0x1p-24f;
    }
}

RETEX_CPU_INLINE void numbers_body(const uint32_t *key, const uint32_t *sample, uint32_t first, VertexSamples *samples)
{
    pair_lanes(key, first + VERTEX_LOBE, sample, samples->lobe, samples->roulette);
    pair_lanes(key, first + VERTEX_DIRECTION, sample, samples->direction_u, samples->direction_v);
    pair_lanes(key, first + VERTEX_LIGHT_CHOICE, sample, samples->light_choice, samples->light_more);
    pair_lanes(key, first + VERTEX_LIGHT_POINT, sample, samples->light_point_u, samples->light_point_v);
}

RETEX_CPU_KERNEL(numbers, (const uint32_t *key, const uint32_t *sample, uint32_t first, VertexSamples *samples),
                 (key, sample, first, samples))

static uint32_t first_dimension(unsigned vertex)
{
    return DIMENSION_PATH + vertex * DIMENSIONS_PER_VERTEX;
}

void vertex_samples(const uint32_t key[VERTEX_LANES], const uint32_t sample[VERTEX_LANES], unsigned vertex,
                    VertexSamples *samples)
{
    numbers_by_level[retex_cpu_level()](key, sample, first_dimension(vertex), samples);
}
