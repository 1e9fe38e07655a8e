/* Pigments, patterns, colour maps, warps. */
#ifndef RENDERER_SDL_TEXTURE_PIGMENT_H
#define RENDERER_SDL_TEXTURE_PIGMENT_H

#include "sdl/texture/image.h"

typedef struct ParsedPigment {
    Pigment pigment;
    int averaged;      /* 1: the pattern is not supported; kind is a colour, the map's mean */
    const char *file;  /* where its colour is written, for messages; line 0: nowhere */
    int line, warned;    /* warned: that it is no albedo */
    int parts, depth;    /* of its map, see ParsedColorMap */
    Gaps gaps;
    struct ParsedPigment *next; /* all there are */
} ParsedPigment;

static inline const ParsedPigment *parsed_pigment(const Pigment *pigment)
{
    return PARSED(ParsedPigment, pigment, pigment);
}

typedef struct ParsedColorMap {
    ColorMap map;
    int parts, depth; /* entries, with those of its pigments' maps; how deep these are nested */
    Gaps gaps;
} ParsedColorMap;

struct ParsedTextureMap;

/* pigment.c, pattern.c, image.c */
ParsedPigment *pigment_new(Sdl *sdl, const ParsedPigment *from /* or NULL */);
ParsedPigment *parse_pigment_body(Sdl *sdl, const ParsedPigment *from, char end);
ParsedPigment *parse_pigment(Sdl *sdl, const ParsedPigment *from); /* with its braces */
/* The same, of a texture without uv_mapping, which would change it: it may be another texture's too. */
ParsedPigment *parse_shared_pigment(Sdl *sdl, const ParsedPigment *from);
const Pigment *parse_uv_pigment(Sdl *sdl); /* of the block `retex` and the like: on the shape's UV, with its braces */
/* A pattern of textures, up to the end: the pattern as a pigment without colours, and its textures in map. */
ParsedPigment *parse_selector(Sdl *sdl, char end, struct ParsedTextureMap *map);
ParsedColorMap *parse_color_map(Sdl *sdl);   /* after color_map */
ParsedColorMap *parse_pigment_map(Sdl *sdl); /* after pigment_map */
/* A pattern's keyword and arguments, no list of colours. Of `object`, the list and the closing brace follow. */
int accept_pattern_word(Sdl *sdl, ParsedPigment *pigment);
void parse_pattern_data(Sdl *sdl, ParsedPigment *pigment);        /* pattern_data.c: after the keyword */
int accept_pattern_data_modifier(Sdl *sdl, Pattern *pattern);
/* textures: gets a list of textures in place of colours; NULL: there are colours. */
int accept_pattern(Sdl *sdl, ParsedPigment *pigment, struct ParsedTextureMap *textures);
int accept_pattern_modifier(Sdl *sdl, ParsedPigment *pigment);
/* Of the colours that POV-Ray takes where none are given. */
ParsedColorMap *color_list_new(Sdl *sdl, const PatternOps *ops);
void color_map_set(Sdl *sdl, ParsedColorMap *map, int entry, const ParsedPigment *pigment);
void pigment_set_map(ParsedPigment *pigment, const ParsedColorMap *map);
/* warp.c */
int accept_turbulence(Sdl *sdl, Turbulence *turbulence); /* turbulence, octaves, lambda or omega */
int accept_warp(Sdl *sdl, Pigment *pigment);

/* field.c: see SdlBuilder */
int parse_field(Sdl *sdl, const char *word, FunctionForeign *function);

/* albedo.c */
int finish_is_emitter(const Finish *finish); /* 1: its pigment stands for light */
void check_albedo(Sdl *sdl, const Texture *texture);

#endif
