/* Surfaces of polynomials: rays against marching, and POV-Ray's order of coefficients. */
#include "lib_implicit.h"
#include <stdlib.h>
#include "shape/poly.h"
#include "lib_scene_text.h"
#include "shape/surface.h"

static uint32_t state = 3;

typedef struct Term {
    int i, j, k;
    double c;
} Term;

/* In the order of the manual: powers of x go down first, then those of y, then those of z. */
static Poly *make_poly(int degree, const Term *terms, int count)
{
    Poly *poly = calloc(1, sizeof *poly + (size_t)poly_terms(degree) * sizeof(double));
    int at = 0;

    poly->degree = degree;
    for (int i = degree; i >= 0; i--)
        for (int j = degree - i; j >= 0; j--)
            for (int k = degree - i - j; k >= 0; k--, at++)
                for (int n = 0; n < count; n++)
                    if (terms[n].i == i && terms[n].j == j && terms[n].k == k)
                        poly->c[at] += terms[n].c;
    assert_int_equal(at, poly_terms(degree));
    return poly;
}

static void check(int degree, const Term *terms, int count, TestImplicit *f, double size)
{
    static Texture texture;
    Poly *poly = make_poly(degree, terms, count);
    TestShape shape = {
        .primitive = {.shape = {.ops = &shape_poly, .data = poly}, .texture = &texture}, .f = f, .size = size};

    test_shape_at_all_sizes(shape, 150, &state);
    free(poly);
}

static double saddle(const Primitive *p, Vec3 q)
{
    (void)p;
    return q.x * q.x - q.y * q.y + 0.3 * q.x * q.z - q.z + 0.1;
}

static double cone(const Primitive *p, Vec3 q)
{
    (void)p;
    return q.x * q.x + q.z * q.z - q.y * q.y - 0.05;
}

static double monkey(const Primitive *p, Vec3 q)
{
    (void)p;
    return q.x * q.x * q.x - 3 * q.x * q.y * q.y - q.z;
}

/* The ring of major radius 1 and minor 0.4 about y. */
static double torus(const Primitive *p, Vec3 q)
{
    (void)p;
    return hypot(hypot(q.x, q.z) - 1, q.y) - 0.4;
}

static double cushion(const Primitive *p, Vec3 q)
{
    (void)p;
    return pow(q.x, 6) + pow(q.y, 6) + pow(q.z, 6) - 1;
}

static double hills(const Primitive *p, Vec3 q)
{
    (void)p;
    return 20 * pow(q.x, 7) - 9 * pow(q.x, 3) + pow(q.z, 5) * q.y * q.y - 2 * q.y * q.z + q.y;
}

static void crossings_match_marching(void **unused)
{
    const Term of_saddle[] = {{2, 0, 0, 1}, {0, 2, 0, -1}, {1, 0, 1, 0.3}, {0, 0, 1, -1}, {0, 0, 0, 0.1}};
    const Term of_cone[] = {{2, 0, 0, 1}, {0, 0, 2, 1}, {0, 2, 0, -1}, {0, 0, 0, -0.05}};
    const Term of_monkey[] = {{3, 0, 0, 1}, {1, 2, 0, -3}, {0, 0, 1, -1}};
    const Term of_torus[] = {{4, 0, 0, 1},        {0, 4, 0, 1},          {0, 0, 4, 1},     {2, 2, 0, 2},
                             {2, 0, 2, 2},        {0, 2, 2, 2},          {2, 0, 0, -2.32}, {0, 0, 2, -2.32},
                             {0, 2, 0, 2 * 0.84}, {0, 0, 0, 0.84 * 0.84}};
    const Term of_cushion[] = {{6, 0, 0, 1}, {0, 6, 0, 1}, {0, 0, 6, 1}, {0, 0, 0, -1}};
    const Term of_hills[] = {{7, 0, 0, 20}, {3, 0, 0, -9}, {0, 2, 5, 1}, {0, 1, 1, -2}, {0, 1, 0, 1}};

    (void)unused;
    check(2, of_saddle, 5, saddle, 1);
    check(2, of_cone, 4, cone, 1);
    check(3, of_monkey, 3, monkey, 1);
    check(4, of_torus, 10, torus, 1.5);
    check(6, of_cushion, 4, cushion, 1.2);
    check(7, of_hills, 5, hills, 1);
}

static double nearest(const Primitive *p, Vec3 from, Vec3 to)
{
    Ray ray = {from, vec_normalize(vec_sub(to, from)), 0, INFINITY};
    double t;
    int face;

    return shape_intersect(p, &ray, &t, &face) ? t : -1;
}

/* A quadric's terms one by one: on the x axis from x = 3, and beside it. */
static void quadrics_are_povray(void **unused)
{
    Scene *scene = parse(V37 "quadric{<1, 2, -3>, <4, 5, 6>, <7, 8, 9>, -10}");
    const Primitive *p = only(scene);
    double x = nearest(p, vec3(3, 0.5, 0.25), vec3(0, 0.5, 0.25));

    (void)unused;
    assert_true(p->shape.ops == &shape_poly && x > 0);
    x = 3 - x;
    double y = 0.5, z = 0.25;
    assert_near(x * x + 2 * y * y - 3 * z * z + 4 * x * y + 5 * x * z + 6 * y * z + 7 * x + 8 * y + 9 * z - 10, 0);
    scene_close(&scene);
}

/* An ellipsoid is a sphere with bounds, with the equation of the quadric; turned inside out where that is positive. Its
 * UV of uv_mapping are the world's x and y, as POV-Ray has them of quadrics, and not a sphere's. */
static void ellipsoids_have_bounds(void **unused)
{
    const char *const texts[] = {V37 "quadric{<2, 3, 1>, <0.5, 0.4, 0.3>, <-1, 2, 0.5>, -4}",
                                 V37 "quadric{<-2, -3, -1>, <-0.5, -0.4, -0.3>, <1, -2, -0.5>, 4}"};

    (void)unused;
    for (int i = 0; i < 2; i++) {
        Scene *scene = parse(texts[i]);
        const Primitive *p = only(scene);
        Vec3 low, high;
        assert_true(p->shape.ops == &shape_sphere && shape_bounds(p, &low, &high) && p->inverse == i);
        for (int k = 0; k < 100; k++) {
            double z = 2 * test_random(&state) - 1, angle = 7 * test_random(&state), rho = sqrt(1 - z * z);
            Vec3 q = transform_point(&p->transform, vec3(rho * cos(angle), rho * sin(angle), z));
            assert_near(2 * q.x * q.x + 3 * q.y * q.y + q.z * q.z + 0.5 * q.x * q.y + 0.4 * q.x * q.z +
                            0.3 * q.y * q.z - q.x + 2 * q.y + 0.5 * q.z - 4,
                        0);
            Surface surface = {0};
            surface_from_point(&surface, p, 0, &(ShapePoint){.p = vec3(rho * cos(angle), rho * sin(angle), z)});
            const SurfaceUv uv = surface_uv(&surface);
            assert_near(uv.uv.u - q.x, 0);
            assert_near(uv.uv.v - q.y, 0);
            assert_near(uv.natural.v - (0.5 + asin(rho * sin(angle)) / PI), 0);
        }
        scene_close(&scene);
    }
}

/* The terms of a cubic by its list, and of a polynomial by their powers. */
static void terms_are_povray(void **unused)
{
    const char *const texts[] = {
        V37 "cubic{<1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,-20> sturm}",
        V37 "poly{3, <1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,-20>}",
        V37 "polynomial{3, xyz(3,0,0):1, xyz(2,1,0):2, xyz(2,0,1):3, xyz(2,0,0):4, xyz(1,2,0):5, xyz(1,1,1):6,"
            "xyz(1,1,0):7, xyz(1,0,2):8, xyz(1,0,1):9, xyz(1,0,0):10, xyz(0,3,0):11, xyz(0,2,1):12, xyz(0,2,0):13,"
            "xyz(0,1,2):14, xyz(0,1,1):15, xyz(0,1,0):16, xyz(0,0,3):17, xyz(0,0,2):18, xyz(0,0,1):19,"
            "xyz(0,0,0):-20}"};

    (void)unused;
    for (int i = 0; i < 3; i++) {
        Scene *scene = parse(texts[i]);
        double y = 0.3, z = 0.2, x = 5 - nearest(only(scene), vec3(5, y, z), vec3(0, y, z));
        assert_near(x * x * x + 2 * x * x * y + 3 * x * x * z + 4 * x * x + 5 * x * y * y + 6 * x * y * z + 7 * x * y +
                        8 * x * z * z + 9 * x * z + 10 * x + 11 * y * y * y + 12 * y * y * z + 13 * y * y +
                        14 * y * z * z + 15 * y * z + 16 * y + 17 * z * z * z + 18 * z * z + 19 * z - 20,
                    0);
        scene_close(&scene);
    }
    expect_error("poly{36, <1>}", "from 2 to 35");
    expect_error("polynomial{2, xyz(1,1,1):1}", "add up to more");
    expect_error("polynomial{2, xyz(0.5,1,0):1}", "whole numbers");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_match_marching),
        cmocka_unit_test(quadrics_are_povray),
        cmocka_unit_test(ellipsoids_have_bounds),
        cmocka_unit_test(terms_are_povray),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
