/* UV in scene units on targets whose parts differ in size: steps on the surface against steps in UV. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "accel/accel.h"
#include "lib_scene.h"
#include "path/surface_color.h"
#include "path/target_units.h"
#include "render/first_hit.h"

/* ---- scenes ---- */

static const char *const head = "#version 3.7; global_settings { assumed_gamma 1 } camera { location -20*z } "
                                "light_source { -9*z rgb 1 } #declare T = texture { pigment { rgb .5 } }\n";

typedef struct World {
    Scene *scene;
    Accel *accel;
} World;

static World open_world(const char *objects, const char *target)
{
    char text[4096];
    World world;
    snprintf(text, sizeof text, "%s%s", head, objects);
    world.scene = test_scene(text);
    assert_int_equal(scene_resolve_targets(world.scene, &target, 1, NULL), 0);
    target_units_choose(world.scene);
    assert_int_equal(accel_create(&world.accel, world.scene, 1, NULL), 0);
    return world;
}

static void close_world(World *world)
{
    accel_close(&world->accel);
    scene_close(&world->scene);
}

/* The UV where a ray towards `direction` meets the target next to `at`. */
static Vec2 uv_at(const World *world, Vec3 at, Vec3 direction)
{
    const Vec3 d = vec_normalize(direction);
    const Ray ray = {vec_mad(at, d, -0.01), d, 0, 0.02};
    Hit hit;
    Surface surface;
    assert_true(accel_intersect(world->accel, &ray, RAY_CAMERA, &hit));
    surface_at(&surface, world->scene, &ray, &hit);
    assert_int_equal(surface.target, 0);
    return surface_target_uv(&surface);
}

static double distance(Vec2 a, Vec2 b)
{
    return hypot(a.u - b.u, a.v - b.v);
}

static void check(const char *what, double is, double should_be, double tolerance)
{
    if (!(fabs(is - should_be) <= tolerance))
        fail_msg("%s: %.9g, should be %.9g", what, is, should_be);
}

static double random_number(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* ---- flat faces ---- */

/* A box with these half sizes, rotated about y and moved: distances on each face are distances in UV. */
static void check_box(const World *world, Vec3 half, double degrees, Vec3 centre)
{
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180), h[3] = {half.x, half.y, half.z};
    const Vec3 axes[3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}}; /* rotations are left-handed */
    unsigned seed = 7;
    for (int face = 0; face < 6; face++) {
        Vec3 p[2];
        Vec2 uv[2];
        const int k = face / 2;
        const double side = face % 2 ? 1 : -1;
        for (int i = 0; i < 2; i++) {
            p[i] = vec_mad(centre, axes[k], side * h[k]);
            for (int j = 1; j < 3; j++)
                p[i] = vec_mad(p[i], axes[(k + j) % 3], (1.9 * random_number(&seed) - 0.95) * h[(k + j) % 3]);
            uv[i] = uv_at(world, p[i], vec_scale(axes[k], -side));
        }
        check("a step on a box", distance(uv[0], uv[1]), vec_length(vec_sub(p[0], p[1])), 1e-5);
    }
}

static void boxes_of_all_sizes(void **state)
{
    (void)state;
    const char *const scene =
        "union { box { <-2,-.05,-1>, <2,.05,1> } box { -.3, .3 scale <1,2,3> rotate 30*y translate 5*x } "
        "box { -1, 1 scale .1 rotate 77*y translate <-5,3,1> } pigment { rgb .2 } }";
    static const char *const targets[] = {"A=#1,#2,#3", "A=~rgb(.2,.2,.2)"};
    for (int k = 0; k < 2; k++) {
        World world = open_world(scene, targets[k]);
        check_box(&world, vec3(2, 0.05, 1), 0, vec3(0, 0, 0));
        check_box(&world, vec3(0.3, 0.6, 0.9), 30, vec3(5, 0, 0));
        check_box(&world, vec3(0.1, 0.1, 0.1), 77, vec3(-5, 3, 1));
        close_world(&world);
    }
}

/* What lies in one plane goes on from box to box, and rows keep their height round corners. */
static void boxes_go_on(void **state)
{
    (void)state;
    World world =
        open_world("box { <-2,0,-1>, <1,3,1> pigment { rgb .2 } } box { <1,0,-1>, <1.7,5,4> pigment { rgb .2 } }",
                   "A=~rgb(.2,.2,.2)");
    const Vec2 left = uv_at(&world, vec3(0.5, 2, -1), vec3(0, 0, 1)),
               right = uv_at(&world, vec3(1.5, 2.5, -1), vec3(0, 0, 1)),
               corner = uv_at(&world, vec3(1.7, 2, 0.25), vec3(-1, 0, 0));
    check("u from box to box", right.u - left.u, 1, 1e-5);
    check("v from box to box", right.v - left.v, 0.5, 1e-5);
    check("v round the corner", corner.v, left.v, 1e-5);
    close_world(&world);
}

static void copies_of_a_compound(void **state)
{
    (void)state;
    char scene[2048] = "#declare G = union { #for (I, 1, 9000) box { -.1, .1 scale <1,2,1> translate I*x } #end } "
                       "object { G texture { T } } object { G texture { T } scale 3 rotate 30*y translate -20*y } "
                       "object { G texture { T } translate 30*y } object { G texture { T } translate 40*y }";
    World world = open_world(scene, "A=~rgb(.5,.5,.5)");
    assert_true(world.scene->ninstances > 0);
    check_box(&world, vec3(0.1, 0.2, 0.1), 0, vec3(3, 0, 0));
    check_box(&world, vec3(0.3, 0.6, 0.3), 30, vec3(12 * cos(PI / 6), -20, -12 * sin(PI / 6)));
    close_world(&world);
}

/* ---- what closes ---- */

/* Round a cylinder about y: as far in u as on the surface, but for where it turns back; and nowhere a jump. */
static void check_round(const World *world, const char *what, double radius, Vec3 centre, int folds, double unit)
{
    enum { STEPS = 360 };
    int turns = 0;
    Vec2 last = {0, 0};
    for (int k = 0; k <= STEPS; k++) {
        const double angle = 2 * PI * (k + 0.5) / STEPS;
        const Vec3 out = vec3(cos(angle), 0, sin(angle));
        const Vec2 uv = uv_at(world, vec_mad(centre, out, radius), vec_neg(out));
        double step = k ? fabs(uv.u - last.u) * unit : 0;
        if (!folds && step > 0.5 * unit)
            step = unit - step;
        const double length = 2 * PI * radius / STEPS;
        if (k && step < 0.9 * length)
            turns++;
        else if (k)
            check(what, step, length, 2e-3 * length);
        last = uv;
    }
    assert_int_equal(turns, folds ? 2 : 0);
}

static void round_parts(void **state)
{
    (void)state;
    World world = open_world(
        "cylinder { 0, 2*y, .5 pigment { rgb .2 } } cylinder { 0, 3*y, .8 pigment { rgb .2 } translate 4*x } "
        "sphere { 0, 1.3 pigment { rgb .2 } translate 8*x } box { 0, 1 pigment { rgb .2 } translate -9*x }",
        "A=~rgb(.2,.2,.2)");
    int periodic[2];
    check_round(&world, "a cylinder", 0.5, vec3(0, 1, 0), 1, 1);
    check_round(&world, "a wider one", 0.8, vec3(4, 1, 0), 1, 1);
    check_round(&world, "a sphere", 1.3, vec3(8, 0, 0), 1, 1);
    const Vec2 low = uv_at(&world, vec3(4, 0.5, -0.8), vec3(0, 0, 1)),
               high = uv_at(&world, vec3(4, 2.5, -0.8), vec3(0, 0, 1));
    check("along a cylinder", fabs(high.v - low.v), 2, 1e-5);
    const double c = 1.3 * sqrt(0.5);
    const Vec2 pole = uv_at(&world, vec3(8, c, -c), vec3(0, -1, 1)),
               equator = uv_at(&world, vec3(8, 0, -1.3), vec3(0, 0, 1));
    check("along a meridian", fabs(pole.v - equator.v), 1.3 * PI / 4, 1e-5);
    const Vec2 a = uv_at(&world, vec3(4.3, 3, 0.1), vec3(0, -1, 0)),
               b = uv_at(&world, vec3(3.8, 3, -0.2), vec3(0, -1, 0));
    check("on a cap", distance(a, b), hypot(0.5, 0.3), 1e-5);
    target_periodic(world.scene, 0, periodic);
    assert_int_equal(periodic[0], 0);
    close_world(&world);
}

static void equally_round(void **state)
{
    (void)state;
    World world = open_world(
        "cylinder { 0, 2*y, .5 pigment { rgb .2 } } cylinder { 0, 3*y, .5 pigment { rgb .2 } translate 4*x }",
        "A=#1,#2");
    const double around = 2 * PI * 0.5;
    int periodic[2];
    check_round(&world, "the first leg", 0.5, vec3(0, 1, 0), 0, around);
    check_round(&world, "the second leg", 0.5, vec3(4, 1, 0), 0, around);
    const Vec2 low = uv_at(&world, vec3(4, 0.5, -0.5), vec3(0, 0, 1)),
               high = uv_at(&world, vec3(4, 2.5, -0.5), vec3(0, 0, 1)),
               first = uv_at(&world, vec3(0, 0.5, -0.5), vec3(0, 0, 1));
    check("heights are alike", high.v - low.v, 1, 1e-6);
    check("the first one's", first.v, 0.25, 1e-6);
    const Vec2 a = uv_at(&world, vec3(4.3, 3, 0.1), vec3(0, -1, 0)),
               b = uv_at(&world, vec3(3.8, 3, -0.2), vec3(0, -1, 0));
    check("on a cap", hypot((a.u - b.u) * around, (a.v - b.v) * 2), hypot(0.5, 0.3), 1e-5);
    target_periodic(world.scene, 0, periodic);
    assert_int_equal(periodic[0], 1);
    close_world(&world);
}

/* Of different size they turn back, so that nothing closes. */
static void not_equally_round(void **state)
{
    (void)state;
    World world = open_world("sphere { 0, .5 pigment { rgb .2 } } sphere { 4*x, .6 pigment { rgb .2 } }", "A=#1,#2");
    int periodic[2];
    check_round(&world, "a ball", 0.5, vec3(0, 0, 0), 1, 1);
    check_round(&world, "a larger ball", 0.6, vec3(4, 0, 0), 1, 1);
    target_periodic(world.scene, 0, periodic);
    assert_int_equal(periodic[0], 0);
    close_world(&world);
}

/* ---- what stays ---- */

static void others_keep_theirs(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *target;
    } cases[] = {
        {"box { -1, 1 texture { T } scale <2,3,1> } box { 9, 10 texture { T } }", "A=T"},
        {"lathe { linear_spline 3 <0,-1>, <2,0>, <0,1> pigment { rgb .2 } }", "A=#1"},
        {"plane { z, 1 pigment { rgb .2 scale 3 } }", "A=#1"},
        {"box { -1, 1 pigment { uv_mapping rgb .2 } scale <2,3,1> } box { 9, 10 pigment { rgb .2 } }",
         "A=~rgb(.2,.2,.2)"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        World world = open_world(cases[k].scene, cases[k].target);
        const Ray ray = {vec3(0.1, 0.2, -9), vec3(0, 0, 1), 0, INFINITY};
        Hit hit;
        Surface surface;
        assert_true(accel_intersect(world.accel, &ray, RAY_CAMERA, &hit));
        surface_at(&surface, world.scene, &ray, &hit);
        const Vec2 uv = surface_target_uv(&surface);
        for (int i = 0; i < world.scene->nprimitives; i++)
            world.scene->primitives[i].unit_targets = NULL;
        const Vec2 own = surface_target_uv(&surface);
        if (uv.u != own.u || uv.v != own.v)
            fail_msg("case %zu", k);
        close_world(&world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_of_all_sizes), cmocka_unit_test(boxes_go_on),   cmocka_unit_test(copies_of_a_compound),
        cmocka_unit_test(round_parts),        cmocka_unit_test(equally_round), cmocka_unit_test(others_keep_theirs),
        cmocka_unit_test(not_equally_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
