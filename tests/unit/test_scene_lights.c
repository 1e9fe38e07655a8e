/* What the language builds: camera, lights, sky and targets. */
#include "lib_scene_text.h"

#include <stdio.h>
#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "camera/cameras.h"
#include "light/environment.h"
#include "light/source.h"
#include "shade/pigment.h"

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
    assert_ptr_equal(scene->camera.ops, &camera_orthographic);
    assert_near(vec_length(scene->camera.right), 20);
    assert_near(vec_length(scene->camera.up), 20 / 1.33);
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
    assert_ptr_equal(light->ops, &light_spotlight);
    assert_vec(light->location, -5, 0, 0);
    assert_vec(light->axis1, 0, 1, 0);
    assert_int_equal(light->size2, 5);
    assert_near(light->color.b, 0.25);
    assert_near(light->fade_power, 2);
    assert_true(scene->lights[1].shadowless);
    assert_ptr_equal(scene->lights[1].ops, &light_parallel);
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
        const LightOps *ops;
    } cases[] = {{"cylinder parallel", &light_cylinder},    {"parallel cylinder", &light_cylinder},
                 {"spotlight parallel", &light_parallel},   {"parallel spotlight", &light_parallel},
                 {"spotlight shadowless", &light_point},    {"parallel shadowless", &light_parallel},
                 {"shadowless spotlight", &light_spotlight}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[128];
        snprintf(text, sizeof text, V37 "light_source{<0,5,0> 1 %s point_at 0}", cases[k].words);
        Scene *scene = parse(text);
        assert_ptr_equal(scene->lights[0].ops, cases[k].ops);
        scene_close(&scene);
    }
}

static const char LAMPS[] =
    V37 "#declare T = texture{pigment{rgb 1} finish{emission <4,2,1>}} #declare Bulb = sphere{0,1 texture{T}}"
        "#declare Spot = light_source{-y <1,.5,.25> spotlight} #declare Red = light_source{z <2,0,0>}"
        "light_source{y 1} object{Bulb} sphere{0,1} light_source{Spot} light_source{Red}"
        "box{0,1 texture{pigment{checker color rgb 0 color rgb 1} finish{ambient 2}}}"
        "mesh{triangle{0,x,y} triangle{0,x,z texture{T}}} light_source{x 0} background{rgb <.5,1,.5>}";

static Scene *parse_lamps(const char *const *specs, int nspecs)
{
    RetexError err = {0};
    Scene *scene = parse(LAMPS);
    if (scene_resolve_lamps(scene, specs, nspecs, &err))
        fail_msg("%s", err.message);
    return scene;
}

static void test_lamps(void **state)
{
    (void)state;
    const char *specs[] = {"spot", "Ball=#1", "T", "sky", "box=#3", "one=light_source#1"};
    Scene *scene = parse_lamps(specs, 6);
    assert_int_equal(scene->nlamps, 7);
    assert_int_equal(scene->lights[0].lamp, 5);
    assert_int_equal(scene->lights[1].lamp, 0);
    assert_int_equal(scene->lights[2].lamp, 6); /* the rest */
    assert_int_equal(scene->lights[3].lamp, 6);
    assert_int_equal(scene->primitives[0].lamp, 1); /* the first that was asked for */
    assert_int_equal(scene->primitives[1].lamp, 6);
    assert_int_equal(scene->primitives[2].lamp, 4);
    assert_int_equal(scene->primitives[3].lamp, 2); /* by the texture of a face */
    assert_int_equal(scene->sky_lamp, 3);
    assert_string_equal(scene->lamps[6].name, "rest");
    scene_close(&scene);
    scene = parse_lamps(NULL, 0);
    assert_int_equal(scene->nlamps, 0);
    assert_int_equal(scene->lights[1].lamp, 0);
    assert_int_equal(scene->sky_lamp, 0);
    scene_close(&scene);
}

static void assert_color_near(Rgb c, double r, double g, double b)
{
    assert_color((Rgbft){c.r, c.g, c.b, 0, 0}, r, g, b);
}

/* The colour of a lamp, and what its light is while paths are traced. */
static void test_lamp_colors(void **state)
{
    (void)state;
    const char *specs[] = {"Spot", "Red", "Bulb", "box=#3", "sky", "off=light_source#4", "both=light_source#1,T"};
    Scene *scene = parse_lamps(specs, 7);
    const Lamp *lamps = scene->lamps;
    for (int l = 0; l < 7; l++)
        assert_int_equal(lamps[l].several, l == 3 || l == 6);
    assert_color_near(lamps[0].value, 1, 0.5, 0.25);
    assert_color_near(lamps[0].kept, 1, 0.5, 0.25);
    assert_color_near(lamps[0].shown, 1, 1, 1);
    const float red = 2 * rgb_luminance(rgb(1, 0, 0));
    assert_color_near(lamps[1].value, 2, 0, 0);
    assert_color_near(lamps[1].kept, red, red, red);
    assert_color_near(lamps[1].shown, 2 / red, 0, 0);
    assert_color_near(scene->lights[2].color, red, red, red);
    assert_color_near(lamps[2].value, 4, 2, 1);
    assert_color_near(lamps[3].value, 1, 1, 1);
    assert_color_near(lamps[4].value, 0.5, 1, 0.5);
    assert_color_near(lamps[5].value, 0, 0, 0);
    assert_color_near(lamps[5].kept, 1, 1, 1);
    assert_color_near(lamps[5].shown, 0, 0, 0);
    assert_color_near(scene->lights[3].color, 1, 1, 1);
    assert_color_near(lamps[6].kept, 1, 1, 1);
    scene_close(&scene);
}

/* A sky of one colour, however it is written, is a lamp of that colour; but one with a channel of 0 is multiplied. */
static void test_sky_colors(void **state)
{
    (void)state;
    const struct {
        const char *sky;
        int one, several;
        double color[3];
    } cases[] = {
        {"sky_sphere{pigment{rgb <.4,.6,.9>}}", 1, 0, {0.4, 0.6, 0.9}},
        {"sky_sphere{pigment{rgb <.2,.4,.8>} emission 2}", 1, 0, {0.4, 0.8, 1.6}},
        {"sky_sphere{pigment{rgb .5} pigment{rgbt <1,0,0,.5>}}", 1, 0, {0.75, 0.25, 0.25}},
        {"sky_sphere{pigment{gradient y color_map{[0 rgb <.4,.6,.9>][1 rgb <.4,.6,.9>]}}}", 1, 0, {0.4, 0.6, 0.9}},
        {"sky_sphere{pigment{gradient y color_map{[0 rgb <.4,.6,.9>][1 rgb <.4,.6,.8>]}}}", 0, 1, {0}},
        {"sky_sphere{pigment{rgb <0,.5,1>}}", 1, 1, {0, 0.5, 1}},
        {"background{rgb 1} sky_sphere{pigment{rgbt <1,0,0,.5>}}", 1, 0, {1, 0.5, 0.5}},
        {"background{rgb 1} sky_sphere{pigment{rgbt <1,0,0,.5>}} light_source{y 1}", 0, 1, {0}}, /* seen, no light */
        {"background{rgb <.4,.6,.9>}", 1, 0, {0.4, 0.6, 0.9}},
    };
    const char *const sky = "sky";
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, V37 "%s", cases[k].sky);
        Scene *scene = parse(text);
        assert_int_equal(scene_resolve_lamps(scene, &sky, 1, NULL), 0);
        const Lamp *lamp = &scene->lamps[0];
        assert_int_equal(lamp->has_one_color, cases[k].one);
        assert_int_equal(lamp->several, cases[k].several);
        const double *c = cases[k].color;
        if (cases[k].one)
            assert_color_near(lamp->color, c[0], c[1], c[2]);
        if (!cases[k].several)
            assert_color_near(lamp->value, c[0], c[1], c[2]);
        scene_close(&scene);
    }
}

static void test_each_lamp(void **state)
{
    (void)state;
    static const char *const names[] = {
        "light1=light_source#1", "Spot", "Red", "light4=light_source#4", "Bulb", "T", "sky"};
    const char *const *specs;
    int count;
    Scene *scene = parse(LAMPS);
    assert_int_equal(scene_each_lamp(scene, 1, 0, &specs, &count, NULL), 0);
    assert_int_equal(count, 7);
    for (int k = 0; k < 7; k++)
        assert_string_equal(specs[k], names[k]);
    assert_int_equal(scene_each_lamp(scene, 0, 0, &specs, &count, NULL), 0);
    assert_int_equal(count, 6);
    scene_close(&scene);
    /* What a lamp has by one of its names needs no other: every lamp gets something. */
    scene = parse(V37 "#declare T = texture{pigment{rgb 1} finish{emission 1}} #declare A = sphere{0,1 texture{T}}"
                      "#declare B = object{A} #declare C = box{0,1 texture{T}} object{A} object{B} object{C}"
                      "box{0,1 texture{T}} union{light_source{x 1} object{B}}");
    assert_int_equal(scene_each_lamp(scene, 0, 0, &specs, &count, NULL), 0);
    assert_int_equal(scene_resolve_lamps(scene, specs, count, NULL), 0);
    scene_close(&scene);
    /* Without a name, objects are lamps where that is asked for; light sources always, by a name that is free. */
    scene = parse(V37 "#declare light1 = texture{pigment{rgb 1} finish{emission 1}} light_source{x 1}"
                      "sphere{0,1 pigment{rgb 1} finish{emission 1}} box{0,1 texture{light1}} box{2,3}");
    for (int unnamed = 0; unnamed < 2; unnamed++) {
        static const char *const all[] = {"light1_=light_source#1", "light1", "object1=#1"};
        assert_int_equal(scene_each_lamp(scene, 0, unnamed, &specs, &count, NULL), 0);
        assert_int_equal(count, 2 + unnamed);
        for (int k = 0; k < count; k++)
            assert_string_equal(specs[k], all[k]);
        assert_int_equal(scene_resolve_lamps(scene, specs, count, NULL), 0);
    }
    scene_close(&scene);
    scene = parse(V37 "#for (K, 1, 17) light_source{K*y 1} #end");
    assert_int_equal(scene_each_lamp(scene, 0, 0, &specs, &count, NULL), RETEX_ELIMIT);
    scene_close(&scene);
}

static void test_lamps_refused(void **state)
{
    (void)state;
    const struct {
        const char *spec, *message;
    } cases[] = {{"Spt", "nearest: Spot"},
                 {"=Spot", "a name has"},
                 {"a/b=Spot", "letters, digits"},
                 {"Rest=Spot", "all other light"},
                 {"A=", "missing"},
                 {"A=Spot,,Red", "missing"},
                 {"A=light_source#0", "the number of a light source"},
                 {"A=light_source#5", "has 4 light sources"},
                 {"A=#2", "nothing that shines"}, /* a sphere that does not */
                 {"A=#9", "no object `#9`"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RetexError err = {0};
        Scene *scene = parse(LAMPS);
        assert_true(scene_resolve_lamps(scene, &cases[k].spec, 1, &err) < 0);
        if (!strstr(err.message, cases[k].message))
            fail_msg("%s: %s", cases[k].spec, err.message);
        scene_close(&scene);
    }
    const char *twice[] = {"A=Spot", "a=Red"}, *taken[] = {"A=Spot", "Spot"};
    RetexError err = {0};
    Scene *scene = parse(LAMPS);
    assert_true(scene_resolve_lamps(scene, twice, 2, &err) < 0 && strstr(err.message, "named twice"));
    assert_true(scene_resolve_lamps(scene, taken, 2, &err) < 0 && strstr(err.message, "named before it"));
    scene_close(&scene);
}

/* Which primitives throw caustics of which lights: what photons blocks say. */
static void test_photons(void **state)
{
    (void)state;
    static const char TEXT[] =
        V37 "%s light_source{y, 1} light_source{2*y, 1 photons{refraction off}} light_source{3*y, 1 shadowless}"
            "sphere{0,1 photons{target 1 reflection on refraction on collect off}}"
            "union{sphere{0,1} photons{target refraction on reflection off}} sphere{0,1 photons{refraction on}}";
    char text[1024];
    snprintf(text, sizeof text, TEXT, "global_settings{photons{count 100 media 10}}");
    Scene *scene = parse(text);
    const int both = CAUSTICS_REFRACT | CAUSTICS_REFLECT;
    assert_int_equal(scene->lights[0].caustics, both);
    assert_int_equal(scene->lights[1].caustics, CAUSTICS_REFLECT);
    assert_int_equal(scene->lights[2].caustics, 0);
    assert_near(scene->lights[1].size, 2.0 / 200);
    assert_int_equal(scene->primitives[0].caustics, both);
    assert_int_equal(scene->primitives[1].caustics, CAUSTICS_REFRACT);
    assert_int_equal(scene->primitives[2].caustics, 0);
    scene_close(&scene);
    snprintf(text, sizeof text, TEXT, "");
    scene = parse(text);
    assert_int_equal(scene_caustic_sources(scene), 0);
    assert_int_equal(scene->primitives[0].caustics, 0);
    scene_close(&scene);
    expect_error(V37 "light_source{y, 1 retex{radius 0}}", "above 0");
}

static void test_names_of_insides(void **state)
{
    (void)state;
    /* a texture that is used inside only can be a target too */
    Scene *scene =
        parse(V37 "#declare Lining = texture{pigment{rgb 1}} sphere{0,1 pigment{rgb 0} interior_texture{Lining}}");
    const char *specs[] = {"Lining"};
    assert_int_equal(scene->primitives[0].interior_target, -1); /* before any is asked for */
    assert_int_equal(scene_resolve_targets(scene, specs, 1, NULL), 0);
    assert_int_equal(scene->primitives[0].interior_target, 0);
    assert_int_equal(scene->primitives[0].target, -1);
    scene_close(&scene);
}

static void test_sky(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sky_sphere{pigment{gradient 3*y color_map{[0 rgb 1][1 rgb <0,0,1>]}} pigment{rgbt 1}"
                             " rotate 90*z emission .5}");
    assert_int_equal(scene->sky->npigments, 2);
    assert_near(scene->sky->emission.r, 0.5);
    assert_color(pigment_eval(scene->sky->pigments[0], vec3(-0.5, 0, 0), (Vec2){0, 0}), 0.5, 0.5, 1);
    scene_close(&scene);
    /* A pigment lets through what lies behind it, its filter in its own colour. */
    scene =
        parse(V37 "background{rgb <1,.5,.25>} sky_sphere{pigment{rgb .5} pigment{rgbft <.2,.4,.8,.5,.3>} emission 2}");
    Rgb seen = sky_radiance(scene, vec3(0, 1, 0), 1);
    assert_near(seen.r, (0.5 * 0.2 + 0.3) * 0.5 * 2 + 0.2 * 0.2 * 2);
    assert_near(seen.g, (0.5 * 0.4 + 0.3) * 0.5 * 2 + 0.2 * 0.4 * 2);
    assert_near(seen.b, (0.5 * 0.8 + 0.3) * 0.5 * 2 + 0.2 * 0.8 * 2);
    scene_close(&scene);
    /* In older scenes filter tints nothing; the version at the scene's end counts. POV-Ray shows .3501, .5, .75. */
    scene = parse("#version 3.7; global_settings{assumed_gamma 1}"
                  "sky_sphere{pigment{rgb <.2,.4,.8>} pigment{rgbf <.5,.6,.7,.5>}} #version 3.6;");
    seen = sky_radiance(scene, vec3(0, 1, 0), 1);
    assert_near(seen.r, 0.35);
    assert_near(seen.g, 0.5);
    assert_near(seen.b, 0.75);
    scene_close(&scene);
}

/* The background lights surfaces beside radiosity, finishes of retex's own, or where there is no light source. */
static void test_background_light(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int only_seen;
    } cases[] = {
        {V37 "sphere{0,1}", 0},
        {V37 "light_source{0, rgb 1} sphere{0,1}", 1},
        {V37 "light_source{0, rgb 0} sphere{0,1}", 0},
        {V37 "global_settings{radiosity{}} light_source{0, rgb 1} sphere{0,1}", 0},
        {V37 "light_source{0, rgb 1} sphere{0,1 finish{retex{roughness .5}}}", 0},
        {"light_source{0, rgb 1} sphere{0,1}", 1},
        {"global_settings{radiosity{}} light_source{0, rgb 1} sphere{0,1}", 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, "%s background{rgb <1,0,0>}", cases[k].text);
        Scene *scene = parse(text);
        assert_int_equal(scene->background_only_seen, cases[k].only_seen);
        assert_near(sky_radiance(scene, vec3(0, 1, 0), 1).r, 1);
        assert_near(sky_radiance(scene, vec3(0, 1, 0), 0).r, !cases[k].only_seen);
        scene_close(&scene);
    }
}

static void test_negative_light(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "light_source{0, rgb <1,-.1,0>} light_source{0, 1}");
    assert_null(strstr(messages, "negative"));
    scene_close(&scene);
    scene = parse(V37 "light_source{0, 1} light_source{y, rgb -.9 spotlight}");
    assert_non_null(strstr(messages, "`light_source of negative colour` is not supported yet: it takes no light away"));
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
    /* a name is another one than its beginning */
    scene = parse(V37 "#declare Tile = texture{pigment{rgb 1}} #declare Tiles = texture{pigment{rgb .5}}"
                      "sphere{0,1 texture{Tile}} sphere{3,1 texture{Tiles}}");
    const char *tiles[] = {"Tiles", "Tile"};
    assert_int_equal(scene_resolve_targets(scene, tiles, 2, &err), 0);
    assert_int_equal(scene->primitives[0].target, 1);
    assert_int_equal(scene->primitives[1].target, 0);
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
        {{"a:b=Floor"}, 1, RETEX_EINVAL, "letters"},
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

/* Lights above 1 are not decoded further: 4 of the display's space would be 24. */
static void test_bright_lights_of_old_scenes(void **state)
{
    (void)state;
    Scene *scene = parse("#version 3.5; light_source{0 rgb <4,1,.5>} sphere{0,1}");
    assert_near(scene->lights[0].color.r, 4);
    assert_near(scene->lights[0].color.g, 1);
    assert_near(scene->lights[0].color.b, pow((.5 + .055) / 1.055, 2.4));
    scene_close(&scene);
    scene = parse("#version 3.5; global_settings{assumed_gamma 2} light_source{0 rgb <4,1,.5>} sphere{0,1}");
    assert_near(scene->lights[0].color.r, 4);
    assert_near(scene->lights[0].color.b, .25);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_bright_lights_of_old_scenes),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_light_kinds_written_twice),
        cmocka_unit_test(test_lamps),
        cmocka_unit_test(test_lamp_colors),
        cmocka_unit_test(test_each_lamp),
        cmocka_unit_test(test_lamps_refused),
        cmocka_unit_test(test_photons),
        cmocka_unit_test(test_names_of_insides),
        cmocka_unit_test(test_sky),
        cmocka_unit_test(test_sky_colors),
        cmocka_unit_test(test_background_light),
        cmocka_unit_test(test_negative_light),
        cmocka_unit_test(test_targets),
        cmocka_unit_test(test_target_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
