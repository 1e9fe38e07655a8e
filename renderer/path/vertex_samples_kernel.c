/* See vertex_samples.h. Loops over lanes without branches: the compiler makes vectors of them. */
#include <retex/host/cpu.h>
#include "path/vertex_samples.h"

/* sampler_pair, of all lanes. */
RETEX_CPU_INLINE void pair_lanes(const VertexKeys *keys, int pair, const uint32_t *restrict sample, float *restrict u,
                                 float *restrict v)
{
    uint32_t shuffle = keys->shuffle[pair], first = keys->scramble[pair][0], second = keys->scramble[pair][1];
    for (int k = 0; k < VERTEX_LANES; k++) {
        uint32_t index = reverse_bits(owen_reversed(reverse_bits(sample[k]), shuffle));
        uint32_t x = reverse_bits(owen_reversed(index, first));
        uint32_t y = reverse_bits(owen_reversed(sobol_second(index), second));
        u[k] = (float)(int32_t)(x >> 8) * 0x1p-24f; /* unit_float, by the conversion that all machines have */
        v[k] = (float)(int32_t)(y >> 8) * 0x1p-24f;
    }
}

RETEX_CPU_INLINE void numbers_body(const VertexKeys *keys, const uint32_t *sample, VertexSamples *samples)
{
    pair_lanes(keys, VERTEX_LOBE, sample, samples->lobe, samples->roulette);
    pair_lanes(keys, VERTEX_DIRECTION, sample, samples->direction_u, samples->direction_v);
    pair_lanes(keys, VERTEX_LIGHT_CHOICE, sample, samples->light_choice, samples->light_part);
    pair_lanes(keys, VERTEX_LIGHT_POINT, sample, samples->light_point_u, samples->light_point_v);
}

RETEX_CPU_KERNEL(numbers, (const VertexKeys *keys, const uint32_t *sample, VertexSamples *samples),
                 (keys, sample, samples))

static void make_keys(VertexKeys *keys, uint32_t key, unsigned vertex)
{
    for (unsigned p = 0; p < DIMENSIONS_PER_VERTEX; p++) {
        uint32_t k = hash_pair(key, DIMENSION_PATH + vertex * DIMENSIONS_PER_VERTEX + p);
        keys->shuffle[p] = k;
        keys->scramble[p][0] = hash_mix(k ^ 0x68bc21ebu);
        keys->scramble[p][1] = hash_mix(k ^ 0x02e5be93u);
    }
}

static const VertexKeys *vertex_keys(PixelKeys *keys, uint32_t key, unsigned vertex)
{
    if (keys->key != key)
        keys->key = key, keys->ready = 0;
    VertexKeys *own = &keys->vertices[vertex < VERTEX_KEYS_MAX ? vertex : VERTEX_KEYS_MAX];
    if (vertex >= VERTEX_KEYS_MAX || !(keys->ready >> vertex & 1)) {
        make_keys(own, key, vertex);
        keys->ready |= vertex < VERTEX_KEYS_MAX ? 1u << vertex : 0;
    }
    return own;
}

void vertex_samples_plain(PixelKeys *keys, uint32_t key, const uint32_t sample[VERTEX_LANES], unsigned vertex,
                          VertexSamples *samples)
{
    numbers_baseline(vertex_keys(keys, key, vertex), sample, samples);
}

void vertex_samples(PixelKeys *keys, uint32_t key, const uint32_t sample[VERTEX_LANES], unsigned vertex,
                    VertexSamples *samples)
{
    numbers_by_level[retex_cpu_level()](vertex_keys(keys, key, vertex), sample, samples);
}
