/* Texels that are no colour of a surface: what becomes of them, and what is said of them. The rules stand in
 * <retex/texture.h>, at retex_texture_load. Private to libretex. */
#ifndef RETEX_TEXTURE_TEXEL_DEFECTS_H
#define RETEX_TEXTURE_TEXEL_DEFECTS_H

#include <retex/texture.h>

typedef enum RetexTexelDefect {
    RETEX_TEXEL_NOT_FINITE,
    RETEX_TEXEL_TOO_LARGE,
    RETEX_TEXEL_NEGATIVE,
    RETEX_TEXEL_BRIGHT,
    RETEX_TEXEL_DEFECTS
} RetexTexelDefect;

/* How many texels are of each kind, and where the first is; a texel may be of several. */
typedef struct RetexTexelDefects {
    long count[RETEX_TEXEL_DEFECTS];
    int x[RETEX_TEXEL_DEFECTS], y[RETEX_TEXEL_DEFECTS];
    float brightest; /* the largest channel of a bright one */
} RetexTexelDefects;

/* Make colours of width texels of row y, R,G,B,A with alpha unassociated, and count those that were none. */
void retex_texel_defects_repair(float *rgba, int width, int y, RetexTexelDefects *defects);
/* Put rows together, in their order. */
void retex_texel_defects_merge(RetexTexelDefects *defects, const RetexTexelDefects *row);
/* A constant: as a single texel. */
void retex_texel_defects_repair_color(float color[3], RetexTexelDefects *defects);

/* In texel_defects_kernel.c: 1 where all are from 0 to 1. */
int retex_texels_are_in_range(const float *values, size_t count);

/* Say what there is to be said of the texture that spec describes, line by line; texels: how many it has. */
void retex_texel_defects_report(const RetexTexelDefects *defects, const RetexTextureSpec *spec, long texels);

#endif
