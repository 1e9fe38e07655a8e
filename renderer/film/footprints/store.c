/* Finished pixels into their images; see footprints.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/host/rounding.h>
#include <retex/target_name.h>
#include "film/footprints/lamps.h"

#define PARTS_MAX 1490   /* of a set, with room for its beauty, originals, AOVs and what denoising needs */
#define PARTS_EXTRA 1024 /* extra clusters are given up beyond: half of what readers of EXR files take */
#define CLUSTER_PARTS 5

/* ---- life ---- */

/* kind: 0 sharp, 1 broad, 2 interreflections. */
static const char *kind_name(int kind)
{
    return retex_footprint_kind_name(RETEX_FOOTPRINT_SHARP + kind);
}

/* One image of a footprint: uv_Floor_sharp1 and so on. number: 0 for none. */
static int add_image(FootprintFilm *film, const char *what, int t, const char *kind, int number, int *image,
                     RetexError *err)
{
    static const struct {
        const char *what, *letters;
        RetexPixelType type;
    } table[] = {{"uv", "RGA", RETEX_FLOAT}, {"spread", "RGB", RETEX_HALF}, {"albedo", "RGB", RETEX_HALF},
                 {"dep", "RGB", RETEX_HALF}, {"share", "R", RETEX_HALF},    {"axes", "RGBA", RETEX_HALF}};
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX], digits[16] = "";
    int i = 0;
    while (strcmp(table[i].what, what))
        i++;
    retex_target_word(word, film->scene->targets[t].name);
    if (number)
        snprintf(digits, sizeof digits, "%d", number);
    snprintf(name, sizeof name, "%s_%.90s_%s%s", what, word, kind, digits);
    return bands_add(film->bands, name, table[i].letters, table[i].type, image, err);
}

/* kind: 2 for further hits. */
static int add_footprint(FootprintFilm *film, FootprintImages *f, int t, int kind, int k, RetexError *err)
{
    const char *name = kind_name(kind);
    int code = add_image(film, "uv", t, name, k + 1, &f->uv, err);
    if (!code)
        code = add_image(film, "spread", t, name, k + 1, &f->spread, err);
    if (!code)
        code = add_image(film, "albedo", t, name, k + 1, &f->albedo, err);
    if (!code && kind < 2)
        code = add_image(film, "dep", t, name, k + 1, &f->light, err);
    if (!code && film->plan.count > 1)
        code = add_image(film, "share", t, name, k + 1, &f->share, err);
    return code;
}

/* uv_Floor_quadrants and so on, which the quarters of a pixel share, and dep_Floor_quadrant1. */
static int add_quadrants(FootprintFilm *film, QuadrantImages *q, int t, RetexError *err)
{
    int code = add_image(film, "uv", t, "quadrants", 0, &q->uv, err);
    if (!code)
        code = add_image(film, "axes", t, "quadrants", 0, &q->axes, err);
    if (!code)
        code = add_image(film, "albedo", t, "quadrants", 0, &q->albedo, err);
    for (int k = 0; k < RETEX_QUADRANTS && !code; k++)
        code = add_image(film, "dep", t, "quadrant", k + 1, &q->light[k], err);
    for (int k = 0; k < RETEX_QUADRANTS && !code && film->plan.count > 1; k++)
        code = add_image(film, "share", t, "quadrant", k + 1, &q->share[k], err);
    return code;
}

/* correction_Floor, correction_Floor_sharp1 and so on: the number is that of the target's hits. */
static int add_corrections(FootprintFilm *film, int t, RetexError *err)
{
    CorrectionImages *images = &film->targets[t].corrections;
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX];
    retex_target_word(word, film->scene->targets[t].name);
    snprintf(name, sizeof name, "correction_%.90s", word);
    int code = bands_add(film->bands, name, "RGB", RETEX_HALF, &images->without, err);
    for (int kind = 0; kind < CORRECTION_KINDS; kind++)
        for (int n = 0; n < CORRECTION_POWERS && !code; n++) {
            snprintf(name, sizeof name, "correction_%.80s_%s%d", word, kind_name(kind), n + 1);
            code = bands_add(film->bands, name, "RGB", RETEX_HALF, &images->with[kind][n], err);
        }
    return code;
}

static int add_target(FootprintFilm *film, int t, RetexError *err)
{
    TargetImages *target = &film->targets[t];
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX], light[RETEX_NAME_MAX];
    int code = RETEX_OK;
    retex_target_word(word, film->scene->targets[t].name);
    snprintf(light, sizeof light, "dep_%.80s", word);
    for (int kind = 0; kind < 2; kind++) {
        for (int k = 0; k < most_of_kind(&film->params, kind) && !code; k++)
            code = add_footprint(film, &target->kinds[kind].of[k], t, kind, k, err);
        for (int i = 1; i < film->plan.count && !code; i++) {
            plan_light_name(name, &film->plan, light, kind, i);
            code = bands_add(film->bands, name, "RGB", RETEX_HALF, &target->kinds[kind].interreflected[i], err);
        }
    }
    for (int k = 0; k < most_interreflections(film) && !code; k++)
        code = add_footprint(film, &target->interreflections[k], t, 2, k, err);
    if (!code && film->quadrants)
        code = add_quadrants(film, &target->quadrants, t, err);
    if (!code && corrected_targets(film->scene))
        code = add_corrections(film, t, err);
    return code;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* How many parts the set may need. */
static int parts_needed(const FootprintFilm *film)
{
    const FilmParams *p = &film->params;
    return film->scene->ntargets *
               (CLUSTER_PARTS * (most_of_kind(p, 0) + most_of_kind(p, 1)) + 2 * film->plan.count +
                4 * (INTERREFLECTION_CLUSTERS + p->extra_interreflections) + 1 + CORRECTION_KINDS * CORRECTION_POWERS) +
           film->scene->nkept * (lamps_images_needed(film) + 1 + 2 * film->scene->ntargets);
}

static void give_up(const FootprintFilm *film, int most, int *extra)
{
    while (*extra > 0 && parts_needed(film) > most)
        --*extra;
}

static void shorten_lamps(FootprintFilm *film, int most, int together)
{
    while (film->scene->nkept && parts_needed(film) > most)
        if (!plan_shorten(&film->lamp_plan, film->scene->ntargets, together))
            return;
}

/* Where there may be extra sharp clusters, there may be extra ones of the other kinds. Of many targets they are fewer:
 * the interreflections of all targets are one mixture. If the set may need too many parts, extra clusters of the other
 * kinds are the first to be given up, then further hits of lamps in all combinations but of two, then extra sharp
 * clusters, and last combinations of two. */
static void fit_parts(FootprintFilm *film)
{
    FilmParams *p = &film->params;
    const int most = film->scene->nkept ? PARTS_MAX : PARTS_EXTRA, ntargets = film->scene->ntargets;
    film->lamp_plan = film->plan;
    if (p->extra && ntargets) {
        p->extra_broad = least(EXTRA_BROAD, FILM_CLUSTERS_MAX - p->broad);
        p->extra_interreflections = least(INTERREFLECTION_MOST, RETEX_SHARES_MAX / ntargets) - INTERREFLECTION_CLUSTERS;
    }
    give_up(film, most, &p->extra_interreflections);
    give_up(film, most, &p->extra_broad);
    shorten_lamps(film, most, 2);
    give_up(film, most, &p->extra);
    shorten_lamps(film, most, 1);
}

int footprints_create(void **out, const Scene *scene, const FilmParams *params, Bands *bands, RetexError *err)
{
    FootprintFilm *film = *out = calloc(1, sizeof *film);
    if (film)
        film->targets = calloc((size_t)scene->ntargets + 1, sizeof *film->targets);
    if (!film || !film->targets)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    film->bands = bands;
    plan_make(&film->plan, scene->ntargets, params->orders, RETEX_MAX_HITS);
    fit_parts(film);
    plan_weigh(&film->plan, scene->ntargets, params->brightness);
    plan_weigh(&film->lamp_plan, scene->ntargets, params->brightness);
    if (parts_needed(film) > PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT,
                          "the set may need %d parts, more than %d: take fewer targets%s or clusters",
                          parts_needed(film), PARTS_MAX, scene->nkept ? ", lamps, finishes" : "");
    film->quadrants = params->quadrants && parts_needed(film) + scene->ntargets * QUADRANT_IMAGES <= PARTS_MAX;
    int code = bands_add(bands, "indep", "RGB", RETEX_HALF, &film->indep, err);
    for (int t = 0; t < scene->ntargets && !code; t++)
        code = add_target(film, t, err);
    return code ? code : lamps_create(film, err);
}

void footprints_close(void **out)
{
    FootprintFilm *film = *out;
    if (!film)
        return;
    lamps_close(film);
    free(film->targets);
    free(film);
    *out = NULL;
}

long footprints_floats(const FilmParams *params, int ntargets)
{
    Plan plan;
    plan_make(&plan, ntargets, params->orders, RETEX_MAX_HITS);
    /* few pixels have all clusters, and what is never written takes no memory: one cluster, and its coefficients */
    return 3 + ntargets * (12 + 10 + 3 * (plan.count - 1)) + 3 * params->nkept * (1 + 2 * ntargets);
}

/* ---- the finished pixel ---- */

/* Where a finished pixel goes. */
typedef struct Place {
    BandRows *rows;
    int x, y;
} Place;

static float *pixel_of(const Place *place, int image)
{
    return bands_pixel(place->rows, image, place->x, place->y);
}

static void store_albedo(int image, const AlbedoSums *albedo, const Place *at)
{
    float *a = pixel_of(at, image);
    float light = albedo->light[0] + albedo->light[1] + albedo->light[2];
    float reflected = albedo->reflected[0] + albedo->reflected[1] + albedo->reflected[2];
    for (int c = 0; c < 3; c++) /* a channel without light: grey of the others */
        a[c] = albedo->light[c] > 0 ? albedo->reflected[c] / albedo->light[c] : light > 0 ? reflected / light : 0;
}

static void store_footprint(const FootprintImages *to, const RetexUvStats *uv, const AlbedoSums *albedo, float coverage,
                            const Place *at)
{
    float *mean = pixel_of(at, to->uv), *spread = pixel_of(at, to->spread);
    retex_uv_stats_get(uv, mean, spread);
    mean[2] = coverage;
    store_albedo(to->albedo, albedo, at);
}

static int compare_clusters(const void *a, const void *b)
{
    const Cluster *x = a, *y = b;
    double p = x->uv.mean[0] + x->uv.mean[1], q = y->uv.mean[0] + y->uv.mean[1];
    return p < q ? -1 : p > q;
}

static void add_white(double sum[3], const Clusters *clusters)
{
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < clusters->count; k++)
            sum[c] += clusters->of[k].c[c];
        for (unsigned left = clusters->used; left; left &= left - 1)
            sum[c] += clusters->interreflected[__builtin_ctz(left)][c];
    }
}

/* The largest channel of the pixel as it would be with white textures, in the set's units. */
static double white_pixel(const FootprintPixel *p)
{
    double sum[3] = {p->indep[0], p->indep[1], p->indep[2]};
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        add_white(sum, &p->targets[t].sharp);
        add_white(sum, &p->targets[t].broad);
    }
    return fmax(sum[0], fmax(sum[1], sum[2])) / p->spp;
}

/* So many paths of equal weight would know as much (Kish 1965): few bright ones count for few. */
static double effective_samples(double weight, double squares)
{
    return weight * weight / squares;
}

static void store_light(int image, Float4 sum, float scale, const Place *at)
{
    if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0)
        return; /* memory that is never touched is never taken */
    float *to = pixel_of(at, image);
    for (int c = 0; c < 3; c++)
        to[c] = sum[c] * scale;
}

static void store_share(int image, float share, const Place *at)
{
    *pixel_of(at, image) = fmaxf(share, RETEX_LEAST_SHARE);
}

/* What the pixel sees directly of the target that covers it. interreflected: the light of the kind, for shares. */
static void store_quadrants(const FootprintPixel *p, const QuadrantImages *images, const PixelMap *map,
                            float interreflected, const Place *at)
{
    const Quadrants *q = &p->quadrants;
    const float scale = 1 / (float)p->spp, coverage = (float)effective_samples(q->weight, q->squares) * scale;
    float *uv = pixel_of(at, images->uv), *axes = pixel_of(at, images->axes);
    for (int k = 0; k < 2; k++)
        uv[k] = (float)map->uv[k];
    for (int k = 0; k < 4; k++)
        axes[k] = (float)map->axes[k];
    uv[2] = coverage / RETEX_QUADRANTS;
    store_albedo(images->albedo, &q->albedo, at);
    for (int k = 0; k < RETEX_QUADRANTS; k++) {
        store_light(images->light[k], quadrants_light(q, k, 0), scale, at);
        if (interreflected > 0)
            store_share(images->share[k], luminance4(quadrants_light(q, k, 1)) / interreflected, at);
    }
}

/* Clusters into their images, in the order of their place on the texture, so that neighbours agree. map: where the
 * quadrants are that stand for a part of the light, or NULL. */
static void store_clusters(FootprintPixel *p, const TargetImages *target, int kind, Clusters *clusters,
                           const PixelMap *map, const Place *at)
{
    const KindImages *images = &target->kinds[kind];
    float scale = 1 / (float)p->spp;
    float interreflected = 0;
    for (int k = 0; k < clusters->count; k++)
        interreflected += luminance4(clusters->of[k].interreflected);
    if (map) {
        store_quadrants(p, &target->quadrants, map, interreflected, at);
        clusters_keep_rest(clusters);
    }
    qsort(clusters->of, (size_t)clusters->count, sizeof *clusters->of, compare_clusters);
    RETEX_ASSERT(clusters->count <= most_of_kind(&p->film->params, kind)); /* as many as have images */
    for (int k = 0; k < clusters->count; k++) {
        const Cluster *cluster = &clusters->of[k];
        float coverage = (float)effective_samples(cluster->uv.weight, cluster->squares) * scale;
        store_footprint(&images->of[k], &cluster->uv, &cluster->albedo, coverage, at);
        store_light(images->of[k].light, cluster->c, scale, at);
        if (interreflected > 0)
            store_share(images->of[k].share, luminance4(cluster->interreflected) / interreflected, at);
    }
    for (unsigned left = clusters->used; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        store_light(images->interreflected[i], clusters->interreflected[i], scale, at);
    }
}

static void reset_clusters(Clusters *clusters)
{
    for (unsigned left = clusters->used; left; left &= left - 1)
        clusters->interreflected[__builtin_ctz(left)] = splat(0);
    clusters->count = 0;
    clusters->used = 0;
}

static double light_sum(const AlbedoSums *albedo)
{
    return (double)albedo->light[0] + albedo->light[1] + albedo->light[2];
}

/* Interreflections, with the share that each has in the light of all. */
static void store_interreflections(FootprintPixel *p, const Place *at)
{
    int ntargets = p->film->scene->ntargets;
    double sum = 0;
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < most_interreflections(p->film); k++)
            sum += light_sum(&p->targets[t].interreflections[k].albedo);
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < most_interreflections(p->film); k++) {
            const InterreflectionCluster *cluster = &p->targets[t].interreflections[k];
            const FootprintImages *images = &p->film->targets[t].interreflections[k];
            if (!(cluster->uv.weight > 0))
                continue;
            double effective = effective_samples(cluster->uv.weight, cluster->squares) / p->spp;
            store_footprint(images, &cluster->uv, &cluster->albedo, (float)fmin(effective, 1), at);
            store_share(images->share, sum > 0 ? (float)(light_sum(&cluster->albedo) / sum) : 0, at);
        }
}

void footprints_pixel_end(void *pixel, BandRows *rows, int spp, int x, int y)
{
    FootprintPixel *p = pixel;
    const Place at = {rows, x, y};
    FootprintFilm *film = p->film;
    p->spp = spp;
    const double white = white_pixel(p), unit = retex_coefficient_unit(white); /* before light is reset */
    const double light = white * spp;                                          /* in the units of paths */
    for (int t = 0; t < film->scene->ntargets; t++) {
        clusters_merge_extra(&p->targets[t], t, &film->params, light);
        clusters_merge_interreflections(&p->targets[t], t, &film->params, light, spp);
        clusters_merge_broad(&p->targets[t], t, &film->params, light, spp);
    }
    float scale = 1 / (float)spp, *c0 = pixel_of(&at, film->indep);
    for (int c = 0; c < 3; c++)
        c0[c] = (float)(p->indep[c] * scale), p->indep[c] = 0;
    PixelMap map;
    const int covered =
        quadrants_find_map(&p->quadrants, film->params.periodic, &map) ? p->quadrants.target : QUADRANTS_NONE;
    for (int t = 0; t < film->scene->ntargets; t++) {
        store_clusters(p, &film->targets[t], 0, &p->targets[t].sharp, t == covered ? &map : NULL, &at);
        store_clusters(p, &film->targets[t], 1, &p->targets[t].broad, NULL, &at);
    }
    p->quadrants.target = covered; /* corrections look at the stored images */
    store_interreflections(p, &at);
    if (p->lamps)
        lamps_store(p->lamps, rows, spp, x, y);
    corrections_store(p, rows, unit, x, y);
    for (int t = 0; t < film->scene->ntargets; t++) {
        TargetClusters *target = &p->targets[t];
        reset_clusters(&target->sharp);
        target->specular = 0;
        reset_clusters(&target->broad);
        memset(target->interreflections, 0, sizeof target->interreflections);
    }
    p->quadrants.target = QUADRANTS_NONE;
}

/* ---- the finished band ---- */

void footprints_band_stats(const void *layout, const BandRows *rows, RetexBandStats *s)
{
    const FootprintFilm *film = layout;
    for (int t = 0; t < film->scene->ntargets; t++) {
        const TargetImages *target = &film->targets[t];
        for (int kind = 0; kind < 2; kind++)
            for (int k = 0; k < most_of_kind(&film->params, kind); k++)
                bands_add_albedo(rows, target->kinds[kind].of[k].uv, target->kinds[kind].of[k].albedo, s, t);
        for (int k = 0; k < RETEX_QUADRANTS && film->quadrants; k++)
            bands_add_albedo(rows, target->quadrants.uv, target->quadrants.albedo, s, t);
        for (int k = 0; k < most_interreflections(film); k++)
            bands_add_albedo(rows, target->interreflections[k].uv, target->interreflections[k].albedo, s, t);
    }
}
