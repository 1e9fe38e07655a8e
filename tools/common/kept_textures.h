/* Textures of one picture after the other, in batches and animations. Images stay in memory from one picture to the
 * next: an image is read, and its pyramid built, only once, however its placement changes. */
#ifndef RETEX_KEPT_TEXTURES_H
#define RETEX_KEPT_TEXTURES_H

#include <retex/combine.h>

enum { KEPT_IMAGES_MAX = 256 };

/* Zero-initialized. */
typedef struct KeptTextures {
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target of the set */
    RetexTexture *images[KEPT_IMAGES_MAX];     /* whose texels they share; the last used ones first */
    int nimages;
    RetexTextureSpec colors[RETEX_MAX_TARGETS]; /* of the last picture: warnings about them have been told */
    int ncolors;
    uint64_t most_bytes; /* images that the last picture does not use stay if all take at most this much */
} KeptTextures;

/* Have the textures of these specs, for this set. After a failure there are none. */
int kept_textures_load(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count, int nthreads,
                       RetexError *err);
void kept_textures_close(KeptTextures *kept);

#endif
