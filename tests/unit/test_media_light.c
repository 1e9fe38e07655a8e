/* Light in participating media: Beer's law on shadow rays, single scattering against sums over the medium that are
 * written here, a furnace, and the identity of retexturing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include "base/vec.h"
#include "lib_identity.h"

#define HEAD "#version 3.7; global_settings { assumed_gamma 1 }\n"

static void expect_color(const double got[3], const double wanted[3], double tolerance, const char *what)
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(got[c] - wanted[c]) <= tolerance * wanted[c]))
            fail_msg("%s: channel %d is %.6f, should be %.6f within %g", what, c, got[c], wanted[c], tolerance);
}

/* The mean of a small picture. */
static void render_mean(const char *text, int spp, int max_depth, double mean[3])
{
    RetexSet *set = render_text(text, 8, 8, spp, 1, max_depth);
    mean_color(set, mean);
    retex_set_close(&set);
}

/* A slope seen from the front and lit from above, by light that is dimmed on its way as `things` do. */
static void expect_slope(const char *things, const char *light, int spp, const double dimmed[3])
{
    char text[1024];
    double mean[3], wanted[3];
    snprintf(text, sizeof text,
             HEAD "#declare ABSORBING = media { absorption <.1,.2,.4> }\n"
                  "camera { orthographic location <0,0,-2> direction z right .001*x up .001*y }\n%s\n"
                  "light_source { 5*y, rgb <3,2,1> %s }\n"
                  "plane { -z, 0 rotate 45*x pigment { rgb .5 } finish { ambient 0 diffuse 1 } hollow }\n",
             things, light);
    render_mean(text, spp, 4, mean);
    for (int c = 0; c < 3; c++)
        wanted[c] = (3 - c) * 0.5 * sqrt(0.5) * dimmed[c];
    expect_color(mean, wanted, 4e-3, things);
}

/* ---- Beer's law ---- */

static void shadow_rays_obey_beer(void **state)
{
    static const struct {
        const char *media, *light;
        double depth; /* the integral of density on the way of light, and, of the air, to the camera */
    } cases[] = {
        {"box { <-1,1,-1>, <1,3,1> pigment { rgbt 1 } hollow interior { media { ABSORBING } } }", "", 2},
        {"box { <-1,1,-1>, <1,3,1> pigment { rgbt 1 } hollow interior { media { ABSORBING density {\n"
         "  gradient y scale 4 density_map { [.25 rgb 1] [.75 rgb .5] } } } } }",
         "", 1.5},
        {"box { <-1,1,-1>, <1,3,1> pigment { rgbt 1 } hollow interior { media { ABSORBING density {\n"
         "  gradient y scale 4 density_map { [.5 rgb 0] [.5 rgb 1] } } } } }",
         "", 1},
        {"box { <-1,1,-1>, <1,3,1> pigment { rgbt 1 } hollow interior { media { ABSORBING } } }\n"
         "box { <-1,2,-1>, <1,4,1> pigment { rgbt 1 } hollow interior { media { ABSORBING } } }",
         "", 4},
        {"box { <-1,1,-1>, <1,3,1> pigment { rgbt 1 } interior { media { ABSORBING } } }", "", 0},
        {"media { ABSORBING }", "media_attenuation on", 5 + 2},
        {"media { ABSORBING }", "", 2},
    };
    static const double a[3] = {0.1, 0.2, 0.4};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double dimmed[3];
        for (int c = 0; c < 3; c++)
            dimmed[c] = exp(-a[c] * cases[k].depth);
        expect_slope(cases[k].media, cases[k].light, 512, dimmed);
    }
}

/* ---- fading ---- */

#define BOX(from, to, fade)                                                                                            \
    "box { <-1," from ",-1>, <1," to ",1> pigment { rgbt 1 } interior { fade_color <.2,.5,.8> " fade " } }\n"

/* POV-Ray's formula: c + (1 - c) / (1 + (d / distance)^power), above a power of 1000 exp(-(1 - c) d / distance). */
static double faded(double color, double d, double distance, double power)
{
    return power > 1000 ? exp(-(1 - color) * d / distance) : color + (1 - color) / (1 + pow(d / distance, power));
}

/* Light through fading interiors that follow each other, overlap, and hold the light or what it shines on. */
static void shadow_rays_fade(void **state)
{
    static const double colors[3] = {.2, .5, .8};
    static const struct {
        const char *boxes;
        int count;
        double of[9][3]; /* a way, fade_distance and fade_power */
    } cases[] = {
        {BOX("1", "3", "fade_distance 1.5 fade_power 2"), 1, {{2, 1.5, 2}}},
        {BOX("1", "3", "fade_distance 4 fade_power 1001"), 1, {{2, 4, 1001}}},
        {BOX("1", "3", "fade_distance 2 fade_power 1") BOX("3.5", "4", "fade_distance .5 fade_power 3"),
         2,
         {{2, 2, 1}, {.5, .5, 3}}},
        {BOX("1", "3", "fade_distance 2 fade_power 1") BOX("2", "4.5", "fade_distance .5 fade_power 3"),
         4,
         {{1, 2, 1}, {1, 2, 1}, {1, .5, 3}, {1.5, .5, 3}}},
        {BOX("1", "4", "fade_distance 2 fade_power 1") BOX("2", "3", "fade_distance .5 fade_power 3"),
         4,
         {{1, 2, 1}, {1, 2, 1}, {1, .5, 3}, {1, 2, 1}}},
        {BOX("1", "3", "fade_distance 2 fade_power 1") BOX("1.5", "4", "fade_distance .5 fade_power 3")
             BOX("2", "4.5", "fade_distance 3 fade_power 2"),
         9,
         {{.5, 2, 1}, {.5, 2, 1}, {.5, .5, 3}, {1, 2, 1}, {1, .5, 3}, {1, 3, 2}, {1, .5, 3}, {1, 3, 2}, {.5, 3, 2}}},
        /* the camera stands in it, and POV-Ray does not know */
        {"box { <-1,-1.25,-3>, <1,1,1> pigment { rgbt 1 } interior { fade_color <.2,.5,.8> fade_distance 1 fade_power "
         "2 } }",
         1,
         {{1, 1, 2}}},
        {BOX("4", "6", "fade_distance 1 fade_power 2"), 1, {{1, 1, 2}}},
        {BOX("-1.25", "1", "fade_distance 1 fade_power 2"), 2, {{1, 1, 2}, {1, 1, 2}}}, /* and to the camera */
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double dimmed[3] = {1, 1, 1};
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < cases[k].count; i++)
                dimmed[c] *= faded(colors[c], cases[k].of[i][0], cases[k].of[i][1], cases[k].of[i][2]);
        expect_slope(cases[k].boxes, "", 64, dimmed);
    }
}

/* ---- single scattering ---- */

/* A ball of smoke of radius 1: what it scatters and extinguishes where density is 1; density falls from its middle
 * to its edge, or is 1. */
typedef struct Smoke {
    Vec3 middle;
    double scattering[3], extinction[3], g;
    int varies;
} Smoke;

static double density_in(const Smoke *s, Vec3 p)
{
    const double r = vec_length(vec_sub(p, s->middle));
    return r >= 1 ? 0 : s->varies ? 1 - r : 1;
}

/* The integral of density along a ray; at most 4 of it are in the ball. */
static double depth_along(const Smoke *s, Vec3 p, Vec3 direction)
{
    enum { STEPS = 400 };
    double sum = 0;
    for (int k = 0; k < STEPS; k++)
        sum += density_in(s, vec_mad(p, direction, (k + 0.5) * 4 / STEPS)) * 4 / STEPS;
    return sum;
}

static double phase(const Smoke *s, double cosine)
{
    return (1 - s->g * s->g) / pow(1 + s->g * s->g - 2 * s->g * cosine, 1.5) / (4 * PI);
}

static const char *smoke_text(const Smoke *s, char *text, size_t size)
{
    const double *k = s->scattering;
    const Vec3 m = s->middle;
    snprintf(text, size,
             "sphere { <%g,%g,%g>, 1 pigment { rgbt 1 } hollow interior { media {\n"
             "  scattering { 5, <%g,%g,%g> eccentricity %g } absorption <%g,%g,%g> %s translate <%g,%g,%g> } } }\n",
             m.x, m.y, m.z, k[0], k[1], k[2], s->g, s->extinction[0] - k[0], s->extinction[1] - k[1],
             s->extinction[2] - k[2], s->varies ? "density { spherical }" : "", m.x, m.y, m.z);
    return text;
}

/* A shining ball lights smoke that is seen directly: over the ray of view, and over the cone of directions to the
 * light, along which radiance is 1. */
static void sum_seen(const Smoke *s, Vec3 lamp, double radius, double sum[3])
{
    enum { ALONG = 100, ACROSS = 12, ROUND = 24 };
    const Vec3 view = {0, 0, 1};
    const double begin = s->middle.z - 1;
    sum[0] = sum[1] = sum[2] = 0;
    for (int k = 0; k < ALONG; k++) {
        const Vec3 p = vec3(0, 0, begin + (k + 0.5) * 2 / ALONG), to = vec_sub(lamp, p), axis = vec_normalize(to);
        const double before = depth_along(s, p, vec_neg(view)), here = density_in(s, p),
                     least = sqrt(1 - radius * radius / vec_dot(to, to));
        Vec3 x, y;
        vec_frame(axis, &x, &y);
        for (int i = 0; i < ACROSS * ROUND; i++) {
            const double c = 1 - (i / ROUND + 0.5) / ACROSS * (1 - least), r = sqrt(1 - c * c),
                         phi = (i % ROUND + 0.5) / ROUND * 2 * PI;
            const Vec3 w = vec_mad(vec_mad(vec_scale(axis, c), x, r * cos(phi)), y, r * sin(phi));
            const double depth = before + depth_along(s, p, w),
                         part = phase(s, vec_dot(view, w)) * here * 2.0 / ALONG * 2 * PI * (1 - least) / ACROSS / ROUND;
            for (int q = 0; q < 3; q++)
                sum[q] += s->scattering[q] * part * exp(-s->extinction[q] * depth);
        }
    }
}

static void smoke_by_a_shining_ball(void **state)
{
    static const Smoke smokes[] = {{{0, 0, 10}, {0.2, 0.5, 1.5}, {0.3, 0.5, 2}, 0.5, 0},
                                   {{0, 0, 10}, {0.2, 0.5, 1.5}, {0.3, 0.5, 2}, -0.4, 1}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[1024], smoke[512];
        double mean[3], wanted[3];
        snprintf(text, sizeof text,
                 HEAD "camera { location 0 look_at z angle .01 } %s\n"
                      "sphere { <3,0,8>, .8 pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1 } }",
                 smoke_text(&smokes[k], smoke, sizeof smoke));
        render_mean(text, 4096, 2, mean);
        sum_seen(&smokes[k], vec3(3, 0, 8), 0.8, wanted);
        expect_color(mean, wanted, 0.012, k ? "varying smoke" : "smoke");
    }
}

/* A light_source, whose irradiance is pi, gives smoke that is seen directly four times as much. */
static void smoke_by_a_light_source(void **state)
{
    enum { STEPS = 2000 };
    static const Smoke smokes[] = {{{0, 0, 10}, {0.2, 0.5, 1.5}, {0.3, 0.5, 2}, 0.5, 0},
                                   {{0, 0, 10}, {0.2, 0.5, 1.5}, {0.3, 0.5, 2}, -0.4, 1}};
    const Vec3 lamp = {3, 0, 8};
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[1024], smoke[512];
        double mean[3], wanted[3] = {0};
        snprintf(text, sizeof text, HEAD "camera { location 0 look_at z angle .01 } %s light_source { <3,0,8>, 1 }",
                 smoke_text(&smokes[k], smoke, sizeof smoke));
        render_mean(text, 4096, 2, mean);
        for (int i = 0; i < STEPS; i++) {
            const Vec3 p = vec3(0, 0, 9 + (i + 0.5) * 2 / STEPS), w = vec_normalize(vec_sub(lamp, p));
            const double depth = depth_along(&smokes[k], p, vec3(0, 0, -1)) + depth_along(&smokes[k], p, w);
            for (int q = 0; q < 3; q++)
                wanted[q] += 4 * PI * phase(&smokes[k], w.z) * smokes[k].scattering[q] * density_in(&smokes[k], p) * 2 /
                             STEPS * exp(-smokes[k].extinction[q] * depth);
        }
        expect_color(mean, wanted, 0.012, k ? "varying smoke and a light source" : "smoke and a light source");
    }
}

/* Light that skims over a plane meets the smoke above, which lights the plane: over all of the smoke. */
static void smoke_lights_a_plane(void **state)
{
    enum { STEPS = 48 };
    static const Smoke smoke = {{0, 2.2, 0}, {0.2, 0.5, 1.5}, {0.3, 0.5, 2}, 0.4, 0};
    char text[1024], media[512];
    double mean[3], wanted[3] = {0};
    (void)state;
    snprintf(text, sizeof text,
             HEAD "camera { location <0,1,-3> look_at 0 angle .01 } light_source { 9*x, 1 parallel point_at 0 } %s\n"
                  "plane { y, 0 pigment { rgb .5 } finish { ambient 0 diffuse 1 } }",
             smoke_text(&smoke, media, sizeof media));
    render_mean(text, 4096, 3, mean);
    for (int i = 0; i < STEPS * STEPS * STEPS; i++) {
        const Vec3 off = {(i % STEPS + 0.5) * 2 / STEPS - 1, (i / STEPS % STEPS + 0.5) * 2 / STEPS - 1,
                          (i / STEPS / STEPS + 0.5) * 2 / STEPS - 1};
        if (vec_dot(off, off) >= 1)
            continue;
        const Vec3 p = vec_add(smoke.middle, off), down = vec_normalize(vec_neg(p));
        const double r = vec_length(p), along = vec_dot(off, down);
        /* to the edge of the ball, along x and down */
        const double depth =
            sqrt(1 - off.y * off.y - off.z * off.z) - off.x + sqrt(along * along - vec_dot(off, off) + 1) - along;
        for (int q = 0; q < 3; q++)
            wanted[q] += 0.5 * phase(&smoke, -down.x) * smoke.scattering[q] * exp(-smoke.extinction[q] * depth) *
                         (p.y / r) / (r * r) * 8 / STEPS / STEPS / STEPS;
    }
    expect_color(mean, wanted, 0.015, "a plane below smoke");
}

/* Behind a pane that refracts it, the same light source is as bright in smoke: on paths that are scattered there. */
static void smoke_behind_a_pane(void **state)
{
    static const char *const types[] = {"1, .1", "4, .1", "1, .1 extinction .5"};
    (void)state;
    for (int k = 0; k < 3; k++) {
        double means[2][3];
        for (int pane = 0; pane < 2; pane++) {
            char text[1024];
            snprintf(text, sizeof text,
                     "#version 3.7; global_settings { assumed_gamma 1 photons { count 1 } }\n"
                     "camera { location -6*z look_at 0 angle 12 }\n"
                     "light_source { 9*y, 1 parallel point_at 0 retex { radius 3 } }\n"
                     "sphere { 0, .8 pigment { rgbt 1 } hollow interior { media { scattering { %s } } } }\n"
                     "box { <-9,2,-9>, <9,2.1,9> pigment { rgbt 1 } finish { diffuse 0 } no_image %s }",
                     types[k], pane ? "interior { ior 1.2 } photons { target refraction on }" : "");
            render_mean(text, pane ? 8192 : 256, 5, means[pane]);
        }
        expect_color(means[1], means[0], 0.1, types[k]);
    }
}

/* ---- furnace ---- */

/* Nothing is absorbed under a white sky, by smoke that scatters each colour by its own, in each other too. */
static void white_smoke_vanishes(void **state)
{
    static const double white[3] = {1, 1, 1};
    double mean[3];
    (void)state;
    render_mean(HEAD "camera { location -6*z look_at 0 angle 15 } background { rgb 1 }\n"
                     "sphere { -.5*x, 1 pigment { rgbt 1 } hollow interior { media { scattering { 2, <.5,1,2> } } } }\n"
                     "sphere { .5*x, 1 pigment { rgbt 1 } hollow interior {\n"
                     "  media { scattering { 5, <1,.8,.4> eccentricity .6 } density { spherical translate .5*x } } } }",
                256, 250, mean);
    expect_color(mean, white, 0.012, "coloured smoke");
    render_mean(HEAD "camera { location -6*z look_at 0 angle 15 } background { rgb 1 }\n"
                     "sphere { 0, 1 pigment { rgbt 1 } hollow interior { media { scattering { 1, 1.5 } } } }\n"
                     "sphere { x, 1 pigment { rgbt 1 } hollow interior { media { scattering { 3, .7 } } } }",
                16, 256, mean);
    expect_color(mean, white, 1e-6, "grey smoke");
}

/* ---- retexturing ---- */

static void sets_recombine(void **state)
{
    static const char *const airs[] = {
        "fog { distance 6 rgb <.3,.35,.4> }",
        "fog { fog_type 2 distance 3 rgb <.3,.35,.4> fog_offset .2 fog_alt .4 turbulence .3 }",
        "media { scattering { 2, .08 } absorption .02 }",
        "sphere { <0,1,0>, .8 pigment { rgbt 1 } hollow interior { media { scattering { 5, <1,2,3> eccentricity .3 }\n"
        "  absorption .3 density { spherical scale .8 translate y } } } }",
        "box { <-.6,.1,-.6>, <.6,1.6,.6> pigment { rgbt 1 } hollow interior { media { absorption <.2,.7,2> } } }",
        "sphere { <0,1,0>, .8 pigment { rgbt 1 } hollow interior { media { emission <1,.5,.1> absorption .2\n"
        "  density { spherical scale .8 translate y } } } }",
        "sphere { <0,1,0>, .8 pigment { rgbf <1,.9,.8,.9> } finish { reflection { 0, 1 fresnel } } hollow\n"
        "  interior { ior 1.4 media { scattering { 4, 1 } } } }",
    };
    (void)state;
    for (size_t k = 0; k < sizeof airs / sizeof *airs; k++) {
        char text[2048];
        snprintf(text, sizeof text,
                 HEAD "camera { location <0,1.2,-1.9> look_at <0,.9,0> angle 80 }\n"
                      "#declare Floor = pigment { rgb <.3,.6,.5> }\n"
                      "#declare Dull = finish { ambient 0 diffuse .8 }\n"
                      "light_source { <-1,2.7,-1>, .7 media_attenuation on }\n"
                      "box { <-.4,2.9,-.4>, <.4,2.95,.4> pigment { rgb 1 } finish { ambient 0 emission 6 } }\n"
                      "plane { y, 0 pigment { Floor } finish { Dull } }\n"
                      "plane { -z, -2 pigment { Floor } finish { Dull reflection .2 } }\n"
                      "box { <-2,0,-2>, <2,3,2> pigment { rgb .7 } finish { Dull } hollow inverse }\n%s",
                 airs[k]);
        assert_identity(text, "Floor", 16, 6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadow_rays_obey_beer),   cmocka_unit_test(shadow_rays_fade),
        cmocka_unit_test(smoke_by_a_shining_ball), cmocka_unit_test(smoke_by_a_light_source),
        cmocka_unit_test(smoke_lights_a_plane),    cmocka_unit_test(smoke_behind_a_pane),
        cmocka_unit_test(white_smoke_vanishes),    cmocka_unit_test(sets_recombine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
