/* Layers of textures, as specifications. Each is a texture of its own, filtered by itself, and laid over what the ones
 * below gave: alpha is the mean over the footprint, as if what lies below did not vary with it. See layer.h. */
#include "texture/layer.h"

#include <string.h>

#include "base/params.h"

static void get(RetexTextureSpec *layer, const RetexTextureSpec *spec, int index)
{
    const RetexTextureLayer *own = &spec->layers[index];
    *layer = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    memcpy(layer->target, spec->target, sizeof layer->target);
    memcpy(layer->image, own->image, sizeof own->image);
    memcpy(layer->colorspace, own->colorspace, sizeof own->colorspace);
    memcpy(layer->scale, own->scale, sizeof own->scale);
    memcpy(layer->offset, own->offset, sizeof own->offset);
    memcpy(layer->width, own->width, sizeof own->width);
    memcpy(layer->flip, own->flip, sizeof own->flip);
    memcpy(layer->at, own->at, sizeof own->at);
    memcpy(layer->adjustments, own->adjustments, sizeof own->adjustments);
    layer->rotate = own->rotate;
    layer->has_at = own->has_at;
    layer->nadjustments = own->nadjustments;
    layer->wrap[0] = layer->wrap[1] = RETEX_WRAP_BLACK;
    memcpy(layer->uv_scale, spec->uv_scale, sizeof spec->uv_scale);
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
    memcpy(own->image, layer->image, sizeof own->image);
    memcpy(own->colorspace, layer->colorspace, sizeof own->colorspace);
    memcpy(own->scale, layer->scale, sizeof own->scale);
    memcpy(own->offset, layer->offset, sizeof own->offset);
    memcpy(own->width, layer->width, sizeof own->width);
    memcpy(own->flip, layer->flip, sizeof own->flip);
    memcpy(own->at, layer->at, sizeof own->at);
    memcpy(own->adjustments, layer->adjustments, sizeof own->adjustments);
    own->rotate = layer->rotate;
    own->has_at = layer->has_at;
    own->nadjustments = layer->nadjustments;
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
