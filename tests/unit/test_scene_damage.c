/* Broken scenes end with one clear error. */
#include "lib_scene_text.h"

#include <string.h>

#include <cmocka.h>

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
        cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_damaged),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
