/* Pixels that one target covers, seen directly: there UV are an even map from the place in the pixel, which a
 * regression finds, and light is kept for each quarter of the pixel. Curved surfaces, seams, and lenses leave
 * residuals: such pixels keep their clusters. */
#include <math.h>
#include "film/footprints/pixel.h"

#define LEAST_PATHS 4 /* in each quarter of a pixel, for its light to be a mean */
/* The residual of the regression, in pixels: root mean square of the distance from where the map has a UV to where it
 * was met. */
#define MOST_RESIDUAL 0.015

static int quadrant_of(const SeenTarget *seen)
{
    return (seen->place[0] >= 0.5f) + 2 * (seen->place[1] >= 0.5f);
}

static void add_place(PlaceSums *s, double x, double y, double u, double v)
{
    s->n++;
    s->place[0] += x, s->place[1] += y;
    s->uv[0] += u, s->uv[1] += v;
    s->places[0] += x * x, s->places[1] += x * y, s->places[2] += y * y;
    s->mixed[0][0] += x * u, s->mixed[0][1] += x * v;
    s->mixed[1][0] += y * u, s->mixed[1][1] += y * v;
    s->uvs[0] += u * u, s->uvs[1] += u * v, s->uvs[2] += v * v;
}

void quadrants_start_path(Quadrants *q, const SeenTarget *seen, const int periodic[][2])
{
    if (q->target == QUADRANTS_MIXED)
        return;
    if (q->target == QUADRANTS_NONE)
        *q = (Quadrants){.target = seen->target, .origin = {seen->uv.u, seen->uv.v}};
    if (seen->target < 0 || seen->target != q->target) {
        q->target = QUADRANTS_MIXED;
        return;
    }
    double uv[2] = {seen->uv.u - q->origin[0], seen->uv.v - q->origin[1]};
    for (int k = 0; k < 2; k++)
        if (periodic[q->target][k])
            uv[k] -= floor(uv[k] + 0.5);
    add_place(&q->sums, (double)seen->place[0] - 0.5, (double)seen->place[1] - 0.5, uv[0], uv[1]);
    q->of[quadrant_of(seen)].paths++;
}

void quadrants_add(Quadrants *q, const SeenTarget *seen, const FirstHit *hit)
{
    Quadrant *quadrant = &q->of[quadrant_of(seen)];
    q->weight += hit->weight;
    q->squares += hit->weight * hit->weight;
    add_hit_albedo(&q->albedo, hit);
    quadrant->c += hit->light->c[0];
    quadrant->interreflected += hit->light->original;
}

/* Sums about the means, divided by the number. */
typedef struct Moments {
    double places[3], mixed[2][2], uvs[3];
} Moments;

static Moments moments_of(const PlaceSums *s)
{
    const double n = s->n, x = s->place[0] / n, y = s->place[1] / n, u = s->uv[0] / n, v = s->uv[1] / n;
    return (Moments){{s->places[0] / n - x * x, s->places[1] / n - x * y, s->places[2] / n - y * y},
                     {{s->mixed[0][0] / n - x * u, s->mixed[0][1] / n - x * v},
                      {s->mixed[1][0] / n - y * u, s->mixed[1][1] / n - y * v}},
                     {s->uvs[0] / n - u * u, s->uvs[1] / n - u * v, s->uvs[2] / n - v * v}};
}

/* The axes that fit best. */
static void find_axes(const Moments *m, double axes[4])
{
    const double determinant = m->places[0] * m->places[2] - m->places[1] * m->places[1];
    for (int k = 0; k < 2; k++) {
        axes[k] = (m->places[2] * m->mixed[0][k] - m->places[1] * m->mixed[1][k]) / determinant;
        axes[2 + k] = (m->places[0] * m->mixed[1][k] - m->places[1] * m->mixed[0][k]) / determinant;
    }
}

/* The mean square of the residual, in pixels: what is left of UV's covariance, by the inverse of the axes. */
static double residual_of(const Moments *m, const double axes[4])
{
    const double uu = m->uvs[0] - axes[0] * m->mixed[0][0] - axes[2] * m->mixed[1][0];
    const double uv = m->uvs[1] - axes[0] * m->mixed[0][1] - axes[2] * m->mixed[1][1];
    const double vv = m->uvs[2] - axes[1] * m->mixed[0][1] - axes[3] * m->mixed[1][1];
    const double area = axes[0] * axes[3] - axes[1] * axes[2];
    const double x = axes[3] * axes[3] * uu - 2 * axes[3] * axes[2] * uv + axes[2] * axes[2] * vv;
    const double y = axes[1] * axes[1] * uu - 2 * axes[1] * axes[0] * uv + axes[0] * axes[0] * vv;
    return (x + y) / (area * area);
}

int quadrants_find_map(const Quadrants *q, const int periodic[][2], PixelMap *map)
{
    if (q->target < 0 || !(q->weight > 0))
        return 0;
    for (int k = 0; k < RETEX_QUADRANTS; k++)
        if (q->of[k].paths < LEAST_PATHS)
            return 0;
    const PlaceSums *s = &q->sums;
    const Moments m = moments_of(s);
    find_axes(&m, map->axes);
    if (!(residual_of(&m, map->axes) < MOST_RESIDUAL * MOST_RESIDUAL))
        return 0;
    for (int k = 0; k < 2; k++) {
        map->uv[k] = q->origin[k] + (s->uv[k] - map->axes[k] * s->place[0] - map->axes[2 + k] * s->place[1]) / s->n;
        if (periodic[q->target][k])
            map->uv[k] -= floor(map->uv[k]);
    }
    return 1;
}

static Float4 light_of(const Quadrants *q, int k, int interreflected)
{
    return interreflected ? q->of[k].interreflected : q->of[k].c;
}

Float4 quadrants_light(const Quadrants *q, int k, int interreflected)
{
    Float4 sum = splat(0), means = splat(0), light;
    for (int i = 0; i < RETEX_QUADRANTS; i++) {
        light = light_of(q, i, interreflected);
        sum += light, means += light / splat((float)q->of[i].paths);
    }
    light = light_of(q, k, interreflected) / splat((float)q->of[k].paths);
    for (int c = 0; c < 3; c++)
        light[c] = means[c] > 0 ? light[c] / means[c] * sum[c] : 0;
    return light;
}
