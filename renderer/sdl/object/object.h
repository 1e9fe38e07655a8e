/* Objects, light sources among them. Their transforms are kept apart from their geometry. */
#ifndef RENDERER_SDL_OBJECT_OBJECT_H
#define RENDERER_SDL_OBJECT_OBJECT_H

#include "sdl/medium/interior.h"
#include "shape/csg.h"

typedef enum ObjectKind { OBJECT_EMPTY, OBJECT_SHAPE, OBJECT_COMPOUND, OBJECT_LIGHT } ObjectKind;
enum {
    OBJECT_NO_SHADOW = 1,
    OBJECT_NO_IMAGE = 2,
    OBJECT_NO_REFLECTION = 4,
    OBJECT_INVERSE = 8,
    OBJECT_HOLLOW = 16,
    OBJECT_CUTAWAY_TEXTURES = 32,
    OBJECT_LIGHT_GROUP = 64,
    OBJECT_GLOBAL_LIGHTS = 128, /* of a light_group */
    OBJECT_PHOTON_TARGET = 256, /* the following two count with it */
    OBJECT_PHOTONS_REFRACT = 512,
    OBJECT_PHOTONS_REFLECT = 1024,
    OBJECT_DOUBLE_ILLUMINATE = 2048
};

typedef struct ObjectList {
    const struct Object *object;
    struct ObjectList *next;
} ObjectList;

/* Objects of clipped_by or bounded_by, each added before the others. */
typedef struct ClipList {
    const struct Object *object;
    Transform written; /* the clipped object's transform where they were written: what moves it later moves them */
    const struct ClipList *next;
} ClipList;

/* Of single triangles: not yet with neighbours in one mesh, or that mesh. */
typedef enum TriangleKind { TRIANGLE_NOT, TRIANGLE_SINGLE, TRIANGLES_GATHERED } TriangleKind;

typedef struct Object {
    ObjectKind kind;
    Shape shape;      /* its textures are ParsedTextures in the shape's own space */
    TriangleKind single_triangle;
    int polygon;      /* the mesh is a polygon */
    const Light *light;
    const struct Object *projector; /* of a light: what its light passes through, in its space; or NULL */
    CsgKind csg;                /* of a compound */
    int difference;             /* an intersection written as one */
    const ObjectList *children; /* of a compound; of a light: what it looks like */
    const ClipList *clips, *bounds;
    Transform transform;        /* canonical shape, or the children's space, to here */
    MovedTexture texture, interior_texture;
    const ParsedInterior *interior;
    Transform interior_transform; /* what moved it since, where its media vary */
    unsigned flags;
    int uv_mapping;
    int depth;    /* of nested compounds */
    double parts; /* objects in it, counted through identifiers */
    const IdentList *idents;
    const PlaceList *places;
    int line;
    Gaps gaps;
} Object;

/* ---- the state ---- */

typedef struct ObjectState {
    Object *spare; /* memory for the next one */
    struct Tracer *tracer; /* trace.c: objects made ready for rays */
    struct FontFiles *fonts; /* font.c */
    struct IesFile *ies_files; /* ies.c */
} ObjectState;

void object_begin(Sdl *sdl);

static inline ObjectState *objects_of(Sdl *sdl)
{
    return builder_of(sdl)->object;
}

/* object.c */
const Object *accept_object(Sdl *sdl); /* an object statement or identifier, or NULL where none is next */
Object *object_new(Sdl *sdl, ObjectKind kind);
const PlaceList *places_join(Sdl *sdl, const PlaceList *within, const PlaceList *around);
void object_report(Sdl *sdl, const Object *object); /* what of it is not supported */
void object_count_child(Sdl *sdl, Object *object, const Object *child); /* counts; an error beyond all bounds */
void object_move(Object *object, const Transform *by);
void parse_object_modifiers(Sdl *sdl, Object *object); /* up to the closing brace */
/* Nothing needs the object any more: it is placed, and has no name. */
void object_done(Sdl *sdl, const Object *object);
/* photons.c: photons{…} of an object or light: sets and clears OBJECT_PHOTON… in flags. */
void parse_photons(Sdl *sdl, unsigned *flags);

/* light.c, ies.c */
const Object *parse_light_source(Sdl *sdl); /* after light_source */
const struct Ies *parse_ies(Sdl *sdl); /* the name of a file that has a light distribution, after `ies` */

/* gather_triangles.c: single triangles become meshes. Of children of a union: */
void gather_children(Sdl *sdl, Object *compound);
/* Of the scene's primitives; single: for each, whether it is one. */
void gather_triangles(Sdl *sdl, const unsigned char *single);

/* extent.c, trace.c: see SdlBuilder */
int object_extent(Sdl *sdl, const Value *object, Vec3 *low, Vec3 *high);
int object_trace(Sdl *sdl, const Value *object, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal);
int object_inside(Sdl *sdl, const Value *object, Vec3 p);
const Csg *object_solid(Sdl *sdl, const Object *object); /* in its own space; kept for the next call */

#endif
