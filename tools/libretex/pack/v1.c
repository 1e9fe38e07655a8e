/* Packs of version 1. Each part is one piece: parts/NAME.data, and for JPEGs parts/NAME.mask, whose set bits are black
 * pixels. Codec `planes` is deflate over the bytes of the stored samples, by channel and significance; `jpeg-log` a
 * JPEG of log2(1 + x / scale) up to max, `jpeg-srgb` one of sRGB-encoded values, both times a gain for each channel. */
#include "pack/v1.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <turbojpeg.h>
#include <zlib.h>

#include <retex/parallel.h>

#include "exr/io.h"
#include "base/half.h"
#include "pack/format.h"

enum { DEFLATE_RATIO_MAX = 1032 };

typedef struct Item {
    RetexPart *part;
    const char *codec;
    unsigned char *data, *mask;
    size_t bytes, mask_bytes;
    double scale, max, gain[3];
    int code;
    RetexError err;
} Item;

static int damaged(RetexError *err, const char *name)
{
    return retex_fail(err, RETEX_EFORMAT, "the pack is damaged: part '%s' cannot be decoded", name);
}

static int is_jpeg(const Item *item)
{
    return strncmp(item->codec, "jpeg-", 5) == 0;
}

/* --- decoding --- */

static int inflate_whole(unsigned char *to, size_t bytes, const unsigned char *data, size_t packed)
{
    uLongf got = bytes;
    return uncompress(to, &got, data, packed) == Z_OK && got == bytes;
}

static void join_bytes(RetexPart *part, const unsigned char *raw, uint16_t *halves, float *plane)
{
    const size_t n = (size_t)part->image.width * (size_t)part->image.height, channels = (size_t)part->image.channels;
    for (size_t c = 0; c < channels; c++) {
        for (size_t i = 0; i < n && part->type == RETEX_HALF; i++)
            halves[i] = (uint16_t)(raw[i] | raw[n + i] << 8);
        for (size_t i = 0; i < n && part->type == RETEX_FLOAT; i++) {
            const uint32_t bits =
                raw[i] | (uint32_t)raw[n + i] << 8 | (uint32_t)raw[2 * n + i] << 16 | (uint32_t)raw[3 * n + i] << 24;
            memcpy(&plane[i], &bits, sizeof bits);
        }
        if (part->type == RETEX_HALF)
            retex_half_to_float(plane, halves, n);
        for (size_t i = 0; i < n; i++)
            part->image.pixels[i * channels + c] = plane[i];
        raw += n * (part->type == RETEX_HALF ? 2 : 4);
    }
}

static int decode_planes(Item *item, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    const size_t n = (size_t)im->width * (size_t)im->height;
    const size_t total = n * (size_t)im->channels * (item->part->type == RETEX_HALF ? 2 : 4);
    unsigned char *raw = malloc(total);
    uint16_t *halves = malloc(n * sizeof *halves);
    float *plane = malloc(n * sizeof *plane);
    uint32_t crc = 0;
    int code = raw && halves && plane ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    if (!code && !inflate_whole(raw, total, item->data, item->bytes))
        code = damaged(err, item->part->name);
    if (!code)
        join_bytes(item->part, raw, halves, plane);
    free(raw);
    free(halves);
    free(plane);
    if (!code)
        code = pack_samples_crc(&crc, item->part, err);
    return !code && crc != item->part->crc ? damaged(err, item->part->name) : code;
}

static int apply_mask(Item *item, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    const size_t n = (size_t)im->width * (size_t)im->height, bytes = (n + 7) / 8;
    unsigned char *bits = malloc(bytes);
    int code = bits ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    if (!code && !inflate_whole(bits, bytes, item->mask, item->mask_bytes))
        code = damaged(err, item->part->name);
    for (size_t i = 0; !code && i < n; i++)
        if (bits[i / 8] >> i % 8 & 1)
            memset(im->pixels + 3 * i, 0, 3 * sizeof(float));
    free(bits);
    return code;
}

static int decode_jpeg(Item *item, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    const size_t n = (size_t)im->width * (size_t)im->height;
    const double range = strcmp(item->codec, "jpeg-log") == 0 ? log2(1 + item->max / item->scale) : 0;
    const PackCurve srgb = {1, 255};
    int width, height, subsampling, colorspace;
    unsigned char *codes = im->channels == 3 ? malloc(3 * n) : NULL;
    tjhandle jpeg = tjInitDecompress();
    const int ok =
        codes && jpeg &&
        tjDecompressHeader3(jpeg, item->data, item->bytes, &width, &height, &subsampling, &colorspace) == 0 &&
        width == im->width && height == im->height &&
        tjDecompress2(jpeg, item->data, item->bytes, codes, width, 0, height, TJPF_RGB,
                      TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) == 0;
    float value[256];
    for (int i = 0; i < 256; i++)
        value[i] = (float)(range > 0 ? item->scale * (exp2(i / 255.0 * range) - 1) : pack_curve_value(&srgb, i));
    for (size_t i = 0; ok && i < 3 * n; i++)
        im->pixels[i] = value[codes[i]] * (float)item->gain[i % 3];
    if (jpeg)
        tjDestroy(jpeg);
    free(codes);
    if (!ok)
        return damaged(err, item->part->name);
    return item->mask ? apply_mask(item, err) : 0;
}

static void decode_item(void *context, int index, int thread)
{
    (void)thread;
    Item *item = (Item *)context + index;
    if (is_jpeg(item))
        item->code = decode_jpeg(item, &item->err);
    else if (strcmp(item->codec, "planes") == 0)
        item->code = decode_planes(item, &item->err);
}

/* --- what the manifest says --- */

static int get_positive(const json_t *value, double *out)
{
    *out = json_number_value(value);
    return json_is_number(value) && isfinite(*out) && *out > 0;
}

static int parse_item(Item *item, const json_t *o)
{
    static const char *const codecs[] = {"zero", "planes", "jpeg-log", "jpeg-srgb"};
    const char *name = json_string_value(json_object_get(o, "name"));
    const char *codec = json_string_value(json_object_get(o, "codec"));
    item->codec = NULL;
    for (size_t i = 0; codec && i < sizeof codecs / sizeof *codecs; i++)
        if (strcmp(codec, codecs[i]) == 0)
            item->codec = codecs[i];
    int ok = item->codec && name && strcmp(name, item->part->name) == 0;
    if (ok && strcmp(item->codec, "jpeg-log") == 0)
        ok = get_positive(json_object_get(o, "scale"), &item->scale) &&
             get_positive(json_object_get(o, "max"), &item->max);
    for (size_t c = 0; ok && is_jpeg(item) && c < 3; c++)
        ok = get_positive(json_array_get(json_object_get(o, "gain"), c), &item->gain[c]);
    return ok;
}

/* A file of the zip, whose checksum must be right; one that may be missing gives NULL. */
static int load_file(unsigned char **data, size_t *bytes, const Item *item, const char *ending, int needed,
                     const RetexInput *input, const ZipList *entries, int *used, RetexError *err)
{
    char name[PACK_NAME_MAX];
    snprintf(name, sizeof name, "parts/%s%s", item->part->name, ending);
    const ZipEntry *entry = zip_list_find(entries, name);
    if (!entry)
        return needed ? retex_fail(err, RETEX_EFORMAT, "the pack is damaged: it lacks '%s'", name) : 0;
    *used += 1;
    *bytes = (size_t)entry->bytes;
    *data = malloc(*bytes + 1);
    if (!*data)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    if (retex_input_read(input, *data, *bytes, entry->offset) == (int64_t)*bytes &&
        (uint32_t)crc32_z(crc32(0, NULL, 0), *data, *bytes) == entry->crc)
        return 0;
    const int code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: the checksum is wrong of '%s'", name);
    return retex_input_check(input, code, err);
}

/* A part of this size cannot be in fewer bytes. */
static size_t least_bytes(const Item *item)
{
    const RetexImage *im = &item->part->image;
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    if (is_jpeg(item))
        return pixels / 64 / 8; /* at least a bit a block */
    const size_t wide = item->part->type == RETEX_HALF ? 2 : 4;
    return strcmp(item->codec, "zero") == 0 ? 0 : pixels * (size_t)im->channels * wide / DEFLATE_RATIO_MAX;
}

static int load_item(Item *item, const RetexInput *input, const ZipList *entries, int *used, RetexError *err)
{
    RetexImage *image = &item->part->image;
    const RetexImage shape = *image;
    const int has_data = strcmp(item->codec, "zero") != 0;
    int code = load_file(&item->data, &item->bytes, item, ".data", has_data, input, entries, used, err);
    if (!code)
        code = load_file(&item->mask, &item->mask_bytes, item, ".mask", 0, input, entries, used, err);
    if (!code && item->bytes < least_bytes(item))
        code = damaged(err, item->part->name);
    if (code)
        return code;
    *image = (RetexImage){0};
    code = retex_image_alloc(image, shape.width, shape.height, shape.channels, err);
    if (code)
        *image = shape;
    return code;
}

static int read_items(Item *items, RetexSet *set, const RetexInput *input, const ZipList *entries, const json_t *parts,
                      int nthreads, RetexError *err)
{
    uint64_t memory = 0;
    int code = 0, used = 1;
    for (int i = 0; !code && i < set->nparts; i++) {
        const RetexImage *im = &set->parts[i].image;
        items[i].part = &set->parts[i];
        memory += (uint64_t)im->width * (uint64_t)im->height * (uint64_t)im->channels * sizeof(float);
        if (memory > RETEX_EXR_MEMORY_MAX)
            code = retex_fail(err, RETEX_ELIMIT, "the pack's images are too large");
        else if (!parse_item(&items[i], json_array_get(parts, (size_t)i)))
            code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: the description of a part is not sound");
        else
            code = load_item(&items[i], input, entries, &used, err);
    }
    if (!code && used != entries->count)
        code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: it has entries that its manifest does not know");
    if (!code)
        retex_parallel(nthreads, set->nparts, decode_item, items);
    for (int i = 0; !code && i < set->nparts; i++)
        if (items[i].code)
            code = retex_fail(err, items[i].code, "%s", items[i].err.message);
    for (int i = 0; !code && i < set->nparts; i++)
        code = retex_numbers_check_part(&set->parts[i], err);
    return code;
}

int pack_v1_read(RetexSet *set, const RetexInput *input, const ZipList *entries, const char *manifest, int nthreads,
                 RetexError *err)
{
    Item *items = calloc((size_t)set->nparts + 1, sizeof *items);
    if (!items)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    json_t *root = json_loads(manifest, 0, NULL);
    const json_t *parts = json_object_get(json_object_get(root, "pack"), "parts");
    int code = read_items(items, set, input, entries, parts, nthreads, err);
    for (int i = 0; i < set->nparts; i++) {
        free(items[i].data);
        free(items[i].mask);
    }
    free(items);
    json_decref(root);
    return code;
}
