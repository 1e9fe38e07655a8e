/* Finished pixels into their images; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "film/footprint_pixel.h"

#define PARTS_MAX 1490 /* of a set, with room for its beauty, originals, AOVs and what denoising needs */
#define SHARE_STEP (1.0 / 512)
#define LEAST_SHARE 1e-5f /* of further hits: a half holds it */
/* Coefficients are rounded to this share of what the pixel would be were its targets white: steps no one sees, and
 * small coefficients of few bits, which compress. */
#define COEFFICIENT_STEP (1.0f / 8192)

/* ---- life ---- */

static int alloc_footprint(const FilmParams *p, FootprintImages *f, RetexError *err)
{
    int code = retex_image_alloc(&f->uv, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->spread, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->albedo, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->light, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->share, p->width, p->height, 1, err);
    return code;
}

static void free_footprint(FootprintImages *f)
{
    retex_image_free(&f->uv);
    retex_image_free(&f->spread);
    retex_image_free(&f->albedo);
    retex_image_free(&f->light);
    retex_image_free(&f->share);
}

static int alloc_target(const FootprintFilm *film, TargetImages *target, RetexError *err)
{
    const FilmParams *p = &film->params;
    int code = RETEX_OK;
    for (int kind = 0; kind < 2; kind++) {
        for (int k = 0; k < most_of_kind(p, kind) && !code; k++)
            code = alloc_footprint(p, &target->kinds[kind].of[k], err);
        for (int i = 1; i < film->plan.count && !code; i++)
            code = retex_image_alloc(&target->kinds[kind].again[i], p->width, p->height, 3, err);
    }
    for (int k = 0; k < LATER_COUNT && film->plan.count > 1 && !code; k++)
        code = alloc_footprint(p, &target->later[k], err);
    return code;
}

static void free_target(TargetImages *target)
{
    for (int kind = 0; kind < 2; kind++) {
        for (int k = 0; k < FILM_CLUSTERS_MAX; k++)
            free_footprint(&target->kinds[kind].of[k]);
        for (int i = 0; i < PLAN_COEFFICIENTS_MAX; i++)
            retex_image_free(&target->kinds[kind].again[i]);
    }
    for (int k = 0; k < LATER_COUNT; k++)
        free_footprint(&target->later[k]);
}

int footprints_create(FootprintFilm **out, const Scene *scene, const FilmParams *params, RetexError *err)
{
    FootprintFilm *film = *out = calloc(1, sizeof *film);
    if (film)
        film->targets = calloc((size_t)scene->ntargets + 1, sizeof *film->targets);
    if (!film || !film->targets)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    plan_make(&film->plan, scene->ntargets, params->orders, expansion_most_hits(scene->ntargets, 0));
    int parts = scene->ntargets * (5 * (params->sharp + params->broad) + 2 * film->plan.count + 4 * LATER_COUNT);
    if (parts > PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the set may need %d parts, more than %d: take fewer targets or clusters",
                          parts, PARTS_MAX);
    int code = retex_image_alloc(&film->free, params->width, params->height, 3, err);
    for (int t = 0; t < scene->ntargets && !code; t++)
        code = alloc_target(film, &film->targets[t], err);
    return code;
}

void footprints_close(FootprintFilm **out)
{
    FootprintFilm *film = *out;
    if (!film)
        return;
    retex_image_free(&film->free);
    for (int t = 0; film->targets && t < film->scene->ntargets; t++)
        free_target(&film->targets[t]);
    free(film->targets);
    free(film);
    *out = NULL;
}

/* ---- the finished pixel ---- */

static float *pixel_of(RetexImage *image, int x, int y)
{
    return image->pixels + retex_image_index(image, x, y);
}

static void store_footprint(FootprintImages *to, const UvStats *uv, const AlbedoSums *albedo, float coverage, int x,
                            int y)
{
    float *mean = pixel_of(&to->uv, x, y), *spread = pixel_of(&to->spread, x, y), *a = pixel_of(&to->albedo, x, y);
    uv_stats_store(uv, mean, spread);
    mean[2] = coverage;
    float light = albedo->light[0] + albedo->light[1] + albedo->light[2];
    float reflected = albedo->reflected[0] + albedo->reflected[1] + albedo->reflected[2];
    for (int c = 0; c < 3; c++) /* a channel without light: grey of the others */
        a[c] = albedo->light[c] > 0 ? albedo->reflected[c] / albedo->light[c] : light > 0 ? reflected / light : 0;
}

static int compare_clusters(const void *a, const void *b)
{
    const Cluster *x = a, *y = b;
    double p = x->uv.mean[0] + x->uv.mean[1], q = y->uv.mean[0] + y->uv.mean[1];
    return p < q ? -1 : p > q;
}

static void add_white(double sum[3], const Clusters *clusters, int coefficients)
{
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < clusters->count; k++)
            sum[c] += clusters->of[k].c[c];
        for (int i = 1; i < coefficients; i++)
            sum[c] += clusters->again[i][c];
    }
}

/* The largest channel of the pixel as it would be with white textures, in the set's units. */
static float white_pixel(const FootprintPixel *p)
{
    double sum[3] = {p->free[0], p->free[1], p->free[2]};
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        add_white(sum, &p->targets[t].sharp, p->film->plan.count);
        add_white(sum, &p->targets[t].broad, p->film->plan.count);
    }
    return (float)(fmax(sum[0], fmax(sum[1], sum[2])) / p->film->params.spp);
}

/* So many paths of equal weight would know as much (Kish 1965): few bright ones count for few. */
static double effective_samples(const Cluster *cluster)
{
    return cluster->uv.weight * cluster->uv.weight / cluster->squares;
}

static void store_light(RetexImage *image, const float sum[3], float scale, double step, int x, int y)
{
    if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0)
        return; /* memory that is never touched is never taken */
    float *to = pixel_of(image, x, y);
    for (int c = 0; c < 3; c++)
        to[c] = (float)retex_round_to(sum[c] * scale, step);
}

static void store_share(RetexImage *image, float share, int x, int y)
{
    *pixel_of(image, x, y) = fmaxf((float)retex_round_to(share, SHARE_STEP), LEAST_SHARE);
}

/* Clusters into their images, in the order of their place on the texture, so that neighbours agree. */
static void store_clusters(FootprintPixel *p, KindImages *images, Clusters *clusters, double step, int x, int y)
{
    float scale = 1 / (float)p->film->params.spp;
    float again = 0;
    for (int k = 0; k < clusters->count; k++)
        again += clusters->of[k].again;
    qsort(clusters->of, (size_t)clusters->count, sizeof *clusters->of, compare_clusters);
    for (int k = 0; k < clusters->count; k++) {
        const Cluster *cluster = &clusters->of[k];
        float coverage = (float)effective_samples(cluster) * scale;
        store_footprint(&images->of[k], &cluster->uv, &cluster->albedo, coverage, x, y);
        store_light(&images->of[k].light, cluster->c, scale, step, x, y);
        if (again > 0)
            store_share(&images->of[k].share, cluster->again / again, x, y);
    }
    for (int i = 1; i < p->film->plan.count; i++)
        store_light(&images->again[i], clusters->again[i], scale, step, x, y);
    clusters->count = 0;
    memset(clusters->again, 0, sizeof clusters->again[0] * (size_t)p->film->plan.count);
}

static double light_sum(const AlbedoSums *albedo)
{
    return (double)albedo->light[0] + albedo->light[1] + albedo->light[2];
}

/* Further hits, with the share that each has in the light of all. */
static void store_later(FootprintPixel *p, int x, int y)
{
    int ntargets = p->film->scene->ntargets;
    double sum = 0;
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < LATER_COUNT; k++)
            sum += light_sum(&p->targets[t].later[k].albedo);
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < LATER_COUNT; k++) {
            Later *later = &p->targets[t].later[k];
            FootprintImages *images = &p->film->targets[t].later[k];
            if (!(later->uv.weight > 0))
                continue;
            double effective = later->uv.weight * later->uv.weight / later->squares / p->film->params.spp;
            store_footprint(images, &later->uv, &later->albedo, (float)fmin(effective, 1), x, y);
            store_share(&images->share, sum > 0 ? (float)(light_sum(&later->albedo) / sum) : 0, x, y);
            *later = (Later){.squares = 0};
        }
}

void footprints_pixel_end(FootprintPixel *p, int x, int y)
{
    FootprintFilm *film = p->film;
    double step = COEFFICIENT_STEP * white_pixel(p);
    float scale = 1 / (float)film->params.spp, *c0 = pixel_of(&film->free, x, y);
    for (int c = 0; c < 3; c++)
        c0[c] = (float)(p->free[c] * scale), p->free[c] = 0;
    for (int t = 0; t < film->scene->ntargets; t++) {
        store_clusters(p, &film->targets[t].kinds[0], &p->targets[t].sharp, step, x, y);
        store_clusters(p, &film->targets[t].kinds[1], &p->targets[t].broad, step, x, y);
    }
    store_later(p, x, y);
}
