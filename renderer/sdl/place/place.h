/* Objects become the scene's primitives, lights and instances, and what waits for the end of the scene is done. */
#ifndef RENDERER_SDL_PLACE_PLACE_H
#define RENDERER_SDL_PLACE_PLACE_H

#include "sdl/object/object.h"

#define PLACED_CACHE 256
typedef struct PlacedTexture {
    const ParsedTexture *from, *to;
    Transform by;
} PlacedTexture;

typedef struct CsgRoot {
    CsgNode *root;
    const Prototype *prototype; /* or NULL */
    int line;
} CsgRoot;

typedef struct PlaceState {
    int primitive_capacity, light_capacity, instance_capacity;
    unsigned char *single_triangle; /* of each primitive */
    CsgRoot *csg_roots;             /* placed, to be completed with the scene */
    int ncsg_roots, csg_capacity;
    PlacedTexture placed[PLACED_CACHE];
    const FaceTextures *placed_textures, *placed_textures_from; /* the last that were placed */
    Transform placed_textures_by;
    struct CopiedCompounds *copied; /* instance.c: compounds that were placed */
    const Prototype *prototypes; /* all, the last first */
    const ParsedTexture *inherited_texture; /* stands for the instance's while a prototype is placed */
} PlaceState;

void place_begin(Sdl *sdl);

static inline PlaceState *places_of(Sdl *sdl)
{
    return builder_of(sdl)->place;
}

/* What a child inherits from the compounds around it. */
typedef struct Inherited {
    Transform to_world;
    const ParsedTexture *texture, *interior_texture; /* in world space */
    const ParsedInterior *interior;
    int uv_mapping;
    unsigned flags;
    const IdentList *idents;
    const PlaceList *places;
    const LightGroup *light_group;
    CsgNode *csg; /* the node that it is an operand of, or NULL */
    struct Cutaway *cutaway; /* of the tree of CSG that it is in, where that has cutaway_textures, or NULL */
    int is_taken_off;        /* it is in an operand that a difference takes off */
    const Prototype *prototype; /* that it is part of, or NULL: then the world is its space */
} Inherited;

/* cutaway.c: a tree of CSG with cutaway_textures while it is placed. */
typedef struct CutOperand {
    const ParsedTexture *texture;
    const IdentList *idents;
    const CsgNode *node;
} CutOperand;
typedef struct Cutaway {
    int nbare, bare_capacity, ncut, cut_capacity;
    int *bare;       /* primitives that are to show textures of others */
    CutOperand *cut; /* those with textures */
} Cutaway;
/* The last primitive, which was placed with this texture. */
void cutaway_add(Sdl *sdl, const Inherited *in, const ParsedTexture *texture);
void cutaway_complete(Sdl *sdl, const Cutaway *cutaway);

/* caustics.c, at the end of reading: which light sources throw caustics, by which primitives. */
void find_caustics(Sdl *sdl);
void place_object(Sdl *sdl, const Object *object, const Inherited *around);
int place_instance(Sdl *sdl, const Object *object, const Inherited *around); /* 0: it is to be placed by itself */
unsigned flags_within(const Object *object, const Inherited *around);
const ParsedTexture *texture_placed(Sdl *sdl, const ParsedTexture *texture, const Transform *by);
void texture_report(Sdl *sdl, const ParsedTexture *texture);
void complete_prototypes(Sdl *sdl);
void complete_csgs(Sdl *sdl);
/* mesh_tangents.c: once textures are complete */
void add_tangents(Sdl *sdl);
void finalize_scene(Sdl *sdl);         /* everything that waits for the end of the scene */

#endif
