/* See picture_layers.h. Names are compared without regard to case. */
#include "files/picture_layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The letters of three channels that belong together. */
static const char *const triples[][3] = {{"R", "G", "B"}, {"red", "green", "blue"}, {"X", "Y", "Z"}};

/* Of the picture, in the order in which they are looked for; "" is R,G,B without a name. */
static const char *const beauties[] = {"",  "Combined",  "RGBA",        "rgb", "beauty", "Ci",
                                       "C", "rgb_color", "Noisy Image", "Y",   NULL};

/* Of Cycles, Arnold, V-Ray, RenderMan, Octane, Mitsuba and our own renderer. */
static const char *const known[RETEX_PICTURE_GUIDES][16] = {
    [RETEX_PICTURE_NORMAL] = {"Normal", "N", "Normals", "Nn", "ShadingNormal", "bump_normals", "normal_mean",
                              "sh_normal", "nn", NULL},
    [RETEX_PICTURE_SEEN_NORMAL] = {"Denoising Normal", "DenoisingNormal", "denoise_normal", "N_noice", "OptixNormals",
                                   "Denoise Normal", NULL},
    [RETEX_PICTURE_ALBEDO] = {"Denoising Albedo", "DenoisingAlbedo", "denoise_albedo", "Denoise Albedo", "albedo",
                              "albedo_mean", "diffuse_albedo", "diffuse_albedo_noice", "DiffCol", "diffuse_filter",
                              "diffuseFilter", "OptixAlbedo", "DiffuseFilter", NULL},
    [RETEX_PICTURE_POSITION] = {"Position", "P", "Pworld", "__Pworld", "world_position", "worldPosition", "Points",
                                NULL},
    [RETEX_PICTURE_DEPTH] = {"Denoising Depth", "DenoisingDepth", "Depth", "Z", "z_depth", "zDepth", "Z_noice", NULL}};

static int is_same(const char *a, const char *b)
{
    return strcasecmp(a, b) == 0;
}

/* The part of a name after its last dot. */
static const char *last_word(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? dot + 1 : name;
}

/* The length of a name without its last word and the dot before that. */
static size_t stem_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? (size_t)(dot - name) : 0;
}

/* The whole name of a channel: in files of several parts that of the part comes first. */
static void channel_name(char name[2 * RETEX_EXR_NAME_MAX], const RetexExr *exr, int part, int channel)
{
    const char *of_part = retex_exr_part_count(exr) > 1 ? retex_exr_part_name(exr, part) : "";
    const char *own = retex_exr_channel_name(exr, part, channel);
    const size_t length = strlen(of_part);
    const int has_it = !length || (strncmp(own, of_part, length) == 0 && own[length] == '.');
    snprintf(name, 2 * RETEX_EXR_NAME_MAX, "%.*s%s%.*s", RETEX_EXR_NAME_MAX - 1, has_it ? "" : of_part,
             has_it ? "" : ".", RETEX_EXR_NAME_MAX - 1, own);
}

/* The channel of the part with the same stem and another letter, or -1. */
static int sibling(const RetexExr *exr, int part, const char *name, const char *letter)
{
    char other[2 * RETEX_EXR_NAME_MAX];
    const size_t stem = stem_length(name);
    for (int c = 0; c < retex_exr_channel_count(exr, part); c++) {
        channel_name(other, exr, part, c);
        if (stem_length(other) == stem && strncmp(other, name, stem) == 0 && is_same(last_word(other), letter))
            return c;
    }
    return -1;
}

static void add_channel(RetexPictureLayers *layers, const RetexExr *exr, int part, int channel)
{
    RetexPictureLayer *alone = &layers->of[layers->count++];
    *alone = (RetexPictureLayer){.part = part, .count = 1, .channels = {channel}};
    channel_name(alone->name, exr, part, channel);
    for (size_t k = 0; k < sizeof triples / sizeof *triples; k++) {
        if (!is_same(last_word(alone->name), triples[k][0]))
            continue;
        const int second = sibling(exr, part, alone->name, triples[k][1]);
        const int third = sibling(exr, part, alone->name, triples[k][2]);
        if (second < 0 || third < 0)
            continue;
        RetexPictureLayer *all = &layers->of[layers->count++];
        *all = (RetexPictureLayer){.part = part, .count = 3, .channels = {channel, second, third}};
        memcpy(all->name, alone->name, stem_length(alone->name));
    }
}

int retex_picture_layers_open(RetexPictureLayers *layers, const RetexExr *exr, RetexError *err)
{
    size_t channels = 0;
    *layers = (RetexPictureLayers){0};
    for (int part = 0; part < retex_exr_part_count(exr); part++)
        channels += (size_t)retex_exr_channel_count(exr, part);
    layers->of = calloc(2 * channels + 1, sizeof *layers->of);
    if (!layers->of)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the layers of a picture");
    for (int part = 0; part < retex_exr_part_count(exr); part++)
        for (int c = 0; c < retex_exr_channel_count(exr, part); c++)
            add_channel(layers, exr, part, c);
    return RETEX_OK;
}

void retex_picture_layers_close(RetexPictureLayers *layers)
{
    free(layers->of);
    *layers = (RetexPictureLayers){0};
}

/* 1 if a name is `end`, or ends in a dot and that. */
static int ends_in(const char *name, const char *end)
{
    const size_t length = strlen(name), tail = strlen(end);
    return length >= tail && is_same(name + length - tail, end) &&
           (length == tail || (tail > 0 && name[length - tail - 1] == '.'));
}

/* How well a name fits a layer: 0 not at all. */
static int fit(const RetexPictureLayer *layer, const char *name)
{
    char stem[sizeof layer->name];
    snprintf(stem, sizeof stem, "%.*s", (int)stem_length(layer->name), layer->name);
    if (strcmp(layer->name, name) == 0)
        return 5;
    if (!*layer->name && (is_same(name, "RGB") || is_same(name, "RGBA")))
        return 4;
    if (is_same(layer->name, name))
        return 4;
    if (ends_in(layer->name, name) && (layer->count > 1 || strchr(name, '.')))
        return 3;
    if (layer->count == 1 && *stem && is_same(stem, name))
        return 2;
    return layer->count == 1 && *stem && ends_in(stem, name);
}

/* The layer that a name fits best; with *several 1 where another one fits as well. Of three channels the layer of all
 * comes before that of one. */
static int find_best(const RetexPictureLayers *layers, const char *name, int *several)
{
    int best = -1, most = 0;
    *several = 0;
    for (int k = 0; k < layers->count; k++) {
        const int how = fit(&layers->of[k], name);
        if (how && how == most)
            *several = 1;
        if (how > most)
            best = k, most = how, *several = 0;
    }
    return best;
}

int retex_picture_layer_named(const RetexPictureLayers *layers, const char *name, const char *file, RetexError *err)
{
    int several, found = find_best(layers, name, &several);
    if (found < 0)
        return retex_fail(err, RETEX_ENOTFOUND, "%s has no layer %s", file, name);
    if (several)
        return retex_fail(err, RETEX_ENOTFOUND, "%s has several layers %s, such as %s: give the whole name", file, name,
                          retex_picture_layer_text(layers, found));
    return found;
}

/* Pictures that Blender's compositor added are none of the renderer's. */
static int is_composite(const char *name)
{
    return strncasecmp(name, "Composite.", 10) == 0;
}

int retex_picture_layer_beauty(const RetexPictureLayers *layers, const char *file, RetexError *err)
{
    for (const char *const *name = beauties; *name; name++) {
        int found = -1;
        for (int k = 0; k < layers->count; k++) {
            const RetexPictureLayer *layer = &layers->of[k];
            const int is_grey = is_same(*name, "Y");
            if (layer->count != (is_grey ? 1 : 3) || is_composite(layer->name) ||
                !(**name && !is_grey ? ends_in(layer->name, *name) : is_same(layer->name, *name)))
                continue;
            if (found >= 0)
                return retex_fail(err, RETEX_ENOTFOUND, "%s has several pictures, %s and %s: choose by --layer", file,
                                  retex_picture_layer_text(layers, found), retex_picture_layer_text(layers, k));
            found = k;
        }
        if (found >= 0)
            return found;
    }
    return retex_fail(err, RETEX_ENOTFOUND,
                      "%s has no channels R, G, B and no layer of a well known name: choose by --layer", file);
}

int retex_picture_layer_known(const RetexPictureLayers *layers, RetexPictureGuide guide, int beauty)
{
    const char *of = beauty >= 0 ? layers->of[beauty].name : "";
    const size_t stem = stem_length(of);
    for (int any = 0; any < 2; any++)
        for (const char *const *name = known[guide]; *name; name++)
            for (int k = 0; k < layers->count; k++) {
                const RetexPictureLayer *layer = &layers->of[k];
                const int grey = guide == RETEX_PICTURE_DEPTH;
                char text[sizeof layer->name];
                snprintf(text, sizeof text, "%s", layer->name);
                if (grey && layer->count == 1 && strchr(text, '.') && !is_same(text, *name))
                    text[stem_length(text)] = 0; /* without the letter of the channel */
                if (layer->count == (grey ? 1 : 3) && ends_in(text, *name) &&
                    (any || (strlen(text) >= stem && strncmp(text, of, stem) == 0)))
                    return k;
            }
    return -1;
}

int retex_picture_layer_color(const RetexPictureLayers *layers, int light)
{
    char name[2 * RETEX_EXR_NAME_MAX];
    const size_t length = strlen(layers->of[light].name);
    if (length < 3 || layers->of[light].count != 3 ||
        (strcmp(layers->of[light].name + length - 3, "Dir") != 0 &&
         strcmp(layers->of[light].name + length - 3, "Ind") != 0))
        return -1;
    snprintf(name, sizeof name, "%.*sCol", (int)(length - 3), layers->of[light].name);
    for (int k = 0; k < layers->count; k++)
        if (layers->of[k].count == 3 && strcmp(layers->of[k].name, name) == 0)
            return k;
    return -1;
}

const char *retex_picture_layer_text(const RetexPictureLayers *layers, int layer)
{
    return *layers->of[layer].name ? layers->of[layer].name : "RGB";
}
