/* The common case for a whole packet of paths: surfaces that only reflect, by Lambert's law, and direct light from
 * faces of meshes with uniform emission. Each lane has the same numbers, to the bit, as lights_sample, bsdf_eval,
 * bsdf_sample and accel_offset give; packet.c multiplies them in another order, which rounds differently. */
#ifndef RENDERER_PATH_MATTE_H
#define RENDERER_PATH_MATTE_H

#include "accel/accel.h"
#include "light/mesh_light.h"

#define MATTE_LANES ACCEL_PACKET

typedef double MatteDoubles[MATTE_LANES];
typedef float MatteFloats[MATTE_LANES];

typedef struct MatteVectors {
    MatteDoubles x, y, z;
} MatteVectors;

/* Lanes beyond the count may hold anything. */
typedef struct MattePacket {
    int count;
    MatteVectors position, normal, geometric; /* normals on the side that is seen, for shading and the shape's own */
    MatteFloats diffuse;
    /* the face, the density of points on it, the probability of having picked it */
    MatteVectors corner, edge1, edge2, face_normal;
    MatteDoubles density;
    MatteFloats pick_probability;
    MatteFloats along, across;             /* the point on it, see MeshLightPoint */
    MatteFloats direction_u, direction_v; /* in [0, 1) */
} MattePacket;

/* Direct-light samples of the faces, before their shadow rays are traced. */
typedef struct MatteLights {
    int found[MATTE_LANES];
    int behind[MATTE_LANES]; /* the back of the face lights the surface */
    MatteVectors origin, direction;
    MatteDoubles length;      /* of the ray */
    MatteFloats value;       /* of the BSDF over albedo, times the cosine */
    MatteFloats weight;      /* MIS weight over the density of the light sample */
} MatteLights;

/* BSDF samples: the rays that paths go on with. */
typedef struct MatteBounces {
    int found[MATTE_LANES];
    MatteVectors origin, direction;
    MatteFloats pdf;
} MatteBounces;

void matte_lights(MatteLights *lights, const MattePacket *packet);
void matte_bounces(MatteBounces *bounces, const MattePacket *packet);

static inline void matte_set(MatteVectors *to, int lane, Vec3 v)
{
    to->x[lane] = v.x, to->y[lane] = v.y, to->z[lane] = v.z;
}
static inline Vec3 matte_get(const MatteVectors *from, int lane)
{
    return vec3(from->x[lane], from->y[lane], from->z[lane]);
}

#endif
