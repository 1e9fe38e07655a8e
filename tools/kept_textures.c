/* See kept_textures.h. */
#include <string.h>

#include "kept_textures.h"

/* Move a texture of the picture before into `next`, if it has it. */
static int take(KeptTextures *kept, KeptTextures *next, const RetexSet *set, int i, RetexError *err)
{
    const int target = next->targets[i];
    for (int k = 0; k < kept->count; k++) {
        RetexTexture **texture = &kept->textures[kept->targets[k]];
        if (!*texture || memcmp(&kept->specs[k], &next->specs[i], sizeof kept->specs[k]) != 0)
            continue;
        next->textures[target] = *texture;
        *texture = NULL;
        return retex_textures_move(next->textures[target], set, target, err);
    }
    return RETEX_OK;
}

int kept_textures_load(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count, int nthreads,
                       RetexError *err)
{
    KeptTextures next = {.count = count};
    RetexTexture *loaded[RETEX_MAX_TARGETS] = {0};
    RetexTextureSpec missing[RETEX_MAX_TARGETS];
    int nmissing = 0, code = RETEX_OK;
    for (int i = 0; i < count && !code; i++) {
        next.specs[i] = specs[i];
        next.targets[i] = retex_set_find_target(set, specs[i].target);
        if (next.targets[i] >= 0)
            code = take(kept, &next, set, i, err);
        if (next.targets[i] < 0 || !next.textures[next.targets[i]])
            missing[nmissing++] = specs[i];
    }
    retex_textures_close(kept->textures);
    if (!code)
        code = retex_textures_load(loaded, set, missing, nmissing, nthreads, err);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        if (loaded[t])
            next.textures[t] = loaded[t];
    *kept = next;
    if (code)
        kept_textures_close(kept);
    return code;
}

void kept_textures_close(KeptTextures *kept)
{
    retex_textures_close(kept->textures);
    kept->count = 0;
}
