/* Checks of a shape's operations: marching along rays with bisection, and sides of the surface. */
#include <math.h>
#include "lib_implicit.h"
#include "shape/surface.h"

enum { STEPS = 3000, MOST = 128 };

static double between(uint32_t *state, double low, double high)
{
    return low + (high - low) * test_random(state);
}

static Vec3 direction(uint32_t *state)
{
    double z = between(state, -1, 1), angle = between(state, 0, 2 * PI), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

Transform test_shape_transform(uint32_t *state, double size, double shift, int even)
{
    double s = size * between(state, 0.5, 2);
    Vec3 factor =
        even ? vec3(s, s, s)
             : vec3(size * between(state, 0.3, 3), -size * between(state, 0.3, 3), size * between(state, 0.3, 3));
    Transform t = transform_then(transform_scale(factor), transform_rotate(vec_scale(direction(state), 180)));

    return transform_then(t, transform_translate(vec_scale(direction(state), shift)));
}

static int is_inside(const TestShape *shape, Vec3 p)
{
    return shape->f(&shape->primitive, p) < 0;
}

static Surface surface_of(const Primitive *p, const Ray *ray, double t, int face)
{
    Scene scene = {.primitives = (Primitive *)p, .nprimitives = 1};
    Hit hit = {.t = t, .face = face};
    Surface s;

    surface_at(&s, &scene, ray, &hit);
    return s;
}

static int all_crossings(const Primitive *p, Ray ray, double *t, int *faces)
{
    int count = 0;

    while (shape_intersect(p, &ray, &t[count], &faces[count])) {
        assert_true(t[count] > ray.tmin);
        ray.tmin = t[count++];
        assert_true(count < MOST);
    }
    return count;
}

/* Where the ray enters or leaves, by bisection. */
static double bisected(const TestShape *shape, Vec3 o, Vec3 d, double a, double b)
{
    int before = is_inside(shape, vec_mad(o, d, a));

    for (int i = 0; i < 60; i++) {
        double m = 0.5 * (a + b);
        if (is_inside(shape, vec_mad(o, d, m)) == before)
            a = m;
        else
            b = m;
    }
    return 0.5 * (a + b);
}

/* Point, normal and sides of one crossing; world is the length of a canonical unit. */
static void check_crossing(const TestShape *shape, const Ray *ray, double t, int face, double world, double tolerance)
{
    const Primitive *p = &shape->primitive;
    const Surface s = surface_of(p, ray, t, face);
    const Vec3 at = vec_mad(ray->origin, ray->direction, t);
    double off = 1e-5 * shape->size * world;
    Vec3 low, high;

    assert_true(vec_length(vec_sub(s.position, at)) <= tolerance);
    assert_true(fabs(vec_length(s.geometric_normal) - 1) < 1e-9);
    assert_int_equal(s.backside, vec_dot(ray->direction, s.geometric_normal) > 0);
    if (shape_bounds(p, &low, &high))
        for (int k = 0; k < 3; k++) {
            double x = k == 0   ? at.x
                       : k == 1 ? at.y
                                : at.z,
                   a = k == 0   ? low.x
                       : k == 1 ? low.y
                                : low.z,
                   b = k == 0   ? high.x
                       : k == 1 ? high.y
                                : high.z;
            assert_true(x >= a - tolerance && x <= b + tolerance);
        }
    if (shape->open)
        return;
    /* Outside along the normal, inside against it; nearer by where another part of the surface is near. */
    Vec3 out, in;
    for (int i = 0; i < 3; i++, off /= 30) {
        out = transform_inverse_point(&p->transform, vec_mad(s.position, s.geometric_normal, off));
        in = transform_inverse_point(&p->transform, vec_mad(s.position, s.geometric_normal, -off));
        if (is_inside(shape, out) != is_inside(shape, in))
            break;
    }
    assert_true(!is_inside(shape, out) && is_inside(shape, in));
}

static void check_ray(const TestShape *shape, const Ray *ray, double world, int *crossings)
{
    const Primitive *p = &shape->primitive;
    const Vec3 o = transform_inverse_point(&p->transform, ray->origin),
               d = transform_inverse_vector(&p->transform, ray->direction), centre = shape->centre;
    const double speed = vec_length(d), nearest = vec_dot(vec_sub(centre, o), d) / (speed * speed),
                 reach = 2.5 * shape->size / speed, begin = fmax(nearest - reach, 0), end = nearest + reach;
    const double tolerance = 2e-9 * shape->size * world + 1e-14 * vec_length(ray->origin);
    double t[MOST];
    int faces[MOST], count = all_crossings(p, *ray, t, faces), next = 0;

    *crossings += count;
    for (int i = 0; i < count; i++)
        if (t[i] < end)
            check_crossing(shape, ray, t[i], faces[i], world, tolerance);
    if (shape->open || end <= begin)
        return;
    /* Between crossings the sides alternate, and inside() has the same ones. */
    for (int i = 0; i <= count; i++) {
        double a = i > 0 ? t[i - 1] : 0, b = i < count ? t[i] : fmax(end, a + reach);
        Vec3 middle = vec_mad(o, d, 0.5 * (a + b));
        int in = is_inside(shape, middle);
        if ((b - a) * speed < 1e-4 * shape->size || b > end)
            continue;
        assert_int_equal(p->shape.ops->inside(&p->shape, middle) != 0, in);
        assert_int_equal(in, (is_inside(shape, o) + i) % 2);
    }
    /* Every change of sides that marching meets is a crossing. */
    int before = is_inside(shape, vec_mad(o, d, begin));
    while (next < count && t[next] <= begin)
        next++;
    for (int i = 1; i <= STEPS; i++) {
        double a = begin + (end - begin) * (i - 1) / STEPS, b = begin + (end - begin) * i / STEPS;
        int now = is_inside(shape, vec_mad(o, d, b));
        if (now != before) {
            double at = bisected(shape, o, d, a, b), nearest_one = INFINITY;
            for (int k = 0; k < count; k++)
                nearest_one = fmin(nearest_one, fabs(t[k] - at));
            assert_true(nearest_one * speed <= 1e-6 * shape->size + tolerance / world);
        }
        before = now;
    }
}

/* The length in the world of a canonical unit. */
static double unit_of(const Transform *t)
{
    double longest = 0;

    for (int k = 0; k < 3; k++)
        longest = fmax(longest, vec_length(shape_axis(t, k)));
    return longest;
}

static Ray random_ray(const TestShape *shape, double world, uint32_t *state)
{
    const double size = shape->size * world, far[4] = {0.3, 1.5, 4, 300};
    Vec3 centre = transform_point(&shape->primitive.transform, shape->centre);
    Ray ray = {vec_mad(centre, direction(state), size * far[(int)(4 * test_random(state))] * test_random(state)),
               direction(state), 0, INFINITY};
    Vec3 aim = transform_point(&shape->primitive.transform,
                               vec_mad(shape->centre, direction(state), shape->size * sqrt(test_random(state))));

    ray.direction = vec_normalize(vec_sub(aim, ray.origin));
    /* Along an axis of the shape, as cameras often look. */
    if (test_random(state) < 0.2)
        ray.direction = vec_normalize(shape_axis(&shape->primitive.transform, (int)(3 * test_random(state))));
    return ray;
}

int test_shape_crossings(const TestShape *shape, int rays, uint32_t *state)
{
    double world = unit_of(&shape->primitive.transform);
    int crossings = 0;

    for (int i = 0; i < rays; i++) {
        Ray ray = random_ray(shape, world, state);
        check_ray(shape, &ray, world, &crossings);
    }
    return crossings;
}

void test_shape_departures(const TestShape *shape, int rays, uint32_t *state)
{
    const Primitive *p = &shape->primitive;
    const double world = unit_of(&p->transform), size = shape->size * world;
    int began = 0;

    for (int i = 0; i < rays; i++) {
        Ray ray = random_ray(shape, world, state);
        double t, slope = pow(10, -6 * test_random(state)), angle = 2 * PI * test_random(state);
        int face, out = test_random(state) < 0.5;
        Vec3 e, f;
        if (!shape_intersect(p, &ray, &t, &face) || t > 1000 * size)
            continue;
        Surface s = surface_of(p, &ray, t, face);
        vec_frame(s.geometric_normal, &e, &f);
        ray.origin = s.position;
        ray.direction = vec_add(vec_scale(e, cos(angle)), vec_scale(f, sin(angle)));
        ray.direction = vec_normalize(vec_mad(ray.direction, s.geometric_normal, out ? slope : -slope));
        if (!shape_intersect(p, &ray, &t, &face))
            continue;
        began++;
        assert_true(t > 1e-4 * slope * size);
        if (shape->open || slope < 1e-4)
            continue;
        /* Half way there the ray is on the side to which it left. */
        Vec3 middle = transform_inverse_point(&p->transform, vec_mad(ray.origin, ray.direction, 0.5 * t));
        if (t > 1e-3 * size)
            assert_int_equal(is_inside(shape, middle), !out);
    }
    assert_true(began >= rays / 20);
}

void test_shape_at_all_sizes(TestShape shape, int rays, uint32_t *state)
{
    const double sizes[] = {1, 1e-4, 1e-2, 1e2, 1e5};

    for (int i = 0; i < 10; i++) {
        double size = sizes[i % 5];
        shape.primitive.transform = test_shape_transform(state, size / shape.size, size * (i < 5 ? 1 : 30), i & 1);
        assert_true(test_shape_crossings(&shape, rays, state) > rays / 4);
        test_shape_departures(&shape, rays, state);
    }
}
