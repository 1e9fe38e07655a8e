/* Few clusters for all places that a pixel met: the cheapest pair merges. See footprints.h.
 *
 * Which pair is cheapest is asked for nearly every path, and nearly always a new place joins a cluster for little,
 * while clusters are far from each other. What merging two of them costs is therefore bounded from below, and looked at
 * only where the bound does not tell. With f(C) for what a texture varies within a cluster (uv_stats.h), merging a with
 * k costs f(ak) - f(a) - f(k). A place x that joins a cannot make ak vary less, and makes a vary more by exactly what
 * it cost: f(axk) - f(ax) - f(k) >= f(ak) - f(a) - f(k) - (f(ax) - f(a)). So the bound falls by what is spent. That
 * does not hold where UV close, whose distances go the short way round. */
#include <math.h>
#include "film/footprints/pixel.h"

#define ROUNDING 1e-9      /* of bounds */
#define AGAIN_WEIGHT 1e-3f /* in a cluster's albedo, of light that goes on to targets */

static void add_albedo(AlbedoSums *sums, Float4 light, Float4 albedo)
{
    sums->light += light, sums->reflected += light * albedo;
}

static void merge_albedo(AlbedoSums *into, const AlbedoSums *from)
{
    into->light += from->light, into->reflected += from->reflected;
}

/* The bound on what pairs cost, after so much was spent on joining one. */
static double less_apart(double apart, double spent, const int periodic[2])
{
    return periodic[0] || periodic[1] ? -INFINITY : (apart - spent) * (1 - ROUNDING);
}

/* ---- further hits ---- */

static void merge_later(Later *into, const Later *from, const int periodic[2])
{
    retex_uv_stats_merge(&into->uv, &from->uv, periodic);
    into->varies = retex_uv_stats_variation(&into->uv);
    into->squares += from->squares;
    merge_albedo(&into->albedo, &from->albedo);
}

void clusters_add_later(TargetClusters *target, const PendingLater *l, const int periodic[2])
{
    const Later one = {.uv = {l->weight, {l->uv[0], l->uv[1]}, {0, 0, 0}},
                       .squares = l->weight * l->weight,
                       .albedo = {l->light, l->light * l->albedo}};
    Later *later = target->later;
    double gain[LATER_COUNT];
    for (int k = 0; k < LATER_COUNT; k++) {
        if (later[k].uv.weight == 0) {
            later[k] = one;
            target->later_apart = -INFINITY;
            return;
        }
        gain[k] = retex_uv_stats_merged_variation(&later[k].uv, l->weight, l->uv, 0, periodic) - later[k].varies;
        if (gain[k] <= 0) {
            merge_later(&later[k], &one, periodic);
            return;
        }
    }
    int nearer = gain[1] < gain[0];
    if (target->later_apart <= gain[nearer])
        target->later_apart = retex_uv_stats_variation_gain(&later[0].uv, &later[1].uv, periodic);
    if (target->later_apart < gain[nearer]) {
        merge_later(&later[0], &later[1], periodic);
        later[1] = one;
        target->later_apart = -INFINITY;
    } else {
        merge_later(&later[nearer], &one, periodic);
        target->later_apart = less_apart(target->later_apart, gain[nearer], periodic);
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
    into->again += from->again;
}

static void add_pending(Cluster *into, const Pending *q, const int periodic[2])
{
    const HitLight *l = q->light;
    retex_uv_stats_add(&into->uv, q->weight, q->uv, periodic);
    into->varies = retex_uv_stats_variation(&into->uv);
    /* a cluster's own light is what its albedo is for; light that goes on to targets tells where there is no other */
    add_albedo(&into->albedo, l->c[0] + l->original * splat(AGAIN_WEIGHT), q->albedo);
    into->squares += q->weight * q->weight;
    into->c += l->c[0];
    into->again += l->original;
}

static void start_cluster(Cluster *cluster, const Pending *q, const int periodic[2])
{
    *cluster = (Cluster){.squares = 0};
    add_pending(cluster, q, periodic);
}

/* Two clusters of one kind, or one and what is to be added (b = -1). */
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

/* What it costs a cluster to take a place in. */
static double join_cost(const Cluster *a, const Pending *q, const int periodic[2])
{
    return q->sharp
               ? retex_uv_stats_point_ward(&a->uv, q->weight, q->uv, periodic) / (RETEX_UV_FEATURE * RETEX_UV_FEATURE)
               : retex_uv_stats_merged_variation(&a->uv, q->weight, q->uv, 0, periodic) - a->varies;
}

/* Look among the clusters for a pair that is cheaper than the best so far. */
static void find_pair(Pair *best, Clusters *clusters, int sharp, const int periodic[2])
{
    clusters->apart = INFINITY;
    for (int i = 0; i < clusters->count; i++)
        for (int k = i + 1; k < clusters->count; k++) {
            double cost = merge_cost(&clusters->of[i], &clusters->of[k], sharp, periodic);
            if (cost < best->cost)
                *best = (Pair){clusters, i, k, cost};
            if (cost < clusters->apart)
                clusters->apart = cost;
        }
}

/* The cheapest way to have room for one more: of either kind, or of its own where that has all that it may have. */
static Pair find_cheapest(Clusters *own, Clusters *other, int own_is_full, const Pending *q, const int periodic[2])
{
    Pair best = own->count ? (Pair){own, 0, -1, INFINITY} : (Pair){other, 0, 1, INFINITY};
    for (int i = 0; i < own->count; i++) {
        double cost = join_cost(&own->of[i], q, periodic);
        if (cost < best.cost)
            best = (Pair){own, i, -1, cost};
    }
    if (!(own->apart > best.cost))
        find_pair(&best, own, q->sharp, periodic);
    if (!own_is_full && !(other->apart > best.cost))
        find_pair(&best, other, !q->sharp, periodic);
    return best;
}

/* One more, where there are as many clusters as there may be. */
static void squeeze(Clusters *own, Clusters *other, int own_is_full, const Pending *q, const int periodic[2])
{
    Pair best = find_cheapest(own, other, own_is_full, q, periodic);
    if (best.b < 0) {
        add_pending(&own->of[best.a], q, periodic);
        own->apart = less_apart(own->apart, best.cost, periodic);
        return;
    }
    Clusters *merged = best.clusters;
    merge_cluster(&merged->of[best.a], &merged->of[best.b], periodic);
    own->apart = merged->apart = -INFINITY;
    if (merged == own) {
        start_cluster(&own->of[best.b], q, periodic);
        return;
    }
    if (best.b != --merged->count)
        merged->of[best.b] = merged->of[merged->count];
    start_cluster(&own->of[own->count++], q, periodic);
}

void clusters_add(TargetClusters *target, const Pending *q, const FilmParams *params)
{
    Clusters *own = q->sharp ? &target->sharp : &target->broad, *other = q->sharp ? &target->broad : &target->sharp;
    int room = q->sharp ? params->sharp : params->broad;
    const int *periodic = params->periodic[q->target];
    own->used |= q->light->used;
    for (unsigned left = q->light->used; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        own->again[i] += q->light->c[i];
    }
    if (own->count < room && own->count + other->count < params->clusters) {
        start_cluster(&own->of[own->count++], q, periodic);
        own->apart = -INFINITY;
    } else {
        squeeze(own, other, own->count == room, q, periodic);
    }
}
