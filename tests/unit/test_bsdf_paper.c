/* The BSDF of the extension, compared with a second one. That one is written from the formulas of the paper's
 * supplement (4.1) and of its sources: Trowbridge and Reitz' distribution and Smith's height-correlated masking (Heitz
 * 2014), Cook and Torrance's form of Fresnel's equations (1982), Burley's diffuse and retro-reflective lobes (2015),
 * Walter et al.'s rough refraction (2007, Eq. 21). Nothing here is shared with renderer/shade.
 *
 * Sampling is tested as well: directions have the stated density, by a chi-square test for each lobe, and the mean of
 * the weights is the integral of the second BSDF. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "shade/bsdf.h"
#include "shade/material.h"

/* ---- the second BSDF: plain numbers, z is the normal ---- */

typedef struct Direction {
    double x, y, z;
} Direction;
typedef struct Material {
    double m, roughness, tint, eta, transmission;
} Material;
typedef struct Value {
    double dep, indep;
} Value; /* what albedo 1 multiplies, and the rest */

static Direction spherical(double theta, double phi)
{
    return (Direction){sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

static double dot(Direction a, Direction b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Direction unit(double x, double y, double z)
{
    const double length = sqrt(x * x + y * y + z * z);

    return (Direction){x / length, y / length, z / length};
}

/* Cook and Torrance 1982, with g imaginary beyond the critical angle. */
static double dielectric(double c, double eta)
{
    const double g2 = eta * eta - 1 + c * c;

    if (g2 <= 0)
        return 1;
    const double g = sqrt(g2), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return a * a / 2 * (1 + b * b);
}

static double distribution(double cosine, double alpha)
{
    const double tangent2 = 1 / (cosine * cosine) - 1, k = 1 + tangent2 / (alpha * alpha);

    return 1 / (PI * alpha * alpha * pow(cosine, 4) * k * k);
}

static double smith(double cosine, double alpha)
{
    return (sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
}

static double masking(double a, double b, double alpha)
{
    return 1 / (1 + smith(a, alpha) + smith(b, alpha));
}

/* Supplement 4.1.2: F_dep over the albedo, and F_indep; of what transmits the outer boundary reflects instead. */
static Value fresnel(const Material *m, double cosine, double outer_eta)
{
    const double metal = m->m, through = m->transmission * (1 - metal), w = pow(1 - cosine, 5);
    const double f0 = pow((m->eta - 1) / (m->eta + 1), 2), r0 = (1 - metal) * f0 * m->tint;
    const double indep = (1 - metal) * dielectric(cosine, m->eta) + metal * (r0 + (1 - r0) * w);

    return (Value){(1 - through) * metal * (1 - w) * metal,
                   (1 - through) * indep + through * dielectric(cosine, outer_eta)};
}

static double burley(const Material *m, double out, double in, double cosine)
{
    const double fl = pow(1 - in, 5), fv = pow(1 - out, 5), rr = 2 * m->roughness * cosine * cosine;

    return ((1 - fl / 2) * (1 - fv / 2) + rr * (fl + fv + fl * fv * (rr - 1))) / PI;
}

/* f of a surface seen from o (o.z > 0), lit from i; outer_eta: index beyond the surface over that on o's side. */
static Value paper_bsdf(const Material *m, double outer_eta, Direction o, Direction i)
{
    const double alpha = m->roughness * m->roughness, through = m->transmission * (1 - m->m);

    if (i.z > 0) {
        const Direction h = unit(o.x + i.x, o.y + i.y, o.z + i.z);
        const double cosine = dot(o, h);
        const double lobe = distribution(h.z, alpha) * masking(o.z, i.z, alpha) / (4 * o.z * i.z);
        const Value f = fresnel(m, cosine, outer_eta);
        return (Value){f.dep * lobe + (1 - m->m) * (1 - through) * burley(m, o.z, i.z, cosine), f.indep * lobe};
    }
    if (through <= 0)
        return (Value){0, 0};
    /* light comes from the side of index outer_eta to that of index 1 */
    Direction h = unit(-(outer_eta * i.x + o.x), -(outer_eta * i.y + o.y), -(outer_eta * i.z + o.z));
    if (h.z < 0)
        h = (Direction){-h.x, -h.y, -h.z};
    const double oh = dot(o, h), ih = dot(i, h);
    if (oh <= 0 || ih >= 0)
        return (Value){0, 0};
    const double whole = outer_eta * ih + oh;
    return (Value){through * (1 - dielectric(oh, outer_eta)) * distribution(h.z, alpha) * masking(o.z, -i.z, alpha) *
                       fabs(ih * oh) / (fabs(i.z) * o.z * whole * whole),
                   0};
}

/* ---- the renderer's ---- */

typedef struct Subject {
    Pigment pigment;
    Finish finish;
    Interior interior;
    Texture texture;
    Primitive primitive;
    Surface surface;
    Bsdf bsdf;
} Subject;

static void povray_finish(Subject *s)
{
    memset(s, 0, sizeof *s);
    s->pigment = (Pigment){.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0, 0}};
    s->finish.brilliance = s->finish.reflection_falloff = s->finish.reflection_exponent = 1;
    s->finish.phong_size = 40, s->finish.roughness = 0.05;
    s->interior.ior = 1;
    s->texture = (Texture){.pigment = &s->pigment, .finish = &s->finish};
    s->primitive = (Primitive){.shape.ops = &shape_plane, .texture = &s->texture, .interior = &s->interior};
    s->surface = (Surface){.primitive = &s->primitive,
                           .texture = &s->texture,
                           .target = -1,
                           .geometric_normal = {0, 0, 1},
                           .shading_normal = {0, 0, 1}};
}

static void look(Subject *s, Direction o)
{
    bsdf_setup(&s->bsdf, &s->surface, vec3(o.x, o.y, o.z), 0, 0, 1);
}

static void disney_finish(Subject *s, const Material *m)
{
    povray_finish(s);
    s->finish.retex.present = 1;
    s->finish.retex.metallic = m->m, s->finish.retex.roughness = m->roughness;
    s->finish.retex.specular_tint = m->tint, s->finish.retex.ior = m->eta;
    s->finish.retex.transmission = m->transmission;
}

/* f |cos| of either part; both are grey. */
static Value evaluated(const Subject *s, Direction i, double *pdf)
{
    float p;
    const Split f = bsdf_eval(&s->bsdf, vec3(i.x, i.y, i.z), 0, &p);

    if (pdf)
        *pdf = p;
    return (Value){f.d.r, f.i.r};
}

static void expect(double is, double should, const Material *m, Direction o, Direction i, const char *part)
{
    if (!(fabs(is - should) <= 2e-6 + 2e-4 * fabs(should)))
        fail_msg("%s part is %.7g, should be %.7g: m %g, roughness %g, tint %g, eta %g, transmission %g, "
                 "o %.3f %.3f %.3f, i %.3f %.3f %.3f",
                 part, is, should, m->m, m->roughness, m->tint, m->eta, m->transmission, o.x, o.y, o.z, i.x, i.y, i.z);
}

static uint64_t random_state;
static double random01(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) / 9007199254740992.0;
}

/* A direction on one side, uniform over it but never at its edge. */
static Direction random_side(int side)
{
    const double z = 0.02 + 0.98 * random01(), phi = 2 * PI * random01(), r = sqrt(1 - z * z);

    return (Direction){r * cos(phi), r * sin(phi), side < 0 ? -z : z};
}

static const double metallics[] = {0, 0.25, 0.5, 0.75, 1}, roughnesses[] = {0.15, 0.3, 0.5, 0.8, 1};
static const double tints[] = {0, 0.5, 1}, etas[] = {1.2, 1.5, 2.4}, transmissions[] = {0, 0.4, 1};
#define EACH(k, list) (size_t k = 0; k < sizeof list / sizeof list[0]; k++)

typedef void Check(Subject *s, const Material *m);

static void every_material(Check *check, int with_transmission)
{
    Subject s;

    random_state = 1;
    for
        EACH(a, metallics)
        for
            EACH(b, roughnesses)
            for
                EACH(c, tints)
                for
                    EACH(d, etas)
                    for
                        EACH(e, transmissions)
                        {
                            const Material m = {metallics[a], roughnesses[b], tints[c], etas[d], transmissions[e]};
                            if (e && !with_transmission)
                                continue;
                            disney_finish(&s, &m);
                            check(&s, &m);
                        }
}

static void compare(Subject *s, const Material *m)
{
    for (int k = 0; k < 40; k++) {
        const Direction o = random_side(1), i = random_side(k % 4 ? 1 : -1);
        look(s, o);
        /* opaque, or with transmission seen from outside: what is beyond has the index eta */
        const Value is = evaluated(s, i, NULL), f = paper_bsdf(m, m->eta, o, i);
        expect(is.dep, f.dep * fabs(i.z), m, o, i, "dependent");
        expect(is.indep, f.indep * fabs(i.z), m, o, i, "independent");
    }
}

static void all_values_are_the_papers(void **state)
{
    (void)state;
    every_material(compare, 1);
}

/* From inside the index is the other way round; and light that is bent obeys f(i, o) = eta^2 f(o, i). */
static void compare_inside(Subject *s, const Material *m)
{
    for (int k = 0; k < 20; k++) {
        const Direction o = random_side(1), i = random_side(k % 2 ? 1 : -1);
        s->surface.backside = 1;
        bsdf_setup(&s->bsdf, &s->surface, vec3(o.x, o.y, -o.z), 0, 0, 1);
        float pdf;
        const Split f = bsdf_eval(&s->bsdf, vec3(i.x, i.y, -i.z), 0, &pdf);
        const double outer = m->transmission > 0 && m->m < 1 ? 1 / m->eta : m->eta;
        const Value should = paper_bsdf(m, outer, o, i);
        expect(f.d.r, should.dep * fabs(i.z), m, o, i, "dependent");
        expect(f.i.r, should.indep * fabs(i.z), m, o, i, "independent");
    }
}

static void so_are_those_from_inside(void **state)
{
    (void)state;
    every_material(compare_inside, 1);
}

static void swap(Subject *s, const Material *m)
{
    for (int k = 0; k < 20; k++) {
        const Direction o = random_side(1), i = random_side(1);
        look(s, o);
        const Value there = evaluated(s, i, NULL);
        look(s, i);
        const Value back = evaluated(s, o, NULL);
        expect(there.dep / i.z, back.dep / o.z, m, o, i, "dependent (reciprocal)");
        expect(there.indep / i.z, back.indep / o.z, m, o, i, "independent (reciprocal)");
    }
}

static void reflection_is_reciprocal(void **state)
{
    (void)state;
    every_material(swap, 0);
}

/* Roughness 0: the same split as the weight of a mirror, and the diffuse lobe as it was. */
static void compare_smooth(Subject *s, const Material *given)
{
    Material m = *given;
    m.roughness = 0;
    disney_finish(s, &m);
    for (int k = 0; k < 10; k++) {
        const Direction o = random_side(1), i = random_side(1);
        look(s, o);
        const Value f = fresnel(&m, o.z, m.eta), rest = evaluated(s, i, NULL);
        const double through = m.transmission * (1 - m.m);
        expect(s->bsdf.mirror.d.r, f.dep, &m, o, i, "dependent (mirror)");
        expect(s->bsdf.mirror.i.r, f.indep, &m, o, i, "independent (mirror)");
        expect(s->bsdf.passing.d.r, through * (1 - dielectric(o.z, m.eta)), &m, o, i, "passing");
        const double cosine = dot(o, unit(o.x + i.x, o.y + i.y, o.z + i.z));
        expect(rest.dep, (1 - m.m) * (1 - through) * burley(&m, o.z, i.z, cosine) * i.z, &m, o, i, "diffuse");
        expect(rest.indep, 0, &m, o, i, "independent (but the mirror)");
    }
}

static void smooth_surfaces_split_alike(void **state)
{
    (void)state;
    every_material(compare_smooth, 1);
}

/* ---- sampling ---- */

enum { RINGS = 24, SECTORS = 32, CELLS = RINGS * SECTORS, FINE = 24, SAMPLES = 200000 };

static int cell_of(Vec3 w)
{
    const int ring = (int)((1 - w.z) / 2 * RINGS), sector = (int)((atan2(w.y, w.x) / (2 * PI) + 0.5) * SECTORS);

    return (ring < RINGS ? ring : RINGS - 1) * SECTORS + (sector < SECTORS ? sector : SECTORS - 1);
}

/* How often each cell should be hit: the stated density over it. */
static void expect_counts(const Subject *s, double *counts)
{
    for (int cell = 0; cell < CELLS; cell++) {
        double sum = 0;
        for (int k = 0; k < FINE * FINE; k++) {
            const double z = 1 - 2 * (cell / SECTORS + (k / FINE + 0.5) / FINE) / RINGS, r = sqrt(1 - z * z);
            const double phi = ((cell % SECTORS + (k % FINE + 0.5) / FINE) / SECTORS - 0.5) * 2 * PI;
            double pdf;
            (void)evaluated(s, (Direction){r * cos(phi), r * sin(phi), z}, &pdf);
            sum += pdf;
        }
        counts[cell] = sum / (FINE * FINE) * 4 * PI / CELLS * SAMPLES;
    }
}

/* How many standard deviations chi-square is beyond its mean; cells of few are put together. */
static double excess(const double *expected, const int *counted)
{
    double few = 0, chi = 0;
    int fewer = 0, freedom = 0;

    for (int cell = 0; cell < CELLS; cell++) {
        if (expected[cell] < 10) {
            few += expected[cell], fewer += counted[cell];
            continue;
        }
        chi += (counted[cell] - expected[cell]) * (counted[cell] - expected[cell]) / expected[cell];
        freedom++;
    }
    if (few > 10)
        chi += (fewer - few) * (fewer - few) / few, freedom++;
    else
        assert_true(fewer < 40);
    return (chi - freedom) / sqrt(2.0 * freedom);
}

static void check_sampling(const Subject *s, const char *what)
{
    static double expected[CELLS];
    static int counted[CELLS];

    memset(counted, 0, sizeof counted);
    expect_counts(s, expected);
    for (int k = 0; k < SAMPLES; k++) {
        BsdfSample sample;
        const float lobe = (float)random01(), u = (float)random01(), v = (float)random01();
        if (!bsdf_sample(&s->bsdf, lobe < 1 ? lobe : 0, u < 1 ? u : 0, v < 1 ? v : 0, &sample) || sample.pdf <= 0)
            continue;
        double pdf;
        const Value f = evaluated(s, (Direction){sample.wi.x, sample.wi.y, sample.wi.z}, &pdf);
        if (fabs(pdf - sample.pdf) > 1e-3 * pdf || fabs(f.dep - sample.weight.d.r * pdf) > 1e-6 + 1e-3 * f.dep ||
            fabs(f.indep - sample.weight.i.r * pdf) > 1e-6 + 1e-3 * f.indep)
            fail_msg("%s: a sample's density or weight is not that of its direction", what);
        counted[cell_of(sample.wi)]++;
    }
    const double by = excess(expected, counted);
    if (by > 5)
        fail_msg("%s: directions do not follow their density: chi-square is %.1f standard deviations too large", what,
                 by);
}

static void directions_follow_their_density(void **state)
{
    (void)state;
    static const double angles[] = {0.1, 0.7, 1.3};
    static const Material materials[] = {{0, 0.5, 1, 1.5, 0}, {1, 0.6, 1, 1.5, 0},   {0.5, 0.8, 0.3, 1.5, 0},
                                         {0, 0.6, 1, 1.5, 1}, {0.3, 0.7, 1, 2, 0.6}, {0, 1, 0, 1.2, 0}};
    Subject s;
    char what[96];

    random_state = 2;
    for
        EACH(a, angles)
        {
            const Direction o = spherical(angles[a], 0.4);
        for
            EACH(k, materials)
            {
                disney_finish(&s, &materials[k]);
                look(&s, o);
                snprintf(what, sizeof what, "material %zu at %g", k, angles[a]);
                check_sampling(&s, what);
            }
        povray_finish(&s); /* Lambert, from either side */
        s.finish.diffuse = 0.6, s.finish.diffuse_back = 0.3;
        look(&s, o);
        check_sampling(&s, "diffuse");
        s.finish.brilliance = 3;
        look(&s, o);
        check_sampling(&s, "brilliance");
        s.finish.specular = 0.7, s.finish.specular_albedo = 1, s.finish.roughness = 0.2;
        look(&s, o);
        check_sampling(&s, "highlight");
        }
}

/* The integral of the paper's BSDF over all directions, for albedo 1, by stratified points. */
static Value integral(const Material *m, Direction o)
{
    enum { N = 500 };
    Value sum = {0, 0};

    for (int k = 0; k < N * N; k++) {
        const double z = 1 - 2 * (k / N + 0.5) / N, phi = 2 * PI * (k % N + 0.5) / N, r = sqrt(1 - z * z);
        const Value f = paper_bsdf(m, m->eta, o, (Direction){r * cos(phi), r * sin(phi), z});
        sum.dep += f.dep * fabs(z), sum.indep += f.indep * fabs(z);
    }
    return (Value){sum.dep * 4 * PI / N / N, sum.indep * 4 * PI / N / N};
}

/* Weights are right on the average, part by part, and no surface without Burley's lobe gives more than it gets. */
static void weights_add_up_to_the_papers_integral(void **state)
{
    (void)state;
    static const Material materials[] = {{0, 0.5, 1, 1.5, 0}, {1, 0.5, 1, 1.5, 0},   {0.5, 0.7, 0.3, 1.5, 0},
                                         {0, 0.6, 1, 1.5, 1}, {0.3, 0.7, 1, 2, 0.6}, {0.75, 1, 1, 2.4, 0}};
    Subject s;

    random_state = 3;
    for
        EACH(k, materials)
    for (double theta = 0.1; theta < 1.4; theta += 0.6) {
        const Direction o = spherical(theta, 0.4);
        const Value whole = integral(&materials[k], o);
        Value sum = {0, 0};
        disney_finish(&s, &materials[k]);
        look(&s, o);
        for (int i = 0; i < SAMPLES; i++) {
            BsdfSample sample;
            const float lobe = (float)(random01() * 0.9999999), u = (float)random01(), v = (float)random01();
            if (bsdf_sample(&s.bsdf, lobe, u < 1 ? u : 0, v < 1 ? v : 0, &sample))
                sum.dep += sample.weight.d.r, sum.indep += sample.weight.i.r;
        }
        if (fabs(sum.dep / SAMPLES - whole.dep) > 0.008 || fabs(sum.indep / SAMPLES - whole.indep) > 0.008)
            fail_msg("material %zu at %.1f: weights have the means %.4f and %.4f, the paper %.4f and %.4f", k, theta,
                     sum.dep / SAMPLES, sum.indep / SAMPLES, whole.dep, whole.indep);
        if (materials[k].m == 1)
            assert_true(whole.dep + whole.indep <= 1.0005);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_values_are_the_papers),       cmocka_unit_test(so_are_those_from_inside),
        cmocka_unit_test(reflection_is_reciprocal),        cmocka_unit_test(smooth_surfaces_split_alike),
        cmocka_unit_test(directions_follow_their_density), cmocka_unit_test(weights_add_up_to_the_papers_integral)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
