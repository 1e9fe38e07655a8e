/* The lathe: a curve of (rho, y) turned about y. It has an inside where the curve crosses an odd number of times
 * outward. Faces: segments of the curve. Natural parametrisation: POV-Ray's uv, u around y, v along the curve.
 *
 * With s counted from the line's point next to the axis, rho^2 = h^2 + across^2 s^2 and y = y0 + along s. Without s:
 *     across^2 (y - y0)^2 - along^2 (rho^2 - h^2) = 0,
 * of twice the curve's degree in its parameter. Its critical points come from its coefficients, but its sign from the
 * difference of squares: so pairs of crossings are told apart however nearly level the line is. Of steep lines, whose
 * point next to the axis may be far away, rho at (y - y0) / along is compared with the curve's. */
#include <float.h>
#include "base/polynomial.h"
#include "shape/profile.h"
#include "shape/shape.h"

enum { DEGREE = 2 * PROFILE_DEGREE };

static const Profile *profile_of(const Shape *shape)
{
    return shape->data;
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Profile *profile = profile_of(&primitive->shape);

    for (int i = 0; i < profile->count; i++) {
        const ProfileSegment *s = &profile->segments[i];
        double radius = fmax(fabs(s->low.u), fabs(s->high.u));
        shape_bound_circle(low, high, &primitive->transform, vec3(0, s->low.v, 0), 0, 2, radius, 0);
        shape_bound_circle(low, high, &primitive->transform, vec3(0, s->high.v, 0), 0, 2, radius, 0);
    }
}

/* A line as it meets a surface of revolution: y + along s, and x and z as below. */
typedef struct Meeting {
    const ProfileSegment *segment;
    int steep;
    double across, along; /* how fast it goes across the axis and along it: of a unit direction */
    double y, nearest; /* where s = 0; nearest: the distance from the axis there, least where the line is not steep */
    Vec2 from, by;     /* x and z where s = 0, and their change with s */
} Meeting;

static double difference(const void *data, double u, double *slope)
{
    const Meeting *m = data;
    const Vec2 p = profile_at(m->segment, u), d = profile_slope(m->segment, u);

    if (m->steep) {
        const double s = (p.v - m->y) / m->along, x = m->from.u + s * m->by.u, z = m->from.v + s * m->by.v,
                     rho = sqrt(x * x + z * z);
        *slope = 2 * ((x * m->by.u + z * m->by.v) * d.v / m->along - p.u * d.u);
        return (rho - fabs(p.u)) * (rho + fabs(p.u));
    }
    const double y = m->across * (p.v - m->y), w2 = (fabs(p.u) - m->nearest) * (fabs(p.u) + m->nearest),
                 w = w2 > 0 ? fabs(m->along) * sqrt(w2) : 0;
    *slope = 2 * (m->across * y * d.v - m->along * m->along * p.u * d.u);
    return w2 > 0 ? (fabs(y) - w) * (fabs(y) + w) : y * y - m->along * m->along * w2;
}

static double level(const void *data, double u, double *slope)
{
    const Meeting *m = data;

    *slope = profile_slope(m->segment, u).v;
    return profile_at(m->segment, u).v - m->y;
}

/* What `difference` is monotonic between: from the coefficients in u. */
static int pieces(const Meeting *m, int degree, double *points)
{
    double c[DEGREE + 1] = {0}, a[3][PROFILE_DEGREE + 1], sum[3] = {0, 0, 0};

    for (int i = 0; i <= degree; i++) {
        const Vec2 p = m->segment->c[i];
        const double y = p.v - (i ? 0 : m->y);
        a[0][i] = m->steep ? (i ? 0 : m->from.u) + m->by.u * y / m->along : m->across * y;
        a[1][i] = m->steep ? (i ? 0 : m->from.v) + m->by.v * y / m->along : i ? 0 : m->along * m->nearest;
        a[2][i] = m->steep ? p.u : m->along * p.u;
        for (int k = 0; k < 3; k++)
            sum[k] += fabs(a[k][i]);
    }
    for (int i = 0; i <= degree; i++)
        for (int j = 0; j <= degree; j++)
            c[i + j] += a[0][i] * a[0][j] + a[1][i] * a[1][j] - a[2][i] * a[2][j];
    return polynomial_unit_pieces(c, 2 * degree, sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2], points);
}

/* The square of its distance from the axis. */
static double square_at(const Meeting *m, double s)
{
    const double x = m->from.u + s * m->by.u, z = m->from.v + s * m->by.v;

    return x * x + z * z;
}

/* Whether the line meets the ring that the segment lies in. */
static int may_meet(const Meeting *m)
{
    const ProfileSegment *s = m->segment;
    const double outer = fmax(fabs(s->low.u), fabs(s->high.u)), inner = s->low.u > 0    ? s->low.u
                                                                        : s->high.u < 0 ? -s->high.u
                                                                                        : 0;
    double a = (s->low.v - m->y) / m->along, b = (s->high.v - m->y) / m->along, close, least, most,
           at = -(m->from.u * m->by.u + m->from.v * m->by.v) / (m->across * m->across);

    if (m->along == 0)
        return m->y >= s->low.v && m->y <= s->high.v && m->nearest <= outer;
    close = at > fmin(a, b) ? fmin(at, fmax(a, b)) : fmin(a, b);
    least = square_at(m, close);
    most = fmax(square_at(m, a), square_at(m, b));
    return least <= outer * outer * (1 + 1e-9) && most >= inner * inner * (1 - 1e-9);
}

static void intersect_segment(const Meeting *m, int degree, const ShapeLine *line, double shift, int face,
                              ShapeCrossings *crossings)
{
    const int is_level = fabs(m->along) < 1e-9;
    double points[DEGREE + 1], roots[DEGREE];
    int count;

    if (is_level) {
        double c[PROFILE_DEGREE + 1];
        for (int i = 0; i <= degree; i++)
            c[i] = m->segment->c[i].v;
        count = polynomial_pieces(c, degree, 0, 1, points);
    } else {
        count = pieces(m, degree, points);
    }
    count = roots_between_points(is_level ? level : difference, m, points, count, roots);
    for (int i = 0; i < count; i++) {
        const Vec2 p = profile_at(m->segment, roots[i]);
        const double w2 = (fabs(p.u) - m->nearest) * (fabs(p.u) + m->nearest), w = w2 > 0 ? sqrt(w2) / m->across : 0;
        if (is_level && w2 > 0) {
            shape_add_crossing(crossings, shape_line_t(line, shift - w), face);
            shape_add_crossing(crossings, shape_line_t(line, shift + w), face);
        } else if (!is_level) {
            /* From y, or from rho where that tells it better. */
            double s = (p.v - m->y) / m->along;
            if (!m->steep && fabs(m->along * p.u) < w)
                s = copysign(w, s);
            shape_add_crossing(crossings, shape_line_t(line, shift + s), face);
        }
    }
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Profile *profile = profile_of(&primitive->shape);
    const double wide = profile->size * (1 + 1e-9), pad = 1e-9 * profile->size;
    const ShapeLine line = shape_line(ray, vec3(0, 0.5 * (profile->low.v + profile->high.v), 0));
    const Vec3 o = line.origin, d = line.direction;
    const double across = hypot(d.x, d.z), shift = fabs(d.y) > 0.5 ? 0 : -(o.x * d.x + o.z * d.z) / (across * across),
                 x = o.x + shift * d.x, z = o.z + shift * d.z;
    ShapeCrossings crossings = shape_crossings(ray);
    double low = -INFINITY, high = INFINITY;
    Meeting m = {NULL, fabs(d.y) > 0.5, across, d.y, o.y + shift * d.y, hypot(x, z), {x, z}, {d.x, d.z}};

    if (!shape_line_clip(&line, vec3(-wide, profile->low.v - pad, -wide), vec3(wide, profile->high.v + pad, wide), &low,
                         &high))
        return 0;
    for (int i = 0; i < profile->count; i++) {
        m.segment = &profile->segments[i];
        if (may_meet(&m))
            intersect_segment(&m, profile->degree, &line, shift, i, &crossings);
    }
    return shape_crossings_end(&crossings, primitive, profile->size, t, face);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Profile *profile = profile_of(&primitive->shape);
    const ProfileSegment *segment = &profile->segments[face];
    const double rho = hypot(p.x, p.z), x = rho > 0 ? p.x / rho : 1, z = rho > 0 ? p.z / rho : 0,
                 u = profile_nearest(profile, segment, (Vec2){rho, p.y});
    const Vec2 at = profile_at(segment, u), n = profile_normal(profile, segment, u);

    out->p = vec3(at.u * x, at.v, at.u * z);
    out->normal = vec3(n.u * x, n.v, n.u * z);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Profile *profile = profile_of(&surface->primitive->shape);
    const Vec3 p = shape_local_point(surface);
    const double u = profile_nearest(profile, &profile->segments[surface->face], (Vec2){hypot(p.x, p.z), p.y});

    out->uv = out->natural = (Vec2){shape_turn(p.x, p.z), (surface->face + u) / profile->count};
    out->has_uv = 1;
}

static int inside(const Shape *shape, Vec3 p)
{
    return profile_contains(profile_of(shape), (Vec2){hypot(p.x, p.z), p.y});
}

const ShapeOps shape_lathe = {
    .name = "lathe",
    .properties = SHAPE_U_PERIODIC | SHAPE_UV_NATURAL,
    SHAPE_BOUNDED,
};
