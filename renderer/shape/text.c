/* A letter of text: an outline in x and y, extruded along z from 0 to r0, which may be negative. Faces: 0 at z = 0, 1
 * at the other end, then one for each curve. Natural parametrisation, in units of the font's size: x and y on the front
 * and the back, unmirrored seen from outside; on the sides, the length along the contour and z. There is no
 * uv_mapping.
 *
 * A ray is looked at in the plane of the outline, where it is a line. Its crossings with the outline, sorted along it,
 * give the stretches on which the winding number is not 0; what they share with the time that the ray spends between
 * both ends is inside. So crossings come in pairs, each once and in order. */
#include "shape/shape.h"
#include "shape/text.h"

/* On one line. Outlines that have more are damaged: their letter is not there. */
#define MAX_CROSSINGS 256

typedef struct Crossing {
    double s; /* along the line; of a ray, its t */
    int turn; /* change of the winding number: 1 or -1 */
    int curve;
} Crossing;

/* A line in the plane of the outline. */
typedef struct Line {
    Vec2 origin, direction; /* of unit length */
} Line;

static double across(const Line *line, Vec2 p)
{
    return (p.v - line->origin.v) * line->direction.u - (p.u - line->origin.u) * line->direction.v;
}

static double along(const Line *line, Vec2 p)
{
    return (p.u - line->origin.u) * line->direction.u + (p.v - line->origin.v) * line->direction.v;
}

static double at(const double b[3], double x)
{
    return (1 - x) * ((1 - x) * b[0] + 2 * x * b[1]) + x * x * b[2];
}

/* Where a quadratic with these coefficients of Bézier's form changes its sign in 0..1. Zero counts as positive, so
 * that neighbouring curves agree about the end that they share. */
static int sign_changes(const double b[3], double x[2])
{
    const int first = b[0] >= 0, last = b[2] >= 0;
    const double disc = b[1] * b[1] - b[0] * b[2], slope = b[1] - b[0], bend = b[0] - 2 * b[1] + b[2];
    double q, r0, r1;

    if (first == last && ((b[1] >= 0) == first || !(disc > 0)))
        return 0;
    q = -(slope + copysign(sqrt(fmax(disc, 0)), slope));
    r0 = bend != 0 ? q / bend : -1;
    r1 = q != 0 ? b[0] / q : -1;
    if (first == last) {
        x[0] = fmin(fmax(fmin(r0, r1), 0), 1);
        x[1] = fmin(fmax(fmax(r0, r1), 0), 1);
        return 2;
    }
    /* One root is in range, but for rounding. */
    x[0] = fmin(fmax(fabs(r0 - 0.5) < fabs(r1 - 0.5) ? r0 : r1, 0), 1);
    return 1;
}

static void insert(Crossing *list, int count, Crossing one)
{
    for (; count > 0 && list[count - 1].s > one.s; count--)
        list[count] = list[count - 1];
    list[count] = one;
}

/* All crossings in ascending order; -1: too many. */
static int line_crossings(const Glyph *glyph, const Line *line, Crossing list[MAX_CROSSINGS])
{
    int count = 0;

    for (int i = 0; i < glyph->ncurves; i++) {
        const GlyphCurve *c = &glyph->curves[i];
        const double b[3] = {across(line, c->p[0]), across(line, c->p[1]), across(line, c->p[2])};
        double x[2];
        if ((b[0] >= 0) == (b[2] >= 0) && (b[0] >= 0) == (b[1] >= 0))
            continue;
        const double e[3] = {along(line, c->p[0]), along(line, c->p[1]), along(line, c->p[2])};
        const int n = sign_changes(b, x), turn = b[0] >= 0 ? -1 : 1;
        if (count + n > MAX_CROSSINGS)
            return -1;
        for (int k = 0; k < n; k++)
            insert(list, count++, (Crossing){at(e, x[k]), k == 0 ? turn : -turn, i});
    }
    return count;
}

/* A crossing of the letter. */
typedef struct Event {
    double t;
    int face;
} Event;

/* Where a ray enters and leaves what lies between both ends. Returns 0 where it does not. */
static int between_ends(double depth, Vec3 o, Vec3 d, double shift, Event *in, Event *out)
{
    const double low = fmin(0, depth), high = fmax(0, depth);
    const int below = depth<0, up = d.z> 0; /* below: the face at the lower end */

    *in = (Event){-INFINITY, 0};
    *out = (Event){INFINITY, 0};
    if (d.z == 0)
        return o.z > low && o.z < high;
    *in = (Event){((up ? low : high) - o.z) / d.z + shift, up ? below : !below};
    *out = (Event){((up ? high : low) - o.z) / d.z + shift, up ? !below : below};
    return 1;
}

static int accept_event(const ShapeRay *ray, Event event, double *t, int *face)
{
    if (!shape_accept(ray, event.t, t))
        return 0;
    *face = event.face;
    return 1;
}

/* The nearest end in range of a stretch inside. Stretches that touch are one. */
static int nearest_end(const ShapeRay *ray, const Crossing *list, int count, Event in, Event out, double *t, int *face)
{
    int winding = 0;
    Event from = in;

    for (int i = 0; i < count;) {
        const int before = winding;
        const Event here = {list[i].s, 2 + list[i].curve};
        for (; i < count && list[i].s == here.t; i++)
            winding += list[i].turn;
        if ((before != 0) == (winding != 0))
            continue;
        if (winding != 0) {
            from = here.t > in.t ? here : in;
            continue;
        }
        const Event to = here.t < out.t ? here : out;
        if (from.t < to.t && (accept_event(ray, from, t, face) || accept_event(ray, to, t, face)))
            return 1;
    }
    return 0;
}

/* 1 where the point is in the outline. */
static int in_outline(const Glyph *glyph, double x, double y)
{
    Crossing list[MAX_CROSSINGS];
    const Line line = {{x, y}, {1, 0}};
    int winding = 0, count;

    if (!(x >= glyph->low.u && x <= glyph->high.u && y >= glyph->low.v && y <= glyph->high.v))
        return 0;
    count = line_crossings(glyph, &line, list);
    for (int i = 0; i < count && list[i].s <= 0; i++)
        winding += list[i].turn;
    return winding != 0;
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Glyph *glyph = primitive->shape.data;
    const double depth = primitive->shape.r0;
    const Vec3 middle = vec3((glyph->low.u + glyph->high.u) / 2, (glyph->low.v + glyph->high.v) / 2, depth / 2);
    const Vec3 d = ray->direction;
    const double shift = vec_dot(vec_sub(middle, ray->origin), d) / vec_dot(d, d), speed = hypot(d.x, d.y);
    const Vec3 o = vec_mad(ray->origin, d, shift); /* closest to the middle */
    Crossing list[MAX_CROSSINGS];
    Event in, out;
    Line line;
    int count;

    if (!between_ends(depth, o, d, shift, &in, &out))
        return 0;
    if (!(speed > 1e-12 * fabs(d.z)))
        return in_outline(glyph, o.x, o.y) && (accept_event(ray, in, t, face) || accept_event(ray, out, t, face));
    line = (Line){{o.x, o.y}, {d.x / speed, d.y / speed}};
    count = line_crossings(glyph, &line, list);
    for (int i = 0; i < count; i++)
        list[i].s = list[i].s / speed + shift;
    return nearest_end(ray, list, count, in, out, t, face);
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Glyph *glyph = primitive->shape.data;

    for (int i = 0; i < 8; i++)
        shape_bound_point(low, high,
                          transform_point(&primitive->transform,
                                          vec3(i & 1 ? glyph->high.u : glyph->low.u,
                                               i & 2 ? glyph->high.v : glyph->low.v, i & 4 ? primitive->shape.r0 : 0)));
}

/* The parameter of the curve's point next to p, by the coordinate in which the curve is longer. */
static double nearest_parameter(const GlyphCurve *c, Vec3 p)
{
    const int steep = fabs(c->p[2].v - c->p[0].v) > fabs(c->p[2].u - c->p[0].u);
    const double at_p = steep ? p.y : p.x;
    double b[3], x[2];

    for (int k = 0; k < 3; k++)
        b[k] = (steep ? c->p[k].v : c->p[k].u) - at_p;
    if ((b[0] >= 0) == (b[2] >= 0))
        return fabs(b[0]) < fabs(b[2]) ? 0 : 1;
    sign_changes(b, x);
    return x[0];
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Glyph *glyph = primitive->shape.data;
    const double depth = primitive->shape.r0;

    if (face < 2) {
        out->p = vec3(p.x, p.y, face ? depth : 0);
        out->normal = vec3(0, 0, (face == 1) == (depth > 0) ? 1 : -1);
        return;
    }
    const GlyphCurve *c = &glyph->curves[face - 2];
    const double x = nearest_parameter(c, p);
    const double us[3] = {c->p[0].u, c->p[1].u, c->p[2].u}, vs[3] = {c->p[0].v, c->p[1].v, c->p[2].v};
    Vec2 slope = {(1 - x) * (us[1] - us[0]) + x * (us[2] - us[1]), (1 - x) * (vs[1] - vs[0]) + x * (vs[2] - vs[1])};
    if (slope.u == 0 && slope.v == 0)
        slope = (Vec2){us[2] - us[0], vs[2] - vs[0]};
    out->p = vec3(at(us, x), at(vs, x), fmin(fmax(p.z, fmin(0, depth)), fmax(0, depth)));
    out->normal = vec3(slope.v, -slope.u, 0);
    /* Outlines of either sense: the filled side is where a small step leads inside. */
    const double step =
        1e-6 * fmax(glyph->high.u - glyph->low.u, glyph->high.v - glyph->low.v) / hypot(slope.u, slope.v);
    if (in_outline(glyph, out->p.x + step * out->normal.x, out->p.y + step * out->normal.y))
        out->normal = vec_neg(out->normal);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Shape *shape = &surface->primitive->shape;
    const Glyph *glyph = shape->data;
    const Vec3 p = shape_local_point(surface);

    if (surface->face < 2) {
        const int seen_from_below = (surface->face == 0) == (shape->r0 > 0);
        out->natural = (Vec2){seen_from_below ? p.x : -p.x, p.y};
        return;
    }
    const GlyphCurve *c = &glyph->curves[surface->face - 2];
    out->natural = (Vec2){c->start + c->length * nearest_parameter(c, p), p.z};
}

static int inside(const Shape *shape, Vec3 p)
{
    return p.z >= fmin(0, shape->r0) && p.z <= fmax(0, shape->r0) && in_outline(shape->data, p.x, p.y);
}

const ShapeOps shape_text = {
    .name = "text",
    SHAPE_BOUNDED,
};
