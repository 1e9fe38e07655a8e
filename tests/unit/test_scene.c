/* The scene side of the language: shapes in canonical form, the order of transforms and textures, groups, layers,
 * meshes, polygons, cameras, the working space, targets; and that broken scenes end in one clear error. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "scene/scene.h"
#include "sdl/sdl.h"
#include "shade/pigment.h"

/* ---- scenes from text ---- */

static char messages[8192];

static void collect(void *context, int level, const char *text)
{
    (void)context;
    (void)level;
    size_t used = strlen(messages);
    snprintf(messages + used, sizeof messages - used, "%s\n", text);
}

static int parse_with(Scene **scene, const char *text, SdlOptions *options, RetexError *err)
{
    char path[] = "/tmp/test_scene_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    size_t length = strlen(text);
    assert_int_equal(write(file, text, length), (ssize_t)length);
    close(file);
    messages[0] = 0;
    options->message = collect;
    int code = sdl_parse_file(scene, path, options, err);
    unlink(path);
    return code;
}

static Scene *parse(const char *text)
{
    Scene *scene;
    RetexError err = {0};
    SdlOptions options = SDL_OPTIONS_INIT;
    if (parse_with(&scene, text, &options, &err))
        fail_msg("line %d column %d: %s", err.line, err.column, err.message);
    return scene;
}

static void expect_error(const char *text, const char *part)
{
    Scene *scene;
    RetexError err = {0};
    SdlOptions options = SDL_OPTIONS_INIT;
    int code = parse_with(&scene, text, &options, &err);
    assert_int_not_equal(code, 0);
    assert_null(scene);
    assert_int_equal(err.code, code);
    if (!strstr(err.message, part))
        fail_msg("`%s` is not in the message `%s`", part, err.message);
}

static void assert_near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-6 * (1 + fabs(b))))
        fail_msg("%.9g is not %.9g", a, b);
}

static void assert_vec(Vec3 a, double x, double y, double z)
{
    assert_near(a.x, x);
    assert_near(a.y, y);
    assert_near(a.z, z);
}

static void assert_color(Rgbft c, double r, double g, double b)
{
    assert_near(c.r, r);
    assert_near(c.g, g);
    assert_near(c.b, b);
}

static const Primitive *only(const Scene *scene)
{
    assert_int_equal(scene->nprimitives, 1);
    return &scene->primitives[0];
}

static Rgbft color_at(const Primitive *p, double x, double y, double z)
{
    return pigment_eval(p->texture->pigment, vec3(x, y, z), (Vec2){0, 0});
}

#define V37 "#version 3.7; global_settings{assumed_gamma 1} "

/* ---- shapes ---- */

static void test_sphere_and_transforms(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{<1,2,3>,2 scale <2,1,1> rotate 90*z translate x}");
    const Primitive *p = only(scene);
    assert_int_equal(p->kind, SHAPE_SPHERE);
    /* Left-handed: a turn of 90 degrees about z takes x to y. (2,2,3) -> (-2,2,3) -> (-1,2,3). */
    assert_vec(transform_point(&p->transform, vec3(0, 0, 0)), -1, 2, 3);
    assert_vec(transform_vector(&p->transform, vec3(1, 0, 0)), 0, 4, 0);
    scene_close(&scene);
    assert_null(scene);
}

static void test_box(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "box{<1,-2,3>,<-1,2,-3>} box{<-1,0,-1>,<1,0,1>}");
    assert_int_equal(scene->nprimitives, 2);
    assert_vec(transform_point(&scene->primitives[0].transform, vec3(0, 0, 0)), -1, -2, -3);
    assert_vec(transform_point(&scene->primitives[0].transform, vec3(1, 1, 1)), 1, 2, 3);
    Vec3 top = transform_point(&scene->primitives[1].transform, vec3(1, 1, 1));
    assert_true(top.y > 0 && top.y < 1e-5); /* a card */
    scene_close(&scene);
}

static void test_plane(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "plane{<0,0,-5>,2} plane{y,-1}");
    const Transform *t = &scene->primitives[0].transform;
    assert_vec(transform_point(t, vec3(0, 0, 0)), 0, 0, -2); /* along the unit normal */
    assert_vec(vec_normalize(transform_normal(t, vec3(0, 1, 0))), 0, 0, -1);
    assert_vec(transform_point(&scene->primitives[1].transform, vec3(3, 0, 4)), 3, -1, 4);
    scene_close(&scene);
}

static void test_cone_torus_disc(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "cone{<1,0,0>,.5,<1,4,0>,.25 open} cylinder{-z,z,2} torus{3,.5} disc{y,<1,0,0>,4,1}");
    const Primitive *p = scene->primitives;
    assert_int_equal(p[0].kind, SHAPE_CONE);
    assert_true(p[0].open && !p[1].open);
    assert_near(p[0].r0, 0.5);
    assert_near(p[0].r1, 0.25);
    assert_vec(transform_point(&p[0].transform, vec3(0, 0, 1)), 1, 4, 0);
    assert_near(vec_length(transform_vector(&p[0].transform, vec3(1, 0, 0))), 1);
    assert_vec(transform_point(&p[1].transform, vec3(0, 0, 0)), 0, 0, -1);
    assert_near(p[2].r0, 3);
    assert_near(p[2].r1, 0.5);
    assert_near(p[3].r0, 4);
    assert_near(p[3].r1, 1);
    assert_vec(transform_normal(&p[3].transform, vec3(0, 0, 1)), 1, 0, 0);
    scene_close(&scene);
}

static void test_degenerate_shapes(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{0,0} cylinder{x,x,1} disc{0,0,1} triangle{0,x,2*x} torus{1,0}"
                             "box{y,y} sphere{0,-1}");
    assert_near(vec_length(transform_vector(&only(scene)->transform, vec3(1, 0, 0))), 1);
    scene_close(&scene);
    expect_error(V37 "plane{<0,0,0>,1}", "normal");
    expect_error(V37 "sphere{0,1 matrix <1,0,0, 1,0,0, 0,0,1, 0,0,0>}", "inverse");
}

/* ---- textures and order ---- */

static void test_texture_order(void **state)
{
    (void)state;
    /* The pattern moves with what comes after the texture only. */
    Scene *scene = parse(V37 "#declare P = pigment{checker rgb <1,0,0> rgb <0,1,0>}"
                             "sphere{0,1 pigment{P} translate 5*x} sphere{0,1 translate 5*x pigment{P}}"
                             "sphere{0,1 texture{pigment{P} translate x} scale 2}");
    const Primitive *p = scene->primitives;
    for (double x = -3.25; x < 4; x += 0.5) {
        Rgbft plain = color_at(&p[1], x, 0.5, 0.5), moved = color_at(&p[0], x + 5, 0.5, 0.5);
        assert_color(moved, plain.r, plain.g, plain.b);
        moved = color_at(&p[2], 2 * (x + 1), 1, 1);
        assert_color(moved, plain.r, plain.g, plain.b);
    }
    scene_close(&scene);
}

static void test_uv_mapping_stays(void **state)
{
    (void)state;
    /* Measured: what moves the object or the texture leaves a uv-mapped pigment alone; the pigment's own does not. */
    Scene *scene =
        parse(V37 "sphere{0,1 texture{pigment{uv_mapping checker scale .1 translate .05*x} scale 3} rotate 40*y}"
                  "sphere{0,1 uv_mapping texture{pigment{checker scale .1} translate .05*x} rotate 40*y}"
                  "union{sphere{0,1} uv_mapping pigment{checker scale .1 translate .05*x} translate x}");
    for (int i = 0; i < 3; i++) {
        const Pigment *pigment = scene->primitives[i].texture->pigment;
        assert_true(pigment->uv_mapping);
        assert_vec(transform_point(&pigment->transform, vec3(1, 0, 0)), 0.15, 0, 0);
    }
    scene_close(&scene);
}

static void test_groups(void **state)
{
    (void)state;
    Scene *scene = parse(
        V37 "#declare Leg = cylinder{0,y,.1}"
            "union{ object{Leg} object{Leg pigment{rgb <0,0,1>} translate x} no_shadow pigment{rgb <1,0,0>} scale 2 }"
            "object{Leg}");
    assert_int_equal(scene->nprimitives, 3);
    assert_color(color_at(&scene->primitives[0], 0, 0, 0), 1, 0, 0);
    assert_color(color_at(&scene->primitives[1], 0, 0, 0), 0, 0, 1);
    assert_vec(transform_point(&scene->primitives[1].transform, vec3(0, 0, 1)), 2, 2, 0);
    assert_true(scene->primitives[0].no_shadow && scene->primitives[1].no_shadow && !scene->primitives[2].no_shadow);
    assert_color(color_at(&scene->primitives[2], 0, 0, 0), 0, 0, 0); /* the default pigment */
    scene_close(&scene);
}

static void test_default_at_instantiation(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "#declare B = sphere{0,1} #default{pigment{rgb <0,1,0>} finish{diffuse .9}} object{B}"
                             "#default{pigment{rgb <1,1,0>}} object{B finish{phong 1}}");
    assert_color(color_at(&scene->primitives[0], 0, 0, 0), 0, 1, 0);
    assert_color(color_at(&scene->primitives[1], 0, 0, 0), 1, 1, 0);
    assert_near(scene->primitives[1].texture->finish->diffuse, 0.9);
    scene_close(&scene);
}

static void test_overrides(void **state)
{
    (void)state;
    Scene *scene =
        parse(V37 "#declare T = texture{pigment{rgb <1,0,0>} finish{specular .5}} #declare O = sphere{0,1 texture{T}}"
                  "object{O texture{pigment{rgb <0,1,0>}}}"    /* laid over */
                  "object{O pigment{rgb <0,0,1>}}"             /* changed in place: the finish stays */
                  "object{O texture{pigment{rgbt <0,1,0,1>}}}" /* clear: what is under it shows */
                  "object{O}");
    assert_color(color_at(&scene->primitives[0], 0, 0, 0), 0, 1, 0);
    assert_color(color_at(&scene->primitives[1], 0, 0, 0), 0, 0, 1);
    assert_near(scene->primitives[1].texture->finish->specular, 0.5);
    assert_color(color_at(&scene->primitives[2], 0, 0, 0), 1, 0, 0);
    assert_color(color_at(&scene->primitives[3], 0, 0, 0), 1, 0, 0);
    assert_non_null(strstr(messages, "layered"));
    scene_close(&scene);
}

static void test_layered_declaration(void **state)
{
    (void)state;
    /* The second texture belongs to A; the next #declare uses A and must not be run before A exists. */
    Scene *scene = parse(V37 "#declare A = texture{pigment{rgb 1}} texture{pigment{rgb <1,0,0>}}\n"
                             "#declare B = texture{A scale 2}\nsphere{0,1 texture{B}}");
    assert_color(color_at(only(scene), 0, 0, 0), 1, 0, 0);
    scene_close(&scene);
}

static void test_means(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{0,1 pigment{bozo color_map{[0 rgb 0][.5 rgb <1,0,0>][.5 rgb <0,0,1>]}}}");
    assert_color(color_at(only(scene), 3, 4, 5), 0.25, 0, 0.5);
    assert_non_null(strstr(messages, "`bozo` is not supported yet"));
    scene_close(&scene);
    /* Declared but not used: nothing to report, and strict does not mind. */
    SdlOptions options = SDL_OPTIONS_INIT;
    options.strict = 1;
    RetexError err = {0};
    assert_int_equal(parse_with(&scene, V37 "#declare P = pigment{bozo} sphere{0,1}", &options, &err), 0);
    assert_null(strstr(messages, "bozo"));
    scene_close(&scene);
    assert_int_not_equal(parse_with(&scene, V37 "sphere{0,1 pigment{bozo}}", &options, &err), 0);
    assert_non_null(strstr(err.message, "bozo"));
}

static void test_textures_of_a_checker(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "plane{y,0 texture{checker texture{pigment{rgb 1}}"
                             " texture{pigment{rgb <1,0,0>}} scale 2}}");
    assert_int_equal(only(scene)->texture->pigment->kind, PIGMENT_CHECKER);
    assert_color(color_at(only(scene), 1, 0, 1), 1, 1, 1);
    assert_color(color_at(only(scene), 3, 0, 1), 1, 0, 0);
    assert_string_equal(messages, "");
    scene_close(&scene);
}

/* ---- finish ---- */

static void test_finish(void **state)
{
    (void)state;
    Scene *scene = parse(
        V37 "#declare F = finish{diffuse albedo .7, .2 specular albedo .04 roughness .01 metallic brilliance 2}"
            "sphere{0,1 finish{F reflection{.1, .9 fresnel on falloff 2 exponent .5 metallic .3} conserve_energy}}"
            "sphere{0,1 finish{reflection{.5 fresnel} retex{roughness .3 ior 1.4}}} sphere{0,1 finish{reflection .3}}");
    const Finish *f = scene->primitives[0].texture->finish;
    assert_true(f->diffuse_albedo && f->specular_albedo && f->conserve_energy && f->reflection_fresnel);
    assert_near(f->diffuse, 0.7);
    assert_near(f->diffuse_back, 0.2);
    assert_near(f->metallic, 1);
    assert_near(f->reflection_min.r, 0.1);
    assert_near(f->reflection_max.r, 0.9);
    assert_near(f->reflection_falloff, 2);
    assert_near(f->reflection_metallic, 0.3);
    assert_false(f->retex.present);
    f = scene->primitives[1].texture->finish;
    assert_near(f->reflection_min.r, 0);
    assert_near(f->reflection_max.r, 0.5);
    assert_true(f->retex.present);
    assert_near(f->retex.specular_tint, 1);
    assert_near(f->retex.ior, 1.4);
    f = scene->primitives[2].texture->finish;
    assert_near(f->reflection_min.r, 0.3);
    scene_close(&scene);
    expect_error(V37 "sphere{0,1 finish{retex{roughness 2}}}", "between 0 and 1");
    expect_error(V37 "sphere{0,1 finish{shiny 2}}", "finish keyword");
}

static void test_emitters(void **state)
{
    (void)state;
    const char *text = V37 "sphere{0,1 finish{ambient 2 diffuse 0}} sphere{0,1 finish{ambient 2}}"
                           "sphere{0,1 finish{emission 3}}";
    Scene *scene = parse(text);
    assert_near(scene->primitives[0].texture->finish->emission.r, 2);
    assert_near(scene->primitives[1].texture->finish->emission.r, 0);
    assert_near(scene->primitives[2].texture->finish->emission.r, 3);
    scene_close(&scene);
    SdlOptions options = SDL_OPTIONS_INIT;
    options.ambient = 1;
    RetexError err = {0};
    assert_int_equal(parse_with(&scene, text, &options, &err), 0);
    assert_near(scene->primitives[1].texture->finish->emission.r, 2);
    assert_near(scene->primitives[2].texture->finish->emission.r, 3.1);
    scene_close(&scene);
}

static void test_working_space(void **state)
{
    (void)state;
    const char *body = " sphere{0,1 pigment{gradient y color_map{[0 rgb .5][1 rgb .5]}}} light_source{y rgb .5}"
                       "background{rgb .5} sphere{0,1 pigment{rgbf .5}}";
    struct {
        const char *head;
        double value;
    } cases[] = {
        {"#version 3.7; global_settings{assumed_gamma 1}", 0.5},
        {"#version 3.7;", 0.5},
        {"#version 3.7; global_settings{assumed_gamma 2.2}", 0.217637641},
        {"#version 3.7; global_settings{assumed_gamma srgb}", 0.214041140},
        {"#version 3.5;", 0.214041140},
        {"#version 3.5; global_settings{assumed_gamma 1}", 0.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", cases[i].head, body);
        Scene *scene = parse(text);
        double v = cases[i].value;
        assert_near(scene->lights[0].color.g, v);
        assert_near(scene->background.g, v);
        assert_color(color_at(&scene->primitives[0], 0, 0.5, 0), v, v, v);
        assert_color(color_at(&scene->primitives[1], 0, 0, 0), v, v, v);
        assert_near(color_at(&scene->primitives[1], 0, 0, 0).filter, 0.5); /* a share, not a colour */
        scene_close(&scene);
    }
}

static void test_interior(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "#declare M = material{texture{pigment{rgbt 1}}"
                             "  interior{ior 1.5 fade_distance 2 fade_color rgb <1,0,0>}}"
                             "sphere{0,1 material{M}}"
                             "sphere{0,1 interior{ior 1.3} hollow} sphere{0,1 finish{ior 1.4}}");
    assert_near(scene->primitives[0].interior->ior, 1.5);
    assert_near(scene->primitives[0].interior->fade_color.r, 1);
    assert_true(scene->primitives[1].hollow);
    assert_near(scene->primitives[2].interior->ior, 1.4);
    scene_close(&scene);
}

/* ---- meshes ---- */

static const char mesh2_text[] =
    V37 "mesh2{ vertex_vectors{4, <0,0,0>,<1,0,0>,<1,1,0>,<0,1,0>} normal_vectors{1,<0,0,1>}"
        " uv_vectors{4 <0,0>,<1,0>,<1,1>,<0,1>}"
        " texture_list{2, texture{pigment{rgb <1,0,0>}} texture{pigment{rgb <0,1,0>}}}"
        " face_indices{2, <0,1,2>,0, <0,2,3>,1} normal_indices{2,<0,0,0>,<0,0,0>} translate 5*x }";

static void test_mesh2(void **state)
{
    (void)state;
    Scene *scene = parse(mesh2_text);
    const Primitive *p = only(scene);
    const Mesh *mesh = p->mesh;
    assert_int_equal(mesh->nvertices, 4);
    assert_int_equal(mesh->nfaces, 2);
    assert_int_equal(mesh->faces[1].texture, 1);
    assert_int_equal(mesh->faces[1].normal[2], 0);
    assert_int_equal(mesh->faces[1].uv[2], 3); /* by the vertices' indices */
    assert_color(mesh->textures[1]->pigment->color, 0, 1, 0);
    assert_vec(transform_point(&p->transform, mesh->vertices[1]), 6, 0, 0);
    scene_close(&scene);
}

static void test_mesh2_errors(void **state)
{
    (void)state;
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} face_indices{1,<0,1,3>}}", "vertex 3");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} face_indices{1,<0,-1,2>}}", "vertex -1");
    expect_error(V37 "mesh2{vertex_vectors{4,<0,0,0>,<1,0,0>,<0,1,0>} face_indices{1,<0,1,2>}}", "only 3 are there");
    expect_error(V37 "mesh2{vertex_vectors{2,<0,0,0>,<1,0,0>,<0,1,0>} face_indices{1,<0,1,1>}}", "more than");
    expect_error(V37 "mesh2{vertex_vectors{1e12,0,x,y}}", "number of elements");
    expect_error(V37 "mesh2{vertex_vectors{-1,0}}", "number of elements");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} texture_list{1,texture{}} face_indices{1,<0,1,2>,1}}", "texture 1");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} uv_vectors{1,<0,0>} face_indices{1,<0,1,2>}"
                     " uv_indices{1,<0,0,1>}}",
                 "UV 1");
    expect_error(V37 "mesh2{face_indices{0}}", "vertex_vectors");
}

static void test_mesh(void **state)
{
    (void)state;
    Scene *scene = parse(
        V37 "#declare A = texture{pigment{rgb 1}} #declare B = texture{pigment{rgb <1,0,0>}}"
            "mesh{ triangle{0,x,y texture{A}} smooth_triangle{0,z,x,z,y,z uv_vectors <0,0>,<1,0>,<0,1> texture{B}}"
            " triangle{0,x,z texture{A}} triangle{0,z,y} inside_vector y pigment{rgb <0,0,1>} }");
    const Mesh *mesh = only(scene)->mesh;
    assert_int_equal(mesh->nfaces, 4);
    assert_int_equal(mesh->ntextures, 2);
    assert_int_equal(mesh->faces[2].texture, mesh->faces[0].texture);
    assert_int_equal(mesh->faces[3].texture, -1);
    assert_int_equal(mesh->faces[0].normal[0], -1);
    assert_true(mesh->faces[1].normal[2] >= 0 && mesh->faces[1].uv[2] >= 0);
    assert_true(mesh->closed_inside);
    scene_close(&scene);
}

static void test_loose_triangles(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "#declare Net = union{ triangle{0,x,y} triangle{x,y,z translate z}"
                             "  smooth_triangle{0,z,x,z,y,z} pigment{rgb 1} }"
                             "object{Net translate 3*x} sphere{0,1} triangle{0,x,y no_shadow} triangle{0,x,z}");
    assert_int_equal(scene->nprimitives, 4);
    const Mesh *mesh = scene->primitives[0].mesh;
    assert_int_equal(mesh->nfaces, 3);
    assert_vec(mesh->vertices[3], 4, 0, 1);
    assert_int_equal(mesh->faces[0].normal[0], -1);
    assert_vec(mesh->normals[mesh->faces[2].normal[1]], 0, 0, 1);
    assert_string_equal(scene->primitives[0].idents->name, "Net");
    scene_close(&scene);
}

static double mesh_area(const Scene *scene)
{
    double area = 0;
    const Mesh *mesh = only(scene)->mesh;
    for (int i = 0; i < mesh->nfaces; i++) {
        const int *v = mesh->faces[i].vertex;
        area += 0.5 * vec_length(vec_cross(vec_sub(mesh->vertices[v[1]], mesh->vertices[v[0]]),
                                           vec_sub(mesh->vertices[v[2]], mesh->vertices[v[0]])));
    }
    return area;
}

static void test_polygons(void **state)
{
    (void)state;
    struct {
        const char *text;
        double area;
    } cases[] = {
        {"polygon{5,<0,0>,<2,0>,<2,1>,<0,1>,<0,0>}", 2},
        {"polygon{4,<0,0>,<2,0>,<2,1>,<0,1>}", 2},                                       /* not closed */
        {"polygon{10,<0,0>,<4,0>,<4,4>,<0,4>,<0,0>,<1,1>,<1,2>,<2,2>,<2,1>,<1,1>}", 15}, /* a hole */
        {"polygon{7,<0,0>,<3,0>,<3,3>,<2,3>,<2,1>,<0,1>,<0,0>}", 5},                     /* an L */
        {"polygon{5,<0,0>,<2,2>,<2,0>,<0,2>,<0,0>}", 2},                                 /* a bow tie */
        /* Two squares that overlap: even-odd leaves the common part out. */
        {"polygon{10,<0,0>,<2,0>,<2,2>,<0,2>,<0,0>,<1,1>,<3,1>,<3,3>,<1,3>,<1,1>}", 6},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", V37, cases[i].text);
        /* In a plane that leans: areas must not change. */
        char *brace = strrchr(text, '}');
        snprintf(brace, sizeof text - (size_t)(brace - text), " rotate <20,30,40>}");
        Scene *scene = parse(text);
        assert_near(mesh_area(scene), cases[i].area);
        scene_close(&scene);
    }
    expect_error(V37 "polygon{2,0,x}", "points");
    Scene *scene = parse(V37 "polygon{4,0,x,2*x,0}");
    assert_int_equal(scene->nprimitives, 0);
    scene_close(&scene);
}

/* A five-pointed star drawn in one stroke: even-odd leaves its middle empty. */
static void test_star(void **state)
{
    (void)state;
    char text[1024] = V37 "polygon{6";
    for (int i = 0; i <= 5; i++) {
        double a = 2 * PI * (2 * i % 5) / 5;
        snprintf(text + strlen(text), sizeof text - strlen(text), ",<%.17g,%.17g>", cos(a), sin(a));
    }
    strcat(text, "}");
    Scene *scene = parse(text);
    double r = cos(2 * PI / 5) / cos(PI / 5), pentagon = 2.5 * r * r * sin(2 * PI / 5);
    assert_near(mesh_area(scene), 10 * 0.5 * r * sin(PI / 5) - pentagon);
    scene_close(&scene);
}

/* ---- camera, lights, sky ---- */

static void test_camera(void **state)
{
    (void)state;
    /* look_at is applied last wherever it stands; angle is horizontal. */
    expect_error(V37 "camera{location <1e300*1e300,0,0> look_at 0}", "not finite");
    Scene *scene = parse(V37 "camera{look_at <0,0,4> angle 90 right 2*x up y location <0,0,-1>}");
    assert_vec(scene->camera.location, 0, 0, -1);
    assert_vec(scene->camera.direction, 0, 0, 1);
    assert_vec(scene->camera.right, 2, 0, 0);
    assert_int_equal(scene->width, 640);
    assert_int_equal(scene->height, 320);
    scene_close(&scene);
    scene = parse(V37 "camera{right -16/9*x location <5,0,0> look_at 0 translate y}"); /* mirrored */
    assert_vec(scene->camera.location, 5, 1, 0);
    assert_vec(scene->camera.direction, -1, 0, 0);
    assert_vec(scene->camera.right, 0, 0, -16.0 / 9);
    assert_int_equal(scene->height, 360);
    scene_close(&scene);
    scene = parse(V37 "sphere{0,1}");
    assert_near(scene->camera.right.x, 1.33);
    assert_int_equal(scene->height, 480);
    scene_close(&scene);
    scene = parse(V37 "camera{orthographic location -10*z look_at 0 angle 90}");
    assert_int_equal(scene->camera.kind, CAMERA_ORTHOGRAPHIC);
    assert_near(vec_length(scene->camera.right), 20);
    scene_close(&scene);
    scene = parse(V37 "camera{fisheye angle 200 location -z look_at 0}");
    assert_int_equal(scene->camera.kind, CAMERA_PERSPECTIVE);
    assert_non_null(strstr(messages, "fisheye"));
    scene_close(&scene);
    expect_error(V37 "camera{location 0 look_at 0}", "same point");
}

static void test_lights(void **state)
{
    (void)state;
    Scene *scene = parse(
        V37 "#declare Bulb = sphere{0,.1 pigment{rgb 1}}"
            "#declare L = light_source{<0,5,0> rgb <1,.5,.25> spotlight radius 20 falloff 25 tightness 3 point_at 0"
            "  area_light x,z,4,5 jitter adaptive 1 fade_distance 2 fade_power 2 looks_like{Bulb}}"
            "light_source{L rotate 90*z} light_source{0, 2 shadowless parallel point_at y}");
    assert_int_equal(scene->nlights, 2);
    const Light *light = &scene->lights[0];
    assert_int_equal(light->kind, LIGHT_SPOT);
    assert_vec(light->location, -5, 0, 0);
    assert_vec(light->axis1, 0, 1, 0);
    assert_int_equal(light->size2, 5);
    assert_near(light->color.b, 0.25);
    assert_near(light->fade_power, 2);
    assert_true(scene->lights[1].shadowless);
    assert_int_equal(scene->lights[1].kind, LIGHT_PARALLEL);
    const Primitive *bulb = only(scene);
    assert_true(bulb->no_shadow);
    assert_vec(transform_point(&bulb->transform, vec3(0, 0, 0)), -5, 0, 0);
    scene_close(&scene);
}

static void test_light_kinds_written_twice(void **state)
{
    (void)state;
    const struct {
        const char *words;
        LightKind kind;
    } cases[] = {{"cylinder parallel", LIGHT_CYLINDER},
                 {"parallel cylinder", LIGHT_CYLINDER},
                 {"spotlight parallel", LIGHT_PARALLEL},
                 {"parallel spotlight", LIGHT_PARALLEL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[128];
        snprintf(text, sizeof text, V37 "light_source{<0,5,0> 1 %s point_at 0}", cases[k].words);
        Scene *scene = parse(text);
        assert_int_equal(scene->lights[0].kind, cases[k].kind);
        scene_close(&scene);
    }
}

static void test_names_of_insides(void **state)
{
    (void)state;
    /* a texture that is used inside only can be a target too */
    Scene *scene =
        parse(V37 "#declare Lining = texture{pigment{rgb 1}} sphere{0,1 pigment{rgb 0} interior_texture{Lining}}");
    const char *specs[] = {"Lining"};
    assert_int_equal(scene_resolve_targets(scene, specs, 1, NULL), 0);
    assert_int_equal(scene->primitives[0].interior_target, 0);
    assert_int_equal(scene->primitives[0].target, -1);
    scene_close(&scene);
}

static void test_sky(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sky_sphere{pigment{gradient y color_map{[0 rgb 1][1 rgb <0,0,1>]}} pigment{rgbt 1}"
                             " rotate 90*z emission .5}");
    assert_int_equal(scene->sky->npigments, 2);
    assert_near(scene->sky->emission.r, 0.5);
    assert_color(pigment_eval(scene->sky->pigments[0], vec3(-0.5, 0, 0), (Vec2){0, 0}), 0.5, 0.5, 1);
    scene_close(&scene);
}

/* ---- groups we cannot cut ---- */

static void test_csg(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "difference{box{-1,1} sphere{0,1.2} pigment{rgb 1}} "
                             "intersection{plane{y,0} sphere{0,1} box{0,1}} merge{sphere{0,1} sphere{x,1}}");
    assert_int_equal(scene->nprimitives, 4);
    assert_int_equal(scene->primitives[0].kind, SHAPE_BOX);
    assert_int_equal(scene->primitives[1].kind, SHAPE_SPHERE);
    assert_non_null(strstr(messages, "`difference` is not supported yet"));
    assert_non_null(strstr(messages, "`intersection` is not supported yet"));
    scene_close(&scene);
    scene = parse(V37 "blob{threshold .5 sphere{0,1,1} texture{pigment{rgb 1}}} sphere{0,1}");
    assert_int_equal(scene->nprimitives, 1);
    assert_non_null(strstr(messages, "`blob` is not supported yet"));
    scene_close(&scene);
}

/* ---- targets ---- */

static const char target_text[] =
    V37 "#declare Oak = pigment{rgb <.5,.3,.1>} #declare Floor = texture{pigment{Oak} finish{specular .2}}"
        "#declare Wall = material{texture{pigment{rgb 1}}} #declare WALL = texture{pigment{rgb .5}}"
        "#declare Unused = texture{pigment{rgb 0}} #declare Chair = union{box{0,1} box{1,2} texture{Floor}}"
        "plane{y,0 texture{Floor}} plane{x,0 material{Wall}} object{Chair} plane{z,0 texture{WALL}}"
        "mesh2{vertex_vectors{3,0,x,y} texture_list{2,texture{Floor},texture{WALL}} face_indices{1,<0,1,2>,1}}";

static void test_targets(void **state)
{
    (void)state;
    Scene *scene = parse(target_text);
    RetexError err = {0};
    assert_int_equal(scene->nidents, 5); /* Floor Oak Wall Chair WALL, not Unused */
    assert_string_equal(scene->idents[0], "Floor");
    assert_string_equal(scene->idents[1], "Oak");
    const char *chair_first[] = {"Chair", "floor"};
    assert_int_equal(scene_resolve_targets(scene, chair_first, 2, &err), 0);
    assert_string_equal(scene->targets[1].name, "floor");
    assert_string_equal(scene->targets[1].idents, "Floor");
    assert_int_equal(scene->primitives[0].target, 1);
    assert_int_equal(scene->primitives[1].target, -1);
    assert_int_equal(scene->primitives[2].target, 0); /* a chair first, though its texture is Floor */
    assert_int_equal(scene->primitives[5].target, -1);
    assert_int_equal(scene->primitives[5].face_targets[0], 1);
    assert_int_equal(scene->primitives[5].face_targets[1], -1);
    const char *both[] = {"room=Wall,WALL,oak"};
    assert_int_equal(scene_resolve_targets(scene, both, 1, &err), 0);
    assert_string_equal(scene->targets[0].idents, "Wall,WALL,Oak");
    assert_int_equal(scene->primitives[1].target, 0);
    assert_int_equal(scene->primitives[0].target, 0);
    scene_close(&scene);
}

static void test_target_errors(void **state)
{
    (void)state;
    Scene *scene = parse(target_text);
    struct {
        const char *specs[2];
        int n, code;
        const char *part;
    } cases[] = {
        {{"flor"}, 1, RETEX_ENOTFOUND, "similar: Floor"},
        {{"wall"}, 1, RETEX_ENOTFOUND, "could be `Wall` or `WALL`"},
        {{"Unused"}, 1, RETEX_ENOTFOUND, "no texture"},
        {{"a=Floor", "a=Wall"}, 2, RETEX_EINVAL, "twice"},
        {{"=Floor"}, 1, RETEX_EINVAL, "name"},
        {{"a="}, 1, RETEX_EINVAL, "identifier"},
        {{"a=Floor,,Wall"}, 1, RETEX_EINVAL, "identifier"},
        {{"a.b=Floor"}, 1, RETEX_EINVAL, "letters"},
        {{"xyzzy"}, 1, RETEX_ENOTFOUND, "there are: Floor"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RetexError err = {0};
        assert_int_equal(scene_resolve_targets(scene, cases[i].specs, cases[i].n, &err), cases[i].code);
        if (!strstr(err.message, cases[i].part))
            fail_msg("`%s` is not in `%s`", cases[i].part, err.message);
    }
    scene_close(&scene);
}

/* ---- bad input ---- */

static const char everything[] = V37
    "#declare T = texture{pigment{checker rgb 1 rgb 0 scale 2} finish{phong .5 reflection{.1,.2 fresnel}}}"
    "#declare M = color_map{[0 rgb 0][1 rgb 1]} #default{finish{ambient 0}}"
    "camera{location <0,1,-5> look_at 0 angle 40} sky_sphere{pigment{gradient y color_map{M}} rotate x}"
    "light_source{<0,5,0> rgb 1 area_light x,z,2,2 fade_distance 1 fade_power 2}"
    "union{sphere{0,1 texture{T} rotate 30*y} box{0,1} material{texture{T} interior{ior 1.5}}"
    "  matrix <1,0,0,0,1,0,0,0,1,0,2,0>}"
    "mesh2{vertex_vectors{3,<0,0,0>,<1,0,0>,<0,1,0>} uv_vectors{1,<0,0>} face_indices{1,<0,1,2>} uv_indices{1,<0,0,0>}}"
    "mesh{triangle{0,x,y texture{T}}} polygon{4,0,x,y,0} difference{torus{2,1} cone{0,1,y,0}} disc{0,y,1,.5}";

static void test_truncated(void **state)
{
    (void)state;
    char text[sizeof everything];
    SdlOptions options = SDL_OPTIONS_INIT;
    int failed = 0;
    for (size_t length = 0; length < sizeof everything; length++) {
        Scene *scene;
        RetexError err = {0};
        memcpy(text, everything, length);
        text[length] = 0;
        int code = parse_with(&scene, text, &options, &err);
        if (code) {
            assert_true(err.message[0] && err.line > 0);
            assert_null(scene);
            failed++;
        }
        scene_close(&scene);
    }
    assert_true(failed > (int)sizeof everything / 2);
}

/* Characters and words changed at random: an answer or an error, never a crash or a hang. */
static void test_damaged(void **state)
{
    (void)state;
    static const char letters[] = "{}<>[](),;.#-+*/0123456789xyz \"";
    char text[sizeof everything];
    uint32_t seed = 7;
    SdlOptions options = SDL_OPTIONS_INIT;
    options.max_steps = 200000;
    options.max_memory = (size_t)64 << 20;
    for (int round = 0; round < 1500; round++) {
        Scene *scene;
        RetexError err = {0};
        memcpy(text, everything, sizeof everything);
        for (int i = 0; i < 1 + round % 4; i++)
            text[(size_t)(test_random(&seed) * (sizeof everything - 1))] =
                letters[(size_t)(test_random(&seed) * (sizeof letters - 1))];
        if (parse_with(&scene, text, &options, &err))
            assert_true(err.message[0]);
        scene_close(&scene);
    }
}

static void test_limits(void **state)
{
    (void)state;
    expect_error(V37 "#declare A = sphere{0,1} #for(I,1,60) #declare A = union{object{A} object{A}} #end"
                     " object{A}",
                 "parts");
    expect_error(V37 "#declare A = union{} #for(I,1,900) #declare A = union{object{A}} #end object{A}", "deep");
    expect_error(V37 "#macro R(N) union{ sphere{0,1} #if(N) R(N-1) #end } #end R(300)", "deep");
    expect_error(V37 "sphere{0,1 pigment{image_map{png \"no such file.png\"}}}", "no such file.png");
    expect_error(V37 "sphere{0,1 texture{Nothing}}", "Nothing");
    expect_error(V37 "sphere{0,1", "modifier");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_and_transforms),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_cone_torus_disc),
        cmocka_unit_test(test_degenerate_shapes),
        cmocka_unit_test(test_texture_order),
        cmocka_unit_test(test_uv_mapping_stays),
        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_default_at_instantiation),
        cmocka_unit_test(test_overrides),
        cmocka_unit_test(test_layered_declaration),
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_textures_of_a_checker),
        cmocka_unit_test(test_finish),
        cmocka_unit_test(test_emitters),
        cmocka_unit_test(test_working_space),
        cmocka_unit_test(test_interior),
        cmocka_unit_test(test_mesh2),
        cmocka_unit_test(test_mesh2_errors),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_loose_triangles),
        cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_star),
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_light_kinds_written_twice),
        cmocka_unit_test(test_names_of_insides),
        cmocka_unit_test(test_sky),
        cmocka_unit_test(test_csg),
        cmocka_unit_test(test_targets),
        cmocka_unit_test(test_target_errors),
        cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_damaged),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
