/* The size of a unit of u and v, on surfaces where it is known. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "render/render.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"
#include "set/laid.h"

/* A scene with targets A and B, where it declares them. */
static Scene *read_scene(const char *text, const char *const *targets, int ntargets)
{
    char path[] = "/tmp/retex-uv-scale-XXXXXX";
    int file = mkstemp(path);
    RetexError err = {0};
    Scene *scene;
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
    int code = sdl_read(&scene, path, NULL, &scene_builder, &err);
    if (!code)
        code = scene_resolve_targets(scene, targets, ntargets, &err);
    unlink(path);
    if (code)
        fail_msg("%d:%d: %s", err.line, err.column, err.message);
    return scene;
}

static void check(const char *what, const double scale[2], double u, double v, double tolerance)
{
    if (fabs(scale[0] - u) > tolerance * u || fabs(scale[1] - v) > tolerance * v)
        fail_msg("%s: %g, %g, should be %g, %g", what, scale[0], scale[1], u, v);
}

static void known_surfaces(void **state)
{
    (void)state;
    static const struct {
        const char *what, *scene;
        double u, v, tolerance;
    } cases[] = {
        {"a plane, its pattern scaled by 2",
         "camera { location <1, 3, -4> look_at 0 } #declare A = texture { pigment { rgb 1 scale 2 } }"
         "plane { y, 0 texture { A } }",
         2, 2, 1e-6},
        {"a wall with an image, scaled by 2 and 3",
         "camera { location <1, 0, -4> look_at 0 }"
         "#declare A = texture { pigment { image_map { jpeg \"scenes/textures/brick.jpg\" } scale <2, 3, 1> } }"
         "plane { -z, 0 rotate y * 30 texture { A } }",
         2 / 0.8660254037844386, 3, 1e-6},
        {"a stretched box, a texture to each face",
         "camera { orthographic location -5 * z direction z right 8 * x up 6 * y }"
         "#declare A = texture { pigment { rgb 1 } }"
         "box { -1, 1 scale <1.5, 2, 1> texture { A } }",
         3, 4, 1e-6},
        {"a cylinder's side, seen head-on: round it and along it",
         "camera { orthographic location -5 * z direction z right 0.1 * x up 0.1 * y }"
         "#declare A = texture { pigment { rgb 1 } } cylinder { -2 * y, 2 * y, 1.5 texture { A } }",
         3 * PI, 4, 1e-3},
        {"a small triangle far away",
         "camera { location <0, 0, -100> look_at 0 angle 0.01 } #declare A = texture { uv_mapping pigment { rgb 1 } }"
         "mesh { triangle { <-0.02, -0.02, 0>, <0.02, -0.02, 0>, <-0.02, 0.02, 0> uv_vectors <0, 0>, <4, 0>, <0, 2> }"
         " texture { A } }",
         0.01, 0.02, 1e-3},
    };
    static const char *const target = "A";
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Scene *scene = read_scene(cases[k].scene, &target, 1);
        double scale[RETEX_MAX_TARGETS][2];
        assert_int_equal(render_uv_scales(scene, 1, scale, NULL), 0);
        check(cases[k].what, scale[0], cases[k].u, cases[k].v, cases[k].tolerance);
        scene_close(&scene);
    }
}

static void a_sphere(void **state)
{
    (void)state;
    /* radius 2, u round the axis and v along it: |dP/dv| = pi r everywhere, |dP/du| = 2 pi r cos(latitude); from
     * afar, half of the disc that is seen lies within latitude asin(x), (x sqrt(1 - x^2) + asin x) / (pi / 2) = 1/2,
     * x = 0.4040: there the cosine is 0.9148 */
    static const char *const target = "A";
    Scene *scene = read_scene("camera { orthographic location -9 * z direction z right 5.3333 * x up 4 * y }"
                              "#declare A = texture { uv_mapping pigment { rgb 1 } }"
                              "sphere { 0, 2 texture { A } }",
                              &target, 1);
    double scale[RETEX_MAX_TARGETS][2], again[RETEX_MAX_TARGETS][2];
    assert_int_equal(render_uv_scales(scene, 1, scale, NULL), 0);
    check("a sphere", scale[0], 4 * PI * 0.9148, 2 * PI, 0.01);
    assert_int_equal(render_uv_scales(scene, 2, again, NULL), 0);
    assert_memory_equal(scale[0], again[0], sizeof scale[0]);
    scene_close(&scene);
}

static void what_is_not_seen(void **state)
{
    (void)state;
    /* B lies behind the camera */
    static const char *const targets[] = {"A", "B"};
    Scene *scene =
        read_scene("camera { location <0, 1, -4> look_at 0 }"
                   "#declare A = texture { pigment { rgb 1 } } #declare B = texture { pigment { rgb 1 scale 3 } }"
                   "plane { y, 0 texture { A } } box { <-3, 0, -9>, <3, 4, -8> texture { B } }",
                   targets, 2);
    double scale[RETEX_MAX_TARGETS][2];
    assert_int_equal(render_uv_scales(scene, 1, scale, NULL), 0);
    check("the plane", scale[0], 1, 1, 1e-6);
    assert_true(scale[1][0] > 0 && scale[1][1] > 0);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *set;
    p.width = 16, p.height = 12, p.spp = 1;
    assert_int_equal(render_scene(&set, scene, &p, NULL, NULL), 0);
    assert_memory_equal(set->targets[1].uv_scale, scale[1], sizeof scale[1]);
    retex_set_close(&set);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_surfaces), cmocka_unit_test(a_sphere),
                                       cmocka_unit_test(what_is_not_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
