/* The surface of revolution about y: rho^2 is a cubic of y in each segment. Faces: 0 the lower cap, 1 the upper one,
 * from 2 on the side by segment. Natural parametrisation: of the side POV-Ray's uv, u around y, v upward by segments;
 * of caps x and z, the unit square round the cap's circle. */
#include <float.h>
#include "base/polynomial.h"
#include "shape/shape.h"
#include "shape/sor.h"

static const Sor *sor_of(const Shape *shape)
{
    return shape->data;
}

static double square_at(const SorSegment *s, double y)
{
    const double v = y - s->low;

    return y >= s->high ? s->end : y <= s->low ? s->c[0] : ((s->c[3] * v + s->c[2]) * v + s->c[1]) * v + s->c[0];
}

static double slope_at(const SorSegment *s, double y)
{
    const double v = y - s->low;

    return (3 * s->c[3] * v + 2 * s->c[2]) * v + s->c[1];
}

void sor_set_bounds(Sor *sor)
{
    double most = 0;

    for (int i = 0; i < sor->count; i++) {
        SorSegment *s = &sor->segments[i];
        double at[4];
        const int count = polynomial_pieces(s->c, 3, 0, s->high - s->low, at);
        s->least = s->most = s->c[0];
        for (int k = 0; k < count; k++) {
            double square = square_at(s, s->low + at[k]);
            s->least = fmin(s->least, square);
            s->most = fmax(s->most, square);
        }
        most = fmax(most, s->most);
    }
    sor->radius = sqrt(most);
    sor->low = sor->segments[0].low;
    sor->high = sor->segments[sor->count - 1].high;
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Sor *sor = sor_of(&primitive->shape);

    for (int i = 0; i < sor->count; i++) {
        const SorSegment *s = &sor->segments[i];
        const double radius = sqrt(fmax(s->most, 0));
        shape_bound_circle(low, high, &primitive->transform, vec3(0, s->low, 0), 0, 2, radius, 0);
        shape_bound_circle(low, high, &primitive->transform, vec3(0, s->high, 0), 0, 2, radius, 0);
    }
}

/* ---- the side ---- */

/* A line within a segment: rho^2 = q[0] + q[1] s + q[2] s^2. */
typedef struct Meeting {
    const SorSegment *segment;
    double q[3], y, along; /* y + along s */
    double from, to;       /* where it is at the segment's ends */
} Meeting;

/* How far outside the segment's rho^2 the line is; at the segment's ends just what it is for its neighbour there. */
static double outside(const void *data, double s, double *slope)
{
    const Meeting *m = data;
    const SorSegment *segment = m->segment;
    const double y = m->y + m->along * s, rho2 = (m->q[2] * s + m->q[1]) * s + m->q[0];
    const int to_low = s == (m->along > 0 ? m->from : m->to), to_high = s == (m->along > 0 ? m->to : m->from);

    *slope = 2 * m->q[2] * s + m->q[1] - m->along * slope_at(segment, y);
    return rho2 - (to_low ? segment->c[0] : to_high ? segment->end : square_at(segment, y));
}

static int may_meet(const Meeting *m)
{
    const SorSegment *segment = m->segment;
    const double nearest = m->q[2] > 0 ? fmin(fmax(-0.5 * m->q[1] / m->q[2], m->from), m->to) : m->from,
                 least = (m->q[2] * nearest + m->q[1]) * nearest + m->q[0],
                 a = (m->q[2] * m->from + m->q[1]) * m->from + m->q[0],
                 b = (m->q[2] * m->to + m->q[1]) * m->to + m->q[0], most = fmax(a, b),
                 slack = 1e-9 * (fabs(segment->most) + most);

    return least <= segment->most + slack && most >= segment->least - slack;
}

static void intersect_segment(const Meeting *m, const ShapeLine *line, int face, ShapeCrossings *crossings)
{
    const SorSegment *segment = m->segment;
    const double v = m->y - segment->low, b = m->along, *c = segment->c;
    const double equation[4] = {m->q[0] - (((c[3] * v + c[2]) * v + c[1]) * v + c[0]),
                                m->q[1] - b * ((3 * c[3] * v + 2 * c[2]) * v + c[1]),
                                m->q[2] - b * b * (3 * c[3] * v + c[2]), -b * b * b * c[3]};
    double points[4], roots[3];
    int count = polynomial_pieces(equation, 3, m->from, m->to, points);

    count = roots_between_points(outside, m, points, count, roots);
    for (int k = 0; k < count; k++)
        shape_add_crossing(crossings, shape_line_t(line, roots[k]), face);
}

static void intersect_side(const Sor *sor, const ShapeLine *line, double low, double high, ShapeCrossings *crossings)
{
    const Vec3 o = line->origin, d = line->direction;
    Meeting m = {
        .q = {o.x * o.x + o.z * o.z, 2 * (o.x * d.x + o.z * d.z), d.x * d.x + d.z * d.z}, .y = o.y, .along = d.y};

    for (int i = 0; i < sor->count; i++) {
        const SorSegment *segment = m.segment = &sor->segments[i];
        double a = (segment->low - o.y) / d.y, b = (segment->high - o.y) / d.y;
        if (d.y == 0) {
            if (!(o.y >= segment->low && o.y < segment->high))
                continue;
            a = low, b = high;
        }
        m.from = fmin(a, b);
        m.to = fmax(a, b);
        if (m.to < low || m.from > high)
            continue;
        if (may_meet(&m))
            intersect_segment(&m, line, 2 + i, crossings);
    }
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Sor *sor = sor_of(&primitive->shape);
    const double wide = sor->radius * (1 + 1e-6), pad = 1e-6 * (sor->high - sor->low);
    const ShapeLine line = shape_line(ray, vec3(0, 0.5 * (sor->low + sor->high), 0));
    ShapeCrossings crossings = shape_crossings(ray);
    double low = -INFINITY, high = INFINITY;

    if (!shape_line_clip(&line, vec3(-wide, sor->low - pad, -wide), vec3(wide, sor->high + pad, wide), &low, &high))
        return 0;
    intersect_side(sor, &line, low, high, &crossings);
    for (int cap = 0; cap < 2 && !primitive->shape.open; cap++) {
        const double y = cap ? sor->high : sor->low,
                     square = cap ? sor->segments[sor->count - 1].end : sor->segments[0].c[0];
        double s;
        if (fabs(ray->origin.y - y) <= ray->slack || line.direction.y == 0)
            continue;
        s = (y - line.origin.y) / line.direction.y;
        Vec3 p = vec_mad(line.origin, line.direction, s);
        if (p.x * p.x + p.z * p.z <= square)
            shape_add_crossing(&crossings, shape_line_t(&line, s), cap);
    }
    return shape_crossings_end(&crossings, primitive, fmax(sor->radius, sor->high - sor->low), t, face);
}

/* ---- points ---- */

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Sor *sor = sor_of(&primitive->shape);

    if (face < 2) {
        out->p = vec3(p.x, face ? sor->high : sor->low, p.z);
        out->normal = vec3(0, face ? 1 : -1, 0);
        return;
    }
    const SorSegment *segment = &sor->segments[face - 2];
    for (int i = 0; i < 3; i++) {
        const double far = p.x * p.x + p.z * p.z - square_at(segment, p.y);
        double size;
        out->normal = vec3(2 * p.x, -slope_at(segment, p.y), 2 * p.z);
        size = vec_dot(out->normal, out->normal);
        if (i == 2 || !(size > 0) || far * far > 1e-6 * size * sor->radius * sor->radius)
            break;
        p = vec_mad(p, out->normal, -far / size);
        p.y = fmin(fmax(p.y, segment->low), segment->high);
    }
    out->p = p;
    if (!(vec_dot(out->normal, out->normal) > 0))
        out->normal = vec3(0, 1, 0);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Sor *sor = sor_of(&surface->primitive->shape);
    const Vec3 p = shape_local_point(surface);
    const int face = surface->face, i = face < 2 ? 0 : face - 2;
    const SorSegment *segment = &sor->segments[i];
    const double radius = sqrt(face == 1 ? sor->segments[sor->count - 1].end : sor->segments[0].c[0]),
                 share = fmin(hypot(p.x, p.z) / radius, 1);

    out->uv = (Vec2){shape_turn(p.x, p.z), (i + (p.y - segment->low) / (segment->high - segment->low)) / sor->count};
    if (face < 2)
        out->uv.v = face ? 1 - share : share;
    out->natural = face < 2 ? shape_circle_uv(vec3(p.x, p.z, 0), radius) : out->uv;
    out->has_uv = 1;
}

static int inside(const Shape *shape, Vec3 p)
{
    const Sor *sor = sor_of(shape);

    for (int i = 0; i < sor->count; i++)
        if (p.y >= sor->segments[i].low && p.y <= sor->segments[i].high)
            return p.x * p.x + p.z * p.z < square_at(&sor->segments[i], p.y);
    return 0;
}

const ShapeOps shape_sor = {
    .name = "sor",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
};
