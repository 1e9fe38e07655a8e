/* The table of the sky: densities are those of the sky's luminance, for skies that are level and for others. */
#include <stdio.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include "light/environment.h"

/* As it is written, or turned by next to nothing, so that no row is taken as level. */
static SkyTable *sky(Scene **scene, const char *pigment, const char *turn)
{
    char text[1024];
    SkyTable *environment;
    RetexError err = {0};

    snprintf(text, sizeof text, V37 "sky_sphere{pigment{%s color_map{[0 rgb <.1,.2,.4>] [.6 rgb 1] [1 rgb 2]} %s}}",
             pigment, turn);
    *scene = parse(text);
    test_must(sky_table_of(&environment, *scene, &err), &err);
    return environment;
}

static void densities_are_those_of_luminance(void **unused)
{
    static const char *const pigments[] = {"gradient y",
                                           "gradient y scale 3 translate -1.2*y",
                                           "gradient x",
                                           "gradient y rotate 30*x",
                                           "gradient y turbulence .3",
                                           "bozo scale .4"};
    uint32_t state = 3;

    (void)unused;
    for (size_t i = 0; i < sizeof pigments / sizeof *pigments; i++) {
        Scene *scenes[2];
        SkyTable *written = sky(&scenes[0], pigments[i], ""),
                    *turned = sky(&scenes[1], pigments[i], "rotate <1e-290,0,1e-290>");
        const double mean = sky_table_mean(written);
        int far = 0, other = 0;
        for (int k = 0; k < 4000; k++) {
            const double y = 2 * test_random(&state) - 1, phi = 2 * PI * test_random(&state), rho = sqrt(1 - y * y);
            const Vec3 d = {rho * cos(phi), y, rho * sin(phi)};
            const double of_sky = rgb_luminance(sky_radiance(scenes[0], d, 0)) / (4 * PI * mean);
            other += fabs(sky_table_pdf(written, d) - sky_table_pdf(turned, d)) > 0.02 * sky_table_pdf(turned, d);
            far += fabs(sky_table_pdf(written, d) - of_sky) > 0.05 * of_sky;
        }
        assert_true(far < 80 && other < 80);
        sky_table_close(&written);
        sky_table_close(&turned);
        scene_close(&scenes[0]);
        scene_close(&scenes[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities_are_those_of_luminance),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
