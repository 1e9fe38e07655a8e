/* Layers of textures, as specifications. Each is a texture of its own, filtered by itself, and laid over what the ones
 * below gave: alpha is the mean over the footprint, as if what lies below did not vary with it. See layer.h. */
#include "texture/layer.h"

#include <string.h>

#include "base/params.h"

/* The members that a layer has of a texture, of whose image's name it holds less. */
#define COPY_SHARED(to, from)                                                                                          \
    do {                                                                                                               \
        memcpy((to)->image, (from)->image, sizeof((RetexTextureLayer *)0)->image);                                     \
        memcpy((to)->colorspace, (from)->colorspace, sizeof(from)->colorspace);                                        \
        memcpy((to)->scale, (from)->scale, sizeof(from)->scale);                                                       \
        memcpy((to)->offset, (from)->offset, sizeof(from)->offset);                                                    \
        memcpy((to)->width, (from)->width, sizeof(from)->width);                                                       \
        memcpy((to)->flip, (from)->flip, sizeof(from)->flip);                                                          \
        memcpy((to)->at, (from)->at, sizeof(from)->at);                                                                \
        memcpy((to)->adjustments, (from)->adjustments, sizeof(from)->adjustments);                                     \
        (to)->rotate = (from)->rotate;                                                                                 \
        (to)->has_at = (from)->has_at;                                                                                 \
        (to)->nadjustments = (from)->nadjustments;                                                                     \
        (to)->metric = (from)->metric;                                                                                 \
    } while (0)

static void get(RetexTextureSpec *layer, const RetexTextureSpec *spec, int index)
{
    const RetexTextureLayer *own = &spec->layers[index];
    *layer = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    memcpy(layer->target, spec->target, sizeof layer->target);
    COPY_SHARED(layer, own);
    layer->wrap[0] = layer->wrap[1] = RETEX_WRAP_BLACK;
    memcpy(layer->uv_scale, spec->uv_scale, sizeof spec->uv_scale);
    layer->unit = spec->unit;
    memcpy(layer->uv_min, spec->uv_min, sizeof spec->uv_min);
    memcpy(layer->uv_max, spec->uv_max, sizeof spec->uv_max);
    layer->access = spec->access;
    layer->warn = spec->warn;
    layer->warn_context = spec->warn_context;
    layer->is_light = spec->is_light;
    layer->budget = spec->budget;
}

void retex_texture_layer_get(RetexTextureSpec *layer, const RetexTextureSpec *given, int index)
{
    RetexTextureSpec own, spec = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&spec, given, NULL))
        return;
    get(&own, &spec, index);
    RETEX_PARAMS_RETURN(layer, &own, NULL);
}

static int set(RetexTextureSpec *spec, int index, const RetexTextureSpec *layer, RetexError *err)
{
    RetexTextureLayer *own = &spec->layers[index];
    const int is_plain = layer->repeat == RETEX_REPEAT_STRAIGHT && layer->wrap[0] == RETEX_WRAP_BLACK &&
                         layer->wrap[1] == RETEX_WRAP_BLACK && !layer->finish[0] && !layer->normal && !layer->vary &&
                         !(layer->grout > 0) && !layer->tiles[0][0];
    if (layer->constant)
        return retex_fail(err, RETEX_EINVAL, "a layer on %s must be an image, not a colour", spec->target);
    if (!is_plain)
        return retex_fail(err, RETEX_EINVAL,
                          "a layer on %s lies there once: it has no wrap, repeat, grout, vary, tiles, finish or normal",
                          spec->target);
    if (strlen(layer->image) >= sizeof own->image)
        return retex_fail(err, RETEX_EINVAL, "a layer on %s: the image's name has at most %zu bytes", spec->target,
                          sizeof own->image - 1);
    COPY_SHARED(own, layer);
    return RETEX_OK;
}

int retex_texture_layer_set(RetexTextureSpec *given, int index, const RetexTextureSpec *given_layer, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT, layer = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&spec, given, err) || RETEX_PARAMS_COPY(&layer, given_layer, err))
        return RETEX_EINVAL;
    const int code = set(&spec, index, &layer, err);
    return code ? code : RETEX_PARAMS_RETURN(given, &spec, err);
}

static int has_image(const RetexTextureSpec *spec)
{
    return spec->constant || spec->image[0];
}

int retex_texture_spec_join(RetexTextureSpec *given, const RetexTextureSpec *given_more, RetexError *err)
{
    RetexTextureSpec own = RETEX_TEXTURE_SPEC_INIT, more = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&own, given, err) || RETEX_PARAMS_COPY(&more, given_more, err))
        return RETEX_EINVAL;
    if (has_image(&own) && has_image(&more))
        return retex_fail(err, RETEX_EINVAL, "target %s is given two textures", own.target);
    if (own.nlayers + more.nlayers > RETEX_LAYERS_MAX)
        return retex_fail(err, RETEX_EINVAL, "target %s is given more than %d layers", own.target, RETEX_LAYERS_MAX);
    RetexTextureSpec both = has_image(&more) ? more : own;
    both.nlayers = own.nlayers + more.nlayers;
    for (int k = 0; k < both.nlayers; k++)
        both.layers[k] = k < own.nlayers ? own.layers[k] : more.layers[k - own.nlayers];
    return RETEX_PARAMS_RETURN(given, &both, err);
}

int retex_layers_check(const RetexTextureSpec *spec, RetexError *err)
{
    const int has_map = (spec->finish[0] && strcmp(spec->finish, "none") != 0);
    if (spec->nlayers < 0 || spec->nlayers > RETEX_LAYERS_MAX)
        return retex_fail(err, RETEX_EINVAL, "texture: %d layers; there are at most %d", spec->nlayers,
                          RETEX_LAYERS_MAX);
    if (spec->nlayers && has_map)
        return retex_fail(err, RETEX_EINVAL, "%s: %s= cannot be used below layers", spec->target,
                          spec->normal ? "normal" : "finish");
    return RETEX_OK;
}
