/* What all rooms of statements share: the state that lasts while a scene is read, small helpers, and the report of what
 * is not supported.
 *
 * Everything that can be #declared is immutable once it is read: a change (a transform, another finish, a name) is made
 * on a copy, so identifiers share what they have in common.
 *
 * Where the language asks for more than the renderer has, the thing is marked with a Gap and reported when it is
 * placed, not when it is declared: the standard includes declare hundreds of textures that no scene uses all of. */
#ifndef RENDERER_SDL_STATE_BUILDER_H
#define RENDERER_SDL_STATE_BUILDER_H

#include <stddef.h>
#include <stdint.h>
#include "sdl/lang/parser.h"

/* ---- what is not supported ---- */

#define GAP_TABLE(X) \
    X(MAP_TYPE, "this map_type", "the image is mapped as a plane") \
    X(FAKE_CAUSTICS, "interior caustics", "it is ignored, see photons") \
    X(FINISH_FRESNEL, "finish fresnel", "it is ignored")

typedef enum Gap {
#define X(id, name, instead) GAP_##id,
    GAP_TABLE(X)
#undef X
    GAP_COUNT
} Gap;
typedef struct Gaps { uint64_t bits, patterns; } Gaps; /* by Gap; by the index of the pattern */
_Static_assert(GAP_COUNT <= 64, "Gaps is too small");

void gaps_add(Gaps *gaps, Gap gap);
void gaps_add_pattern(Gaps *gaps, int pattern);
void gaps_join(Gaps *gaps, const Gaps *other);
void gaps_report(Sdl *sdl, const Gaps *gaps);

/* What is read becomes a part of the scene and what only reading needs: both are members of one Parsed…. This is the
 * whole, of its part in the scene; or NULL of NULL. */
#define PARSED(type, member, part) ((part) ? (const type *)((const char *)(part)-offsetof(type, member)) : NULL)

/* ---- the state ---- */

/* What global_settings says, and what it is without them. */
typedef struct GlobalSettings {
    int has_assumed_gamma;
    int gamma_srgb; /* `assumed_gamma srgb` */
    double assumed_gamma;
    double gamma_version; /* the version where it was set */
    int radiosity;        /* there is a block of it */
    int photons;          /* there is a block of them */
    Rgb irid_wavelength;
    int name_capacity, offered_capacity; /* of the scene's names, and of the targets that it offers */
    int has_subsurface; /* there is the block, without which POV-Ray has none either */
    double mm_per_unit;
} GlobalSettings;

/* Each room has a state of its own, which its header describes. */
typedef struct Builder {
    GlobalSettings global;
    int depth; /* of nested statements being read */
    struct TextureState *texture;
    struct ObjectState *object;
    struct CameraState *camera;
    struct PlaceState *place;
    /* The object of a pattern `object{…}`, or NULL where none is next: the grammar is recursive, and textures know no
     * objects. */
    const struct Csg *(*accept_solid)(Sdl *sdl);
} Builder;

static inline Builder *builder_of(Sdl *sdl)
{
    return sdl_builder_state(sdl);
}

/* Nesting of statements that the parser recurses for; an error when too deep. */
void statement_begin(Sdl *sdl);
void statement_end(Sdl *sdl);

/* The value of the next token where it is an identifier of that kind, else NULL. */
Value *peek_ident(Sdl *sdl, ValueKind kind);
/* … taken: its data, or NULL. */
void *accept_ident(Sdl *sdl, ValueKind kind);
/* The same of a VALUE_OTHER with that word. */
void *accept_ident_of_word(Sdl *sdl, const char *word);
/* 1 where the next token begins a number (not a vector or colour). */
int is_float_start(Sdl *sdl);
double optional_float(Sdl *sdl, double missing);
/* A word that introduces a block which is skipped. */
void skip_statement(Sdl *sdl);

/* transform.c */
int accept_transform(Sdl *sdl, Transform *by); /* one translate, rotate, scale, matrix or transform */
Transform parse_transform(Sdl *sdl);           /* after `transform` */
int transform_is_identity(const Transform *t);

/* working_space.c */
WorkingSpace working_space(Sdl *sdl);  /* as far as the scene is read */
Rgb decode_color(Sdl *sdl, Rgb color); /* from the working space */

#endif
