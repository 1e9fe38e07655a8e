/* Interiors, their media, and materials: textures with an interior. */
#ifndef RENDERER_SDL_MEDIUM_INTERIOR_H
#define RENDERER_SDL_MEDIUM_INTERIOR_H

#include "sdl/texture/texture.h"

typedef struct ParsedInterior {
    Interior interior;
    int has_ior;       /* it is written */
    Gaps gaps;
} ParsedInterior;

static inline const ParsedInterior *parsed_interior(const Interior *interior)
{
    return PARSED(ParsedInterior, interior, interior);
}

typedef struct ParsedMedium {
    Medium medium;
    Rgb constant;  /* product of its densities that are the same everywhere */
    Gaps gaps;
} ParsedMedium;

static inline const ParsedMedium *parsed_medium(const Medium *medium)
{
    return PARSED(ParsedMedium, medium, medium);
}

typedef struct ParsedMaterial {
    const ParsedTexture *texture, *interior_texture;
    const ParsedInterior *interior;
    const IdentList *idents;
} ParsedMaterial;

/* interior.c */
const ParsedInterior *parse_interior(Sdl *sdl, const ParsedInterior *from);
const ParsedMaterial *parse_material(Sdl *sdl);

/* media.c */
ParsedMedium *parse_media(Sdl *sdl); /* after media */
const ParsedPigment *parse_density(Sdl *sdl); /* after density */
const Medium *media_with(Sdl *sdl, const Medium *list, const ParsedMedium *added);
int interior_varies(const ParsedInterior *interior); /* its media do, from place to place; NULL: 0 */
const ParsedInterior *interior_moved(Sdl *sdl, const ParsedInterior *interior, const Transform *by);
void complete_media(Sdl *sdl); /* with the images */

#endif
