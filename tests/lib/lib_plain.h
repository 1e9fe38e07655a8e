/* Kernels of the renderer without vector instructions, whatever the processor has: the references of the same functions
 * without _plain. */
#ifndef TESTS_LIB_PLAIN_H
#define TESTS_LIB_PLAIN_H

#include "accel/lanes.h"
#include "film/footprints/places.h"
#include "path/matte.h"
#include "path/vertex_samples.h"

void lanes_start_plain(LaneRays *lanes, double reach, struct RTCRay16 *to, int valid[ACCEL_PACKET]);
void lanes_refine_plain(const LaneRays *rays, LaneTriangles *triangles);
void matte_lights_plain(MatteLights *lights, const MattePacket *packet);
void matte_bounces_plain(MatteBounces *bounces, const MattePacket *packet);
void place_pairs_errors_plain(PlacePairs *pairs, double feature, const int periodic[2]);
void vertex_samples_plain(const uint32_t key[VERTEX_LANES], const uint32_t sample[VERTEX_LANES], unsigned vertex,
                          VertexSamples *samples);

#endif
