/* Normals, their maps, bump maps. */
#ifndef RENDERER_SDL_TEXTURE_NORMAL_H
#define RENDERER_SDL_TEXTURE_NORMAL_H

#include "sdl/texture/pigment.h"

typedef struct ParsedNormal {
    Normal normal;
    Gaps gaps;
} ParsedNormal;

static inline const ParsedNormal *parsed_normal(const Normal *normal)
{
    return PARSED(ParsedNormal, normal, normal);
}

typedef struct ParsedNormalMap {
    int count;
    NormalMapEntry *entries; /* ParsedNormals */
    Gaps gaps;
} ParsedNormalMap;

typedef struct ParsedSlopeMap {
    int count;
    SlopeMapEntry *entries;
} ParsedSlopeMap;

typedef struct ParsedBumpMap {
    BumpMap map;   /* heights and size are filled in when the scene is complete */
    int use_index; /* heights are the indices of a palette, if the picture has one */
} ParsedBumpMap;

static inline const ParsedBumpMap *parsed_bump_map(const BumpMap *map)
{
    return PARSED(ParsedBumpMap, map, map);
}

/* normal.c, bump_map.c */
const ParsedNormal *parse_normal(Sdl *sdl, const ParsedNormal *from /* or NULL */); /* after `normal` */
const ParsedNormalMap *parse_normal_map(Sdl *sdl); /* after normal_map */
const ParsedSlopeMap *parse_slope_map(Sdl *sdl);   /* after slope_map */
/* NULL stays NULL. */
const ParsedNormal *normal_moved(Sdl *sdl, const ParsedNormal *normal, const Transform *by);
const ParsedNormal *normal_changed(Sdl *sdl, const ParsedNormal *normal, int uv_mapping, int keeps_size);
void normal_load(Sdl *sdl, const Normal *normal);          /* the pictures of it, once it is known to be used */
const BumpMap *parse_bump_map(Sdl *sdl, double *size);     /* after bump_map; *size: where it says bump_size */
void load_bump_map(Sdl *sdl, const BumpMap *map);

#endif
