/* See kept_textures.h. */
#include <string.h>

#include "common/kept_textures.h"

/* Close images, those first that were not used for longest: not the first `used` ones, and others only if there are
 * more than `most`, or they take more than most_bytes together with those that were used later. */
static void drop_images(KeptTextures *kept, int used, int most, uint64_t most_bytes)
{
    uint64_t bytes = 0;
    int stay = 0;
    while (stay < kept->nimages) {
        bytes += retex_texture_bytes(kept->images[stay]);
        if (stay >= used && (stay >= most || bytes > most_bytes))
            break;
        stay++;
    }
    while (kept->nimages > stay)
        retex_texture_close(&kept->images[--kept->nimages]);
}

/* Insert an image in front of the others. */
static void add_image(KeptTextures *kept, RetexTexture *image, int before)
{
    memmove(kept->images + 1, kept->images, (size_t)before * sizeof *kept->images);
    kept->images[0] = image;
}

/* Place an image that is in memory, and make it one of the first `used`. Return 0 if none has the texels. */
static int place(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *spec, int target, int *used)
{
    for (int k = 0; k < kept->nimages && !spec->constant; k++) {
        if (retex_textures_place(&kept->textures[target], kept->images[k], set, spec, NULL))
            continue;
        if (k >= *used) {
            add_image(kept, kept->images[k], k);
            ++*used;
        }
        return 1;
    }
    return 0;
}

/* Add a texture that is to be loaded. */
static void add_missing(const KeptTextures *kept, RetexTextureSpec *missing, const RetexTextureSpec *spec)
{
    *missing = *spec;
    for (int k = 0; k < kept->ncolors && spec->constant; k++)
        if (strcmp(kept->colors[k].target, spec->target) == 0 &&
            memcmp(kept->colors[k].color, spec->color, sizeof spec->color) == 0)
            missing->warn = NULL;
}

/* Place all images that are in memory. List the other textures, but no image twice: perhaps both have the same texels.
 * Return their number. */
static int find_missing(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count,
                        RetexTextureSpec missing[RETEX_MAX_TARGETS], int *used)
{
    int nmissing = 0;
    for (int i = 0; i < count; i++) {
        const int target = retex_set_find_target(set, specs[i].target);
        int listed = 0;
        if (kept->textures[target] || place(kept, set, &specs[i], target, used))
            continue;
        for (int k = 0; k < nmissing; k++)
            listed |= retex_texture_specs_alike(&missing[k], &specs[i]);
        if (!listed)
            add_missing(kept, &missing[nmissing++], &specs[i]);
    }
    return nmissing;
}

/* Load textures, and place those that have an image. */
static int load(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count, int *used,
                int nthreads, RetexError *err)
{
    RetexTexture *loaded[RETEX_MAX_TARGETS];
    RetexError why = {0};
    drop_images(kept, *used, KEPT_IMAGES_MAX - count, kept->most_bytes);
    int code = retex_textures_load(loaded, set, specs, count, nthreads, &why);
    if ((code == RETEX_ELIMIT || code == RETEX_ENOMEM) && kept->nimages > *used) { /* kept images may have the memory */
        retex_textures_close(loaded);
        drop_images(kept, *used, *used, 0);
        why = (RetexError){0};
        code = retex_textures_load(loaded, set, specs, count, nthreads, &why);
    }
    for (int i = 0; i < count && !code; i++) {
        const int target = retex_set_find_target(set, specs[i].target);
        if (!specs[i].constant) {
            add_image(kept, loaded[target], kept->nimages++);
            ++*used;
            code = retex_textures_place(&kept->textures[target], loaded[target], set, &specs[i], &why);
        } else {
            kept->textures[target] = loaded[target];
        }
        loaded[target] = NULL;
    }
    retex_textures_close(loaded);
    if (code && err)
        *err = why;
    return code;
}

int kept_textures_load(KeptTextures *kept, const RetexSet *set, const RetexTextureSpec *specs, int count, int nthreads,
                       RetexError *err)
{
    RetexTextureSpec missing[RETEX_MAX_TARGETS];
    int used = 0, nmissing;
    retex_textures_close(kept->textures);
    int code = retex_textures_check(set, specs, count, err);
    while (!code && (nmissing = find_missing(kept, set, specs, count, missing, &used)) > 0)
        code = load(kept, set, missing, nmissing, &used, nthreads, err);
    if (code) {
        kept_textures_close(kept);
        return code;
    }
    drop_images(kept, used, KEPT_IMAGES_MAX, kept->most_bytes);
    kept->ncolors = 0;
    for (int i = 0; i < count; i++)
        if (specs[i].constant)
            kept->colors[kept->ncolors++] = specs[i];
    return RETEX_OK;
}

void kept_textures_close(KeptTextures *kept)
{
    retex_textures_close(kept->textures);
    drop_images(kept, 0, 0, 0);
    kept->ncolors = 0;
}
