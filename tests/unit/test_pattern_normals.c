/* Patterns that look at the surface's normal, from outside and from inside, where POV-Ray turns it towards the viewer.
 * The values are POV-Ray 3.7's, in PNG of 16 bits: `povray +W1 +H1 File_Gamma=1 Bits_Per_Color=16`. */
#include "lib_scene_text.h"

#include <stdio.h>

#include <cmocka.h>

#include "render/render.h"

static const struct {
    const char *shape, *pattern, *from;
    double value;
} cases[] = {
    {"sphere{0,3", "slope{<1,2,-1>}", "<.5,.2,-9>", 0.9287},
    {"sphere{0,3", "slope{<1,2,-1>}", "<2.5,1,-1>", 0.2618},
    {"sphere{0,3", "aoi", "<.5,.2,-9>", 0.6067},
    {"sphere{0,3", "aoi", "<2.5,1,-1>", 0.6040},
    {"cylinder{-9*y,9*y,3", "slope{<1,2,-1>}", "<.5,.2,-9>", 0.6830},
    {"cylinder{-9*y,9*y,3", "slope{<1,2,-1>}", "<2.5,1,-1>", 0.4294},
    {"cylinder{-9*y,9*y,3", "aoi", "<2.5,1,-1>", 0.6599},
    {"box{-3,<4,3,2>", "slope{<1,2,-1>}", "<.5,.2,-9>", 0.6339},
    {"box{-3,<4,3,2>", "slope{<1,2,-1>}", "<2.5,1,-1>", 0.6339},
    {"box{-3,<4,3,2>", "aoi", "<2.5,1,-1>", 0.9132},
    {"torus{3,2", "slope{<1,2,-1>}", "<.5,.2,-9>", 0.8718},
    {"torus{3,2", "slope{<1,2,-1>}", "<2.5,1,-1>", 0.2172},
    {"torus{3,2", "aoi", "<.5,.2,-9>", 0.6648},
    {"torus{3,2", "aoi", "<2.5,1,-1>", 0.6640},
};

static void povray_values(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1024];
        RenderParams params = RENDER_PARAMS_INIT;
        RenderStats stats = {0};
        RetexError err = {0};
        RetexSet *set = NULL;
        snprintf(text, sizeof text,
                 V37 "camera{orthographic location %s right x*.002 up y*.002 look_at %s+<.1,.2,.8>}"
                     "%s pigment{%s color_map{[0 rgb 0][1 rgb 1]}} finish{ambient 0 diffuse 0 emission 1}}",
                 cases[k].from, cases[k].from, cases[k].shape, cases[k].pattern);
        Scene *scene = parse(text);
        params.width = params.height = 1, params.spp = 4, params.nthreads = 1, params.plain = 1;
        test_must(render_scene(&set, scene, &params, &stats, &err), &err);
        assert_float_equal((double)set->parts[0].image.pixels[0], cases[k].value, 1e-3);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(povray_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
