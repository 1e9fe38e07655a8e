/* The textures that a user puts on a set's targets, checked and loaded. Private to libretex. */
#ifndef LIBRETEX_TARGET_TEXTURES_H
#define LIBRETEX_TARGET_TEXTURES_H

#include <retex/set.h>
#include <retex/texture.h>

typedef struct TargetTextures {
    RetexTexture *of[RETEX_MAX_TARGETS];      /* by target; NULL = keeps its original */
    RetexTexture *squares[RETEX_MAX_TARGETS]; /* of their colours, where asked for */
} TargetTextures;

/* specs[0..nspecs) name their targets, each at most once; their footprints must be in the set. */
int target_textures_load(TargetTextures *textures, const RetexSet *set, const RetexTextureSpec *specs, int nspecs,
                         int with_squares, int nthreads, RetexError *err);
void target_textures_close(TargetTextures *textures);

#endif
