/* Textures: a pigment, a finish and a normal; layers and maps of textures. Their transforms are kept apart
 * (MovedTexture), which makes `object{Ident translate …}` one small copy however large Ident is. */
#ifndef RENDERER_SDL_TEXTURE_TEXTURE_H
#define RENDERER_SDL_TEXTURE_TEXTURE_H

#include "sdl/texture/finish.h"
#include "sdl/texture/normal.h"

/* How many plain textures a texture has, how many of them may be seen at one point, how deep maps are nested. */
typedef struct TextureCounts {
    int leaves, seen, depth;
} TextureCounts;

typedef struct ParsedTextureEntry {
    double value;
    const struct ParsedTexture *texture; /* where the whole is, not in the pattern's space; see texture_nested */
} ParsedTextureEntry;

/* Textures by the value of a pattern. */
typedef struct ParsedTextureMap {
    TextureTreeKind kind;          /* not of layers */
    const ParsedPigment *selector; /* NULL of maps that no texture has yet */
    const TextureOperands *operands;
    int count, capacity;
    ParsedTextureEntry *entries; /* in order of value */
    TextureCounts counts;
} ParsedTextureMap;

typedef struct ParsedTexture {
    Texture texture;                   /* its pigment, finish and normal are parsed ones */
    const struct ParsedTexture *below; /* the layer under it */
    const ParsedTextureMap *map;       /* or NULL; then it has no layers, and pigment and finish are of a first leaf */
    Gaps gaps;
    int is_complete; /* its tree is made, and the names of pigments are joined to those of textures */
} ParsedTexture;

static inline const ParsedTexture *parsed_texture(const Texture *texture)
{
    return PARSED(ParsedTexture, texture, texture);
}

/* A texture and the transform written after it: `sphere{… texture{T} rotate …}` only multiplies matrices. */
typedef struct MovedTexture {
    const ParsedTexture *texture; /* or NULL */
    int is_moved;
    Transform transform; /* where is_moved */
} MovedTexture;

/* ---- the state ---- */

#define PLAIN_PIGMENTS 1024

/* Lists are of what is decoded from the working space at the end, each once. */
typedef struct TextureState {
    const ParsedTexture *default_texture;
    ParsedPigment *pigments;
    ParsedPigment *plain_pigments[PLAIN_PIGMENTS]; /* of one colour, which textures share: by a hash of it */
    ParsedPigment *spare_pigment;                  /* memory for the next one */
    ParsedFinish *finishes;
    ParsedImage *images;
    int image_capacity;
} TextureState;

void texture_begin(Sdl *sdl);

static inline TextureState *textures_of(Sdl *sdl)
{
    return builder_of(sdl)->texture;
}
static inline const ParsedNormal *default_normal(Sdl *sdl)
{
    return parsed_normal(textures_of(sdl)->default_texture->texture.normal);
}
static inline const ParsedPigment *default_pigment(Sdl *sdl)
{
    return parsed_pigment(textures_of(sdl)->default_texture->texture.pigment);
}

/* texture_map.c */
ParsedTextureMap *parse_texture_map(Sdl *sdl); /* after texture_map */
/* `texture{…}` up to n times, in place of a list of colours. */
void parse_texture_list(Sdl *sdl, ParsedTextureMap *map, int n);
const ParsedTexture *parse_tiles(Sdl *sdl);        /* after tiles */
const ParsedTexture *parse_material_map(Sdl *sdl); /* after material_map */
/* Of a map without a selector. The textures are seen in the selector's pattern space. */
const ParsedTexture *texture_of_map(Sdl *sdl, const ParsedTextureMap *map, ParsedPigment *selector,
                                    TextureTreeKind kind);
/* A pattern with its textures, up to the end of the texture. */
const ParsedTexture *parse_texture_pattern(Sdl *sdl, char end, int uv_mapping);

/* texture_tree.c: what is done to all of a texture's layers and maps. Changed ones are copies. */
const ParsedTexture *texture_moved(Sdl *sdl, const ParsedTexture *texture, const Transform *by);
/* Lying in the pattern space of a pigment. */
const ParsedTexture *texture_nested(Sdl *sdl, const ParsedTexture *texture, const Pigment *in);
const ParsedTexture *texture_uv_mapped(Sdl *sdl, const ParsedTexture *texture);
const ParsedTexture *texture_named(Sdl *sdl, const ParsedTexture *texture, const IdentList *more);
const ParsedTexture *texture_over(Sdl *sdl, const ParsedTexture *top, const ParsedTexture *bottom);
TextureCounts texture_counts(Sdl *sdl, const ParsedTexture *texture); /* an error beyond all bounds */
void texture_check_counts(Sdl *sdl, const TextureCounts *counts);
/* Calls of each plain texture, layer or leaf, and of each pigment that chooses among textures. */
typedef void TextureVisitor(Sdl *sdl, const ParsedTexture *texture, void *context);
typedef void SelectorVisitor(Sdl *sdl, const ParsedTextureMap *map, void *context);
void texture_visit(Sdl *sdl, const ParsedTexture *texture, TextureVisitor *visit, SelectorVisitor *selector,
                   void *context);
/* The texture of the scene: its tree is made, where it is no plain texture. Only once nothing is read any more. */
const Texture *texture_complete(Sdl *sdl, const ParsedTexture *texture);

/* texture.c */
const ParsedTexture *parse_texture(Sdl *sdl); /* after `texture` */
const ParsedTexture *parse_texture_body(Sdl *sdl, char end);
/* pigment, finish or normal where the next token is one of them: changes the top layer of *texture (NULL = default). */
int accept_texture_part(Sdl *sdl, const ParsedTexture **texture);
ParsedTexture *texture_copy(Sdl *sdl, const ParsedTexture *from);

#endif
