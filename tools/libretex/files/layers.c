/* Reads any picture file as layers. EXR parts are read on demand, packs and other pictures when opened. See
 * layers.h. */
#include "files/layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/budget.h>
#include <retex/set_file.h>

#include "exr/io.h"
#include "files/set_format.h"
#include "io/input.h"
#include "set/set.h"

struct RetexLayers {
    int nthreads;
    long max_pixels; /* 0: no limit */
    RetexInput *input;
    RetexExr *exr; /* the file is one of exr, set and picture */
    RetexSet *set;
    RetexImage picture;
};

static int check_pixels(const RetexLayers *layers, const char *name, int width, int height, RetexError *err)
{
    if (layers->max_pixels > 0 && (int64_t)width * height > layers->max_pixels)
        return retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels, more than the %ld of --max-pixels", name,
                          width, height, layers->max_pixels);
    return RETEX_OK;
}

/* Read a file that is not an EXR: a pack by libretex, any other by OpenImageIO. */
static int open_other(RetexLayers *layers, const char *path, const RetexReadParams *params, RetexError *err)
{
    const RetexSetFormat *format = retex_set_format_of(layers->input);
    int code = retex_input_check(layers->input, RETEX_OK, err);
    if (code)
        return code;
    if (format == &retex_set_format_exr)
        return retex_image_read(&layers->picture, path, params, layers->nthreads, err);
    code = format->open(&layers->input, &layers->set, 1, layers->nthreads, err);
    if (!code)
        code = check_pixels(layers, path, layers->set->width, layers->set->height, err);
    return code ? code : retex_set_load(layers->set, layers->nthreads, err);
}

int retex_layers_open(RetexLayers **result, const char *path, const RetexReadParams *params, int nthreads,
                      RetexError *err)
{
    const char *reason;
    *result = NULL;
    RetexLayers *layers = calloc(1, sizeof *layers);
    if (!layers)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", path);
    layers->nthreads = nthreads;
    layers->max_pixels = retex_budget_pixels(params->budget);
    int code = retex_input_open_allowed(&layers->input, path, params->access, err);
    if (!code && retex_exr_probe(layers->input))
        code = retex_exr_open(&layers->exr, layers->input, err);
    else if (!code)
        code = open_other(layers, path, params, err);
    if (!code && layers->exr && !retex_exr_part_readable(layers->exr, 0, &reason)) {
        /* libretex's EXR reader does not support this file: OpenImageIO reads it */
        retex_exr_close(&layers->exr);
        code = retex_image_read(&layers->picture, path, params, nthreads, err);
    }
    if (code)
        retex_layers_close(&layers);
    *result = layers;
    return code;
}

void retex_layers_close(RetexLayers **layers)
{
    if (!layers || !*layers)
        return;
    retex_exr_close(&(*layers)->exr);
    retex_input_close(&(*layers)->input);
    retex_set_close(&(*layers)->set);
    retex_image_free(&(*layers)->picture);
    free(*layers);
    *layers = NULL;
}

int retex_layers_count(const RetexLayers *layers)
{
    return layers->exr ? retex_exr_part_count(layers->exr) : layers->set ? layers->set->nparts : 1;
}

const char *retex_layers_name(const RetexLayers *layers, int index)
{
    return layers->exr ? retex_exr_part_name(layers->exr, index) : layers->set ? layers->set->parts[index].name : "";
}

int retex_layers_find(const RetexLayers *layers, const char *name)
{
    for (int i = 0; i < retex_layers_count(layers); i++)
        if (strcmp(retex_layers_name(layers, i), name) == 0)
            return i;
    return -1;
}

int retex_layers_is_exact(const RetexLayers *layers)
{
    return layers->exr || layers->set;
}

int retex_layer_find(const RetexLayer *layer, const char *channel)
{
    for (int c = 0; c < layer->image.channels; c++)
        if (strcmp(layer->channels[c], channel) == 0)
            return c;
    return -1;
}

void retex_layer_free(RetexLayer *layer)
{
    free(layer->channels);
    layer->channels = NULL;
    retex_image_free(&layer->image);
}

static int alloc_layer(RetexLayer *layer, int width, int height, int channels, RetexError *err)
{
    memset(layer, 0, sizeof *layer);
    if (channels < 1 || channels > RETEX_MAX_CHANNELS)
        return retex_fail(err, RETEX_EUNSUPPORTED, "a part of %d channels; 1 to %d are read", channels,
                          RETEX_MAX_CHANNELS);
    if ((uint64_t)width * (uint64_t)height * (uint64_t)channels * sizeof(float) > RETEX_EXR_MEMORY_MAX)
        return retex_fail(err, RETEX_ELIMIT, "a part of %d x %d pixels is too large", width, height);
    layer->channels = calloc((size_t)channels, sizeof *layer->channels);
    if (!layer->channels)
        return retex_fail(err, RETEX_ENOMEM, "no memory for %d channels", channels);
    return retex_image_alloc(&layer->image, width, height, channels, err);
}

/* Read channels of a part into the layer, from `first` on, as many as one request may have. */
static int read_exr_channels(RetexLayer *layer, RetexLayers *layers, int part, int first, RetexError *err)
{
    RetexImage block = {0};
    RetexExrRequest request = {.part = part, .image = &block};
    int count = layer->image.channels - first;
    count = count < RETEX_EXR_LETTERS_MAX ? count : RETEX_EXR_LETTERS_MAX;
    for (int c = 0; c < count; c++)
        snprintf(request.channels[c], sizeof request.channels[c], "%s",
                 retex_exr_channel_name(layers->exr, part, first + c));
    int code = retex_image_alloc(&block, layer->image.width, layer->image.height, count, err);
    if (!code)
        code = retex_exr_read(layers->exr, &request, 1, layers->nthreads, err);
    size_t pixels = code ? 0 : (size_t)block.width * (size_t)block.height, channels = (size_t)layer->image.channels;
    for (size_t i = 0; i < pixels; i++)
        memcpy(layer->image.pixels + i * channels + first, block.pixels + i * (size_t)count,
               (size_t)count * sizeof(float));
    retex_image_free(&block);
    return code;
}

static int read_exr_layer(RetexLayer *layer, RetexLayers *layers, int part, RetexError *err)
{
    const char *name = retex_exr_part_name(layers->exr, part), *reason;
    size_t prefix = strlen(name);
    int width, height, channels = retex_exr_channel_count(layers->exr, part);
    if (!retex_exr_part_readable(layers->exr, part, &reason))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: part '%s' cannot be read: %s", retex_input_name(layers->input),
                          name, reason);
    retex_exr_part_size(layers->exr, part, &width, &height);
    int code = check_pixels(layers, retex_input_name(layers->input), width, height, err);
    if (!code)
        code = alloc_layer(layer, width, height, channels, err);
    for (int c = 0; !code && c < channels; c++) {
        const char *channel = retex_exr_channel_name(layers->exr, part, c);
        if (strlen(channel) >= sizeof *layer->channels)
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s: a channel's name is too long",
                              retex_input_name(layers->input));
        int inside = prefix > 0 && strncmp(channel, name, prefix) == 0 && channel[prefix] == '.';
        strcpy(layer->channels[c], channel + (inside ? prefix + 1 : 0));
    }
    for (int c = 0; !code && c < channels; c += RETEX_EXR_LETTERS_MAX)
        code = read_exr_channels(layer, layers, part, c, err);
    return code;
}

int retex_layers_read(RetexLayer *layer, RetexLayers *layers, int index, RetexError *err)
{
    memset(layer, 0, sizeof *layer);
    int code;
    if (layers->exr) {
        code = read_exr_layer(layer, layers, index, err);
    } else {
        const RetexImage *from = layers->set ? &layers->set->parts[index].image : &layers->picture;
        const char *letters = layers->set ? layers->set->parts[index].letters : "RGBA";
        code = alloc_layer(layer, from->width, from->height, from->channels, err);
        for (int c = 0; !code && c < from->channels; c++)
            layer->channels[c][0] = letters[c];
        if (!code)
            memcpy(layer->image.pixels, from->pixels, retex_image_index(from, 0, from->height) * sizeof(float));
    }
    if (code)
        retex_layer_free(layer);
    return code;
}
