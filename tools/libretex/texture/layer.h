/* Layers: textures that lie on others. Private to libretex. */
#ifndef RETEX_TEXTURE_LAYER_H
#define RETEX_TEXTURE_LAYER_H

#include "texture/pyramid.h"

/* 1: there is no image below the layers. */
static inline int retex_texture_is_original(const RetexTextureSpec *spec)
{
    return spec->nlayers > 0 && !spec->constant && !spec->image[0];
}
/* RETEX_EINVAL: their number, or what lies below them, cannot be. */
int retex_layers_check(const RetexTextureSpec *spec, RetexError *err);
/* Lay a colour on another one, both with unassociated alpha. */
static inline void retex_lay_over(float below[4], const float over[4])
{
    const float rest = (1 - over[3]) * below[3], alpha = over[3] + rest;
    for (int c = 0; c < 3; c++)
        below[c] = alpha > 0 ? (over[3] * over[c] + rest * below[c]) / alpha : 0;
    below[3] = alpha;
}

#endif
