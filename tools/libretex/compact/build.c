/* Builds a compact set from kept parts, new footprints and new terms. See build.h. */
#include "compact/build.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/set_build.h>
#include <retex/target_name.h>

#include "compact/strips.h"
#include "compact/clusters.h"
#include "compact/gains.h"
#include "set/strip.h"
#include "set/parts.h"
#include "set/signals.h"

/* What is made of a kind strip by strip, before it becomes parts. */
typedef struct Made {
    RetexCompactClusters clusters;
    RetexImage *sums, *gains; /* of light by lamps; by place (gains.h). Unallocated: there is none */
} Made;

typedef struct Compaction {
    const RetexCompactLight *light;
    RetexSet *set; /* the new set */
    const RetexCompactScales *scales;
    int nthreads;
    Made *made; /* by kind */
    RetexFactor factors[RETEX_COMPACT_KINDS],
        interreflected[RETEX_COMPACT_KINDS];  /* by kind: factors of single-hit and of interreflected light */
    RetexFactor mixtures[RETEX_MIXTURES_MAX]; /* by mixture of interreflections in the old set: the new factor */
    int footprints[RETEX_COMPACT_KINDS][RETEX_SHARES_MAX];
    int weights[RETEX_COMPACT_KINDS][RETEX_SHARES_MAX],
        shares[RETEX_COMPACT_KINDS][RETEX_SHARES_MAX]; /* parts of weights */
    int counts[RETEX_COMPACT_KINDS];                   /* by kind: number of new footprints */
} Compaction;

/* ---- parts that are copied ---- */

int retex_compact_copy_part(RetexSet *set, const RetexSet *from, int number, int *index, RetexError *err)
{
    const RetexPart *part = &from->parts[number];
    int code = retex_set_add_part(set, part->name, part->letters, part->type, part->image.width, part->image.height,
                                  index, err);
    return code ? code : retex_set_part_rows(&set->parts[*index].image, from, number, 0, err);
}

int retex_compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err)
{
    int code = retex_set_create(copy, set->width, set->height, err);
    if (code)
        return code;
    RetexSet empty = *set;
    empty.nparts = empty.nfootprints = empty.nterms = empty.nmixtures = 0;
    empty.parts = NULL, empty.footprints = NULL, empty.terms = NULL;
    **copy = empty;
    return code;
}

int retex_compact_copy_terms(RetexSet *copy, const RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < set->nfootprints && !code; i++)
        code = retex_set_add_footprint(copy, &set->footprints[i], NULL, err);
    for (int i = 0; i < set->nmixtures && !code; i++)
        code = retex_set_add_mixture(copy, &set->mixtures[i], NULL, err);
    for (int i = 0; i < set->nterms && !code; i++) {
        RetexTerm term = set->terms[i];
        term.noise_weight = 0; /* noise is not copied */
        if (!retex_term_is_picture(&set->terms[i]))
            code = retex_set_add_term(copy, &term, NULL, err);
    }
    return code;
}

/* Whether a term is copied as it is: light without hits. */
static int is_copied(const RetexTerm *term)
{
    return retex_term_is_light(term) && !retex_term_hits(term);
}

/* Whether a part is copied: the picture, originals, radiance of terms without hits, and parts that nothing refers to.
 * Denoising data is not copied. */
static int is_kept(const RetexSet *set, int part)
{
    if (retex_part_is_denoise_data(set, part))
        return 0;
    if (!retex_part_is_used(set, part))
        return 1;
    for (int i = 0; i < set->nterms; i++)
        if (set->terms[i].radiance == part && is_copied(&set->terms[i]))
            return 1;
    for (int t = 0; t < set->ntargets; t++)
        if (set->targets[t].original == part)
            return 1;
    return part == 0;
}

static int copy_kept(const Compaction *work, RetexError *err)
{
    const RetexSet *old = work->light->set;
    RetexSet *set = work->set;
    int code = RETEX_OK;
    for (int i = 0; i < old->nparts && !code; i++) {
        int index = -1;
        if (!is_kept(old, i))
            continue;
        code = retex_compact_copy_part(set, old, i, &index, err);
        for (int t = 0; t < old->ntargets; t++)
            if (old->targets[t].original == i)
                set->targets[t].original = index;
        for (int k = 0; k < old->nterms && !code; k++) {
            RetexTerm term = old->terms[k];
            if (!is_copied(&term) || term.radiance != i)
                continue;
            term.radiance = index;
            code = retex_set_add_term(set, &term, NULL, err);
        }
    }
    return code;
}

/* ---- new parts ---- */

/* Move an image into the set as a part. */
static int move_image(RetexSet *set, RetexImage *image, const char *letters, RetexPixelType type, int *index,
                      RetexError *err, const char *format, ...) RETEX_PRINTF(7, 8);
static int move_image(RetexSet *set, RetexImage *image, const char *letters, RetexPixelType type, int *index,
                      RetexError *err, const char *format, ...)
{
    char name[2 * RETEX_NAME_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    int code = retex_set_add_part(set, name, letters, type, image->width, image->height, index, err);
    if (code)
        return code;
    retex_image_free(&set->parts[*index].image);
    set->parts[*index].image = *image;
    *image = (RetexImage){0};
    return code;
}

/* ---- what is made of a kind ---- */

/* How many terms a kind has at most: see gains.h. */
static int term_count(const Compaction *work, int number)
{
    return work->light->nlamps + work->light->kinds[number].ngains[work->scales->mixed[number]];
}

/* Gains of single lamps have scales of their own. */
static int gain_scale(const Compaction *work, int number, int place)
{
    const RetexCompactLight *light = work->light;
    const int lamps = retex_compact_term_lamps(light, &light->kinds[number], work->scales->mixed[number], place);
    return light->lamps[lamps].alone ? *retex_compact_lamp_scale(work->scales, light, number, place)
                                     : work->scales->gains[number];
}

static void free_made(Made *made, const RetexCompactLight *light, int places)
{
    retex_compact_clusters_free(&made->clusters);
    for (int k = 0; k < light->nlamps && made->sums; k++)
        retex_image_free(&made->sums[k]);
    for (int k = 0; k < places && made->gains; k++)
        retex_image_free(&made->gains[k]);
    free(made->sums);
    free(made->gains);
}

/* ---- footprints ---- */

/* Add a cluster as a footprint. All footprints of a kind share one part of albedo. */
static int add_cluster(Compaction *work, int number, RetexCompactClusters *clusters, int k, int albedo, RetexError *err)
{
    const RetexCompactKind *kind = &work->light->kinds[number];
    const int is_whole = k == clusters->whole;
    char target[RETEX_NAME_MAX], name[RETEX_NAME_MAX] = "whole";
    if (!is_whole)
        snprintf(name, sizeof name, "%s%d", retex_footprint_kind_name(kind->kind), k + 1);
    retex_target_word(target, work->set->targets[kind->target].name);
    RetexFootprint f = {.target = kind->target, .kind = kind->kind, .albedo = albedo};
    f.hit = work->light->set->footprints[kind->footprints[is_whole ? 0 : k]].hit;
    int code = move_image(work->set, &clusters->uv[k], "RGA", RETEX_FLOAT, &f.uv, err, "uv_%s_%s", target, name);
    if (!code)
        code = move_image(work->set, &clusters->spread[k], is_whole ? "RGBA" : "RGB", RETEX_HALF, &f.spread, err,
                          is_whole ? "axes_%s_%s" : "spread_%s_%s", target, name);
    if (!code && (clusters->count > 1 || kind->kind == RETEX_FOOTPRINT_INTERREFLECTION))
        code = move_image(work->set, &clusters->weight[k], "R", RETEX_HALF, &work->weights[number][k], err,
                          "weight_%s_%s", target, name);
    work->shares[number][k] = -1;
    if (!code && clusters->count > 1 && clusters->interreflected[k].pixels)
        code = move_image(work->set, &clusters->interreflected[k], "R", RETEX_HALF, &work->shares[number][k], err,
                          "share_%s_%s", target, name);
    if (!code)
        code = retex_set_add_footprint(work->set, &f, &work->footprints[number][k], err);
    return code;
}

/* Add a mixture of a kind's footprints with these parts of weights. *place: its factor, or the footprint if only
 * one. */
static int add_mixture(Compaction *work, int number, const int *weights, RetexFactor *place, RetexError *err)
{
    RetexMixture mixture = {.nshares = work->counts[number]};
    int index = 0;
    *place = retex_factor(RETEX_FACTOR_FOOTPRINT, work->footprints[number][0]);
    if (mixture.nshares == 1)
        return RETEX_OK;
    for (int k = 0; k < mixture.nshares; k++)
        mixture.shares[k] = (struct RetexShare){work->footprints[number][k], weights[k]};
    int code = retex_set_add_mixture(work->set, &mixture, &index, err);
    *place = retex_factor(RETEX_FACTOR_MIXTURE, index);
    return code;
}

static int add_clusters(Compaction *work, int number, RetexError *err)
{
    const RetexCompactKind *kind = &work->light->kinds[number];
    RetexCompactClusters *clusters = &work->made[number].clusters;
    char target[RETEX_NAME_MAX];
    int albedo;
    work->counts[number] = clusters->count;
    retex_target_word(target, work->set->targets[kind->target].name);
    int code = move_image(work->set, &clusters->albedo, "RGB", RETEX_HALF, &albedo, err, "albedo_%s_%s", target,
                          retex_footprint_kind_name(kind->kind));
    for (int k = 0; k < clusters->count && !code; k++)
        code = add_cluster(work, number, clusters, k, albedo, err);
    if (!code)
        code = add_mixture(work, number, work->weights[number], &work->factors[number], err);
    work->interreflected[number] = work->factors[number];
    if (!code && work->counts[number] > 1 && work->shares[number][0] >= 0)
        code = add_mixture(work, number, work->shares[number], &work->interreflected[number], err);
    return code;
}

/* ---- terms ---- */

static int find_kind(const RetexCompactLight *light, int target, RetexFootprintKind kind)
{
    for (int i = 0; i < light->nkinds; i++)
        if (light->kinds[i].target == target && light->kinds[i].kind == kind)
            return i;
    return -1;
}

/* Add the mixtures of interreflection footprints: of one target, or of several. */
static int add_interreflection_mixtures(Compaction *work, RetexError *err)
{
    const RetexSet *old = work->light->set;
    int code = RETEX_OK;
    for (int m = 0; m < old->nmixtures && !code; m++) {
        RetexMixture mixture = {0};
        int index = 0, targets[RETEX_MAX_TARGETS] = {0}, count = 0, one = 0;
        if (old->footprints[old->mixtures[m].shares[0].footprint].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            continue;
        for (int k = 0; k < old->mixtures[m].nshares; k++)
            targets[old->footprints[old->mixtures[m].shares[k].footprint].target] = 1;
        for (int t = 0; t < old->ntargets; t++) {
            if (!targets[t])
                continue;
            one = find_kind(work->light, t, RETEX_FOOTPRINT_INTERREFLECTION);
            count++;
            for (int k = 0; k < work->counts[one]; k++)
                mixture.shares[mixture.nshares++] =
                    (struct RetexShare){work->footprints[one][k], work->weights[one][k]};
        }
        work->mixtures[m] = work->factors[one];
        if (count == 1)
            continue;
        code = retex_set_add_mixture(work->set, &mixture, &index, err);
        work->mixtures[m] = retex_factor(RETEX_FACTOR_MIXTURE, index);
    }
    return code;
}

/* The new factor of an old one of interreflected light: of its kind's clusters. */
static RetexFactor new_factor(const Compaction *work, RetexFactor factor)
{
    int target;
    RetexFootprintKind kind;
    if (!retex_factor_is_texture(factor))
        return factor;
    retex_factor_target(work->light->set, factor, &target, &kind);
    const int number = find_kind(work->light, target, kind);
    RetexFactor made = kind != RETEX_FOOTPRINT_INTERREFLECTION ? work->interreflected[number]
                       : factor.kind == RETEX_FACTOR_MIXTURE   ? work->mixtures[factor.index]
                                                               : work->factors[number];
    made.quantity = factor.quantity;
    return made;
}

/* Names of parts of lamps end so: _lamp and the numbers of the parameters; of others in nothing. */
static const char *lamps_name(char name[RETEX_NAME_MAX], const RetexCompactLight *light, int lamps)
{
    int length = 0;
    name[0] = '\0';
    for (int k = 0; k < light->lamps[lamps].count; k++)
        length += snprintf(name + length, RETEX_NAME_MAX - (size_t)length, "%s%d", k ? "-" : "_lamp",
                           1 + light->lamps[lamps].factors[k].index);
    return name;
}

/* Make a gain, and a factor of it, of a term that has all others. */
static int add_gain(Compaction *work, int number, int place, RetexTerm *term, RetexError *err)
{
    const RetexCompactKind *kind = &work->light->kinds[number];
    const char *name = retex_footprint_kind_name(kind->kind);
    const RetexCompactMixed mixed = work->scales->mixed[number];
    const int single = place < work->light->nlamps;
    char target[RETEX_NAME_MAX], lamps[RETEX_NAME_MAX];
    retex_target_word(target, work->set->targets[kind->target].name);
    lamps_name(lamps, work->light, retex_compact_term_lamps(work->light, kind, mixed, place));
    int part;
    int code = move_image(work->set, &work->made[number].gains[place], "RGB", RETEX_HALF, &part, err,
                          "gain_%s_%s%s%s%s", target, name, lamps, single ? "" : "_",
                          single ? "" : kind->gains[mixed][place - work->light->nlamps].name);
    return code ? code : retex_term_add_image(term, work->set, part, err);
}

static int add_term(Compaction *work, int number, int radiance, int place, int with_gain, RetexError *err)
{
    const RetexCompactKind *kind = &work->light->kinds[number];
    const int lamps = retex_compact_term_lamps(work->light, kind, work->scales->mixed[number], place);
    RetexTerm term = {.role = work->light->lamps[lamps].alone       ? RETEX_ROLE_LAMP
                              : kind->kind == RETEX_FOOTPRINT_SHARP ? RETEX_ROLE_SHARP
                                                                    : RETEX_ROLE_BROAD,
                      .target = kind->target,
                      .radiance = radiance};
    const int gain = place - work->light->nlamps;
    const RetexTerm *old = gain >= 0 ? &kind->gains[work->scales->mixed[number]][gain].term : NULL;
    int code = old ? RETEX_OK : retex_term_add_factor(&term, work->factors[number], err);
    for (int k = 0; !old && k < work->light->lamps[place].count && !code; k++)
        code = retex_term_add_factor(&term, work->light->lamps[place].factors[k], err);
    for (int k = 0; old && k < old->nfactors && !code; k++)
        code = retex_term_add_factor(&term, new_factor(work, old->factors[k]), err);
    if (!code && with_gain)
        code = add_gain(work, number, place, &term, err);
    return code ? code : retex_set_add_term(work->set, &term, NULL, err);
}

/* Add the terms of a kind's light of some lamps; radiance: the part of their light, or, of a single lamp, of all. */
static int add_terms_of(Compaction *work, int number, int lamps, int radiance, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexCompactKind *kind = &light->kinds[number];
    const int further = retex_compact_has_further(light, kind, lamps), alone = light->lamps[lamps].alone;
    int code = RETEX_OK;
    if (retex_compact_has_single(kind, lamps))
        code = add_term(work, number, radiance, lamps, further || alone, err);
    for (int i = light->nlamps; i < term_count(work, number) && !code; i++)
        if (retex_compact_term_lamps(light, kind, work->scales->mixed[number], i) == lamps)
            code = add_term(work, number, radiance, i, 1, err);
    return code;
}

/* Add a kind's light of some lamps; -1: there is none. */
static int add_radiance(Compaction *work, int number, int lamps, int *radiance, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexCompactKind *kind = &light->kinds[number];
    char target[RETEX_NAME_MAX], name[RETEX_NAME_MAX];
    *radiance = -1;
    if (!retex_compact_has_light(light, kind, lamps))
        return RETEX_OK;
    retex_target_word(target, work->set->targets[kind->target].name);
    return move_image(work->set, &work->made[number].sums[lamps], "RGB", RETEX_HALF, radiance, err, "dep_%s_%s%s",
                      target, retex_footprint_kind_name(kind->kind), lamps_name(name, light, lamps));
}

static int add_terms(Compaction *work, int number, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    int code = RETEX_OK, all = -1;
    for (int i = 0; i < light->nlamps && !code; i++) {
        int radiance = -1;
        if (!light->lamps[i].alone)
            code = add_radiance(work, number, i, &radiance, err);
        all = i == light->all ? radiance : all;
        if (!code && radiance >= 0)
            code = add_terms_of(work, number, i, radiance, err);
    }
    for (int i = 0; i < light->nlamps && !code && all >= 0; i++)
        if (light->lamps[i].alone)
            code = add_terms_of(work, number, i, all, err);
    return code;
}

/* Make a term's share of all light that meets no target, and a factor of it. */
static int add_share(Compaction *work, int all, RetexTerm *term, RetexError *err)
{
    const RetexSet *old = work->light->set;
    RetexImage own = {0}, share = {0};
    const int lamp = retex_set_term_lamp(old, term);
    int part, code = retex_image_alloc(&own, old->width, old->height, 3, err);
    if (!code)
        code = retex_set_part_rows(&own, old, term->radiance, 0, err);
    term->radiance = work->set->terms[all].radiance;
    if (!code)
        code = retex_compact_share(&share, &own, &work->set->parts[term->radiance].image,
                                   *retex_compact_share_scale(work->scales, work->light, lamp), work->nthreads, err);
    if (!code)
        code = move_image(work->set, &share, "RGB", RETEX_HALF, &part, err, "gain_lamp%d", 1 + lamp);
    retex_image_free(&own);
    retex_image_free(&share);
    return code ? code : retex_term_add_image(term, work->set, part, err);
}

/* Add light of single lamps that meets no target. */
static int add_lamp_shares(Compaction *work, RetexError *err)
{
    const RetexSet *old = work->light->set;
    const int all = retex_compact_light_without_hits(work->set);
    int code = RETEX_OK;
    for (int t = 0; t < old->nterms && !code; t++) {
        if (!retex_compact_is_lamp_share(&old->terms[t]))
            continue;
        RetexTerm term = old->terms[t];
        code = all >= 0 ? add_share(work, all, &term, err)
                        : retex_compact_copy_part(work->set, old, term.radiance, &term.radiance, err);
        if (!code)
            code = retex_set_add_term(work->set, &term, NULL, err);
    }
    return code;
}

/* Copy a correction, with the new footprints of the same kinds. */
static int copy_correction(Compaction *work, const RetexTerm *old, RetexError *err)
{
    RetexTerm term = *old;
    int code = retex_compact_copy_part(work->set, work->light->set, old->radiance, &term.radiance, err);
    for (int k = 0; k < old->nfactors; k++)
        term.factors[k] = new_factor(work, old->factors[k]);
    return code ? code : retex_set_add_term(work->set, &term, NULL, err);
}

static int copy_corrections(Compaction *work, RetexError *err)
{
    const RetexSet *old = work->light->set;
    int code = RETEX_OK;
    for (int t = 0; t < old->nterms && !code; t++)
        if (old->terms[t].role == RETEX_ROLE_CORRECTION)
            code = copy_correction(work, &old->terms[t], err);
    return code;
}

/* ---- the whole set ---- */

/* Allocate the clusters and gains of a kind. */
static int begin_kind(Compaction *work, int number, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexCompactKind *kind = &light->kinds[number];
    Made *made = &work->made[number];
    made->sums = calloc((size_t)light->nlamps + 1, sizeof *made->sums);
    made->gains = calloc((size_t)term_count(work, number) + 1, sizeof *made->gains);
    if (!made->sums || !made->gains)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for light");
    int code = retex_compact_clusters_begin(&made->clusters, light, kind, work->scales->clusters[number], err);
    for (int i = 0; i < term_count(work, number) && !code && kind->kind != RETEX_FOOTPRINT_INTERREFLECTION; i++) {
        const int lamps = retex_compact_term_lamps(light, kind, work->scales->mixed[number], i);
        const int alone = light->lamps[lamps].alone;
        const int has_gain =
            alone ? retex_compact_has_light(light, kind, light->all) : retex_compact_has_further(light, kind, lamps);
        if (i == lamps && !alone && retex_compact_has_light(light, kind, lamps))
            code = retex_image_alloc(&made->sums[i], light->set->width, light->set->height, 3, err);
        if (!code && has_gain && (i != lamps || retex_compact_has_single(kind, lamps)))
            code = retex_compact_gain_begin(&made->gains[i], light, gain_scale(work, number, i), err);
    }
    return code;
}

static int make_rows(void *context, const RetexCompactLight *light, int first, RetexError *err)
{
    Compaction *work = context;
    int code = RETEX_OK;
    for (int i = 0; i < light->nkinds && !code; i++) {
        const RetexCompactKind *kind = &light->kinds[i];
        const RetexCompactMixed mixed = work->scales->mixed[i];
        RetexImage *sums = work->made[i].sums, *gains = work->made[i].gains;
        retex_compact_clusters_rows(&work->made[i].clusters, light, kind, first, work->nthreads);
        for (int k = 0; k < light->nlamps; k++)
            if (sums[k].pixels)
                retex_compact_sum_rows(&sums[k], light, kind, k, first, work->nthreads);
        for (int k = 0; k < term_count(work, i) && !code; k++) {
            const int lamps = retex_compact_term_lamps(light, kind, mixed, k);
            const RetexImage *sum = &sums[light->lamps[lamps].alone ? light->all : lamps];
            if (gains[k].pixels)
                code = retex_compact_gain_rows(&gains[k], light, kind, sum, k, mixed, gain_scale(work, i, k), first,
                                               work->nthreads, err);
        }
    }
    return code;
}

static int end_kind(Compaction *work, int number, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexCompactKind *kind = &light->kinds[number];
    const RetexCompactMixed mixed = work->scales->mixed[number];
    const RetexImage *sums = work->made[number].sums;
    RetexImage *gains = work->made[number].gains;
    int code = retex_compact_clusters_end(&work->made[number].clusters, work->light, kind, work->nthreads, err);
    for (int k = 0; k < term_count(work, number) && !code; k++)
        if (gains[k].pixels) {
            const int lamps = retex_compact_term_lamps(light, kind, mixed, k);
            code = retex_compact_gain_end(&gains[k], &sums[light->lamps[lamps].alone ? light->all : lamps],
                                          gain_scale(work, number, k), err);
        }
    return code;
}

/* Make the clusters and gains of all kinds, strip by strip, because the set may be larger than memory. */
static int make_kinds(Compaction *work, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    int code = RETEX_OK;
    for (int i = 0; i < light->nkinds && !code; i++)
        code = begin_kind(work, i, err);
    if (!code)
        code = retex_compact_strips(light, make_rows, work, work->nthreads, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        code = end_kind(work, i, err);
    return code;
}

int retex_compact_build(RetexSet **result, const RetexCompactLight *light, const RetexCompactScales *scales,
                        int nthreads, RetexError *err)
{
    Compaction work = {.light = light, .scales = scales, .nthreads = nthreads};
    work.made = calloc((size_t)light->nkinds + 1, sizeof *work.made);
    int code = work.made ? make_kinds(&work, err) : retex_fail(err, RETEX_ENOMEM, "not enough memory for a set");
    if (!code)
        code = retex_compact_copy_head(&work.set, light->set, err);
    if (!code)
        code = copy_kept(&work, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        code = add_clusters(&work, i, err);
    if (!code)
        code = add_interreflection_mixtures(&work, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        if (light->kinds[i].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            code = add_terms(&work, i, err);
    if (!code)
        code = add_lamp_shares(&work, err);
    if (!code)
        code = copy_corrections(&work, err);
    for (int i = 0; i < light->nkinds && work.made; i++)
        free_made(&work.made[i], light, term_count(&work, i));
    free(work.made);
    if (code)
        retex_set_close(&work.set);
    *result = work.set;
    return code;
}
