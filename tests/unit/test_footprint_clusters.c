/* The clusters of a pixel, compared with a simple search that computes the cost of every pair anew for every place. */
#include "lib_test.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "film/footprints/pixel.h"

#define PLACES 400

/* What light of these places is expected to change by, squared, if a texture whose features are .05 wide is taken at
 * their mean: w^2 v. */
static double light_error2(const RetexUvStats *a)
{
    const double variance = (a->m2[0] + a->m2[2]) / a->weight;
    return a->weight * a->weight * variance / (variance + 0.05 * 0.05);
}

/* kind: 1 sharp, 0 broad, 2 sharp where a mirror shows some. */
static double merge_cost(const RetexUvStats *a, const RetexUvStats *b, int kind, const int periodic[2])
{
    RetexUvStats both = *a;
    retex_uv_stats_merge(&both, b, periodic);
    return kind == 2   ? light_error2(&both) - light_error2(a) - light_error2(b)
           : kind == 1 ? retex_uv_stats_ward(a, b, periodic) / (RETEX_UV_FEATURE * RETEX_UV_FEATURE)
                       : retex_uv_stats_variation_gain(a, b, periodic);
}

/* Places of clusters, as of one kind. */
typedef struct Places {
    int count;
    RetexUvStats of[FILM_CLUSTERS_MAX];
} Places;

typedef struct Best {
    Places *places;
    int a, b; /* b = -1: with the new one */
    double cost;
} Best;

static void find_pair(Best *best, Places *places, int kind, const int periodic[2])
{
    for (int i = 0; i < places->count; i++)
        for (int k = i + 1; k < places->count; k++) {
            double cost = merge_cost(&places->of[i], &places->of[k], kind, periodic);
            if (cost < best->cost)
                *best = (Best){places, i, k, cost};
        }
}

static void start_place(RetexUvStats *place, const FirstHit *q, const int periodic[2])
{
    *place = (RetexUvStats){.weight = 0};
    retex_uv_stats_add(place, q->weight, q->uv, periodic);
}

static void squeeze_place(Places *own, Places *other, int own_is_full, int specular, const FirstHit *q,
                          const int periodic[2])
{
    const RetexUvStats one = {q->weight, {q->uv[0], q->uv[1]}, {0, 0, 0}};
    Best best = {.cost = INFINITY};
    for (int i = 0; i < own->count; i++) {
        double cost = merge_cost(&own->of[i], &one, q->sharp ? 1 + specular : 0, periodic);
        if (cost < best.cost)
            best = (Best){own, i, -1, cost};
    }
    find_pair(&best, own, q->sharp ? 1 + specular : 0, periodic);
    if (!own_is_full)
        find_pair(&best, other, q->sharp ? 0 : 1 + specular, periodic);
    if (best.b < 0) {
        retex_uv_stats_add(&own->of[best.a], q->weight, one.mean, periodic);
        return;
    }
    retex_uv_stats_merge(&best.places->of[best.a], &best.places->of[best.b], periodic);
    if (best.places == own) {
        start_place(&own->of[best.b], q, periodic);
        return;
    }
    best.places->of[best.b] = best.places->of[best.places->count - 1];
    best.places->count--;
    start_place(&own->of[own->count++], q, periodic);
}

/* extra: so many more sharp ones there may be in this pixel. */
static void add_place(Places kinds[2], int extra, const FirstHit *q, const FilmParams *params)
{
    Places *own = &kinds[!q->sharp], *other = &kinds[q->sharp];
    const int gathered = params->clusters == params->sharp + params->broad ? 4 : 0; /* broad ones until all are there */
    int room = q->sharp ? params->sharp + extra : params->broad + gathered;
    const int *periodic = params->periodic[q->target];
    if (own->count < room && own->count + other->count < params->clusters + extra + gathered)
        start_place(&own->of[own->count++], q, periodic);
    else
        squeeze_place(own, other, own->count == room, extra > 0, q, periodic);
}

static void add_interreflection(RetexUvStats clusters[INTERREFLECTION_GATHERED], const Interreflection *l,
                                const int periodic[2])
{
    const RetexUvStats one = {l->weight, {l->uv[0], l->uv[1]}, {0, 0, 0}};
    double gain[INTERREFLECTION_GATHERED];
    for (int k = 0; k < INTERREFLECTION_GATHERED; k++) {
        if (clusters[k].weight == 0) {
            clusters[k] = one;
            return;
        }
        gain[k] = retex_uv_stats_variation_gain(&clusters[k], &one, periodic);
        if (gain[k] <= 0) {
            retex_uv_stats_merge(&clusters[k], &one, periodic);
            return;
        }
    }
    int nearest = 0, a = 0, b = 1;
    double least = INFINITY;
    for (int i = 0; i < INTERREFLECTION_GATHERED; i++) {
        nearest = gain[i] < gain[nearest] ? i : nearest;
        for (int k = i + 1; k < INTERREFLECTION_GATHERED; k++) {
            const double cost = retex_uv_stats_variation_gain(&clusters[i], &clusters[k], periodic);
            if (cost < least)
                least = cost, a = i, b = k;
        }
    }
    if (least < gain[nearest]) {
        retex_uv_stats_merge(&clusters[a], &clusters[b], periodic);
        clusters[b] = one;
    } else {
        retex_uv_stats_merge(&clusters[nearest], &one, periodic);
    }
}

/* Some places near others, some far away, some met twice; weights of all sizes. */
static Vec2 any_place(uint32_t *seed, Vec2 last)
{
    double spread = test_random(seed) < 0.7 ? 0.02 : 3;
    if (test_random(seed) < 0.05)
        return last;
    double u = floor(4 * test_random(seed)) / 4;
    return (Vec2){u + spread * (test_random(seed) - 0.5), 0.3 + spread * (test_random(seed) - 0.5)};
}

static void expect_same(const Clusters *clusters, const Places *places)
{
    assert_int_equal(clusters->count, places->count);
    for (int k = 0; k < places->count; k++)
        assert_memory_equal(&clusters->of[k].uv, &places->of[k], sizeof places->of[k]);
}

/* What clusters of one kind or of both keep of their hits' light, whatever merges. */
typedef struct Kept {
    double squares, light, interreflected, reflected;
} Kept;

static void add_kept(Kept *sum, const Clusters *clusters)
{
    for (int k = 0; k < clusters->count; k++) {
        const Cluster *c = &clusters->of[k];
        sum->squares += c->squares, sum->light += c->c[1], sum->interreflected += c->interreflected[1];
        sum->reflected += c->albedo.reflected[1];
    }
}

static void nothing_is_lost_by_merging(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 20; round++) {
        TargetClusters target = {.interreflections_bound = 0};
        FilmParams params = {.sharp = 2, .broad = 2, .clusters = 3 + (int)round % 2};
        Kept all = {0, 0, 0, 0}, kept = {0, 0, 0, 0};
        uint32_t seed = round + 1;
        Vec2 last = {0, 0};
        for (int n = 0; n < PLACES; n++) {
            last = any_place(&seed, last);
            const float own = (float)test_random(&seed), further = (float)test_random(&seed);
            HitLight light = {.original = {0, further, 0, 0}};
            light.c[0] = (Float4){0, own, 0, 0};
            FirstHit q = {.uv = {last.u, last.v}, .light = &light, .albedo = {0.5f, 0.25f, 1, 0}};
            q.sharp = test_random(&seed) < 0.4, q.weight = 0.1 + test_random(&seed);
            clusters_add(&target, &q, &params);
            all.squares += q.weight * q.weight, all.light += own, all.interreflected += further;
            all.reflected += 0.25 * (own + 1e-3 * further); /* interreflected light says little of the albedo */
        }
        clusters_merge_broad(&target, 0, &params, 1, PLACES);
        add_kept(&kept, &target.sharp);
        add_kept(&kept, &target.broad);
        assert_true(fabs(kept.squares / all.squares - 1) < 1e-9);
        assert_true(fabs(kept.light / all.light - 1) < 1e-4);
        assert_true(fabs(kept.interreflected / all.interreflected - 1) < 1e-4);
        assert_true(fabs(kept.reflected / all.reflected - 1) < 1e-4);
    }
}

static void clusters_are_those_of_all_pairs(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 120; round++) {
        TargetClusters target = {.interreflections_bound = 0};
        Places kinds[2] = {{.count = 0}, {.count = 0}};
        FilmParams params = {.sharp = 1 + (int)round % 4, .broad = 1 + (int)round % 3};
        uint32_t seed = round + 1;
        Vec2 last = {0, 0};
        params.clusters = params.sharp + params.broad - (int)(round % 2);
        params.clusters = params.clusters < 2 ? 2 : params.clusters;
        params.periodic[0][0] = round % 5 == 4, params.periodic[0][1] = round % 10 == 4;
        for (int n = 0; n < PLACES; n++) {
            last = any_place(&seed, last);
            const HitLight dark = {.used = 0};
            FirstHit q = {.uv = {last.u, last.v}, .light = &dark};
            q.sharp = test_random(&seed) < 0.4, q.weight = 1e-3 + pow(test_random(&seed), 8) * 50;
            clusters_add(&target, &q, &params);
            add_place(kinds, 0, &q, &params);
            expect_same(&target.sharp, &kinds[0]);
            expect_same(&target.broad, &kinds[1]);
        }
    }
}

/* Down to so many, the cheapest pair first. Returns the cost of the next merging. */
static double merge_places(Places *places, int most, double limit, const int periodic[2])
{
    for (;;) {
        Best best = {.cost = INFINITY};
        find_pair(&best, places, 2, periodic);
        if (places->count <= most || best.cost > limit)
            return best.cost;
        retex_uv_stats_merge(&places->of[best.a], &places->of[best.b], periodic);
        places->of[best.b] = places->of[--places->count];
    }
}

/* Places of a pixel of which some light is direct, if `direct`, and some is not, from path `bent` on. */
static void add_seen(TargetClusters *target, Places kinds[2], uint32_t round, const FilmParams *params, int direct,
                     int bent)
{
    const HitLight dark = {.used = 0};
    uint32_t seed = round + 1;
    Vec2 last = {0, 0};
    int extra = 0;
    for (int n = 0; n < PLACES; n++) {
        last = any_place(&seed, last);
        FirstHit q = {.uv = {last.u, last.v}, .light = &dark};
        q.sharp = test_random(&seed) < 0.8, q.weight = 1e-3 + pow(test_random(&seed), 8) * 50;
        q.direct = n < bent || (direct && test_random(&seed) < 0.5);
        if (q.sharp && !q.direct)
            extra = params->extra;
        clusters_add(target, &q, params);
        add_place(kinds, extra, &q, params);
        expect_same(&target->sharp, &kinds[0]);
        expect_same(&target->broad, &kinds[1]);
    }
}

/* Where mirrors or glass show a target there are extra clusters, once they do; at the end those merge that matter
 * little. */
static void extra_clusters_are_those_that_matter(void **state)
{
    (void)state;
    int stopped = 0, counts[FILM_CLUSTERS_MAX + 1] = {0};
    for (uint32_t round = 0; round < 120; round++) {
        TargetClusters target = {.interreflections_bound = 0};
        Places kinds[2] = {{.count = 0}, {.count = 0}};
        FilmParams params = {.sharp = 4, .broad = 2, .clusters = 6, .extra = 8};
        params.periodic[0][0] = round % 5 == 4, params.periodic[0][1] = round % 10 == 4;
        add_seen(&target, kinds, round, &params, round % 2, round % 3 ? 0 : 50);
        assert_int_equal(target.sharp.count, 12);
        double light = 1;
        for (int k = 0; k < 12; k++)
            light += target.sharp.of[k].uv.weight * pow(4, round % 7);
        clusters_merge_extra(&target, 0, &params, light);
        const double limit = pow(0.02 * light, 2);
        stopped += merge_places(&kinds[0], params.sharp, limit, params.periodic[0]) > limit;
        expect_same(&target.sharp, &kinds[0]);
        expect_same(&target.broad, &kinds[1]);
        counts[target.sharp.count]++;
    }
    assert_true(stopped > 20 && counts[4] > 20 && counts[12] > 0 && counts[4] + counts[12] < 110);
}

/* What is seen directly, or found after wide scattering, has no extra clusters. */
static void direct_light_has_no_extra_clusters(void **state)
{
    (void)state;
    TargetClusters target = {.interreflections_bound = 0};
    Places kinds[2] = {{.count = 0}, {.count = 0}};
    const FilmParams params = {.sharp = 4, .broad = 2, .clusters = 6, .extra = 8};
    add_seen(&target, kinds, 0, &params, 1, PLACES);
    assert_int_equal(target.sharp.count, 4);
    assert_int_equal(target.broad.count, 6);
    clusters_merge_broad(&target, 0, &params, 1, PLACES);
    assert_int_equal(target.broad.count, 2);
}

/* A wave of a texture, as a Gaussian place sees it, times the place's light: from a place near it. */
static void add_wave(double sum[2], double light, const RetexUvStats *a, const RetexUvStats *from, const double wave[2],
                     const int periodic[2])
{
    const double u = retex_uv_stats_difference(a->mean[0], from->mean[0], periodic[0]);
    const double v = retex_uv_stats_difference(a->mean[1], from->mean[1], periodic[1]);
    const double phase = wave[0] * u + wave[1] * v;
    const double m2 = wave[0] * wave[0] * a->m2[0] + 2 * wave[0] * wave[1] * a->m2[1] + wave[1] * wave[1] * a->m2[2];
    const double seen = light * exp(-m2 / a->weight / 2);
    sum[0] += seen * cos(phase), sum[1] += seen * sin(phase);
}

/* How far the light of two places changes, squared, if they are merged: wave by wave, of a texture with features of
 * a size, whose power is a Gaussian of the wave number. */
static double waves_error2(const RetexUvStats *a, const RetexUvStats *b, double feature, const int periodic[2])
{
    const int waves = (int)(6 / feature); /* beyond, there is hardly power */
    const double step = 0.9;              /* its period, 7 units, is beyond all places */
    RetexUvStats both = *a;
    double error2 = 0, power = 0;
    retex_uv_stats_merge(&both, b, periodic);
    for (int i = 0; i <= waves; i++) /* the other half is alike */
        for (int k = i ? -waves : 0; k <= waves; k++) {
            const double wave[2] = {i * step, k * step};
            const double s = exp(-feature * feature * (wave[0] * wave[0] + wave[1] * wave[1]) / 2) * (i || k ? 2 : 1);
            double sum[2] = {0, 0};
            add_wave(sum, a->weight, a, a, wave, periodic);
            add_wave(sum, b->weight, b, a, wave, periodic);
            add_wave(sum, -both.weight, &both, a, wave, periodic);
            error2 += s * (sum[0] * sum[0] + sum[1] * sum[1]), power += s;
        }
    return error2 / power;
}

/* How places of a pixel merge when it is complete. */
typedef struct Merging {
    int least, most;        /* so many remain: more than the least only where merging them changes more than `hidden` */
    double feature, hidden; /* hidden: squared */
} Merging;

/* The variance of a sum of so many paths' light. */
static double variance_of_sum(const double *weights, int count, int paths)
{
    double sum = 0, variance = 0;
    for (int k = 0; k < count; k++)
        sum += weights[k];
    for (int k = 0; k < paths; k++)
        variance += pow((k < count ? weights[k] : 0) - sum / paths, 2);
    return variance;
}

/* Those first that a fine texture tells apart least. */
static void merge_by_waves(Places *places, const Merging *m, const int periodic[2])
{
    while (places->count > m->least) {
        Best best = {.cost = INFINITY};
        for (int i = 0; i < places->count; i++)
            for (int k = i + 1; k < places->count; k++) {
                const double cost = waves_error2(&places->of[i], &places->of[k], m->feature, periodic);
                if (cost < best.cost)
                    best = (Best){places, i, k, cost};
            }
        if (places->count <= m->most && best.cost > m->hidden)
            return;
        retex_uv_stats_merge(&places->of[best.a], &places->of[best.b], periodic);
        places->of[best.b] = places->of[--places->count];
    }
}

/* At the end, broad places merge by what a fine texture would change by that; extra ones remain where that is more than
 * a fiftieth of the pixel's light and the noise. */
static void broad_clusters_are_those_that_matter(void **state)
{
    (void)state;
    int counts[FILM_CLUSTERS_MAX + 1] = {0};
    for (uint32_t round = 0; round < 60; round++) {
        TargetClusters target = {.interreflections_bound = 0};
        const HitLight dark = {.used = 0};
        const int broad = 1 + (int)round % 2, paths = 6 + (int)round / 3 * (1 + 40 * (int)(round % 4 == 3));
        FilmParams params = {.sharp = 1, .broad = broad, .clusters = 1 + broad, .extra_broad = (int)round % 3};
        const int *periodic = params.periodic[0];
        uint32_t seed = round + 1;
        Vec2 last = {0, 0};
        double weights[64];
        params.periodic[0][0] = round % 5 == 4, params.periodic[0][1] = round % 10 == 4;
        const int hits = paths < 46 ? paths : 46;
        for (int n = 0; n < hits; n++) {
            last = any_place(&seed, last);
            weights[n] = 0.6 + 0.4 * test_random(&seed);
            FirstHit q = {.uv = {last.u, last.v}, .light = &dark, .weight = weights[n]};
            clusters_add(&target, &q, &params);
        }
        Places places = {.count = target.broad.count};
        assert_int_equal(places.count, broad + 4);
        for (int k = 0; k < places.count; k++)
            places.of[k] = target.broad.of[k].uv;
        const double light = pow(4, round % 5);
        const Merging merging = {broad, broad + params.extra_broad, 0.05,
                                 pow(0.02 * light, 2) + variance_of_sum(weights, hits, paths)};
        merge_by_waves(&places, &merging, periodic);
        clusters_merge_broad(&target, 0, &params, light, paths);
        expect_same(&target.broad, &places);
        counts[places.count - broad] += params.extra_broad == 2;
    }
    assert_true(counts[0] > 2 && counts[1] > 0 && counts[2] > 2 && counts[0] + counts[1] + counts[2] == 20);
}

/* Two wide clusters on a line far away, where a variance is a small difference of large numbers, and a point. */
static void far_broad_clusters_merge(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int round = 0; round < 200; round++) {
        const FilmParams params = {.sharp = 1, .broad = 2, .clusters = 3};
        const double size = pow(10, 12 * test_random(&seed)), slope = test_random(&seed);
        TargetClusters target = {.broad = {.count = 3, .changed = 7}};
        target.broad.of[0].uv = (RetexUvStats){.weight = 2};
        for (int k = 1; k < 3; k++) {
            RetexUvStats *uv = &target.broad.of[k].uv;
            retex_uv_stats_add(uv, 1, (double[2]){(k - 1) * size, (k - 1) * slope * size}, params.periodic[0]);
            retex_uv_stats_add(uv, 1, (double[2]){k * size, k * slope * size}, params.periodic[0]);
        }
        clusters_merge_broad(&target, 0, &params, 1, 8);
        assert_int_equal(target.broad.count, 2);
        assert_true(target.broad.of[0].uv.m2[0] == 0);
    }
}

/* As many as there may be are gathered no further than arrays reach; where kinds share a number, no more than that. */
static void broad_clusters_are_bounded(void **state)
{
    (void)state;
    static const FilmParams params[] = {{.sharp = 1, .broad = 15, .clusters = 16},
                                        {.sharp = 2, .broad = 14, .clusters = 16},
                                        {.sharp = 3, .broad = 3, .clusters = 3}};
    static const int gathered[] = {16, 16, 3};
    for (int k = 0; k < 3; k++) {
        TargetClusters target = {.interreflections_bound = 0};
        const HitLight dark = {.used = 0};
        for (int n = 0; n < 40; n++) {
            FirstHit q = {.uv = {n * 0.1, 0}, .light = &dark, .weight = 1};
            clusters_add(&target, &q, &params[k]);
        }
        assert_int_equal(target.broad.count, gathered[k]);
        clusters_merge_broad(&target, 0, &params[k], 1, 40);
        assert_int_equal(target.broad.count, params[k].broad);
    }
}

/* No two interreflections cost less to merge than the bound, but for rounding; while more fit, there is none. */
static void expect_bound(const TargetClusters *target, const int periodic[2])
{
    const InterreflectionCluster *c = target->interreflections;
    double least = c[INTERREFLECTION_GATHERED - 1].uv.weight > 0 ? INFINITY : -INFINITY;
    for (int i = 0; i < INTERREFLECTION_GATHERED; i++)
        for (int k = i + 1; k < INTERREFLECTION_GATHERED && least > -INFINITY; k++)
            least = fmin(least, retex_uv_stats_variation_gain(&c[i].uv, &c[k].uv, periodic));
    assert_true(target->interreflections_bound <= least + 1e-12);
}

static void further_hits_are_pooled_alike(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 60; round++) {
        const int periodic[2] = {round % 4 == 3, round % 8 == 3};
        TargetClusters target = {.interreflections_bound = 0};
        RetexUvStats clusters[INTERREFLECTION_GATHERED] = {{.weight = 0}, {.weight = 0}};
        uint32_t seed = round + 1;
        Vec2 last = {0, 0};
        for (int n = 0; n < PLACES; n++) {
            last = any_place(&seed, last);
            const Interreflection l = {.uv = {last.u, last.v}, .weight = 1e-3 + pow(test_random(&seed), 8) * 50};
            clusters_add_interreflection(&target, &l, periodic);
            add_interreflection(clusters, &l, periodic);
            for (int k = 0; k < INTERREFLECTION_GATHERED; k++)
                assert_memory_equal(&target.interreflections[k].uv, &clusters[k], sizeof clusters[k]);
            expect_bound(&target, periodic);
        }
    }
}

/* At the end, interreflections merge as broad places do, by coarser features and a smaller part of the pixel's light,
 * from as many as there are; their light is kept. */
static void interreflections_are_those_that_matter(void **state)
{
    (void)state;
    int gathered[INTERREFLECTION_GATHERED + 1] = {0}, counts[5] = {0};
    for (uint32_t round = 0; round < 60; round++) {
        TargetClusters target = {.interreflections_bound = 0};
        FilmParams params = {.sharp = 1, .broad = 1, .clusters = 2, .extra_interreflections = (int)round % 3};
        const int *periodic = params.periodic[0], hits = 1 + (int)(round % 10 * (1 + round % 4));
        const int paths = hits + hits / 8;
        Places places = {.count = 0};
        uint32_t seed = round + 1;
        Vec2 last = {0, 0};
        double squares = 0, weights[64];
        float light = 0;
        params.periodic[0][0] = round % 5 == 4, params.periodic[0][1] = round % 10 == 4;
        for (int n = 0; n < hits; n++) {
            last = any_place(&seed, last);
            const float own = (float)test_random(&seed);
            const Interreflection l = {.uv = {last.u, last.v},
                                       .weight = 0.6 + 0.4 * test_random(&seed),
                                       .light = {0, own, 0, 0},
                                       .albedo = {0.5f, 0.25f, 1, 0}};
            clusters_add_interreflection(&target, &l, periodic);
            weights[n] = l.weight, squares += l.weight * l.weight, light += own;
        }
        for (; places.count < INTERREFLECTION_GATHERED; places.count++) {
            const RetexUvStats *uv = &target.interreflections[places.count].uv;
            if (!(uv->weight > 0))
                break;
            places.of[places.count] = *uv;
        }
        gathered[places.count]++;
        const double all = pow(8, round % 5);
        const Merging merging = {2, 2 + params.extra_interreflections, 0.1,
                                 pow(0.007 * all, 2) + variance_of_sum(weights, hits, paths)};
        merge_by_waves(&places, &merging, periodic);
        clusters_merge_interreflections(&target, 0, &params, all, paths);
        for (int k = 0; k < INTERREFLECTION_GATHERED; k++) {
            const InterreflectionCluster *c = &target.interreflections[k];
            assert_memory_equal(&c->uv, &places.of[k], k < places.count ? sizeof c->uv : 0);
            assert_true((c->uv.weight > 0) == (k < places.count));
            squares -= c->squares, light -= c->albedo.light[1];
            assert_true(fabsf(c->albedo.reflected[1] - 0.25f * c->albedo.light[1]) < 1e-5f);
        }
        assert_true(fabs(squares) < 1e-9 && fabsf(light) < 1e-4f);
        counts[places.count] += params.extra_interreflections == 2;
    }
    assert_true(gathered[1] > 0 && gathered[2] > 0 && gathered[INTERREFLECTION_GATHERED] > 20);
    assert_true(counts[2] > 2 && counts[3] > 0 && counts[4] > 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(clusters_are_those_of_all_pairs),
                                       cmocka_unit_test(extra_clusters_are_those_that_matter),
                                       cmocka_unit_test(direct_light_has_no_extra_clusters),
                                       cmocka_unit_test(nothing_is_lost_by_merging),
                                       cmocka_unit_test(further_hits_are_pooled_alike),
                                       cmocka_unit_test(broad_clusters_are_those_that_matter),
                                       cmocka_unit_test(far_broad_clusters_merge),
                                       cmocka_unit_test(broad_clusters_are_bounded),
                                       cmocka_unit_test(interreflections_are_those_that_matter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
