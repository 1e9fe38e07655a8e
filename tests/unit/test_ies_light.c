/* Light distributions in pictures: a plane against the cosine law, many lights, caustics and photons, and smoke. */
#include "lib_folder.h"
#include "lib_identity.h"
#include "lib_ies.h"

#include <math.h>
#include <stdio.h>

#include "accel/accel.h"
#include "light/lights.h"
#include "light/source.h"
#include "path/photons.h"
#include "path/sampler.h"

#define HEAD "#version 3.7; global_settings { assumed_gamma 1 photons { count 1 } }\n"

static const TestAngles DEGREES = {0, 90, 361}, ONE = {0, 0, 1};

static double cosine_of(double v)
{
    return fmax(0, cos(v * PI / 180));
}

static double cosine(double v, double h)
{
    (void)h;
    return 700 * cosine_of(v);
}

static double cosine_4(double v, double h)
{
    (void)h;
    return 0.1 * pow(cosine_of(v), 4);
}

static double upwards(double v, double h)
{
    (void)h;
    return v > 90 ? 1 : 0;
}

static double to_x(double v, double h)
{
    (void)v;
    return h < 90 || h > 270 ? 1 : 0;
}

/* ---- a plane ---- */

/* An orthographic camera looks at spots of the floor: radiance is albedo c cos(v)^(n + 1), times 2 / (1 + d^2). Where
 * the luminaire is tilted the angle to its axis is another one. */
static void floor_has_cosine_law(void **state)
{
    static const struct {
        TestIntensity *intensity;
        double power;
        const char *more;
        Vec3 axis;
    } cases[] = {{cosine, 1, "", {0, -1, 0}},
                 {cosine_4, 4, "", {0, -1, 0}},
                 {cosine_4, 4, "point_at <1,1,2>", {0.5773502692, -0.5773502692, 0.5773502692}},
                 {cosine_4, 4, "area_light .01*x, .01*z, 2, 2", {0, -1, 0}}};
    const Vec3 lamp = {0, 2, 1};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *path = test_ies("floor.ies", DEGREES, ONE, cases[k].intensity);
        for (double x = 0; x < 4; x += 0.75) {
            char text[1024];
            double mean[3];
            snprintf(text, sizeof text,
                     HEAD "camera { orthographic location <%g,1,0> direction -y right .001*x up .001*z }\n"
                          "light_source { <0,2,1>, rgb <3,2,1> retex { ies \"%s\" } %s fade_distance 1 fade_power 2 }\n"
                          "plane { y, 0 pigment { rgb .5 } finish { ambient 0 diffuse 1 } }",
                     x, path, cases[k].more);
            RetexSet *set = render_text(text, 4, 4, 4, 1, 2);
            mean_color(set, mean);
            retex_set_close(&set);
            const Vec3 d = vec_sub(vec3(x, 0, 0), lamp);
            const double distance = vec_length(d), along = vec_dot(d, cases[k].axis) / distance;
            const double wanted = 0.5 * 2 / (1 + distance * distance) * -d.y / distance * pow(along, cases[k].power);
            for (int c = 0; c < 3; c++)
                if (!(fabs(mean[c] - (3 - c) * wanted) < 1e-3 * wanted))
                    fail_msg("case %zu, x %g, channel %d: %.6f, not %.6f", k, x, c, mean[c], (3 - c) * wanted);
        }
    }
}

/* ---- many lights ---- */

/* Irradiance of all lights at points in all directions, as it is sampled by estimates of many, and as it is. */
static void many_lights_are_found(void **state)
{
    enum { SAMPLES = 1 << 14, LIGHTS = 12 };
    TestIntensity *const intensities[] = {cosine_4, upwards, to_x};
    const TestAngles all = {0, 180, 181}, round = {0, 360, 73};
    (void)state;
    for (int f = 0; f < 3; f++) {
        char text[1024];
        Lights *lights;
        snprintf(text, sizeof text,
                 HEAD "#for (I, 1, %d) light_source { <I,3,mod(I,3)>, 1 + I/5 retex { ies \"%s\" } rotate 40*z }"
                      " #end sphere { 0, .1 }",
                 LIGHTS, test_ies("many.ies", all, round, intensities[f]));
        Scene *scene = test_scene(text);
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        assert_int_equal(scene->nlights, LIGHTS);
        for (int k = 0; k < 8; k++) {
            const LightSampleContext p = {.position = vec3(k & 1 ? 9 : -9, k & 2 ? 15 : -3, k & 4 ? 8 : -8)};
            double wanted = 0, sum = 0, distance;
            Vec3 direction;
            for (int i = 0; i < LIGHTS; i++) {
                const Light *light = &scene->lights[i];
                wanted += (double)source_irradiance(light, p.position, light->location, &direction, &distance).r;
            }
            for (int i = 0; i < SAMPLES; i++) {
                LightSample s;
                const LightPick pick = lights_pick(lights, &p, (float)((i + 0.5) / SAMPLES), 0.5f);
                if (lights_sample(lights, &p, &pick, 0.5f, 0.5f, &s))
                    sum += (double)(s.radiance.r / s.pick_probability) / SAMPLES;
            }
            if (!(fabs(sum - wanted) < 0.01 * wanted + 1e-6))
                fail_msg("distribution %d, point %d: %.5f, not %.5f", f, k, sum, wanted);
        }
        lights_close(&lights);
        scene_close(&scene);
    }
}

/* What the tree cannot see from below is left to other lights. */
static void dark_sides_get_no_samples(void **state)
{
    Lights *lights;
    char text[1024];
    int dark = 0;
    (void)state;
    snprintf(text, sizeof text,
             HEAD "#for (I, 1, 20) light_source { <I,3,0>, 1 fade_distance 1 fade_power 2"
                  " #if (mod(I, 2)) retex { ies \"%s\" } #end } #end sphere { 0, .1 }",
             test_ies("up.ies", (TestAngles){90, 180, 10}, ONE, upwards));
    Scene *scene = test_scene(text);
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (int i = 0; i < 1000; i++) {
        LightSample s;
        const LightSampleContext p = {.position = vec3(10, -3, 0)};
        const LightPick pick = lights_pick(lights, &p, ((float)i + 0.5f) / 1000, 0.5f);
        dark += !lights_sample(lights, &p, &pick, 0.5f, 0.5f, &s);
    }
    if (dark > 50)
        fail_msg("%d of 1000 samples are of lights that shine upwards", dark);
    lights_close(&lights);
    scene_close(&scene);
}

/* ---- caustics ---- */

/* Rays over a cone about a light source that paths may meet find what it gives as a point. */
static void met_lights_give_their_irradiance(void **state)
{
    enum { N = 600 };
    static const char *const more[] = {"retex { radius .3 }", "area_light .3*x, .2*z, 5, 5",
                                       "spotlight radius 50 falloff 70 point_at 0 retex { radius .2 }"};
    const Vec3 at = vec3(1.5, 0, -0.5);
    (void)state;
    for (int k = 0; k < 3; k++) {
        char text[1024];
        double distance, sum = 0;
        Vec3 axis, s, t;
        const double less = 0.06, v = atan2(sqrt(2.5), 4); /* 1 - cos of the cone; angle to the axis */
        snprintf(text, sizeof text,
                 HEAD "light_source { 4*y, 1 retex { ies \"%s\" } %s }\n"
                      "sphere { 2*y, .1 interior { ior 1.5 } photons { target refraction on } }",
                 test_ies("met.ies", DEGREES, ONE, cosine_4), more[k]);
        Scene *scene = test_scene(text);
        const Light *light = &scene->lights[0];
        const double wanted = (double)source_irradiance(light, at, light->location, &axis, &distance).r;
        assert_true(fabs(wanted - PI * pow(cos(v), 4)) < 1e-3 * wanted);
        vec_frame(axis, &s, &t);
        for (int i = 0; i < N * N; i++) {
            const double down = less * (i % N + 0.5) / N, side = sqrt(down * (2 - down)),
                         turn = (i / N + 0.5) / N * 2 * PI;
            const Vec3 d = vec_mad(vec_mad(vec_scale(axis, 1 - down), s, side * cos(turn)), t, side * sin(turn));
            const Ray ray = {at, d, 0, INFINITY};
            LightSample met;
            if (source_meet(light, &ray, &met))
                sum += (double)met.radiance.r * (1 - down) * 2 * PI * less / N / N;
        }
        if (!(fabs(sum - wanted) < 0.02 * wanted))
            fail_msg("%s: %.5f, not %.5f", more[k], sum, wanted);
        scene_close(&scene);
    }
}

/* Of the size of a side, and what photons are told of it. */
#define SHEET                                                                                                          \
    "box { <-%d,3,-%d>, <%d,3.01,%d> pigment { rgbt 1 } finish { diffuse 0 } interior { ior 1.3 } no_image %s }\n"

/* A thin sheet of glass takes none of the light away, nor moves it: what is refracted is what goes straight. Its edges
 * are far away, for they mirror. */
static void sheets_keep_the_pattern(void **state)
{
    double means[2][3];
    (void)state;
    for (double x = -1; x < 2; x += 2) /* the distribution has light on the side of x */
        for (int k = 0; k < 2; k++) {
            char text[1024];
            snprintf(
                text, sizeof text,
                HEAD
                "camera { orthographic location <%g,1,.5> direction -y right .2*x up .2*z }\n"
                "light_source { 5*y, 12.5e6 fade_distance 1e-3 fade_power 2 retex { ies \"%s\" radius .3 } }\n" SHEET
                "plane { y, 0 pigment { rgb .5 } finish { ambient 0 diffuse 1 } }",
                x, test_ies("sheet.ies", DEGREES, (TestAngles){0, 360, 73}, to_x), 30, 30, 30, 30,
                k ? "photons { target refraction on }" : "");
            RetexSet *set = render_text(text, 8, 8, k ? 2048 : 4, 1, 6);
            mean_color(set, means[k]);
            retex_set_close(&set);
            const double c = 5 / sqrt(x * x + 0.25 + 25), wanted = x > 0 ? 0.5 * pow(c, 3) : 0;
            if (!(fabs(means[k][0] - wanted) <= (k ? 0.02 : 0.002) * wanted))
                fail_msg("x %g, %s: %.5f, not %.5f", x, k ? "refracted" : "straight", means[k][0], wanted);
        }
}

/* The power of photons that land, of a scene with a sheet above the floor. */
static double landed(const char *light)
{
    char text[1024];
    Accel *accel;
    Lights *lights;
    Photons photons;
    double sum = 0;
    snprintf(text, sizeof text, HEAD "%s\n" SHEET "plane { y, 0 pigment { rgb .5 } }", light, 3, 3, 3, 3,
             "photons { target refraction on }");
    Scene *scene = test_scene(text);
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    const PhotonSources sources = {.scene = scene, .accel = accel, .lights = lights, .paths = 1};
    assert_int_equal(photons_trace(&photons, &sources, 1, NULL), 0);
    for (int i = 0; i < photons.count; i++)
        sum += (double)photons.landings[i].power;
    free(photons.landings);
    lights_close(&lights);
    accel_close(&accel);
    scene_close(&scene);
    return sum;
}

/* Photons carry what falls on the sheet: as much less as the sum of cos^4 over its top says. */
static void photons_carry_the_pattern(void **state)
{
    enum { N = 400 };
    char light[512];
    double all = 0, part = 0;
    (void)state;
    for (int i = 0; i < N * N; i++) {
        const double x = ((i % N) + 0.5) * 6 / N - 3, z = ((i / N) + 0.5) * 6 / N - 3, c = 2 / sqrt(4 + x * x + z * z);
        all += c, part += c * pow(c, 4);
    }
    snprintf(light, sizeof light, "light_source { 5*y, 1 retex { ies \"%s\" } }",
             test_ies("photons.ies", DEGREES, ONE, cosine_4));
    const double without = landed("light_source { 5*y, 1 }"), with = landed(light);
    if (!(fabs(with / without - part / all) < 0.015 * part / all))
        fail_msg("photons carry %.4f of the light, not %.4f", with / without, part / all);
    /* the middle of the sheet is dark, all of x below 0 is too: half of the light is on the other side */
    snprintf(light, sizeof light, "light_source { <-.5,5,0>, 1 retex { ies \"%s\" turn 180 } }",
             test_ies("photons.ies", DEGREES, (TestAngles){0, 360, 73}, to_x));
    assert_true(landed(light) > 0.1 * without);
}

/* ---- smoke ---- */

/* Thin smoke seen directly shines by the share of its direction. */
static void smoke_has_the_pattern(void **state)
{
    static const char *const media[] = {"scattering { 1, .05 }",
                                        "scattering { 1, .05 } density { spherical scale .2 }"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        double means[2][3];
        for (int with = 0; with < 2; with++) {
            char text[1024], ies[256] = "";
            if (with)
                snprintf(ies, sizeof ies, "retex { ies \"%s\" }", test_ies("smoke.ies", DEGREES, ONE, cosine_4));
            snprintf(text, sizeof text,
                     HEAD "camera { location 0 look_at z angle .01 } light_source { <0,2,7>, 1 %s }\n"
                          "sphere { 0, .2 pigment { rgbt 1 } hollow interior { media { %s } } translate 8*z }",
                     ies, media[k]);
            RetexSet *set = render_text(text, 8, 8, 512, 1, 2);
            mean_color(set, means[with]);
            retex_set_close(&set);
        }
        const double wanted = pow(2 / sqrt(5), 4), found = means[1][0] / means[0][0];
        if (!(fabs(found - wanted) < 0.015 * wanted))
            fail_msg("smoke %d has %.4f of the light, not %.4f", k, found, wanted);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floor_has_cosine_law),      cmocka_unit_test(many_lights_are_found),
        cmocka_unit_test(dark_sides_get_no_samples), cmocka_unit_test(met_lights_give_their_irradiance),
        cmocka_unit_test(sheets_keep_the_pattern),   cmocka_unit_test(photons_carry_the_pattern),
        cmocka_unit_test(smoke_has_the_pattern),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
