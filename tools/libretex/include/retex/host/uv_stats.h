/* Clusters of weighted UVs, and the cost of merging them: a pixel keeps few clusters, of whatever it meets. */
#ifndef RETEX_HOST_UV_STATS_H
#define RETEX_HOST_UV_STATS_H

#include <math.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* A weighted distribution of UV. On a periodic axis the mean lies in [0,1), and distances go the short way round. */
typedef struct RetexUvStats {
    double weight;
    double mean[2];
    double m2[3]; /* weighted sums of squared deviations: uu, uv, vv */
} RetexUvStats;

void retex_uv_stats_add(RetexUvStats *stats, double weight, const double uv[2], const int periodic[2]);
void retex_uv_stats_merge(RetexUvStats *into, const RetexUvStats *from, const int periodic[2]);

/* By how much merging two raises the sum of squared deviations (Ward 1963): for points that are seen sharply, whose
 * mean matters for every texture. */
double retex_uv_stats_ward(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2]);

/* By how much merging two raises the variation of an unknown texture within clusters, weight V / (V +
 * RETEX_UV_FEATURE^2), V the variance of UV: Ward's rule in units of RETEX_UV_FEATURE^2 while clusters are small.
 * Larger clusters see the texture's mean, however large they are: so a few points far away, as on a plane to the
 * horizon, do not take a cluster each. */
double retex_uv_stats_variation_gain(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2]);
#define RETEX_UV_FEATURE 0.5 /* distance in UV over which most textures change completely */

/* The variation of an unknown texture within a cluster. */
static inline double retex_uv_stats_variation(const RetexUvStats *a)
{
    double squares = a->m2[0] + a->m2[2];
    return a->weight * squares / (squares + a->weight * RETEX_UV_FEATURE * RETEX_UV_FEATURE);
}

static inline double retex_uv_stats_difference(double to, double from, int periodic)
{
    double d = to - from;
    return periodic ? d - rint(d) : d;
}

/* The squared distance of a point from a cluster's mean. */
static inline double retex_uv_stats_distance2(const RetexUvStats *a, const double uv[2], const int periodic[2])
{
    double u = retex_uv_stats_difference(a->mean[0], uv[0], periodic[0]);
    double v = retex_uv_stats_difference(a->mean[1], uv[1], periodic[1]);
    return u * u + v * v;
}

/* Like retex_uv_stats_ward for a cluster and a single point, the same to the bit. */
static inline double retex_uv_stats_point_ward(const RetexUvStats *a, double weight, const double uv[2],
                                               const int periodic[2])
{
    return a->weight * weight / (a->weight + weight) * retex_uv_stats_distance2(a, uv, periodic);
}

/* The variation of an unknown texture within a cluster merged with a point or another cluster, which has this weight,
 * mean and sum of squared deviations. Takes one division. */
static inline double retex_uv_stats_merged_variation(const RetexUvStats *a, double weight, const double uv[2],
                                                     double squares, const int periodic[2])
{
    double sum = a->weight + weight, all = a->m2[0] + a->m2[2] + squares;
    double both = sum * all + a->weight * weight * retex_uv_stats_distance2(a, uv, periodic);
    return sum * both / (both + sum * sum * (RETEX_UV_FEATURE * RETEX_UV_FEATURE));
}

#define RETEX_UV_FINE 0.02 /* distance in UV over which fine textures change */

/* How much of a cluster's light, its weight, a fine texture changes, squared, if it is averaged over an ellipse in
 * place of what the cluster is made of: w^2 (V / (V + RETEX_UV_FINE^2))^3. Both have the same mean and covariance, so
 * textures that are quadratic there do not change. */
static inline double retex_uv_stats_shape_error2(const RetexUvStats *a)
{
    const double squares = a->m2[0] + a->m2[2];
    const double share = squares / (squares + a->weight * RETEX_UV_FINE * RETEX_UV_FINE);
    return a->weight * a->weight * share * share * share;
}

/* By how much merging two raises that. */
static inline double retex_uv_stats_shape_gain(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2])
{
    RetexUvStats both = *a;
    retex_uv_stats_merge(&both, b, periodic);
    return retex_uv_stats_shape_error2(&both) - retex_uv_stats_shape_error2(a) - retex_uv_stats_shape_error2(b);
}

/* The mean, as floats; spread: the standard deviations of u and v, and their correlation. */
void retex_uv_stats_get(const RetexUvStats *stats, float mean[2], float spread[3]);
/* The same, rounded: the mean to a 32nd of the standard deviation at most. */
void retex_uv_stats_store(const RetexUvStats *stats, float mean[2], float spread[3]);
/* Statistics from a footprint's stored mean and spread. */
void retex_uv_stats_load(RetexUvStats *stats, double weight, const float mean[2], const float spread[3]);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
