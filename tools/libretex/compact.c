/* Compacting a set: see compact.h. The set is sorted by whose light is where (compact_light.h); each kind's footprints
 * are made anew at a scale of theirs (compact_clusters.h), and its terms become gains of one radiance
 * (compact_gains.h). Here the new set is put together. */
#include <retex/compact.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compact_clusters.h"
#include "compact_gains.h"
#include "set_parts.h"

typedef struct Compaction {
    const CompactLight *light;
    RetexSet *set; /* the new one */
    RetexCompactParams params;
    int nthreads;
    int places[3 * RETEX_MAX_TARGETS]; /* of each kind, the factor that stands for it */
    int mixtures[RETEX_MIXTURES_MAX];  /* of the old ones of later footprints, the new factor */
    int footprints[3 * RETEX_MAX_TARGETS][RETEX_SHARES_MAX], weights[3 * RETEX_MAX_TARGETS][RETEX_SHARES_MAX];
    int counts[3 * RETEX_MAX_TARGETS]; /* of each kind's new footprints and their weights */
} Compaction;

static const char *const kind_names[] = {"hit", "sharp", "broad", "later"};

/* ---- what stays as it is ---- */

static int copy_part(RetexSet *set, const RetexPart *part, int *index, RetexError *err)
{
    if (part->spooled || !part->image.pixels)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", part->name);
    int code = retex_set_add_part(set, part->name, part->letters, part->type, part->image.width, part->image.height,
                                  index, err);
    if (!code)
        memcpy(set->parts[*index].image.pixels, part->image.pixels,
               (size_t)part->image.width * (size_t)part->image.height * (size_t)part->image.channels * sizeof(float));
    return code;
}

/* All that a set says of itself, and no parts. */
static int copy_head(RetexSet **copy, const RetexSet *set, RetexError *err)
{
    int code = retex_set_create(copy, set->width, set->height, err);
    if (code)
        return code;
    RetexSet empty = *set;
    empty.nparts = empty.nfootprints = empty.nterms = empty.nmixtures = 0;
    empty.parts = NULL, empty.footprints = NULL, empty.terms = NULL, empty.spool = NULL;
    **copy = empty;
    return code;
}

/* Parts that neither terms nor footprints nor mixtures use stay; so do those of terms without factors. */
static int is_kept(const RetexSet *set, int part)
{
    if (part_is_denoise_data(set, part))
        return 0;
    if (!part_is_used(set, part))
        return 1;
    for (int i = 0; i < set->nterms; i++)
        if (set->terms[i].radiance == part && !set->terms[i].nfactors)
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
        code = copy_part(set, &old->parts[i], &index, err);
        for (int t = 0; t < old->ntargets; t++)
            if (old->targets[t].original == i)
                set->targets[t].original = index;
        for (int k = 0; k < old->nterms && !code; k++) {
            RetexTerm term = old->terms[k];
            if (term.nfactors || term.radiance != i)
                continue;
            term.radiance = index;
            code = retex_set_add_term(set, &term, NULL, err);
        }
    }
    return code;
}

/* Everything but what only denoising reads. */
static int copy_set(RetexSet **result, const RetexSet *set, RetexError *err)
{
    SetView view;
    char *kept = malloc((size_t)set->nparts + 1);
    if (!kept)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a set");
    for (int i = 0; i < set->nparts; i++)
        kept[i] = !part_is_denoise_data(set, i);
    int code = set_view_make(&view, set, kept, err);
    free(kept);
    if (code)
        return code;
    code = copy_head(result, &view.set, err);
    for (int i = 0; i < view.set.nparts && !code; i++) {
        int index;
        code = copy_part(*result, &view.set.parts[i], &index, err);
    }
    for (int i = 0; i < view.set.nfootprints && !code; i++)
        code = retex_set_add_footprint(*result, &view.set.footprints[i], NULL, err);
    for (int i = 0; i < view.set.nmixtures && !code; i++)
        code = retex_set_add_mixture(*result, &view.set.mixtures[i], NULL, err);
    for (int i = 0; i < view.set.nterms && !code; i++)
        code = retex_set_add_term(*result, &view.set.terms[i], NULL, err);
    set_view_free(&view);
    return code;
}

/* ---- what is made anew ---- */

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

/* One cluster as a footprint, which refers to the albedo that all of its kind have. */
static int add_cluster(Compaction *work, int number, CompactClusters *clusters, int k, int albedo, RetexError *err)
{
    const CompactKind *kind = &work->light->kinds[number];
    const char *target = work->set->targets[kind->target].name, *name = kind_names[kind->kind];
    RetexFootprint f = {.target = kind->target, .kind = kind->kind, .albedo = albedo};
    f.hit = work->light->set->footprints[kind->footprints[k]].hit;
    int code = move_image(work->set, &clusters->uv[k], "RGA", RETEX_FLOAT, &f.uv, err, "uv_%s_%s%d", target, name, k + 1);
    if (!code)
        code = move_image(work->set, &clusters->spread[k], "RGB", RETEX_HALF, &f.spread, err, "spread_%s_%s%d", target,
                          name, k + 1);
    if (!code && (clusters->count > 1 || kind->kind == RETEX_FOOTPRINT_LATER))
        code = move_image(work->set, &clusters->weight[k], "R", RETEX_HALF, &work->weights[number][k], err,
                          "weight_%s_%s%d", target, name, k + 1);
    return code ? code : retex_set_add_footprint(work->set, &f, &work->footprints[number][k], err);
}

static int add_mixture(Compaction *work, int number, RetexError *err)
{
    RetexMixture mixture = {.nshares = work->counts[number]};
    int index = 0;
    for (int k = 0; k < mixture.nshares; k++)
        mixture.shares[k] = (struct RetexShare){work->footprints[number][k], work->weights[number][k]};
    work->places[number] = mixture.shares[0].footprint;
    if (mixture.nshares == 1)
        return RETEX_OK;
    int code = retex_set_add_mixture(work->set, &mixture, &index, err);
    work->places[number] = RETEX_MIXTURE(index);
    return code;
}

static int add_clusters(Compaction *work, int number, RetexError *err)
{
    const CompactKind *kind = &work->light->kinds[number];
    const int scale = kind->kind == RETEX_FOOTPRINT_SHARP   ? 1
                      : kind->kind == RETEX_FOOTPRINT_BROAD ? work->params.broad
                                                            : work->params.later;
    CompactClusters clusters;
    int albedo, code = compact_clusters_make(&clusters, work->light, kind, scale, work->nthreads, err);
    if (code)
        return code;
    work->counts[number] = clusters.count;
    code = move_image(work->set, &clusters.albedo, "RGB", RETEX_HALF, &albedo, err, "albedo_%s_%s",
                      work->set->targets[kind->target].name, kind_names[kind->kind]);
    for (int k = 0; k < clusters.count && !code; k++)
        code = add_cluster(work, number, &clusters, k, albedo, err);
    compact_clusters_free(&clusters);
    return code ? code : add_mixture(work, number, err);
}

/* ---- terms ---- */

static int find_kind(const CompactLight *light, int target, RetexFootprintKind kind)
{
    for (int i = 0; i < light->nkinds; i++)
        if (light->kinds[i].target == target && light->kinds[i].kind == kind)
            return i;
    return -1;
}

/* Mixtures of later footprints: of one target, or of several. */
static int add_later_mixtures(Compaction *work, RetexError *err)
{
    const RetexSet *old = work->light->set;
    int code = RETEX_OK;
    for (int m = 0; m < old->nmixtures && !code; m++) {
        RetexMixture mixture = {0};
        int index = 0, targets[RETEX_MAX_TARGETS] = {0}, count = 0, one = 0;
        if (old->footprints[old->mixtures[m].shares[0].footprint].kind != RETEX_FOOTPRINT_LATER)
            continue;
        for (int k = 0; k < old->mixtures[m].nshares; k++)
            targets[old->footprints[old->mixtures[m].shares[k].footprint].target] = 1;
        for (int t = 0; t < old->ntargets; t++) {
            if (!targets[t])
                continue;
            one = find_kind(work->light, t, RETEX_FOOTPRINT_LATER);
            count++;
            for (int k = 0; k < work->counts[one]; k++)
                mixture.shares[mixture.nshares++] =
                    (struct RetexShare){work->footprints[one][k], work->weights[one][k]};
        }
        work->mixtures[m] = work->places[one];
        if (count == 1)
            continue;
        code = retex_set_add_mixture(work->set, &mixture, &index, err);
        work->mixtures[m] = RETEX_MIXTURE(index);
    }
    return code;
}

static int later_factor(const Compaction *work, int factor)
{
    const RetexSet *old = work->light->set;
    return factor < 0 ? work->mixtures[RETEX_MIXTURE(factor)]
                      : work->places[find_kind(work->light, old->footprints[factor].target, RETEX_FOOTPRINT_LATER)];
}

/* The gain's name is that of the radiance it replaces. */
static int add_gain(Compaction *work, const CompactKind *kind, int radiance, int old, RetexTerm *term, RetexError *err)
{
    const char *target = work->set->targets[kind->target].name, *name = kind_names[kind->kind];
    const RetexSet *set = work->light->set;
    RetexImage gain = {0};
    char whole[RETEX_NAME_MAX];
    snprintf(whole, sizeof whole, "dep_%s_%s_", target, name);
    int code = compact_make_gain(&gain, work->light, kind, &work->set->parts[radiance].image, old, work->params.gain,
                                 work->nthreads, err);
    if (code)
        return code;
    if (old < 0) {
        code = move_image(work->set, &gain, "RGB", RETEX_HALF, &term->gain, err, "gain_%s_%s", target, name);
    } else {
        const char *part = set->parts[set->terms[old].radiance].name;
        const size_t common = strncmp(part, whole, strlen(whole)) == 0 ? strlen(whole) : 0;
        code = move_image(work->set, &gain, "RGB", RETEX_HALF, &term->gain, err, "gain_%s_%s_%s", target, name,
                          part + common);
    }
    retex_image_free(&gain);
    return code;
}

static int add_term(Compaction *work, int number, int radiance, int old, int with_gain, RetexError *err)
{
    const CompactKind *kind = &work->light->kinds[number];
    RetexTerm term = {.kind = RETEX_TERM_DEP, .nfactors = 1};
    if (old >= 0)
        term = work->light->set->terms[old];
    term.radiance = radiance;
    term.factors[0] = work->places[number];
    for (int k = 1; k < term.nfactors; k++)
        term.factors[k] = later_factor(work, term.factors[k]);
    int code = with_gain ? add_gain(work, kind, radiance, old, &term, err) : RETEX_OK;
    return code ? code : retex_set_add_term(work->set, &term, NULL, err);
}

static int add_terms(Compaction *work, int number, RetexError *err)
{
    const CompactKind *kind = &work->light->kinds[number];
    RetexImage sum = {0};
    int radiance, owns = 0;
    for (int k = 0; k < kind->count; k++)
        owns += kind->own[k] >= 0;
    if (!owns && !kind->nagain)
        return RETEX_OK;
    int code = compact_sum_light(&sum, work->light, kind, work->nthreads, err);
    if (!code)
        code = move_image(work->set, &sum, "RGB", RETEX_HALF, &radiance, err, "dep_%s_%s",
                          work->set->targets[kind->target].name, kind_names[kind->kind]);
    if (!code && owns)
        code = add_term(work, number, radiance, -1, kind->nagain > 0, err);
    for (int i = 0; i < kind->nagain && !code; i++)
        code = add_term(work, number, radiance, kind->again[i], 1, err);
    retex_image_free(&sum);
    return code;
}

/* ---- all of it ---- */

static int build(RetexSet **result, const CompactLight *light, const RetexCompactParams *params, int nthreads,
                 RetexError *err)
{
    Compaction work = {.light = light, .params = *params, .nthreads = nthreads};
    int code = copy_head(&work.set, light->set, err);
    if (!code)
        code = copy_kept(&work, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        code = add_clusters(&work, i, err);
    if (!code)
        code = add_later_mixtures(&work, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        if (light->kinds[i].kind != RETEX_FOOTPRINT_LATER)
            code = add_terms(&work, i, err);
    *result = work.set;
    return code;
}

static int check_scale(int scale, const char *name, RetexError *err)
{
    if (scale == 0 || scale == 1 || scale == 2 || scale == 4 || scale == 8)
        return RETEX_OK;
    return retex_fail(err, RETEX_EINVAL, "the scale of %s is 1, 2, 4 or 8, not %d", name, scale);
}

static int check_params(const RetexCompactParams *params, RetexError *err)
{
    int code = check_scale(params->broad, "broad footprints", err);
    if (!code)
        code = check_scale(params->later, "later footprints", err);
    if (!code)
        code = check_scale(params->gain, "gains", err);
    if (!code && !(params->psnr >= 20 && params->psnr <= 120))
        code = retex_fail(err, RETEX_EINVAL, "a compact set keeps 20 to 120 dB, not %g", params->psnr);
    return code;
}

int retex_set_compact(RetexSet **compact, const RetexSet *set, const RetexCompactParams *params, int nthreads,
                      RetexError *err)
{
    static const RetexCompactParams defaults = RETEX_COMPACT_INIT;
    RetexCompactParams chosen = params ? *params : defaults;
    CompactLight light = {0};
    int understood = 0;
    *compact = NULL;
    int code = check_params(&chosen, err);
    if (!code && strcmp(set->layout, "footprints") == 0)
        code = compact_light_open(&light, set, &understood, err);
    if (!code && understood) {
        chosen.broad = chosen.broad ? chosen.broad : 4;
        chosen.later = chosen.later ? chosen.later : 8;
        chosen.gain = chosen.gain ? chosen.gain : 2;
        code = build(compact, &light, &chosen, nthreads, err);
    } else if (!code) {
        code = copy_set(compact, set, err);
    }
    compact_light_close(&light);
    if (code)
        retex_set_close(compact);
    return code;
}
