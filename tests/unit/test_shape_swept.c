/* Prisms, lathes, surfaces of revolution and sphere sweeps, as scenes write them: rays against marching, with splines
 * computed by their definitions. */
#include "lib_implicit.h"
#include <math.h>
#include "lib_scene_text.h"
#include "shape/surface.h"

enum { SAMPLES = 256, CURVES = 12 };

static uint32_t state = 11;

/* ---- splines ---- */

typedef enum Kind { LINEAR, QUADRATIC, CUBIC, BEZIER, B_SPLINE } Kind;

/* A point of a spline: of four numbers, for centres and radii. */
typedef struct Point {
    double x[4];
} Point;

static Point mix(Point a, Point b, double t)
{
    for (int i = 0; i < 4; i++)
        a.x[i] = (1 - t) * a.x[i] + t * b.x[i];
    return a;
}

/* The parabola with a at -1, b at 0, c at 1. */
static Point parabola(Point a, Point b, Point c, double t)
{
    for (int i = 0; i < 4; i++)
        a.x[i] = a.x[i] * t * (t - 1) / 2 + b.x[i] * (1 - t) * (1 + t) + c.x[i] * t * (t + 1) / 2;
    return a;
}

/* quadratic: the parabola through three points, cubic: from one parabola over to the next; Bezier's by de Casteljau's
 * rule, B-splines by de Boor's. */
static Point spline(Kind kind, const Point *p, double t)
{
    switch (kind) {
    case LINEAR:
        return mix(p[0], p[1], t);
    case QUADRATIC:
        return parabola(p[0], p[1], p[2], t);
    case CUBIC:
        return mix(parabola(p[0], p[1], p[2], t), parabola(p[1], p[2], p[3], t - 1), t);
    case BEZIER: {
        Point a = mix(p[0], p[1], t), b = mix(p[1], p[2], t), c = mix(p[2], p[3], t);
        return mix(mix(a, b, t), mix(b, c, t), t);
    }
    default: {
        Point a = mix(p[0], p[1], (t + 2) / 3), b = mix(p[1], p[2], (t + 1) / 3), c = mix(p[2], p[3], t / 3);
        return mix(mix(a, b, (t + 1) / 2), mix(b, c, t / 2), t);
    }
    }
}

/* ---- curves in the plane, sampled ---- */

typedef struct Curve {
    Kind kind;
    const Point *from;
    double at[SAMPLES + 1]; /* the parameter; one of them at each turn of v */
    double v[SAMPLES + 1];
} Curve;

static Curve curves[CURVES];
static int ncurves;

static double v_at(const Curve *c, double t)
{
    return spline(c->kind, c->from, t).x[1];
}

/* Where v turns, by thirds. */
static void move_to_turn(Curve *c, int k)
{
    const double up = c->v[k] > c->v[k - 1] ? 1 : -1;
    double a = c->at[k - 1], b = c->at[k + 1];

    for (int i = 0; i < 60; i++) {
        double p = a + (b - a) / 3, q = b - (b - a) / 3;
        if (up * v_at(c, p) > up * v_at(c, q))
            b = q;
        else
            a = p;
    }
    c->at[k] = 0.5 * (a + b);
    c->v[k] = v_at(c, c->at[k]);
}

static void add_curves(Kind kind, const Point *points, int first, int count, int step)
{
    for (int i = 0; i < count; i++) {
        Curve *c = &curves[ncurves++];
        assert_true(ncurves <= CURVES);
        *c = (Curve){.kind = kind, .from = points + first + i * step};
        for (int k = 0; k <= SAMPLES; k++) {
            c->at[k] = (double)k / SAMPLES;
            c->v[k] = v_at(c, c->at[k]);
        }
        for (int k = 1; k < SAMPLES; k++)
            if ((c->v[k] - c->v[k - 1]) * (c->v[k + 1] - c->v[k]) < 0)
                move_to_turn(c, k);
    }
}

/* How often the curves cross the line v = y with u greater than x: odd inside. */
static int is_within(double x, double y)
{
    int odd = 0;

    for (int i = 0; i < ncurves; i++)
        for (int k = 0; k < SAMPLES; k++) {
            const Curve *c = &curves[i];
            const int before = c->v[k] > y;
            double a = c->at[k], b = c->at[k + 1];
            if (before == (c->v[k + 1] > y))
                continue;
            for (int n = 0; n < 50; n++) {
                double m = 0.5 * (a + b);
                if ((v_at(c, m) > y) == before)
                    a = m;
                else
                    b = m;
            }
            odd ^= spline(c->kind, c->from, a).x[0] > x;
        }
    return odd;
}

/* ---- checks ---- */

static void check(const char *text, TestImplicit *f, Vec3 centre, double size, int rays)
{
    Scene *scene = parse(text);
    TestShape shape = {.primitive = *only(scene), .f = f, .centre = centre, .size = size};

    assert_string_equal(messages, "");
    test_shape_at_all_sizes(shape, rays, &state);
    scene_close(&scene);
}

static double lathe(const Primitive *p, Vec3 q)
{
    (void)p;
    return is_within(hypot(q.x, q.z), q.y) ? -1 : 1;
}

#define RING "<0.4,-0.7>, <2.1,-0.8>, <1.5,0.1>, <1.9,0.9>, <1,0.5>"

static const Point ring[] = {{{1, 0.5}},   {{0.4, -0.7}}, {{2.1, -0.8}}, {{1.5, 0.1}},
                             {{1.9, 0.9}}, {{1, 0.5}},    {{0.4, -0.7}}, {{2.1, -0.8}}};

/* Closed curves: those that end anywhere have no surface at their ends. */
static void lathes_match_marching(void **unused)
{
    static const Point leaf[] = {{{0.4, -0.7}}, {{2.1, -1.1}}, {{1.8, 0.4}}, {{1.9, 0.9}},
                                 {{1.9, 0.9}},  {{1, 0.9}},    {{0.3, 0.3}}, {{0.4, -0.7}}};

    (void)unused;
    ncurves = 0;
    add_curves(LINEAR, ring, 1, 5, 1);
    check(V37 "lathe{linear_spline 6, " RING ", <0.4,-0.7>}", lathe, vec3(0, 0, 0), 2, 12);
    ncurves = 0;
    add_curves(QUADRATIC, ring, 0, 5, 1);
    check(V37 "lathe{quadratic_spline 7, <1,0.5>, " RING ", <0.4,-0.7> sturm}", lathe, vec3(0, 0, 0), 2, 12);
    ncurves = 0;
    add_curves(CUBIC, ring, 0, 5, 1);
    check(V37 "lathe{cubic_spline 8, <1,0.5>, " RING ", <0.4,-0.7>, <2.1,-0.8>}", lathe, vec3(0, 0, 0), 2, 12);
    ncurves = 0;
    add_curves(BEZIER, leaf, 0, 2, 4);
    check(V37 "lathe{bezier_spline 8, <0.4,-0.7>, <2.1,-1.1>, <1.8,0.4>, <1.9,0.9>, <1.9,0.9>, <1,0.9>, <0.3,0.3>,"
              "<0.4,-0.7>}",
          lathe, vec3(0, 0, 0), 2, 12);
}

/* Nearly level rays, and level ones, cross a lathe as the steeper ones do: in pairs. */
static void lathes_have_level_rays(void **unused)
{
    Scene *scene = parse(V37 "lathe{cubic_spline 8, <1,0.5>, " RING ", <0.4,-0.7>, <2.1,-0.8>}");
    const Primitive *p = only(scene);

    (void)unused;
    ncurves = 0;
    add_curves(CUBIC, ring, 0, 5, 1);
    for (int i = 0; i < 3000; i++) {
        const double tilt = i % 20 == 0 ? 0 : pow(10, -14 * test_random(&state)), y = 1.6 * test_random(&state) - 0.7;
        Ray ray = {{-5, y, 0.5 * test_random(&state)}, {1, 0, 0}, 0, INFINITY};
        double t, seen[16];
        int face, count = 0;
        ray.direction = vec_normalize(vec3(1, tilt * 1e-3, 0));
        while (shape_intersect(p, &ray, &t, &face)) {
            assert_true(count < 16);
            ray.tmin = seen[count++] = t;
        }
        assert_int_equal(count % 2, 0);
        for (int k = 0; k < count; k++) {
            const double gap = fmin(k > 0 ? seen[k] - seen[k - 1] : 1, k + 1 < count ? seen[k + 1] - seen[k] : 1);
            Vec3 before = vec_mad(ray.origin, ray.direction, seen[k] - 1e-6),
                 after = vec_mad(ray.origin, ray.direction, seen[k] + 1e-6);
            if (gap > 1e-3)
                assert_int_equal(lathe(p, before) > 0, lathe(p, after) < 0);
        }
        if (count == 2 && tilt < 1e-6)
            assert_true(fabs(seen[0] + seen[1] - 10) < 1e-6);
    }
    scene_close(&scene);
}

static double prism(const Primitive *p, Vec3 q)
{
    (void)p;
    return q.y > -0.5 && q.y < 0.7 && is_within(q.x, q.z) ? -1 : 1;
}

static double conic(const Primitive *p, Vec3 q)
{
    (void)p;
    return q.y > 0.3 && q.y < 1.2 && is_within(q.x / q.y, q.z / q.y) ? -1 : 1;
}

#define STAR "<-0.8,-0.7>, <0.9,-0.8>, <0.3,0.1>, <0.7,0.9>, <-0.2,0.5>"
#define HOLE "<-0.3,-0.4>, <0.2,-0.5>, <0.1,0>"

static void prisms_match_marching(void **unused)
{
    static const Point star[] = {{{-0.2, 0.5}}, {{-0.8, -0.7}}, {{0.9, -0.8}},  {{0.3, 0.1}},
                                 {{0.7, 0.9}},  {{-0.2, 0.5}},  {{-0.8, -0.7}}, {{0.9, -0.8}}};
    static const Point hole[] = {{{-0.3, -0.4}}, {{0.2, -0.5}}, {{0.1, 0}}, {{-0.3, -0.4}}};
    static const Point leaf[] = {{{-0.8, -0.7}}, {{0.9, -1.1}}, {{0.6, 0.4}},  {{0.7, 0.9}},
                                 {{0.7, 0.9}},   {{-0.2, 0.9}}, {{-0.9, 0.3}}, {{-0.8, -0.7}}};

    (void)unused;
    ncurves = 0;
    add_curves(LINEAR, star, 1, 5, 1);
    add_curves(LINEAR, hole, 0, 3, 1);
    check(V37 "prism{linear_spline linear_sweep 0.7, -0.5, 10, " STAR ", <-0.8,-0.7>, " HOLE ", <-0.3,-0.4>}", prism,
          vec3(0, 0.1, 0), 1.2, 12);
    check(V37 "prism{conic_sweep 0.3, 1.2, 10, " STAR ", <-0.8,-0.7>, " HOLE ", <-0.3,-0.4>}", conic, vec3(0, 0.8, 0),
          1.5, 12);
    ncurves = 0;
    add_curves(QUADRATIC, star, 0, 5, 1);
    check(V37 "prism{quadratic_spline -0.5, 0.7, 7, <-0.2,0.5>, " STAR ", <-0.8,-0.7>}", prism, vec3(0, 0.1, 0), 1.2,
          12);
    ncurves = 0;
    add_curves(CUBIC, star, 0, 5, 1);
    check(V37 "prism{cubic_spline -0.5, 0.7, 8, <-0.2,0.5>, " STAR ", <-0.8,-0.7>, <0.9,-0.8>}", prism, vec3(0, 0.1, 0),
          1.2, 12);
    check(V37 "prism{cubic_spline conic_sweep 0.3, 1.2, 8, <-0.2,0.5>, " STAR ", <-0.8,-0.7>, <0.9,-0.8>}", conic,
          vec3(0, 0.8, 0), 1.5, 12);
    ncurves = 0;
    add_curves(BEZIER, leaf, 0, 2, 4);
    check(V37 "prism{bezier_spline -0.5, 0.7, 8, <-0.8,-0.7>, <0.9,-1.1>, <0.6,0.4>, <0.7,0.9>, <0.7,0.9>,"
              "<-0.2,0.9>, <-0.9,0.3>, <-0.8,-0.7>}",
          prism, vec3(0, 0.1, 0), 1.2, 12);
}

/* rho^2 by Hermite's four polynomials. */
static double sor(const Primitive *p, Vec3 q)
{
    static const double r[] = {0.1, 0.8, 0.3, 0.9, 0.2}, y[] = {-1.3, -1, -0.2, 0.5, 1};

    (void)p;
    for (int i = 1; i + 2 < 5; i++)
        if (q.y >= y[i] && q.y <= y[i + 1]) {
            double h = y[i + 1] - y[i], t = (q.y - y[i]) / h, m[2];
            for (int k = 0; k < 2; k++)
                m[k] = 2 * r[i + k] * (r[i + k + 1] - r[i + k - 1]) / (y[i + k + 1] - y[i + k - 1]) * h;
            return q.x * q.x + q.z * q.z -
                   ((2 * t * t * t - 3 * t * t + 1) * r[i] * r[i] + (t * t * t - 2 * t * t + t) * m[0] +
                    (3 * t * t - 2 * t * t * t) * r[i + 1] * r[i + 1] + (t * t * t - t * t) * m[1]);
        }
    return 1;
}

static void sors_match_marching(void **unused)
{
    (void)unused;
    check(V37 "sor{5, <0.1,-1.3>, <0.8,-1>, <0.3,-0.2>, <0.9,0.5>, <0.2,1>}", sor, vec3(0, -0.25, 0), 1.1, 100);
}

/* ---- sphere sweeps ---- */

static Kind sweep_kind;
static const Point *sweep_points;
static int sweep_count;

static double of_sphere(int segment, double u, Vec3 q)
{
    const Point p = spline(sweep_kind, sweep_points + segment, u);
    const double dx = q.x - p.x[0], dy = q.y - p.x[1], dz = q.z - p.x[2];

    return dx * dx + dy * dy + dz * dz - p.x[3] * p.x[3];
}

/* The least over all spheres: by samples, then by thirds. */
static double sweep(const Primitive *p, Vec3 q)
{
    double least = INFINITY;

    (void)p;
    for (int i = 0; i < sweep_count; i++) {
        const int steps = 20;
        int best = 0;
        double value = INFINITY;
        for (int k = 0; k <= steps; k++)
            if (of_sphere(i, (double)k / steps, q) < value)
                value = of_sphere(i, (double)k / steps, q), best = k;
        if (value < 0)
            return value;
        double a = fmax(best - 1, 0) / steps, b = fmin(best + 1, steps) / steps;
        for (int n = 0; n < 40 && value >= 0; n++) {
            double c = a + (b - a) / 3, d = b - (b - a) / 3, fc = of_sphere(i, c, q), fd = of_sphere(i, d, q);
            if (fc < fd)
                b = d;
            else
                a = c;
            value = fmin(value, fmin(fc, fd));
        }
        least = fmin(least, value);
    }
    return least;
}

#define BALLS "<-0.8,0,0>, 0.3, <-0.4,0.6,0.2>, 0.1, <0.2,-0.4,0>, 0.3, <0.8,0.4,0.6>, 0.2, <0.6,-0.6,-0.6>, 0.05"

static void sphere_sweeps_match_marching(void **unused)
{
    static const Point balls[] = {{{-0.8, 0, 0, 0.3}},
                                  {{-0.4, 0.6, 0.2, 0.1}},
                                  {{0.2, -0.4, 0, 0.3}},
                                  {{0.8, 0.4, 0.6, 0.2}},
                                  {{0.6, -0.6, -0.6, 0.05}}};

    (void)unused;
    sweep_points = balls;
    sweep_kind = LINEAR, sweep_count = 4;
    check(V37 "sphere_sweep{linear_spline 5, " BALLS "}", sweep, vec3(0, 0, 0), 0.9, 8);
    sweep_kind = B_SPLINE, sweep_count = 2;
    check(V37 "sphere_sweep{b_spline, 5, " BALLS " tolerance 0.001}", sweep, vec3(0, 0, 0), 0.5, 8);
    sweep_kind = CUBIC, sweep_count = 2;
    check(V37 "sphere_sweep{cubic_spline 5, " BALLS "}", sweep, vec3(0, 0, 0), 0.8, 8);
}

/* ---- UVs and errors ---- */

static SurfaceUv uv_along(const char *text, Vec3 from, Vec3 direction)
{
    Scene *scene = parse(text);
    Ray ray = {from, vec_normalize(direction), 0, INFINITY};
    Hit hit = {.primitive = 0};
    Surface s;
    SurfaceUv uv;

    assert_true(shape_intersect(only(scene), &ray, &hit.t, &hit.face));
    surface_at(&s, scene, &ray, &hit);
    uv = surface_uv(&s);
    scene_close(&scene);
    return uv;
}

static void assert_uv(Vec2 uv, double u, double v)
{
    assert_true(fabs(uv.u - u) < 1e-4 && fabs(uv.v - v) < 1e-4);
}

/* Of lathe and sor as POV-Ray's pixels have it. */
static void uv_is_povray(void **unused)
{
    const char *const l = V37 "lathe{linear_spline 3, <1,0>, <1,2>, <0.5,3>}",
                      *const s = V37 "sor{5, <0.5,-1>, <0.5,0>, <0.5,1>, <0.2,4>, <0.2,5>}",
                      *const p = V37 "prism{0, 2, 5, <0,0>, <4,0>, <4,2>, <0,2>, <0,0>}";

    (void)unused;
    assert_uv(uv_along(l, vec3(0, 1, -5), vec3(0, 0, 1)).uv, 0.75, 0.25);
    assert_uv(uv_along(l, vec3(5, 2.5, 0), vec3(-1, 0, 0)).uv, 0, 0.75);
    assert_uv(uv_along(s, vec3(0, 0.5, -5), vec3(0, 0, 1)).uv, 0.75, 0.25);
    assert_uv(uv_along(s, vec3(0, 2.5, 5), vec3(0, 0, -1)).uv, 0.25, 0.75);
    assert_uv(uv_along(s, vec3(0, 9, 0.1), vec3(0, -1, 0)).uv, 0.25, 0.5);
    assert_uv(uv_along(s, vec3(0, -9, 0.1), vec3(0, 1, 0)).uv, 0.25, 0.2);
    assert_uv(uv_along(s, vec3(0, -9, 0.1), vec3(0, 1, 0)).natural, 0.5, 0.6);
    assert_uv(uv_along(p, vec3(1, 9, 0.5), vec3(0, -1, 0)).natural, 0.25, 0.25);
    assert_uv(uv_along(p, vec3(1, 0.5, -9), vec3(0, 0, 1)).natural, 0.0625, 0.25);
    assert_uv(uv_along(p, vec3(9, 0.5, 1), vec3(-1, 0, 0)).natural, 0.375, 0.25);
}

/* Rings after the first begin at the right points: a hole is one. */
static void splines_have_rings(void **unused)
{
    const char *const texts[] = {
        V37 "prism{quadratic_spline 0, 1, 12, <-2,2>, <-2,-2>, <2,-2>, <2,2>, <-2,2>, <-2,-2>,"
            "<-1,1>, <-1,-1>, <1,-1>, <1,1>, <-1,1>, <-1,-1>}",
        V37 "prism{cubic_spline 0, 1, 14, <-2,2>, <-2,-2>, <2,-2>, <2,2>, <-2,2>, <-2,-2>, <2,-2>,"
            "<-1,1>, <-1,-1>, <1,-1>, <1,1>, <-1,1>, <-1,-1>, <1,-1>}",
        V37 "prism{bezier_spline 0, 1, 16, <-2,-2>, <0,-3>, <0,-3>, <2,-2>, <2,-2>, <3,3>, <3,3>, <-2,-2>,"
            "<-1,-1>, <0,-1.5>, <0,-1.5>, <1,-1>, <1,-1>, <1,0.5>, <1,0.5>, <-1,-1>}"};

    (void)unused;
    for (int i = 0; i < 3; i++) {
        Scene *scene = parse(texts[i]);
        const Primitive *p = only(scene);
        const double y = i == 2 ? -1 : 0;
        assert_true(p->shape.ops->inside(&p->shape, vec3(1.5, 0.5, y)));
        assert_false(p->shape.ops->inside(&p->shape, vec3(0.3, 0.5, y)));
        assert_false(p->shape.ops->inside(&p->shape, vec3(3.5, 0.5, y)));
        scene_close(&scene);
    }
}

static void open_ends(void **unused)
{
    Scene *scene = parse(V37 "prism{0, 2, 5, <0,0>, <4,0>, <4,2>, <0,2>, <0,0> open}"
                             "sor{5, <0.5,-1>, <0.5,0>, <0.5,1>, <0.5,4>, <0.5,5> open}");

    (void)unused;
    for (int i = 0; i < 2; i++) {
        Ray down = {{0.1, 9, 0.2}, {0, -1, 0}, 0, INFINITY}, across = {{0.1, 1, 0.2}, {1, 0, 0}, 0, INFINITY};
        double t;
        int face;
        assert_false(shape_intersect(&scene->primitives[i], &down, &t, &face));
        assert_true(shape_intersect(&scene->primitives[i], &across, &t, &face));
    }
    scene_close(&scene);
}

static void errors_are_told(void **unused)
{
    (void)unused;
    expect_error("lathe{cubic_spline 3, <1,0>, <1,1>, <1,2>}", "has 4 to");
    expect_error("lathe{bezier_spline 5, <1,0>, <1,1>, <1,2>, <1,3>, <1,4>}", "four points a segment");
    expect_error("prism{cubic_spline 0, 1, 5, <1,0>, <1,1>, <1,2>, <1,3>, <1,4>}", "not closed");
    expect_error("sor{4, <1,0>, <1,3>, <1,2>, <1,4>}", "go upward");
    expect_error("sphere_sweep{b_spline 3, <1,0,0>, 1, <1,3,0>, 1, <1,2,0>, 1}", "has 4 to");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lathes_match_marching),
        cmocka_unit_test(lathes_have_level_rays),
        cmocka_unit_test(prisms_match_marching),
        cmocka_unit_test(sors_match_marching),
        cmocka_unit_test(sphere_sweeps_match_marching),
        cmocka_unit_test(uv_is_povray),
        cmocka_unit_test(splines_have_rings),
        cmocka_unit_test(open_ends),
        cmocka_unit_test(errors_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
