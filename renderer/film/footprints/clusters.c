/* Few clusters for all hits of a pixel: the pair that costs the least merges. See footprints.h.
 *
 * The cheapest pair is looked for at nearly every path. Nearly always a new hit joins a cluster at a low cost, while
 * merging two clusters would cost much. So there is a lower bound of the cost of merging any two clusters, and their
 * costs are computed only where the bound is below the cost of joining. With f(C) for what a texture varies within a
 * cluster (retex/host/uv_stats.h), or for what light may change by that (light_error2), merging a with k costs
 * f(ak) - f(a) - f(k). A hit x that joins a cannot make f(ak) less, and makes f(a) more by exactly what joining cost:
 * f(axk) - f(ax) - f(k) >= f(ak) - f(a) - f(k) - (f(ax) - f(a)). So the bound falls by the cost of joining. There is no
 * bound for UV that close (periodic), as distances there may go either way round. Costs of pairs are kept until one of
 * the two changes.
 *
 * While paths end, broad clusters and interreflections merge by features of half a unit of UV, as it is not yet known
 * which of them are narrow. So more are gathered than are kept; the last mergings, when the pixel is complete, go by
 * fine features. */
#include <math.h>
#include <retex/host/assert.h>
#include "film/footprints/pixel.h"
#include "film/footprints/places.h"

#define ROUNDING 1e-9     /* of bounds */
#define FINE_FEATURE 0.05 /* distance in UV over which textures change that need good clusters */
#define EXTRA_ERROR 0.02  /* of a pixel's light: what it may be expected to change by one merging of them */

/* The same of broad clusters and of interreflections. Of the latter less shows, as they are seen in the mixture of a
 * kind's clusters: so they are judged by coarser features, and several small errors count. Smaller limits, or more
 * clusters than these allow, made sets larger and pictures hardly better. */
#define BROAD_ERROR 0.02
#define INTERREFLECTION_ERROR 0.007
#define INTERREFLECTION_FEATURE 0.1

static void merge_albedo(AlbedoSums *into, const AlbedoSums *from)
{
    into->light += from->light, into->reflected += from->reflected;
}

/* The lower bound of merging two clusters, after a hit joined one of them at a cost of `spent`. */
static double lowered_bound(double bound, double spent, const int periodic[2])
{
    return periodic[0] || periodic[1] ? -INFINITY : (bound - spent) * (1 - ROUNDING);
}

/* ---- interreflections ---- */

static void merge_interreflections(InterreflectionCluster *into, const InterreflectionCluster *from,
                                   const int periodic[2])
{
    retex_uv_stats_merge(&into->uv, &from->uv, periodic);
    into->varies = retex_uv_stats_variation(&into->uv);
    into->squares += from->squares;
    merge_albedo(&into->albedo, &from->albedo);
}

/* What it costs to merge two of them, as retex_uv_stats_variation_gain. */
static double merge_interreflections_cost(const InterreflectionCluster *a, const InterreflectionCluster *b,
                                          const int periodic[2])
{
    return retex_uv_stats_merged_variation(&a->uv, b->uv.weight, b->uv.mean, b->uv.m2[0] + b->uv.m2[2], periodic) -
           a->varies - b->varies;
}

/* The two of a pixel's interreflections, when it has as many as it may gather, that cost the least to merge. Returns
 * the cost. */
static double find_interreflections(TargetClusters *target, const int periodic[2], int *a, int *b)
{
    const InterreflectionCluster *clusters = target->interreflections;
    const unsigned changed = target->interreflections_changed;
    double least = INFINITY;
    for (int i = 0; i < INTERREFLECTION_GATHERED; i++)
        for (int k = i + 1; k < INTERREFLECTION_GATHERED; k++) {
            double *cost = &target->interreflections_costs[i][k];
            if ((changed >> i | changed >> k) & 1)
                *cost = merge_interreflections_cost(&clusters[i], &clusters[k], periodic);
            if (*cost < least)
                least = *cost, *a = i, *b = k;
        }
    target->interreflections_changed = 0;
    return least;
}

void clusters_add_interreflection(TargetClusters *target, const Interreflection *l, const int periodic[2])
{
    const InterreflectionCluster one = {.uv = {l->weight, {l->uv[0], l->uv[1]}, {0, 0, 0}},
                                        .squares = l->weight * l->weight,
                                        .albedo = {l->light, l->light * l->albedo}};
    InterreflectionCluster *clusters = target->interreflections;
    double gain[INTERREFLECTION_GATHERED];
    int nearest = 0, a = 0, b = 1;
    for (int k = 0; k < INTERREFLECTION_GATHERED; k++) {
        if (clusters[k].uv.weight == 0) {
            clusters[k] = one;
            target->interreflections_bound = -INFINITY;
            target->interreflections_changed |= 1u << k;
            return;
        }
        gain[k] = retex_uv_stats_merged_variation(&clusters[k].uv, l->weight, l->uv, 0, periodic) - clusters[k].varies;
        if (gain[k] <= 0) {
            merge_interreflections(&clusters[k], &one, periodic);
            target->interreflections_changed |= 1u << k;
            return;
        }
        nearest = gain[k] < gain[nearest] ? k : nearest;
    }
    if (target->interreflections_bound <= gain[nearest])
        target->interreflections_bound = find_interreflections(target, periodic, &a, &b);
    if (target->interreflections_bound < gain[nearest]) {
        merge_interreflections(&clusters[a], &clusters[b], periodic);
        clusters[b] = one;
        target->interreflections_bound = -INFINITY;
        target->interreflections_changed |= 1u << a | 1u << b;
    } else {
        merge_interreflections(&clusters[nearest], &one, periodic);
        target->interreflections_changed |= 1u << nearest;
        target->interreflections_bound = lowered_bound(target->interreflections_bound, gain[nearest], periodic);
    }
}

/* ---- first hits ---- */

/* What merging costs: of sharp places, of sharp ones where mirrors or glass show some, of broad ones. */
typedef enum Rule { RULE_WARD, RULE_LIGHT, RULE_VARIATION } Rule;

/* Whether clusters of interreflections stand before those that are not used, which have no weight. */
static int are_first(const InterreflectionCluster *clusters)
{
    for (int k = 1; k < INTERREFLECTION_GATHERED; k++)
        if (clusters[k].uv.weight > 0 && !(clusters[k - 1].uv.weight > 0))
            return 0;
    return 1;
}

static Clusters *clusters_of(TargetClusters *target, int sharp)
{
    return sharp ? &target->sharp : &target->broad;
}

static Rule rule_of(const TargetClusters *target, int sharp)
{
    return !sharp ? RULE_VARIATION : target->specular ? RULE_LIGHT : RULE_WARD;
}

/* By how much light is expected to change, squared, if its places are one cluster: its weight times the variation of a
 * fine texture. So what matters is told apart; much that is far away and dim is one place. */
static double light_error2(double weight, double squares)
{
    return weight * weight * squares / (squares + weight * FINE_FEATURE * FINE_FEATURE);
}

static void update_variation(Cluster *cluster, Rule rule)
{
    const RetexUvStats *uv = &cluster->uv;
    cluster->varies =
        rule == RULE_LIGHT ? light_error2(uv->weight, uv->m2[0] + uv->m2[2]) : retex_uv_stats_variation(uv);
}

static void merge_cluster(Cluster *into, const Cluster *from, Rule rule, const int periodic[2])
{
    retex_uv_stats_merge(&into->uv, &from->uv, periodic);
    update_variation(into, rule);
    merge_albedo(&into->albedo, &from->albedo);
    into->squares += from->squares;
    into->c += from->c;
    into->interreflected += from->interreflected;
}

static void merge_clusters(Clusters *clusters, int into, int from, Rule rule, const int periodic[2])
{
    merge_cluster(&clusters->of[into], &clusters->of[from], rule, periodic);
    if (clusters->rest[from].uv.weight > 0 && clusters->rest[into].uv.weight > 0)
        merge_cluster(&clusters->rest[into], &clusters->rest[from], rule, periodic);
    else if (clusters->rest[from].uv.weight > 0)
        clusters->rest[into] = clusters->rest[from];
}

static void move_cluster(Clusters *clusters, int to, int from)
{
    clusters->of[to] = clusters->of[from];
    clusters->rest[to].uv.weight = 0;
    if (clusters->rest[from].uv.weight > 0)
        clusters->rest[to] = clusters->rest[from];
}

void clusters_keep_rest(Clusters *clusters)
{
    int count = 0;
    for (int k = 0; k < clusters->count; k++)
        if (clusters->rest[k].uv.weight > 0)
            clusters->of[count++] = clusters->rest[k];
    clusters->count = count;
}

static void add_to_cluster(Cluster *into, const FirstHit *q, Rule rule, const int periodic[2])
{
    const HitLight *l = q->light;
    retex_uv_stats_add(&into->uv, q->weight, q->uv, periodic);
    update_variation(into, rule);
    add_hit_albedo(&into->albedo, q);
    into->squares += q->weight * q->weight;
    into->c += l->c[0];
    into->interreflected += l->original;
}

static void add_first_hit(Clusters *clusters, int k, const FirstHit *q, Rule rule, const int periodic[2])
{
    add_to_cluster(&clusters->of[k], q, rule, periodic);
    if (!q->is_rest)
        return;
    if (!(clusters->rest[k].uv.weight > 0))
        clusters->rest[k] = (Cluster){.squares = 0};
    add_to_cluster(&clusters->rest[k], q, rule, periodic);
}

static void start_cluster(Clusters *clusters, int k, const FirstHit *q, Rule rule, const int periodic[2])
{
    RETEX_ASSERT(k < FILM_CLUSTERS_MAX);
    clusters->of[k] = (Cluster){.squares = 0};
    clusters->rest[k].uv.weight = 0;
    add_first_hit(clusters, k, q, rule, periodic);
}

/* Two clusters of one kind, or a cluster and the hit that is to be added (b = -1). */
typedef struct Pair {
    Clusters *clusters;
    Rule rule;
    int a, b;
    double cost;
} Pair;

static double merge_cost(const Cluster *a, const Cluster *b, Rule rule, const int periodic[2])
{
    const double spread = b->uv.m2[0] + b->uv.m2[2], apart = a->varies + b->varies;
    if (rule == RULE_VARIATION)
        return retex_uv_stats_merged_variation(&a->uv, b->uv.weight, b->uv.mean, spread, periodic) - apart;
    const double ward = retex_uv_stats_point_ward(&a->uv, b->uv.weight, b->uv.mean, periodic);
    if (rule == RULE_WARD)
        return ward / (RETEX_UV_FEATURE * RETEX_UV_FEATURE);
    return light_error2(a->uv.weight + b->uv.weight, a->uv.m2[0] + a->uv.m2[2] + spread + ward) - apart;
}

/* The cost of adding a hit to a cluster. */
static double join_cost(const Cluster *a, const FirstHit *q, Rule rule, const int periodic[2])
{
    if (rule == RULE_VARIATION)
        return retex_uv_stats_merged_variation(&a->uv, q->weight, q->uv, 0, periodic) - a->varies;
    const double ward = retex_uv_stats_point_ward(&a->uv, q->weight, q->uv, periodic);
    if (rule == RULE_WARD)
        return ward / (RETEX_UV_FEATURE * RETEX_UV_FEATURE);
    return light_error2(a->uv.weight + q->weight, a->uv.m2[0] + a->uv.m2[2] + ward) - a->varies;
}

/* Compute the costs of merging those clusters that have changed with all others. */
static void update_costs(Clusters *clusters, Rule rule, const int periodic[2])
{
    const Cluster *of = clusters->of;
    for (unsigned left = clusters->changed & ((1u << clusters->count) - 1); left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        for (int i = 0; i < k; i++)
            clusters->costs[i][k] = merge_cost(&of[i], &of[k], rule, periodic);
        for (int i = k + 1; i < clusters->count; i++)
            clusters->costs[k][i] = merge_cost(&of[k], &of[i], rule, periodic);
    }
    clusters->changed = 0;
}

/* Look among the clusters for a pair that is cheaper than the best so far. */
static void find_pair(Pair *best, Clusters *clusters, Rule rule, const int periodic[2])
{
    double least = INFINITY;
    int a = 0, b = 0;
    update_costs(clusters, rule, periodic);
    for (int i = 0; i < clusters->count; i++)
        for (int k = i + 1; k < clusters->count; k++)
            if (clusters->costs[i][k] < least)
                least = clusters->costs[i][k], a = i, b = k;
    clusters->merge_bound = least;
    if (least < best->cost)
        *best = (Pair){clusters, rule, a, b, least};
}

static void mark_changed(Clusters *clusters, int k)
{
    clusters->changed |= 1u << k;
}

/* The cheapest way to add a hit: join a cluster, or merge two of either kind; but only two of its own kind, where that
 * kind has as many as it may have. */
static Pair find_cheapest(TargetClusters *target, int own_is_full, const FirstHit *q, const int periodic[2])
{
    Clusters *own = clusters_of(target, q->sharp), *other = clusters_of(target, !q->sharp);
    const Rule rule = rule_of(target, q->sharp), others_rule = rule_of(target, !q->sharp);
    Pair best = own->count ? (Pair){own, rule, 0, -1, INFINITY} : (Pair){other, others_rule, 0, 1, INFINITY};
    for (int i = 0; i < own->count; i++) {
        double cost = join_cost(&own->of[i], q, rule, periodic);
        if (cost < best.cost)
            best = (Pair){own, rule, i, -1, cost};
    }
    if (!(own->merge_bound > best.cost))
        find_pair(&best, own, rule, periodic);
    if (!own_is_full && !(other->merge_bound > best.cost))
        find_pair(&best, other, others_rule, periodic);
    return best;
}

/* Merge two clusters; the last one takes the place of the second. */
static void merge_pair(const Pair *pair, const int periodic[2])
{
    Clusters *clusters = pair->clusters;
    RETEX_ASSERT(pair->a < pair->b && pair->b < clusters->count); /* so the last one is not `a`, which remains */
    merge_clusters(clusters, pair->a, pair->b, pair->rule, periodic);
    if (pair->b != --clusters->count)
        move_cluster(clusters, pair->b, clusters->count);
    clusters->merge_bound = -INFINITY;
    mark_changed(clusters, pair->a), mark_changed(clusters, pair->b);
}

static void add_cluster(Clusters *clusters, const FirstHit *q, Rule rule, const int periodic[2])
{
    start_cluster(clusters, clusters->count, q, rule, periodic);
    mark_changed(clusters, clusters->count++);
    clusters->merge_bound = -INFINITY;
}

/* Add a hit where there are as many clusters as there may be. */
static void merge_cheapest(TargetClusters *target, int own_is_full, const FirstHit *q, const int periodic[2])
{
    Clusters *own = clusters_of(target, q->sharp);
    const Rule rule = rule_of(target, q->sharp);
    Pair best = find_cheapest(target, own_is_full, q, periodic);
    if (best.b < 0) {
        add_first_hit(own, best.a, q, rule, periodic);
        mark_changed(own, best.a);
        own->merge_bound = lowered_bound(own->merge_bound, best.cost, periodic);
        return;
    }
    if (best.clusters == own) {
        merge_clusters(own, best.a, best.b, rule, periodic);
        start_cluster(own, best.b, q, rule, periodic);
        mark_changed(own, best.a), mark_changed(own, best.b);
        own->merge_bound = -INFINITY;
    } else {
        merge_pair(&best, periodic);
        add_cluster(own, q, rule, periodic);
    }
}

/* Mirrors or glass show the target: from now on there may be extra clusters, by another rule. The hit that shows it is
 * the first of them. */
static void become_specular(TargetClusters *target)
{
    Clusters *sharp = &target->sharp;
    target->specular = 1;
    for (int k = 0; k < sharp->count; k++)
        update_variation(&sharp->of[k], RULE_LIGHT), mark_changed(sharp, k);
}

void clusters_add(TargetClusters *target, const FirstHit *q, const FilmParams *params)
{
    Clusters *own = clusters_of(target, q->sharp);
    const int *periodic = params->periodic[q->target];
    if (q->sharp && !q->direct && params->extra && !target->specular)
        become_specular(target);
    const int extra = target->specular ? params->extra : 0, broad = most_gathered_broad(params);
    const int most = q->sharp ? params->sharp + extra : broad, all = params->clusters + extra + broad - params->broad;
    own->used |= q->light->used;
    for (unsigned left = q->light->used; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        own->interreflected[i] += q->light->c[i];
    }
    RETEX_ASSERT(own->count <= most && target->sharp.count + target->broad.count <= all);
    RETEX_ASSERT(!(q->light->used & 1)); /* [0] stays empty: it is light of the clusters themselves */
    if (own->count < most && target->sharp.count + target->broad.count < all)
        add_cluster(own, q, rule_of(target, q->sharp), periodic);
    else
        merge_cheapest(target, own->count == most, q, periodic);
}

void clusters_merge_extra(TargetClusters *target, int t, const FilmParams *params, double light)
{
    Clusters *sharp = &target->sharp;
    const int *periodic = params->periodic[t];
    while (sharp->count > params->sharp) {
        Pair best = {sharp, RULE_LIGHT, 0, 1, INFINITY};
        find_pair(&best, sharp, RULE_LIGHT, periodic);
        if (best.cost > EXTRA_ERROR * EXTRA_ERROR * light * light)
            return;
        merge_pair(&best, periodic);
    }
}

/* ---- broad clusters and interreflections of a pixel that is complete ---- */

/* Few places of a pixel, which merge by what a texture with features of a size would change by that. */
typedef struct Places {
    const int *periodic;
    double feature;
    double weight, squares; /* of all paths: sums of weights and of their squares */
    int count;
    unsigned changed, moved; /* bits: places that are not as the arrays below were computed, and those of which only the
                                places after them are others */
    const RetexUvStats *of[FILM_CLUSTERS_MAX];
    double variance[FILM_CLUSTERS_MAX];                  /* light_variance */
    double error2[FILM_CLUSTERS_MAX][FILM_CLUSTERS_MAX]; /* of merging [i][k], i < k */
} Places;

static void add_place(Places *places, const RetexUvStats *uv, double squares)
{
    places->changed |= 1u << places->count;
    places->of[places->count++] = uv;
    places->weight += uv->weight, places->squares += squares;
}

/* Place b became a part of place a, and the last one took its index. Merging is rounded by the order of the two: what
 * is known of the last one stays known with those that are before it still. */
static void remove_place(Places *places, int a, int b)
{
    const int last = --places->count;
    RETEX_ASSERT(a < b && b <= last);
    places->changed |= 1u << a;
    if (b == last)
        return;
    places->moved |= 1u << b;
    places->variance[b] = places->variance[last];
    for (int i = 0; i < b; i++)
        places->error2[i][b] = places->error2[i][last];
}

/* How far the light of a place varies, squared, with such a texture. */
static double light_variance(const RetexUvStats *a, double feature)
{
    const double f = feature * feature, two = 2 / a->weight;
    return a->weight * a->weight * f / sqrt(places_determinant(a->m2[0] * two, a->m2[1] * two, a->m2[2] * two, f));
}

static void set_place(PlaceLanes *to, int lane, const Places *places, int k)
{
    const RetexUvStats *a = places->of[k];
    to->weight[lane] = a->weight, to->variance[lane] = places->variance[k];
    for (int i = 0; i < 2; i++)
        to->mean[i][lane] = a->mean[i];
    for (int i = 0; i < 3; i++)
        to->m2[i][lane] = a->m2[i], to->covariance[i][lane] = a->m2[i] / a->weight;
}

/* Of so many pairs, each to its place. Returns 0, the number that is left. */
static int compute_errors(const Places *places, PlacePairs *pairs, double *const *to, int count)
{
    if (count)
        place_pairs_errors(pairs, places->feature, places->periodic);
    for (int n = 0; n < count; n++)
        *to[n] = pairs->error2[n];
    return 0;
}

/* By how much light is expected to change, squared, if such a texture is seen by one cluster instead of two: of pairs
 * of which a place has changed. */
static void update_errors(Places *places)
{
    PlacePairs pairs = {.error2 = {0}};
    double *to[PLACE_LANES];
    int n = 0;
    for (int k = 0; k < places->count; k++) {
        if (places->changed >> k & 1)
            places->variance[k] = light_variance(places->of[k], places->feature);
        for (int i = 0; i < k; i++) {
            if (!((places->changed >> i | places->moved >> i | places->changed >> k) & 1))
                continue;
            set_place(&pairs.a, n, places, i), set_place(&pairs.b, n, places, k);
            to[n++] = &places->error2[i][k];
            if (n == PLACE_LANES)
                n = compute_errors(places, &pairs, to, n);
        }
    }
    compute_errors(places, &pairs, to, n);
    places->changed = places->moved = 0;
}

/* The two places that such a texture tells apart least. Returns what merging them changes, squared. */
static double find_least_different(Places *places, int *a, int *b)
{
    double least = INFINITY;
    update_errors(places);
    *a = 0, *b = 1;
    for (int i = 0; i < places->count; i++)
        for (int k = i + 1; k < places->count; k++)
            if (places->error2[i][k] < least)
                least = places->error2[i][k], *a = i, *b = k;
    return least;
}

/* By how much light may change, squared, and it is hardly seen: a part of the pixel's, and the noise that the light of
 * these places has as a sum over so many paths. */
static double hidden_error2(const Places *places, double part, double light, int spp)
{
    const double noise2 = places->squares - places->weight * places->weight / spp;
    return part * part * light * light + noise2;
}

void clusters_merge_broad(TargetClusters *target, int t, const FilmParams *params, double light, int spp)
{
    Clusters *broad = &target->broad;
    Places places = {.periodic = params->periodic[t], .feature = FINE_FEATURE};
    for (int k = 0; k < broad->count; k++)
        add_place(&places, &broad->of[k].uv, broad->of[k].squares);
    const double hidden = hidden_error2(&places, BROAD_ERROR, light, spp);
    while (places.count > params->broad) {
        Pair pair = {broad, RULE_VARIATION, 0, 1, 0};
        pair.cost = find_least_different(&places, &pair.a, &pair.b);
        if (pair.cost > hidden && places.count <= most_of_kind(params, 1))
            return;
        merge_pair(&pair, params->periodic[t]);
        remove_place(&places, pair.a, pair.b);
    }
}

void clusters_merge_interreflections(TargetClusters *target, int t, const FilmParams *params, double light, int spp)
{
    InterreflectionCluster *clusters = target->interreflections;
    RETEX_ASSERT(are_first(clusters));
    Places places = {.periodic = params->periodic[t], .feature = INTERREFLECTION_FEATURE};
    int a, b;
    while (places.count < INTERREFLECTION_GATHERED && clusters[places.count].uv.weight > 0)
        add_place(&places, &clusters[places.count].uv, clusters[places.count].squares);
    const double hidden = hidden_error2(&places, INTERREFLECTION_ERROR, light, spp);
    while (places.count > INTERREFLECTION_CLUSTERS) {
        const double error2 = find_least_different(&places, &a, &b);
        if (error2 > hidden && places.count <= INTERREFLECTION_CLUSTERS + params->extra_interreflections)
            return;
        merge_interreflections(&clusters[a], &clusters[b], params->periodic[t]);
        remove_place(&places, a, b);
        clusters[b] = clusters[places.count];
        clusters[places.count] = (InterreflectionCluster){.squares = 0};
    }
}
