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
    test_must(sky_table_of(&environment, *scene, 0, &err), &err);
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

typedef struct Sun {
    double theta, phi, size; /* size: cosine of its radius */
    Vec3 direction;
} Sun;

#define CELL (PI / SKY_TABLE_HEIGHT)

/* A sun of a hundredth of a cell, at the point of that cell that is looked at. */
static Sun sun_in(int x, int y)
{
    const int at = (x + 2 * y) & 3;
    const double theta = PI * (y + 0.25 + 0.5 * (at >> 1)) / SKY_TABLE_HEIGHT,
                 phi = 2 * PI * (x + 0.25 + 0.5 * (at & 1)) / SKY_TABLE_WIDTH;
    return (Sun){theta,
                 phi,
                 1 - 0.01 * sin(theta) * CELL * CELL / (2 * PI),
                 {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)}};
}

/* A sun of a hundredth of a cell in clouds, at the point of a cell that is looked at. The table must not pass over it,
 * wherever it is in what is looked at together; and the cells about it, which its edge may reach, are sampled too. */
static void small_suns_are_found(void **unused)
{
    (void)unused;
    for (int n = 0; n < 16; n++) {
        const Sun sun = sun_in(333 + n % 4, 150 + n / 4);
        char text[1024];
        SkyTable *table;
        RetexError err = {0};
        snprintf(text, sizeof text,
                 V37 "sky_sphere{pigment{bozo scale .4 color_map{[0 rgb .4][1 rgb 1]}} pigment{gradient y"
                     " color_map{[%.15f rgbt 1][%.15f rgb 1e6]} scale 2 translate -y rotate %.15f*z rotate %.15f*y}}",
                 (sun.size + 1) / 2, (sun.size + 1) / 2, -sun.theta * 180 / PI, -sun.phi * 180 / PI);
        Scene *scene = parse(text);
        assert_true(sky_radiance(scene, sun.direction, 0).r > 9e5f);
        test_must(sky_table_of(&table, scene, 0, &err), &err);
        const double there = (double)sky_table_pdf(table, sun.direction),
                     wanted = 1e6 / (4 * PI * (double)sky_table_mean(table));
        assert_true(fabs(there / wanted - 1) < 1e-3);
        for (int k = 0; k < 9; k++) {
            const double t = sun.theta + (k / 3 - 1) * CELL, p = sun.phi + (k % 3 - 1) * CELL;
            const float beside = sky_table_pdf(table, vec3(sin(t) * cos(p), cos(t), sin(t) * sin(p)));
            assert_true(k == 4 || fabs((double)beside / there - 0.125) < 1e-3);
        }
        sky_table_close(&table);
        scene_close(&scene);
    }
}

/* A sun between 24 times the mean, from where on all cells are looked at, and the most that colours of an average with
 * a share below 0 are: as small, and found, whatever makes the mean. */
static void dim_suns_are_found(void **unused)
{
    static const struct {
        const char *rest, *sun;
        double most; /* luminance of the sun */
    } skies[] = {{"pigment{gradient y color_map{[.5 rgb 1][.5 rgb 0]} scale 2 translate -y}", "rgb 14.4", 14.4},
                 {"pigment{gradient y color_map{[.5 rgb 0][.5 rgb 1]} scale 2 translate -y}", "rgb 14.4", 14.4},
                 {"pigment{gradient y pigment_map{[0 average pigment_map{[-1 rgb .3][2 rgb .3]}][1 rgb .3]}}",
                  "average pigment_map{[-1 rgb 0][2 rgb 6]}", 12}};
    (void)unused;
    for (int n = 0; n < 3 * 16; n++) {
        const Sun sun = sun_in(333 + n % 4, 400 + n / 4 % 4 - 300 * (n < 16));
        const double most = skies[n / 16].most;
        char text[1024];
        SkyTable *table;
        RetexError err = {0};
        snprintf(text, sizeof text,
                 V37 "sky_sphere{%s pigment{gradient y pigment_map{[%.15f rgbt 1][%.15f %s]} scale 2 translate -y"
                     " rotate %.15f*z rotate %.15f*y}}",
                 skies[n / 16].rest, (sun.size + 1) / 2, (sun.size + 1) / 2, skies[n / 16].sun, -sun.theta * 180 / PI,
                 -sun.phi * 180 / PI);
        Scene *scene = parse(text);
        assert_true(fabs((double)rgb_luminance(sky_radiance(scene, sun.direction, 0)) - most) < 1e-3 * most);
        test_must(sky_table_of(&table, scene, 0, &err), &err);
        const double there = (double)sky_table_pdf(table, sun.direction),
                     wanted = most / (4 * PI * (double)sky_table_mean(table));
        if (fabs(there / wanted - 1) > 1e-3)
            fail_msg("sun %d: density %g, not %g", n, there, wanted);
        sky_table_close(&table);
        scene_close(&scene);
    }
}

/* Whatever is bright of a sky: all of it, a half of it, and one cell. */
static void skies_shine(void **unused)
{
    static const struct {
        const char *pigment;
        int shines;
    } skies[] = {{"gradient y color_map{[0 rgb 0][1 rgb 1]}", 1},
                 {"gradient y color_map{[.999 rgb 0][.999 rgb 1]}", 1},
                 {"gradient x color_map{[.999 rgb 0][.999 rgb 1]}", 1},
                 {"gradient y color_map{[0 rgb 0][1 rgb 0]}", 0},
                 {"bozo color_map{[0 rgb 0][1 rgb 0]}", 0}};
    (void)unused;
    for (size_t i = 0; i < sizeof skies / sizeof *skies; i++) {
        char text[256];
        snprintf(text, sizeof text, V37 "sky_sphere{pigment{%s}}", skies[i].pigment);
        Scene *scene = parse(text);
        assert_int_equal(sky_shines(scene), skies[i].shines);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities_are_those_of_luminance),
        cmocka_unit_test(small_suns_are_found),
        cmocka_unit_test(dim_suns_are_found),
        cmocka_unit_test(skies_shine),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
