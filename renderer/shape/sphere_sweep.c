/* The sphere sweep: all spheres along a curve, whose centre and radius are polynomials of a parameter u. Faces:
 * segments of the curve. Natural parametrisation: u along the curve, by segments, v the angle around it from the
 * direction of y (of x where the curve runs along y).
 *
 * A line meets the sphere of u from a - w to a + w, where w^2 is a polynomial. These intervals change steadily with
 * u: so from each run of u where w^2 is positive there is one interval, from the least a - w to the largest a + w, and
 * what the line has inside is the union of these. Crossings are the ends of that: always pairs. */
#include <float.h>
#include "base/polynomial.h"
#include "shape/shape.h"
#include "shape/sphere_sweep.h"

enum { MOST_INTERVALS = 256, SQUARE = 2 * SWEEP_DEGREE, EXTREMES = 4 * SWEEP_DEGREE };

static const SphereSweep *sweep_of(const Shape *shape)
{
    return shape->data;
}

static Vec3 centre_at(const SweepSegment *s, double u)
{
    return vec_mad(s->c[0], vec_mad(s->c[1], vec_mad(s->c[2], s->c[3], u), u), u);
}

static double radius_at(const SweepSegment *s, double u)
{
    return fabs(polynomial_value(s->r, SWEEP_DEGREE, u));
}

/* ---- bounds ---- */

/* The largest value along a row of a transform, of the centre and the radius times the row's length. */
static double support(const SphereSweep *sweep, const SweepSegment *s, Vec3 row)
{
    const double length = vec_length(row);
    double most = -INFINITY;

    for (int sign = -1; sign <= 1; sign += 2) {
        double c[SWEEP_DEGREE + 1], at[SWEEP_DEGREE + 1];
        for (int k = 0; k <= SWEEP_DEGREE; k++)
            c[k] = vec_dot(row, s->c[k]) + sign * length * s->r[k];
        const int count = polynomial_pieces(c, sweep->degree, 0, 1, at);
        for (int k = 0; k < count; k++)
            most = fmax(most, polynomial_value(c, SWEEP_DEGREE, at[k]));
    }
    return most;
}

static void bound_segment(const SphereSweep *sweep, const SweepSegment *s, const Transform *t, Vec3 *low, Vec3 *high)
{
    double ends[2][3];

    for (int k = 0; k < 3; k++) {
        const Vec3 row = vec3(t->m[k][0], t->m[k][1], t->m[k][2]);
        ends[0][k] = t->m[k][3] - support(sweep, s, vec_neg(row));
        ends[1][k] = t->m[k][3] + support(sweep, s, row);
    }
    for (int i = 0; i < 2; i++)
        shape_bound_point(low, high, vec3(ends[i][0], ends[i][1], ends[i][2]));
}

void sphere_sweep_set_bounds(SphereSweep *sweep)
{
    const Transform none = transform_identity();

    sweep->low = vec3(INFINITY, INFINITY, INFINITY);
    sweep->high = vec_neg(sweep->low);
    for (int i = 0; i < sweep->count; i++) {
        SweepSegment *s = &sweep->segments[i];
        s->low = vec3(INFINITY, INFINITY, INFINITY);
        s->high = vec_neg(s->low);
        bound_segment(sweep, s, &none, &s->low, &s->high);
        shape_bound_point(&sweep->low, &sweep->high, s->low);
        shape_bound_point(&sweep->low, &sweep->high, s->high);
    }
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const SphereSweep *sweep = sweep_of(&primitive->shape);

    for (int i = 0; i < sweep->count; i++)
        bound_segment(sweep, &sweep->segments[i], &primitive->transform, low, high);
}

/* ---- intersection ---- */

/* What a line has inside: intervals apart from each other, ascending. */
typedef struct Interval {
    double from, to;
    int from_face, to_face;
} Interval;
typedef struct Intervals {
    int count;
    Interval at[MOST_INTERVALS];
} Intervals;

static void add_interval(Intervals *all, Interval in)
{
    int first = 0, last;

    while (first < all->count && all->at[first].to < in.from)
        first++;
    for (last = first; last < all->count && all->at[last].from <= in.to; last++) {
        if (all->at[last].from < in.from)
            in.from = all->at[last].from, in.from_face = all->at[last].from_face;
        if (all->at[last].to > in.to)
            in.to = all->at[last].to, in.to_face = all->at[last].to_face;
    }
    /* first..last - 1 are one with it. Of too many the farthest is lost. */
    if (last == first) {
        if (first == MOST_INTERVALS)
            return;
        all->count -= all->count == MOST_INTERVALS;
        for (int i = all->count++; i > first; i--)
            all->at[i] = all->at[i - 1];
    } else {
        for (int i = last; i < all->count; i++)
            all->at[first + 1 + i - last] = all->at[i];
        all->count -= last - first - 1;
    }
    all->at[first] = in;
}

/* The line and one segment: where it is nearest to centres, and the square of half the length within a sphere. */
typedef struct Meeting {
    double a[SWEEP_DEGREE + 1], p[SWEEP_DEGREE + 1], q[SWEEP_DEGREE + 1], w2[SQUARE + 1];
    const SweepSegment *segment;
} Meeting;

static void add_product(double *out, const double *a, int na, const double *b, int nb, double factor)
{
    for (int i = 0; i <= na; i++)
        for (int j = 0; j <= nb; j++)
            out[i + j] += factor * a[i] * b[j];
}

static double half_at(const Meeting *m, double u)
{
    const double p = polynomial_value(m->p, SWEEP_DEGREE, u), q = polynomial_value(m->q, SWEEP_DEGREE, u),
                 r = radius_at(m->segment, u), far = hypot(p, q);

    return r > far ? sqrt((r - far) * (r + far)) : 0;
}

/* Where a - w or a + w may be extreme: 4 a'^2 w^2 = (w^2)'^2. */
static int extremes(const Meeting *m, int degree, double low, double high, double *points)
{
    double slope[SWEEP_DEGREE + 1] = {0}, slope2[SQUARE + 1] = {0}, rate[SQUARE + 1] = {0}, c[EXTREMES + 1] = {0};
    int count;

    for (int i = 1; i <= degree; i++)
        slope[i - 1] = i * m->a[i];
    for (int i = 1; i <= 2 * degree; i++)
        rate[i - 1] = i * m->w2[i];
    add_product(slope2, slope, degree - 1, slope, degree - 1, 4);
    add_product(c, slope2, 2 * degree - 2, m->w2, 2 * degree, 1);
    add_product(c, rate, 2 * degree - 1, rate, 2 * degree - 1, -1);
    count = polynomial_roots(c, 4 * degree - 2, low, high, points);
    points[count++] = low;
    points[count++] = high;
    return count;
}

static void add_run(const Meeting *m, int degree, double low, double high, int face, Intervals *all)
{
    double points[EXTREMES + 2];
    const int count = extremes(m, degree, low, high, points);
    Interval in = {INFINITY, -INFINITY, face, face};

    for (int i = 0; i < count; i++) {
        double a = polynomial_value(m->a, SWEEP_DEGREE, points[i]), w = half_at(m, points[i]);
        in.from = fmin(in.from, a - w);
        in.to = fmax(in.to, a + w);
    }
    if (in.from < in.to)
        add_interval(all, in);
}

static void meet_segment(const SphereSweep *sweep, int index, const ShapeLine *line, Vec3 e, Vec3 f, Intervals *all)
{
    const SweepSegment *s = &sweep->segments[index];
    const int degree = sweep->degree;
    double ends[SQUARE + 2] = {0}, roots[SQUARE];
    Meeting m = {.segment = s};
    int count, positive;

    for (int k = 0; k <= degree; k++) {
        Vec3 c = k ? s->c[k] : vec_sub(s->c[0], line->origin);
        m.a[k] = vec_dot(c, line->direction);
        m.p[k] = vec_dot(c, e);
        m.q[k] = vec_dot(c, f);
    }
    add_product(m.w2, s->r, degree, s->r, degree, 1);
    add_product(m.w2, m.p, degree, m.p, degree, -1);
    add_product(m.w2, m.q, degree, m.q, degree, -1);
    count = polynomial_roots(m.w2, 2 * degree, 0, 1, roots);
    for (int i = 0; i < count; i++)
        ends[i + 1] = roots[i];
    ends[count + 1] = 1;
    positive = polynomial_value(m.w2, 2 * degree, 0.5 * ends[1]) > 0;
    for (int i = 0; i <= count; i++, positive = !positive)
        if (positive)
            add_run(&m, degree, ends[i], ends[i + 1], index, all);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const SphereSweep *sweep = sweep_of(&primitive->shape);
    const ShapeLine line = shape_line(ray, vec_scale(vec_add(sweep->low, sweep->high), 0.5));
    ShapeCrossings crossings = shape_crossings(ray);
    Intervals all;
    Vec3 e, f;

    all.count = 0;
    vec_frame(line.direction, &e, &f);
    for (int i = 0; i < sweep->count; i++) {
        const SweepSegment *s = &sweep->segments[i];
        double low = -INFINITY, high = INFINITY;
        if (shape_line_clip(&line, s->low, s->high, &low, &high))
            meet_segment(sweep, i, &line, e, f, &all);
    }
    for (int i = 0; i < all.count; i++) {
        shape_add_crossing(&crossings, shape_line_t(&line, all.at[i].from), all.at[i].from_face);
        shape_add_crossing(&crossings, shape_line_t(&line, all.at[i].to), all.at[i].to_face);
    }
    return shape_crossings_end(&crossings, primitive, vec_length(vec_sub(sweep->high, sweep->low)), t, face);
}

/* ---- points ---- */

/* The u of the segment's sphere that p is deepest in, and the square of its distance from the centre less the
 * radius'. */
static double deepest(const SphereSweep *sweep, const SweepSegment *s, Vec3 p, double *square)
{
    const int n = sweep->degree;
    double c[SQUARE + 1] = {0}, slope[SQUARE] = {0}, at[SQUARE + 1], best = 0;
    int count;

    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++) {
            Vec3 a = i ? s->c[i] : vec_sub(s->c[0], p), b = j ? s->c[j] : vec_sub(s->c[0], p);
            c[i + j] += vec_dot(a, b) - s->r[i] * s->r[j];
        }
    for (int i = 1; i <= 2 * n; i++)
        slope[i - 1] = i * c[i];
    count = polynomial_roots(slope, 2 * n - 1, 0, 1, at);
    at[count++] = 0;
    at[count++] = 1;
    *square = INFINITY;
    for (int i = 0; i < count; i++) {
        Vec3 away = vec_sub(p, centre_at(s, at[i]));
        double r = radius_at(s, at[i]), f = vec_dot(away, away) - r * r;
        if (f < *square)
            *square = f, best = at[i];
    }
    return best;
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const SphereSweep *sweep = sweep_of(&primitive->shape);
    const SweepSegment *s = &sweep->segments[face];
    double square, u = deepest(sweep, s, p, &square), size;
    Vec3 centre = centre_at(s, u);

    out->normal = vec_sub(p, centre);
    size = vec_length(out->normal);
    out->p = size > 0 ? vec_mad(centre, out->normal, radius_at(s, u) / size) : p;
    if (!(size > 0))
        out->normal = vec3(0, 1, 0);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const SphereSweep *sweep = sweep_of(&surface->primitive->shape);
    const SweepSegment *s = &sweep->segments[surface->face];
    Vec3 p = shape_local_point(surface), along, across, up;
    double square, u = deepest(sweep, s, p, &square);

    along = vec_normalize(vec_mad(s->c[1], vec_mad(vec_scale(s->c[2], 2), s->c[3], 3 * u), u));
    up = fabs(along.y) < 0.99 ? vec3(0, 1, 0) : vec3(1, 0, 0);
    up = vec_normalize(vec_mad(up, along, -vec_dot(up, along)));
    across = vec_cross(along, up);
    p = vec_sub(p, centre_at(s, u));
    out->natural = (Vec2){(surface->face + u) / sweep->count, shape_turn(vec_dot(p, up), vec_dot(p, across))};
}

static int inside(const Shape *shape, Vec3 p)
{
    const SphereSweep *sweep = sweep_of(shape);

    for (int i = 0; i < sweep->count; i++) {
        const SweepSegment *s = &sweep->segments[i];
        double square;
        int within = 1;
        for (int k = 0; k < 3; k++)
            within &= vec_component(p, k) >= vec_component(s->low, k) &&
                      vec_component(p, k) <= vec_component(s->high, k);
        if (!within)
            continue;
        deepest(sweep, s, p, &square);
        if (square < 0)
            return 1;
    }
    return 0;
}

const ShapeOps shape_sphere_sweep = {
    .name = "sphere_sweep",
    .properties = SHAPE_V_PERIODIC,
    SHAPE_BOUNDED,
};
