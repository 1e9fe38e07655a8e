/* Reads the manifest. Every reference is resolved and every count, size and name is checked here, so that no other code
 * has to: a RetexSet that exists is consistent. Unknown keys are skipped, because a later version may add some. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>

#include <retex/host/band_store.h>
#include <retex/host/set_build.h>

#include "set/manifest_fields.h"
#include "set/parts.h"
#include "set/references.h"

static void get_pair(Reading *reading, const json_t *object, const char *key, double out[2])
{
    const json_t *array = retex_reading_array(reading, object, key, 2);

    for (size_t i = 0; i < 2; i++)
        out[i] = retex_reading_real(reading, json_array_get(array, i), key);
}

/* The part of the standard deviations of u and v, with or without their correlation; or that of the axes of a
 * parallelogram. */
static int get_spread(Reading *reading, const RetexSet *set, const json_t *json)
{
    const char *name = json_string_value(json_object_get(json, "spread"));
    if (json_object_get(json, "axes")) {
        if (json_object_get(json, "spread"))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a footprint with both \"spread\" and \"axes\"");
        return retex_reading_part(reading, set, json, "axes", RETEX_AXES, 1);
    }
    const int part = name ? retex_set_find_part(set, name) : -1;
    return retex_reading_part(reading, set, json, "spread", part >= 0 && set->parts[part].image.channels == 3 ? 3 : 2,
                              1);
}

/* Parses the checksums of bands: eight hexadecimal digits each. */
static uint32_t *parse_bands(Reading *reading, const json_t *json, int height)
{
    const size_t count = ((size_t)height + RETEX_BAND_ROWS - 1) / RETEX_BAND_ROWS;
    const char *digits = json_string_value(json);
    uint32_t *bands = NULL;

    if (!digits || strlen(digits) != 8 * count || strspn(digits, "0123456789abcdef") != 8 * count)
        retex_reading_fail(reading, RETEX_EFORMAT, "has no proper checksums of a part's \"bands\"");
    else if (!(bands = calloc(count, sizeof *bands)))
        retex_reading_fail(reading, RETEX_ENOMEM, "does not fit in memory");
    for (size_t i = 0; bands && i < count; i++) {
        char hex[9] = "";
        memcpy(hex, digits + 8 * i, 8);
        bands[i] = (uint32_t)strtoul(hex, NULL, 16);
    }
    return bands;
}

/* Reads the checksums of the bands of the next part. */
static void read_bands(Reading *reading, const json_t *part, int height)
{
    const json_t *json = json_object_get(part, "bands");

    if (reading->sums && !reading->code)
        reading->sums->of[reading->sums->count++] = json ? parse_bands(reading, json, height) : NULL;
}

void retex_band_sums_free(RetexBandSums *sums)
{
    for (int i = 0; i < sums->count; i++)
        free(sums->of[i]);
    free(sums->of);
    *sums = (RetexBandSums){0};
}

static void read_part(Reading *reading, const json_t *json, RetexPart *part)
{
    char type[8] = "", hex[16] = "", *end = hex;

    retex_reading_text(reading, json, "name", part->name, sizeof part->name);
    retex_reading_text(reading, json, "letters", part->letters, sizeof part->letters);
    retex_reading_text(reading, json, "type", type, sizeof type);
    retex_reading_text(reading, json, "crc32", hex, sizeof hex);
    part->image.width = retex_reading_integer(reading, json, "width", 1, RETEX_MAX_SIZE);
    part->image.height = retex_reading_integer(reading, json, "height", 1, RETEX_MAX_SIZE);
    if (!reading->code && !retex_letters_are_valid(part->letters))
        retex_reading_fail(reading, RETEX_EFORMAT, "has a part of channels \"%.16s\"", part->letters);
    part->image.channels = (int)strlen(part->letters);
    part->crc = (uint32_t)strtoul(hex, &end, 16);
    if (strlen(hex) != 8 || *end || hex[0] == '+' || hex[0] == '-')
        retex_reading_fail(reading, RETEX_EFORMAT, "has no proper checksum of part \"%.64s\"", part->name);
    part->type = strcmp(type, "float") == 0 ? RETEX_FLOAT : RETEX_HALF;
    if (part->type == RETEX_HALF && strcmp(type, "half") != 0)
        retex_reading_fail(reading, RETEX_EFORMAT, "has a part of type \"%s\"", type);
}

static void read_parts(Reading *reading, const json_t *root, RetexSet *set)
{
    const json_t *array = retex_reading_array(reading, root, "parts", RETEX_SET_PARTS_MAX);
    const size_t count = json_array_size(array);

    if (count == 0 && !set->is_samples)
        retex_reading_fail(reading, RETEX_EFORMAT, "lists no parts");
    set->parts = calloc(count ? count : 1, sizeof *set->parts);
    if (!set->parts)
        retex_reading_fail(reading, RETEX_ENOMEM, "does not fit in memory");
    for (size_t i = 0; i < count && !reading->code; i++) {
        RetexPart *part = &set->parts[i];
        read_part(reading, json_array_get(array, i), part);
        read_bands(reading, json_array_get(array, i), part->image.height);
        if (reading->code)
            return;
        if (!retex_name_is_valid(part->name))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a part named \"%.64s\"", part->name);
        else if (retex_set_find_part(set, part->name) >= 0)
            retex_reading_fail(reading, RETEX_EFORMAT, "has two parts named \"%s\"", part->name);
        set->nparts = (int)i + 1;
    }
    if (!reading->code && !set->is_samples) {
        retex_reading_check_size(reading, set, 0, "parts");
        if (strcmp(set->parts[0].letters, "RGB") != 0)
            retex_reading_fail(reading, RETEX_EFORMAT, "has a first part that is no picture");
    }
}

static void read_finishes(Reading *reading, const json_t *json, RetexTarget *target)
{
    const json_t *names = retex_reading_array(reading, json, "finishes", RETEX_FINISHES_MAX);

    target->nfinishes = (int)json_array_size(names);
    target->finish = retex_reading_integer(reading, json, "finish", 1, target->nfinishes);
    for (int k = 0; k < target->nfinishes && !reading->code; k++) {
        const char *name = json_string_value(json_array_get(names, (size_t)k));
        if (!name || !*name || strlen(name) >= sizeof target->finishes[k])
            retex_reading_fail(reading, RETEX_EFORMAT, "has a finish without a proper name");
        else
            strcpy(target->finishes[k], name);
        target->finish_roughness[k] = -1;
    }
    if (json_object_get(json, "normal_tilt"))
        target->normal_tilt = retex_reading_real(reading, json_object_get(json, "normal_tilt"), "normal_tilt");
    if (!json_object_get(json, "finish_roughness")) /* older sets do not know it */
        return;
    const json_t *roughness = retex_reading_array(reading, json, "finish_roughness", (size_t)target->nfinishes);
    for (size_t k = 0; k < json_array_size(roughness); k++)
        target->finish_roughness[k] =
            (float)retex_reading_real(reading, json_array_get(roughness, k), "finish_roughness");
}

static void read_target(Reading *reading, const json_t *json, RetexSet *set, RetexTarget *target)
{
    const json_t *periodic = retex_reading_array(reading, json, "periodic", 2);
    const json_t *albedo = retex_reading_array(reading, json, "mean_albedo", 3);

    retex_reading_text(reading, json, "name", target->name, sizeof target->name);
    retex_reading_text(reading, json, "idents", target->idents, sizeof target->idents);
    if (!reading->code && !target->name[0])
        retex_reading_fail(reading, RETEX_EFORMAT, "has a target without a name");
    for (int i = 0; i < set->ntargets; i++)
        if (strcmp(set->targets[i].name, target->name) == 0)
            retex_reading_fail(reading, RETEX_EFORMAT, "has two targets named \"%s\"", target->name);
    for (size_t i = 0; i < 2; i++)
        target->periodic[i] = retex_reading_boolean(reading, json_array_get(periodic, i), "periodic");
    for (size_t i = 0; i < 3; i++)
        target->mean_albedo[i] = (float)retex_reading_real(reading, json_array_get(albedo, i), "mean_albedo");
    get_pair(reading, json, "uv_min", target->uv_min);
    get_pair(reading, json, "uv_max", target->uv_max);
    get_pair(reading, json, "original_min", target->original_min);
    get_pair(reading, json, "original_max", target->original_max);
    if (json_object_get(json, "uv_scale"))
        get_pair(reading, json, "uv_scale", target->uv_scale);
    if (json_object_get(json, "finishes"))
        read_finishes(reading, json, target);
    target->share = retex_reading_real(reading, json_object_get(json, "share"), "share");
    const json_t *original = json_object_get(json, "original");
    const char *name = json_string_value(original);
    target->original = name ? retex_set_find_part(set, name) : -1;
    if (target->original < 0 && !json_is_null(original))
        retex_reading_fail(reading, RETEX_EFORMAT, "refers to a part that is not there in \"original\"");
    if (json_object_get(json, "texture"))
        retex_reading_text(reading, json, "texture", target->texture, sizeof target->texture);
    if (json_object_get(json, "gates"))
        target->gates = 1 + retex_reading_part(reading, set, json, "gates", 3, 0);
    retex_reading_check_size(reading, set, target->gates - 1, "gates");
}

/* What the texture shows that is laid on a footprint's target. */
static void read_laid(Reading *reading, const json_t *json, const RetexSet *set, RetexFootprint *footprint)
{
    const json_t *finished = json_object_get(json, "finished");
    const int count =
        finished ? (int)json_array_size(retex_reading_array(reading, json, "finished", RETEX_FINISHES_MAX)) : 0;
    if (json_object_get(json, "sampled"))
        footprint->sampled = 1 + retex_reading_part(reading, set, json, "sampled", 3, 0);
    retex_reading_check_scale(reading, set, footprint->sampled - 1, "sampled");
    for (int k = 0; k < count && !reading->code; k++) {
        const char *name = json_string_value(json_array_get(finished, (size_t)k));
        const int part = name ? retex_set_find_part(set, name) : -1;
        if (part < 0 || set->parts[part].image.channels != 3 || !footprint->sampled ||
            retex_set_scale(set, &set->parts[part].image) !=
                retex_set_scale(set, &set->parts[footprint->sampled - 1].image))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a footprint whose parts differ in size");
        footprint->finished[k] = 1 + part;
    }
    if (!reading->code && count && count != set->targets[footprint->target].nfinishes)
        retex_reading_fail(reading, RETEX_EFORMAT, "has a footprint with other finishes than its target");
}

static void read_targets(Reading *reading, const json_t *root, RetexSet *set)
{
    const json_t *array = retex_reading_array(reading, root, "targets", RETEX_MAX_TARGETS);

    for (size_t i = 0; i < json_array_size(array) && !reading->code; i++) {
        read_target(reading, json_array_get(array, i), set, &set->targets[i]);
        set->ntargets = (int)i + 1;
    }
}

static void read_footprints(Reading *reading, const json_t *root, RetexSet *set)
{
    const json_t *array = retex_reading_array(reading, root, "footprints", RETEX_SET_FOOTPRINTS_MAX);

    for (size_t i = 0; i < json_array_size(array) && !reading->code; i++) {
        const json_t *json = json_array_get(array, i);
        RetexFootprint footprint = {
            .target = retex_reading_integer(reading, json, "target", 0, set->ntargets - 1),
            .hit = retex_reading_integer(reading, json, "hit", 1, 1 << 20),
            .uv = retex_reading_part(reading, set, json, "uv", 3, 1),
            .spread = get_spread(reading, set, json),
            .albedo = retex_reading_part(reading, set, json, "albedo", 3, 1),
        };
        if (json_object_get(json, "quadrant"))
            footprint.quadrant = retex_reading_integer(reading, json, "quadrant", 0, RETEX_QUADRANTS);
        if (reading->code)
            return;
        if (json_object_get(json, "kind"))
            footprint.kind = (RetexFootprintKind)retex_reading_named(reading, json, "kind", "kind",
                                                                     retex_footprint_kind_name, RETEX_FOOTPRINT_KINDS);
        retex_reading_check_scale(reading, set, footprint.uv, "uv");
        retex_reading_check_scale(reading, set, footprint.spread, "spread");
        retex_reading_check_scale(reading, set, footprint.albedo, "albedo");
        read_laid(reading, json, set, &footprint);
        if (!reading->code)
            reading->code = retex_set_add_footprint(set, &footprint, NULL, reading->err);
        if (!reading->code && !retex_set_footprint_scale(set, set->nfootprints - 1))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a footprint whose parts differ in size");
    }
}

static void read_mixture(Reading *reading, const json_t *array, RetexSet *set)
{
    RetexMixture mixture = {.nshares = (int)json_array_size(array)};

    if (!json_is_array(array) || json_array_size(array) > RETEX_SHARES_MAX) {
        retex_reading_fail(reading, RETEX_EFORMAT, "has a mixture that is no list of at most %d", RETEX_SHARES_MAX);
        return;
    }
    for (int i = 0; i < mixture.nshares && !reading->code; i++) {
        const json_t *json = json_array_get(array, (size_t)i);
        mixture.shares[i].footprint = retex_reading_integer(reading, json, "footprint", 0, set->nfootprints - 1);
        mixture.shares[i].weight = retex_reading_weight(reading, set, json, "weight");
        retex_reading_check_scale(reading, set, mixture.shares[i].weight, "weight");
        if (reading->code)
            return;
        const int scale = retex_set_scale(set, &set->parts[mixture.shares[i].weight].image);
        if (scale != retex_set_footprint_scale(set, mixture.shares[i].footprint) ||
            scale != retex_set_scale(set, &set->parts[mixture.shares[0].weight].image))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a mixture whose footprints and weights differ in size");
    }
    if (!reading->code)
        reading->code = retex_set_add_mixture(set, &mixture, NULL, reading->err);
}

static void read_mixtures(Reading *reading, const json_t *root, RetexSet *set)
{
    if (!json_object_get(root, "mixtures"))
        return;
    const json_t *array = retex_reading_array(reading, root, "mixtures", RETEX_MIXTURES_MAX);
    for (size_t i = 0; i < json_array_size(array) && !reading->code; i++)
        read_mixture(reading, json_array_get(array, i), set);
}

/* Parses an id: eight hexadecimal digits. */
static uint32_t get_identity(Reading *reading, const json_t *json, const char *key)
{
    char hex[16], *end;

    retex_reading_text(reading, json, key, hex, sizeof hex);
    unsigned long id = strtoul(hex, &end, 16);
    if (!reading->code && (end != hex + 8 || *end))
        retex_reading_fail(reading, RETEX_EFORMAT, "has no \"%s\" of eight hexadecimal digits", key);
    return (uint32_t)id;
}

/* {"hits": 2, "ratio": [.4, .4, .3]}: see RETEX_QUANTITY_FURTHER. */
static void read_further_hits(Reading *reading, const json_t *json, RetexSet *set)
{
    const json_t *ratio = retex_reading_array(reading, json, "ratio", 3);

    set->further_hits = retex_reading_integer(reading, json, "hits", 1, RETEX_FURTHER_HITS_MAX);
    for (size_t c = 0; c < 3; c++) {
        const double value = retex_reading_real(reading, json_array_get(ratio, c), "ratio");
        if (!(value >= 0 && value <= RETEX_FURTHER_RATIO_MAX))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a ratio of further hits out of range");
        set->further_ratio[c] = (float)value;
    }
}

/* How often a part is referred to, and whether a texture that is laid on the set has it. */
typedef struct PartUses {
    int count, is_laid;
} PartUses;

static void count_use(void *context, RetexPartUse use, int user, int *part)
{
    PartUses *uses = context;
    (void)user;
    uses[*part].count++;
    uses[*part].is_laid |= use == RETEX_PART_LAID || use == RETEX_PART_GATES;
}

/* Parts of textures leave the set when these do, so nothing else may have them. */
static void check_laid(Reading *reading, const RetexSet *set)
{
    PartUses *uses = calloc((size_t)set->nparts + 1, sizeof *uses);
    if (!uses) {
        retex_reading_fail(reading, RETEX_ENOMEM, "does not fit in memory");
        return;
    }
    retex_set_visit_const_parts(set, count_use, uses);
    for (int i = 0; i < set->nparts && !reading->code; i++)
        if (uses[i].is_laid ? uses[i].count > 1 || (i == 0 && !set->is_samples) || set->parts[i].type != RETEX_FLOAT
                            : set->is_samples)
            retex_reading_fail(reading, RETEX_EFORMAT, "has textures' part \"%.64s\", which is used as another one",
                               set->parts[i].name);
    free(uses);
}

static void read_reference(Reading *reading, const json_t *json, RetexSetReference *reference)
{
    const json_int_t bytes = json_integer_value(json_object_get(json, "bytes"));

    retex_reading_text(reading, json, "path", reference->path, sizeof reference->path);
    reference->crc = get_identity(reading, json, "crc32");
    reference->bytes = bytes > 0 ? (uint64_t)bytes : 0;
    if (!reading->code && (reference->path[0] != '/' || !reference->bytes))
        retex_reading_fail(reading, RETEX_EFORMAT, "refers to a set without an absolute path or a size");
}

static void read_set(Reading *reading, const json_t *root, int is_samples, RetexSet **result)
{
    RetexSet *set = calloc(1, sizeof *set);
    const json_t *seed = json_object_get(root, "seed");

    *result = set;
    if (!set) {
        retex_reading_fail(reading, RETEX_ENOMEM, "does not fit in memory");
        return;
    }
    set->is_samples = is_samples;
    set->width = retex_reading_integer(reading, root, "width", 1, RETEX_MAX_SIZE);
    set->height = retex_reading_integer(reading, root, "height", 1, RETEX_MAX_SIZE);
    if (reading->code)
        return;
    retex_reading_text(reading, root, "layout", set->layout, sizeof set->layout);
    retex_reading_text(reading, root, "filter", set->filter, sizeof set->filter);
    retex_reading_text(reading, root, "scene", set->scene, sizeof set->scene);
    retex_reading_text(reading, root, "generator", set->generator, sizeof set->generator);
    set->orders = retex_reading_integer(reading, root, "orders", 0, RETEX_MAX_ORDERS);
    set->spp = retex_reading_integer(reading, root, "spp", 0, 1 << 30);
    set->max_depth = retex_reading_integer(reading, root, "max_depth", 0, 1 << 30);
    if (!json_is_integer(seed) || json_integer_value(seed) < 0 || json_integer_value(seed) > UINT32_MAX)
        retex_reading_fail(reading, RETEX_EFORMAT, "has no integer \"seed\" of 32 bits");
    set->seed = (uint32_t)json_integer_value(seed);
    set->id = get_identity(reading, root, "id");
    set->folded = retex_reading_real(reading, json_object_get(root, "folded"), "folded");
    if (json_object_get(root, "folded_white"))
        set->folded_white = retex_reading_real(reading, json_object_get(root, "folded_white"), "folded_white");
    if (json_object_get(root, "depth_cut"))
        set->depth_cut = retex_reading_real(reading, json_object_get(root, "depth_cut"), "depth_cut");
    if (json_object_get(root, "exposure"))
        set->exposure = retex_reading_real(reading, json_object_get(root, "exposure"), "exposure");
    if (json_object_get(root, "further"))
        read_further_hits(reading, json_object_get(root, "further"), set);
    set->unit = json_object_get(root, "unit") ? retex_reading_real(reading, json_object_get(root, "unit"), "unit") : 1;
    if (!reading->code && !(set->unit > 0))
        retex_reading_fail(reading, RETEX_EFORMAT, "has a scene unit of 0 metres or less");
    if (json_object_get(root, "denoised"))
        set->denoised = retex_reading_boolean(reading, json_object_get(root, "denoised"), "denoised");
    set->strict_paper = retex_reading_boolean(reading, json_object_get(root, "strict_paper"), "strict_paper");
    if (!reading->code)
        read_parts(reading, root, set);
    if (!reading->code)
        read_targets(reading, root, set);
    if (!reading->code)
        read_footprints(reading, root, set);
    if (!reading->code)
        read_mixtures(reading, root, set);
    if (!reading->code)
        retex_reading_terms(reading, root, set);
    if (!reading->code)
        check_laid(reading, set);
    if (!reading->code && is_samples && json_object_get(root, "set"))
        read_reference(reading, json_object_get(root, "set"), &set->refers);
}

/* Checks the version before everything else: in a manifest of another version nothing else may be relied on. Builds
 * from before the release counted too, and wrote a version 1 without a list of parameters, which every set of this one
 * has. */
static void check_version(Reading *reading, const json_t *root, RetexManifestSum sum)
{
    const json_t *version = json_object_get(root, "retex");
    const json_int_t number = json_integer_value(version);

    if (!json_is_integer(version) || number < 1)
        retex_reading_fail(reading, RETEX_EFORMAT, "has no version");
    else if (number != RETEX_FORMAT_VERSION)
        retex_reading_fail(reading, RETEX_EUNSUPPORTED,
                           "is of version %lld; this program reads version %d: render again", (long long)number,
                           RETEX_FORMAT_VERSION);
    else if (json_object_get(root, "terms") && !json_object_get(root, "parameters"))
        retex_reading_fail(reading, RETEX_EUNSUPPORTED,
                           "has terms but no list of parameters, as before the release of version %d: render again",
                           RETEX_FORMAT_VERSION);
    else if (sum == RETEX_MANIFEST_UNSEALED)
        retex_reading_fail(reading, RETEX_EFORMAT, "is damaged: its checksum is missing");
}

static void read_root(Reading *reading, const json_t *root, RetexManifestSum sum, RetexSet **set)
{
    char kind[32] = "";

    check_version(reading, root, sum);
    if (reading->code)
        return;
    retex_reading_text(reading, root, "kind", kind, sizeof kind);
    const int is_samples = strcmp(kind, "samples") == 0;
    if (!is_samples && strcmp(kind, "set") != 0)
        retex_reading_fail(reading, RETEX_EFORMAT, "is of unknown kind \"%s\"", kind);
    if (!reading->code)
        read_set(reading, root, is_samples, set);
}

int retex_manifest_read(const char *json, const char *name, RetexSet **set, RetexBandSums *sums, RetexError *err)
{
    Reading reading = {name, err, 0, sums};
    const RetexManifestSum sum = retex_manifest_sum(json);
    json_error_t where;

    *set = NULL;
    if (sums)
        *sums = (RetexBandSums){0, calloc((size_t)RETEX_SET_PARTS_MAX, sizeof *sums->of)};
    if (sums && !sums->of)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    if (sum == RETEX_MANIFEST_WRONG)
        return retex_fail(err, RETEX_EFORMAT, "%s: the manifest is damaged: its checksum is wrong", name);
    json_t *root = json_loads(json, JSON_REJECT_DUPLICATES, &where);
    if (!root && !where.text[0]) /* jansson says nothing then */
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    if (!root)
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set (its `retex` attribute is no JSON: %s)", name,
                          where.text);
    if (!json_is_object(root))
        retex_reading_fail(&reading, RETEX_EFORMAT, "is no JSON object");
    else
        read_root(&reading, root, sum, set);
    json_decref(root);
    if (*set)
        (*set)->file_sum = retex_manifest_own_sum(json);
    if (reading.code)
        retex_set_close(set);
    return reading.code;
}
