/* Isosurfaces: rays against marching on the function, containers, and what functions may do to them. */
#include "lib_implicit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "lib_scene_text.h"
#include "shape/isosurface.h"
#include "shape/surface.h"

static uint32_t state = 5;

/* ---- marching ---- */

static double container(const Primitive *p, Vec3 q)
{
    const Container *c = &((const Isosurface *)p->shape.data)->container;
    if (c->spherical)
        return vec_length(vec_sub(q, c->centre)) - c->radius;
    const Vec3 half = vec_scale(vec_sub(c->high, c->low), 0.5), from = vec_sub(q, c->centre);
    return fmax(fabs(from.x) - half.x, fmax(fabs(from.y) - half.y, fabs(from.z) - half.z));
}

static double ball(const Primitive *p, Vec3 q)
{
    return fmax(container(p, q), vec_length(q) - 0.9);
}

static double bean(const Primitive *p, Vec3 q)
{
    return fmax(container(p, q), q.x * q.x * q.x + q.x * q.y - q.z + 0.3 * sin(3 * q.y));
}

static double gyroid(const Primitive *p, Vec3 q)
{
    return fmax(container(p, q),
                sin(5 * q.x) * cos(5 * q.y) + sin(5 * q.y) * cos(5 * q.z) + sin(5 * q.z) * cos(5 * q.x));
}

/* Cells alternate between -1 and 1: the function jumps. */
static double cells(const Primitive *p, Vec3 q)
{
    return fmax(container(p, q), fmod(floor(q.x * 2 + .3) + floor(q.y * 2 + .3) + floor(q.z * 2 + .3) + 12, 2) * 2 - 1);
}

/* A ray of a test costs thousands of evaluations. */
static void march(const char *function, const char *options, TestImplicit *f, Vec3 centre, int rays)
{
    char text[1024];
    snprintf(text, sizeof text,
             "#version 3.7; global_settings{assumed_gamma 1} isosurface{function{%s} accuracy 1e-6 %s}", function,
             options);
    Scene *scene = parse(text);
    assert_int_equal(scene->nprimitives, 1);
    assert_true(scene->primitives[0].shape.ops == &shape_isosurface);
    TestShape shape = {.primitive = scene->primitives[0], .f = f, .centre = centre, .size = 1.3};
    test_shape_at_all_sizes(shape, rays, &state);
    scene_close(&scene);
}

static void test_marching(void **unused)
{
    (void)unused;
    const Vec3 origin = {0, 0, 0};
    march("sqrt(x*x+y*y+z*z)-.9", "contained_by{sphere{0,1}} max_gradient 1.01", ball, origin, 40);
    march("sqrt(x*x+y*y+z*z)", "threshold .9 contained_by{box{-.8,<.7,2,2>}} max_gradient 1.01", ball, origin, 40);
    march("x*x*x+x*y-z+.3*sin(3*y)", "contained_by{box{-1,1}} max_gradient 6", bean, origin, 25);
    march("sin(5*x)*cos(5*y)+sin(5*y)*cos(5*z)+sin(5*z)*cos(5*x)",
          "contained_by{sphere{<.1,.2,0>,1.1}} max_gradient 13", gyroid, vec3(.1, .2, 0), 15);
}

/* Steps between cells are found wherever max_gradient lets them be looked for; the crossings of each ray alternate. */
static void test_jumps(void **unused)
{
    (void)unused;
    Scene *scene = parse("#version 3.7; isosurface{function{mod(floor(x*2+.3)+floor(y*2+.3)+floor(z*2+.3)+12,2)*2-1}"
                         " accuracy 1e-4 max_gradient 1e5 contained_by{box{-1,1}}}");
    const Primitive *p = &scene->primitives[0];
    for (int i = 0; i < 40; i++) {
        const Vec3 from = vec3(test_random(&state) * 6 - 3, test_random(&state) * 6 - 3, 3),
                   to = vec3(test_random(&state) - .5, test_random(&state) - .5, test_random(&state) - .5);
        Ray ray = {from, vec_normalize(vec_sub(to, from)), 0, INFINITY};
        double t, sum = 0;
        int face, count = 0;
        for (; shape_intersect(p, &ray, &t, &face) && count < 100; count++) {
            sum += count % 2 ? t : -t;
            ray.tmin = t;
        }
        double inside = 0;
        for (int k = 0; k < 20000; k++)
            inside += cells(p, vec_mad(from, ray.direction, (k + .5) * 6e-4)) < 0 ? 6e-4 : 0;
        assert_int_equal(count % 2, 0);
        assert_true(fabs(inside - sum) < 7e-4 * (count + 1));
    }
    scene_close(&scene);
}

/* ---- containers and options ---- */

static int crossings(const char *text, Vec3 from, Vec3 direction, double *t)
{
    Scene *scene = parse(text);
    Ray ray = {from, vec_normalize(direction), 0, INFINITY};
    int count = 0, face;
    while (count < 8 && shape_intersect(&scene->primitives[0], &ray, &t[count], &face))
        ray.tmin = t[count++];
    scene_close(&scene);
    return count;
}

static int near(double a, double b)
{
    return fabs(a - b) < 1e-12;
}

static void test_options(void **unused)
{
    (void)unused;
    double t[8];
    const Vec3 behind = vec3(0, 0, -3), forward = vec3(0, 0, 1);
    /* a plane cuts the container of -1 to 1 */
    assert_int_equal(crossings(V37 "isosurface{function{z-.25}}", behind, forward, t), 2);
    assert_true(near(t[0], 2) && near(t[1], 3.25));
    assert_int_equal(crossings(V37 "isosurface{function{z-.25} open}", behind, forward, t), 1);
    assert_true(near(t[0], 3.25));
    assert_int_equal(crossings(V37 "isosurface{function{.25-z} open}", behind, forward, t), 1);
    assert_true(near(t[0], 3.25));
    assert_int_equal(crossings(V37 "isosurface{function{.25-z} max_trace 3}", behind, forward, t), 2);
    assert_true(near(t[0], 3.25) && near(t[1], 4));
    /* from inside: out through the container, or through the surface */
    assert_int_equal(crossings(V37 "isosurface{function{.25-z}}", vec3(0, 0, .5), forward, t), 1);
    assert_true(near(t[0], .5));
    assert_int_equal(crossings(V37 "isosurface{function{z-.25}}", vec3(0, 0, 0), forward, t), 1);
    assert_true(near(t[0], .25));
    /* where there is no surface: all, or nothing */
    assert_int_equal(crossings(V37 "isosurface{function{-1} contained_by{sphere{<0,0,1>,1.5}}}", behind, forward, t),
                     2);
    assert_true(near(t[0], 2.5) && near(t[1], 5.5));
    assert_int_equal(crossings(V37 "isosurface{function{1}}", behind, forward, t), 0);
    assert_int_equal(crossings(V37 "isosurface{function{0/0}}", behind, forward, t), 0);
    assert_int_equal(crossings(V37 "isosurface{function{ln(x)}}", vec3(-3, .1, .2), vec3(1, 0, 0), t), 0);
    /* slopes that are larger than max_gradient hide a thin slab; evaluate learns them */
    const char *text = V37 "isosurface{function{abs(z-.3)*20-1} max_gradient 20}";
    assert_int_equal(crossings(text, behind, forward, t), 2);
    assert_true(near(t[0], 3.25) && near(t[1], 3.35));
    assert_int_equal(crossings(V37 "isosurface{function{abs(z-.3)*20-1} max_gradient 2}", behind, forward, t), 0);
    assert_int_equal(crossings(V37 "isosurface{function{abs(z-.3)*20-1} evaluate 1,1.2,.99}", behind, forward, t), 2);
}

/* Normals, and inside() as POV-Ray has it. */
static void test_surface(void **unused)
{
    (void)unused;
    Scene *scene =
        parse(V37 "isosurface{function{sqrt(x*x+y*y+z*z)-2} contained_by{box{0,1.5}} translate 5*x inverse}");
    const Primitive *p = &scene->primitives[0];
    const Vec3 from[3] = {{5.5, .75, -3}, {5.5, .75, .7}, {14, 9, 9}},
               to[3] = {{5.5, .75, 0}, {5.5, 1.5, .7}, {5, 0, 0}},
               normal[3] = {{0, 0, -1}, {0, 1, 0}, {.577350269, .577350269, .577350269}};
    for (int i = 0; i < 3; i++) {
        Ray ray = {from[i], vec_normalize(vec_sub(to[i], from[i])), 0, INFINITY};
        Hit hit = {.primitive = 0};
        Surface s;
        assert_true(shape_intersect(p, &ray, &hit.t, &hit.face));
        surface_at(&s, scene, &ray, &hit);
        const Vec3 off = vec_add(s.geometric_normal, normal[i]); /* inverse */
        if (!(vec_length(off) < 1e-6))
            fail_msg("normal %d is off by %g %g %g", i, off.x, off.y, off.z);
    }
    assert_true(p->shape.ops->inside(&p->shape, vec3(.1, .1, .1)));
    assert_false(p->shape.ops->inside(&p->shape, vec3(1.45, 1.45, 1.45)));
    assert_false(p->shape.ops->inside(&p->shape, vec3(-.1, .1, .1)));
    scene_close(&scene);
}

static void test_errors(void **unused)
{
    (void)unused;
    expect_error("isosurface{sphere{0,1}}", "function");
    expect_error("isosurface{function(x){x}}", "1 arguments");
    expect_error("isosurface{function{x} contained_by{cone{0,1,x,1}}}", "box");
}

/* Nowhere near enough to the threshold that its slope could not reach it, for ever. The surface is at the far end. */
static void test_endless_search(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "isosurface { function { y - 4e9 < 0 ? .05 : -1 } max_gradient 4 accuracy .001"
                             "  contained_by { box { -1, <1, 4294967296, 1> } } }");
    const Primitive *p = only(scene);
    const ShapeRay ray = {.origin = {0, -5, 0}, .direction = {0, 1, 0}, .tmin = 0, .tmax = INFINITY};
    double t = 0;
    int face;
    const clock_t before = clock();
    assert_int_equal(p->shape.ops->intersect(p, &ray, &t, &face), 0);
    assert_true((double)(clock() - before) < 10.0 * CLOCKS_PER_SEC);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_marching), cmocka_unit_test(test_jumps),  cmocka_unit_test(test_options),
        cmocka_unit_test(test_surface),  cmocka_unit_test(test_errors), cmocka_unit_test(test_endless_search),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
