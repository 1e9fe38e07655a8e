/* What both layouts share: the beauty, sums of energy, the range of UV, and handing images over to a set. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "film/film.h"
#include "film/footprints.h"
#include "film/noise.h"
#include "film/paper.h"
#include "film/plan.h"

struct Film {
    const Scene *scene;
    FilmParams params;
    RetexImage beauty;
    PaperFilm *paper; /* one of these two, where there is a split */
    FootprintFilm *footprints;
    NoiseImages noise;
    LightSums *tiles;
    pthread_mutex_t lock;
    UvRange range; /* under lock, as is: */
    long dropped;
};

struct FilmPixel {
    Film *film;
    PaperPixel *paper;
    FootprintPixel *footprints;
    double beauty[3];
    int paths;         /* so far */
    SignalTotals half; /* of the first half of the paths */
    LightSums light;   /* of the tile so far */
    UvRange range;
    long dropped;
};

/* ---- ranges of UV ---- */

void uv_range_reset(UvRange *range)
{
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++)
            range->low[t][k] = INFINITY, range->high[t][k] = -INFINITY;
}

void uv_range_add(UvRange *range, int target, const double uv[2])
{
    for (int k = 0; k < 2; k++) {
        range->low[target][k] = fmin(range->low[target][k], uv[k]);
        range->high[target][k] = fmax(range->high[target][k], uv[k]);
    }
}

void uv_range_merge(UvRange *into, const UvRange *from)
{
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++) {
            into->low[t][k] = fmin(into->low[t][k], from->low[t][k]);
            into->high[t][k] = fmax(into->high[t][k], from->high[t][k]);
        }
}

/* ---- life ---- */

static int film_alloc(Film *film, RetexError *err)
{
    const FilmParams *p = &film->params;
    int code = retex_image_alloc(&film->beauty, p->width, p->height, 3, err);
    if (!code && p->split)
        code = p->paper ? paper_create(&film->paper, film->scene, p, err)
                        : footprints_create(&film->footprints, film->scene, p, err);
    return code ? code : noise_create(&film->noise, p, film->scene->ntargets, err);
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
    uv_range_reset(&film->range);
    film->tiles = calloc((size_t)params->ntiles, sizeof *film->tiles);
    int code = film->tiles ? film_alloc(film, err) : retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    if (code)
        film_close(out);
    return code;
}

void film_close(Film **film)
{
    if (!*film)
        return;
    retex_image_free(&(*film)->beauty);
    paper_close(&(*film)->paper);
    footprints_close(&(*film)->footprints);
    noise_close(&(*film)->noise);
    free((*film)->tiles);
    pthread_mutex_destroy(&(*film)->lock);
    free(*film);
    *film = NULL;
}

int film_pixel_create(FilmPixel **out, Film *film, RetexError *err)
{
    FilmPixel *p = *out = calloc(1, sizeof *p);
    if (!p)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
    p->film = film;
    uv_range_reset(&p->range);
    int code = RETEX_OK;
    if (film->paper)
        code = paper_pixel_create(&p->paper, film->paper, err);
    if (film->footprints)
        code = footprints_pixel_create(&p->footprints, film->footprints, err);
    if (code)
        film_pixel_close(out);
    return code;
}

/* Merge what a thread knows of UV ranges; minima and maxima do not depend on order. */
void film_pixel_close(FilmPixel **pixel)
{
    FilmPixel *p = *pixel;
    if (!p)
        return;
    pthread_mutex_lock(&p->film->lock);
    uv_range_merge(&p->film->range, &p->range);
    p->film->dropped += p->dropped;
    pthread_mutex_unlock(&p->film->lock);
    paper_pixel_close(&p->paper);
    footprints_pixel_close(&p->footprints);
    free(p);
    *pixel = NULL;
}

/* ---- light ---- */

void film_connect(FilmPixel *p, Rgb beauty, Rgb outside, const Expansion *e, int folded)
{
    float l = rgb_luminance(beauty);
    if (!isfinite(beauty.r + beauty.g + beauty.b + outside.r + outside.g + outside.b)) {
        p->dropped++;
        return;
    }
    p->beauty[0] += beauty.r, p->beauty[1] += beauty.g, p->beauty[2] += beauty.b;
    LightSums before = p->light;
    p->light.total += l;
    if (p->paper && !rgb_is_black(outside))
        paper_connect(p->paper, e, outside);
    if (p->footprints && !rgb_is_black(outside))
        footprints_connect(p->footprints, e, outside, &p->light);
    if (folded) { /* all of it, and not again what the layout folded of it */
        p->light.folded = before.folded + l;
        p->light.folded_white = before.folded_white + p->light.total_white - before.total_white;
    }
}

/* What each signal got in the pixel so far. */
static void signal_totals(const FilmPixel *p, SignalTotals *totals)
{
    if (p->paper)
        paper_totals(p->paper, totals);
    else if (p->footprints)
        footprints_totals(p->footprints, totals);
    else
        memcpy(totals->of[0], p->beauty, sizeof p->beauty);
}

void film_path_end(FilmPixel *p)
{
    if (p->paper)
        paper_path_end(p->paper, &p->range);
    if (p->footprints)
        footprints_path_end(p->footprints, &p->range);
    if (++p->paths == p->film->params.spp / 2 && p->film->noise.count)
        signal_totals(p, &p->half);
}

void film_pixel_end(FilmPixel *p, int x, int y)
{
    Film *film = p->film;
    float *beauty = film->beauty.pixels + retex_image_index(&film->beauty, x, y);
    if (film->noise.count) {
        SignalTotals all;
        signal_totals(p, &all);
        noise_store(&film->noise, &p->half, &all, x, y);
    }
    p->paths = 0;
    for (int c = 0; c < 3; c++)
        beauty[c] = (float)(p->beauty[c] / film->params.spp), p->beauty[c] = 0;
    if (p->paper)
        paper_pixel_end(p->paper, x, y);
    if (p->footprints)
        footprints_pixel_end(p->footprints, x, y);
}

void film_tile_end(FilmPixel *p, int tile)
{
    p->film->tiles[tile] = p->light;
    p->light = (LightSums){0};
}

long film_floats(const FilmParams *params, int ntargets)
{
    int noise = 3 * noise_count(params, ntargets);
    if (!params->split || ntargets == 0)
        return 3 + noise;
    if (params->paper)
        return 3 + noise + params->orders * (8 * ntargets + 6); /* footprints, terms */
    Plan plan;
    plan_make(&plan, ntargets, params->orders, expansion_most_hits(ntargets, 0));
    /* few pixels have all clusters, and what is never written takes no memory: one cluster, and its coefficients */
    return 6 + noise + ntargets * (12 + 10 + 3 * (plan.count - 1));
}

long film_dropped(const Film *film)
{
    return film->dropped;
}

/* ---- into a set ---- */

int film_move_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, RetexImage *image,
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
        for (int k = 0; k < 2; k++) {
            int met = film->range.high[t][k] >= film->range.low[t][k];
            target->uv_min[k] = met ? film->range.low[t][k] : 0;
            target->uv_max[k] = met ? film->range.high[t][k] : 1;
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
        return noise_finish(&film->noise, set, err);
    set->orders = film->params.orders;
    set->strict_paper = film->params.strict_paper;
    LightSums sums = {0};
    for (int k = 0; k < film->params.ntiles; k++) {
        sums.total += film->tiles[k].total, sums.folded += film->tiles[k].folded;
        sums.total_white += film->tiles[k].total_white, sums.folded_white += film->tiles[k].folded_white;
    }
    set->folded = sums.total > 0 ? sums.folded / sums.total : 0;
    set->folded_white = sums.total_white > 0 ? sums.folded_white / sums.total_white : 0;
    set->ntargets = film->scene->ntargets;
    finish_targets(film, set);
    int code = film->paper ? paper_finish(film->paper, set, err) : footprints_finish(film->footprints, set, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        target_mean(set, t, set->targets[t].mean_albedo);
    return code ? code : noise_finish(&film->noise, set, err);
}
