/* The key "pack" of a manifest: writing and parsing. See format.h. */
#include "pack/format.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "base/half.h"
#include "base/json_write.h"
#include "set/manifest.h"

static const char *const codec_names[RETEX_PACK_CODECS] = {"zero", "planes", "jpeg"};

void retex_pack_part_begin(RetexPackPart *packed, const RetexPart *part)
{
    memset(packed, 0, sizeof *packed);
    packed->width = part->image.width;
    packed->height = part->image.height;
    packed->channels = (int)strlen(part->letters);
    packed->type = part->type;
    packed->nstrips = (part->image.height + RETEX_PACK_STRIP_ROWS - 1) / RETEX_PACK_STRIP_ROWS;
    packed->present = packed->sigma = -1;
}

int retex_pack_part_slices(RetexPackPart *packed, RetexError *err)
{
    packed->nslices = packed->codec == RETEX_PACK_ZERO     ? 0
                      : packed->codec == RETEX_PACK_PLANES ? packed->nstrips * packed->channels
                                                           : 1 + packed->nstrips * (1 + packed->masked);
    packed->bytes = calloc((size_t)packed->nslices + 1, sizeof *packed->bytes);
    packed->crcs = calloc((size_t)packed->nslices + 1, sizeof *packed->crcs);
    return packed->bytes && packed->crcs ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory for a pack's index");
}

void retex_pack_part_free(RetexPackPart *packed)
{
    free(packed->offsets);
    free(packed->bytes);
    free(packed->crcs);
    packed->offsets = NULL;
    packed->bytes = packed->crcs = NULL;
}

int retex_pack_strip_rows(const RetexPackPart *packed, int strip)
{
    const int left = packed->height - strip * RETEX_PACK_STRIP_ROWS;
    return left < RETEX_PACK_STRIP_ROWS ? left : RETEX_PACK_STRIP_ROWS;
}

int retex_pack_lattice_shift(const RetexPackPart *packed, int code, int per_octave)
{
    const int octaves = code - 1 + packed->sigma_first;
    const int shift = code > 0 && octaves > 0 ? octaves / per_octave : 0;
    return shift < RETEX_PACK_LATTICE_SHIFT_MAX ? shift : RETEX_PACK_LATTICE_SHIFT_MAX;
}

int retex_pack_mask_width(const RetexPackPart *packed)
{
    return (packed->width + 7) / 8;
}

void retex_pack_file_name(char *name, size_t size, const RetexSet *set, int part, int planes)
{
    if (part == 0 && !planes)
        snprintf(name, size, RETEX_PACK_PICTURE_NAME);
    else
        snprintf(name, size, planes ? "planes/%s.blk" : "radiance/%s.jpg", set->parts[part].name);
}

void retex_pack_level_name(char *name, size_t size, int scale)
{
    snprintf(name, size, "level-%d.retex", scale);
}

int retex_pack_damaged(RetexError *err, const char *what, const char *name)
{
    return retex_fail(err, RETEX_EFORMAT, "the pack is damaged: %s '%s'", what, name);
}

int retex_pack_samples_crc(uint32_t *crc, const RetexPart *part, RetexError *err)
{
    const size_t n = (size_t)part->image.width * (size_t)part->image.height, channels = (size_t)part->image.channels;
    float *plane = malloc(n * sizeof *plane);
    uint16_t *halves = malloc(n * sizeof *halves);
    uint32_t sum = CRC32_OF_NONE;
    if (!plane || !halves) {
        free(plane);
        free(halves);
        return retex_fail(err, RETEX_ENOMEM, "no memory to pack part '%s'", part->name);
    }
    for (size_t c = 0; c < channels; c++) {
        for (size_t i = 0; i < n; i++)
            plane[i] = part->image.pixels[i * channels + c];
        if (part->type == RETEX_HALF) {
            retex_half_from_float(halves, plane, n);
            sum = retex_crc32(sum, halves, n * sizeof *halves);
        } else {
            sum = retex_crc32(sum, plane, n * sizeof *plane);
        }
    }
    free(plane);
    free(halves);
    *crc = sum;
    return 0;
}

/* --- to JSON --- */

/* The key of per_octave. */
static const char *octaves_key(const RetexPackMap *map)
{
    return map->kind == RETEX_PACK_MAP_ANGLE ? "steps" : "per_octave";
}

static json_t *describe_map(const RetexPackMap *map)
{
    json_t *o = json_pack("{s:s}", "map", retex_pack_map_names[map->kind]);
    if (map->kind == RETEX_PACK_MAP_PALETTE) {
        json_t *numbers = json_array();
        for (int i = 0; i < map->count; i++)
            retex_json_add(&numbers, json_integer(map->palette[i]));
        retex_json_put(&o, "numbers", numbers);
        return o;
    }
    if (retex_pack_map_is_coded(map) && map->kind != RETEX_PACK_MAP_ANGLE)
        retex_json_put(&o, "first", json_real(map->first));
    if (retex_pack_map_is_coded(map) && map->kind != RETEX_PACK_MAP_LINEAR)
        retex_json_put(&o, octaves_key(map), json_integer(map->per_octave));
    return o;
}

json_t *retex_pack_describe_white(const RetexPackCurve *curve)
{
    const double *white = curve->white;
    return white[0] == white[1] && white[0] == white[2] ? json_real(white[0])
                                                        : json_pack("[f, f, f]", white[0], white[1], white[2]);
}

static json_t *describe_part(const RetexSet *set, int part, const RetexPackPart *packed)
{
    json_t *o = json_pack("{s:s, s:s}", "name", set->parts[part].name, "codec", codec_names[packed->codec]);
    if (packed->codec == RETEX_PACK_JPEG) {
        retex_json_put(&o, "white", retex_pack_describe_white(&packed->curve));
        retex_json_put(&o, "levels", json_real(packed->curve.levels));
        retex_json_put(&o, "masked", json_boolean(packed->masked));
    }
    if (packed->codec == RETEX_PACK_PLANES) {
        json_t *channels = json_array();
        for (int c = 0; c < packed->channels; c++)
            retex_json_add(&channels, describe_map(&packed->maps[c]));
        retex_json_put(&o, "channels", channels);
        if (packed->present >= 0)
            retex_json_put(&o, "present", json_string(set->parts[packed->present].name));
        if (packed->sigma >= 0) {
            retex_json_put(&o, "sigma", json_string(set->parts[packed->sigma].name));
            retex_json_put(&o, "sigma_first", json_integer(packed->sigma_first));
        }
    }
    return o;
}

char *retex_pack_describe(const char *manifest, const RetexSet *set, const RetexPackPart *packed,
                          const RetexPackPromise *promise, const RetexPackScales *levels)
{
    json_t *root = json_loads(manifest, 0, NULL), *parts = json_array();
    for (int i = 0; i < set->nparts; i++)
        retex_json_add(&parts, describe_part(set, i, &packed[i]));
    json_t *pack = json_pack("{s:o}", "parts", parts);
    if (promise) {
        retex_json_put(&pack, "quality", json_integer(promise->quality));
        retex_json_put(&pack, "promised", json_real(promise->promised));
        retex_json_put(&pack, "measured", json_real(promise->measured));
    }
    if (levels && levels->count) {
        json_t *scales = json_array();
        for (int i = 0; i < levels->count; i++)
            retex_json_add(&scales, json_integer(levels->of[i]));
        retex_json_put(&pack, "levels", scales);
    }
    retex_json_put(&root, "pack", pack);
    char *text = retex_json_text(root, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(root);
    if (text)
        retex_manifest_seal(text);
    return text;
}

/* --- from JSON --- */

static int get_positive(const json_t *value, double *out)
{
    *out = json_number_value(value);
    return json_is_number(value) && isfinite(*out) && *out > 0 && *out < 1e30;
}

static int get_integer(const json_t *value, int least, int most, int *out)
{
    const json_int_t v = json_integer_value(value);
    *out = json_is_integer(value) && v >= least && v <= most ? (int)v : 0;
    return json_is_integer(value) && v >= least && v <= most;
}

int retex_pack_promise_of(RetexPackPromise *promise, const char *manifest)
{
    json_t *root = json_loads(manifest, 0, NULL);
    const json_t *pack = json_object_get(root, "pack");
    const int sound = get_integer(json_object_get(pack, "quality"), 1, 100, &promise->quality) &&
                      get_positive(json_object_get(pack, "promised"), &promise->promised) &&
                      get_positive(json_object_get(pack, "measured"), &promise->measured);
    json_decref(root);
    return sound;
}

int retex_pack_levels_of(RetexPackScales *levels, const char *manifest, RetexError *err)
{
    json_t *root = json_loads(manifest, 0, NULL);
    const json_t *scales = json_object_get(json_object_get(root, "pack"), "levels");
    const size_t count = json_array_size(scales);
    int sound = !scales || (json_is_array(scales) && count > 0 && count <= RETEX_PACK_LEVELS_MAX), least = 2;
    *levels = (RetexPackScales){0};
    for (size_t i = 0; i < count && sound; i++) {
        int *scale = &levels->of[levels->count++];
        sound = get_integer(json_array_get(scales, i), least, RETEX_PACK_LEVEL_SCALE_MAX, scale);
        least = *scale + 1;
    }
    json_decref(root);
    return sound ? 0 : retex_fail(err, RETEX_EFORMAT, "the pack is damaged: its list of smaller sets is not sound");
}

/* The numbers of a palette, which ascend. */
static int parse_palette(RetexPackMap *map, const json_t *numbers, RetexPixelType type)
{
    const int most = type == RETEX_HALF ? INT16_MAX : INT32_MAX;
    int least = -most - 1, ok = json_array_size(numbers) > 0 && json_array_size(numbers) <= RETEX_PACK_CODES;
    for (size_t i = 0; ok && i < json_array_size(numbers); i++) {
        ok = get_integer(json_array_get(numbers, i), least, most, &map->palette[map->count++]);
        ok = ok && (i == 0 || map->palette[i] > map->palette[i - 1]);
        least = map->palette[i];
    }
    retex_pack_map_fill_palette(map, type);
    return ok;
}

static int parse_map(RetexPackMap *map, const json_t *o, RetexPixelType type)
{
    const char *name = json_string_value(json_object_get(o, "map"));
    int kind = 0, ok = 1;
    while (name && kind < RETEX_PACK_MAPS && strcmp(name, retex_pack_map_names[kind]) != 0)
        kind++;
    if (!name || kind == RETEX_PACK_MAPS)
        return 0;
    map->kind = (RetexPackMapKind)kind;
    if (map->kind == RETEX_PACK_MAP_PALETTE)
        return parse_palette(map, json_object_get(o, "numbers"), type);
    if (retex_pack_map_is_coded(map) && map->kind != RETEX_PACK_MAP_ANGLE)
        ok = get_positive(json_object_get(o, "first"), &map->first);
    if (retex_pack_map_is_coded(map) && map->kind != RETEX_PACK_MAP_LINEAR)
        ok = ok && get_integer(json_object_get(o, octaves_key(map)), 1, 1000, &map->per_octave);
    retex_pack_map_fill(map);
    return ok;
}

/* The part named by a key, or -1 if the key is missing. *ok = 0 if no part of this size has the name. */
static int named_part(const json_t *o, const char *key, const RetexSet *set, const RetexPackPart *packed, int *ok)
{
    const json_t *value = json_object_get(o, key);
    if (!value)
        return -1;
    const char *name = json_string_value(value);
    const int part = name ? retex_set_find_part(set, name) : -1;
    if (part < 0 || set->parts[part].image.width != packed->width || set->parts[part].image.height != packed->height)
        *ok = 0;
    return part;
}

/* The way back. */
static int parse_white(RetexPackCurve *curve, const json_t *o)
{
    int ok = !json_is_array(o) || json_array_size(o) == 3;
    for (size_t c = 0; c < 3; c++)
        ok = ok && get_positive(json_is_array(o) ? json_array_get(o, c) : o, &curve->white[c]);
    return ok;
}

static int parse_part(RetexPackPart *packed, const RetexSet *set, const json_t *o, RetexError *err)
{
    const char *codec = json_string_value(json_object_get(o, "codec"));
    int c = 0, ok = 1;
    while (codec && c < RETEX_PACK_CODECS && strcmp(codec, codec_names[c]) != 0)
        c++;
    if (codec && c == RETEX_PACK_CODECS)
        return retex_fail(err, RETEX_EUNSUPPORTED, "a part is packed as '%.64s'; this version knows %s, %s and %s",
                          codec, codec_names[0], codec_names[1], codec_names[2]);
    packed->codec = codec ? (RetexPackCodec)c : RETEX_PACK_ZERO;
    ok = codec != NULL && packed->channels <= RETEX_PACK_CHANNELS_MAX;
    if (ok && packed->codec == RETEX_PACK_JPEG) {
        const json_t *masked = json_object_get(o, "masked");
        ok = parse_white(&packed->curve, json_object_get(o, "white")) &&
             get_positive(json_object_get(o, "levels"), &packed->curve.levels) && packed->curve.levels >= 255 &&
             packed->curve.levels <= RETEX_PACK_LEVELS_MOST && json_is_boolean(masked) &&
             (packed->channels == 1 || packed->channels == 3) && packed->width <= RETEX_PACK_JPEG_SIDE_MAX &&
             packed->height <= RETEX_PACK_JPEG_SIDE_MAX;
        packed->masked = json_is_true(masked);
    }
    if (ok && packed->codec == RETEX_PACK_PLANES) {
        const json_t *channels = json_object_get(o, "channels");
        ok = json_array_size(channels) == (size_t)packed->channels;
        for (int i = 0; ok && i < packed->channels; i++)
            ok = parse_map(&packed->maps[i], json_array_get(channels, (size_t)i), packed->type);
        packed->present = named_part(o, "present", set, packed, &ok);
        packed->sigma = named_part(o, "sigma", set, packed, &ok);
        if (packed->sigma >= 0)
            ok = ok && get_integer(json_object_get(o, "sigma_first"), -100000, 100000, &packed->sigma_first);
    }
    return ok ? 0 : retex_fail(err, RETEX_EFORMAT, "the pack is damaged: the description of a part is not sound");
}

/* Axes are steps in all channels, of the means whose coverage says where they are. */
static int steps_are_sound(int part, const RetexPackPart *all)
{
    const RetexPackPart *packed = &all[part], *means = packed->present >= 0 ? &all[packed->present] : NULL;
    int ok = means && packed->channels == RETEX_AXES && means->present == packed->present && means->sigma == part;
    for (int c = 0; c < packed->channels; c++)
        ok = ok && packed->maps[c].kind == RETEX_PACK_MAP_STEP &&
             (c > 1 || means->maps[c].kind == RETEX_PACK_MAP_LATTICE);
    return ok;
}

static int is_step(const RetexPackPart *packed, int c)
{
    return packed->maps[c].kind == RETEX_PACK_MAP_STEP;
}

/* Check that a part refers to parts of the right kind, and that there are no cycles: coverage refers to no part,
 * standard deviations to coverage, means to both, axes, beyond their sizes, to means. */
static int references_are_sound(int part, const RetexPackPart *all)
{
    const RetexPackPart *packed = &all[part];
    if (packed->codec != RETEX_PACK_PLANES)
        return 1;
    const RetexPackPart *present = packed->present >= 0 ? &all[packed->present] : NULL;
    if (present &&
        (present->codec != RETEX_PACK_PLANES || present->channels != 3 || !retex_pack_map_is_coded(&present->maps[2]) ||
         (present->present >= 0 && &all[present->present] != present)))
        return 0;
    for (int c = 0; c < packed->channels; c++)
        if (packed->maps[c].kind == RETEX_PACK_MAP_LATTICE) {
            const RetexPackPart *sigma = packed->sigma >= 0 ? &all[packed->sigma] : NULL;
            if (!present || !sigma || c > 1 || sigma->codec != RETEX_PACK_PLANES || sigma->channels < 2 ||
                (sigma->maps[c].kind != RETEX_PACK_MAP_LOG && !is_step(sigma, c)) || sigma->present != packed->present)
                return 0;
        } else if (is_step(packed, c) && !steps_are_sound(part, all)) {
            return 0;
        }
    return 1;
}

/* Where UV are periodic whose steps are axes. */
static void find_wraps(RetexPackPart *packed, const RetexSet *set)
{
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        for (int a = 0; a < 2 && f->spread >= 0; a++)
            packed[f->spread].wraps[a] = set->targets[f->target].periodic[a];
    }
}

int retex_pack_parse(RetexPackPart *packed, const RetexSet *set, const char *manifest, RetexError *err)
{
    json_t *root = json_loads(manifest, 0, NULL);
    const json_t *parts = json_object_get(json_object_get(root, "pack"), "parts");
    int code = 0;
    if (json_array_size(parts) != (size_t)set->nparts)
        code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: its list of parts does not match");
    for (int i = 0; !code && i < set->nparts; i++) {
        const json_t *o = json_array_get(parts, (size_t)i);
        const char *name = json_string_value(json_object_get(o, "name"));
        retex_pack_part_begin(&packed[i], &set->parts[i]);
        if (!name || strcmp(name, set->parts[i].name) != 0)
            code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: its list of parts does not match");
        else
            code = parse_part(&packed[i], set, o, err);
    }
    for (int i = 0; !code && i < set->nparts; i++)
        if (!references_are_sound(i, packed))
            code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: the description of a part is not sound");
    if (!code)
        find_wraps(packed, set);
    for (int i = 0; !code && i < set->nparts; i++)
        code = retex_pack_part_slices(&packed[i], err);
    json_decref(root);
    return code;
}
