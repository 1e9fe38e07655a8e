/* Texels that cannot be colours of a surface: how they are repaired and reported. The rules are in <retex/texture.h>,
 * at retex_texture_load. Private to libretex. */
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

/* The number of texels with each defect, and the first of them; a texel may have several. */
typedef struct RetexTexelDefects {
    long count[RETEX_TEXEL_DEFECTS];
    int x[RETEX_TEXEL_DEFECTS], y[RETEX_TEXEL_DEFECTS];
    float brightest; /* the largest channel of all texels that are too bright */
} RetexTexelDefects;

/* Repair width texels of row y, R,G,B,A with alpha unassociated, and count their defects. */
void retex_texel_defects_repair(float *rgba, int width, int y, RetexTexelDefects *defects);
/* Add the defects of a row, in the order of rows. */
void retex_texel_defects_merge(RetexTexelDefects *defects, const RetexTexelDefects *row);
/* Repair a constant colour, as a single texel. */
void retex_texel_defects_repair_color(float color[3], RetexTexelDefects *defects);

/* In texel_defects_kernel.c: 1 if all values are from 0 to 1. */
int retex_texels_are_in_range(const float *values, size_t count);

/* Report the defects of the texture that spec describes, one line each; texels: how many it has. */
void retex_texel_defects_report(const RetexTexelDefects *defects, const RetexTextureSpec *spec, long texels);

#endif
