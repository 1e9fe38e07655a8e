/* A set for compositors: one flat EXR part whose channels are LAYER.R and so on, because not every program reads files
 * of several parts, of other sizes or of one or two channels. See retex_set_write_layers. */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/aov.h>
#include <retex/host/denoise_data.h>
#include <retex/parallel.h>
#include <retex/set_file.h>

#include "base/half.h"
#include "exr/chunk.h"
#include "exr/zip.h"
#include "io/output.h"
#include "set/set.h"

enum { LINES = RETEX_CHUNK_LINES, SHORT_NAME = 31, COMPRESSION_ZIP = 3, LONG_NAMES = 0x400, EXR_VERSION = 2 };

/* A channel of the file: one of a part, or what is made of it. */
typedef struct LayerChannel {
    char name[RETEX_NAME_MAX + 8];
    const RetexPart *part;
    int index;    /* of the part's channels, or -1: 0 everywhere */
    int coverage; /* 1: it is 1 where the channel is above 0 */
} LayerChannel;

typedef struct LayersFile {
    const RetexSet *set;
    LayerChannel *channels;
    int nchannels, nchunks;
    size_t row_bytes; /* of all channels */
    unsigned char **chunks;
    size_t *bytes;  /* of each chunk */
    RetexZip *zips; /* by thread */
    atomic_int starved;
} LayersFile;

static size_t sample_bytes(const LayerChannel *channel)
{
    return channel->part->type == RETEX_HALF ? 2 : 4;
}

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

int retex_set_is_layer(const RetexSet *set, int part)
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
    *channel = (LayerChannel){.part = part, .index = index, .coverage = coverage};
    if (part == file->set->parts)
        snprintf(channel->name, sizeof channel->name, "%c", letter);
    else if (lamp >= 0)
        snprintf(channel->name, sizeof channel->name, "lamp_%s.%c", file->set->parameters[lamp].name, letter);
    else
        snprintf(channel->name, sizeof channel->name, "%.*s.%c", RETEX_NAME_MAX - 1, part->name, letter);
    file->row_bytes += sample_bytes(channel) * (size_t)part->image.width;
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
    return strcmp(((const LayerChannel *)a)->name, ((const LayerChannel *)b)->name);
}

static void pack_row(unsigned char *to, const LayerChannel *channel, int y)
{
    enum { BLOCK = 256 };
    const RetexImage *image = &channel->part->image;
    const float *row = image->pixels + retex_image_index(image, 0, y);
    const size_t step = (size_t)image->channels, sample = sample_bytes(channel);
    for (int x = 0; x < image->width; x += BLOCK) {
        const size_t count = (size_t)(image->width - x < BLOCK ? image->width - x : BLOCK);
        float values[BLOCK] = {0};
        uint16_t halves[BLOCK];
        for (size_t i = 0; i < count && channel->index >= 0; i++)
            values[i] = row[((size_t)x + i) * step + (size_t)channel->index];
        for (size_t i = 0; i < count && channel->coverage; i++)
            values[i] = values[i] > 0;
        if (channel->part->type == RETEX_HALF)
            retex_half_from_float(halves, values, count);
        memcpy(to, channel->part->type == RETEX_HALF ? (void *)halves : (void *)values, count * sample);
        to += count * sample;
    }
}

static void pack_chunk(void *context, int chunk, int thread)
{
    LayersFile *file = context;
    RetexZip *zip = &file->zips[thread];
    const int first = chunk * LINES, height = file->set->height,
              lines = height - first < LINES ? height - first : LINES;
    const size_t bytes = file->row_bytes * (size_t)lines;
    unsigned char *raw = malloc(bytes), *packed = malloc(bytes), *to = raw;
    if (!raw || !packed || !retex_zip_reserve(zip, bytes)) {
        file->starved = 1;
        free(raw);
        free(packed);
        return;
    }
    for (int y = first; y < first + lines; y++)
        for (int c = 0; c < file->nchannels; c++) {
            pack_row(to, &file->channels[c], y);
            to += sample_bytes(&file->channels[c]) * (size_t)file->set->width;
        }
    file->bytes[chunk] = retex_zip_pack(zip, packed, raw, bytes);
    if (!file->bytes[chunk]) { /* compression gained nothing: stored uncompressed */
        memcpy(packed, raw, bytes);
        file->bytes[chunk] = bytes;
    }
    free(raw);
    unsigned char *fitting = realloc(packed, file->bytes[chunk]);
    file->chunks[chunk] = fitting ? fitting : packed;
}

/* ---- the header, little-endian, as OpenEXR's file layout says ---- */

static void put(RetexOutput *output, const void *data, size_t bytes, int *code, RetexError *err)
{
    if (!*code)
        *code = retex_output_write(output, data, bytes, err);
}

static void put_number(RetexOutput *output, uint64_t value, int bytes, int *code, RetexError *err)
{
    unsigned char digits[8];
    for (int k = 0; k < bytes; k++)
        digits[k] = (unsigned char)(value >> (8 * k));
    put(output, digits, (size_t)bytes, code, err);
}

static void put_attribute(RetexOutput *output, const char *name, const char *type, size_t bytes, int *code,
                          RetexError *err)
{
    put(output, name, strlen(name) + 1, code, err);
    put(output, type, strlen(type) + 1, code, err);
    put_number(output, bytes, 4, code, err);
}

static void put_channels(RetexOutput *output, const LayersFile *file, int *code, RetexError *err)
{
    size_t bytes = 1;
    for (int c = 0; c < file->nchannels; c++)
        bytes += strlen(file->channels[c].name) + 1 + 16;
    put_attribute(output, "channels", "chlist", bytes, code, err);
    for (int c = 0; c < file->nchannels; c++) {
        put(output, file->channels[c].name, strlen(file->channels[c].name) + 1, code, err);
        put_number(output, file->channels[c].part->type == RETEX_HALF ? 1 : 2, 4, code, err);
        put_number(output, 0, 4, code, err); /* not perceptually linear */
        put_number(output, 1, 4, code, err); /* all columns and rows are there */
        put_number(output, 1, 4, code, err);
    }
    put_number(output, 0, 1, code, err);
}

static void put_header(RetexOutput *output, const LayersFile *file, int *code, RetexError *err)
{
    static const char *const windows[2] = {"dataWindow", "displayWindow"};
    const float one = 1, zero[2] = {0, 0};
    int long_names = 0;
    for (int c = 0; c < file->nchannels; c++)
        long_names |= strlen(file->channels[c].name) > SHORT_NAME;
    put(output, "\x76\x2f\x31\x01", 4, code, err);
    put_number(output, EXR_VERSION | (long_names ? LONG_NAMES : 0), 4, code, err);
    put_channels(output, file, code, err);
    put_attribute(output, "compression", "compression", 1, code, err);
    put_number(output, COMPRESSION_ZIP, 1, code, err);
    for (int k = 0; k < 2; k++) {
        put_attribute(output, windows[k], "box2i", 16, code, err);
        put_number(output, 0, 8, code, err);
        put_number(output, (uint64_t)file->set->width - 1, 4, code, err);
        put_number(output, (uint64_t)file->set->height - 1, 4, code, err);
    }
    put_attribute(output, "lineOrder", "lineOrder", 1, code, err);
    put_number(output, 0, 1, code, err);
    put_attribute(output, "pixelAspectRatio", "float", 4, code, err);
    put(output, &one, 4, code, err);
    put_attribute(output, "screenWindowCenter", "v2f", 8, code, err);
    put(output, zero, 8, code, err);
    put_attribute(output, "screenWindowWidth", "float", 4, code, err);
    put(output, &one, 4, code, err);
    put_number(output, 0, 1, code, err);
}

/* Bytes of the header, which the offsets of chunks count from. */
static int header_bytes(const LayersFile *file, size_t *bytes, RetexError *err)
{
    RetexOutput *memory = NULL;
    void *header = NULL;
    int code = retex_output_open_memory(&memory, err);
    if (code)
        return code;
    put_header(memory, file, &code, err);
    if (code)
        retex_output_abandon(&memory);
    else
        code = retex_output_take(&memory, &header, bytes, err);
    free(header);
    return code;
}

static int write_file(const LayersFile *file, const char *path, RetexError *err)
{
    RetexOutput *output = NULL;
    size_t header;
    int code = header_bytes(file, &header, err);
    if (!code)
        code = retex_output_open(&output, path, err);
    if (code)
        return code;
    put_header(output, file, &code, err);
    uint64_t offset = header + (uint64_t)file->nchunks * 8;
    for (int k = 0; k < file->nchunks; k++) {
        put_number(output, offset, 8, &code, err);
        offset += 8 + file->bytes[k];
    }
    for (int k = 0; k < file->nchunks; k++) {
        put_number(output, (uint64_t)k * LINES, 4, &code, err);
        put_number(output, file->bytes[k], 4, &code, err);
        put(output, file->chunks[k], file->bytes[k], &code, err);
    }
    if (!code)
        return retex_output_commit(&output, err);
    retex_output_abandon(&output);
    return code;
}

static int open_file(LayersFile *file, const RetexSet *set, int nthreads, RetexError *err)
{
    size_t channels = 0;
    *file = (LayersFile){.set = set, .nchunks = (set->height + LINES - 1) / LINES};
    for (int i = 0; i < set->nparts; i++) {
        if (!set->parts[i].image.pixels)
            return retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
        channels += strlen(set->parts[i].letters) + 1;
    }
    file->channels = calloc(channels + 1, sizeof *file->channels);
    file->chunks = calloc((size_t)file->nchunks, sizeof *file->chunks);
    file->bytes = calloc((size_t)file->nchunks, sizeof *file->bytes);
    file->zips = calloc((size_t)nthreads, sizeof *file->zips);
    if (!file->channels || !file->chunks || !file->bytes || !file->zips)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write layers");
    for (int i = 0; i < set->nparts; i++)
        if (retex_set_is_layer(set, i))
            add_layer(file, i);
    qsort(file->channels, (size_t)file->nchannels, sizeof *file->channels, compare_channels);
    if (file->row_bytes * LINES > INT32_MAX)
        return retex_fail(err, RETEX_ELIMIT, "%d channels of %d pixels a row are too many for a flat EXR file",
                          file->nchannels, set->width);
    return RETEX_OK;
}

static void close_file(LayersFile *file, int nthreads)
{
    for (int k = 0; k < file->nchunks && file->chunks; k++)
        free(file->chunks[k]);
    for (int k = 0; k < nthreads && file->zips; k++)
        retex_zip_free(&file->zips[k]);
    free(file->channels);
    free(file->chunks);
    free(file->bytes);
    free(file->zips);
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
    nthreads = retex_threads(nthreads);
    int code = open_file(&file, set, nthreads, err);
    if (!code) {
        retex_parallel(nthreads, file.nchunks, pack_chunk, &file);
        code = file.starved ? retex_fail(err, RETEX_ENOMEM, "no memory to write layers") : write_file(&file, path, err);
    }
    close_file(&file, nthreads);
    return code;
}
