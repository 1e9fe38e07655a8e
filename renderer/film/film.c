/* Layout `paper`: per hit count the dependent and independent radiance, cross terms of two and three hits, and per
 * target and hit index the UV statistics, unweighted over all connections (supplement 2, 4.2, 4.3). With several
 * targets the dependent radiance is kept by the number of factors of each target.
 *
 * Terms come into being when a path first needs them; with one target all 21 exist from the start, which with the 12
 * UV images make the paper's 33. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "film/film.h"
#include "film/terms.h"

typedef struct FootprintSums {
    int samples;                     /* paths that brought a connection */
    double count, mean[2], m2[2];    /* Welford's running mean and sum of squared deviations of u and v */
    float light[3], light_albedo[3]; /* what the albedo there multiplied, without it and with it */
    float albedo[3];                 /* unweighted, for footprints that gave no light */
} FootprintSums;

struct Film {
    const Scene *scene;
    FilmParams params;
    TermTable terms;
    RetexImage beauty;
    RetexImage uv[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS], spread[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS],
        albedo[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS];
    double *tile_total, *tile_folded;
    pthread_mutex_t lock;
    double uv_min[RETEX_MAX_TARGETS][2], uv_max[RETEX_MAX_TARGETS][2]; /* under lock */
    long dropped;
    int lost; /* light found no term to go to */
};

struct FilmPixel {
    Film *film;
    TermCache cache;
    float (*sums)[3]; /* by term */
    int nsums;
    int *touched, ntouched;
    double beauty[3];
    FootprintSums footprints[RETEX_MAX_TARGETS * RETEX_MAX_ORDERS];
    /* of the path in hand: every hit that connected, with how often */
    TargetHit hits[64];
    int connections[64], nhits;
    double total, folded; /* luminance of the tile so far */
    double uv_min[RETEX_MAX_TARGETS][2], uv_max[RETEX_MAX_TARGETS][2];
    long dropped;
    int lost; /* light found no term to go to */
};

static int footprints_count(const Film *film)
{
    return film->scene->ntargets * RETEX_MAX_ORDERS;
}
static int footprint_number(const TargetHit *hit)
{
    return hit->target * RETEX_MAX_ORDERS + hit->index;
}

static void uv_range_reset(double low[][2], double high[][2])
{
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++)
            low[t][k] = INFINITY, high[t][k] = -INFINITY;
}

static int film_alloc(Film *film, RetexError *err)
{
    int w = film->params.width, h = film->params.height, code = retex_image_alloc(&film->beauty, w, h, 3, err);
    if (code || !film->params.split)
        return code;
    for (int k = 0; k < footprints_count(film) && !code; k++) {
        if (k % RETEX_MAX_ORDERS >= film->params.orders)
            continue;
        code = retex_image_alloc(&film->uv[k], w, h, 3, err);
        if (!code)
            code = retex_image_alloc(&film->spread[k], w, h, 2, err);
        if (!code)
            code = retex_image_alloc(&film->albedo[k], w, h, 3, err);
    }
    if (!code)
        code = terms_create(&film->terms, w, h, film->scene->ntargets, film->params.orders, err);
    return code;
}

int film_create(Film **out, const Scene *scene, const FilmParams *params, RetexError *err)
{
    Film *film = calloc(1, sizeof *film);
    *out = film;
    if (!film)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    pthread_mutex_init(&film->lock, NULL);
    uv_range_reset(film->uv_min, film->uv_max);
    film->tile_total = calloc((size_t)params->ntiles, sizeof(double));
    film->tile_folded = calloc((size_t)params->ntiles, sizeof(double));
    int code = film->tile_total && film->tile_folded ? film_alloc(film, err)
                                                     : retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    if (code)
        film_close(out);
    return code;
}

void film_close(Film **film)
{
    if (!*film)
        return;
    retex_image_free(&(*film)->beauty);
    for (int k = 0; k < RETEX_MAX_TARGETS * RETEX_MAX_ORDERS; k++) {
        retex_image_free(&(*film)->uv[k]);
        retex_image_free(&(*film)->spread[k]);
        retex_image_free(&(*film)->albedo[k]);
    }
    terms_close(&(*film)->terms);
    free((*film)->tile_total);
    free((*film)->tile_folded);
    pthread_mutex_destroy(&(*film)->lock);
    free(*film);
    *film = NULL;
}

int film_pixel_create(FilmPixel **out, Film *film, RetexError *err)
{
    FilmPixel *p = calloc(1, sizeof *p);
    *out = p;
    if (p) {
        p->film = film;
        p->sums = calloc(TERMS_MAX, sizeof *p->sums);
        p->touched = calloc(TERMS_MAX, sizeof *p->touched);
        uv_range_reset(p->uv_min, p->uv_max);
    }
    if (p && p->sums && p->touched)
        return RETEX_OK;
    film_pixel_close(out);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
}

/* Merge what a thread knows of UV ranges; minima and maxima do not depend on order. */
void film_pixel_close(FilmPixel **pixel)
{
    FilmPixel *p = *pixel;
    if (!p)
        return;
    pthread_mutex_lock(&p->film->lock);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++) {
            p->film->uv_min[t][k] = fmin(p->film->uv_min[t][k], p->uv_min[t][k]);
            p->film->uv_max[t][k] = fmax(p->film->uv_max[t][k], p->uv_max[t][k]);
        }
    p->film->dropped += p->dropped;
    p->film->lost |= p->lost;
    pthread_mutex_unlock(&p->film->lock);
    free(p->sums);
    free(p->touched);
    free(p);
    *pixel = NULL;
}

static void add_term(FilmPixel *p, TermKey key, Rgb value)
{
    int term = terms_find(&p->film->terms, &p->cache, key);
    if (term < 0) { /* no room for one more: film_finish says so */
        p->lost = 1;
        return;
    }
    float *sum = p->sums[term];
    if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0)
        p->touched[p->ntouched++] = term;
    sum[0] += value.r, sum[1] += value.g, sum[2] += value.b;
}

/* The original albedo of each hit of a monomial, weighted by the light it multiplied: so a term of one factor keeps its
 * original to the bit that arithmetic allows, whatever the texture does inside the pixel. */
static void add_albedos(FilmPixel *p, const Expansion *e, HitMask hits, Rgb value)
{
    for (int j = 0; j < e->nhits; j++) {
        const TargetHit *hit = &e->hits[j];
        if (!(hits & hit_bit(hit->target, hit->index)))
            continue;
        Rgb light = value;
        for (int k = 0; k < e->nhits; k++)
            if (k != j && hits & hit_bit(e->hits[k].target, e->hits[k].index))
                light = rgb_mul(light, e->hits[k].albedo);
        FootprintSums *f = &p->footprints[footprint_number(hit)];
        f->light[0] += light.r, f->light[1] += light.g, f->light[2] += light.b;
        f->light_albedo[0] += light.r * hit->albedo.r;
        f->light_albedo[1] += light.g * hit->albedo.g;
        f->light_albedo[2] += light.b * hit->albedo.b;
    }
}

/* Remember that each hit of the expansion has one more connection behind it. */
static void note_connection(FilmPixel *p, const Expansion *e)
{
    for (int j = 0; j < e->nhits; j++) {
        const TargetHit *hit = &e->hits[j];
        int k = p->nhits - 1;
        while (k >= 0 && !(p->hits[k].target == hit->target && p->hits[k].index == hit->index &&
                           p->hits[k].uv.u == hit->uv.u && p->hits[k].uv.v == hit->uv.v))
            k--;
        if (k < 0) {
            if (p->nhits == 64)
                continue;
            k = p->nhits++;
            p->hits[k] = *hit;
            p->connections[k] = 0;
        }
        p->connections[k]++;
    }
}

void film_connect(FilmPixel *p, Rgb beauty, Rgb outside, const Expansion *e, int folded)
{
    float l = rgb_luminance(beauty);
    if (!isfinite(beauty.r + beauty.g + beauty.b + outside.r + outside.g + outside.b)) {
        p->dropped++;
        return;
    }
    p->beauty[0] += beauty.r, p->beauty[1] += beauty.g, p->beauty[2] += beauty.b;
    p->total += l;
    if (folded)
        p->folded += l;
    if (!p->film->params.split || rgb_is_black(outside))
        return;
    for (int k = 0; k < e->nmonomials; k++) {
        Rgb value = rgb_mul(outside, e->monomials[k].coefficient);
        TermKey key = term_key(e->nhits, e->monomials[k].hits, p->film->params.strict_paper);
        if (key == TERM_DROPPED || rgb_is_black(value))
            continue;
        add_term(p, key, value);
        if (e->monomials[k].hits)
            add_albedos(p, e, e->monomials[k].hits, value);
    }
    note_connection(p, e);
}

static void footprint_add(FootprintSums *f, const TargetHit *hit, int weight)
{
    double before = f->count, uv[2] = {hit->uv.u, hit->uv.v};
    f->count += weight;
    for (int k = 0; k < 2; k++) {
        double delta = uv[k] - f->mean[k];
        f->mean[k] += delta * weight / f->count;
        f->m2[k] += delta * delta * weight * before / f->count;
    }
    f->albedo[0] += hit->albedo.r * (float)weight;
    f->albedo[1] += hit->albedo.g * (float)weight;
    f->albedo[2] += hit->albedo.b * (float)weight;
}

void film_path_end(FilmPixel *p)
{
    HitMask seen = 0;
    for (int k = 0; k < p->nhits; k++) {
        const TargetHit *hit = &p->hits[k];
        FootprintSums *f = &p->footprints[footprint_number(hit)];
        HitMask bit = hit_bit(hit->target, hit->index);
        footprint_add(f, hit, p->connections[k]);
        if (!(seen & bit))
            f->samples++;
        seen |= bit;
        for (int a = 0; a < 2; a++) {
            double x = a ? hit->uv.v : hit->uv.u;
            p->uv_min[hit->target][a] = fmin(p->uv_min[hit->target][a], x);
            p->uv_max[hit->target][a] = fmax(p->uv_max[hit->target][a], x);
        }
    }
    p->nhits = 0;
}

static void store_footprint(Film *film, int k, const FootprintSums *f, int x, int y)
{
    float *uv = film->uv[k].pixels + retex_image_index(&film->uv[k], x, y);
    float *spread = film->spread[k].pixels + retex_image_index(&film->spread[k], x, y);
    float *albedo = film->albedo[k].pixels + retex_image_index(&film->albedo[k], x, y);
    for (int a = 0; a < 2; a++) {
        uv[a] = (float)f->mean[a];
        spread[a] = (float)sqrt(f->m2[a] / f->count);
    }
    uv[2] = (float)f->samples / (float)film->params.spp;
    for (int c = 0; c < 3; c++)
        albedo[c] = f->light[c] > 0 ? f->light_albedo[c] / f->light[c] : (float)(f->albedo[c] / f->count);
}

void film_pixel_end(FilmPixel *p, int x, int y)
{
    Film *film = p->film;
    float scale = 1 / (float)film->params.spp;
    float *beauty = film->beauty.pixels + retex_image_index(&film->beauty, x, y);
    for (int c = 0; c < 3; c++)
        beauty[c] = (float)(p->beauty[c] / film->params.spp), p->beauty[c] = 0;
    for (int k = 0; k < p->ntouched; k++) {
        float *sum = p->sums[p->touched[k]], *pixel = terms_pixel(&film->terms, p->touched[k], x, y);
        for (int c = 0; c < 3; c++)
            pixel[c] = sum[c] * scale, sum[c] = 0;
    }
    p->ntouched = 0;
    for (int k = 0; k < footprints_count(film); k++)
        if (p->footprints[k].count > 0) {
            store_footprint(film, k, &p->footprints[k], x, y);
            p->footprints[k] = (FootprintSums){0};
        }
}

void film_tile_end(FilmPixel *p, int tile)
{
    p->film->tile_total[tile] = p->total;
    p->film->tile_folded[tile] = p->folded;
    p->total = p->folded = 0;
}

long film_dropped(const Film *film)
{
    return film->dropped;
}

/* Hand an image over to a new part of the set. */
static int move_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, RetexImage *image,
                     int *index, RetexError *err)
{
    int part, code = retex_set_add_part(set, name, letters, type, 1, 1, &part, err);
    if (code)
        return code;
    retex_image_free(&set->parts[part].image);
    set->parts[part].image = *image;
    *image = (RetexImage){0};
    if (index)
        *index = part;
    return RETEX_OK;
}

static int finish_footprints(Film *film, RetexSet *set, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    for (int t = 0; t < film->scene->ntargets; t++)
        for (int j = 0; j < film->params.orders; j++) {
            int k = t * RETEX_MAX_ORDERS + j, code;
            RetexFootprint f = {.target = t, .hit = j + 1};
            snprintf(name, sizeof name, "uv_%.90s_%d", film->scene->targets[t].name, j + 1);
            if ((code = move_part(set, name, "RGA", RETEX_FLOAT, &film->uv[k], &f.uv, err)))
                return code;
            snprintf(name, sizeof name, "spread_%.90s_%d", film->scene->targets[t].name, j + 1);
            if ((code = move_part(set, name, "RG", RETEX_HALF, &film->spread[k], &f.spread, err)))
                return code;
            snprintf(name, sizeof name, "albedo_%.90s_%d", film->scene->targets[t].name, j + 1);
            if ((code = move_part(set, name, "RGB", RETEX_HALF, &film->albedo[k], &f.albedo, err)))
                return code;
            if ((code = retex_set_add_footprint(set, &f, NULL, err)))
                return code;
        }
    return RETEX_OK;
}

/* Mean original albedo of a target over its footprints, weighted by coverage; the same for any number of threads. */
static void target_mean(const RetexSet *set, int target, float mean[3])
{
    double sum[3] = {0, 0, 0}, weight = 0;
    for (int k = 0; k < set->nfootprints; k++) {
        if (set->footprints[k].target != target)
            continue;
        const RetexImage *uv = &set->parts[set->footprints[k].uv].image,
                         *a = &set->parts[set->footprints[k].albedo].image;
        for (size_t i = 0; i < (size_t)uv->width * (size_t)uv->height; i++) {
            double w = uv->pixels[i * 3 + 2];
            weight += w;
            for (int c = 0; c < 3; c++)
                sum[c] += w * a->pixels[i * 3 + (size_t)c];
        }
    }
    for (int c = 0; c < 3; c++)
        mean[c] = weight > 0 ? (float)(sum[c] / weight) : 0;
}

static void finish_targets(const Film *film, RetexSet *set)
{
    for (int t = 0; t < set->ntargets; t++) {
        RetexTarget *target = &set->targets[t];
        snprintf(target->name, sizeof target->name, "%s", film->scene->targets[t].name);
        snprintf(target->idents, sizeof target->idents, "%s", film->scene->targets[t].idents);
        target->original = -1;
        target_mean(set, t, target->mean_albedo);
        for (int k = 0; k < 2; k++) {
            int met = film->uv_max[t][k] >= film->uv_min[t][k];
            target->uv_min[k] = met ? film->uv_min[t][k] : 0;
            target->uv_max[k] = met ? film->uv_max[t][k] : 1;
        }
    }
}

int film_finish(Film *film, RetexSet *set, RetexError *err)
{
    retex_image_free(&set->parts[0].image);
    set->parts[0].image = film->beauty;
    film->beauty = (RetexImage){0};
    set->ntargets = 0;
    retex_set_identify(set);
    if (!film->params.split)
        return RETEX_OK;
    if (film->lost)
        return retex_fail(err, RETEX_ELIMIT, "the set needs more than %d terms, or more memory than there is: %s",
                          TERMS_MAX, "take fewer targets or orders");
    set->orders = film->params.orders;
    set->strict_paper = film->params.strict_paper;
    double total = 0, folded = 0;
    for (int k = 0; k < film->params.ntiles; k++)
        total += film->tile_total[k], folded += film->tile_folded[k];
    set->folded = total > 0 ? folded / total : 0;
    set->ntargets = film->scene->ntargets;
    int code = finish_footprints(film, set, err);
    if (code)
        return code;
    finish_targets(film, set);
    return terms_finish(&film->terms, set, err);
}
