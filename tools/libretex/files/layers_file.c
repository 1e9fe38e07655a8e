/* A set for compositors: one flat EXR part whose channels are LAYER.R and so on, because not every program reads files
 * of several parts, of other sizes or of one or two channels. See retex_set_write_layers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/aov.h>
#include <retex/host/denoise_data.h>
#include <retex/host/flat_exr.h>
#include <retex/set_file.h>

#include "set/set.h"

/* A channel of the file: one of a part, or what is made of it. */
typedef struct LayerChannel {
    RetexFlatChannel flat;
    const RetexPart *part;
    int index;    /* of the part's channels, or -1: 0 everywhere */
    int coverage; /* 1: it is 1 where the channel is above 0 */
} LayerChannel;

typedef struct LayersFile {
    const RetexSet *set;
    LayerChannel *channels;
    int nchannels;
} LayersFile;

static int is_mean_uv(const RetexSet *set, int part)
{
    for (int i = 0; i < set->nfootprints; i++)
        if (set->footprints[i].uv == part)
            return 1;
    return 0;
}

static int is_picture_of(const RetexSet *set, const RetexTerm *term, int lamp)
{
    return term->role == RETEX_ROLE_LAMP_PICTURE && retex_set_term_lamp(set, term) == lamp;
}

/* The term that is the picture by a lamp: where the set has no other for it, the light that meets no target. */
static int is_layer_of_lamp(const RetexSet *set, const RetexTerm *term, int lamp)
{
    int has_picture = 0;
    for (int t = 0; t < set->nterms; t++)
        has_picture |= is_picture_of(set, &set->terms[t], lamp);
    return has_picture ? is_picture_of(set, term, lamp) : term->nfactors == 1;
}

/* The lamp whose picture a part is; -2: of a part of its light, which only mixtures make a picture of; else -1. */
static int lamp_of_layer(const RetexSet *set, int part)
{
    int found = -1;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        const int lamp = term->radiance == part ? retex_set_term_lamp(set, term) : -1;
        if (term->radiance == part && lamp < 0)
            return -1;
        if (lamp >= 0 && is_layer_of_lamp(set, term, lamp))
            return lamp;
        found = lamp >= 0 ? -2 : found;
    }
    return found;
}

static int begins_with(const char *text, const char *prefix)
{
    return strncmp(text, prefix, strlen(prefix)) == 0;
}

/* Whether the part is written; the set is in memory. */
static int is_layer(const RetexSet *set, int part)
{
    const RetexPart *p = &set->parts[part];
    const RetexImage *image = &p->image;
    int is_original = 0;
    for (int t = 0; t < set->ntargets; t++)
        is_original |= set->targets[t].original == part;
    if (image->width != set->width || image->height != set->height || is_original || lamp_of_layer(set, part) == -2 ||
        begins_with(p->name, RETEX_NOISE_PREFIX) || begins_with(p->name, RETEX_FEATURE_PREFIX))
        return 0;
    if (part == 0 || retex_aov_find(p->name) >= 0)
        return 1;
    for (size_t i = 0; i < retex_image_index(image, 0, image->height); i++)
        if (image->pixels[i] != 0)
            return 1;
    return 0;
}

static void add_channel(LayersFile *file, const RetexPart *part, char letter, int index, int coverage)
{
    LayerChannel *channel = &file->channels[file->nchannels++];
    const int lamp = lamp_of_layer(file->set, (int)(part - file->set->parts));
    *channel = (LayerChannel){.flat.type = part->type, .part = part, .index = index, .coverage = coverage};
    char *name = channel->flat.name;
    const size_t size = sizeof channel->flat.name;
    if (part == file->set->parts)
        snprintf(name, size, "%c", letter);
    else if (lamp >= 0)
        snprintf(name, size, "lamp_%s.%c", file->set->parameters[lamp].name, letter);
    else
        snprintf(name, size, "%.*s.%c", RETEX_NAME_MAX - 1, part->name, letter);
}

/* Mean UV and spread become three channels R, G, B, which all programs take alike. */
static void add_layer(LayersFile *file, int part)
{
    const RetexPart *p = &file->set->parts[part];
    const char *letters = p->letters;
    const int is_uv = is_mean_uv(file->set, part), is_pair = strcmp(letters, "RG") == 0;
    for (int c = 0; letters[c]; c++)
        add_channel(file, p, is_uv && c == 2 ? 'B' : letters[c], c, is_uv && c == 2);
    if (is_pair)
        add_channel(file, p, 'B', -1, 0);
}

static int compare_channels(const void *a, const void *b)
{
    return strcmp(((const LayerChannel *)a)->flat.name, ((const LayerChannel *)b)->flat.name);
}

static void fill_row(void *context, int c, int y, int thread, float *values)
{
    const LayersFile *file = context;
    const LayerChannel *channel = &file->channels[c];
    const RetexImage *image = &channel->part->image;
    const float *row = image->pixels + retex_image_index(image, 0, y);
    const size_t step = (size_t)image->channels, width = (size_t)image->width;
    (void)thread;
    memset(values, 0, width * sizeof *values);
    for (size_t x = 0; x < width && channel->index >= 0; x++)
        values[x] = row[x * step + (size_t)channel->index];
    for (size_t x = 0; x < width && channel->coverage; x++)
        values[x] = values[x] > 0;
}

static int list_channels(LayersFile *file, const RetexSet *set, RetexError *err)
{
    size_t channels = 0;
    *file = (LayersFile){.set = set};
    for (int i = 0; i < set->nparts; i++) {
        if (!set->parts[i].image.pixels)
            return retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
        channels += strlen(set->parts[i].letters) + 1;
    }
    file->channels = calloc(channels + 1, sizeof *file->channels);
    if (!file->channels)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write layers");
    for (int i = 0; i < set->nparts; i++)
        if (is_layer(set, i))
            add_layer(file, i);
    qsort(file->channels, (size_t)file->nchannels, sizeof *file->channels, compare_channels);
    return RETEX_OK;
}

static int write_layers(LayersFile *file, const char *path, int nthreads, RetexError *err)
{
    const RetexFlatRows rows = {.context = file, .row = fill_row};
    RetexFlatChannel *flat = calloc((size_t)file->nchannels + 1, sizeof *flat);
    if (!flat)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write layers");
    for (int c = 0; c < file->nchannels; c++)
        flat[c] = file->channels[c].flat;
    int code = retex_flat_exr_write(path, file->set->width, file->set->height, flat, file->nchannels, &rows, nthreads,
                                    err);
    free(flat);
    return code;
}

/* A lamp whose picture is not in the set, as in a compact one, where its light is gains; -1: there is none. */
static int lamp_without_picture(const RetexSet *set)
{
    for (int i = 0; i < set->nterms; i++) {
        const int lamp = set->terms[i].role == RETEX_ROLE_LAMP ? retex_set_term_lamp(set, &set->terms[i]) : -1;
        int has_picture = set->terms[i].nfactors == 1;
        for (int t = 0; t < set->nterms; t++)
            has_picture |= is_picture_of(set, &set->terms[t], lamp);
        if (lamp >= 0 && !has_picture)
            return lamp;
    }
    return -1;
}

int retex_set_write_layers(const RetexSet *set, const char *path, int nthreads, RetexError *err)
{
    LayersFile file;
    const int lamp = lamp_without_picture(set);
    if (lamp >= 0)
        return retex_fail(err, RETEX_EUNSUPPORTED,
                          "the set has no picture of the lamp %s: packs with loss leave them out; take the set before "
                          "packing, or one of retex-pack --no-lamps",
                          set->parameters[lamp].name);
    int code = list_channels(&file, set, err);
    if (!code)
        code = write_layers(&file, path, nthreads, err);
    free(file.channels);
    return code;
}
