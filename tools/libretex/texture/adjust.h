/* Adjustments of a texture's colours, see retex/texture.h. Private to libretex. */
#ifndef RETEX_TEXTURE_ADJUST_H
#define RETEX_TEXTURE_ADJUST_H

#include "texture/pyramid.h"

/* RETEX_EINVAL: one has a value that it cannot have. */
int retex_adjust_check(const RetexTextureSpec *spec, RetexError *err);
/* Adjust a colour, of which there is nothing else. */
void retex_adjust_color(const RetexTextureSpec *spec, float rgb[3]);
/* Adjust the texels of an image. delta_e: how far, as CIEDE2000, the mean colour is in the end from that of `colorize`;
 * 0 without it. */
int retex_adjust_texels(const RetexTextureSpec *spec, RetexTexels *texels, double *delta_e, int nthreads,
                        RetexError *err);

#endif
