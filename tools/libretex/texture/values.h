/* Texels that are no colour of a surface: what becomes of them, and what is said of them. The rules stand in
 * <retex/texture.h>, at retex_texture_load. Private to libretex. */
#ifndef RETEX_TEXTURE_VALUES_H
#define RETEX_TEXTURE_VALUES_H

#include <retex/texture.h>

typedef enum TextureOddity {
    TEXEL_NOT_FINITE,
    TEXEL_TOO_LARGE,
    TEXEL_NEGATIVE,
    TEXEL_BRIGHT,
    TEXTURE_ODDITIES
} TextureOddity;

/* How many texels are of each kind, and where the first is; a texel may be of several. */
typedef struct TextureValues {
    long count[TEXTURE_ODDITIES];
    int x[TEXTURE_ODDITIES], y[TEXTURE_ODDITIES];
    float brightest; /* the largest channel of a bright one */
} TextureValues;

/* Make colours of width texels of row y, R,G,B,A with alpha unassociated, and count those that were none. */
void texture_values_mend(float *rgba, int width, int y, TextureValues *values);
/* Put rows together, in their order. */
void texture_values_join(TextureValues *values, const TextureValues *row);
/* A constant: as a single texel. */
void texture_values_mend_color(float color[3], TextureValues *values);

/* In values_kernel.c: 1 where all are from 0 to 1. */
int texture_values_are_plain(const float *values, size_t count);

/* Say what there is to be said of the texture that spec describes, line by line; texels: how many it has. */
void texture_values_tell(const TextureValues *values, const RetexTextureSpec *spec, long texels);

#endif
