/* Tangents, and normals by normal maps. The reference of a sphere's tangents is their closed form; that of a normal map
 * is the sum of its components along the axes. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "lib_scene_text.h"
#include "shade/normal.h"
#include "shape/surface.h"

/* As a mesh: a globe with u once round from +x towards +z, v up, `u` of POV-Ray's sphere. */
static const char globe[] =
    "#declare N = 24; #declare K = 12; #declare Globe = mesh2 {\n"
    "#macro All(What) #local J = 0; #while (J <= K) #local I = 0; #while (I <= N)\n"
    "  #local A = 2*pi*I/N; #local B = pi*(J/K - 1/2);\n"
    "  #if (What) <I/N, J/K> #else <cos(A)*cos(B), sin(B), sin(A)*cos(B)> #end\n"
    "  #local I = I + 1; #end #local J = J + 1; #end #end\n"
    "vertex_vectors { (N+1)*(K+1), All(0) } normal_vectors { (N+1)*(K+1), All(0) } uv_vectors { (N+1)*(K+1), All(1) }\n"
    "face_indices { 2*N*(K-2), #declare J = 1; #while (J < K-1) #declare I = 0; #while (I < N)\n"
    "  #declare P = J*(N+1) + I; <P, P+1, P+N+2>, <P, P+N+2, P+N+1>,\n"
    "  #declare I = I + 1; #end #declare J = J + 1; #end } }\n";

/* What a ray from `from` meets of the scene's only primitive. */
static Surface seen(const Scene *scene, Vec3 from, Vec3 direction)
{
    const Primitive *p = &scene->primitives[0];
    const Ray ray = {from, vec_normalize(direction), 0, INFINITY};
    Hit hit = {.t = INFINITY, .primitive = 0};
    Surface surface;
    assert_int_equal(shape_intersect(p, &ray, &hit.t, &hit.face), 1);
    shape_complete_hit(p, &ray, &hit);
    surface_at(&surface, scene, &ray, &hit);
    return surface;
}

/* How far tangents are from those of the unit sphere, where it is seen from a hundred sides; not at the seam of u, at
 * which the corners of both sides have different UV. */
static double worst_of_sphere(const char *object)
{
    char text[4096];
    double worst = 0;
    snprintf(text, sizeof text, V37 "%s %s", globe, object);
    Scene *scene = parse(text);
    for (int i = 0; i < 100; i++) {
        const double a = 0.37 + 2.399963 * i, y = -0.8 + 1.6 * (i + 0.5) / 100, r = sqrt(1 - y * y);
        const Vec3 p = vec3(r * cos(a), y, r * sin(a));
        if (p.x > 0 && fabs(atan2(p.z, p.x)) < 2 * PI / 24)
            continue;
        const Surface s = seen(scene, vec_scale(p, 4), vec_neg(p));
        Vec3 t, b;
        assert_int_equal(surface_tangents(&s, 0, s.shading_normal, &t, &b), 1);
        assert_true(fabs(vec_dot(t, s.shading_normal)) < 1e-9 && fabs(vec_length(t) - 1) < 1e-9);
        assert_true(fabs(vec_dot(b, s.shading_normal)) < 1e-9 && fabs(vec_length(b) - 1) < 1e-9);
        const Vec3 east = vec3(-sin(a), 0, cos(a)), north = vec3(-y * cos(a), r, -y * sin(a));
        worst = fmax(worst, fmax(vec_length(vec_sub(t, east)), vec_length(vec_sub(b, north))));
    }
    scene_close(&scene);
    return worst;
}

static void sphere_has_its_tangents(void **state)
{
    (void)state;
    assert_true(worst_of_sphere("sphere { 0, 1 pigment { rgb 1 } }") < 1e-6);
    assert_true(worst_of_sphere("sphere { 0, .01 scale 100 pigment { rgb 1 } }") < 1e-6);
}

/* Faces alone are wrong by up to half a face's turn, .13; with those around, far less. */
static void corners_of_meshes_are_smooth(void **state)
{
    (void)state;
    const char *bumps = "pigment { rgb 1 } normal { retex_normal_map { rgb <.5,.5,1> } }";
    char text[256];
    const double flat = worst_of_sphere("object { Globe pigment { rgb 1 } }");
    snprintf(text, sizeof text, "object { Globe %s }", bumps);
    const double smooth = worst_of_sphere(text);
    assert_true(flat > 0.08 && flat < 0.2);
    assert_true(smooth < 0.02);
}

#define QUAD "mesh2 { vertex_vectors { 4, 0, x, x+y, y } normal_vectors { 4, -z, -z, -z, -z } "
#define FACES "face_indices { 2, <0,1,2>, <0,2,3> } "
#define UV "uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> } "
#define TILT "pigment { rgb 1 } normal { retex_normal_map { rgb <.7,.6,.9> "

/* The normal at a point of an object about (.7, .4, 0), seen from in front or behind. */
static void expect_normal(const char *object, int behind, double x, double y, double z)
{
    char text[2048];
    snprintf(text, sizeof text, V37 "%s", object);
    Scene *scene = parse(text);
    const double side = behind ? 1 : -1;
    if (scene->pixels)
        scene->pixels->apart = .2; /* the heights below are even slopes, so any distance will do but for rounding */
    const Surface s = seen(scene, vec3(.7, .4, 3 * side), vec3(0, 0, -side));
    const Vec3 facing = s.backside ? vec_neg(s.shading_normal) : s.shading_normal;
    const Vec3 n = normal_tilted(s.texture->normal, &s, facing, vec3(0, 0, -side)), want = vec_normalize(vec3(x, y, z));
    if (!(vec_length(vec_sub(n, want)) < 1e-6))
        print_error("%s: %g %g %g, not %g %g %g\n", object, n.x, n.y, n.z, want.x, want.y, want.z);
    assert_true(vec_length(vec_sub(n, want)) < 1e-6);
    scene_close(&scene);
}

static void maps_are_along_uv(void **state)
{
    (void)state;
    expect_normal(QUAD UV FACES TILT "} } }", 0, .4, .2, -.8);
    expect_normal(QUAD UV FACES TILT "} .5 } }", 0, .2, .1, -.8);
    expect_normal(QUAD UV FACES TILT "} bump_size 2 } }", 0, .8, .4, -.8);
    /* a bump is a dent from behind */
    expect_normal(QUAD UV FACES TILT "} } }", 1, -.4, -.2, .8);
    /* UV that are mirrored, turned, sheared */
    expect_normal(QUAD "uv_vectors { 4, <1,0>, <0,0>, <0,1>, <1,1> } " FACES TILT "} } }", 0, -.4, .2, -.8);
    expect_normal(QUAD "uv_vectors { 4, <0,1>, <0,0>, <1,0>, <1,1> } " FACES TILT "} } }", 0, -.2, .4, -.8);
    expect_normal(QUAD "uv_vectors { 4, <0,0>, <2,0>, <3,1>, <1,1> } " FACES TILT "} } }", 0, .4, .2, -.8);
    /* a picture that is turned or mirrored on the UV */
    expect_normal(QUAD UV FACES TILT "rotate 90*z } } }", 0, -.2, .4, -.8);
    expect_normal(QUAD UV FACES TILT "scale <-1,1,1> } } }", 0, -.4, .2, -.8);
    expect_normal(QUAD UV FACES TILT "scale <3,.1,1> translate x } } }", 0, .4, .2, -.8);
    /* the object moves */
    expect_normal(QUAD UV FACES TILT "} } rotate 90*z translate <1,-.3,0> }", 0, -.2, .4, -.8);
    expect_normal(QUAD UV FACES TILT "} } scale <-1,1,1> translate x }", 0, -.4, .2, -.8);
    expect_normal(QUAD UV FACES TILT "} } scale <2,1,3> }", 0, .4, .2, -.8);
    /* no UV, or UV in a line: smooth */
    expect_normal(QUAD FACES TILT "} } }", 0, 0, 0, -1);
    expect_normal(QUAD "uv_vectors { 4, <0,0>, <1,1>, <2,2>, <1,1> } " FACES TILT "} } }", 0, 0, 0, -1);
    /* within other normals */
    expect_normal(QUAD UV FACES
                  "pigment { rgb 1 } normal { average normal_map { [1 retex_normal_map { rgb <1,.5,.5> } ]"
                  " [1 retex_normal_map { rgb <.5,.5,1> } ] } } }",
                  0, 1, 0, -1);
}

#define CARD "mesh2 { vertex_vectors { 4, 0, x, x+y, y } "
#define REVERSED "face_indices { 2, <0,2,1>, <0,3,2> } "

/* A surface has a front only where a mesh has normals, which may be on the other side than its winding. All others are
 * seen from the side that bumps rise to. */
static void winding_makes_no_front(void **state)
{
    (void)state;
    static const char *const faces[] = {FACES, REVERSED};
    char text[1024];
    for (int i = 0; i < 2; i++)
        for (int behind = 0; behind < 2; behind++) {
            snprintf(text, sizeof text, CARD UV "%s" TILT "} } }", faces[i]);
            expect_normal(text, behind, .4, .2, behind ? .8 : -.8);
            snprintf(text, sizeof text, CARD "uv_vectors { 4, <1,0>, <0,0>, <0,1>, <1,1> } %s" TILT "} } }", faces[i]);
            expect_normal(text, behind, -.4, .2, behind ? .8 : -.8);
            for (int away = 0; away < 2; away++) {
                const double side = behind == away ? 1 : -1;
                snprintf(text, sizeof text, CARD "normal_vectors { 4, %s } " UV "%s" TILT "} } }",
                         away ? "z, z, z, z" : "-z, -z, -z, -z", faces[i]);
                expect_normal(text, behind, .4 * side, .2 * side, behind ? .8 : -.8);
            }
        }
    /* a side of a box, on which u grows against x, from outside and inside */
    expect_normal("box { <0,0,0>, <1,1,9> " TILT "} } }", 0, -.4, .2, -.8);
    expect_normal("box { <0,0,0>, <1,1,9> " TILT "} } }", 1, -.4, .2, .8);
}

/* Corners that have all but the mirroring of UV in common keep their own sides, however large the angles of the other
 * side are there. */
static void mirrored_halves_stay_apart(void **state)
{
    (void)state;
    const char *two = "mesh2 { vertex_vectors { 6, <.5,0,0>, <1,0,0>, <1,1,0>, <.5,1,0>, <0,1,0>, %s }"
                      " normal_vectors { 6, -z,-z,-z,-z,-z,-z }"
                      " uv_vectors { 6, <0,0>, <1,0>, <1,1>, <0,1>, <1,1>, <1,0> }"
                      " face_indices { 4, <0,1,2>, <0,2,3>, <0,3,4>, <0,4,5> } " TILT "} } %s }";
    char text[1024];
    snprintf(text, sizeof text, two, "<-.5,-1,0>", "");
    expect_normal(text, 0, .4, .2, -.8);
    snprintf(text, sizeof text, two, "<0,0,0>", "translate .6*x");
    expect_normal(text, 0, -.4, .2, -.8);
}

/* Heights that rise by 1 with u, in a colour whose luminance that is. */
#define RISE "pigment { rgb 1 } normal { retex_height_map { gradient x color_map { [0 rgb 0] [1 rgb <0,1/.7152,0>] } "

/* The normal of a slope s is that of the surface minus s along it: of a card that faces -z, (-s, 0, -1). */
static void heights_are_slopes_of_the_surface(void **state)
{
    (void)state;
    expect_normal(QUAD UV FACES RISE "} } }", 0, -1, 0, -1);
    expect_normal(QUAD UV FACES RISE "} .5 } }", 0, -.5, 0, -1);
    expect_normal(QUAD UV FACES RISE "} -.5 } }", 0, .5, 0, -1);
    expect_normal(QUAD UV FACES RISE "} bump_size .25 } }", 0, -.25, 0, -1);
    /* on both sides heights rise to where one looks from */
    expect_normal(QUAD UV FACES RISE "} .5 } }", 1, -.5, 0, 1);
    /* UV that are mirrored, turned, sheared: in the last, u = 2 x + y */
    expect_normal(QUAD "uv_vectors { 4, <1,0>, <0,0>, <0,1>, <1,1> } " FACES RISE "} .5 } }", 0, .5, 0, -1);
    expect_normal(QUAD "uv_vectors { 4, <0,0>, <0,1>, <1,1>, <1,0> } " FACES RISE "} .5 } }", 0, 0, -.5, -1);
    expect_normal(QUAD "uv_vectors { 4, <0,0>, <2,0>, <3,1>, <1,1> } " FACES RISE "scale 4 } 1 } }", 0, -.5, -.25, -1);
    /* the picture is scaled on the UV; heights stay as high where the object is larger, and slopes are flatter */
    expect_normal(QUAD UV FACES RISE "scale 2 } } }", 0, -.5, 0, -1);
    expect_normal(QUAD UV FACES RISE "} } scale <2,1,3> }", 0, -.5, 0, -1);
    expect_normal(QUAD UV FACES RISE "} } rotate 90*z translate <1,-.3,0> }", 0, 0, -1, -1);
    /* a part of the strength: the mean of that normal and the plain one */
    expect_normal(QUAD UV FACES RISE "} .75 strength .5 } }", 0, -.3, 0, -.9);
    expect_normal(QUAD UV FACES RISE "} .75 strength 0 } }", 0, 0, 0, -1);
    expect_normal(QUAD FACES RISE "} } }", 0, 0, 0, -1);
}

/* Shapes have UV too: of a sphere of radius 2, u rises by 1 in 4 pi at the equator, and more slowly nowhere. */
static void heights_on_a_sphere(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere { 0, 2 " RISE "} } }");
    const double latitude = .5, longitude = 2, r = cos(latitude);
    scene->pixels->apart = .02;
    const Vec3 out = vec3(r * cos(longitude), sin(latitude), r * sin(longitude));
    const Surface s = seen(scene, vec_scale(out, 4), vec_neg(out));
    const Vec3 east = vec3(-sin(longitude), 0, cos(longitude));
    const Vec3 n = normal_tilted(s.texture->normal, &s, out, vec_neg(out));
    const Vec3 want = vec_normalize(vec_mad(out, east, -1 / (4 * PI * r)));
    assert_true(vec_length(vec_sub(n, want)) < 1e-4);
    scene_close(&scene);
}

/* An instance is larger than its prototype. */
static void heights_of_instances(void **state)
{
    (void)state;
    Scene *scene = parse(V37 QUAD UV FACES RISE "} } }");
    const Instance instance = {.transform = transform_scale(vec3(4, 1, 1))};
    scene->pixels->apart = .2;
    Surface s = seen(scene, vec3(.7, .4, -3), vec3(0, 0, 1));
    s.position = transform_point(&instance.transform, s.position);
    s.instance = &instance;
    const Vec3 n = normal_tilted(s.texture->normal, &s, vec3(0, 0, -1), vec3(0, 0, 1));
    assert_true(vec_length(vec_sub(n, vec_normalize(vec3(-.25, 0, -1)))) < 1e-6);
    scene_close(&scene);
}

/* Of a step of 1 at u = .5, pixels that are .6 apart see a slope of 1 / .6 at u = .7, and narrow ones none. */
static void heights_over_two_pixels(void **state)
{
    (void)state;
    Scene *scene = parse(V37 QUAD UV FACES "pigment { rgb 1 } normal { retex_height_map { gradient x color_map "
                                           "{ [0 rgb 0] [.5 rgb 0] [.5 rgb 1] [1 rgb 1] } } } }");
    const Surface s = seen(scene, vec3(.7, .4, -3), vec3(0, 0, 1));
    const PixelSize sizes[] = {{{0, 0, 0}, 0, .3}, {{0, 0, 0}, 0, .6}, {{.7, .4, -3}, .2, 0}, {{.7, .4, -1}, .2, 0}};
    const double slopes[] = {0, 1 / .6, 1 / .6, 0};
    for (int k = 0; k < 4; k++) {
        *scene->pixels = sizes[k];
        const Vec3 n = normal_tilted(s.texture->normal, &s, vec3(0, 0, -1), vec3(0, 0, 1));
        assert_true(vec_length(vec_sub(n, vec_normalize(vec3(-slopes[k], 0, -1)))) < 1e-6);
    }
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_has_its_tangents),
        cmocka_unit_test(corners_of_meshes_are_smooth),
        cmocka_unit_test(maps_are_along_uv),
        cmocka_unit_test(winding_makes_no_front),
        cmocka_unit_test(mirrored_halves_stay_apart),
        cmocka_unit_test(heights_are_slopes_of_the_surface),
        cmocka_unit_test(heights_on_a_sphere),
        cmocka_unit_test(heights_of_instances),
        cmocka_unit_test(heights_over_two_pixels),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
