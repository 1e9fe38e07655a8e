/* Shapes, primitives and their copies in a scene (scene.h). */
#ifndef RENDERER_SCENE_PRIMITIVE_H
#define RENDERER_SCENE_PRIMITIVE_H

#include "scene/texture.h"

/* Triangles. Indices are into the arrays; a normal or UV index of -1 means that the corner has none. */
typedef struct MeshFace {
    int vertex[3], normal[3], uv[3];
    int texture;             /* index into the shape's textures; -1 = the primitive's own texture */
} MeshFace;
/* Of corners, for normal maps; see mesh_add_tangents. */
typedef struct MeshTangents {
    int count;
    Vec3 *vectors;           /* of unit length */
    int (*corners)[3];       /* of each face: indices, or -1 in all three */
} MeshTangents;
typedef struct Mesh {
    int nvertices, nnormals, nuvs, nfaces;
    Vec3 *vertices, *normals;
    Vec2 *uvs;
    MeshFace *faces;
    int (*corner_textures)[2]; /* of each face: textures of corners 1 and 2, where `texture` is that of corner 0; or
                                  NULL: each face has one texture */
    int closed_inside;       /* inside_vector was given: has an inside */
    int inward;              /* 1: the faces' winding (edge 01 x edge 02) points inside; set from mesh_winds_inward */
    const struct Bvh *tree;  /* over the faces, or NULL: see mesh_index */
    const MeshTangents *tangents; /* or NULL: each face has its own */
    const struct Mesh *second;    /* the same mesh with its second set of UV, or NULL */
} Mesh;

static inline int mesh_face_has_normals(const MeshFace *f)
{
    return f->normal[0] >= 0 && f->normal[1] >= 0 && f->normal[2] >= 0;
}
static inline int mesh_face_has_uvs(const MeshFace *f) { return f->uv[0] >= 0 && f->uv[1] >= 0 && f->uv[2] >= 0; }

static inline int mesh_face_blends(const Mesh *mesh, int face)
{
    const int *others = mesh->corner_textures ? mesh->corner_textures[face] : NULL;
    return others && (others[0] != mesh->faces[face].texture || others[1] != mesh->faces[face].texture);
}

typedef struct ShapeOps ShapeOps; /* shape/shape.h */

/* Textures of parts of a shape, in world space like all textures. ShapeOps.texture says which a point has. */
typedef struct FaceTextures {
    int count;
    const Texture **list;
} FaceTextures;

/* A shape in its canonical space, which shape/NAME.c describes, with its parameters there. */
typedef struct Shape {
    const ShapeOps *ops;
    double r0, r1;           /* radii, exponents and the like */
    int open;                /* of a cone: without caps */
    const Mesh *mesh;        /* of a mesh, and of nothing else; shared by copies that differ in transform only */
    const void *data;        /* what else the shape's operations read */
    const FaceTextures *textures; /* or NULL: the primitive's own is on all of it */
} Shape;

/* Primitives in a space of their own. They are where the prototype's instances are, and nowhere else. */
typedef struct Prototype {
    int number;              /* index into scene->prototypes */
    int first, count;        /* of scene->primitives */
    int ncsgs;
    struct Csg **csgs;       /* its trees: indices of their leaves count from first */
    int inherits;            /* some of its primitives do */
    const struct Prototype *next;
} Prototype;

/* A copy of a prototype. Where it has names or a texture that are targets, so are the primitives that have them. */
typedef struct Instance {
    const Prototype *prototype;
    Transform transform;     /* the prototype's space to the world */
    const Texture *texture;  /* in the prototype's space: of primitives that inherit theirs; NULL where none does */
    const IdentList *idents;
    const PlaceList *places;
    int target, texture_target; /* by idents; by the texture. -1: none */
    int lamp;                /* that its emission is of; -1: those of its primitives */
    int line;
} Instance;

/* Faces of a primitive that are targets by themselves, whatever the rest of it is. */
typedef struct FaceTargets {
    const int8_t *of;        /* of each face, as Hit counts them: the target, or -1 */
    int count;               /* the textures of these faces, each with each of their targets */
    struct FaceTexture {
        const Texture *texture;
        int target;
    } *textures;
} FaceTargets;

typedef struct Primitive {
    Shape shape;
    Transform transform;     /* canonical shape to world */
    const Texture *texture;  /* never NULL after parsing */
    const Texture *interior_texture; /* or NULL: the same on both sides */
    const Interior *interior; /* or NULL */
    int no_shadow, no_image, no_reflection, inverse, hollow;
    int double_illuminate;   /* 1: its diffuse lobes take light from both sides */
    const struct CsgNode *csg; /* its place in the tree of which it is an operand, or NULL; shape/csg.h */
    const struct LightGroup *light_group; /* that it is in, or NULL */
    const Prototype *prototype; /* that it is part of: its world is the prototype's space; or NULL */
    int inherits;            /* 1: its texture is the instance's */
    int is_solid;            /* 1: neither fog nor media are in it; 0 where the scene has none */
    int caustics;            /* CAUSTICS_…: of light sources that have caustics */
    const IdentList *idents; /* names of the objects it is part of */
    const PlaceList *places; /* their statements; NULL where the scene is made without a file */
    int line;                /* of the scene file, for messages */
    int target;              /* index into scene->targets, or -1; parts may have others, see face_targets */
    int interior_target;     /* the same for interior_texture */
    const int8_t *face_targets; /* of each of the shape's textures, or NULL: their targets instead */
    const FaceTargets *faces; /* or NULL: no face is a target by itself */
    int lamp;                /* of the scene's lamps, that its emission is of */
    const struct Target *unit_targets; /* the scene's targets, where one has a uv_unit or a projection, else NULL */
} Primitive;

#endif
