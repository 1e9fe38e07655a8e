/* The surface where a function has the value threshold, within a container: inside it is lower. Canonical space is that
 * of the function. Faces: 0 the surface, 1 to 6 sides of a box that contains it, 7 a sphere that does; unless it is
 * open, these close it. Natural parametrisation: the direction from the container's centre, as that of a sphere.
 *
 * Crossings are found as POV-Ray finds them: an interval of the ray is halved until it is shorter than accuracy, unless
 * its ends are so far from the threshold that the function cannot get there with slopes of max_gradient. Then the
 * crossing is located exactly. Where the slopes are larger than said, parts of the surface may be missed, as in
 * POV-Ray. The number of crossings is not limited: max_trace is of no concern. */
#include <float.h>
#include "shape/isosurface.h"
#include "shape/shape.h"

enum { FACE_SURFACE, FACE_BOX, FACE_SPHERE = 7 };

static double height(const Isosurface *iso, Vec3 p)
{
    return function_at(iso->function, p) - iso->threshold;
}

/* ---- the container ---- */

typedef struct Range {
    double start, end; /* along the line */
    int start_face, end_face;
} Range;

static int clip_side(double o, double d, double low, double high, int face, Range *range)
{
    if (d == 0)
        return o >= low && o <= high;
    const double a = (low - o) / d, b = (high - o) / d;
    if (fmin(a, b) > range->start) {
        range->start = fmin(a, b);
        range->start_face = face + (a > b);
    }
    if (fmax(a, b) < range->end) {
        range->end = fmax(a, b);
        range->end_face = face + (a <= b);
    }
    return 1;
}

/* The part of the line in the container. */
static int contained(const Isosurface *iso, const ShapeLine *line, Range *range)
{
    const Vec3 o = line->origin, d = line->direction;
    *range = (Range){-INFINITY, INFINITY, FACE_SPHERE, FACE_SPHERE};
    if (!iso->container.spherical)
        return clip_side(o.x, d.x, iso->container.low.x, iso->container.high.x, FACE_BOX, range) &&
               clip_side(o.y, d.y, iso->container.low.y, iso->container.high.y, FACE_BOX + 2, range) &&
               clip_side(o.z, d.z, iso->container.low.z, iso->container.high.z, FACE_BOX + 4, range) &&
               range->start < range->end;
    const Vec3 from = vec_sub(o, iso->container.centre);
    const double middle = -vec_dot(from, d),
                 half = iso->container.radius * iso->container.radius + middle * middle - vec_dot(from, from);
    if (!(half > 0))
        return 0;
    range->start = middle - sqrt(half);
    range->end = middle + sqrt(half);
    return 1;
}

/* ---- crossings ---- */

typedef struct Sample {
    double s, f; /* f: of the height with the sign that makes it positive before the crossing */
} Sample;

typedef struct Search {
    const Isosurface *iso;
    const ShapeLine *line;
    double sign, gradient, accuracy;
    long evaluations;
} Search;

static Sample sample_at(Search *search, double s)
{
    search->evaluations++;
    return (Sample){s, search->sign * height(search->iso, vec_mad(search->line->origin, search->line->direction, s))};
}

/* Raises the gradient in use to what the slope asks for. */
static void adapt(Search *search, double slope)
{
    const Isosurface *iso = search->iso;
    if (iso->evaluates && search->gradient < slope * iso->factor)
        search->gradient = slope * iso->factor * iso->factor;
}

/* The first interval, shorter than accuracy, at whose end f is negative. Depth first, so that what is to the right
 * waits on a stack. A search of more evaluations than any sensible surface needs ends without one: in a container that
 * is a million million times wider than accuracy, it would go on for days. */
static int bracket(Search *search, Sample *left, Sample *end)
{
    enum { DEPTH = 64, EVALUATIONS = 1 << 18 };
    Sample right[DEPTH];
    int top = 0;
    right[0] = *end;
    while (top >= 0 && search->evaluations < EVALUATIONS) {
        const double length = right[top].s - left->s, sum = left->f + right[top].f;
        adapt(search, fabs(right[top].f - left->f) / length);
        if (length < search->accuracy || top == DEPTH - 1) {
            if (right[top].f < 0) {
                *end = right[top];
                return 1;
            }
        } else if (sum < search->gradient * length) {
            const double middle = left->s + 0.5 * length;
            if (middle > left->s && middle < right[top].s) {
                right[top + 1] = sample_at(search, middle);
                top++;
                continue;
            }
        }
        *left = right[top--];
    }
    return 0;
}

/* The crossing in the interval: where f is negative, at most tolerance from where it is not. By regula falsi, and by
 * halves in between. */
static double locate(Search *search, Sample left, Sample right, double tolerance)
{
    double weight = left.f; /* halved while the left end stays */
    for (int i = 0; i < 100 && right.s - left.s > tolerance; i++) {
        double s = left.s + (right.s - left.s) * (weight > 0 ? weight / (weight - right.f) : 0.5);
        if (i % 3 == 2)
            s = 0.5 * (left.s + right.s);
        s = fmin(right.s - 0.5 * tolerance, fmax(left.s + 0.5 * tolerance, s));
        const Sample middle = sample_at(search, s);
        if (middle.f < 0) {
            right = middle;
            weight *= 0.5;
        } else {
            left = middle;
            weight = middle.f;
        }
    }
    return right.s;
}

/* The next crossing after that sample. 0: there is none up to the end. */
static int next_crossing(Search *search, Sample left, double end, double tolerance, double *s)
{
    if (left.f < 0) { /* the side on which it begins */
        search->sign = -1;
        left.f = -left.f;
    }
    Sample right = sample_at(search, end);
    if (search->iso->evaluates && search->gradient > search->iso->least)
        search->gradient *= search->iso->fall;
    if (!bracket(search, &left, &right))
        return 0;
    *s = locate(search, left, right, tolerance);
    return 1;
}

/* Where the search begins. A ray that begins here leaves the surface that it may begin on behind: by a tenth of the
 * accuracy, for no function tells where exactly its surface is. A ray that goes on after a crossing has that behind it,
 * and the sign there tells on which side it goes on. */
static double search_start(const Isosurface *iso, const ShapeRay *ray, const ShapeLine *line, double rounding)
{
    return ray->tmin * line->length - line->shift + (ray->tmin == 0 ? fmax(0.1 * iso->accuracy, rounding) : rounding);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Isosurface *iso = primitive->shape.data;
    const ShapeLine line = shape_line(ray, iso->container.centre);
    Range range;
    double s;

    if (!contained(iso, &line, &range))
        return 0;
    /* POV-Ray measures accuracy in the world. Objects that are scaled down need it in their own space. */
    const double accuracy = iso->accuracy * fmin(1, line.length);
    const double size = fabs(range.start) + fabs(range.end) + vec_length(line.origin);
    const double rounding = 8 * DBL_EPSILON * (fabs(line.shift) + size) + 4 * ray->slack;
    const double start = search_start(iso, ray, &line, rounding);
    if (start >= range.end || shape_line_t(&line, fmax(start, range.start)) >= ray->tmax)
        return 0;
    Search search = {iso, &line, 1, iso->max_gradient, fmax(accuracy, 2 * rounding), 0};
    const Sample first = sample_at(&search, fmax(range.start, start));
    if (range.start > start && !iso->open && first.f < 0) {
        *face = range.start_face;
        return shape_accept(ray, shape_line_t(&line, range.start), t);
    }
    if (next_crossing(&search, first, range.end, rounding, &s)) {
        *face = FACE_SURFACE;
        return shape_accept(ray, shape_line_t(&line, s), t);
    }
    *face = range.end_face;
    return !iso->open && search.sign < 0 && shape_accept(ray, shape_line_t(&line, range.end), t);
}

/* ---- the surface ---- */

static Vec3 side_normal(int face)
{
    const int side = face - FACE_BOX, axis = side / 2;
    const double up = side % 2 ? 1 : -1;
    return vec3(axis == 0 ? up : 0, axis == 1 ? up : 0, axis == 2 ? up : 0);
}

/* By differences over the accuracy, as POV-Ray has them. */
static Vec3 gradient(const Isosurface *iso, Vec3 p)
{
    const double h = 0.5 * iso->accuracy;
    const Vec3 g = vec3(height(iso, vec3(p.x + h, p.y, p.z)) - height(iso, vec3(p.x - h, p.y, p.z)),
                        height(iso, vec3(p.x, p.y + h, p.z)) - height(iso, vec3(p.x, p.y - h, p.z)),
                        height(iso, vec3(p.x, p.y, p.z + h)) - height(iso, vec3(p.x, p.y, p.z - h)));
    const double length = vec_length(g);
    return length > 0 && length < INFINITY ? vec_scale(g, 1 / length) : vec3(1, 0, 0);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Isosurface *iso = primitive->shape.data;

    out->p = p;
    if (face == FACE_SURFACE)
        out->normal = gradient(iso, p);
    else if (face == FACE_SPHERE) {
        out->normal = vec_normalize(vec_sub(p, iso->container.centre));
        out->p = vec_mad(iso->container.centre, out->normal, iso->container.radius);
    } else {
        const Vec3 n = out->normal = side_normal(face);
        const Vec3 side = n.x + n.y + n.z > 0 ? iso->container.high : iso->container.low;
        out->p = vec3(n.x != 0 ? side.x : p.x, n.y != 0 ? side.y : p.y, n.z != 0 ? side.z : p.z);
    }
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Isosurface *iso = surface->primitive->shape.data;
    const Vec3 p = vec_sub(shape_local_point(surface), iso->container.centre);

    out->natural.u = p.x != 0 || p.z != 0 ? shape_turn(p.x, p.z) : 0;
    out->natural.v = 0.5 + atan2(p.y, hypot(p.x, p.z)) / PI;
}

static int inside(const Shape *shape, Vec3 p)
{
    const Isosurface *iso = shape->data;
    const Vec3 from = vec_sub(p, iso->container.centre);

    if (iso->container.spherical
            ? vec_dot(from, from) > iso->container.radius * iso->container.radius
            : p.x < iso->container.low.x || p.x > iso->container.high.x || p.y < iso->container.low.y ||
                  p.y > iso->container.high.y || p.z < iso->container.low.z || p.z > iso->container.high.z)
        return 0;
    return !(height(iso, p) > 0);
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Isosurface *iso = primitive->shape.data;

    if (iso->container.spherical) {
        shape_bound_circle(low, high, &primitive->transform, iso->container.centre, 0, 1, 0, iso->container.radius);
        return;
    }
    for (int i = 0; i < 8; i++) {
        const Vec3 corner = vec3(i & 1 ? iso->container.high.x : iso->container.low.x,
                                 i & 2 ? iso->container.high.y : iso->container.low.y,
                                 i & 4 ? iso->container.high.z : iso->container.low.z);
        shape_bound_point(low, high, transform_point(&primitive->transform, corner));
    }
}

/* ---- evaluate ---- */

static double random_share(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static Vec3 random_point(const Isosurface *iso, uint32_t *state)
{
    const double x = random_share(state), y = random_share(state), z = random_share(state);
    return vec3(iso->container.low.x + x * (iso->container.high.x - iso->container.low.x),
                iso->container.low.y + y * (iso->container.high.y - iso->container.low.y),
                iso->container.low.z + z * (iso->container.high.z - iso->container.low.z));
}

long isosurface_learn(Isosurface *iso)
{
    enum { RAYS = 1000 };
    uint32_t state = 1;
    long evaluations = 0;
    double s;

    for (int i = 0; i < RAYS && evaluations < 1000000; i++) {
        const Vec3 a = random_point(iso, &state), b = random_point(iso, &state);
        const ShapeRay ray = {a, vec_sub(b, a), -INFINITY, INFINITY, 0};
        const ShapeLine line = shape_line(&ray, iso->container.centre);
        Range range;
        if (!contained(iso, &line, &range))
            continue;
        Search search = {iso, &line, 1, iso->max_gradient, iso->accuracy, 0};
        next_crossing(&search, sample_at(&search, range.start), range.end, 0.1 * iso->accuracy, &s);
        evaluations += search.evaluations;
        iso->max_gradient = fmax(iso->max_gradient, search.gradient);
    }
    return evaluations;
}

const ShapeOps shape_isosurface = {
    .name = "isosurface",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
};
