/* What the files of shapes share: lines, bounds of circles, areas under a transform. */
#include <float.h>
#include <string.h>
#include "shape/shape.h"

double shape_turn(double x, double y)
{
    double turn = atan2(y, x) / (2 * PI);

    return turn < 0 ? turn + 1 : turn;
}

Vec2 shape_angles(Vec3 p)
{
    return (Vec2){shape_turn(p.x, p.z), 0.5 + atan2(p.y, hypot(p.x, p.z)) / PI};
}

double shape_even_density(const Primitive *primitive, Vec3 p, int face)
{
    (void)p, (void)face;
    return shape_inverse(primitive->shape.ops->area(primitive));
}

ShapeLine shape_line(const ShapeRay *ray, Vec3 centre)
{
    double length = vec_length(ray->direction), shift;
    Vec3 d = vec_scale(ray->direction, 1 / length);

    shift = vec_dot(vec_sub(centre, ray->origin), d);
    return (ShapeLine){vec_mad(ray->origin, d, shift), d, shift, length};
}

static int clip_axis(double o, double d, double box_low, double box_high, double *low, double *high)
{
    double a, b;

    if (d == 0)
        return o >= box_low && o <= box_high;
    a = (box_low - o) / d;
    b = (box_high - o) / d;
    *low = fmax(*low, fmin(a, b));
    *high = fmin(*high, fmax(a, b));
    return *low < *high;
}

int shape_line_clip(const ShapeLine *line, Vec3 box_low, Vec3 box_high, double *low, double *high)
{
    Vec3 o = line->origin, d = line->direction;

    return clip_axis(o.x, d.x, box_low.x, box_high.x, low, high) &&
           clip_axis(o.y, d.y, box_low.y, box_high.y, low, high) &&
           clip_axis(o.z, d.z, box_low.z, box_high.z, low, high);
}

int shape_first_crossing(const ShapeRay *ray, const ShapeLine *line, const double *s, int count, double *t)
{
    for (int i = 0; i < count; i++) {
        double at = shape_line_t(line, s[i]);
        if (i + 1 < count && shape_line_t(line, s[i + 1]) == at)
            i++;
        else if (at > ray->tmin)
            return shape_accept(ray, at, t) ? i : -1;
    }
    return -1;
}

int shape_crossings_end(const ShapeCrossings *c, const Primitive *primitive, double size, double *t, int *face)
{
    const double length = vec_length(c->ray->direction);
    double found = c->first;
    int of = c->first_face;

    if (found == c->near && found * length < 1e-3 * size) {
        ShapePoint on = {.p = c->ray->origin, .normal = {0, 1, 0}};
        primitive->shape.ops->point(primitive, c->ray->origin, c->near_face, &on);
        /* Along the normal: in the surface, the nearest point is known less well. */
        const Vec3 off = vec_sub(on.p, c->ray->origin);
        if (fabs(vec_dot(off, on.normal)) <=
                (2 * c->ray->slack + 16 * DBL_EPSILON * size) * vec_length(on.normal) &&
            vec_length(off) < 1e-9 * size)
            found = c->second, of = c->second_face;
    }
    if (!shape_accept(c->ray, found, t))
        return 0;
    *face = of;
    return 1;
}

/* Newton's steps from outside: of a convex function they never pass the root. */
static int approach(const Shape *shape, ShapeConvex *f, const ShapeLine *line, double *s, double end, double sign)
{
    const double scale = fabs(*s) + fabs(end);

    for (int i = 0; i < 200; i++) {
        Vec3 gradient;
        double v = f(shape, vec_mad(line->origin, line->direction, *s), &gradient), step,
               slope = sign * vec_dot(gradient, line->direction);
        if (v <= 0)
            return 1;
        if (!(slope < 0))
            return 0;
        step = -v / slope;
        *s += sign * step;
        if (sign * (end - *s) < 0)
            return 0;
        if (step <= 2 * DBL_EPSILON * scale)
            return 1;
    }
    return 1;
}

int shape_add_convex(ShapeCrossings *crossings, const Shape *shape, ShapeConvex *f, const ShapeLine *line, double low,
                     double high)
{
    double s[2] = {low, high};

    if (!approach(shape, f, line, &s[0], high, 1) || !approach(shape, f, line, &s[1], s[0], -1) || !(s[0] < s[1]))
        return 0;
    for (int i = 0; i < 2; i++)
        shape_add_crossing(crossings, shape_line_t(line, s[i]), 0);
    return 1;
}

double shape_share(Vec3 position)
{
    uint64_t bits[3], hash = 0;

    memcpy(bits, &position, sizeof(bits));
    for (int i = 0; i < 3; i++) { /* Steele's mixing function of SplitMix64 */
        hash += bits[i] + 0x9e3779b97f4a7c15u;
        hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
        hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
        hash ^= hash >> 31;
    }
    return (double)(hash >> 11) * 0x1p-53;
}

void shape_bound_point(Vec3 *low, Vec3 *high, Vec3 p)
{
    *low = vec_min(*low, p), *high = vec_max(*high, p);
}

void shape_bound_box(Vec3 *low, Vec3 *high, const Transform *t, Vec3 from, Vec3 to)
{
    for (int i = 0; i < 8; i++)
        shape_bound_point(
            low, high, transform_point(t, vec3(i & 1 ? to.x : from.x, i & 2 ? to.y : from.y, i & 4 ? to.z : from.z)));
}

void shape_bound_circle(Vec3 *low, Vec3 *high, const Transform *t, Vec3 centre, int i, int j, double radius,
                        double ball)
{
    Vec3 p = transform_point(t, centre), half;
    double extent[3];

    for (int k = 0; k < 3; k++) {
        const double *row = t->m[k];
        extent[k] = radius * hypot(row[i], row[j]) + ball * sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
    }
    half = vec3(extent[0], extent[1], extent[2]);
    shape_bound_point(low, high, vec_sub(p, half));
    shape_bound_point(low, high, vec_add(p, half));
}

void shape_bound_half_space(const Primitive *primitive, int axis, Vec3 *low, Vec3 *high)
{
    Vec3 n = shape_world_normal(primitive, vec3(axis == 0, axis == 1, axis == 2));
    Vec3 p = transform_point(&primitive->transform, vec3(0, 0, 0));
    const double normal[3] = {n.x, n.y, n.z}, at[3] = {p.x, p.y, p.z};
    double *ends[2][3] = {{&low->x, &low->y, &low->z}, {&high->x, &high->y, &high->z}};

    *low = vec3(-INFINITY, -INFINITY, -INFINITY);
    *high = vec_neg(*low);
    for (int i = 0; i < 3; i++)
        if (fabs(normal[(i + 1) % 3]) + fabs(normal[(i + 2) % 3]) < 1e-15)
            *ends[normal[i] > 0][i] = at[i];
}

double shape_stretch(const Transform *t, Vec3 e, Vec3 f)
{
    return vec_length(vec_cross(transform_vector(t, e), transform_vector(t, f)));
}

Vec3 shape_axis(const Transform *t, int i)
{
    return vec3(t->m[0][i], t->m[1][i], t->m[2][i]);
}

double shape_circumference(double radius, Vec3 e, Vec3 f)
{
    return 2 * PI * radius * sqrt((vec_dot(e, e) + vec_dot(f, f)) / 2);
}

double shape_similarity(const Transform *t)
{
    Vec3 x = shape_axis(t, 0), y = shape_axis(t, 1), z = shape_axis(t, 2);
    double xx = vec_dot(x, x), bound = 1e-12 * xx;

    if (fabs(vec_dot(x, y)) > bound || fabs(vec_dot(y, z)) > bound || fabs(vec_dot(z, x)) > bound)
        return 0;
    return fabs(vec_dot(y, y) - xx) <= bound && fabs(vec_dot(z, z) - xx) <= bound ? sqrt(xx) : 0;
}

Vec3 shape_world_normal(const Primitive *primitive, Vec3 normal)
{
    Vec3 n = vec_normalize(transform_normal(&primitive->transform, normal));

    return primitive->inverse ? vec_neg(n) : n;
}
