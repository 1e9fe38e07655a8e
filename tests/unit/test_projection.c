/* UV by projection against what a person would measure on the surface, in metres from its corner. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "accel/accel.h"
#include "job/job.h"
#include "lib_scene.h"
#include "path/path.h"
#include "path/projection.h"
#include "render/first_hit.h"

#define HEAD "#version 3.7; camera { location <0,1,-20> } #default { pigment { rgb 1 } } "

typedef struct World {
    Scene *scene;
    Accel *accel;
} World;

static World open_world(const char *text, const char *target, double unit)
{
    RenderParams render = RENDER_PARAMS_INIT;
    RetexError err = {0};
    World world = {.scene = test_scene(text)};
    render.unit = unit;
    if (job_resolve_targets(world.scene, &render, &target, 1, &err))
        fail_msg("%s", err.message);
    assert_int_equal(accel_create(&world.accel, world.scene, 1, NULL), 0);
    return world;
}

static void close_world(World *world)
{
    accel_close(&world->accel);
    scene_close(&world->scene);
}

static Surface surface_towards(const World *world, Vec3 at, Vec3 direction)
{
    const Vec3 d = vec_normalize(direction);
    const Ray ray = {vec_mad(at, d, -0.01), d, 0, 0.02};
    Hit hit;
    Surface surface;
    assert_true(accel_intersect(world->accel, &ray, RAY_CAMERA, &hit));
    surface_at(&surface, world->scene, &ray, &hit);
    assert_int_equal(surface.target, 0);
    return surface;
}

static void check_uv(const World *world, const char *what, Vec3 at, Vec3 direction, double u, double v)
{
    const Surface surface = surface_towards(world, at, direction);
    const Vec2 uv = surface_target_uv(&surface);
    if (fabs(uv.u - u) > 1e-6 || fabs(uv.v - v) > 1e-6)
        fail_msg("%s: %.9g, %.9g, should be %.9g, %.9g", what, uv.u, uv.v, u, v);
}

static double random_number(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* ---- box: the corner of each side at the lower left, as it is seen ---- */

/* Where a side begins, and where its u and v go, in a box of this size with its corner at 0. */
static const struct {
    const char *what;
    double corner[3];
    int u, v; /* axes, from 1; negative: against them */
    int across;
} sides[6] = {{"left", {0, 0, 1}, -3, 2, -1}, {"right", {1, 0, 0}, 3, 2, 1},  {"bottom", {0, 0, 1}, 1, -3, -2},
              {"top", {0, 1, 0}, 1, 3, 2},    {"front", {0, 0, 0}, 1, 2, -3}, {"back", {1, 0, 1}, -1, 2, 3}};

static Vec3 along(const Vec3 axes[3], int axis, double by)
{
    return vec_scale(axes[abs(axis) - 1], axis < 0 ? -by : by);
}

static void check_box(const World *world, Vec3 place, double degrees, const double size[3], double unit)
{
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180); /* rotations are left-handed */
    const Vec3 axes[3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    unsigned seed = 3;
    for (int k = 0; k < 6; k++) {
        Vec3 corner = place;
        for (int axis = 0; axis < 3; axis++)
            corner = vec_mad(corner, axes[axis], sides[k].corner[axis] * size[axis]);
        for (int i = 0; i < 40; i++) {
            /* the last ones are at the edges: no seam is off its edge */
            const double near = i < 20 ? 0 : 1e-5;
            const double a = near ? (i & 1 ? near : 1 - near) : random_number(&seed),
                         b = near ? (i & 2 ? near : 1 - near) : random_number(&seed);
            const double u = a * size[abs(sides[k].u) - 1], v = b * size[abs(sides[k].v) - 1];
            const Vec3 p = vec_add(corner, vec_add(along(axes, sides[k].u, u), along(axes, sides[k].v, v)));
            check_uv(world, sides[k].what, p, along(axes, -sides[k].across, 1), u * unit, v * unit);
        }
    }
}

static void box(void **state)
{
    (void)state;
    static const double size[3] = {2, 1, 0.5}, turns[] = {0, 30, 44, -70 + 90};
    for (int k = 0; k < 8; k++) {
        char text[1024], form[512];
        const double unit = k < 4 ? 1 : 0.01;
        /* A mesh with UV of its own, and a box. */
        snprintf(
            form, sizeof form, "%s",
            k % 2
                ? "box { 0, <2,1,.5>"
                : "mesh2 { vertex_vectors { 8, <0,0,0>,<2,0,0>,"
                  "<0,1,0>,<2,1,0>,<0,0,.5>,<2,0,.5>,<0,1,.5>,<2,1,.5> } uv_vectors { 1, <.3,.4> } face_indices { 12, "
                  "<0,4,6>,<0,6,2>,<1,3,7>,<1,7,5>,<0,1,5>,<0,5,4>,<2,6,7>,<2,7,3>,<0,2,3>,<0,3,1>,<4,5,7>,<4,7,6> } "
                  "uv_indices { 12, 0,0,0,0,0,0,0,0,0,0,0,0 }");
        if (k % 2 == 0) /* face after face, all with the one UV */
            snprintf(strstr(form, "uv_indices"), 200, "inside_vector y");
        snprintf(text, sizeof text, HEAD "%s rotate y*%g translate <3,4,5> }", form, turns[k % 4]);
        World world = open_world(text, "A=#1:uv=box", unit);
        check_box(&world, vec3(3, 4, 5), turns[k % 4], size, unit);
        close_world(&world);
    }
}

/* From inside a side is not mirrored either: u goes the other way. */
static void box_from_inside(void **state)
{
    (void)state;
    World world = open_world(HEAD "box { 0, <2,1,.5> }", "A=#1:uv=box", 1);
    check_uv(&world, "front, from inside", vec3(0.25, 0.75, 0), vec3(0, 0, -1), 1.75, 0.75);
    check_uv(&world, "right, from inside", vec3(2, 0.75, 0.1), vec3(1, 0, 0), 0.4, 0.75);
    close_world(&world);
}

/* ---- planar ---- */

/* A rectangle of many triangles, its longer edge turned by degrees about y: u goes along that, to the right. */
static void floors(void **state)
{
    (void)state;
    static const double turns[] = {0, 25, -25, 60, 89, -89, 150};
    for (int k = 0; k < 14; k++) {
        char text[12000];
        const double turn = turns[k % 7] * PI / 180, w = k < 7 ? 6 : 4, d = k < 7 ? 4 : 6, h = 0.25;
        size_t used = (size_t)snprintf(text, sizeof text, HEAD "mesh {");
        for (int i = 0; i < 12; i++) {
            const double x = w / 4 * (i % 4), z = d / 3 * (i / 4), x1 = x + w / 4, z1 = z + d / 3;
            used += (size_t)snprintf(text + used, sizeof text - used,
                                     " triangle { <%.9f,%g,%.9f>, <%.9f,%g,%.9f>, <%.9f,%g,%.9f> }"
                                     " triangle { <%.9f,%g,%.9f>, <%.9f,%g,%.9f>, <%.9f,%g,%.9f> }",
                                     x, h, z, x1, h, z1, x1, h, z, x, h, z, x, h, z1, x1, h, z1);
        }
        snprintf(text + used, sizeof text - used, " rotate y*%g translate <10, 0, 20> }", turns[k % 7]);
        World world = open_world(text, "A=#1/flat:3", 1);
        /* The longer edge, as a direction with x above 0; v is to its left, away from who looks along z. */
        const Vec3 axes[2] = {{cos(turn), 0, -sin(turn)}, {sin(turn), 0, cos(turn)}};
        Vec3 u = w > d ? axes[0] : axes[1];
        if (u.x < -1e-6 || (u.x < 1e-6 && u.z < 0))
            u = vec_neg(u);
        const Vec3 v = vec_cross(u, vec3(0, 1, 0));
        Vec3 corners[4];
        double low[2] = {INFINITY, INFINITY};
        for (int c = 0; c < 4; c++) {
            corners[c] =
                vec_add(vec3(10, h, 20), vec_add(vec_scale(axes[0], c & 1 ? w : 0), vec_scale(axes[1], c & 2 ? d : 0)));
            low[0] = fmin(low[0], vec_dot(corners[c], u)), low[1] = fmin(low[1], vec_dot(corners[c], v));
        }
        for (int c = 0; c < 4; c++) {
            const Vec3 p = vec_mad(vec_scale(corners[c], 0.9),
                                   vec_add(vec_add(corners[0], corners[1]), vec_add(corners[2], corners[3])), 0.025);
            check_uv(&world, "floor", p, vec3(0.1, -1, 0), vec_dot(p, u) - low[0], vec_dot(p, v) - low[1]);
        }
        close_world(&world);
    }
}

/* Of a floor with a corner in it u goes along its walls, not along a diagonal that is the longest edge of its hull. */
static void floors_with_corners(void **state)
{
    (void)state;
    for (int k = 0; k < 7; k++) {
        char text[600];
        const double degrees = 24 * k - 72, turn = degrees * PI / 180;
        snprintf(text, sizeof text,
                 HEAD "mesh { triangle { <0,0,0>, <6,0,0>, <6,0,1> } triangle { <0,0,0>, <6,0,1>, <0,0,1> } "
                      "triangle { <0,0,1>, <1.5,0,1>, <1.5,0,5> } triangle { <0,0,1>, <1.5,0,5>, <0,0,5> } "
                      "rotate y*%g translate <3,0,20> }",
                 degrees);
        World world = open_world(text, "A=#1/level:1", 1);
        const Vec3 u = vec3(cos(turn), 0, -sin(turn)), v = vec3(sin(turn), 0, cos(turn));
        check_uv(&world, "corner", vec_add(vec3(3, 0, 20), vec_add(vec_scale(u, 0.75), vec_scale(v, 0.5))),
                 vec3(0.1, -1, 0), 0.75, 0.5);
        close_world(&world);
    }
}

/* Of edges of the same length u goes along the one next to the first axis, however a triangle is turned. */
static void even_floors(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        char text[400];
        snprintf(text, sizeof text,
                 HEAD "mesh { triangle { <-1,0,0>, <1,0,0>, <0,0,%.15f> } translate -%.15f*z rotate %d*y }", sqrt(3),
                 1 / sqrt(3), 60 * k);
        World world = open_world(text, "A=#1/flat:1", 1);
        const double low = -(k % 2 ? 2 : 1) / sqrt(3);
        check_uv(&world, "even", vec3(0.1, 0, 0.05), vec3(0.01, -1, 0), 1.1, 0.05 - low);
        close_world(&world);
    }
}

/* v goes up a wall, and a slope; seen from the camera's side, u goes to the right. */
static void walls(void **state)
{
    (void)state;
    World world = open_world(HEAD "box { <-1,2,3>, <3,5,4> }", "A=#1/flat:5", 1); /* its front */
    check_uv(&world, "front", vec3(0, 3, 3), vec3(0, 0, 1), 1, 1);
    close_world(&world);
    world = open_world(HEAD "box { <-1,2,-30>, <3,5,4> }", "A=#1/flat:6", 1); /* its back, with the camera inside */
    check_uv(&world, "back", vec3(0, 3, 4), vec3(0, 0, 1), 1, 1);
    close_world(&world);
    world = open_world(HEAD "box { <-1,2,-30>, <3,5,-21> }", "A=#1/flat:6", 1); /* and behind the camera */
    check_uv(&world, "from behind", vec3(0, 3, -21), vec3(0, 0, -1), 3, 1);
    close_world(&world);
    world = open_world(HEAD "polygon { 4, <0,0,0>, <4,0,0>, <4,3,4>, <0,3,4> }", "A=#1/flat:1", 1);
    check_uv(&world, "slope", vec3(1, 1.5, 2), vec3(0, -1, 0.2), 1, 2.5);
    close_world(&world);
    /* Of what has no end they begin at the scene's origin. */
    world = open_world(HEAD "plane { y, -1 }", "A=#1/flat:1", 0.1);
    check_uv(&world, "plane", vec3(7, -1, 30), vec3(0, -1, 0), 0.7, 3);
    close_world(&world);
}

/* A closed board is seen along its thickness, however it is turned and however many triangles its edges have. */
static void boards(void **state)
{
    (void)state;
    static const double turns[] = {0, 25, -60, 140};
    for (int k = 0; k < 8; k++) {
        const double turn = turns[k % 4] * PI / 180, w = 2, h = 3, thick = k < 4 ? 0.1 : 0.4;
        const Vec3 x = {cos(turn), 0, -sin(turn)}, z = {sin(turn), 0, cos(turn)}, middle = {1, 2, 5};
        const int front = vec_dot(vec_sub(vec3(0, 1, -20), middle), z) < 0; /* of the camera */
        const Vec3 towards = front ? z : vec_neg(z), u = front ? x : vec_neg(x);
        char text[8000];
        size_t used = (size_t)snprintf(text, sizeof text,
                                       HEAD "mesh2 { vertex_vectors { 56, <0,0,0>,<%g,0,0>,<0,%g,0>,<%g,%g,0>,"
                                            "<0,0,%g>,<%g,0,%g>,<0,%g,%g>,<%g,%g,%g>",
                                       w, h, w, h, thick, w, thick, h, thick, w, h, thick);
        for (int i = 0; i < 24; i++) /* along the left edge */
            used += (size_t)snprintf(text + used, sizeof text - used, ",<0,%g,0>,<0,%g,%g>", h * (i + 1) / 25,
                                     h * (i + 1) / 25, thick);
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "} face_indices { 60, <1,3,7>,<1,7,5>,<0,1,5>,<0,5,4>,<2,6,7>,<2,7,3>,<0,2,3>,"
                                 "<0,3,1>,<4,5,7>,<4,7,6>");
        for (int i = 0; i < 25; i++) {
            const int a = i ? 6 + 2 * i : 0, b = i ? 7 + 2 * i : 4, c = i < 24 ? 8 + 2 * i : 2, d = i < 24 ? c + 1 : 6;
            used += (size_t)snprintf(text + used, sizeof text - used, ",<%d,%d,%d>,<%d,%d,%d>", a, b, d, a, d, c);
        }
        snprintf(text + used, sizeof text - used, "} translate <%g,%g,%g> rotate y*%g translate <1,2,5> }", -w / 2,
                 -h / 2, -thick / 2, turns[k % 4]);
        World world = open_world(text, "A=#1:uv=planar", 0.5);
        const Vec3 p = vec_add(vec_mad(vec_mad(middle, u, 0.3), towards, -thick / 2), vec3(0, 0.7, 0));
        check_uv(&world, "board", p, towards, 0.5 * (w / 2 + 0.3), 0.5 * (h / 2 + 0.7));
        close_world(&world);
    }
}

/* A floor of copies of a tile: its UV begin at the corner of all. */
static void copies(void **state)
{
    (void)state;
    World world =
        open_world(HEAD "#declare Tile = mesh { triangle { 0, <1,0,0>, <1,0,1> } triangle { 0, <1,0,1>, <0,0,1> } }"
                        " #for (I, 2, 7) object { Tile translate <I,0,I> } #end",
                   "A=Tile:uv=planar", 1);
    /* The longest edge of the copies' hull runs along the diagonal. */
    const double r = sqrt(0.5);
    check_uv(&world, "copies", vec3(4.5, 0, 4.25), vec3(0, -1, 0), r * (4.5 + 4.25 - 4), r * (4.25 - 4.5 + 1));
    close_world(&world);
}

/* ---- cylinder ---- */

static void cylinder(void **state)
{
    (void)state;
    World world = open_world(HEAD "cylinder { <2,1,3>, <2,4,3>, .5 }", "A=#1:uv=cylinder", 2);
    for (int k = 1; k < 12; k++) {
        const double angle = 2 * PI * k / 12; /* from the back, to the right as it is seen from outside */
        const Vec3 out = vec3(-sin(angle), 0, cos(angle));
        check_uv(&world, "side", vec_mad(vec3(2, 1.75, 3), out, 0.5), vec_neg(out), 2 * 0.5 * angle, 1.5);
    }
    check_uv(&world, "cap", vec3(1.9, 4, 3.2), vec3(0, -1, 0), 2 * 0.4, 2 * 0.7);
    close_world(&world);
}

/* ---- which projection ---- */

static void chosen_by_itself(void **state)
{
    (void)state;
    static const char bare[] = "mesh { triangle { 0, x, y } triangle { x, y, z } }", round[] = "sphere { 0, 1 }",
                      with_uv[] = "mesh2 { vertex_vectors { 3, 0, x, y } uv_vectors { 3, <0,0>, <1,0>, <0,1> } "
                                  "face_indices { 1, <0,1,2> } }";
    static const struct {
        const char *object, *target;
        UvProjection kind;
    } cases[] = {
        {bare, "A=#1/flat:1", UV_PLANAR},
        {with_uv, "A=#1/level:1", UV_PLANAR},
        {bare, "A=#1/flat:1:uv=model", UV_MODEL},
        {bare, "A=#1", UV_BOX},
        {bare, "A=#1:uv=model", UV_MODEL},
        {bare, "Object", UV_MODEL},
        {bare, "Object:uv=cylinder", UV_CYLINDER},
        {with_uv, "A=#1", UV_MODEL},
        {round, "A=#1", UV_MODEL},
        {round, "A=Object,#1:uv=planar", UV_PLANAR},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, HEAD "#declare Object = %s object { Object }", cases[k].object);
        World world = open_world(text, cases[k].target, 1);
        if (world.scene->targets[0].projection.kind != cases[k].kind)
            fail_msg("%s of %s: %d", cases[k].target, cases[k].object, (int)world.scene->targets[0].projection.kind);
        close_world(&world);
    }
}

/* What is known of the UV follows: their size, their frame, that they do not close; and the original keeps its own. */
static void all_follow(void **state)
{
    (void)state;
    static const char text[] =
        HEAD "cylinder { 0, 3*y, 1 pigment { uv_mapping checker rgb 0, rgb <1,.5,.25> scale .5 } }";
    World world = open_world(text, "A=#1:uv=cylinder", 0.01), plain = open_world(text, "A=#1", 0.01);
    double scales[1][2];
    int periodic[2];
    Vec3 of_u, of_v;
    assert_int_equal(render_uv_scales(world.scene, 1, scales, NULL), 0);
    assert_true(scales[0][0] == 100 && scales[0][1] == 100);
    target_periodic(world.scene, 0, periodic);
    assert_false(periodic[0]);
    const Surface surface = surface_towards(&world, vec3(0.6, 1, -0.8), vec3(-0.6, 0, 0.8));
    assert_true(surface_target_frame(&surface, surface.geometric_normal, &of_u, &of_v));
    assert_true(vec_length(vec_sub(of_u, vec3(0.8, 0, 0.6))) < 1e-4 && vec_length(vec_sub(of_v, vec3(0, 1, 0))) < 1e-4);
    for (int k = 0; k < 200; k++) {
        const double angle = 0.0314 * k;
        const Vec3 out = vec3(cos(angle), 0, sin(angle)), at = vec_add(out, vec3(0, 0.013 * k, 0));
        Surface a = surface_towards(&world, at, vec_neg(out)), b = surface_towards(&plain, at, vec_neg(out));
        Vec2 uv, ignored;
        const Rgbft c = surface_color(&a, NULL, &uv), d = surface_color(&b, NULL, &ignored);
        assert_true(c.r == d.r && c.g == d.g && c.b == d.b);
        assert_true(fabs(uv.v - 0.01 * at.y) < 1e-6);
    }
    close_world(&world);
    close_world(&plain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box),         cmocka_unit_test(box_from_inside), cmocka_unit_test(floors),
        cmocka_unit_test(even_floors), cmocka_unit_test(floors_with_corners),
        cmocka_unit_test(walls),           cmocka_unit_test(boards),
        cmocka_unit_test(copies),      cmocka_unit_test(cylinder),        cmocka_unit_test(chosen_by_itself),
        cmocka_unit_test(all_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
