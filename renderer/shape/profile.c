/* Plane curves of polynomial segments. */
#include <math.h>
#include "base/polynomial.h"
#include "shape/profile.h"

Vec2 profile_at(const ProfileSegment *segment, double u)
{
    const Vec2 *c = segment->c;

    if (u >= 1)
        return segment->end;
    return (Vec2){((c[3].u * u + c[2].u) * u + c[1].u) * u + c[0].u, ((c[3].v * u + c[2].v) * u + c[1].v) * u + c[0].v};
}

Vec2 profile_slope(const ProfileSegment *segment, double u)
{
    const Vec2 *c = segment->c;

    return (Vec2){(3 * c[3].u * u + 2 * c[2].u) * u + c[1].u, (3 * c[3].v * u + 2 * c[2].v) * u + c[1].v};
}

static void widen(Vec2 *low, Vec2 *high, Vec2 p)
{
    *low = (Vec2){fmin(low->u, p.u), fmin(low->v, p.v)};
    *high = (Vec2){fmax(high->u, p.u), fmax(high->v, p.v)};
}

void profile_set_bounds(Profile *profile)
{
    profile->low = (Vec2){INFINITY, INFINITY};
    profile->high = (Vec2){-INFINITY, -INFINITY};
    for (int i = 0; i < profile->count; i++) {
        ProfileSegment *s = &profile->segments[i];
        s->low = s->high = s->c[0];
        for (int axis = 0; axis < 2; axis++) {
            double c[PROFILE_DEGREE + 1], at[PROFILE_DEGREE + 1];
            for (int k = 0; k <= profile->degree; k++)
                c[k] = axis ? s->c[k].v : s->c[k].u;
            const int count = polynomial_pieces(c, profile->degree, 0, 1, at);
            for (int k = 0; k < count; k++)
                widen(&s->low, &s->high, profile_at(s, at[k]));
        }
        widen(&profile->low, &profile->high, s->low);
        widen(&profile->low, &profile->high, s->high);
    }
}

double profile_nearest(const Profile *profile, const ProfileSegment *segment, Vec2 p)
{
    double away[PROFILE_DEGREE + 1][2], c[2 * PROFILE_DEGREE] = {0}, at[2 * PROFILE_DEGREE + 1], best = 0,
                                              least = INFINITY;
    const int n = profile->degree;
    int count;

    for (int i = 0; i <= n; i++) {
        away[i][0] = segment->c[i].u - (i ? 0 : p.u);
        away[i][1] = segment->c[i].v - (i ? 0 : p.v);
    }
    for (int i = 0; i <= n; i++)
        for (int j = 1; j <= n; j++)
            c[i + j - 1] += j * (away[i][0] * away[j][0] + away[i][1] * away[j][1]);
    count = polynomial_roots(c, 2 * n - 1, 0, 1, at);
    at[count++] = 0;
    at[count++] = 1;
    for (int i = 0; i < count; i++) {
        Vec2 q = profile_at(segment, at[i]);
        double far = (q.u - p.u) * (q.u - p.u) + (q.v - p.v) * (q.v - p.v);
        if (far < least)
            least = far, best = at[i];
    }
    return best;
}

/* A line's equation along a segment. */
typedef struct Along {
    double c[PROFILE_DEGREE + 1], end;
} Along;

static double along_segment(const void *data, double u, double *slope)
{
    const Along *a = data;

    *slope = (3 * a->c[3] * u + 2 * a->c[2]) * u + a->c[1];
    return u >= 1 ? a->end : ((a->c[3] * u + a->c[2]) * u + a->c[1]) * u + a->c[0];
}

int profile_crossings(const Profile *profile, const ProfileSegment *segment, double a, double b, double c,
                      double roots[PROFILE_DEGREE])
{
    const ProfileSegment *s = segment;
    const double middle = 0.5 * (a * (s->low.u + s->high.u) + b * (s->low.v + s->high.v)) + c,
                 half = 0.5 * (fabs(a) * (s->high.u - s->low.u) + fabs(b) * (s->high.v - s->low.v));
    double points[PROFILE_DEGREE + 1];
    Along along;
    int count;

    if (fabs(middle) > half + 1e-12 * (fabs(a) * fabs(s->low.u) + fabs(b) * fabs(s->low.v) + fabs(c)))
        return 0;
    for (int i = 0; i <= PROFILE_DEGREE; i++)
        along.c[i] = a * s->c[i].u + b * s->c[i].v + (i ? 0 : c);
    along.end = a * s->end.u + b * s->end.v + c;
    if (profile->degree > 1) {
        count = polynomial_pieces(along.c, profile->degree, 0, 1, points);
        return roots_between_points(along_segment, &along, points, count, roots);
    }
    if ((along.c[0] > 0) == (along.end > 0))
        return 0;
    roots[0] = along.c[0] / (along.c[0] - along.end);
    return 1;
}

int profile_contains(const Profile *profile, Vec2 p)
{
    int odd = 0;

    for (int i = 0; i < profile->count; i++) {
        const ProfileSegment *s = &profile->segments[i];
        double roots[PROFILE_DEGREE];
        if (p.v < s->low.v || p.v > s->high.v || p.u > s->high.u)
            continue;
        const int count = profile_crossings(profile, s, 0, 1, -p.v, roots);
        for (int k = 0; k < count; k++)
            odd ^= profile_at(s, roots[k]).u > p.u;
    }
    return odd;
}

Vec2 profile_normal(const Profile *profile, const ProfileSegment *segment, double u)
{
    const Vec2 slope = profile_slope(segment, u), p = profile_at(segment, u);
    const double length = hypot(slope.u, slope.v);
    Vec2 n = {slope.v, -slope.u};
    double off;

    if (!(length > 0))
        return (Vec2){1, 0};
    off = 1e-6 * profile->size / length;
    if (profile_contains(profile, (Vec2){p.u + off * n.u, p.v + off * n.v}))
        n = (Vec2){-n.u, -n.v};
    return n;
}
