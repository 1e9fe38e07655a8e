/* See vertex_samples.h. Eight numbers are one vector: u of four pairs and v of four pairs. */
#include <string.h>
#include "integrate/vertex_samples.h"

#define INLINE static inline __attribute__((always_inline))

typedef uint32_t Lanes __attribute__((vector_size(4 * VERTEX_NUMBERS)));
typedef float FloatLanes __attribute__((vector_size(4 * VERTEX_NUMBERS)));

/* sampler.h's, on all lanes. Macros: vectors are not passed to functions where the machine may lack them. */
#define REVERSE(x)                                                                                                     \
    do {                                                                                                               \
        x = (x >> 16) | (x << 16);                                                                                     \
        x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);                                                       \
        x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);                                                       \
        x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);                                                       \
        x = ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);                                                       \
    } while (0)
#define OWEN(x, seed)                                                                                                  \
    do {                                                                                                               \
        x ^= x * 0x3d20adeau;                                                                                          \
        x += seed;                                                                                                     \
        x *= (seed >> 16) | 1;                                                                                         \
        x ^= x * 0x05526c56u;                                                                                          \
        x ^= x * 0x53a22864u;                                                                                          \
    } while (0)

INLINE void numbers(const VertexKeys *keys, uint32_t reversed, float *out)
{
    const Lanes second = {0, 0, 0, 0, ~0u, ~0u, ~0u, ~0u};
    Lanes shuffle, scramble, x = reversed - (Lanes){0}, sobol;
    memcpy(&shuffle, keys->shuffle, sizeof shuffle);
    memcpy(&scramble, keys->scramble, sizeof scramble);
    OWEN(x, shuffle);
    REVERSE(x);
    sobol = x;
    sobol ^= sobol >> 1 & 0x55555555u;
    sobol ^= sobol >> 2 & 0x33333333u;
    sobol ^= sobol >> 4 & 0x0f0f0f0fu;
    sobol ^= sobol >> 8 & 0x00ff00ffu;
    sobol ^= sobol >> 16;
    x = (x & ~second) | (sobol & second);
    OWEN(x, scramble);
    REVERSE(x);
    x >>= 8;
    FloatLanes u = __builtin_convertvector((__typeof__(x))x, FloatLanes) * 0x1p-24f;
    memcpy(out, &u, sizeof u);
}

static void make_keys(VertexKeys *keys, uint32_t key, unsigned vertex)
{
    for (unsigned p = 0; p < DIMENSIONS_PER_VERTEX; p++) {
        uint32_t k = hash_pair(key, DIMENSION_PATH + vertex * DIMENSIONS_PER_VERTEX + p);
        keys->shuffle[p] = keys->shuffle[p + DIMENSIONS_PER_VERTEX] = k;
        keys->scramble[p] = hash_mix(k ^ 0x68bc21ebu);
        keys->scramble[p + DIMENSIONS_PER_VERTEX] = hash_mix(k ^ 0x02e5be93u);
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

void vertex_samples_plain(PixelKeys *keys, const Sampler *sampler, unsigned vertex, VertexSamples *samples)
{
    numbers(vertex_keys(keys, sampler->key, vertex), reverse_bits(sampler->sample), &samples->lobe);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void numbers_avx2(const VertexKeys *keys, uint32_t reversed, float *out)
{
    numbers(keys, reversed, out);
}

void vertex_samples(PixelKeys *keys, const Sampler *sampler, unsigned vertex, VertexSamples *samples)
{
    const VertexKeys *own = vertex_keys(keys, sampler->key, vertex);
    if (__builtin_cpu_supports("avx2"))
        numbers_avx2(own, reverse_bits(sampler->sample), &samples->lobe);
    else
        numbers(own, reverse_bits(sampler->sample), &samples->lobe);
}
#else
void vertex_samples(PixelKeys *keys, const Sampler *sampler, unsigned vertex, VertexSamples *samples)
{
    vertex_samples_plain(keys, sampler, vertex, samples);
}
#endif
