/* Reading a pack. Nothing in it is believed: every entry must have the name, the size and the checksum the manifest
 * promises, nothing else may be there, and no size is allocated that the bytes at hand could not hold. */
#include <retex/pack.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>
#include <zlib.h>

#include <retex/parallel.h>

#include "exr_io.h"
#include "manifest.h"
#include "pack_codec.h"
#include "pack_format.h"

typedef struct Item {
    RetexPart *part;
    RetexPacked packed;
    uint32_t data_crc, mask_crc; /* promised */
    int code;
    RetexError err;
} Item;

typedef struct Reading {
    zip_t *zip;
    size_t bytes;     /* of the whole pack */
    zip_int64_t used; /* entries that something referred to */
    RetexError *err;
} Reading;

static int bad(const Reading *r, const char *what)
{
    return retex_fail(r->err, RETEX_EFORMAT, "the pack is damaged: %s", what);
}

/* --- entries --- */

/* A name we write: the manifest, or a part's data or mask; so no folder but ours and no way out of it. */
static int name_is_ours(const char *name)
{
    char part[RETEX_NAME_MAX];
    if (strcmp(name, PACK_MANIFEST) == 0)
        return 1;
    size_t length = strlen(name), folder = strlen(PACK_FOLDER), ending = strlen(PACK_DATA);
    if (length <= folder + ending || length - folder - ending >= sizeof part || strncmp(name, PACK_FOLDER, folder) != 0)
        return 0;
    if (strcmp(name + length - ending, PACK_DATA) != 0 && strcmp(name + length - ending, PACK_MASK) != 0)
        return 0;
    snprintf(part, sizeof part, "%.*s", (int)(length - folder - ending), name + folder);
    return retex_name_is_valid(part);
}

static int check_entries(const Reading *r)
{
    char what[256];
    zip_int64_t entries = zip_get_num_entries(r->zip, 0);
    if (entries > 2 * RETEX_SET_PARTS_MAX + 1)
        return bad(r, "it has too many entries");
    for (zip_int64_t i = 0; i < entries; i++) {
        zip_stat_t stat;
        const zip_uint64_t wanted =
            ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
        if (zip_stat_index(r->zip, (zip_uint64_t)i, 0, &stat) || (stat.valid & wanted) != wanted)
            return bad(r, "an entry has no proper header");
        if (!name_is_ours(stat.name)) {
            snprintf(what, sizeof what, "it has an entry '%.128s', which no pack has", stat.name);
            return bad(r, what);
        }
        if (stat.comp_method != ZIP_CM_STORE || stat.encryption_method != ZIP_EM_NONE || stat.size != stat.comp_size ||
            stat.size > r->bytes)
            return bad(r, "an entry is not stored plainly");
    }
    return 0;
}

/* Read an entry whole, with a NUL behind it. bytes: what it must have, or SIZE_MAX = any up to limit. */
static int read_entry(Reading *r, const char *name, size_t bytes, size_t limit, unsigned char **data, size_t *got)
{
    zip_stat_t stat;
    char what[PACK_FILE_MAX + 64];
    snprintf(what, sizeof what, "'%s' is missing, cut short or changed", name);
    if (zip_stat(r->zip, name, 0, &stat) || !(stat.valid & ZIP_STAT_SIZE))
        return bad(r, what);
    if ((bytes != SIZE_MAX && stat.size != bytes) || stat.size > limit)
        return bad(r, what);
    zip_file_t *file = zip_fopen(r->zip, name, 0);
    *data = file ? malloc(stat.size + 1) : NULL;
    if (file && !*data) {
        zip_fclose(file);
        return retex_fail(r->err, RETEX_ENOMEM, "no memory to read a pack");
    }
    /* asking for one more byte makes libzip see the end and compare its own checksum */
    zip_int64_t n = file ? zip_fread(file, *data, stat.size + 1) : -1;
    if (file && n == (zip_int64_t)stat.size)
        n = zip_fread(file, what, 1) == 0 ? n : -1;
    if (file && zip_fclose(file) != 0)
        n = -1;
    if (n != (zip_int64_t)stat.size) {
        free(*data);
        *data = NULL;
        return bad(r, what);
    }
    (*data)[stat.size] = 0;
    *got = stat.size;
    r->used++;
    return 0;
}

/* --- the manifest's pack section --- */

static int get_crc(const json_t *object, const char *key, uint32_t *crc)
{
    const char *text = json_string_value(json_object_get(object, key));
    if (!text || strlen(text) != 8 || strspn(text, "0123456789abcdef") != 8)
        return 0;
    *crc = (uint32_t)strtoul(text, NULL, 16);
    return 1;
}

static int get_size(const json_t *object, const char *key, size_t most, size_t *size)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_integer(value) || json_integer_value(value) < 0 || (size_t)json_integer_value(value) > most)
        return 0;
    *size = (size_t)json_integer_value(value);
    return 1;
}

static int get_positive(const json_t *value, double *out)
{
    *out = json_number_value(value);
    return json_is_number(value) && isfinite(*out) && *out > 0;
}

static int parse_codec(const Reading *r, Item *item, const json_t *o)
{
    const char *codec = json_string_value(json_object_get(o, "codec"));
    for (int c = 0; codec && c < RETEX_PACK_CODECS; c++)
        if (strcmp(codec, retex_pack_codec_names[c]) == 0) {
            item->packed.codec = (RetexPackCodec)c;
            return 0;
        }
    if (!codec)
        return bad(r, "a part has no codec");
    return retex_fail(r->err, RETEX_EUNSUPPORTED,
                      "part '%s' is packed as '%.64s'; this version knows %s, %s, %s and %s", item->part->name, codec,
                      retex_pack_codec_names[0], retex_pack_codec_names[1], retex_pack_codec_names[2],
                      retex_pack_codec_names[3]);
}

static int parse_item(const Reading *r, Item *item, const json_t *o)
{
    RetexPacked *p = &item->packed;
    const char *name = json_string_value(json_object_get(o, "name"));
    if (!name || strcmp(name, item->part->name) != 0)
        return bad(r, "its list of parts does not match");
    int code = parse_codec(r, item, o);
    if (code)
        return code;
    int ok = get_size(o, "bytes", r->bytes, &p->bytes) && get_crc(o, "crc32", &item->data_crc);
    if (json_object_get(o, "mask_bytes"))
        ok = ok && get_size(o, "mask_bytes", r->bytes, &p->mask_bytes) && get_crc(o, "mask_crc32", &item->mask_crc);
    if (p->codec == RETEX_PACK_LOG)
        ok = ok && get_positive(json_object_get(o, "scale"), &p->scale) &&
             get_positive(json_object_get(o, "max"), &p->max);
    for (size_t c = 0; c < 3 && (p->codec == RETEX_PACK_LOG || p->codec == RETEX_PACK_SRGB); c++)
        ok = ok && get_positive(json_array_get(json_object_get(o, "gain"), c), &p->gain[c]);
    const RetexImage *im = &item->part->image;
    ok = ok && p->bytes >= retex_pack_least_bytes(p->codec, item->part, im->width, im->height);
    return ok ? 0 : bad(r, "the description of a part is not sound");
}

static int parse_pack(const Reading *r, Item *items, const RetexSet *set, const char *manifest)
{
    json_t *root = json_loads(manifest, 0, NULL);
    const json_t *pack = json_object_get(root, "pack"), *parts = json_object_get(pack, "parts");
    const json_t *version = json_object_get(pack, "version");
    uint64_t memory = 0;
    int code = 0;
    if (!json_is_integer(version))
        code = bad(r, "its manifest does not say how parts are packed");
    else if (json_integer_value(version) != PACK_VERSION)
        code = retex_fail(r->err, RETEX_EUNSUPPORTED, "the pack has version %lld; this program reads version %d",
                          (long long)json_integer_value(version), PACK_VERSION);
    else if (json_array_size(parts) != (size_t)set->nparts)
        code = bad(r, "its list of parts does not match");
    for (int i = 0; !code && i < set->nparts; i++) {
        const RetexImage *im = &set->parts[i].image;
        items[i].part = &set->parts[i];
        memory += (uint64_t)im->width * (uint64_t)im->height * (uint64_t)im->channels * sizeof(float);
        code = memory > RETEX_EXR_MEMORY_MAX ? retex_fail(r->err, RETEX_ELIMIT, "the pack's images are too large")
                                             : parse_item(r, &items[i], json_array_get(parts, (size_t)i));
    }
    json_decref(root);
    return code;
}

/* --- parts --- */

static int load_blob(Reading *r, const Item *item, const char *ending, size_t bytes, uint32_t crc, unsigned char **data)
{
    char name[PACK_FILE_MAX], what[PACK_FILE_MAX + 64];
    snprintf(name, sizeof name, PACK_FOLDER "%s%s", item->part->name, ending);
    int code = read_entry(r, name, bytes, r->bytes, data, &bytes);
    if (!code && (uint32_t)crc32_z(crc32(0, NULL, 0), *data, bytes) != crc) {
        snprintf(what, sizeof what, "the checksum of '%s' is wrong", name);
        code = bad(r, what);
    }
    return code;
}

static int load_item(Reading *r, Item *item)
{
    RetexPacked *p = &item->packed;
    int code = 0;
    if (p->codec != RETEX_PACK_ZERO)
        code = load_blob(r, item, PACK_DATA, p->bytes, item->data_crc, &p->data);
    if (!code && p->mask_bytes)
        code = load_blob(r, item, PACK_MASK, p->mask_bytes, item->mask_crc, &p->mask);
    if (!code) {
        RetexImage image = {0};
        code = retex_image_alloc(&image, item->part->image.width, item->part->image.height, item->part->image.channels,
                                 r->err);
        item->part->image = image;
    }
    return code;
}

static void decode_item(void *context, int index, int thread)
{
    (void)thread;
    Item *item = (Item *)context + index;
    uint32_t promised = item->part->crc;
    item->code = retex_pack_decode(item->part, &item->packed, &item->err);
    int lossy = item->packed.codec == RETEX_PACK_LOG || item->packed.codec == RETEX_PACK_SRGB;
    if (!item->code && !lossy && item->part->crc != promised)
        item->code = retex_fail(&item->err, RETEX_EFORMAT, "the pack is damaged: the checksum of part '%s' is wrong",
                                item->part->name);
    retex_packed_free(&item->packed);
}

static int read_parts(Reading *r, RetexSet *set, const char *manifest, int nthreads)
{
    Item *items = calloc((size_t)set->nparts + 1, sizeof *items);
    if (!items)
        return retex_fail(r->err, RETEX_ENOMEM, "no memory to read a pack");
    int code = parse_pack(r, items, set, manifest);
    for (int i = 0; !code && i < set->nparts; i++)
        code = load_item(r, &items[i]);
    if (!code && r->used != zip_get_num_entries(r->zip, 0))
        code = bad(r, "it has entries the manifest does not know");
    if (!code)
        retex_parallel(nthreads, set->nparts, decode_item, items);
    for (int i = 0; !code && i < set->nparts; i++)
        if (items[i].code)
            code = retex_fail(r->err, items[i].code, "%s", items[i].err.message);
    for (int i = 0; i < set->nparts; i++)
        retex_packed_free(&items[i].packed);
    free(items);
    return code;
}

static int read_zip(Reading *r, RetexSet **set, int nthreads)
{
    unsigned char *manifest = NULL;
    size_t length;
    int code = check_entries(r);
    if (!code)
        code = read_entry(r, PACK_MANIFEST, SIZE_MAX, PACK_MANIFEST_MAX, &manifest, &length);
    if (!code && strlen((char *)manifest) != length)
        code = bad(r, "its manifest is no text");
    if (!code) {
        RetexSamples *samples = NULL;
        RetexSamplePart *sample_parts = NULL;
        code = retex_manifest_read((char *)manifest, "the pack", set, &samples, &sample_parts, r->err);
        free(sample_parts);
        retex_samples_close(&samples);
        if (!code && !*set)
            code = bad(r, "its manifest describes no set");
    }
    if (!code)
        code = read_parts(r, *set, (char *)manifest, nthreads);
    free(manifest);
    return code;
}

int retex_pack_read(const void *data, size_t bytes, RetexSet **set, int nthreads, RetexError *err)
{
    Reading r = {.bytes = bytes, .err = err};
    zip_error_t error;
    *set = NULL;
    zip_error_init(&error);
    zip_source_t *source = zip_source_buffer_create(data, bytes, 0, &error);
    r.zip = source ? zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error) : NULL;
    if (!r.zip) {
        int code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged or truncated: %s", zip_error_strerror(&error));
        zip_source_free(source);
        zip_error_fini(&error);
        return code;
    }
    zip_error_fini(&error);
    int code = read_zip(&r, set, nthreads);
    zip_discard(r.zip);
    if (code)
        retex_set_close(set);
    return code;
}

int retex_pack_name_error(int code, const char *name, RetexError *err)
{
    if (code && err && !err->file[0])
        snprintf(err->file, sizeof err->file, "%s", name);
    return code;
}

int retex_pack_probe(const void *data, size_t bytes)
{
    return bytes >= 4 && memcmp(data, "PK\3\4", 4) == 0;
}

int retex_pack_check(const void *data, size_t bytes, RetexError *err)
{
    RetexSet *set = NULL;
    int code = retex_pack_read(data, bytes, &set, 0, err);
    retex_set_close(&set);
    return code;
}
