/* Clear coat and sheen: what their tables say is the integral of their lobes, sampling matches evaluation, no light is
 * made, and only i knows of them. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <cmocka.h>
#include "lib_bsdf.h"
#include "shade/fresnel.h"
#include "shade/material.h"

static Pigment white = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0, 0}};

/* A surface that faces z, without highlights below its layers. */
typedef struct Case {
    Finish finish;
    Texture texture;
    Primitive primitive;
    Surface surface;
} Case;

static void case_begin(Case *c)
{
    *c = (Case){.finish = {.retex = {.present = 1, .ior = 1, .roughness = 0.3, .specular_tint = 1}}};
    c->texture = (Texture){.pigment = &white, .finish = &c->finish};
    c->primitive = (Primitive){.shape.ops = &shape_plane, .texture = &c->texture};
    c->surface = (Surface){.primitive = &c->primitive,
                           .texture = &c->texture,
                           .target = -1,
                           .geometric_normal = {0, 0, 1},
                           .shading_normal = {0, 0, 1}};
}

static Bsdf make(const Case *c, double theta)
{
    Bsdf b;
    bsdf_setup(&b, &c->surface, vec3(sin(theta) * cos(0.3), sin(theta) * sin(0.3), cos(theta)), 0, 0, 1);
    return b;
}

static Split sampled(const Bsdf *b)
{
    enum { COUNT = 1 << 15 };
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < COUNT; k++) {
        BsdfSample s;
        if (!test_bsdf_sample(b, 7, k, &s))
            continue;
        sum.d = rgb_add(sum.d, s.weight.d), sum.i = rgb_add(sum.i, s.weight.i);
    }
    return (Split){rgb_scale(sum.d, 1.0f / COUNT), rgb_scale(sum.i, 1.0f / COUNT)};
}

static Split integrated(const Bsdf *b, double *pdf)
{
    enum { N = 400 };
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    const float scale = (float)(2 * PI / N / N);
    *pdf = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            const double cosine = (i + 0.5) / N, phi = 2 * PI * (j + 0.5) / N, sine = sqrt(1 - cosine * cosine);
            float p;
            const Split f = bsdf_eval(b, vec3(sine * cos(phi), sine * sin(phi), cosine), BSDF_ANY_LIGHT, &p);
            sum.d = rgb_add(sum.d, f.d), sum.i = rgb_add(sum.i, f.i);
            *pdf += (double)p;
        }
    *pdf *= (double)scale;
    return (Split){rgb_scale(sum.d, scale), rgb_scale(sum.i, scale)};
}

static void close_to(double a, double b, double tolerance, const char *what)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f within %g", what, a, b, tolerance);
}

static void smooth_coat_obeys_fresnel(void **state)
{
    (void)state;
    Case c;
    case_begin(&c);
    c.finish.retex.clearcoat = 0.7;
    for (double theta = 0.05; theta < 1.55; theta += 0.25) {
        const double t = asin(sin(theta) / 1.5), s = sin(theta - t) / sin(theta + t),
                     p = tan(theta - t) / tan(theta + t);
        const double fresnel = (s * s + p * p) / 2;
        const Bsdf b = make(&c, theta);
        const Split energy = sampled(&b);
        double pdf;
        close_to((double)energy.i.g, 0.7 * fresnel, 2e-3, "mirrored");
        close_to((double)integrated(&b, &pdf).i.g, 0, 1e-6, "a delta");
        close_to((double)b.coating.under, 1 - 0.7 * fresnel, 2e-3, "passes");
    }
}

/* Of black surfaces, which have nothing but the layer. */
static void tables_are_the_integrals(void **state)
{
    (void)state;
    for (double roughness = 0.3; roughness <= 1; roughness += 0.1)
        for (double theta = 0.1; theta < 1.45; theta += 0.2) {
            Case c;
            double pdf;
            case_begin(&c);
            c.finish.retex.clearcoat = 1, c.finish.retex.clearcoat_roughness = roughness;
            Bsdf b = make(&c, theta);
            const double f = (double)fresnel_dielectric((float)cos(theta), 1.5f);
            close_to((double)(clearcoat_albedo((float)cos(theta), (float)roughness) / integrated(&b, &pdf).i.g), 1,
                     0.02, "coat");
            assert_true((double)clearcoat_albedo((float)cos(theta), (float)roughness) < 1.03 * f);
            case_begin(&c);
            c.finish.retex.sheen = rgb_grey(1), c.finish.retex.sheen_roughness = roughness;
            b = make(&c, theta);
            close_to((double)sheen_albedo((float)cos(theta), (float)roughness), (double)integrated(&b, &pdf).i.g, 0.012,
                     "sheen");
        }
}

static const struct {
    double metallic, roughness, ior, coat, coat_roughness, sheen, sheen_roughness;
} settings[] = {{0, 0.5, 1, 1, 0.3, 0, 0.3},   {0, 0.5, 1.5, 0.5, 0.6, 0, 0.3}, {1, 0.4, 1.5, 1, 0.8, 0, 0.3},
                {0, 0.7, 1, 0, 0, 1, 0.3},     {0, 0.7, 1.5, 0, 0, 0.6, 0.8},   {1, 0.4, 1.5, 0.7, 0.5, 0.8, 0.5},
                {0.5, 0, 1.5, 0.7, 0.5, 0, 1}, {1, 0.3, 1.5, 1, 0, 1, 0.5}};

static void sampling_matches_evaluation(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++)
        for (double theta = 0.2; theta < 1.5; theta += 0.6) {
            Case c;
            double pdf;
            char what[64];
            case_begin(&c);
            c.finish.retex.metallic = settings[k].metallic, c.finish.retex.roughness = settings[k].roughness;
            c.finish.retex.ior = settings[k].ior;
            c.finish.retex.clearcoat = settings[k].coat;
            c.finish.retex.clearcoat_roughness = settings[k].coat_roughness;
            c.finish.retex.sheen = rgb(1 * (float)settings[k].sheen, 0.5f * (float)settings[k].sheen, 0);
            c.finish.retex.sheen_roughness = settings[k].sheen_roughness;
            const Bsdf b = make(&c, theta);
            const Split by_samples = sampled(&b), whole = integrated(&b, &pdf);
            const float delta = b.coating.coat.weight > 0 && b.coating.coat.alpha == 0
                                    ? b.coating.coat.weight * fresnel_dielectric((float)cos(theta), 1.5f)
                                    : 0;
            snprintf(what, sizeof what, "case %zu theta %.1f", k, theta);
            close_to((double)by_samples.d.r, (double)(whole.d.r + b.mirror.d.r), 0.01, what);
            close_to((double)by_samples.i.r, (double)(whole.i.r + b.mirror.i.r + delta), 0.01, what);
            close_to((double)by_samples.i.g, (double)(whole.i.g + b.mirror.i.g + delta), 0.01, what);
            const double deltas = (double)(b.p_mirror + (b.coating.coat.alpha == 0 ? b.coating.coat.p : 0));
            assert_true(pdf + deltas < 1.005 && pdf + deltas > 0.85);
            close_to((double)bsdf_wide_probability(&b), 1 - deltas, 1e-5, "wide");
        }
}

/* No lamp, furnace of 1: what comes back is at most what the base gave back, or 1. */
static void no_light_is_made(void **state)
{
    (void)state;
    for (int k = 0; k < 48; k++) {
        Case c;
        case_begin(&c);
        c.finish.retex.roughness = k & 1 ? 0.6 : 0, c.finish.retex.metallic = k & 2 ? 1 : 0;
        c.finish.retex.ior = k & 2 ? 1.5 : 1;
        for (double theta = 0.05; theta < 1.55; theta += 0.15) {
            c.finish.retex.clearcoat = 0, c.finish.retex.sheen = rgb_grey(0);
            Bsdf b = make(&c, theta);
            const double base = (double)split_apply(sampled(&b), rgb_grey(1)).g;
            c.finish.retex.clearcoat = k & 4 ? 1 : 0, c.finish.retex.sheen = rgb_grey(k & 8 ? 1 : 0);
            c.finish.retex.clearcoat_roughness = k >= 32 ? 1 : k >= 16 ? 0.4 : 0;
            c.finish.retex.sheen_roughness = k >= 32 ? 1 : k >= 16 ? 0.5 : 0.1;
            b = make(&c, theta);
            const double energy = (double)split_apply(sampled(&b), rgb_grey(1)).g;
            if (energy > fmax(base, 1) + 0.02)
                fail_msg("case %d theta %.2f: %.4f of %.4f", k, theta, energy, base);
        }
    }
}

/* Glass has its coat on the outside; where an image cuts holes, there is none. */
static void coat_is_outside_and_not_in_holes(void **state)
{
    (void)state;
    Case c;
    Bsdf b;
    case_begin(&c);
    c.finish.retex.clearcoat = 1, c.finish.retex.transmission = 1, c.finish.retex.ior = 1.5;
    c.finish.retex.roughness = 0;
    b = make(&c, 0.5);
    assert_true(b.coating.present && b.coating.under < 1);
    const Bsdf coated = b;
    c.finish.retex.clearcoat = 0;
    b = make(&c, 0.5);
    close_to((double)coated.passing.d.g, (double)(b.passing.d.g * coated.coating.under), 1e-6, "passes the coat");
    c.finish.retex.clearcoat = 1, c.surface.backside = 1;
    bsdf_setup(&b, &c.surface, vec3(0, 0.6, -0.8), 0, 0, 1);
    assert_false(b.coating.present);
    case_begin(&c);
    c.finish.retex.clearcoat = 1;
    bsdf_setup(&b, &c.surface, vec3(0, 0.6, 0.8), 0, 0.75f, 0.25f);
    const Bsdf full = make(&c, asin(0.6));
    close_to((double)b.passing.i.g, 0.75, 1e-6, "through the hole");
    close_to((double)b.coating.coat.weight, 0.25, 1e-6, "what is there");
    close_to((double)b.coating.under, (double)full.coating.under, 1e-6, "under it");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_coat_obeys_fresnel),        cmocka_unit_test(tables_are_the_integrals),
        cmocka_unit_test(sampling_matches_evaluation),      cmocka_unit_test(no_light_is_made),
        cmocka_unit_test(coat_is_outside_and_not_in_holes),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("coat", tests, NULL, NULL);
}
