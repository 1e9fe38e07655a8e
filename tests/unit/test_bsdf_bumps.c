/* The BSDF where bumps tilt the normal: no energy is won or lost, no mirrored or refracted ray goes astray, and samples
 * are distributed as evaluation says. The white furnace is a closed form here: a surface that reflects all light with a
 * smooth normal must do so with a tilted one. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "pattern/pattern.h"
#include "lib_bsdf.h"
#include "shade/material.h"

enum { COSINES = 16, TURNS = 24, FINE = 24, SAMPLES = 1 << 16 }; /* bins, and points to a side of a bin */

typedef struct Case {
    Pigment pigment;
    Finish finish;
    Interior interior;
    Normal normal;
    Texture texture;
    Primitive primitive;
    Surface surface;
} Case;

/* A surface that faces +z. The place on it decides the tilt, which is up to 60 degrees. */
static void case_begin(Case *c, int backside, int place)
{
    *c = (Case){.pigment = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0, 0}, .transform = transform_identity()},
                .finish = {.brilliance = 1,
                           .reflection_falloff = 1,
                           .reflection_exponent = 1,
                           .phong_size = 40,
                           .roughness = 1},
                .interior = {.ior = 1},
                .normal = {.kind = NORMAL_VECTORS, .size = 2.5, .accuracy = 0.02, .transform = transform_identity()}};
    c->normal.pattern = (Pattern){.ops = pattern_at(pattern_find("bumps")), .frequency = 1};
    c->texture = (Texture){.pigment = &c->pigment, .finish = &c->finish, .normal = &c->normal};
    c->primitive = (Primitive){.shape.ops = &shape_plane, .texture = &c->texture, .interior = &c->interior};
    c->surface = (Surface){.primitive = &c->primitive,
                           .texture = &c->texture,
                           .target = -1,
                           .position = {0.37 * place, 0.61 * place, 0.23 * place},
                           .geometric_normal = {0, 0, 1},
                           .shading_normal = {0, 0, 1},
                           .backside = backside};
}

static Bsdf make(const Case *c, double theta, float filter, float transmit)
{
    Bsdf b;
    const Vec3 wo = vec3(sin(theta) * cos(0.3), sin(theta) * sin(0.3), cos(theta));
    bsdf_setup(&b, &c->surface, c->surface.backside ? vec_neg(wo) : wo, filter, transmit,
               fmaxf(0, 1 - filter - transmit));
    assert_int_equal(b.bumped, 1);
    assert_true(vec_dot(b.normal, b.wo) > 0);
    return b;
}

static double whole(Split s)
{
    return split_apply(s, rgb_grey(1)).g;
}

/* Sampled directions by bin, and the mean weight. */
static double sample_all(const Bsdf *b, double bins[COSINES][TURNS])
{
    double sum = 0;
    memset(bins, 0, COSINES * TURNS * sizeof **bins);
    for (int k = 0; k < SAMPLES; k++) {
        BsdfSample s;
        if (!test_bsdf_sample(b, 3, k, &s))
            continue;
        assert_int_equal(s.transmitted, vec_dot(s.wi, b->geometric) < 0);
        sum += whole(s.weight);
        double turn = atan2(s.wi.y, s.wi.x) / (2 * PI);
        int i = (int)((s.wi.z + 1) / 2 * COSINES), j = (int)((turn - floor(turn)) * TURNS);
        bins[i < COSINES ? i : COSINES - 1][j < TURNS ? j : TURNS - 1] += 1.0 / SAMPLES;
    }
    return sum / SAMPLES;
}

/* The same from evaluation, by the midpoint rule. */
static double integrate(const Bsdf *b, double bins[COSINES][TURNS])
{
    const double area = 4 * PI / (COSINES * TURNS * FINE * FINE);
    double sum = 0;
    memset(bins, 0, COSINES * TURNS * sizeof **bins);
    for (int i = 0; i < COSINES * FINE; i++)
        for (int j = 0; j < TURNS * FINE; j++) {
            const double z = 2 * (i + 0.5) / (COSINES * FINE) - 1, phi = 2 * PI * (j + 0.5) / (TURNS * FINE);
            const double r = sqrt(1 - z * z);
            float pdf;
            sum += area * whole(bsdf_eval(b, vec3(r * cos(phi), r * sin(phi), z), 0, &pdf));
            bins[i / FINE][j / FINE] += area * pdf;
        }
    return sum;
}

/* Returns the energy. */
static double check_lobes(const Bsdf *b, const char *what)
{
    static double sampled[COSINES][TURNS], density[COSINES][TURNS];
    const double a = sample_all(b, sampled), e = integrate(b, density);
    double whole_density = 0;
    if (fabs(a - e) > 0.01)
        fail_msg("%s: energy %.4f by samples, %.4f by evaluation", what, a, e);
    for (int i = 0; i < COSINES; i++)
        for (int j = 0; j < TURNS; j++) {
            whole_density += density[i][j];
            if (fabs(sampled[i][j] - density[i][j]) > 0.003)
                fail_msg("%s: bin %d %d has %.5f of the samples, its density is %.5f", what, i, j, sampled[i][j],
                         density[i][j]);
        }
    assert_true(whole_density < 1.005);
    return a;
}

static void near(double a, double b, double tolerance, const char *what)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f", what, a, b);
}

static void diffuse_surfaces_lose_nothing(void **state)
{
    (void)state;
    for (int place = 1; place < 9; place++)
        for (int side = 0; side < 2; side++)
            for (double theta = 0.1; theta < 1.5; theta += 0.65) {
                Case c;
                case_begin(&c, side, place);
                c.finish.diffuse = 1;
                Bsdf b = make(&c, theta, 0, 0);
                near(check_lobes(&b, "diffuse"), 1, 1e-4, "diffuse");
                c.finish.diffuse = 0.6, c.finish.diffuse_back = 0.4;
                b = make(&c, theta, 0, 0);
                near(check_lobes(&b, "translucent"), 1, 1e-4, "translucent");
            }
}

static void mirrors_and_glass_lose_nothing(void **state)
{
    (void)state;
    for (int place = 1; place < 40; place++)
        for (int side = 0; side < 2; side++)
            for (double theta = 0.05; theta < 1.55; theta += 0.1) {
                Case c;
                BsdfSample s;
                case_begin(&c, side, place);
                c.finish.reflection_min = c.finish.reflection_max = rgb_grey(1);
                Bsdf b = make(&c, theta, 0, 0);
                assert_int_equal(bsdf_sample(&b, 0.5f, 0.5f, 0.5f, &s), 1);
                assert_true(vec_dot(s.wi, b.geometric) > 0);
                near(whole(s.weight), 1, 1e-6, "mirror");

                c.interior.ior = 1.5;
                c.finish.reflection_min = rgb_grey(0), c.finish.reflection_fresnel = 1;
                b = make(&c, theta, 0, 1);
                double energy = 0; /* radiance refracted by eta carries 1 / eta^2 of it */
                for (double u = 0.5 / 64; u < 1; u += 1.0 / 64) {
                    assert_int_equal(bsdf_sample(&b, (float)u, 0.5f, 0.5f, &s), 1);
                    assert_int_equal(s.transmitted, vec_dot(s.wi, b.geometric) < 0);
                    energy += whole(s.weight) * (s.transmitted ? b.eta * b.eta : 1) / 64;
                }
                near(energy, 1, 0.02, "glass");
            }
}

/* Highlights and the extension's lobes: as much energy as without bumps, or less where a rough lobe reaches under the
 * tilted surface, as it does under a smooth one. */
static void rough_lobes_gain_nothing(void **state)
{
    (void)state;
    for (int place = 1; place < 6; place++)
        for (int kind = 0; kind < 4; kind++)
            for (double theta = 0.2; theta < 1.5; theta += 0.6) {
                Case c;
                char what[64];
                case_begin(&c, kind == 3, place);
                if (kind == 0) {
                    c.finish.diffuse = 0.3, c.finish.specular = 0.7, c.finish.specular_albedo = 1;
                    c.finish.roughness = 0.1;
                } else {
                    c.finish.retex.present = 1, c.finish.retex.roughness = 0.6, c.finish.retex.ior = 1.5;
                    c.finish.retex.metallic = kind == 1, c.finish.retex.transmission = kind >= 2;
                }
                Bsdf b = make(&c, theta, 0, 0);
                snprintf(what, sizeof what, "kind %d place %d theta %.1f", kind, place, theta);
                const double energy = check_lobes(&b, what);
                assert_true(energy > 0.3 && energy <= (kind == 3 ? 2.25 : 1.002));
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_surfaces_lose_nothing),
        cmocka_unit_test(mirrors_and_glass_lose_nothing),
        cmocka_unit_test(rough_lobes_gain_nothing),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
