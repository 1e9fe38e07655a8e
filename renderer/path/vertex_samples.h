/* All sample numbers that the vertices of a packet of paths need. The paths are of one pixel, and each is at its n-th
 * vertex, with the same n: the numbers are the four pairs that sampler_pair gives one by one, to the bit.
 *
 * Keys that depend on pixel and dimension alone are kept from packet to packet. */
#ifndef RENDERER_PATH_VERTEX_SAMPLES_H
#define RENDERER_PATH_VERTEX_SAMPLES_H

#include "path/sampler.h"

#define VERTEX_NUMBERS (2 * DIMENSIONS_PER_VERTEX)
#define VERTEX_KEYS_MAX 16 /* vertices of a path whose keys are kept; keys of later ones are computed each time */
#define VERTEX_LANES 16

/* In [0, 1); u of the pairs, then v; by lane. */
typedef struct VertexSamples {
    float lobe[VERTEX_LANES], direction_u[VERTEX_LANES], light_choice[VERTEX_LANES], light_point_u[VERTEX_LANES];
    float roulette[VERTEX_LANES], direction_v[VERTEX_LANES], light_part[VERTEX_LANES], light_point_v[VERTEX_LANES];
} VertexSamples;

/* Keys of a vertex, by pair: for the shuffle, and for scrambling each number. */
typedef struct VertexKeys {
    uint32_t shuffle[DIMENSIONS_PER_VERTEX], scramble[DIMENSIONS_PER_VERTEX][2];
} VertexKeys;

/* One thread's keys of the current pixel; begin with zeros. */
typedef struct PixelKeys {
    uint32_t key;   /* the sampler's */
    unsigned ready; /* bits: vertices whose keys are computed */
    VertexKeys vertices[VERTEX_KEYS_MAX + 1];
} PixelKeys;

/* Vertex 0 is the first hit. The samplers' key, and the sample in its pixel of each lane. */
void vertex_samples(PixelKeys *keys, uint32_t key, const uint32_t sample[VERTEX_LANES], unsigned vertex,
                    VertexSamples *samples);
/* The same without vector instructions: the reference. */
void vertex_samples_plain(PixelKeys *keys, uint32_t key, const uint32_t sample[VERTEX_LANES], unsigned vertex,
                          VertexSamples *samples);

#endif
