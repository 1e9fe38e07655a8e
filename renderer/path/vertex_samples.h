/* All sample numbers that the vertices of a packet of paths need, which are each at its n-th vertex, with the same n:
 * the four pairs that sampler_pair gives one by one, to the bit. */
#ifndef RENDERER_PATH_VERTEX_SAMPLES_H
#define RENDERER_PATH_VERTEX_SAMPLES_H

#include "path/sampler.h"

#define VERTEX_LANES 16

/* In [0, 1); u of the pairs, then v; by lane. */
typedef struct VertexSamples {
    float lobe[VERTEX_LANES], direction_u[VERTEX_LANES], light_choice[VERTEX_LANES], light_point_u[VERTEX_LANES];
    float roulette[VERTEX_LANES], direction_v[VERTEX_LANES], light_more[VERTEX_LANES], light_point_v[VERTEX_LANES];
} VertexSamples;

/* Vertex 0 is the first hit. By lane: the sampler's key, and the sample in its pixel. */
void vertex_samples(const uint32_t key[VERTEX_LANES], const uint32_t sample[VERTEX_LANES], unsigned vertex,
                    VertexSamples *samples);

#endif
