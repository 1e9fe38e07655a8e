/* Pigments that reflect more light than they receive are reported once, where they are written. Emitters are not. */
#include "lib_folder.h"
#include "lib_scene_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void expect(const char *text, const char *said)
{
    Scene *scene = parse(text);
    const char *about = strstr(messages, " warning: ");
    assert_string_equal(about ? about : "", said);
    scene_close(&scene);
}

static void test_pigments(void **state)
{
    (void)state;
    static const char *const fine[] = {
        "sphere{0,1 pigment{rgb 1}}",
        "sphere{0,1 pigment{rgb 1.5}}",                            /* by a diffuse of 0.6 */
        "sphere{0,1 pigment{rgb 50} finish{emission 1}}",          /* shines */
        "sphere{0,1 pigment{rgb 50} finish{ambient 1 diffuse 0}}", /* as lamps are often written */
        "sphere{0,1 pigment{rgb 50} finish{diffuse 0 reflection 1}}",
        "sphere{0,1 pigment{rgbt <2,2,2,1>}}",                       /* nothing comes back */
        "#declare P = pigment{rgb 255}; sphere{0,1 pigment{rgb 1}}", /* used nowhere */
        "sky_sphere{pigment{rgb 20}} background{rgb 9} light_source{0,rgb 7} sphere{0,1 pigment{rgb 1}}",
    };
    char text[400];
    for (size_t i = 0; i < sizeof fine / sizeof *fine; i++) {
        snprintf(text, sizeof text, "%s%s", V37, fine[i]);
        expect(text, "");
    }
    expect(V37 "sphere{0,1 pigment{rgb <255,128,0>}}", " warning: a surface of rgb <255,128,0> gives back more light "
                                                       "than it gets: colours go from 0 to 1, not to 255\n");
    expect(V37 "#declare P = pigment{rgb 2}; sphere{0,1 pigment{P}} sphere{3,1 pigment{P scale 2} finish{diffuse 1}}",
           " warning: a surface of rgb <2,2,2> gives back more light than it gets: colours go from 0 to 1\n");
    expect(V37 "sphere{0,1 pigment{rgb 1.5} finish{retex{metallic 1}}}",
           " warning: a surface of rgb <1.5,1.5,1.5> gives back more light than it gets: colours go from 0 to 1\n");
    expect(V37 "sphere{0,1 pigment{checker rgb 1, rgb 3}}",
           " warning: a surface of rgb <3,3,3> gives back more light than it gets: colours go from 0 to 1\n");
    expect(V37 "sphere{0,1 pigment{gradient y color_map{[0 rgb 0][1 rgb 4]}}}",
           " warning: a surface of rgb <4,4,4> gives back more light than it gets: colours go from 0 to 1\n");
    /* numbers of a display's space, where 1.3 is nearly 2 */
    expect("#version 3.7; global_settings{assumed_gamma 2.2} sphere{0,1 pigment{rgb 1.3}}",
           " warning: a surface of rgb <1.3,1.3,1.3> gives back more light than it gets: colours go from 0 to 1\n");
    Scene *scene = parse(V37 "sphere{0,1\npigment{\nrgb 9}}\n");
    assert_non_null(strstr(messages, ":3: warning: "));
    scene_close(&scene);
}

static const char *write_image(const char *name, float odd)
{
    RetexImage im = {0};
    RetexError err = {0};
    const char *path = test_in_folder(name);
    test_random_image(&im, 8, 6, 3, 1, 0, 1);
    im.pixels[retex_image_index(&im, 3, 2)] = odd;
    im.pixels[retex_image_index(&im, 3, 2) + 1] = odd;
    test_must(retex_image_write(&im, path, NULL, 1, &err), &err);
    retex_image_free(&im);
    return path;
}

static void test_images(void **state)
{
    (void)state;
    char text[600], said[600];
    const char *bright = write_image("bright.exr", 6), *nan = write_image("nan.exr", NAN);
    snprintf(text, sizeof text, V37 "sphere{0,1 pigment{image_map{\"%s\"}}} sphere{3,1 pigment{image_map{\"%s\"}}}",
             bright, bright);
    snprintf(
        said, sizeof said,
        " warning: image_map: %s: 1 texel of 48 brighter than white, up to 6, the first at 3,2: a surface gives back "
        "no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly\n",
        bright);
    expect(text, said);
    snprintf(text, sizeof text, V37 "sphere{0,1 pigment{image_map{\"%s\"}} finish{emission 1}}", bright);
    expect(text, "");
    snprintf(text, sizeof text, V37 "sky_sphere{pigment{image_map{\"%s\"}}} sphere{0,1 pigment{rgb 1}}", bright);
    expect(text, "");
    snprintf(text, sizeof text, V37 "sky_sphere{pigment{image_map{\"%s\"}}} sphere{0,1 pigment{rgb 1}}", nan);
    snprintf(said, sizeof said, " warning: image_map: %s: 1 texel not finite, the first at 3,2: taken as black\n", nan);
    expect(text, said);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pigments), cmocka_unit_test(test_images)};
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
