/* Light sources: where and how much each kind shines, and that one that paths may meet gives the same light as one that
 * is sampled. test_lights.c has how they are chosen. */
#include "lib_random_scene.h"
#include "lib_scene.h"

#include <stdio.h>
#include <string.h>
#include "light/lights.h"
#include "light/source.h"

static Vec3 random_point(double size)
{
    double x = random_between(-size, size), y = random_between(-size, size);
    return vec3(x, y, random_between(-size, size));
}

/* Light sources by POV-Ray's laws: a spot is whole within its radius, none beyond its falloff, and a smooth cubic
 * between; fading halves at the distance it names; an area light is a grid about its centre. */
static void sources_shine_by_their_laws(void **state)
{
    (void)state;
    const Light plain = {.ops = &light_point, .location = {0, 4, 0}, .point_at = {0, 0, 0}, .color = {1, 0.5f, 0.25f}};
    Vec3 direction;
    double distance;
    Light spot = plain;
    spot.ops = &light_spotlight, spot.radius = 20, spot.falloff = 35, spot.tightness = 3;
    for (double angle = 1; angle < 180; angle += 2) {
        const Vec3 at = vec3(3 * sin(angle * PI / 180), 4 - 3 * cos(angle * PI / 180), 0);
        const double cosine = cos(angle * PI / 180), outer = cos(35 * PI / 180), inner = cos(20 * PI / 180);
        const double t = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);
        const double wanted = cosine > 0 ? PI * pow(cosine, 3) * t * t * (3 - 2 * t) : 0;
        const Rgb found = source_irradiance(&spot, at, spot.location, &direction, &distance);
        assert_true(fabs((double)found.r - wanted) < 1e-5 && fabs((double)found.g - wanted / 2) < 1e-5);
        assert_true(fabs(distance - 3) < 1e-12);
    }
    for (int power = 1; power < 4; power++)
        for (int k = 1; k < 6; k++) {
            Light fading = plain;
            fading.fade_power = power, fading.fade_distance = 2;
            const Rgb found = source_irradiance(&fading, vec3(0, 4 - k, 0), fading.location, &direction, &distance);
            assert_true(fabs((double)found.r - PI * 2 / (1 + pow(k / 2.0, power))) < 1e-5);
        }
    Light grid = plain;
    grid.area = 1, grid.size1 = 3, grid.size2 = 5, grid.axis1 = vec3(2, 0, 0), grid.axis2 = vec3(0, 0, 8);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 5; j++) {
            const Vec3 p = source_point(&grid, vec3(0, 0, 0), (float)((i + 0.5) / 3), (float)((j + 0.5) / 5));
            assert_true(fabs(p.x - (i - 1)) < 1e-6 && p.y == 4 && fabs(p.z - (2 * j - 4)) < 1e-6);
        }
}

/* The lit part of a line has all places that a spot or a cylinder shines at, and hardly another one. */
static void lit_parts_are_where_they_shine(void **state)
{
    (void)state;
    enum { PLACES = 400 };
    const double length = 12, step = length / PLACES;
    for (int kind = 0; kind < 2; kind++) {
        int lit = 0, exact = 0, nothing = 0;
        for (int k = 0; k < 3000; k++) {
            Light light = {.ops = kind ? &light_cylinder : &light_spotlight, .location = random_point(2)};
            light.color = rgb_grey(1);
            light.point_at = vec_add(light.location, random_direction());
            light.falloff = kind ? random_between(0.5, 2.5) : random_between(5, 85), light.radius = light.falloff / 2;
            Ray ray = {.origin = random_point(5), .direction = random_direction(), .tmin = 0.5};
            if (k % 10 == 0) /* along the axis */
                ray.direction = vec_normalize(vec_sub(light.point_at, light.location));
            double begin = -1, end = -1, first = INFINITY, last = -INFINITY;
            const int any = source_lit_part(&light, &ray, length, &begin, &end);
            for (int n = 0; n < PLACES; n++) {
                const double t = (n + 0.5) * step;
                const Vec3 at = vec_mad(ray.origin, ray.direction, ray.tmin + t);
                Vec3 direction;
                double distance;
                if (!(rgb_luminance(source_irradiance(&light, at, light.location, &direction, &distance)) > 0))
                    continue;
                first = fmin(first, t), last = t;
                if (!any || t < begin - 1e-9 || t > end + 1e-9)
                    fail_msg("%s %d shines at %g, not in %d: %g to %g", light.ops->name, k, t, any, begin, end);
            }
            if (any)
                assert_true(begin >= 0 && end <= length);
            lit += last >= first;
            exact += last >= first && begin > first - 1.01 * step && end < last + 1.01 * step;
            nothing += any && last < first;
        }
        printf("# %d of 3000 lines are lit, %d exactly, %d in vain\n", lit, exact, nothing);
        assert_true(lit > 250);
        assert_true(exact > (kind ? 0.7 : 0.98) * lit); /* a cylinder shines one way alone */
        assert_true(nothing < (kind ? lit : lit / 100));
    }
}

/* On a ray no place has more than the most, and one has as much. */
static void most_is_the_largest(void **state)
{
    (void)state;
    for (int k = 0; k < 500; k++) {
        Light light = {.ops = &light_point, .location = random_point(3), .color = {1, 0.5f, 0.25f}};
        if (k % 4)
            light.fade_power = 1 + k % 3, light.fade_distance = random_between(0.2, 3);
        const Ray ray = {.origin = random_point(5), .direction = random_direction(), .tmin = 0.5};
        const double length = 6, most = (double)source_most_irradiance(&light, &ray, length);
        double largest = 0;
        for (int n = 0; n <= 2000; n++) {
            const Vec3 at = vec_mad(ray.origin, ray.direction, ray.tmin + n * length / 2000);
            Vec3 direction;
            double distance;
            const Rgb rgb = source_irradiance(&light, at, light.location, &direction, &distance);
            largest = fmax(largest, (double)rgb_luminance(rgb));
        }
        if (!(largest <= most * 1.00001 && largest > 0.99 * most))
            fail_msg("light %d: the most is %g, not %g", k, most, largest);
    }
}

/* A sphere is met by rays that go through it, from outside, ahead. */
static void spheres_are_met_ahead(void **state)
{
    (void)state;
    int met = 0;
    for (int k = 0; k < 20000; k++) {
        const Light light = {.ops = &light_point, .location = random_point(1), .color = rgb_grey(1), .size = 0.5};
        const Ray ray = {.origin = random_point(1), .direction = random_direction()};
        const Vec3 to = vec_sub(light.location, ray.origin);
        const double along = vec_dot(to, ray.direction), d = vec_length(to);
        const double beside = vec_length(vec_mad(vec_neg(to), ray.direction, along));
        LightSample s;
        if (fabs(beside - light.size) < 1e-6 || fabs(d - light.size) < 1e-6)
            continue;
        const int wanted = along > 0 && beside < light.size && d > light.size;
        assert_int_equal(source_meet(&light, &ray, &s), wanted);
        if (wanted)
            assert_true(fabs((double)s.radiance.r * light.size * light.size / (d * d) - 1) < 1e-5);
        met += wanted;
    }
    assert_true(met > 500);
}

/* What callers take for granted of a row. */
static void rows_are_whole(void **state)
{
    static const LightOps *const rows[] = {
#define X(name) &light_##name,
        LIGHT_TABLE(X)
#undef X
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const LightOps *ops = rows[i];
        int yields = !ops->yields_to;
        assert_true(ops->shine && ops->meet);
        assert_true(!ops->cone || !(ops->properties & LIGHT_BEAM));
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            yields |= k != i && strcmp(ops->yields_to ? ops->yields_to : "", rows[k]->name) == 0;
            assert_true(k == i || strcmp(ops->name, rows[k]->name) != 0);
        }
        assert_true(yields);
    }
}

/* A row of a kind that nothing knows: it lights what is below it. */
static double half_space_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    return point_shine(light, position, place, direction, distance) > 0 && position.y < light->location.y ? 0.5 : 0;
}

static const LightOps half_space = {.name = "half_space", .shine = half_space_shine, .meet = point_meet};

/* It needs no more to be fading, chosen among few lights and many, sampled as a grid, and met. */
static void row_of_a_new_kind(void **state)
{
    (void)state;
    for (int others = 0; others <= 9; others += 9) {
        char text[400];
        snprintf(text, sizeof text,
                 "camera { look_at 3*z } light_source { 4*y, rgb <1, .5, .25> fade_distance 4 fade_power 2 }"
                 "#for(I,1,%d) light_source { <I,7,-3>, 1 } #end sphere { 0, .1 }",
                 others);
        Scene *scene = test_scene(text);
        Lights *lights;
        double sum[2] = {0, 0};
        enum { N = 4000 };
        scene->lights[0].ops = &half_space, scene->lights[0].lamp = 7;
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        for (int above = 0; above < 2; above++)
            for (int i = 0; i < N; i++) {
                const LightSampleContext p = {.position = vec3(0, 8.0 * above, 0)};
                LightSample s;
                const LightPick pick = lights_pick(lights, &p, (float)(i + 0.5) / N, 0.5f);
                if (!lights_sample(lights, &p, &pick, 0.5f, 0.5f, &s) || s.source != &scene->lights[0])
                    continue;
                assert_int_equal(s.lamp, 7);
                sum[above] += (double)(s.radiance.r / s.pick_probability) / N;
            }
        if (fabs(sum[0] - PI / 2) > 0.05 || sum[1] != 0) /* half of it; fading leaves 2 / (1 + 1) at 4 */
            fail_msg("%d others: %.3f below, %.3f above", others, sum[0], sum[1]);
        lights_close(&lights);
        scene_close(&scene);
    }
}

/* A light source that paths may meet gives what it gives as a point: rays over a cone that holds all of it. */
static void met_sources_give_their_irradiance(void **state)
{
    (void)state;
    const char *const texts[] = {
        "light_source { 4*y, rgb <1, .5, .25> retex { radius .3 } }",
        "light_source { 4*y, 1 fade_distance 2 fade_power 2 retex { radius .4 } }",
        "light_source { 4*y, 1 spotlight radius 30 falloff 60 point_at 0 retex { radius .3 } }",
        "light_source { 4*y, 1 parallel point_at <1, 0, 0> retex { radius .8 } }",
        "light_source { 4*y, 1 area_light x, 2*z, 5, 5 }",
        "light_source { 4*y, 1 area_light x, z, 5, 5 circular orient }",
        "light_source { 4*y, 1 area_light x, z, 5, 1 retex { radius .3 } }",
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "global_settings { photons { count 1 } } camera { look_at 3*z } %s"
                 "sphere { 2*y, .1 interior { ior 1.5 } photons { target refraction on } }",
                 texts[k]);
        Scene *scene = test_scene(text);
        const Light *light = &scene->lights[0];
        const Vec3 at = vec3(0.3, 0, -0.2);
        Vec3 axis, s, t;
        double distance, sum = 0, sine, cosine;
        const Rgb wanted = source_irradiance(light, at, light->location, &axis, &distance);
        enum { N = 1200 };
        const double less = 0.06; /* 1 - cos of the cone */
        vec_frame(axis, &s, &t);
        assert_true(light->caustics && light->size > 0);
        for (int i = 0; i < N * N; i++) {
            const double down = less * (i % N + 0.5) / N, across = sqrt(down * (2 - down));
            LightSample met;
            turn_sincos((float)(((double)(i / N) + 0.5) / N), &sine, &cosine);
            const Vec3 d = vec_mad(vec_mad(vec_scale(axis, 1 - down), s, across * cosine), t, across * sine);
            const Ray ray = {at, d, 0, INFINITY};
            if (source_meet(light, &ray, &met))
                sum += (double)met.radiance.r * (1 - down) * 2 * PI * less / N / N;
        }
        if (fabs(sum - (double)wanted.r) > 0.02 * (double)wanted.r)
            fail_msg("%s: %.5f, not %.5f", texts[k], sum, (double)wanted.r);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_shine_by_their_laws),
        cmocka_unit_test(lit_parts_are_where_they_shine),
        cmocka_unit_test(most_is_the_largest),
        cmocka_unit_test(spheres_are_met_ahead),
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(row_of_a_new_kind),
        cmocka_unit_test(met_sources_give_their_irradiance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
