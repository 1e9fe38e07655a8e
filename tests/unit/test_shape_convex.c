/* Superellipsoids and eggs: rays against marching along their equations, closed forms, distances of POV-Ray. */
#include "lib_implicit.h"
#include <math.h>
#include "lib_scene_text.h"
#include "shape/surface.h"

static uint32_t state = 5;

static void check(const ShapeOps *ops, double r0, double r1, TestImplicit *f, Vec3 centre, double size)
{
    static Texture texture;
    TestShape shape = {.primitive = {.shape = {.ops = ops, .r0 = r0, .r1 = r1}, .texture = &texture},
                       .f = f,
                       .centre = centre,
                       .size = size};

    test_shape_at_all_sizes(shape, 100, &state);
}

static double superellipsoid(const Primitive *p, Vec3 q)
{
    const double e = p->shape.r0, n = p->shape.r1;

    return pow(pow(fabs(q.x), 2 / e) + pow(fabs(q.y), 2 / e), e / n) + pow(fabs(q.z), 2 / n) - 1;
}

static void superellipsoids_match_marching(void **unused)
{
    const double exponents[][2] = {{1, 1},   {0.5, 0.5}, {0.1, 0.1}, {0.25, 1}, {1, 0.3},
                                   {2, 1.5}, {3, 0.5},   {0.8, 2.5}, {2.5, 3}};

    (void)unused;
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++)
        check(&shape_superellipsoid, exponents[i][0], exponents[i][1], superellipsoid, vec3(0, 0, 0), 1);
}

/* By height: the arc touches both spheres from outside, twice as large as the larger one. */
static double egg(const Primitive *p, Vec3 q)
{
    const double r0 = p->shape.r0, r1 = p->shape.r1, big = r1 > r0 ? 2 * r1 : 2 * r0;
    const double v = (2 * big * (r1 - r0) + r0 * r0 - r1 * r1 + r0 * r0) / (2 * r0),
                 h = sqrt((big - r0) * (big - r0) - v * v);
    const double lower = -v * r0 / (big - r0), upper = r0 + (r0 - v) * r1 / (big - r1), rho = hypot(q.x, q.z);

    if (q.y < lower)
        return hypot(rho, q.y) - r0;
    if (q.y > upper)
        return hypot(rho, q.y - r0) - r1;
    return rho + h - sqrt(big * big - (q.y - v) * (q.y - v));
}

static void eggs_match_marching(void **unused)
{
    const double radii[][2] = {{1, 0.7}, {1, 1}, {1, 1.4}, {1, 0.05}, {0.6, 1.15}};

    (void)unused;
    for (int i = 0; i < 5; i++)
        check(&shape_ovus, radii[i][0], radii[i][1], egg, vec3(0, radii[i][1] / 2, 0), radii[i][0] + radii[i][1]);
}

/* Bounds touch the surface: no point of it, sought along many directions, is farther out. */
static void check_bounds(const ShapeOps *ops, double r0, double r1, Vec3 centre)
{
    for (int i = 0; i < 5; i++) {
        Primitive p = {.shape = {.ops = ops, .r0 = r0, .r1 = r1}};
        double out[6] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
        Vec3 low, high, middle;
        p.transform = test_shape_transform(&state, 1, 3, 0);
        middle = transform_point(&p.transform, centre);
        assert_true(shape_bounds(&p, &low, &high));
        for (int k = 0; k < 20000; k++) {
            double z = 2 * test_random(&state) - 1, angle = 2 * PI * test_random(&state), rho = sqrt(1 - z * z), t;
            Ray ray = {middle, {rho * cos(angle), rho * sin(angle), z}, 0, INFINITY};
            int face;
            assert_true(shape_intersect(&p, &ray, &t, &face));
            Vec3 at = vec_mad(middle, ray.direction, t);
            const double of[6] = {low.x - at.x,  low.y - at.y,  low.z - at.z,
                                  at.x - high.x, at.y - high.y, at.z - high.z};
            for (int j = 0; j < 6; j++)
                out[j] = fmax(out[j], of[j]);
        }
        double size = vec_length(vec_sub(high, low));
        for (int j = 0; j < 6; j++)
            assert_true(out[j] <= 1e-9 * size && out[j] > -0.02 * size);
    }
}

static void bounds_are_tight(void **unused)
{
    (void)unused;
    check_bounds(&shape_superellipsoid, 0.5, 0.8, vec3(0, 0, 0));
    check_bounds(&shape_superellipsoid, 1.5, 0.4, vec3(0, 0, 0));
    check_bounds(&shape_ovus, 1, 0.6, vec3(0, 0.3, 0));
    check_bounds(&shape_ovus, 1, 1.5, vec3(0, 0.5, 0));
}

static double traced(const char *text, Vec3 direction)
{
    Scene *scene = parse(text);
    Ray ray = {{0, 0, -4}, vec_normalize(direction), 0, INFINITY};
    double t = -1;
    int face;

    shape_intersect(only(scene), &ray, &t, &face);
    scene_close(&scene);
    return t;
}

/* Distances are those of POV-Ray's trace(). */
static void distances_are_povray(void **unused)
{
    (void)unused;
    assert_near(traced(V37 "superellipsoid{<0.5,1>}", vec3(0.05, 0.1, 1)), 3.068120785);
    assert_near(traced(V37 "superellipsoid{<0.5,1>}", vec3(-0.07, -0.03, 1)), 3.031783663);
    assert_near(traced(V37 "superellipsoid{<3,0.5> rotate <20,30,10>}", vec3(0.05, 0.1, 1)), 2.966097484);
    assert_near(traced(V37 "superellipsoid{<3,0.5> rotate <20,30,10>}", vec3(-0.07, -0.03, 1)), 3.106934287);
    assert_near(traced(V37 "ovus{0.7,0.5 rotate x*30}", vec3(0.05, 0.1, 1)), 3.427731066);
    assert_near(traced(V37 "ovus{0.7,0.5 rotate x*30}", vec3(-0.07, -0.03, 1)), 3.357787759);
    assert_near(traced(V37 "ovus{0.3,1}", vec3(0.05, 0.1, 1)), 3.030164124);
    assert_near(traced(V37 "ovus{0.3,1}", vec3(-0.07, -0.03, 1)), 3.115629655);
    expect_error("superellipsoid{<0, 1>}", "greater than 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(superellipsoids_match_marching),
        cmocka_unit_test(eggs_match_marching),
        cmocka_unit_test(bounds_are_tight),
        cmocka_unit_test(distances_are_povray),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
