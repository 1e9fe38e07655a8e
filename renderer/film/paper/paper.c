/* Layout `paper`; see paper.h. Terms come into being when a path first needs them; with one target all 21 exist from
 * the start, which with the 12 UV images make the paper's 33. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/set_build.h>
#include <retex/target_name.h>
#include "film/corrections.h"
#include "film/noise.h"
#include "film/paper/expansion.h"
#include "film/paper/paper.h"
#include "film/paper/terms.h"

typedef struct FootprintSums {
    int samples;                  /* paths with a contribution */
    double count, mean[2], m2[2]; /* Welford's running mean and sum of squared deviations of u and v */
    Float4 light, light_albedo;   /* what the albedo there multiplied, without it and with it */
    Float4 albedo;                /* unweighted, for footprints that gave no light */
} FootprintSums;

/* Light, or images, of a target's corrections, by the number of its hits. */
typedef struct CorrectionImages {
    int of[CORRECTION_POWERS + 1];
} CorrectionImages;

typedef struct PaperFilm {
    const Scene *scene;
    FilmParams params;
    Bands *bands; /* borrowed */
    TermTable terms;
    /* images of the bands */
    int uv[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS], spread[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS],
        albedo[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS];
    CorrectionImages corrections[RETEX_MAX_TARGETS];
    atomic_int lost; /* light was lost, as there were too many terms */
} PaperFilm;

typedef struct PaperPixel {
    PaperFilm *film;
    TermCache cache;
    Float4 *sums; /* by term */
    int *touched, ntouched;
    FootprintSums footprints[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS];
    Float4 corrections[RETEX_MAX_TARGETS][CORRECTION_POWERS + 1]; /* by target, and number of hits on it */
    /* of the current path: */
    Expansion expansion;
    ExpansionMark mark;                  /* of it before a hit that light came by */
    TargetVertex hits[TARGET_NODES_MAX]; /* all hits that connected, with how often */
    int connections[TARGET_NODES_MAX], nhits;
    UvRange *range; /* of the hits */
} PaperPixel;

static int footprints_count(const PaperFilm *film)
{
    return film->scene->ntargets * RETEX_MAX_ORDERS;
}
static int footprint_number(const TargetVertex *hit)
{
    return hit->target * RETEX_MAX_ORDERS + hit->index;
}

static int add_footprint(PaperFilm *film, int k, RetexError *err)
{
    int hit = k % RETEX_MAX_ORDERS + 1;
    char name[RETEX_NAME_MAX], target[RETEX_NAME_MAX];
    retex_target_word(target, film->scene->targets[k / RETEX_MAX_ORDERS].name);
    snprintf(name, sizeof name, "uv_%.90s_%d", target, hit);
    int code = bands_add(film->bands, name, "RGA", RETEX_FLOAT, &film->uv[k], err);
    snprintf(name, sizeof name, "spread_%.90s_%d", target, hit);
    if (!code)
        code = bands_add(film->bands, name, "RG", RETEX_HALF, &film->spread[k], err);
    snprintf(name, sizeof name, "albedo_%.90s_%d", target, hit);
    return code ? code : bands_add(film->bands, name, "RGB", RETEX_HALF, &film->albedo[k], err);
}

/* Sets of the supplement's own form have none. */
static int corrected(const PaperFilm *film)
{
    return film->params.strict_paper ? 0 : corrected_targets(film->scene);
}

static int last_correction(const PaperFilm *film)
{
    return correction_power(film->params.orders);
}

/* correction_Floor_2: with two hits on the target. */
static int add_corrections(PaperFilm *film, RetexError *err)
{
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX];
    int code = RETEX_OK;
    for (int t = 0; t < corrected(film); t++)
        for (int n = 0; n <= last_correction(film) && !code; n++) {
            retex_target_word(word, film->scene->targets[t].name);
            snprintf(name, sizeof name, "correction_%.90s_%d", word, n);
            code = bands_add(film->bands, name, "RGB", RETEX_HALF, &film->corrections[t].of[n], err);
        }
    return code;
}

static int paper_alloc(PaperFilm *film, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < footprints_count(film) && !code; k++)
        if (k % RETEX_MAX_ORDERS < film->params.orders)
            code = add_footprint(film, k, err);
    if (!code)
        code = add_corrections(film, err);
    return code ? code : terms_create(&film->terms, film->bands, film->scene->ntargets, film->params.orders, err);
}

static int create_film(void **out, const Scene *scene, const FilmParams *params, Bands *bands, RetexError *err)
{
    PaperFilm *film = *out = calloc(1, sizeof *film);
    if (!film)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    film->bands = bands;
    return paper_alloc(film, err);
}

static void close_film(void **layout)
{
    PaperFilm *film = *layout;
    if (!film)
        return;
    terms_close(&film->terms);
    free(film);
    *layout = NULL;
}

static int resume_image(void *layout, const char *name, RetexError *err)
{
    PaperFilm *film = layout;
    return terms_resume(&film->terms, name, err);
}

static void close_pixel(void **pixel)
{
    PaperPixel *p = *pixel;
    if (!p)
        return;
    free(p->sums);
    free(p->touched);
    free(p);
    *pixel = NULL;
}

static int create_pixel(void **out, void *layout, LightSums *light, UvRange *range, RetexError *err)
{
    PaperPixel *p = *out = calloc(1, sizeof *p);
    (void)light;
    if (p) {
        p->film = layout;
        p->range = range;
        p->sums = calloc(TERMS_MAX, sizeof *p->sums);
        p->touched = calloc(TERMS_MAX, sizeof *p->touched);
    }
    if (p && p->sums && p->touched)
        return RETEX_OK;
    close_pixel(out);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
}

static void add_term(PaperPixel *p, TermKey key, Float4 value)
{
    int term = terms_find(&p->film->terms, &p->cache, key);
    if (term < 0) { /* too many: finish_film reports it */
        p->film->lost = 1;
        return;
    }
    if (is_black4(p->sums[term]))
        p->touched[p->ntouched++] = term;
    p->sums[term] += value;
}

/* The original albedo of each hit of a monomial, weighted by the light it multiplied: so a term of one factor keeps its
 * original to the bit that arithmetic allows, whatever the texture does inside the pixel. */
static void add_albedos(PaperPixel *p, const Expansion *e, unsigned hits, Float4 value)
{
    for (unsigned left = hits; left; left &= left - 1) {
        const TargetVertex *hit = &e->hits[__builtin_ctz(left)];
        Float4 light = value;
        for (unsigned others = hits & ~(left & -left); others; others &= others - 1)
            light *= color4(e->hits[__builtin_ctz(others)].albedo);
        FootprintSums *f = &p->footprints[footprint_number(hit)];
        f->light += light;
        f->light_albedo += light * color4(hit->albedo);
    }
}

/* Add a monomial to the light of edited targets, with the original albedos of all other hits. */
static void add_to_corrections(PaperPixel *p, const Expansion *e, unsigned hits, Float4 value)
{
    for (int t = 0; t < corrected(p->film); t++) {
        Float4 light = value;
        int on = 0, others = 0;
        for (unsigned left = hits; left; left &= left - 1) {
            const TargetVertex *hit = &e->hits[__builtin_ctz(left)];
            if (hit->target == t)
                on++;
            else
                light *= color4(hit->albedo), others++;
        }
        if (others)
            p->corrections[t][correction_power(on)] += light;
    }
}

/* Count contributions for each hit of the expansion. */
static void add_connections(PaperPixel *p, const Expansion *e, int connections)
{
    for (int j = 0; j < e->size.nhits; j++) {
        const TargetVertex *hit = &e->hits[j];
        int k = p->nhits - 1;
        while (k >= 0 && !(p->hits[k].target == hit->target && p->hits[k].index == hit->index &&
                           p->hits[k].uv.u == hit->uv.u && p->hits[k].uv.v == hit->uv.v))
            k--;
        if (k < 0) {
            k = p->nhits++;
            p->hits[k] = *hit;
            p->connections[k] = 0;
        }
        p->connections[k] += connections;
    }
}

/* A monomial's hits by target. */
static HitMask mask_by_target(const Expansion *e, unsigned hits)
{
    HitMask mask = 0;
    for (; hits; hits &= hits - 1) {
        const TargetVertex *hit = &e->hits[__builtin_ctz(hits)];
        mask |= hit_bit(hit->target, hit->index);
    }
    return mask;
}

/* Add the expansion's monomials to their terms: light of so many contributions. */
static void connect(PaperPixel *p, int connections)
{
    const Expansion *e = &p->expansion;
    for (int k = 0; k < e->size.nmonomials; k++) {
        const Monomial *m = &e->monomials[k];
        if (is_black4(m->coefficient))
            continue;
        TermKey key = term_key(e->size.nhits, mask_by_target(e, m->hits), p->film->params.strict_paper);
        if (key == TERM_DROPPED)
            continue;
        add_term(p, key, m->coefficient);
        if (m->hits)
            add_albedos(p, e, m->hits, m->coefficient), add_to_corrections(p, e, m->hits, m->coefficient);
    }
    add_connections(p, e, connections);
}

/* Make the expansion that of the hits before one. */
static void expand_before(Expansion *e, const TargetNode *hit)
{
    expansion_reset(e);
    if (!hit->before)
        return;
    expand_before(e, hit->before);
    expansion_push(e, &hit->before->at, hit->before_d, hit->before_i);
}

static void add_path(PaperPixel *p, const TargetTree *path)
{
    Expansion *e = &p->expansion;
    const TargetNode *hits[TARGET_NODES_MAX], *previous = NULL;
    for (const TargetNode *hit = path->last; hit; hit = hit->earlier)
        hits[hit->number] = hit;
    if (path->nwithout_hit && !is_black4(path->without_hit))
        add_term(p, term_key(0, 0, 0), path->without_hit);
    expansion_reset(e);
    for (int k = 0; k < path->count; previous = hits[k++]) {
        const TargetNode *hit = hits[k];
        if (hit->before && hit->before == previous)
            expansion_push(e, &previous->at, hit->before_d, hit->before_i);
        else
            expand_before(e, hit);
        if (!hit->connections)
            continue;
        const int is_last = k + 1 == path->count;
        if (!is_last)
            expansion_mark(&p->mark, e);
        expansion_push(e, &hit->at, hit->dependent, hit->independent);
        connect(p, hit->connections);
        if (!is_last)
            expansion_return(e, &p->mark);
    }
}

static void footprint_add(FootprintSums *f, const TargetVertex *hit, int weight)
{
    const double before = f->count, uv[2] = {hit->uv.u, hit->uv.v};
    f->count += weight;
    const double share = weight / f->count;
    for (int k = 0; k < 2; k++) {
        double delta = uv[k] - f->mean[k];
        f->mean[k] += delta * share;
        f->m2[k] += delta * delta * before * share;
    }
    f->albedo += color4(hit->albedo) * splat((float)weight);
}

static void end_path(void *pixel, const TargetTree *path)
{
    PaperPixel *p = pixel;
    HitMask seen = 0;
    add_path(p, path);
    for (int k = 0; k < p->nhits; k++) {
        const TargetVertex *hit = &p->hits[k];
        FootprintSums *f = &p->footprints[footprint_number(hit)];
        HitMask bit = hit_bit(hit->target, hit->index);
        const double uv[2] = {hit->uv.u, hit->uv.v};
        footprint_add(f, hit, p->connections[k]);
        if (!(seen & bit))
            f->samples++;
        seen |= bit;
        uv_range_add(p->range, hit->target, uv);
    }
    p->nhits = 0;
}

static void store_footprint(const PaperFilm *film, int k, const FootprintSums *f, BandRows *rows, int spp, int x, int y)
{
    float *uv = bands_pixel(rows, film->uv[k], x, y);
    float *spread = bands_pixel(rows, film->spread[k], x, y);
    float *albedo = bands_pixel(rows, film->albedo[k], x, y);
    for (int a = 0; a < 2; a++) {
        uv[a] = (float)f->mean[a];
        spread[a] = (float)sqrt(f->m2[a] / f->count);
    }
    uv[2] = (float)f->samples / (float)spp;
    for (int c = 0; c < 3; c++)
        albedo[c] = f->light[c] > 0 ? f->light_albedo[c] / f->light[c] : (float)(f->albedo[c] / f->count);
}

static void sum_signals(const void *pixel, SignalTotals *totals)
{
    const PaperPixel *p = pixel;
    memset(totals->of, 0, sizeof totals->of[0] * (size_t)(1 + p->film->scene->ntargets));
    for (int k = 0; k < p->ntouched; k++) {
        const Float4 sum = p->sums[p->touched[k]];
        const int target = terms_first_target(&p->film->terms, p->touched[k]);
        const double weight = terms_weight(&p->film->terms, p->touched[k], p->film->params.brightness);
        for (int c = 0; c < 3; c++)
            totals->of[1 + target][c] += weight * sum[c];
    }
}

/* The unit of a pixel's corrections. */
static double correction_unit(const PaperPixel *p, int spp)
{
    Float4 white = splat(0);
    for (int k = 0; k < p->ntouched; k++)
        white += p->sums[p->touched[k]];
    const float most = fmaxf(white[0], fmaxf(white[1], white[2])) / (float)spp;
    return retex_coefficient_unit((double)most);
}

/* Subtract a stored term, with the mean albedos of all targets but t. */
static void subtract_term(PaperPixel *p, int term, int t, BandRows *rows, int x, int y)
{
    const PaperFilm *film = p->film;
    const HitMask hits = terms_hits(&film->terms, term);
    const int on = hits_on_target(hits, t);
    int others = 0;
    Float4 light = correction_stored(rows, film->terms.images[term], x, y);
    for (int k = 0; k < footprints_count(film); k++)
        if (k / RETEX_MAX_ORDERS != t && hits & hit_bit(k / RETEX_MAX_ORDERS, k % RETEX_MAX_ORDERS))
            light *= correction_stored(rows, film->albedo[k], x, y), others++;
    if (others)
        p->corrections[t][correction_power(on)] -= light;
}

/* Terms and footprints are stored already. */
static void store_corrections(PaperPixel *p, BandRows *rows, int spp, int x, int y)
{
    const PaperFilm *film = p->film;
    const double unit = correction_unit(p, spp);
    for (int t = 0; t < corrected(film); t++) {
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            p->corrections[t][n] *= splat(1 / (float)spp);
        for (int k = 0; k < p->ntouched; k++)
            subtract_term(p, p->touched[k], t, rows, x, y);
        for (int n = 0; n <= last_correction(film); n++)
            correction_store(rows, film->corrections[t].of[n], p->corrections[t][n], unit, x, y);
    }
    memset(p->corrections, 0, sizeof p->corrections);
}

static void end_pixel(void *context, BandRows *rows, int spp, int x, int y)
{
    PaperPixel *p = context;
    PaperFilm *film = p->film;
    float scale = 1 / (float)spp;
    for (int k = 0; k < p->ntouched; k++) {
        const Float4 sum = p->sums[p->touched[k]];
        float *pixel = bands_pixel(rows, film->terms.images[p->touched[k]], x, y);
        for (int c = 0; c < 3; c++)
            pixel[c] = sum[c] * scale;
    }
    for (int k = 0; k < footprints_count(film); k++)
        if (p->footprints[k].count > 0) {
            store_footprint(film, k, &p->footprints[k], rows, spp, x, y);
            p->footprints[k] = (FootprintSums){0};
        }
    store_corrections(p, rows, spp, x, y);
    for (int k = 0; k < p->ntouched; k++)
        p->sums[p->touched[k]] = splat(0);
    p->ntouched = 0;
}

static void add_band_stats(const void *layout, const BandRows *rows, RetexBandStats *stats)
{
    const PaperFilm *film = layout;
    for (int t = 0; t < film->scene->ntargets; t++)
        for (int k = t * RETEX_MAX_ORDERS; k < t * RETEX_MAX_ORDERS + film->params.orders; k++)
            bands_add_albedo(rows, film->uv[k], film->albedo[k], stats, t);
}

static int finish_footprints(PaperFilm *film, RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < film->scene->ntargets; t++)
        for (int j = 0; j < film->params.orders && !code; j++) {
            int k = t * RETEX_MAX_ORDERS + j;
            RetexFootprint f = {.target = t, .hit = j + 1};
            code = bands_move_part(film->bands, film->uv[k], set, &f.uv, err);
            if (!code)
                code = bands_move_part(film->bands, film->spread[k], set, &f.spread, err);
            if (!code)
                code = bands_move_part(film->bands, film->albedo[k], set, &f.albedo, err);
            if (!code)
                code = retex_set_add_footprint(set, &f, NULL, err);
        }
    return code;
}

/* Each takes the texture at the first hits of its target. */
static int finish_corrections(PaperFilm *film, RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < corrected(film); t++)
        for (int n = 0; n <= last_correction(film) && !code; n++) {
            RetexTerm term = {.role = RETEX_ROLE_CORRECTION, .target = t, .nfactors = n};
            for (int k = 0; k < n; k++)
                term.factors[k] = retex_factor(RETEX_FACTOR_FOOTPRINT, t * film->params.orders + k);
            code = bands_move_part(film->bands, film->corrections[t].of[n], set, &term.radiance, err);
            if (!code)
                code = retex_set_add_correction(set, &term, NULL, err);
        }
    return code;
}

static int finish_film(void *layout, RetexSet *set, RetexError *err)
{
    PaperFilm *film = layout;
    if (film->lost)
        return retex_fail(err, RETEX_ELIMIT, "the set needs more than %d terms, or more memory than there is: %s",
                          TERMS_MAX, "take fewer targets or orders");
    const int noise = noise_count(&film->params, film->scene->ntargets);
    int code = finish_footprints(film, set, err);
    if (!code)
        code = terms_finish(&film->terms, set, noise ? film->params.brightness : NULL, err);
    return code ? code : finish_corrections(film, set, err);
}

/* Footprints, and terms: what each has for every order. */
static long count_floats(const FilmParams *params, int ntargets)
{
    return params->orders * (8 * ntargets + 6);
}

const FilmLayout paper_layout = {.name = "paper",
                                 .nsignals = 1,
                                 .signals = {"hit"},
                                 .most_hits = expansion_most_hits,
                                 .floats = count_floats,
                                 .create = create_film,
                                 .close = close_film,
                                 .resume_image = resume_image,
                                 .pixel_create = create_pixel,
                                 .pixel_close = close_pixel,
                                 .path_end = end_path,
                                 .totals = sum_signals,
                                 .pixel_end = end_pixel,
                                 .band_stats = add_band_stats,
                                 .finish = finish_film};
