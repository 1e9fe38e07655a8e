/* Writes the manifest: a RetexSet as JSON. Parts are referred to by name, so that a file keeps its
 * meaning when parts are reordered, added or removed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include <retex/host/band_store.h>
#include <retex/set_file.h>

#include "base/json_write.h"
#include "set/manifest.h"

/* A JSON string of any bytes: text that is not UTF-8 loses its bytes above 127, which JSON cannot hold. */
static json_t *text(const char *bytes)
{
    json_t *value = json_string(bytes);

    if (!value) {
        char *ascii = strdup(bytes);
        for (char *byte = ascii; byte && *byte; byte++)
            if ((unsigned char)*byte > 127)
                *byte = '?';
        value = ascii ? json_string(ascii) : NULL;
        free(ascii);
    }
    return value;
}

/* A JSON number. JSON has no infinity or NaN: these become 0 and *finite is cleared. */
static json_t *real(double value, int *finite)
{
    if (!isfinite(value)) {
        *finite = 0;
        value = 0;
    }
    return json_real(value);
}

static json_t *pair(const double values[2], int *finite)
{
    return json_pack("[o, o]", real(values[0], finite), real(values[1], finite));
}

static json_t *part_name(const RetexSet *set, int part)
{
    return part < 0 || part >= set->nparts ? json_null() : json_string(set->parts[part].name);
}

static json_t *write_target(const RetexSet *set, const RetexTarget *target, int *finite)
{
    const float *albedo = target->mean_albedo;

    json_t *json =
        json_pack("{s:o, s:o, s:[b, b], s:o, s:o, s:[o, o, o], s:o, s:o, s:o, s:o, s:o}", "name", text(target->name),
                     "idents", text(target->idents), "periodic", target->periodic[0], target->periodic[1], "uv_min",
                     pair(target->uv_min, finite), "uv_max", pair(target->uv_max, finite), "mean_albedo",
                     real(albedo[0], finite), real(albedo[1], finite), real(albedo[2], finite), "original",
                     part_name(set, target->original), "original_min", pair(target->original_min, finite),
                     "original_max", pair(target->original_max, finite), "share", real(target->share, finite),
                     "uv_scale", pair(target->uv_scale, finite));
    if (target->nfinishes) {
        json_t *names = json_array();
        for (int k = 0; k < target->nfinishes; k++)
            retex_json_add(&names, text(target->finishes[k]));
        retex_json_put(&json, "finishes", names);
        retex_json_put(&json, "finish", json_integer(target->finish));
        json_t *roughness = json_array();
        for (int k = 0; k < target->nfinishes; k++)
            retex_json_add(&roughness, real(target->finish_roughness[k], finite));
        retex_json_put(&json, "finish_roughness", roughness);
        if (target->normal_tilt > 0)
            retex_json_put(&json, "normal_tilt", real(target->normal_tilt, finite));
    }
    if (target->texture[0])
        retex_json_put(&json, "texture", text(target->texture));
    if (target->gates)
        retex_json_put(&json, "gates", part_name(set, target->gates - 1));
    return json;
}

static json_t *write_footprint(const RetexSet *set, const RetexFootprint *footprint)
{
    const int has_axes = retex_footprint_has_axes(set, footprint);
    json_t *json = json_pack("{s:i, s:i, s:s, s:o, s:o, s:o}", "target", footprint->target, "hit", footprint->hit,
                             "kind", retex_footprint_kind_name(footprint->kind), "uv", part_name(set, footprint->uv),
                             has_axes ? "axes" : "spread", part_name(set, footprint->spread), "albedo",
                             part_name(set, footprint->albedo));

    if (has_axes && footprint->quadrant)
        retex_json_put(&json, "quadrant", json_integer(footprint->quadrant));
    if (footprint->sampled)
        retex_json_put(&json, "sampled", part_name(set, footprint->sampled - 1));
    json_t *finished = json_array();
    for (int k = 0; k < RETEX_FINISHES_MAX && footprint->finished[k]; k++)
        retex_json_add(&finished, part_name(set, footprint->finished[k] - 1));
    if (json_array_size(finished))
        retex_json_put(&json, "finished", finished);
    else
        json_decref(finished);
    return json;
}

static json_t *write_factor(const RetexSet *set, RetexFactor factor)
{
    const char *kind = retex_factor_kind_name(factor.kind);

    if (factor.kind == RETEX_FACTOR_IMAGE)
        return json_pack("{s:o}", kind, part_name(set, factor.index));
    if (factor.kind == RETEX_FACTOR_PARAMETER)
        return json_pack("{s:o}", kind, text(set->parameters[factor.index].name));
    json_t *json = json_pack("{s:i}", kind, factor.index);
    if (factor.quantity != RETEX_QUANTITY_COLOR)
        retex_json_put(&json, "quantity", json_string(retex_quantity_name(factor.quantity)));
    return json;
}

static json_t *target_number(int target)
{
    return target < 0 ? json_null() : json_integer(target);
}

static json_t *write_term(const RetexSet *set, const RetexTerm *term, int *finite)
{
    json_t *factors = json_array();

    for (int i = 0; i < term->nfactors; i++)
        retex_json_add(&factors, write_factor(set, term->factors[i]));
    json_t *json =
        json_pack("{s:s, s:o, s:o, s:o}", "role", retex_role_name(term->role), "target", target_number(term->target),
                  "radiance", part_name(set, term->radiance), "factors", factors);
    if (term->noise_weight > 0)
        retex_json_put(&json, "noise_weight", real((double)term->noise_weight, finite));
    return json;
}

static json_t *write_color(const float color[3], int *finite)
{
    return json_pack("[o, o, o]", real((double)color[0], finite), real((double)color[1], finite),
                     real((double)color[2], finite));
}

static json_t *write_parameter(const RetexSet *set, const RetexParameter *parameter, int *finite)
{
    json_t *json = json_pack("{s:o, s:s, s:o, s:o}", "name", text(parameter->name), "kind",
                             retex_parameter_kind_name(parameter->kind), "target", target_number(parameter->target),
                             "value", write_color(parameter->value, finite));

    if (memcmp(parameter->kept, parameter->value, sizeof parameter->kept) != 0)
        retex_json_put(&json, "kept", write_color(parameter->kept, finite));
    if (parameter->several)
        retex_json_put(&json, "several", json_true());
    if (parameter->kind == RETEX_PARAMETER_COLOR && retex_set_has_finishes(set)) {
        json_t *finishes = json_array();
        for (int t = 0; t < set->ntargets; t++)
            retex_json_add(&finishes, json_integer(parameter->finishes[t]));
        retex_json_put(&json, "lamp", text(parameter->lamp));
        retex_json_put(&json, "finishes", finishes);
    }
    return json;
}

static json_t *write_mixture(const RetexSet *set, const RetexMixture *mixture)
{
    json_t *shares = json_array();

    for (int i = 0; i < mixture->nshares; i++)
        retex_json_add(&shares, json_pack("{s:i, s:o}", "footprint", mixture->shares[i].footprint, "weight",
                                          part_name(set, mixture->shares[i].weight)));
    return shares;
}

/* The checksums of bands as one string of hexadecimal digits. */
static json_t *write_bands(const uint32_t *bands, int height)
{
    const size_t count = ((size_t)height + RETEX_BAND_ROWS - 1) / RETEX_BAND_ROWS;
    char *digits = malloc(8 * count + 1);

    for (size_t i = 0; digits && i < count; i++)
        snprintf(digits + 8 * i, 9, "%08x", (unsigned)bands[i]);
    json_t *json = digits ? json_string(digits) : NULL;
    free(digits);
    return json;
}

/* bands: the checksums of the part's bands, or NULL. */
static json_t *write_part(const RetexPart *part, const uint32_t *bands)
{
    const RetexImage *image = &part->image;
    char hex[16];

    snprintf(hex, sizeof hex, "%08x", (unsigned)part->crc);
    json_t *json = json_pack("{s:s, s:s, s:s, s:i, s:i, s:s}", "name", part->name, "letters", part->letters, "type",
                             part->type == RETEX_HALF ? "half" : "float", "width", image->width, "height",
                             image->height, "crc32", hex);
    if (bands)
        retex_json_put(&json, "bands", write_bands(bands, image->height));
    return json;
}

static json_t *write_further(const RetexSet *set, int *finite)
{
    const float *ratio = set->further_ratio;

    return json_pack("{s:i, s:[o, o, o]}", "hits", set->further_hits, "ratio", real((double)ratio[0], finite),
                     real((double)ratio[1], finite), real((double)ratio[2], finite));
}

static json_t *identity(uint32_t id)
{
    char hex[16];

    snprintf(hex, sizeof hex, "%08x", (unsigned)id);
    return json_string(hex);
}

static void write_set(json_t **root, const RetexSet *set, const RetexBandSums *sums, int *finite)
{
    json_t *targets = json_array(), *footprints = json_array(), *terms = json_array(), *parts = json_array();
    json_t *mixtures = json_array(), *parameters = json_array();

    for (int i = 0; i < set->ntargets; i++)
        retex_json_add(&targets, write_target(set, &set->targets[i], finite));
    for (int i = 0; i < set->nfootprints; i++)
        retex_json_add(&footprints, write_footprint(set, &set->footprints[i]));
    for (int i = 0; i < set->nterms; i++)
        retex_json_add(&terms, write_term(set, &set->terms[i], finite));
    for (int i = 0; i < set->nparts; i++)
        retex_json_add(&parts, write_part(&set->parts[i], sums && i < sums->count ? sums->of[i] : NULL));
    for (int i = 0; i < set->nmixtures; i++)
        retex_json_add(&mixtures, write_mixture(set, &set->mixtures[i]));
    for (int i = 0; i < set->nparameters; i++)
        retex_json_add(&parameters, write_parameter(set, &set->parameters[i], finite));
    retex_json_put(root, "layout", text(set->layout));
    retex_json_put(root, "filter", text(set->filter));
    retex_json_put(root, "scene", text(set->scene));
    retex_json_put(root, "generator", text(set->generator));
    retex_json_put(root, "orders", json_integer(set->orders));
    retex_json_put(root, "spp", json_integer(set->spp));
    retex_json_put(root, "max_depth", json_integer(set->max_depth));
    if (set->depth_cut != 0)
        retex_json_put(root, "depth_cut", real(set->depth_cut, finite));
    if (set->exposure != 0)
        retex_json_put(root, "exposure", real(set->exposure, finite));
    retex_json_put(root, "seed", json_integer(set->seed));
    retex_json_put(root, "id", identity(set->id));
    retex_json_put(root, "folded", real(set->folded, finite));
    retex_json_put(root, "folded_white", real(set->folded_white, finite));
    if (set->further_hits)
        retex_json_put(root, "further", write_further(set, finite));
    if (set->unit != 1)
        retex_json_put(root, "unit", real(set->unit, finite));
    retex_json_put(root, "denoised", json_boolean(set->denoised));
    retex_json_put(root, "strict_paper", json_boolean(set->strict_paper));
    retex_json_put(root, "targets", targets);
    retex_json_put(root, "footprints", footprints);
    retex_json_put(root, "mixtures", mixtures);
    retex_json_put(root, "parameters", parameters);
    retex_json_put(root, "terms", terms);
    retex_json_put(root, "parts", parts);
    if (set->is_samples && set->refers.path[0])
        retex_json_put(root, "set",
                       json_pack("{s:o, s:I, s:o}", "path", text(set->refers.path), "bytes",
                                 (json_int_t)set->refers.bytes, "crc32", identity(set->refers.crc)));
}

int retex_manifest_write(const RetexSet *set, const RetexBandSums *sums, char **json, RetexError *err)
{
    int finite = 1;
    json_t *root = json_pack("{s:i, s:s, s:s, s:i, s:i}", "retex", RETEX_FORMAT_VERSION, "crc32", "00000000", "kind",
                             set->is_samples ? "samples" : "set", "width", set->width, "height", set->height);

    *json = NULL;
    if (root)
        write_set(&root, set, sums, &finite);
    const size_t style = JSON_COMPACT | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(17);
    char *dumped = root && finite ? retex_json_text(root, style) : NULL;
    json_decref(root);
    if (!finite)
        return retex_fail(err, RETEX_EINVAL, "the set's description has a number that is infinite or NaN");
    if (!dumped)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the manifest");
    retex_manifest_seal(dumped);
    *json = dumped;
    return 0;
}

int retex_set_manifest(const RetexSet *set, char **json, RetexError *err)
{
    return retex_manifest_write(set, NULL, json, err);
}
