/* Checks that hold for every closed shape: what a ray crosses, one crossing after the other as CSG asks for them, is
 * compared with inside() in many points along the ray. */
#ifndef LIB_SHAPE_H
#define LIB_SHAPE_H

#include "lib_test.h"

#include <cmocka.h>
#include <math.h>

#include "shape/shape.h"
#include "shape/surface.h"

enum { TEST_CROSSINGS = 1024, TEST_SAMPLES = 400 };

typedef struct TestCrossing {
    double t;
    int face;
} TestCrossing;

static inline Vec3 test_direction(uint32_t *state)
{
    const double z = 2 * test_random(state) - 1, angle = 2 * PI * test_random(state), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

static inline int test_inside(const Primitive *p, Vec3 at)
{
    return p->shape.ops->inside(&p->shape, transform_inverse_point(&p->transform, at));
}

/* inside() is the same all around, so that rounding does not decide it. */
static inline int test_is_clear(const Primitive *p, Vec3 at, double step)
{
    const int here = test_inside(p, at);

    for (int i = 0; i < 6; i++) {
        const double s = i & 1 ? step : -step;
        if (test_inside(p, vec_add(at, vec3(i / 2 == 0 ? s : 0, i / 2 == 1 ? s : 0, i / 2 == 2 ? s : 0))) != here)
            return 0;
    }
    return 1;
}

/* All crossings of the ray, each asked for from the one before. */
static inline int test_all_crossings(const Primitive *p, Ray ray, TestCrossing *list)
{
    int count = 0;

    for (TestCrossing one; shape_intersect(p, &ray, &one.t, &one.face); ray.tmin = one.t) {
        assert_true(count < TEST_CROSSINGS);
        assert_true(one.t > ray.tmin && one.t < ray.tmax);
        list[count++] = one;
    }
    return count;
}

/* The normal points outward: against the ray where it enters. */
static inline void test_normals(const Primitive *p, const Ray *ray, const TestCrossing *list, int count, int inside,
                                double size)
{
    const Scene scene = {.primitives = (Primitive *)p, .nprimitives = 1};

    for (int i = 0; i < count; i++) {
        const Hit hit = {.t = list[i].t, .face = list[i].face};
        Surface s;
        surface_at(&s, &scene, ray, &hit);
        const double fall = vec_dot(s.geometric_normal, ray->direction), far = size + vec_length(ray->origin);
        const double moved = vec_length(vec_sub(s.position, vec_mad(ray->origin, ray->direction, hit.t)));
        if (!(moved < 1e-7 * far))
            fail_msg("point %g away from where the ray is", moved);
        if (fabs(vec_length(s.geometric_normal) - 1) > 1e-9)
            fail_msg("a normal of length %g", vec_length(s.geometric_normal));
        if (fabs(fall) > 1e-3 && (fall > 0) != (inside ^ (i & 1)) &&
            (i == 0 || list[i].t - list[i - 1].t > 1e-6 * far) &&
            (i + 1 == count || list[i + 1].t - list[i].t > 1e-6 * far))
            fail_msg("normal at crossing %d of %d: cosine %g", i, count, fall);
    }
}

/* Rays from near, from within and from far away, through a shape of that size about centre; some along an axis of the
 * shape. step: what inside() may be off by, in sizes. Returns the number of crossings. */
static inline int test_shape_crossings(const Primitive *p, Vec3 centre, double size, int rays, double step,
                                       uint32_t *state)
{
    int all = 0;

    for (int i = 0; i < rays; i++) {
        TestCrossing list[TEST_CROSSINGS];
        const double away = size * (i % 3 == 0 ? test_random(state) : i % 3 == 1 ? 3 : 1000);
        const double aside = 0.7 * size * test_random(state); /* first, by every compiler */
        const Vec3 aim = vec_mad(centre, test_direction(state), aside);
        Ray ray = {.tmin = 0, .tmax = INFINITY};
        ray.direction = test_direction(state);
        if (i % 10 < 3) {
            const double sign = test_random(state) < 0.5 ? -1 : 1;
            const int k = i % 10;
            ray.direction =
                vec_normalize(transform_vector(&p->transform, vec3(sign * (k == 0), sign * (k == 1), sign * (k == 2))));
        }
        ray.origin = vec_mad(aim, ray.direction, -away);
        const int count = test_all_crossings(p, ray, list), inside = test_inside(p, ray.origin);
        const double doubt = step * size + 1e-12 * (away + vec_length(centre));
        if (!test_is_clear(p, ray.origin, doubt))
            continue;
        if ((inside + count) % 2 != 0)
            fail_msg("ray %d ends inside: %d crossings, inside %d", i, count, inside);
        for (int k = 0; k < TEST_SAMPLES; k++) {
            const double t = fmax(away - 2 * size, 0) + 4 * size * (k + test_random(state)) / TEST_SAMPLES;
            const Vec3 at = vec_mad(ray.origin, ray.direction, t);
            int before = 0;
            while (before < count && list[before].t < t)
                before++;
            if (test_inside(p, at) != ((inside + before) & 1) && test_is_clear(p, at, doubt))
                fail_msg("ray %d at %.17g: inside() is %d after %d of %d crossings, origin %d", i, t,
                         test_inside(p, at), before, count, inside);
        }
        test_normals(p, &ray, list, count, inside, size);
        all += count;
    }
    return all;
}

#endif
