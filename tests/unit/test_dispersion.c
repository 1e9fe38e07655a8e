/* Dispersion against POV-Ray's spectrum and against Snell's law, a furnace, and the identity of retexturing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include "lib_identity.h"
#include "shade/dispersion.h"

#define HEAD "#version 3.7; global_settings { assumed_gamma 1 }\n"
#define CLEAR "pigment { rgbt 1 } finish { ambient 0 diffuse 0 } "
#define GLASS "pigment { rgbt 1 } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel } } "

static void expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f within %g", what, value, wanted, tolerance);
}

/* Colours of stripes in POV-Ray 3.7's picture of a white line behind a prism of clear glass, dispersion 1.3 and
 * dispersion_samples 100, times 100; of stripe k, from the red end. */
static void spectrum_is_that_of_povray(void **state)
{
    static const struct {
        int stripe;
        double color[3];
    } seen[] = {{0, {.6860, 0, 0}},        {10, {2.3652, 0, 0}},     {20, {3.0039, .9800, 0}},
                {30, {2.5820, 2.3594, 0}}, {42, {.7808, 2.8828, 0}}, {52, {0, 2.4102, 1.0381}},
                {62, {0, 1.0908, 2.1992}}, {75, {0, 0, 2.6816}},     {90, {.3081, 0, 1.7500}},
                {99, {.1400, 0, .5249}}};
    (void)state;
    for (size_t k = 0; k < sizeof seen / sizeof *seen; k++) {
        const Rgb c = dispersion_color((seen[k].stripe + 0.5) / 100);
        expect(c.r, seen[k].color[0], 0.08, "red");
        expect(c.g, seen[k].color[1], 0.08, "green");
        expect(c.b, seen[k].color[2], 0.08, "blue");
    }
}

static void spectrum_is_white(void **state)
{
    enum { COUNT = 100000 };
    double sum[3] = {0};
    (void)state;
    for (int k = 0; k < COUNT; k++) {
        const Rgb c = dispersion_color((k + 0.5) / COUNT);
        sum[0] += (double)c.r / COUNT, sum[1] += (double)c.g / COUNT, sum[2] += (double)c.b / COUNT;
        assert_true(c.r + c.g + c.b > 0.1f); /* no wavelength is black */
    }
    for (int k = 0; k < 3; k++)
        expect(sum[k], 1, 1e-5, "mean");
}

/* Violet over red is the dispersion, and the middle has the ior itself: as where POV-Ray's stripes are. */
static void index_rises_to_violet(void **state)
{
    (void)state;
    expect(dispersion_scale(1.3, 1) / dispersion_scale(1.3, 0), 1.3, 1e-12, "ratio");
    expect(1.5 * dispersion_scale(1.3, 0.005), 1.3174, 3e-4, "red end");
    expect(1.5 * dispersion_scale(1.3, 0.995), 1.7082, 3e-4, "violet end");
    expect(dispersion_scale(1.3, 0.5), 1, 1e-12, "middle");
}

/* A wedge whose first face is met head-on bends light of each wavelength by Snell's law at its second face; the sky is
 * as bright as the direction's sideways part. */
static void prism_follows_snell(void **state)
{
    enum { STEPS = 20000 };
    const double slope = 0.4, dispersion = 1.25, ior = 1.4;
    char text[1024];
    (void)state;
    snprintf(text, sizeof text,
             HEAD "camera { orthographic location <0,0,-3> direction z right x up y }\n"
                  "sky_sphere { pigment { gradient x color_map { [0 rgb 0] [1 rgb 1] } } }\n"
                  "intersection { plane { -z, 0 } plane { <%g, 0, 1>, 1 } " CLEAR "interior { ior %g dispersion %g } }",
             -slope, ior, dispersion);
    double wanted[3] = {0}, mean[3];
    for (int k = 0; k < STEPS; k++) {
        const double t = (k + 0.5) / STEPS, in = atan(slope);
        const double out = asin(ior * pow(dispersion, t - 0.5) * sin(in));
        const Rgb c = dispersion_color(t);
        wanted[0] += (double)c.r * sin(out - in) / STEPS;
        wanted[1] += (double)c.g * sin(out - in) / STEPS;
        wanted[2] += (double)c.b * sin(out - in) / STEPS;
    }
    assert_true(wanted[2] > 1.3 * wanted[0]);
    RetexSet *set = render_text(text, 4, 3, 4096, 1, 16);
    mean_color(set, mean);
    for (int k = 0; k < 3; k++)
        expect(mean[k], wanted[k], 1e-3, "sky behind the prism");
    retex_set_close(&set);
}

/* Parallel light through a slit and the same wedge, on a wall: each wavelength is shifted by Snell's law, and keeps its
 * light. Bounds of the wedge are far from the slit. */
static void caustics_of_a_prism_are_a_spectrum(void **state)
{
    enum { STEPS = 4000, WIDTH = 24 };
    const double slope = 0.4, dispersion = 1.25, ior = 1.4, wall = 6, slit = 0.2, left = 0.4, right = 1.6;
    double wanted[WIDTH][3] = {{0}};
    char text[2048];
    (void)state;
    for (int k = 0; k < STEPS; k++) {
        const double t = (k % 400 + 0.5) / 400, x = ((k / 400 + 0.5) / 10 - 0.5) * slit, in = atan(slope);
        const double out = asin(ior * pow(dispersion, t - 0.5) * sin(in));
        const double z = sqrt(1 + slope * slope) + slope * x, at = x + (wall - z) * tan(out - in);
        const int column = (int)floor((at - left) / (right - left) * WIDTH);
        const Rgb c = dispersion_color(t);
        assert_true(column >= 0 && column < WIDTH);
        const float part = (float)(0.5 * slit / STEPS * WIDTH / (right - left)); /* of light 1 and albedo .5 */
        wanted[column][0] += (double)(c.r * part), wanted[column][1] += (double)(c.g * part),
            wanted[column][2] += (double)(c.b * part);
    }
    snprintf(text, sizeof text,
             "#version 3.7; global_settings { assumed_gamma 1 photons { count 1 } }\n"
             "camera { orthographic location <%g,0,4> direction z right %g*x up .05*y }\n"
             "light_source { -20*z, 1 parallel point_at 0 retex { radius .4 } }\n"
             "#declare Black = texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } }\n"
             "box { <-30,-30,-1>, <%g,30,-.9> texture { Black } } box { <%g,-30,-1>, <30,30,-.9> texture { Black } }\n"
             "plane { -z, -%g pigment { rgb .5 } finish { ambient 0 diffuse 1 } }\n"
             "intersection { plane { -z, 0 } plane { <%g,0,1>, 1 } box { <-.5,-1.5,-.5>, <.5,1.5,2> }\n"
             "  photons { target refraction on } " CLEAR "interior { ior %g dispersion %g } }",
             (left + right) / 2, right - left, -slit / 2, slit / 2, wall, -slope, ior, dispersion);
    RetexSet *set = render_text(text, WIDTH, 2, 16384, 1, 16);
    const RetexImage *image = &set->parts[0].image;
    for (int c = 0; c < 3; c++) {
        double sums[2] = {0}, places[2] = {0}, off = 0;
        for (int x = 0; x < WIDTH; x++) {
            const double got = (double)(image->pixels[retex_image_index(image, x, 0) + (size_t)c] +
                                        image->pixels[retex_image_index(image, x, 1) + (size_t)c]) /
                               2;
            sums[0] += got, places[0] += got * x, sums[1] += wanted[x][c], places[1] += wanted[x][c] * x;
            off += fabs(got - wanted[x][c]);
        }
        expect(sums[0] / sums[1], 1, 0.04, "light on the wall");
        expect(places[0] / sums[0], places[1] / sums[1], 0.1,
               "its place");                                /* of columns, of which red and blue are 8 apart */
        expect(off / sums[1], 0, 0.25, "its distribution"); /* the light source is no point, so lines are blurred */
    }
    retex_set_close(&set);
}

/* An object without an ior has no dispersion, as in POV-Ray. */
static void no_ior_no_dispersion(void **state)
{
    (void)state;
    Scene *scene =
        test_scene(HEAD "camera { location -5*z } light_source { -9*z, 1 } sphere { 0, 1 " CLEAR
                        "interior { dispersion 1.2 } } sphere { 0, 1 " CLEAR "interior { ior 1 dispersion 1.2 } }");
    assert_false(interior_disperses(scene->primitives[0].interior));
    assert_false(interior_bends(scene->primitives[0].interior));
    assert_true(interior_disperses(scene->primitives[1].interior));
    assert_true(interior_bends(scene->primitives[1].interior));
    scene_close(&scene);
}

/* Clear glass under a white sky is invisible; a camera inside sees the square of the index. */
static void furnace_is_white(void **state)
{
    enum { STEPS = 20000 };
    static const struct {
        const char *camera;
        double ior;
        int is_inside;
    } balls[] = {{"location -5*z look_at 0 angle 30", 1.5, 0},
                 {"location .6*x look_at x angle 100", 1.5, 1},
                 {"location -5*z look_at 0 angle 30", 0.8, 0}};
    char text[1024];
    double mean[3], square[3] = {0};
    (void)state;
    for (int k = 0; k < STEPS; k++) {
        const double t = (k + 0.5) / STEPS, index = 1.5 * pow(1.3, t - 0.5);
        const Rgb c = dispersion_color(t);
        square[0] += (double)c.r * index * index / STEPS;
        square[1] += (double)c.g * index * index / STEPS;
        square[2] += (double)c.b * index * index / STEPS;
    }
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text,
                 HEAD "background { rgb 1 } camera { %s } sphere { 0, 1 " GLASS "interior { ior %g dispersion 1.3 } }",
                 balls[k].camera, balls[k].ior);
        RetexSet *set = render_text(text, 16, 12, 1024, 1, 200);
        mean_color(set, mean);
        for (int c = 0; c < 3; c++)
            expect(mean[c], balls[k].is_inside ? square[c] : 1, 0.004, balls[k].camera);
        retex_set_close(&set);
    }
}

/* A bright wall in rough glass: light samples find what paths find. Planes are not sampled, boxes are. */
static void light_samples_have_the_wavelength(void **state)
{
    static const char *const walls[] = {"plane { -z, -2 clipped_by { box { <.3,-1,1>, <1,1,3> } }",
                                        "box { <.3,-1,2>, <1,1,2.001>"};
    double mean[2][3];
    char text[1024];
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 HEAD "camera { orthographic location <-3,0,-3> look_at 0 right .1*x up .1*y }\n"
                      "plane { -z, 0 pigment { rgbt 1 }\n"
                      "finish { ambient 0 diffuse 0 retex { transmission 1 roughness .6 ior 1.4 } }\n"
                      "interior { ior 1.4 dispersion 1.7 } }\n"
                      "%s pigment { rgb 1 } finish { diffuse 0 ambient 0 emission 1 } }",
                 walls[k]);
        RetexSet *set = render_text(text, 4, 3, 16384, 1, 16);
        mean_color(set, mean[k]);
        retex_set_close(&set);
    }
    assert_true(fabs(mean[0][0] - mean[0][2]) > 0.05);
    for (int c = 0; c < 3; c++)
        expect(mean[1][c], mean[0][c], 0.004, "by light samples");
}

static void sets_recombine(void **state)
{
    static const char *const finishes[] = {
        GLASS, "pigment { rgbt 1 } finish { ambient 0 retex { transmission 1 roughness .3 ior 1.5 } } "};
    char text[1024];
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 HEAD "camera { location <0,1,-4> look_at 0 angle 50 } background { rgb <.6,.7,1> }\n"
                      "light_source { <3,5,-4>, 1 }\n"
                      "#declare Floor = pigment { rgb <.3,.5,.7> }\n"
                      "plane { y, -1 pigment { Floor } }\n"
                      "sphere { 2.5*y, .5 pigment { rgb 1 } finish { ambient 0 emission 8 diffuse 0 } }\n"
                      "sphere { 0, 1 %s interior { ior 1.5 dispersion 1.2 } }",
                 finishes[k]);
        assert_identity(text, "Floor", 32, 7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spectrum_is_that_of_povray),
        cmocka_unit_test(spectrum_is_white),
        cmocka_unit_test(index_rises_to_violet),
        cmocka_unit_test(prism_follows_snell),
        cmocka_unit_test(caustics_of_a_prism_are_a_spectrum),
        cmocka_unit_test(no_ior_no_dispersion),
        cmocka_unit_test(furnace_is_white),
        cmocka_unit_test(light_samples_have_the_wavelength),
        cmocka_unit_test(sets_recombine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
