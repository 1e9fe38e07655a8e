/* Layers and maps of textures against POV-Ray's pictures in tests/data/layers.txt (tests/lib/povray_layers.py), in
 * several working spaces; and where a target is among them. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib_scene_text.h"
#include "path/leaves.h"
#include "path/shading.h"

static Scene *plane(const char *head, const char *texture)
{
    char text[2048];
    snprintf(text, sizeof text, "%s plane { z, 0 %s }", head, texture);
    return parse(text);
}

static void add_seen(void *context, const SeenLeaf *seen)
{
    Rgb *sum = context;
    *sum = rgb_add(*sum, rgb_scale(seen->albedo, seen->share));
}

static Rgb albedo(const Scene *scene, double x, double y)
{
    const Ray ray = {vec3(x, y, -5), {0, 0, 1}, 0, INFINITY};
    const Hit hit = {.t = 5, .primitive = 0};
    Rgb sum = {0, 0, 0};
    shading_each_leaf(scene, NULL, &ray, &hit, add_seen, &sum);
    return sum;
}

static double difference(Rgb a, Rgb b)
{
    return fmax(fmax(fabs(a.r - b.r), fabs(a.g - b.g)), fabs(a.b - b.b));
}

static void layers_are_povray(void **state)
{
    (void)state;
    FILE *file = fopen("tests/data/layers.txt", "r");
    char line[1024], head[1024] = "", folder[1024];
    Scene *scene = NULL;
    int failed = 0, count = 0;
    assert_non_null(file);
    assert_non_null(getcwd(folder, sizeof folder));
    assert_int_equal(chdir("tests/data"), 0); /* images are there */
    while (fgets(line, sizeof line, file)) {
        double x, y;
        Rgb c;
        line[strcspn(line, "\n")] = 0;
        if (strncmp(line, "scene ", 6) == 0) {
            snprintf(head, sizeof head, "%s", line + 6);
        } else if (strncmp(line, "texture ", 8) == 0) {
            if (scene)
                scene_close(&scene);
            scene = plane(head, line + 8);
        } else {
            assert_int_equal(sscanf(line, "at %lf %lf %f %f %f", &x, &y, &c.r, &c.g, &c.b), 5);
            const Rgb ours = albedo(scene, x, y);
            count++;
            if (difference(ours, c) > 5e-4) {
                print_error("%s: %s: %.5f %.5f %.5f\n", head, line, ours.r, ours.g, ours.b);
                failed++;
            }
        }
    }
    scene_close(&scene);
    fclose(file);
    assert_int_equal(chdir(folder), 0);
    assert_true(count > 100);
    assert_int_equal(failed, 0);
}

/* ---- with targets: gamma 2, so that a number of the working space is the root of its light ---- */

#define HEAD                                                                                                           \
    "#version 3.7; global_settings { assumed_gamma 2 } #declare T = texture { pigment { rgb <.9,.4,.1> } }"            \
    "#declare F = texture { pigment { rgbf <.9,.4,.1,.6> } }"
#define BLUE "texture { pigment { rgbt <.1,.3,.8,.6> } } "
#define GREEN "texture { pigment { rgbt <.2,.9,.3,.5> } } "
#define GREY "texture { pigment { rgb .5 } } "

static void expect_albedo(const char *texture, const char *target, double r, double g, double b)
{
    Scene *scene = plane(HEAD, texture);
    assert_int_equal(scene_resolve_targets(scene, &target, 1, NULL), 0);
    const Rgb c = albedo(scene, 0, 0);
    scene_close(&scene);
    assert_near(c.r, r);
    assert_near(c.g, g);
    assert_near(c.b, b);
}

/* What weight shows of two colours that blend as numbers of the working space, of which the first has the share t. */
static double blended(double weight, double t, double a, double b)
{
    return weight * pow(t * a + (1 - t) * b, 2);
}

static void targets_count_by_geometry(void **state)
{
    (void)state;
    /* a target below one layer, and below two that blend with each other */
    expect_albedo("texture { T } " BLUE, "T", .4 * .01 + .6 * .81, .4 * .09 + .6 * .16, .4 * .64 + .6 * .01);
    expect_albedo("texture { T } " GREEN BLUE, "T", blended(.7, 4. / 7, .1, .2) + .3 * .81,
                  blended(.7, 4. / 7, .3, .9) + .3 * .16, blended(.7, 4. / 7, .8, .3) + .3 * .01);
    /* what is below a target that filters is linear in its albedo, and so are the layers among themselves */
    expect_albedo(GREY BLUE "texture { F }", "F", .81 * (.4 + .6 * (.4 * .01 + .6 * .25)),
                  .16 * (.4 + .6 * (.4 * .09 + .6 * .25)), .01 * (.4 + .6 * (.4 * .64 + .6 * .25)));
    expect_albedo("texture { gradient x texture_map { [0 T] [1 pigment { rgb .5 }] } translate .5*x }", "T",
                  .405 + .125, .08 + .125, .005 + .125);
}

/* Maps of textures are those of their pigments: of the same patterns, which disturb what is in them too. */
static void textures_are_chosen_as_pigments(void **state)
{
    (void)state;
    static const char *const patterns[] = {
        "gradient x",
        "uv_mapping gradient x scale <.23, 1, 1>",
        "uv_mapping gradient y scale .17",
        "marble turbulence .7 scale .4",
        "bozo warp { turbulence <.4, .1, .8> } scale .3",
        "radial frequency 5 rotate 20*z",
        "leopard scale .05 translate .3",
    };
    for (size_t k = 0; k < sizeof patterns / sizeof *patterns; k++)
        for (int way = 0; way < 4; way++) {
            const int is_moved = way & 1, is_nested = way & 2;
            const char *red = is_nested ? "gradient y scale .3 color_map { [.5 rgb <1, 0, 0>] [.5 rgb <0, .5, 0>] }"
                                        : "rgb <1, 0, 0>";
            const char *green = is_nested ? "gradient z scale .2 color_map { [.5 rgb <.7, 0, 0>] [.5 rgb <0, 1, 0>] }"
                                          : "rgb <0, 1, 0>";
            Scene *scenes[2];
            int reds = 0, count = 0;
            for (int i = 0; i < 2; i++) {
                char text[1024];
                snprintf(
                    text, sizeof text,
                    i ? HEAD
                        " sphere { 0, 1 texture { %s texture_map { [.5 pigment { %s }] [.5 pigment { %s }] } %s } }"
                      : HEAD " sphere { 0, 1 pigment { %s pigment_map { [.5 %s] [.5 %s] } %s } }",
                    patterns[k], red, green, is_moved ? "rotate <10, 20, 30> translate .2" : "");
                scenes[i] = parse(text);
            }
            for (double y = -.9; y < .9; y += .07)
                for (double x = -.9; x < .9; x += .07) {
                    if (x * x + y * y > .95)
                        continue;
                    const Ray ray = {vec3(x, y, -5), {0, 0, 1}, 0, INFINITY};
                    const Hit hit = {.t = 5 - sqrt(1 - x * x - y * y), .primitive = 0};
                    Rgb of[2] = {{0, 0, 0}, {0, 0, 0}};
                    for (int i = 0; i < 2; i++)
                        shading_each_leaf(scenes[i], NULL, &ray, &hit, add_seen, &of[i]);
                    if (difference(of[0], of[1]) > 1e-6)
                        fail_msg("%s at %g, %g: %g %g, not %g %g", patterns[k], x, y, of[1].r, of[1].g, of[0].r,
                                 of[0].g);
                    reds += of[0].r > .5f, count++;
                }
            assert_true(reds > count / 20 && reds < count - count / 20);
            scene_close(&scenes[0]);
            scene_close(&scenes[1]);
        }
}

/* A surface that filters, lit from both sides by light of 1: what POV-Ray shows of rgbf <.8,.4,.1,.5> with ambient 1
 * before white is .8798 .4399 .1100 in version 3.6, and .7998 .3999 .1000 in version 3.7. */
static void filters_hide_by_version(void **state)
{
    (void)state;
    static const struct {
        const char *version;
        double red, green, blue;
    } cases[] = {{"3.1", .88, .44, .11}, {"3.6", .88, .44, .11}, {"3.7", .8, .4, .1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Ray ray = {vec3(0, 0, -5), {0, 0, 1}, 0, INFINITY};
        const Hit hit = {.t = 5, .primitive = 0};
        char head[128];
        Shading s;
        snprintf(head, sizeof head, "#version %s; global_settings { assumed_gamma 1 }", cases[k].version);
        Scene *scene = plane(head, "pigment { rgbf <.8,.4,.1,.5> } finish { diffuse 1 }");
        shading_at(&s, scene, NULL, 1, &ray, &hit);
        assert_near(s.albedo.r * s.bsdf.diffuse + split_apply(s.bsdf.passing, s.albedo).r, cases[k].red);
        assert_near(s.albedo.g * s.bsdf.diffuse + split_apply(s.bsdf.passing, s.albedo).g, cases[k].green);
        assert_near(s.albedo.b * s.bsdf.diffuse + split_apply(s.bsdf.passing, s.albedo).b, cases[k].blue);
        scene_close(&scene);
    }
}

/* POV-Ray's slope is of the normal that is turned to whoever looks: its picture has the first colour from below the
 * plane, and the second from above. */
static void slopes_are_turned_to_the_viewer(void **state)
{
    (void)state;
    static const char *const textures[] = {
        "pigment { slope z color_map { [0 rgb <.2,.4,.6>] [1 rgb <.9,.8,.7>] } }",
        "texture { slope z texture_map { [0 pigment { rgb <.2,.4,.6> }] [1 pigment { rgb <.9,.8,.7> }] } }",
    };
    for (int k = 0; k < 2; k++)
        for (int side = -1; side <= 1; side += 2) {
            Scene *scene = plane("#version 3.7; global_settings { assumed_gamma 1 }", textures[k]);
            const Ray ray = {vec3(.3, .4, 5 * side), {0, 0, -side}, 0, INFINITY};
            const Hit hit = {.t = 5, .primitive = 0};
            Rgb sum = {0, 0, 0};
            shading_each_leaf(scene, NULL, &ray, &hit, add_seen, &sum);
            assert_near(sum.r, side < 0 ? .2 : .9);
            assert_near(sum.g, side < 0 ? .4 : .8);
            assert_near(sum.b, side < 0 ? .6 : .7);
            scene_close(&scene);
        }
}

/* What denoising takes a surface for: what reflects or lets light through clearly is a mirror. */
static void roughness_is_that_of_the_sharpest_lobe(void **state)
{
    (void)state;
    static const struct {
        const char *texture;
        double least, most;
    } cases[] = {{"pigment { rgb 1 }", 1, 1},
                 {"pigment { rgb 1 } finish { reflection .1 }", 0, 0},
                 {"pigment { rgb 1 } finish { reflection { 0, .1 } }", 0, 0},
                 {"pigment { rgbf <.5,.5,.5,.2> }", 0, 0},
                 {"pigment { rgbt <.5,.5,.5,.2> }", 0, 0},
                 {"pigment { rgb 1 } finish { diffuse .5 phong .3 phong_size 40 }", .2, .6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Ray ray = {vec3(0, 0, -5), {0, 0, 1}, 0, INFINITY};
        const Hit hit = {.t = 5, .primitive = 0};
        Shading s;
        Scene *scene = plane("#version 3.7; global_settings { assumed_gamma 1 }", cases[k].texture);
        shading_at(&s, scene, NULL, 1, &ray, &hit);
        const double roughness = (double)shading_roughness(&s);
        if (!(roughness >= cases[k].least && roughness <= cases[k].most))
            fail_msg("%s: %g", cases[k].texture, roughness);
        scene_close(&scene);
    }
}

static void add_share(void *context, const SeenLeaf *seen)
{
    double *sum = context;
    *sum += (double)seen->share;
}

/* A filter beyond all numbers hides everything and shows nothing; still there is a leaf. */
static void infinite_filters_are_black(void **state)
{
    (void)state;
    const Ray ray = {vec3(0, 0, -5), {0, 0, 1}, 0, INFINITY};
    const Hit hit = {.t = 5, .primitive = 0};
    Scene *scene = plane("#version 3.7; global_settings { assumed_gamma 1 }",
                         "texture { pigment { rgb .5 } } texture { pigment { rgbf <1,1,1,1e308> } }");
    Surface surface;
    Leaves leaves;
    memset(&leaves, 0xff, sizeof leaves);
    surface_at(&surface, scene, &ray, &hit);
    leaves_at(&leaves, &surface, vec3(0, 0, -1), 1);
    float weight;
    const Leaf *leaf = leaves_choose(&leaves, 0.5, &weight);
    assert_int_equal(leaves.count, 1);
    assert_true(leaf->texture && leaf->target == -1 && leaf->above == -1 && weight == 0);
    double sum = 0; /* it is all of the surface */
    shading_each_leaf(scene, NULL, &ray, &hit, add_share, &sum);
    assert_near(sum, 1);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_povray),
        cmocka_unit_test(targets_count_by_geometry),
        cmocka_unit_test(textures_are_chosen_as_pigments),
        cmocka_unit_test(filters_hide_by_version),
        cmocka_unit_test(slopes_are_turned_to_the_viewer),
        cmocka_unit_test(roughness_is_that_of_the_sharpest_lobe),
        cmocka_unit_test(infinite_filters_are_black),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
