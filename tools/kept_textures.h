/* Textures that stay in memory from one picture to the next, in batches and animations: an image that both have is
 * read, and its pyramid built, only once. */
#ifndef RETEX_KEPT_TEXTURES_H
#define RETEX_KEPT_TEXTURES_H

#include <retex/combine.h>

/* Zero-initialized. */
typedef struct KeptTextures {
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int targets[RETEX_MAX_TARGETS]; /* by spec */
    int count;
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target of the set */
} KeptTextures;

/* Have the textures of these specs, for this set, and only them. The specs name targets of the set. After a failure
 * there are none. */
int kept_textures_load(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count, int nthreads,
                       RetexError *err);
void kept_textures_close(KeptTextures *kept);

#endif
