/* See places.h. Loops over lanes without branches: the compiler makes vectors of them. */
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <retex/host/cpu.h>
#include <retex/host/uv_stats.h>
#include "film/footprints/places.h"

#define LEAST_POWER (-700.0) /* e to that is nothing beside any other number */

/* A member of a pair, or both as one. */
typedef struct Place {
    double weight, mean[2], covariance[3];
} Place;

/* e^x for x <= 0, to the last bit or two. x is n log 2 + r; the low bits of x / log 2 + 1.5 2^52 are n. */
RETEX_CPU_INLINE double exponential(double x)
{
    const double shift = 0x1.8p52, log2_high = 0x1.62e42fee00000p-1, log2_low = 0x1.a39ef35793c76p-33;
    const double bounded = x > LEAST_POWER ? x : LEAST_POWER, shifted = bounded * 0x1.71547652b82fep+0 + shift;
    const double n = shifted - shift, r = bounded - n * log2_high - n * log2_low;
    static const double factorials[] = {
        1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
        1.0 / 720,        1.0 / 120,       1.0 / 24,       1.0 / 6,       0.5,          1,           1};
    double sum = factorials[0], scale;
    uint64_t bits;
    for (int k = 1; k < (int)(sizeof factorials / sizeof *factorials); k++)
        sum = sum * r + factorials[k];
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits + 1023) << 52;
    memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

RETEX_CPU_INLINE Place place_at(const PlaceLanes *p, int k)
{
    return (Place){
        p->weight[k], {p->mean[0][k], p->mean[1][k]}, {p->covariance[0][k], p->covariance[1][k], p->covariance[2][k]}};
}

/* As retex_uv_stats_merge. */
RETEX_CPU_INLINE Place merged_at(const PlacePairs *pairs, int k, const int periodic[2])
{
    const PlaceLanes *a = &pairs->a, *b = &pairs->b;
    const double total = a->weight[k] + b->weight[k], share = b->weight[k] / total, between = a->weight[k] * share;
    double d[2], mean[2];
    for (int i = 0; i < 2; i++) {
        d[i] = retex_uv_stats_difference(b->mean[i][k], a->mean[i][k], periodic[i]);
        const double at = a->mean[i][k] + share * d[i], rest = periodic[i] ? at - floor(at) : at;
        mean[i] = periodic[i] && rest >= 1 ? 0 : rest;
    }
    return (Place){total,
                   {mean[0], mean[1]},
                   {(a->m2[0][k] + (b->m2[0][k] + between * d[0] * d[0])) / total,
                    (a->m2[1][k] + (b->m2[1][k] + between * d[0] * d[1])) / total,
                    (a->m2[2][k] + (b->m2[2][k] + between * d[1] * d[1])) / total}};
}

/* The covariance of what two places see of a texture, of variance 1, whose values are correlated as exp(-d^2 / 2) by
 * their distance d in features. */
RETEX_CPU_INLINE double texture_covariance(const Place *a, const Place *b, double f, const int periodic[2])
{
    const double uu = a->covariance[0] + b->covariance[0], uv = a->covariance[1] + b->covariance[1];
    const double vv = a->covariance[2] + b->covariance[2];
    const double u = retex_uv_stats_difference(a->mean[0], b->mean[0], periodic[0]);
    const double v = retex_uv_stats_difference(a->mean[1], b->mean[1], periodic[1]);
    const double det = places_determinant(uu, uv, vv, f);
    const double squares = (vv + f) * u * u - 2 * uv * u * v + (uu + f) * v * v;
    const double distance2 = (squares > 0 ? squares : 0) / det;
    return f / sqrt(det) * exponential(-distance2 / 2);
}

RETEX_CPU_INLINE double error2_at(const PlacePairs *pairs, int k, double f, const int periodic[2])
{
    const Place a = place_at(&pairs->a, k), b = place_at(&pairs->b, k), both = merged_at(pairs, k, periodic);
    const double *m = both.covariance, p = a.weight, q = b.weight;
    const double alone = both.weight * both.weight * f / sqrt(places_determinant(2 * m[0], 2 * m[1], 2 * m[2], f));
    return pairs->a.variance[k] + pairs->b.variance[k] + alone + 2 * p * q * texture_covariance(&a, &b, f, periodic) -
           2 * both.weight *
               (p * texture_covariance(&a, &both, f, periodic) + q * texture_covariance(&b, &both, f, periodic));
}

RETEX_CPU_INLINE void errors_body(PlacePairs *restrict pairs, double f, const int *restrict periodic)
{
    static const int open[2] = {0, 0};
    if (periodic[0] || periodic[1])
        for (int k = 0; k < PLACE_LANES; k++)
            pairs->error2[k] = error2_at(pairs, k, f, periodic);
    else
        for (int k = 0; k < PLACE_LANES; k++)
            pairs->error2[k] = error2_at(pairs, k, f, open);
}

RETEX_CPU_KERNEL(errors, (PlacePairs * pairs, double f, const int *periodic), (pairs, f, periodic))

void place_pairs_errors(PlacePairs *pairs, double feature, const int periodic[2])
{
    errors_by_level[retex_cpu_level()](pairs, feature * feature, periodic);
}
