/* Normal maps: a normal is a sum of three, those of the finishes of a target that takes such maps. With the angle t
 *
 *     n = w0 (0, 0, 1) + w1 (sin t, 0, cos t) + w2 (0, sin t, cos t)
 *
 * and light that is reflected diffusely is nearly linear in the normal. Weights have either sign. They need not sum
 * to 1: what is missing is that of a fourth finish, which is black. Private to libretex. */
#ifndef RETEX_TEXTURE_NORMAL_MAP_H
#define RETEX_TEXTURE_NORMAL_MAP_H

#include "texture/pyramid.h"

/* The weights of a texel of the map, r, g, b and a, 0 to 1, on the surface: turned as the texture lies there;
 * mirrored: by axis, 1 in a repeat that is mirrored along it. is_dx: green points down. */
void retex_normal_map_weights(const RetexTextureSpec *spec, int is_dx, const int mirrored[2], const float rgba[4],
                              float weights[RETEX_FINISHES_MAX]);

/* How many repeats of the map are one image: two along an axis whose every second repeat is mirrored, for there the
 * normals are others. spec: of a texture that was made, whose wrap modes say it all. */
void retex_normal_map_repeats(const RetexTextureSpec *spec, int repeats[2]);
/* The texel of the map, from the left or the top, of place i of an image with all its repeats; *mirrored: of a
 * repeat that is mirrored. Rows go down and v goes up: of two repeats the lower one is the first. */
static inline int retex_normal_map_texel(int axis, int i, int texels, int repeats, int *mirrored)
{
    const int is_second = i >= texels;
    *mirrored = repeats == 2 && is_second != axis;
    i = is_second ? i - texels : i;
    return *mirrored ? texels - 1 - i : i;
}

/* The weights of all texels of a map of four channels, unassociated, with these repeats: of the second finish and later
 * ones, the last number is 1. texels have the size. */
void retex_normal_map_weigh(const RetexTextureSpec *spec, const RetexImage *map, int is_dx, const RetexTexels *texels,
                            int nthreads);

#endif
