/* Weighted means and covariances of UV, updated without cancellation (Welford; Chan et al. for merging). */
#include <math.h>

#include <retex/host/assert.h>
#include <retex/host/rounding.h>
#include <retex/host/uv_stats.h>

/* Wraps x into [0,1); a negative x too small for the sum to be below 1 becomes 0. */
static double wrapped(double x, int periodic)
{
    double rest = periodic ? x - floor(x) : x;
    return periodic && rest >= 1 ? 0 : rest;
}

void retex_uv_stats_add(RetexUvStats *stats, double weight, const double uv[2], const int periodic[2])
{
    double share, d[2];
    stats->weight += weight;
    share = weight / stats->weight;
    for (int k = 0; k < 2; k++) {
        d[k] = retex_uv_stats_difference(uv[k], stats->mean[k], periodic[k]);
        stats->mean[k] = wrapped(stats->mean[k] + share * d[k], periodic[k]);
    }
    double rest = weight * (1 - share);
    stats->m2[0] += rest * d[0] * d[0];
    stats->m2[1] += rest * d[0] * d[1];
    stats->m2[2] += rest * d[1] * d[1];
}

void retex_uv_stats_merge(RetexUvStats *into, const RetexUvStats *from, const int periodic[2])
{
    RETEX_ASSERT(from->weight > 0 && into->weight >= 0); /* else the mean is NaN */
    double total = into->weight + from->weight, share = from->weight / total, d[2];
    for (int k = 0; k < 2; k++) {
        d[k] = retex_uv_stats_difference(from->mean[k], into->mean[k], periodic[k]);
        into->mean[k] = wrapped(into->mean[k] + share * d[k], periodic[k]);
    }
    double between = into->weight * share;
    into->m2[0] += from->m2[0] + between * d[0] * d[0];
    into->m2[1] += from->m2[1] + between * d[0] * d[1];
    into->m2[2] += from->m2[2] + between * d[1] * d[1];
    into->weight = total;
}

double retex_uv_stats_ward(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2])
{
    return retex_uv_stats_point_ward(a, b->weight, b->mean, periodic);
}

double retex_uv_stats_variation_gain(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2])
{
    return retex_uv_stats_merged_variation(a, b->weight, b->mean, b->m2[0] + b->m2[2], periodic) -
           retex_uv_stats_variation(a) - retex_uv_stats_variation(b);
}

static double correlation_of(const RetexUvStats *stats, double su, double sv)
{
    return su > 0 && sv > 0 ? stats->m2[1] / (stats->weight * su * sv) : 0;
}

void retex_uv_stats_get(const RetexUvStats *stats, float mean[2], float spread[3])
{
    const double su = sqrt(stats->m2[0] / stats->weight), sv = sqrt(stats->m2[2] / stats->weight);
    mean[0] = (float)stats->mean[0], mean[1] = (float)stats->mean[1];
    spread[0] = (float)su, spread[1] = (float)sv;
    spread[2] = (float)fmax(-1, fmin(correlation_of(stats, su, sv), 1));
}

#define UV_STEP (1.0 / 32)
#define UV_FINEST (1.0 / (1 << 18)) /* a 64th of a texel of a 4K texture: the step where all samples met one place */
enum { SPREAD_BITS = 7 };           /* an error of 1/128 is less than the uncertainty from so few samples */
enum { CORRELATION_BITS = 6 };      /* significant bits of 1 - correlation */

void retex_uv_stats_store(const RetexUvStats *stats, float mean[2], float spread[3])
{
    double su = sqrt(stats->m2[0] / stats->weight), sv = sqrt(stats->m2[2] / stats->weight);
    /* + 0: no -0 */
    mean[0] = (float)retex_round_to(stats->mean[0], fmax(UV_STEP * su, UV_FINEST)) + 0.0f;
    mean[1] = (float)retex_round_to(stats->mean[1], fmax(UV_STEP * sv, UV_FINEST)) + 0.0f;
    spread[0] = (float)retex_round_bits(su, SPREAD_BITS), spread[1] = (float)retex_round_bits(sv, SPREAD_BITS);
    const double correlation = correlation_of(stats, su, sv);
    spread[2] = (float)copysign(1 - retex_round_bits(1 - fmin(fabs(correlation), 1), CORRELATION_BITS), correlation);
}

void retex_uv_stats_load(RetexUvStats *stats, double weight, const float mean[2], const float spread[3])
{
    stats->weight = weight;
    stats->mean[0] = mean[0], stats->mean[1] = mean[1];
    stats->m2[0] = weight * spread[0] * spread[0];
    stats->m2[1] = weight * spread[2] * spread[0] * spread[1];
    stats->m2[2] = weight * spread[1] * spread[1];
}
