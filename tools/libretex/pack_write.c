/* Writing a pack: what only denoising reads is left out, the other parts are encoded on all threads, the manifest says
 * how, a stored zip holds both. The bytes depend on the set and the parameters only: no dates, no order of threads. */
#include <retex/pack.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>
#include <zlib.h>

#include <retex/parallel.h>

#include "output.h"
#include "pack_codec.h"
#include "pack_format.h"
#include "set_parts.h"

/* Encoding one part. */
typedef struct Item {
    const RetexPart *part;
    const RetexImage *spread; /* of a footprint's UV part that may be snapped; else NULL */
    int is_spread;            /* standard deviations, which may be rounded */
    RetexPackCodec wanted;
    int quality, code;
    double mean; /* see retex_pack_encode */
    RetexPacked packed;
    RetexError err;
} Item;

/* --- which codec for which part --- */

static void want(Item *items, int part, RetexPackCodec codec)
{
    if (part >= 0)
        items[part].wanted = codec;
}

/* Light and albedo may be JPEG; a UV may lose what is far below its own spread; all else keeps its bits. */
static void choose_codecs(Item *items, const RetexSet *set, const RetexPackParams *params)
{
    for (int i = 0; i < set->nparts; i++) {
        items[i].part = &set->parts[i];
        items[i].quality = params->quality;
        items[i].wanted = RETEX_PACK_PLANES;
    }
    if (params->lossless)
        return;
    double mean = set->nparts > 0 ? retex_pack_mean(&set->parts[0].image) : 0;
    want(items, set->nparts > 0 ? 0 : -1, RETEX_PACK_LOG);
    for (int i = 0; i < set->nterms; i++) {
        want(items, set->terms[i].radiance, RETEX_PACK_LOG);
        items[set->terms[i].radiance].mean = mean;
    }
    for (int i = 0; i < set->ntargets; i++)
        want(items, set->targets[i].original, RETEX_PACK_SRGB);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        want(items, f->albedo, RETEX_PACK_SRGB);
        if (f->uv >= 0 && f->spread >= 0) {
            items[f->uv].spread = &set->parts[f->spread].image;
            items[f->spread].is_spread = 1;
        }
    }
}

/* Round u and v to a power of two below an eighth of their standard deviation: 1/16 of a footprint's width is far below
 * what filtering a texture over it can show, and the bits of noise below cost most of a pack. */
static void snap_uv(RetexImage *uv, const RetexImage *spread)
{
    const double finest = ldexp(1, -18); /* 1/64 texel of a 4K texture */
    for (size_t i = 0; i < (size_t)uv->width * (size_t)uv->height; i++)
        for (size_t c = 0; c < 2; c++) {
            double sigma = (double)spread->pixels[(size_t)spread->channels * i + c];
            double value = (double)uv->pixels[3 * i + c];
            double step = sigma > 0 && isfinite(sigma) ? fmax(exp2(floor(log2(sigma / 8))), finest) : finest;
            if (isfinite(value))
                uv->pixels[3 * i + c] = (float)(rint(value / step) * step);
        }
}

/* Round standard deviations to five significant bits: to within 3%. A correlation, the third channel, keeps its bits:
 * near 1 they are the narrower width. */
static void round_spread(RetexImage *spread)
{
    for (size_t i = 0; i < (size_t)spread->channels * (size_t)spread->width * (size_t)spread->height; i++) {
        int exponent;
        if (i % (size_t)spread->channels == 2)
            continue;
        double fraction = frexp((double)spread->pixels[i], &exponent);
        if (isfinite(fraction))
            spread->pixels[i] = (float)ldexp(rint(fraction * 32) / 32, exponent);
    }
}

/* What is far below seeing is removed from a footprint's part before it is encoded without loss. *changed gets the
 * copy. */
static int simplify(RetexPart *part, const Item *item, RetexImage *changed, RetexError *err)
{
    RetexImage *im = &part->image;
    const RetexImage *spread = item->spread;
    int snap = spread && part->type == RETEX_FLOAT && im->channels == 3 && spread->channels >= 2 &&
               spread->width == im->width && spread->height == im->height;
    if (!snap && !item->is_spread)
        return 0;
    int code = retex_image_copy(changed, im, err);
    if (code)
        return code;
    if (snap)
        snap_uv(changed, spread);
    else
        round_spread(changed);
    *im = *changed;
    return 0;
}

static void encode_item(void *context, int index, int thread)
{
    (void)thread;
    Item *item = (Item *)context + index;
    RetexPart part = *item->part;
    RetexImage changed = {0};
    item->code = simplify(&part, item, &changed, &item->err);
    if (!item->code)
        item->code = retex_pack_encode(&item->packed, &part, item->wanted, item->quality, item->mean, &item->err);
    retex_image_free(&changed);
}

/* --- the manifest --- */

static json_t *hex(uint32_t value)
{
    char text[16];
    snprintf(text, sizeof text, "%08x", (unsigned)value);
    return json_string(text);
}

static uint32_t bytes_crc(const unsigned char *data, size_t bytes)
{
    return (uint32_t)crc32_z(crc32(0, NULL, 0), data, bytes);
}

static json_t *describe_item(const Item *item)
{
    const RetexPacked *p = &item->packed;
    json_t *o = json_pack("{s:s, s:s, s:I, s:o}", "name", item->part->name, "codec", retex_pack_codec_names[p->codec],
                          "bytes", (json_int_t)p->bytes, "crc32", hex(bytes_crc(p->data, p->bytes)));
    if (p->mask) {
        json_object_set_new(o, "mask_bytes", json_integer((json_int_t)p->mask_bytes));
        json_object_set_new(o, "mask_crc32", hex(bytes_crc(p->mask, p->mask_bytes)));
    }
    if (p->codec == RETEX_PACK_LOG) {
        json_object_set_new(o, "scale", json_real(p->scale));
        json_object_set_new(o, "max", json_real(p->max));
    }
    if (p->codec == RETEX_PACK_LOG || p->codec == RETEX_PACK_SRGB)
        json_object_set_new(o, "gain", json_pack("[f, f, f]", p->gain[0], p->gain[1], p->gain[2]));
    return o;
}

/* The set's manifest with what the pack adds: how each part is encoded, in the order of its parts. */
static int write_manifest(char **text, const RetexSet *set, const Item *items, RetexError *err)
{
    RetexSet described = *set;
    char *json = NULL;
    described.parts = malloc((size_t)set->nparts * sizeof *described.parts);
    if (!described.parts)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the pack's manifest");
    for (int i = 0; i < set->nparts; i++) {
        described.parts[i] = set->parts[i];
        described.parts[i].crc = items[i].packed.crc;
    }
    int code = retex_set_manifest(&described, NULL, &json, err);
    free(described.parts);
    if (code)
        return code;
    json_t *root = json_loads(json, 0, NULL), *parts = json_array();
    free(json);
    for (int i = 0; i < set->nparts; i++)
        json_array_append_new(parts, describe_item(&items[i]));
    json_object_set_new(root, "pack", json_pack("{s:i, s:o}", "version", PACK_VERSION, "parts", parts));
    *text = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(root);
    return *text ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory for the pack's manifest");
}

/* --- the zip --- */

static int zip_failed(zip_error_t *error, RetexError *err)
{
    int code = zip_error_code_zip(error) == ZIP_ER_MEMORY ? RETEX_ENOMEM : RETEX_EINTERNAL;
    retex_fail(err, code, "cannot build the pack: %s", zip_error_strerror(error));
    zip_error_fini(error);
    return code;
}

/* data is borrowed until the zip is closed. */
static int add_file(zip_t *zip, const char *name, const void *data, size_t bytes)
{
    zip_source_t *source = zip_source_buffer(zip, data, bytes, 0);
    zip_int64_t index = source ? zip_file_add(zip, name, source, 0) : -1;
    if (index < 0) {
        zip_source_free(source);
        return -1;
    }
    /* 1 January 1980, the first day zip knows: the same set gives the same bytes */
    return zip_set_file_compression(zip, (zip_uint64_t)index, ZIP_CM_STORE, 0) ||
           zip_file_set_dostime(zip, (zip_uint64_t)index, 0, 0x21, 0);
}

static int add_items(zip_t *zip, const Item *items, int count)
{
    char name[PACK_FILE_MAX];
    for (int i = 0; i < count; i++) {
        const RetexPacked *p = &items[i].packed;
        snprintf(name, sizeof name, PACK_FOLDER "%s" PACK_DATA, items[i].part->name);
        if (p->data && add_file(zip, name, p->data, p->bytes))
            return -1;
        snprintf(name, sizeof name, PACK_FOLDER "%s" PACK_MASK, items[i].part->name);
        if (p->mask && add_file(zip, name, p->mask, p->mask_bytes))
            return -1;
    }
    return 0;
}

/* Copy a finished zip into the output. */
static int copy_source(RetexOutput *output, zip_source_t *source, size_t *total, RetexError *err)
{
    char buffer[65536];
    zip_int64_t got = zip_source_open(source) == 0 ? 1 : -1;
    int code = 0;
    *total = 0;
    while (got > 0 && !code && (got = zip_source_read(source, buffer, sizeof buffer)) > 0) {
        code = retex_output_write(output, buffer, (size_t)got, err);
        *total += (size_t)got;
    }
    zip_source_close(source);
    return got < 0 ? retex_fail(err, RETEX_EINTERNAL, "cannot read back the pack") : code;
}

static int write_zip(const char *manifest, const Item *items, int count, const char *path, size_t *total,
                     RetexError *err)
{
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, &error);
    if (!source)
        return zip_failed(&error, err);
    zip_source_keep(source);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, &error);
    if (!zip) {
        zip_source_free(source);
        zip_source_free(source);
        return zip_failed(&error, err);
    }
    if (add_file(zip, PACK_MANIFEST, manifest, strlen(manifest)) || add_items(zip, items, count) || zip_close(zip)) {
        zip_error_set(&error, zip_error_code_zip(zip_get_error(zip)), 0);
        zip_discard(zip);
        zip_source_free(source);
        return zip_failed(&error, err);
    }
    zip_error_fini(&error);
    RetexOutput *output = NULL;
    int code = retex_output_open(&output, path, err);
    if (!code)
        code = copy_source(output, source, total, err);
    zip_source_free(source);
    if (!code)
        return retex_output_commit(&output, err);
    retex_output_abandon(&output);
    return code;
}

/* Pack all of a set. */
static int write_pack(const RetexSet *set, const char *path, const RetexPackParams *params, size_t *bytes,
                      RetexError *err)
{
    char *manifest = NULL;
    size_t total;
    int code = 0;
    Item *items = calloc((size_t)set->nparts + 1, sizeof *items);
    if (!items)
        return retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
    choose_codecs(items, set, params);
    retex_parallel(params->nthreads, set->nparts, encode_item, items);
    for (int i = 0; !code && i < set->nparts; i++)
        if (items[i].code)
            code = retex_fail_at(err, items[i].code, items[i].err.file, 0, 0, "%s", items[i].err.message);
    if (!code)
        code = write_manifest(&manifest, set, items, err);
    if (!code)
        code = write_zip(manifest, items, set->nparts, path, &total, err);
    if (!code && bytes)
        *bytes = total;
    free(manifest);
    for (int i = 0; i < set->nparts; i++)
        retex_packed_free(&items[i].packed);
    free(items);
    return code;
}

int retex_pack_write(const RetexSet *set, const char *path, const RetexPackParams *params, size_t *bytes,
                     RetexError *err)
{
    static const RetexPackParams defaults = RETEX_PACK_INIT;
    SetView view;
    if (!params)
        params = &defaults;
    if (params->quality < 1 || params->quality > 100)
        return retex_fail(err, RETEX_EINVAL, "quality is 1 to 100, not %d", params->quality);
    char *kept = malloc((size_t)set->nparts + 1);
    if (!kept)
        return retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
    for (int i = 0; i < set->nparts; i++)
        kept[i] = !part_is_denoise_data(set, i);
    int code = set_view_make(&view, set, kept, err);
    free(kept);
    if (code)
        return code;
    code = write_pack(&view.set, path, params, bytes, err);
    set_view_free(&view);
    return code;
}
