/* All numbers that a path's vertex needs, at once: the four pairs that sampler_pair gives one by one, to the bit.
 *
 * What depends on the pixel and the dimension alone is kept from sample to sample. */
#ifndef RENDERER_INTEGRATE_VERTEX_SAMPLES_H
#define RENDERER_INTEGRATE_VERTEX_SAMPLES_H

#include "integrate/sampler.h"

#define VERTEX_NUMBERS (2 * DIMENSIONS_PER_VERTEX)
#define VERTEX_KEYS_MAX 16 /* vertices of a path whose keys are kept; those of later ones are made anew */

/* In [0, 1); u of the pairs, then v. */
typedef struct VertexSamples {
    float lobe, direction_u, light_choice, light_point_u;
    float roulette, direction_v, light_part, light_point_v;
} VertexSamples;

/* Keys of a vertex, twice the four pairs' for the shuffle, then those for scrambling each number. */
typedef struct VertexKeys {
    uint32_t shuffle[VERTEX_NUMBERS], scramble[VERTEX_NUMBERS];
} VertexKeys;

/* One thread's, of the pixel in hand; zeros to begin with. */
typedef struct PixelKeys {
    uint32_t key; /* the sampler's */
    unsigned ready; /* bits: vertices that have theirs */
    VertexKeys vertices[VERTEX_KEYS_MAX + 1];
} PixelKeys;

/* Vertex 0 is the first hit. */
void vertex_samples(PixelKeys *keys, const Sampler *sampler, unsigned vertex, VertexSamples *samples);
/* The same with instructions that every machine has: the reference. */
void vertex_samples_plain(PixelKeys *keys, const Sampler *sampler, unsigned vertex, VertexSamples *samples);

#endif
