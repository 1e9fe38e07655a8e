/* Which finish of its target a texture has where: the picture `finish` of RetexTextureSpec, or the roughness of a
 * folder. Private to libretex. */
#ifndef RETEX_TEXTURE_FINISH_MAP_H
#define RETEX_TEXTURE_FINISH_MAP_H

#include "texture/pyramid.h"

/* What a picture says at a texel. */
typedef enum RetexFinishScale {
    RETEX_FINISH_BY_LIST,      /* grey: 0 is the first finish, 1 the last, between them in the order of the list. Else
                                  red is the second finish, green the third, blue the fourth, and the rest the first */
    RETEX_FINISH_BY_ROUGHNESS, /* roughness: finishes by their own, between the two that are next to it */
    RETEX_FINISH_BY_GLOSS,     /* the same of 1 minus the value */
    RETEX_FINISH_BY_NORMAL,    /* a normal map whose green points up, see normal_map.h */
    RETEX_FINISH_BY_NORMAL_DX  /* down */
} RetexFinishScale;

/* 1: enough finishes have a roughness that a map of it can choose from. */
int retex_finish_map_has_scale(const RetexTextureSpec *spec);

/* Weights of spec->nfinishes finishes by one texel of the map, r, g and b: they sum to 1. is_grey: 1 if all channels
 * are equal all over the map. channel: which one says the roughness. */
void retex_finish_map_weights(const RetexTextureSpec *spec, RetexFinishScale scale, int channel, int is_grey,
                              const float rgb[3], float weights[RETEX_FINISHES_MAX]);

/* Make texture->finishes from a picture of four channels, as numbers, and the texture's texels, premultiplied and not
 * yet arranged as repeats; NULL: a constant. The larger of both sizes counts; the other is interpolated. */
int retex_finish_map_make(RetexTexture *texture, const RetexTexels *color, const RetexImage *map,
                          RetexFinishScale scale, int channel, int nthreads, RetexError *err);

#endif
