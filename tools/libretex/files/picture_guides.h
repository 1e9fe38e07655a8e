/* The guides of a picture that is no set. Private to libretex. */
#ifndef RETEX_FILES_PICTURE_GUIDES_H
#define RETEX_FILES_PICTURE_GUIDES_H

#include <retex/set.h>

/* Images of three channels, of the picture's size; those that a picture lacks are not allocated. */
typedef struct RetexPictureGuides {
    RetexImage normal, position;           /* of the first hit; used if has_first is 1 */
    RetexImage seen_normal, seen_position; /* of what is seen in mirrors and through glass, as far as known */
    RetexImage albedo;
    int has_first;
} RetexPictureGuides;

/* Turn depths, of three equal channels, into positions, where the field of view is not known: x and y in units of
 * the picture's width, and the logarithm of the depth. A plane stays about plane. */
void retex_picture_depth_to_position(RetexImage *depth);
/* Normals of a picture's positions: at right angles to the smaller of the differences to both sides. */
int retex_picture_derive_normals(RetexImage *normal, const RetexImage *position, RetexError *err);
/* Sort what was found: a position gets the normals that belong to it; two kinds of normals are of two hits. */
int retex_picture_guides_finish(RetexPictureGuides *guides, int has_depth, RetexError *err);
void retex_picture_guides_close(RetexPictureGuides *guides);

/* Append a part with a copy of an image; without one, value everywhere. */
int retex_picture_add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type,
                           const RetexImage *from, float value, RetexError *err);
/* Append the parts that denoising goes by. with_albedo 0: surfaces are white. */
int retex_picture_add_guides(RetexSet *set, const RetexPictureGuides *guides, int with_albedo, RetexError *err);

/* A set without terms, for retex_denoise, of this beauty and noise. with_albedo 0: surfaces are white. */
int retex_picture_set(RetexSet **set, const RetexImage *beauty, const RetexImage *noise,
                      const RetexPictureGuides *guides, int with_albedo, RetexError *err);

#endif
