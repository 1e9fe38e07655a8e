/* The emitting faces of a mesh in world space, ready to be sampled. */
#ifndef RENDERER_LIGHT_MESH_LIGHT_H
#define RENDERER_LIGHT_MESH_LIGHT_H

#include "shape/surface.h"

typedef struct MeshLightFace {
    Vec3 corner, edge1, edge2;
    Vec3 normal; /* of the surface: outward, unit length */
    double inverse_area;
    double share;           /* of the mesh's power */
    float radiance;         /* luminance of its emission */
    int face, target;       /* of the mesh; of the face's outside */
    const Texture *texture; /* of its outside */
    int uniform;            /* it is no target and its radiance is uniform: emission, of its outside and inside */
    Rgb emission[2];
} MeshLightFace;

typedef struct MeshLight {
    int count;
    MeshLightFace *faces;
    double *sums;       /* running sums of shares, count + 1, the last one 1 */
    int *of_face;       /* by face of the mesh: index into faces, or -1 */
    double area, power; /* power: luminance of emission times area */
    int closed;         /* its faces' area vectors add up to 0: the outside is what is seen most */
} MeshLight;

/* A point of a face: a share `along` of the way from its corner to the opposite edge, and a share `across` of that edge
 * from the end of edge1. */
typedef struct MeshLightPoint {
    const MeshLightFace *face;
    float along, across;
    double density; /* of such points, by area */
} MeshLightPoint;

/* *light is NULL where no face emits. */
int mesh_light_create(MeshLight **light, const Primitive *primitive, RetexError *err);
void mesh_light_close(MeshLight **light);
/* A point of a face, uniform in area, by u1 and u2 in [0,1). face: -1 for one chosen by its power. */
MeshLightPoint mesh_light_point(const MeshLight *light, int face, float u1, float u2);
/* There: a Surface of backside 0 as from shape_sample, but with the shading normal of a flat face. */
void mesh_light_surface(const MeshLightPoint *point, const Primitive *primitive, Surface *surface);

#endif
