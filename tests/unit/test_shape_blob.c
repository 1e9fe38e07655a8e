/* blob: inside() against POV-Ray's formula written out, crossings against inside(), normals against differences of the
 * formula, and the shares of textures that are blended. */
#include "lib_scene_text.h"
#include "lib_shape.h"
#include "shape/blob.h"
#include "shape/surface.h"

#include <stdio.h>
#include <string.h>

/* Random balls and cylinders, as text and as numbers. */
typedef struct Part {
    Vec3 from, to;
    double radius, strength;
} Part;

static uint32_t state = 5;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}

static Part random_part(int i)
{
    Part p = {.from = vec3(between(-1, 1), between(-1, 1), between(-1, 1)), .radius = between(0.2, 0.9)};
    p.to = i % 3 == 2 ? vec3(between(-1, 1), between(-1, 1), between(-1, 1)) : p.from;
    if (i % 6 == 5) /* along an axis */
        p.to = vec3(p.from.x, p.from.y, p.from.z + 1);
    p.strength = i % 4 == 3 ? -between(0.3, 1) : between(0.4, 2);
    return p;
}

static void describe(char *text, size_t size, const Part *parts, int count, double threshold, const char *after)
{
    int used = snprintf(text, size, V37 "blob{threshold %.17g ", threshold);
    for (int i = 0; i < count; i++) {
        const Part *p = &parts[i];
        used += snprintf(text + used, size - (size_t)used, "%s{<%.17g,%.17g,%.17g>,",
                         i % 3 == 2 ? "cylinder" : "sphere", p->from.x, p->from.y, p->from.z);
        if (i % 3 == 2)
            used += snprintf(text + used, size - (size_t)used, "<%.17g,%.17g,%.17g>,", p->to.x, p->to.y, p->to.z);
        used += snprintf(text + used, size - (size_t)used, "%.17g,%s %.17g}", p->radius, i % 2 ? "strength" : "",
                         p->strength);
    }
    snprintf(text + used, size - (size_t)used, "%s}", after);
}

/* The manual's: density = strength (1 - (distance / radius)^2)^2, of a cylinder by the distance from its axis. */
static double formula(const Part *parts, int count, Vec3 p)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const Vec3 axis = vec_sub(parts[i].to, parts[i].from), away = vec_sub(p, parts[i].from);
        const double length2 = vec_dot(axis, axis);
        const double along = length2 > 0 ? fmin(fmax(vec_dot(away, axis) / length2, 0), 1) : 0;
        const double d = vec_length(vec_mad(away, axis, -along)) / parts[i].radius;
        if (d < 1)
            sum += parts[i].strength * (1 - d * d) * (1 - d * d);
    }
    return sum;
}

static void test_inside_and_normals(void **unused)
{
    (void)unused;
    int checked = 0;
    for (int k = 0; k < 20; k++) {
        Part parts[12];
        char text[6000];
        const int count = 1 + k % 12;
        for (int i = 0; i < count; i++)
            parts[i] = random_part(i);
        describe(text, sizeof text, parts, count, 0.4, "");
        Scene *scene = parse(text);
        const Primitive *p = only(scene);
        Vec3 low, high;
        assert_true(shape_bounds(p, &low, &high));
        for (int i = 0; i < 3000; i++) {
            const Vec3 at = vec3(between(-2, 2), between(-2, 2), between(-2, 2));
            const double f = formula(parts, count, at);
            if (fabs(f - 0.4) < 1e-9)
                continue;
            assert_int_equal(test_inside(p, at), f > 0.4);
            if (f > 0.4)
                assert_true(at.x > low.x && at.y > low.y && at.z > low.z && at.x < high.x && at.y < high.y &&
                            at.z < high.z);
        }
        for (int i = 0; i < 200; i++) {
            const Vec3 d = test_direction(&state);
            const Ray ray = {vec_mad(vec3(between(-1, 1), between(-1, 1), between(-1, 1)), d, -4), d, 0, 100};
            Hit hit = {.primitive = 0};
            Surface s;
            Vec3 slope;
            if (!shape_intersect(p, &ray, &hit.t, &hit.face))
                continue;
            surface_at(&s, scene, &ray, &hit);
            for (int axis = 0; axis < 3; axis++) {
                const double h = 1e-6;
                const Vec3 step = vec3(h * (axis == 0), h * (axis == 1), h * (axis == 2));
                ((double *)&slope)[axis] = (formula(parts, count, vec_add(s.position, step)) -
                                            formula(parts, count, vec_sub(s.position, step))) /
                                           (2 * h);
            }
            if (vec_length(slope) < 1e-3)
                continue;
            assert_true(fabs(formula(parts, count, s.position) - 0.4) < 1e-9);
            assert_true(vec_length(vec_add(s.geometric_normal, vec_normalize(slope))) < 1e-5);
            checked++;
        }
        scene_close(&scene);
    }
    assert_true(checked > 500);
}

static void test_crossings(void **unused)
{
    static const double scales[] = {1e-4, 1, 1e5};
    (void)unused;
    for (int s = 0; s < 3; s++)
        for (int k = 0; k < 8; k++) {
            Part parts[12];
            char text[6000], after[100];
            for (int i = 0; i < 12; i++)
                parts[i] = random_part(i);
            snprintf(after, sizeof after, "scale %g*<1,1,%g> rotate 40 translate %g*x", scales[s], k % 2 ? 1.0 : 0.3,
                     k == 1 ? 30 * scales[s] : 0);
            describe(text, sizeof text, parts, 4 + k, 0.4, after);
            Scene *scene = parse(text);
            const Primitive *p = only(scene);
            const Vec3 centre = transform_point(&p->transform, vec3(0, 0, 0));
            test_shape_crossings(p, centre, 1.5 * scales[s], 300, 1e-9, &state);
            scene_close(&scene);
        }
}

/* More pieces on a ray than are worked on at once. */
static void test_many_components(void **unused)
{
    char text[9000];
    int used = snprintf(text, sizeof text, V37 "blob{threshold .5 ");
    TestCrossing list[TEST_CROSSINGS];
    (void)unused;
    for (int i = 0; i < 300; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "sphere{<%d,0,0>,.4,1}", i);
    snprintf(text + used, sizeof text - (size_t)used, "}");
    Scene *scene = parse(text);
    const double half = 0.4 * sqrt(1 - sqrt(0.5));
    const int count = test_all_crossings(only(scene), (Ray){vec3(-5, 0, 0), vec3(1, 0, 0), 0, INFINITY}, list);
    assert_int_equal(count, 600);
    for (int i = 0; i < count; i++)
        assert_true(fabs(list[i].t - (5 + i / 2 + (i % 2 ? half : -half))) < 1e-12);
    scene_close(&scene);
}

static void test_textures(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "blob{threshold .5 sphere{0,1,1 pigment{rgb <1,0,0>} scale <1,2,1>} sphere{.6*x,1,1}"
                             " sphere{9*x,1,.7 texture{pigment{rgb <0,0,1>}}} pigment{rgb <0,1,0>} translate 5*z}");
    const Primitive *p = only(scene);
    Surface s = {.primitive = p};
    int of_own = 0;
    (void)unused;
    assert_int_equal(p->shape.textures->count, 2);
    for (int i = 0; i < 20000; i++) {
        s.position = vec3(.2 + 1e-9 * i, 0, 5);
        const int which = p->shape.ops->texture(&s);
        assert_true(which < 1);
        of_own += which < 0;
    }
    /* densities (1 - .04)^2 and (1 - .16)^2 */
    assert_true(fabs(of_own / 20000.0 - .7056 / (.7056 + .9216)) < 0.015);
    s.position = vec3(9, .1, 5);
    assert_int_equal(p->shape.ops->texture(&s), 1);
    assert_color(p->shape.textures->list[1]->pigment->color, 0, 0, 1);
    scene_close(&scene);
}

static void test_forms(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "blob{component 1.0, 2.0, <1,2,3> component -1 1 <0,0,0> threshold .6 sturm}");
    const Blob *blob = only(scene)->shape.data;
    assert_int_equal(blob->ncomponents, 2);
    assert_near(blob->threshold, .6);
    assert_near(blob->components[1].strength, -1);
    assert_vec(blob->low, -1, 0, 1); /* of what adds */
    assert_vec(blob->high, 3, 4, 5);
    scene_close(&scene);
    scene = parse(V37 "blob{threshold 1} blob{threshold 0 sphere{0,1,1}}");
    assert_int_equal(scene->nprimitives, 0);
    assert_non_null(strstr(messages, "a blob without components"));
    assert_non_null(strstr(messages, "a blob whose threshold is not above 0"));
    scene_close(&scene);
    expect_error(V37 "blob{sphere{0,0,1}}", "a blob's component of radius 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inside_and_normals),
        cmocka_unit_test(test_crossings),
        cmocka_unit_test(test_many_components),
        cmocka_unit_test(test_textures),
        cmocka_unit_test(test_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
