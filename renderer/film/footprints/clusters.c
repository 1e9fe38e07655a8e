/* Few clusters for all hits of a pixel: the pair that costs the least merges. See footprints.h.
 *
 * The cheapest pair is looked for at nearly every path. Nearly always a new hit joins a cluster at a low cost, while
 * merging two clusters would cost much. So there is a lower bound of the cost of merging any two clusters, and their
 * costs are computed only where the bound is below the cost of joining. With f(C) for what a texture varies within a
 * cluster (retex/host/uv_stats.h), merging a with k costs f(ak) - f(a) - f(k). A hit x that joins a cannot make ak vary
 * less, and makes a vary more by exactly what joining cost: f(axk) - f(ax) - f(k) >= f(ak) - f(a) - f(k) -
 * (f(ax) - f(a)). So the bound falls by the cost of joining. There is no bound for UV that close (periodic), as
 * distances there may go either way round. */
#include <math.h>
#include "film/footprints/pixel.h"

#define ROUNDING 1e-9               /* of bounds */
#define EXTRA_FEATURE 0.05          /* distance in UV over which a texture changes that needs extra clusters */
#define EXTRA_ERROR 0.01            /* of a pixel's light: what it may be expected to change by one merging of them */
#define INTERREFLECTED_WEIGHT 1e-3f /* in a cluster's albedo, of light that goes on to targets */

static void add_albedo(AlbedoSums *sums, Float4 light, Float4 albedo)
{
    sums->light += light, sums->reflected += light * albedo;
}

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

void clusters_add_interreflection(TargetClusters *target, const Interreflection *l, const int periodic[2])
{
    const InterreflectionCluster one = {.uv = {l->weight, {l->uv[0], l->uv[1]}, {0, 0, 0}},
                                        .squares = l->weight * l->weight,
                                        .albedo = {l->light, l->light * l->albedo}};
    InterreflectionCluster *clusters = target->interreflections;
    double gain[INTERREFLECTION_CLUSTERS];
    for (int k = 0; k < INTERREFLECTION_CLUSTERS; k++) {
        if (clusters[k].uv.weight == 0) {
            clusters[k] = one;
            target->interreflections_bound = -INFINITY;
            return;
        }
        gain[k] = retex_uv_stats_merged_variation(&clusters[k].uv, l->weight, l->uv, 0, periodic) - clusters[k].varies;
        if (gain[k] <= 0) {
            merge_interreflections(&clusters[k], &one, periodic);
            return;
        }
    }
    int nearer = gain[1] < gain[0];
    if (target->interreflections_bound <= gain[nearer])
        target->interreflections_bound = retex_uv_stats_variation_gain(&clusters[0].uv, &clusters[1].uv, periodic);
    if (target->interreflections_bound < gain[nearer]) {
        merge_interreflections(&clusters[0], &clusters[1], periodic);
        clusters[1] = one;
        target->interreflections_bound = -INFINITY;
    } else {
        merge_interreflections(&clusters[nearer], &one, periodic);
        target->interreflections_bound = lowered_bound(target->interreflections_bound, gain[nearer], periodic);
    }
}

/* ---- first hits ---- */

static void merge_cluster(Cluster *into, const Cluster *from, const int periodic[2])
{
    retex_uv_stats_merge(&into->uv, &from->uv, periodic);
    into->varies = retex_uv_stats_variation(&into->uv);
    merge_albedo(&into->albedo, &from->albedo);
    into->squares += from->squares;
    into->c += from->c;
    into->interreflected += from->interreflected;
}

static void add_first_hit(Cluster *into, const FirstHit *q, const int periodic[2])
{
    const HitLight *l = q->light;
    retex_uv_stats_add(&into->uv, q->weight, q->uv, periodic);
    into->varies = retex_uv_stats_variation(&into->uv);
    /* the albedo is that of the cluster's own light; interreflected light counts where there is no other */
    add_albedo(&into->albedo, l->c[0] + l->original * splat(INTERREFLECTED_WEIGHT), q->albedo);
    into->squares += q->weight * q->weight;
    into->c += l->c[0];
    into->interreflected += l->original;
}

static void start_cluster(Cluster *cluster, const FirstHit *q, const int periodic[2])
{
    *cluster = (Cluster){.squares = 0};
    add_first_hit(cluster, q, periodic);
}

/* Two clusters of one kind, or a cluster and the hit that is to be added (b = -1). */
typedef struct Pair {
    Clusters *clusters;
    int a, b;
    double cost;
} Pair;

static double merge_cost(const Cluster *a, const Cluster *b, int sharp, const int periodic[2])
{
    if (sharp)
        return retex_uv_stats_ward(&a->uv, &b->uv, periodic) / (RETEX_UV_FEATURE * RETEX_UV_FEATURE);
    double squares = b->uv.m2[0] + b->uv.m2[2];
    return retex_uv_stats_merged_variation(&a->uv, b->uv.weight, b->uv.mean, squares, periodic) - a->varies - b->varies;
}

/* The cost of adding a hit to a cluster. */
static double join_cost(const Cluster *a, const FirstHit *q, const int periodic[2])
{
    return q->sharp
               ? retex_uv_stats_point_ward(&a->uv, q->weight, q->uv, periodic) / (RETEX_UV_FEATURE * RETEX_UV_FEATURE)
               : retex_uv_stats_merged_variation(&a->uv, q->weight, q->uv, 0, periodic) - a->varies;
}

/* Look among the clusters for a pair that is cheaper than the best so far. */
static void find_pair(Pair *best, Clusters *clusters, int sharp, const int periodic[2])
{
    clusters->merge_bound = INFINITY;
    for (int i = 0; i < clusters->count; i++)
        for (int k = i + 1; k < clusters->count; k++) {
            double cost = merge_cost(&clusters->of[i], &clusters->of[k], sharp, periodic);
            if (cost < best->cost)
                *best = (Pair){clusters, i, k, cost};
            if (cost < clusters->merge_bound)
                clusters->merge_bound = cost;
        }
}

/* The cheapest way to add a hit: join a cluster, or merge two of either kind; but only two of its own kind, where that
 * kind has as many as it may have. */
static Pair find_cheapest(Clusters *own, Clusters *other, int own_is_full, const FirstHit *q, const int periodic[2])
{
    Pair best = own->count ? (Pair){own, 0, -1, INFINITY} : (Pair){other, 0, 1, INFINITY};
    for (int i = 0; i < own->count; i++) {
        double cost = join_cost(&own->of[i], q, periodic);
        if (cost < best.cost)
            best = (Pair){own, i, -1, cost};
    }
    if (!(own->merge_bound > best.cost))
        find_pair(&best, own, q->sharp, periodic);
    if (!own_is_full && !(other->merge_bound > best.cost))
        find_pair(&best, other, !q->sharp, periodic);
    return best;
}

/* Merge two clusters; the last one takes the place of the second. */
static void merge_pair(const Pair *pair, const int periodic[2])
{
    Clusters *clusters = pair->clusters;
    merge_cluster(&clusters->of[pair->a], &clusters->of[pair->b], periodic);
    if (pair->b != --clusters->count)
        clusters->of[pair->b] = clusters->of[clusters->count];
    clusters->merge_bound = -INFINITY;
}

/* Add a hit where there are as many clusters as there may be. */
static void merge_cheapest(Clusters *own, Clusters *other, int own_is_full, const FirstHit *q, const int periodic[2])
{
    Pair best = find_cheapest(own, other, own_is_full, q, periodic);
    if (best.b < 0) {
        add_first_hit(&own->of[best.a], q, periodic);
        own->merge_bound = lowered_bound(own->merge_bound, best.cost, periodic);
        return;
    }
    own->merge_bound = -INFINITY;
    if (best.clusters == own) {
        merge_cluster(&own->of[best.a], &own->of[best.b], periodic);
        start_cluster(&own->of[best.b], q, periodic);
    } else {
        merge_pair(&best, periodic);
        start_cluster(&own->of[own->count++], q, periodic);
    }
}

void clusters_add(TargetClusters *target, const FirstHit *q, const FilmParams *params)
{
    Clusters *own = q->sharp ? &target->sharp : &target->broad, *other = q->sharp ? &target->broad : &target->sharp;
    target->specular |= q->sharp && !q->direct;
    int extra = target->specular ? params->extra : 0, most = q->sharp ? params->sharp + extra : params->broad;
    const int *periodic = params->periodic[q->target];
    own->used |= q->light->used;
    for (unsigned left = q->light->used; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        own->interreflected[i] += q->light->c[i];
    }
    if (own->count < most && own->count + other->count < params->clusters + extra) {
        start_cluster(&own->of[own->count++], q, periodic);
        own->merge_bound = -INFINITY;
    } else {
        merge_cheapest(own, other, own->count == most, q, periodic);
    }
}

/* ---- extra clusters ---- */

/* As retex_uv_stats_variation, of a texture with features of EXTRA_FEATURE. */
static double fine_variation(const RetexUvStats *a)
{
    double squares = a->m2[0] + a->m2[2];
    return a->weight * squares / (squares + a->weight * EXTRA_FEATURE * EXTRA_FEATURE);
}

/* By how much merging two is expected to change their light, squared. */
static double merge_error2(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2])
{
    RetexUvStats both = *a;
    retex_uv_stats_merge(&both, b, periodic);
    return both.weight * (fine_variation(&both) - fine_variation(a) - fine_variation(b));
}

void clusters_merge_extra(TargetClusters *target, int t, const FilmParams *params, double light)
{
    Clusters *sharp = &target->sharp;
    const int *periodic = params->periodic[t];
    const double most = EXTRA_ERROR * EXTRA_ERROR * light * light;
    while (sharp->count > params->sharp) {
        Pair best = {sharp, 0, 1, INFINITY};
        for (int i = 0; i < sharp->count; i++)
            for (int k = i + 1; k < sharp->count; k++) {
                double error2 = merge_error2(&sharp->of[i].uv, &sharp->of[k].uv, periodic);
                if (error2 < best.cost)
                    best = (Pair){sharp, i, k, error2};
            }
        if (best.cost > most)
            return;
        merge_pair(&best, periodic);
    }
}
