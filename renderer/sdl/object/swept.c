/* Parsers of shapes that are made of splines: prism, lathe, sor, sphere_sweep. */
#include "sdl/object/shape.h"
#include "shape/profile.h"
#include "shape/sor.h"
#include "shape/sphere_sweep.h"

#define MAX_POINTS 1e6

typedef enum SplineKind { SPLINE_LINEAR, SPLINE_QUADRATIC, SPLINE_CUBIC, SPLINE_BEZIER } SplineKind;

static int accept_spline(Sdl *sdl, SplineKind *kind)
{
    static const char *const words[] = {"linear_spline", "quadratic_spline", "cubic_spline", "bezier_spline"};
    for (int i = 0; i < 4; i++)
        if (sdl_accept(sdl, words[i])) {
            *kind = (SplineKind)i;
            return 1;
        }
    return 0;
}

static Vec2 *parse_points(Sdl *sdl, int least, int *count)
{
    const double n = sdl_float(sdl);
    if (!(n >= least && n <= MAX_POINTS))
        sdl_error(sdl, "a spline of this kind has %d to %.0f points", least, MAX_POINTS);
    *count = (int)n;
    Vec2 *points = sdl_alloc(sdl, (size_t)(*count + 1) * sizeof *points); /* one more, to close a ring by */
    for (int i = 0; i < *count; i++) {
        sdl_optional_comma(sdl);
        points[i] = sdl_vector2(sdl);
    }
    return points;
}

static Vec2 sum(double a, Vec2 p, double b, Vec2 q, double c, Vec2 r, double d, Vec2 s)
{
    return (Vec2){a * p.u + b * q.u + c * r.u + d * s.u, a * p.v + b * q.v + c * r.v + d * s.v};
}

/* The segment from p[1] to p[2] (bezier: from p[0] to p[3]); beside it p[0] and p[3] give the direction. */
static void set_segment(ProfileSegment *s, SplineKind kind, const Vec2 p[4])
{
    const Vec2 none = {0, 0};
    s->c[0] = kind == SPLINE_BEZIER ? p[0] : p[1];
    s->end = kind == SPLINE_BEZIER ? p[3] : p[2];
    switch (kind) {
    case SPLINE_LINEAR:
        s->c[1] = sum(-1, p[1], 1, p[2], 0, none, 0, none);
        break;
    case SPLINE_QUADRATIC:
        s->c[1] = sum(-0.5, p[0], 0.5, p[2], 0, none, 0, none);
        s->c[2] = sum(0.5, p[0], -1, p[1], 0.5, p[2], 0, none);
        break;
    case SPLINE_CUBIC:
        s->c[1] = sum(-0.5, p[0], 0.5, p[2], 0, none, 0, none);
        s->c[2] = sum(1, p[0], -2.5, p[1], 2, p[2], -0.5, p[3]);
        s->c[3] = sum(-0.5, p[0], 1.5, p[1], -1.5, p[2], 0.5, p[3]);
        break;
    case SPLINE_BEZIER:
        s->c[1] = sum(-3, p[0], 3, p[1], 0, none, 0, none);
        s->c[2] = sum(3, p[0], -6, p[1], 3, p[2], 0, none);
        s->c[3] = sum(-1, p[0], 3, p[1], -3, p[2], 1, p[3]);
        break;
    }
}

static Profile *new_profile(Sdl *sdl, SplineKind kind, int segments)
{
    Profile *profile = sdl_alloc(sdl, sizeof *profile + (size_t)segments * sizeof *profile->segments);
    profile->degree = kind == SPLINE_LINEAR ? 1 : kind == SPLINE_QUADRATIC ? 2 : 3;
    return profile;
}

static const int least_points[] = {
    [SPLINE_LINEAR] = 2, [SPLINE_QUADRATIC] = 3, [SPLINE_CUBIC] = 4, [SPLINE_BEZIER] = 4};

/* One segment from points[i] on, or none where it has no length. */
static void add_segment(Profile *profile, SplineKind kind, const Vec2 *points, int i, int count)
{
    Vec2 p[4] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    const int first = kind == SPLINE_LINEAR ? i - 1 : i;
    for (int k = 0; k < 4; k++)
        if (first + k >= 0 && first + k < count)
            p[k] = points[first + k];
    ProfileSegment *s = &profile->segments[profile->count];
    set_segment(s, kind, p);
    profile->count += s->c[0].u != s->end.u || s->c[0].v != s->end.v || profile->degree > 1;
}

void parse_lathe(Sdl *sdl, Object *object)
{
    SplineKind kind = SPLINE_LINEAR;
    int count;
    accept_spline(sdl, &kind);
    const Vec2 *points = parse_points(sdl, least_points[kind], &count);
    if (kind == SPLINE_BEZIER && count % 4 != 0)
        sdl_error(sdl, "a bezier_spline has four points a segment");
    Profile *profile = new_profile(sdl, kind, count);
    const int step = kind == SPLINE_BEZIER ? 4 : 1;
    for (int i = 0; i + least_points[kind] <= count; i += step)
        add_segment(profile, kind, points, i, count);
    profile_set_bounds(profile);
    profile->size = fmax(fmax(fabs(profile->low.u), fabs(profile->high.u)), profile->high.v - profile->low.v);
    object->shape.ops = &shape_lathe;
    object->shape.data = profile;
    if (!(profile->size > 0) || profile->count == 0)
        object->kind = OBJECT_EMPTY;
}

/* ---- prisms ---- */

static int same(Vec2 a, Vec2 b)
{
    return fabs(a.u - b.u) < 1e-10 && fabs(a.v - b.v) < 1e-10;
}

/* The rings of a bezier_spline are as long as its segments join. */
static void add_bezier(Sdl *sdl, Profile *profile, Vec2 *points, int count)
{
    if (count % 4 != 0)
        sdl_error(sdl, "a bezier_spline has four points a segment");
    for (int i = 0, ring = 0; i < count; i += 4) {
        if (same(points[i + 3], points[ring])) {
            points[i + 3] = points[ring];
            ring = i + 4;
        } else if (i + 4 < count && same(points[i + 3], points[i + 4])) {
            points[i + 4] = points[i + 3];
        } else {
            sdl_error(sdl, "the curve of this prism is not closed");
        }
        add_segment(profile, SPLINE_BEZIER, points, i, count);
    }
}

/* Rings begin with so many points that only give a direction, and end with as many; a ring ends where its first point
 * that counts comes again. */
static void add_rings(Sdl *sdl, Profile *profile, SplineKind kind, Vec2 *points, int count)
{
    const int before = kind != SPLINE_LINEAR, after = kind == SPLINE_CUBIC;
    int ring = before;
    if (kind == SPLINE_LINEAR && !same(points[0], points[count - 1])) {
        int closed = 0;
        for (int i = 1; i < count; i++)
            if (same(points[i], points[closed]))
                closed = ++i;
        if (closed < count) {
            sdl_warn(sdl, "the curve of this prism is closed");
            points[count++] = points[closed];
        }
    }
    for (int i = ring + 1; i < count; i++) {
        if (same(points[i], points[ring]))
            points[i] = points[ring];
        add_segment(profile, kind, points, i - 1 - before, count);
        if (points[i].u == points[ring].u && points[i].v == points[ring].v) {
            ring = i + after + before + 1;
            i = ring;
        } else if (i + 1 == count) {
            sdl_error(sdl, "the curve of this prism is not closed");
        }
    }
}

void parse_prism(Sdl *sdl, Object *object)
{
    SplineKind kind = SPLINE_LINEAR;
    int conic = 0, count;
    for (;;) {
        if (sdl_accept(sdl, "conic_sweep"))
            conic = 1;
        else if (sdl_accept(sdl, "linear_sweep"))
            conic = 0;
        else if (!accept_spline(sdl, &kind))
            break;
    }
    const double a = sdl_float(sdl);
    sdl_optional_comma(sdl);
    const double b = sdl_float(sdl);
    sdl_optional_comma(sdl);
    Vec2 *points = parse_points(sdl, least_points[kind] + 1 - (kind == SPLINE_BEZIER), &count);
    object->shape.open = sdl_accept(sdl, "open");
    Profile *profile = new_profile(sdl, kind, count);
    profile->conic = conic;
    if (kind == SPLINE_BEZIER)
        add_bezier(sdl, profile, points, count);
    else
        add_rings(sdl, profile, kind, points, count);
    profile_set_bounds(profile);
    object->shape.ops = &shape_prism;
    object->shape.data = profile;
    object->shape.r0 = fmin(a, b);
    object->shape.r1 = fmax(a, b);
    profile->size = fmax(profile->high.u - profile->low.u, profile->high.v - profile->low.v);
    if (a == b || !(profile->size > 0) || profile->count == 0)
        object->kind = OBJECT_EMPTY;
}

/* ---- sor ---- */

void parse_sor(Sdl *sdl, Object *object)
{
    int count;
    const Vec2 *p = parse_points(sdl, 4, &count);
    object->shape.open = sdl_accept(sdl, "open");
    Sor *sor = sdl_alloc(sdl, sizeof *sor + (size_t)count * sizeof *sor->segments);
    for (int i = 0; i + 3 < count; i++) {
        const Vec2 *q = p + i;
        const double h = q[2].v - q[1].v, f0 = q[1].u * q[1].u, f1 = q[2].u * q[2].u;
        if (!(h > 0) || !(q[2].v > q[0].v) || !(q[3].v > q[1].v))
            sdl_error(sdl, "the points of a sor go upward, from the second to the last but one");
        /* The slope of rho^2 at either end, from the points beside it. */
        const double m0 = 2 * q[1].u * (q[2].u - q[0].u) / (q[2].v - q[0].v),
                     m1 = 2 * q[2].u * (q[3].u - q[1].u) / (q[3].v - q[1].v), rise = (f1 - f0) / h;
        sor->segments[sor->count++] = (SorSegment){
            q[1].v, q[2].v, {f0, m0, (3 * rise - 2 * m0 - m1) / h, (m0 + m1 - 2 * rise) / (h * h)}, f1, 0, 0};
    }
    sor_set_bounds(sor);
    object->shape.ops = &shape_sor;
    object->shape.data = sor;
    if (!(sor->radius > 0))
        object->kind = OBJECT_EMPTY;
}

/* ---- sphere_sweep ---- */

/* Rows: how the coefficients of 1, u, u^2 and u^3 come from four points that follow each other. */
static const double b_spline[4][4] = {{1.0 / 6, 4.0 / 6, 1.0 / 6, 0},
                                      {-0.5, 0, 0.5, 0},
                                      {0.5, -1, 0.5, 0},
                                      {-1.0 / 6, 0.5, -0.5, 1.0 / 6}},
                    catmull_rom[4][4] = {{0, 1, 0, 0}, {-0.5, 0, 0.5, 0}, {1, -2.5, 2, -0.5}, {-0.5, 1.5, -1.5, 0.5}},
                    linear[4][4] = {{1, 0, 0, 0}, {-1, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};

void parse_sphere_sweep(Sdl *sdl, Object *object)
{
    const double(*matrix)[4] = linear;
    if (sdl_accept(sdl, "b_spline"))
        matrix = b_spline;
    else if (sdl_accept(sdl, "cubic_spline"))
        matrix = catmull_rom;
    else
        sdl_expect(sdl, "linear_spline");
    const int points = matrix == linear ? 2 : 4;
    sdl_optional_comma(sdl);
    const double n = sdl_float(sdl);
    if (!(n >= points && n <= MAX_POINTS))
        sdl_error(sdl, "a sphere_sweep of this kind has %d to %.0f spheres", points, MAX_POINTS);
    const int count = (int)n;
    Vec3 *centres = sdl_alloc(sdl, (size_t)count * sizeof *centres);
    double *radii = sdl_alloc(sdl, (size_t)count * sizeof *radii);
    for (int i = 0; i < count; i++) {
        sdl_optional_comma(sdl);
        centres[i] = sdl_vector(sdl);
        sdl_optional_comma(sdl);
        radii[i] = sdl_float(sdl);
    }
    if (sdl_accept(sdl, "tolerance"))
        sdl_float(sdl);
    SphereSweep *sweep = sdl_alloc(sdl, sizeof *sweep + (size_t)count * sizeof *sweep->segments);
    sweep->degree = matrix == linear ? 1 : 3;
    for (int i = 0; i + points <= count; i++) {
        SweepSegment *s = &sweep->segments[sweep->count++];
        for (int k = 0; k <= sweep->degree; k++)
            for (int j = 0; j < points; j++) {
                s->c[k] = vec_mad(s->c[k], centres[i + j], matrix[k][j]);
                s->r[k] += matrix[k][j] * radii[i + j];
            }
    }
    sphere_sweep_set_bounds(sweep);
    object->shape.ops = &shape_sphere_sweep;
    object->shape.data = sweep;
}
