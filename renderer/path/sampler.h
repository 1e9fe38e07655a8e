/* Sample numbers: Owen-scrambled Sobol' points, keyed by seed, pixel, sample and dimension alone, so that a picture
 * is the same to the bit whatever thread renders which pixel.
 *
 * Dimensions are taken in pairs; every pair is the first two Sobol' dimensions, with its own Owen scrambling and its
 * own shuffled order of the samples (Burley, 'Practical hash-based Owen scrambling', JCGT 2020). */
#ifndef RENDERER_PATH_SAMPLER_H
#define RENDERER_PATH_SAMPLER_H

#include <stdint.h>

typedef struct Sampler {
    uint32_t key;    /* of seed and pixel */
    uint32_t sample; /* index of the sample in its pixel */
} Sampler;

/* Pairs of dimensions by what they decide. A path vertex owns DIMENSIONS_PER_VERTEX pairs from DIMENSION_PATH on. */
enum {
    DIMENSION_PIXEL = 0,
    DIMENSION_PATH = 1,
    DIMENSION_TEXTURE = 0x20000000, /* beyond those too: u chooses a leaf of a tree of textures; only where there is
                                       one. Each vertex has TEXTURES_PER_VERTEX pairs */
    TEXTURES_PER_VERTEX = 256,
    TEXTURE_VERTEX = 0, /* of the vertex itself */
    TEXTURE_LIGHT = 1,  /* of the emitter that is sampled */
    TEXTURE_SHADOW = 2, /* of the first surface on the shadow ray, and so on */
    DIMENSION_MEDIA = 0x30000000, /* the same of distances and lights in media, some pairs for each segment */
    DIMENSION_JITTER = 0x3fff0000, /* u: of rainbows, one pair for each segment */
    JITTER_SEGMENTS = 0x100,
    DIMENSION_WAVELENGTH = 0x3fffffff, /* u: the path's wavelength, only where light is dispersed */
    DIMENSION_CAMERA = 0x40000000, /* beyond those of all vertices; only of cameras that need it */
    VERTEX_LOBE = 0,        /* u: which lobe, v: Russian roulette */
    VERTEX_DIRECTION = 1,
    VERTEX_LIGHT_CHOICE = 2, /* u: which light, v: more digits of u, for many */
    VERTEX_LIGHT_POINT = 3,
    DIMENSIONS_PER_VERTEX = 4
};

static inline uint32_t hash_mix(uint32_t x)
{
    x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16; /* Wellons' lowbias32 */
    return x;
}

static inline uint32_t hash_pair(uint32_t a, uint32_t b)
{
    return hash_mix(a ^ (hash_mix(b) + 0x9e3779b9u + (a << 6) + (a >> 2)));
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/* Laine-Karras style permutation of reversed bits with the constants found by Vegdahl (2021): low bits affect high
 * ones. */
static inline uint32_t owen_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* Second Sobol' dimension, bits from the lowest: multiplication by the Pascal matrix mod 2. C(k, j) is odd where the
 * bits of j are among those of k (Lucas), so it is a sum over supersets of bits, taken one bit of the position at a
 * time. */
static inline uint32_t sobol_second(uint32_t index)
{
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 8 & 0x00ff00ffu;
    return index ^ index >> 16;
}

static inline float unit_float(uint32_t x) { return (float)(x >> 8) * 0x1p-24f; } /* [0,1) */

static inline Sampler sampler_start(uint32_t seed, uint32_t x, uint32_t y, uint32_t sample)
{
    return (Sampler){hash_pair(hash_pair(hash_mix(seed ^ 0x52455458u), x), y), sample};
}

/* What all samples of a pixel share of a pair. */
typedef struct PairKeys {
    uint32_t order, u, v;
} PairKeys;

static inline PairKeys pair_keys(uint32_t key, uint32_t dimension)
{
    key = hash_pair(key, dimension);
    return (PairKeys){key, hash_mix(key ^ 0x68bc21ebu), hash_mix(key ^ 0x02e5be93u)};
}

static inline void pair_of_keys(const PairKeys *keys, uint32_t sample, float *u, float *v)
{
    uint32_t index = reverse_bits(owen_reversed(reverse_bits(sample), keys->order)); /* shuffled */
    *u = unit_float(reverse_bits(owen_reversed(index, keys->u)));
    *v = unit_float(reverse_bits(owen_reversed(sobol_second(index), keys->v)));
}

static inline void sampler_pair(const Sampler *sampler, uint32_t dimension, float *u, float *v)
{
    PairKeys keys = pair_keys(sampler->key, dimension);
    pair_of_keys(&keys, sampler->sample, u, v);
}

#endif
