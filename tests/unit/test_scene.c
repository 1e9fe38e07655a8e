/* What the language builds: shapes in canonical form, the order of transforms and textures, compounds, layers,
 * finishes, the working space. */
#include "lib_scene_text.h"
#include "pattern/patterns.h"
#include "shade/pigment.h"
#include "shape/shapes.h"

#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* ---- shapes ---- */

static void test_sphere_and_transforms(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{<1,2,3>,2 scale <2,1,1> rotate 90*z translate x}");
    const Primitive *p = only(scene);
    assert_ptr_equal(p->shape.ops, &shape_sphere);
    /* Left-handed: a turn of 90 degrees about z takes x to y. (2,2,3) -> (-2,2,3) -> (-1,2,3). */
    assert_vec(transform_point(&p->transform, vec3(0, 0, 0)), -1, 2, 3);
    assert_vec(transform_vector(&p->transform, vec3(1, 0, 0)), 0, 4, 0);
    scene_close(&scene);
    /* A block of transforms is applied from first to last, declared ones in their place; `inverse` undoes it. */
    scene = parse(V37 "#declare Turn = transform{rotate 90*z}"
                      "sphere{0,1 transform{translate x Turn scale 2}} sphere{0,1 transform{translate x Turn inverse}}"
                      "sphere{0,1 transform Turn translate x}");
    assert_vec(transform_point(&scene->primitives[0].transform, vec3(0, 0, 0)), 0, 2, 0);
    assert_vec(transform_point(&scene->primitives[0].transform, vec3(1, 0, 0)), 0, 4, 0);
    assert_vec(transform_point(&scene->primitives[1].transform, vec3(0, 1, 0)), 0, 0, 0);
    assert_vec(transform_point(&scene->primitives[1].transform, vec3(0, 0, 0)), -1, 0, 0);
    assert_vec(transform_point(&scene->primitives[2].transform, vec3(1, 0, 0)), 1, 1, 0);
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
    assert_ptr_equal(p[0].shape.ops, &shape_cone);
    assert_true(p[0].shape.open && !p[1].shape.open);
    assert_near(p[0].shape.r0, 0.5);
    assert_near(p[0].shape.r1, 0.25);
    assert_vec(transform_point(&p[0].transform, vec3(0, 0, 1)), 1, 4, 0);
    assert_near(vec_length(transform_vector(&p[0].transform, vec3(1, 0, 0))), 1);
    assert_vec(transform_point(&p[1].transform, vec3(0, 0, 0)), 0, 0, -1);
    assert_near(p[2].shape.r0, 3);
    assert_near(p[2].shape.r1, 0.5);
    assert_near(p[3].shape.r0, 4);
    assert_near(p[3].shape.r1, 1);
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

static void test_compounds(void **state)
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
    const Texture *layers = scene->primitives[2].texture;
    assert_int_equal(texture_leaf_count(layers), 2);
    assert_near(texture_leaf(layers, 0)->pigment->color.transmit, 1);
    assert_near(texture_leaf(layers, 1)->pigment->color.r, 1);
    assert_color(color_at(&scene->primitives[3], 0, 0, 0), 1, 0, 0);
    assert_string_equal(messages, "");
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
    Scene *scene = parse(V37 "sphere{0,1 pigment{projection{x} color_map{[0 rgb 0][.5 rgb <1,0,0>][.5 rgb <0,0,1>]}}}");
    assert_color(color_at(only(scene), 3, 4, 5), 0.25, 0, 0.5);
    assert_non_null(strstr(messages, "`projection` is not supported yet"));
    scene_close(&scene);
    /* Declared but not used: nothing to report, and strict does not mind. */
    SdlOptions options = SDL_OPTIONS_INIT;
    options.strict = 1;
    RetexError err = {0};
    assert_int_equal(parse_with(&scene, V37 "#declare P = pigment{projection{x}} sphere{0,1}", &options, &err), 0);
    assert_null(strstr(messages, "projection"));
    scene_close(&scene);
    assert_int_not_equal(parse_with(&scene, V37 "sphere{0,1 pigment{projection{x}}}", &options, &err), 0);
    assert_non_null(strstr(err.message, "projection"));
}

static void test_textures_of_a_checker(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "plane{y,0 texture{checker texture{pigment{rgb 1}}"
                             " texture{pigment{rgb <1,0,0>}} scale 2}}");
    const TextureTree *tree = only(scene)->texture->tree;
    assert_int_equal(tree->kind, TEXTURE_MAP);
    assert_ptr_equal(tree->selector->pattern.ops, &pattern_checker);
    assert_near(tree->leaves[1]->pigment->color.g, 0);
    assert_int_equal((int)pigment_value(tree->selector, &(PatternPoint){.p = vec3(1, 0, 1)}, (Vec2){0, 0}), 0);
    assert_int_equal((int)pigment_value(tree->selector, &(PatternPoint){.p = vec3(3, 0, 1)}, (Vec2){0, 0}), 1);
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

static double emission_by(const char *text, int ambient)
{
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    Scene *scene;
    options.ambient = ambient;
    assert_int_equal(parse_with(&scene, text, &options, &err), 0);
    const double emission = scene->primitives[0].texture->finish->emission.g;
    scene_close(&scene);
    return emission;
}

/* The rule in retex-scene(5). */
static void test_emitters(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double by_rule, all;
    } cases[] = {
        {V37 "sphere{0,1 finish{ambient 2 diffuse 0}}", 2, 2},
        {V37 "sphere{0,1 finish{ambient 2}}", 2, 2},
        {V37 "sphere{0,1 finish{emission 3}}", 3, 3.1},
        {V37 "sphere{0,1}", 0, .1},
        {V37 "sphere{0,1 finish{diffuse 0}}", 0, .1},
        {V37 "sphere{0,1 finish{ambient .1}}", 0, .1},
        {V37 "sphere{0,1 finish{ambient .39}}", .29, .39},
        {V37 "#default{finish{ambient .3}} sphere{0,1}", 0, .3},
        {V37 "#default{finish{ambient .3}} sphere{0,1 finish{ambient .35}}", .05, .35},
        {V37 "#default{finish{ambient 0}} sphere{0,1 finish{ambient .15}}", .05, .15},
        {V37 "sphere{0,1 finish{ambient .4}}", .4, .4},
        {V37 "sphere{0,1 finish{ambient rgb <.5,.1,.1>}}", .1, .1},
        {V37 "sphere{0,1 finish{ambient .11 diffuse 0}}", .11, .11},
        {V37 "#default{finish{ambient .5 diffuse .45}} sphere{0,1}", .5, .5},
        {V37 "global_settings{ambient_light rgb .5} sphere{0,1 finish{ambient .8 emission .1}}", .5, .5},
        {V37 "global_settings{radiosity{}} sphere{0,1 finish{ambient 1 diffuse 0}}", 0, 1},
        {"#version 3.5; global_settings{assumed_gamma 1 radiosity{}} sphere{0,1 finish{ambient 1}}", 1, 1},
        /* the number is looked at as it is written, and then decoded */
        {"#version 3.5; sphere{0,1 finish{ambient .5}}", .214041140, .214041140},
        {"#version 3.7; global_settings{assumed_gamma .5} sphere{0,1 finish{ambient .36}}", .509901951, .6},
        /* A bright background gives what ambient stands for. */
        {V37 "background{rgb .5} sphere{0,1 finish{ambient .5 diffuse .45}}", 0, .5},
        {V37 "background{rgb .2} sphere{0,1 finish{ambient .2}}", 0, .2},
        {V37 "background{rgb .19} sphere{0,1 finish{ambient .2}}", .1, .2},
        {V37 "background{rgb .49} sphere{0,1 finish{ambient .5 diffuse .45}}", .5, .5},
        {V37 "background{rgb 1} sphere{0,1 finish{ambient .5 diffuse 0}}", .5, .5},
        {V37 "background{rgb 2} sphere{0,1 finish{ambient 1 diffuse .5}}", 1, 1},
        {V37 "background{rgb .5} light_source{0,rgb 1} sphere{0,1 finish{ambient .5 diffuse .45}}", .5, .5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_float_equal(emission_by(cases[k].text, 0), cases[k].by_rule, 1e-6);
        assert_float_equal(emission_by(cases[k].text, 1), cases[k].all, 1e-6);
        assert_float_equal(emission_by(cases[k].text, -1), k == 2 ? 3 : k == 14 ? .1 : 0, 1e-6);
    }
}

/* What fills shadows and what surrounds the camera is left to paths. */
static void test_sampled_emitters(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{0,1 finish{ambient .9 diffuse 0}} sphere{0,1 finish{ambient 1 diffuse 0}}"
                             "sphere{0,1 finish{emission .1}} sphere{0,1 finish{emission .1 ambient .5}}"
                             "sphere{0,1}");
    const int sampled[] = {0, 1, 1, 1, 0};
    for (int k = 0; k < 5; k++)
        assert_int_equal(finish_is_sampled(scene->primitives[k].texture->finish), sampled[k]);
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

static void finishes_of_new_scenes_and_interiors_of_old_ones(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere { 0, 1 double_illuminate finish { irid { 2 thickness 1 } use_alpha fresnel 0 } }");
    assert_true(only(scene)->double_illuminate);
    assert_true(only(scene)->texture->finish->use_alpha);
    assert_non_null(strstr(messages, "irid 2 would make light"));
    assert_null(strstr(messages, "fresnel"));
    scene_close(&scene);
    scene = parse(V37 "sphere { 0, 1 finish { fresnel } interior { caustics 1 } }");
    assert_non_null(strstr(messages, "finish fresnel"));
    assert_non_null(strstr(messages, "interior caustics"));
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finishes_of_new_scenes_and_interiors_of_old_ones),
        cmocka_unit_test(test_sphere_and_transforms),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_cone_torus_disc),
        cmocka_unit_test(test_degenerate_shapes),
        cmocka_unit_test(test_texture_order),
        cmocka_unit_test(test_uv_mapping_stays),
        cmocka_unit_test(test_compounds),
        cmocka_unit_test(test_default_at_instantiation),
        cmocka_unit_test(test_overrides),
        cmocka_unit_test(test_layered_declaration),
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_textures_of_a_checker),
        cmocka_unit_test(test_finish),
        cmocka_unit_test(test_emitters),
        cmocka_unit_test(test_sampled_emitters),
        cmocka_unit_test(test_working_space),
        cmocka_unit_test(test_interior),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
