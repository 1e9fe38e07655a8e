/* The julia_fractal: points within a ball about the origin whose iterates stay small, as POV-Ray's. Natural
 * parametrisation: longitude and latitude about the origin, as a sphere has them. There is no uv_mapping.
 *
 * Outside, an estimate of the distance to the set tells how far a ray may go, but it goes at least a step; inside it
 * goes by steps. Between a point outside and one inside, halving finds the crossing. The points are the same for each
 * tmin, so that crossings are. */
#include "shape/julia_fractal.h"
#include "shape/shape.h"

typedef struct Quad {
    double v[4];
} Quad;

/* ---- iteration ---- */

static Quad quad_of(const JuliaFractal *f, Vec3 p)
{
    const double w = (f->distance - f->slice[0] * p.x - f->slice[1] * p.y - f->slice[2] * p.z) / f->slice[3];

    return (Quad){{p.x, p.y, p.z, w}};
}

static double norm_of(Quad z)
{
    return z.v[0] * z.v[0] + z.v[1] * z.v[1] + z.v[2] * z.v[2] + z.v[3] * z.v[3];
}

static double complex applied(const JuliaFractal *f, double complex z)
{
    const double complex exponent = f->exponent[0] + f->exponent[1] * I;

    switch (f->function) {
#define X(name, value)                                                                                                 \
    case JULIA_##name:                                                                                                 \
        return value;
        JULIA_FUNCTIONS(X)
#undef X
    }
    (void)exponent;
    return 0;
}

static Quad hypercomplex_square(Quad z)
{
    const double ar = z.v[0] - z.v[3], ai = z.v[1] + z.v[2], br = z.v[0] + z.v[3], bi = z.v[1] - z.v[2];
    const double a = ar * ar - ai * ai, b = br * br - bi * bi;

    return (Quad){{0.5 * (a + b), ar * ai + br * bi, ar * ai - br * bi, 0.5 * (b - a)}};
}

static Quad hypercomplex_function(const JuliaFractal *f, Quad z)
{
    if (f->function == JULIA_sqr || f->function == JULIA_cube)
        return hypercomplex_square(z);
    const double complex a = applied(f, z.v[0] - z.v[3] + (z.v[1] + z.v[2]) * I);
    const double complex b = applied(f, z.v[0] + z.v[3] + (z.v[1] - z.v[2]) * I);

    return (Quad){{0.5 * (creal(a) + creal(b)), 0.5 * (cimag(a) + cimag(b)), 0.5 * (cimag(a) - cimag(b)),
                   0.5 * (creal(b) - creal(a))}};
}

/* A power of a quaternion, here its square or cube, keeps the direction of its imaginary part. norm: norm_of(z). */
static inline Quad quaternion_power(int square, Quad z, double norm)
{
    const double r = z.v[0], rr = r * r, ii = norm - rr;
    const double real = square ? rr - ii : r * (rr - 3 * ii);
    const double imaginary = square ? 2 * r : 3 * rr - ii;

    return (Quad){{real, imaginary * z.v[1], imaginary * z.v[2], imaginary * z.v[3]}};
}

static inline Quad plus_constant(const JuliaFractal *f, Quad z)
{
    for (int k = 0; k < 4; k++)
        z.v[k] += f->constant[k];
    return z;
}

static Quad next_iterate(const JuliaFractal *f, Quad z)
{
    return plus_constant(f, f->hypercomplex ? hypercomplex_function(f, z)
                                            : quaternion_power(f->function == JULIA_sqr, z, norm_of(z)));
}

/* How much an iterate moves with the one before, at most, squared. */
static double growth(const JuliaFractal *f, Quad z, double norm)
{
    switch (f->function) {
    case JULIA_sqr:
        return 4 * norm;
    case JULIA_cube:
        return f->hypercomplex ? 4 * norm : 9 * norm * norm;
    default: {
        const double r = sqrt(norm);
        const double h = 1e-6 * (1 + r);
        Quad moved = z;
        double most = 0;
        for (int k = 0; k < 2; k++) {
            moved.v[0] = z.v[0] + h * (1 - k), moved.v[3] = z.v[3] + h * k;
            const Quad a = hypercomplex_function(f, z), b = hypercomplex_function(f, moved);
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += (b.v[i] - a.v[i]) * (b.v[i] - a.v[i]);
            most = fmax(most, sum / (h * h));
        }
        return most;
    }
    }
}

/* The most that iterate k may be for the last one to be small. A power of a quaternion has the power of its size;
 * products of hypercomplex numbers may be smaller than their factors. */
static double most_of(const JuliaFractal *f, int k)
{
    double most = sqrt(f->limit);

    for (; !f->hypercomplex && k < f->iterations; k++) {
        const double power =
            most + sqrt(norm_of((Quad){{f->constant[0], f->constant[1], f->constant[2], f->constant[3]}}));
        most = f->function == JULIA_sqr ? sqrt(power) : cbrt(power);
    }
    return most;
}

/* How far away the set is where iterate k is not small: half the estimate for powers iterated for ever, |z| log |z| /
 * |dz|. The set of a few iterations is larger, and other functions grow otherwise: then no more than by how much the
 * iterate is too large. slope: of that iterate, squared. */
static double distance_estimate(const JuliaFractal *f, int k, double size, double slope)
{
    enum { FEW = 4 };
    const double estimate = 0.25 * log(size) * sqrt(size / slope);
    const int is_power = f->function == JULIA_sqr || f->function == JULIA_cube;

    if (!isfinite(size))
        return 0;
    if (is_power && f->iterations - k >= FEW)
        return estimate;
    return fmin(estimate, (sqrt(size) - most_of(f, k)) / sqrt(slope));
}

/* The first iterate that is not small, from 1 on; 0: all are. *distance: about how far away the set is. Compiled twice,
 * for most of the time goes into squares of quaternions. */
static inline int escape_of(const JuliaFractal *f, int is_square, Vec3 p, double *distance)
{
    Quad z = quad_of(f, p);
    double slope = 1; /* squared */

    for (int k = 1;; k++) {
        const double size = norm_of(z);
        if (!(size <= f->limit)) {
            if (distance)
                *distance = distance_estimate(f, k, size, slope);
            return k;
        }
        if (k == f->iterations)
            return 0;
        if (distance)
            slope *= is_square ? 4 * size : growth(f, z, size);
        z = is_square ? plus_constant(f, quaternion_power(1, z, size)) : next_iterate(f, z);
    }
}

static int escape(const JuliaFractal *f, Vec3 p, double *distance)
{
    return f->function == JULIA_sqr && !f->hypercomplex ? escape_of(f, 1, p, distance) : escape_of(f, 0, p, distance);
}

static double size_after(const JuliaFractal *f, Vec3 p, int k)
{
    Quad z = quad_of(f, p);

    for (int i = 1; i < k; i++)
        z = next_iterate(f, z);
    return norm_of(z);
}

/* ---- along a ray ---- */

static int is_in(const JuliaFractal *f, const ShapeLine *line, double s, double *distance)
{
    return escape(f, vec_mad(line->origin, line->direction, s), distance) == 0;
}

/* Between low and high the state changes. */
static double halved(const JuliaFractal *f, const ShapeLine *line, double low, double high, int low_is_in)
{
    for (int i = 0; i < 60 && high - low > 1e-11 * f->radius; i++) {
        const double middle = 0.5 * (low + high);
        if (is_in(f, line, middle, NULL) == low_is_in)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const JuliaFractal *f = primitive->shape.data;
    const ShapeLine line = shape_line(ray, vec3(0, 0, 0));
    const double reach = f->radius * f->radius - vec_dot(line.origin, line.origin);
    double s, end, distance;
    int in;

    (void)face;
    if (!(reach > 0))
        return 0;
    end = sqrt(reach);
    s = fmax(-end, shape_line_start(&line, ray));
    if (!(s < end))
        return 0;
    in = is_in(f, &line, s, &distance);
    /* What reaches the ball ends there. */
    if (in && s == -end && shape_accept(ray, shape_line_t(&line, s), t))
        return 1;
    while (s < end) {
        const double next = fmin(end, s + (in ? f->step : fmax(distance, f->step)));
        const int then = is_in(f, &line, next, &distance);
        if (then != in && shape_accept(ray, shape_line_t(&line, halved(f, &line, s, next, in)), t))
            return 1;
        in = then;
        s = next;
    }
    return in && shape_accept(ray, shape_line_t(&line, end), t);
}

static int inside(const Shape *shape, Vec3 p)
{
    const JuliaFractal *f = shape->data;

    return vec_dot(p, p) <= f->radius * f->radius && escape(f, p, NULL) == 0;
}

/* The iterate that is about as large as it may be, and by how much it moves there; *last: how much the one after the
 * last does. */
static int iterate_at_limit(const JuliaFractal *f, Vec3 p, double *slope, double *last)
{
    Quad z = quad_of(f, p);
    double moved = 1, best = INFINITY;
    int found = 1;

    for (int k = 1; k <= f->iterations; k++) {
        const double off = fabs(norm_of(z) / f->limit - 1) / moved;
        if (!isfinite(off))
            break;
        if (off < best) {
            best = off;
            found = k;
            *slope = moved;
        }
        moved *= fmax(sqrt(growth(f, z, norm_of(z))), 1e-3);
        z = next_iterate(f, z);
    }
    *last = moved;
    return found;
}

/* Where the size of an iterate grows; 0 where that cannot be told. slope: by how much the iterate moves there. */
static Vec3 size_gradient(const JuliaFractal *f, Vec3 p, int k, double slope)
{
    const double h = 1e-4 / fmax(slope, 1e-2);
    double change[3];

    for (int i = 0; i < 3; i++) {
        const Vec3 step = vec3(h * (i == 0), h * (i == 1), h * (i == 2));
        change[i] = size_after(f, vec_add(p, step), k) - size_after(f, vec_sub(p, step), k);
    }
    const Vec3 gradient = vec_normalize(vec3(change[0], change[1], change[2]));
    return vec_length(gradient) > 0.5 ? gradient : vec3(0, 0, 0);
}

/* The surface is where the largest iterate has the limit's size. POV-Ray shades with that of the iterate after the last
 * one, which is finer. */
static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const JuliaFractal *f = primitive->shape.data;
    double slope = 1, last;

    (void)face;
    out->p = out->normal = p;
    if (vec_length(p) > f->radius * (1 - 1e-9))
        return;
    const int k = iterate_at_limit(f, p, &slope, &last);
    const Vec3 gradient = size_gradient(f, p, k, slope);
    if (vec_length(gradient) > 0.5)
        out->normal = gradient;
    const Vec3 finer = size_gradient(f, p, f->iterations + 1, last);
    if (vec_dot(finer, out->normal) > 0)
        out->shading_normal = finer;
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const JuliaFractal *f = primitive->shape.data;

    shape_bound_circle(low, high, &primitive->transform, vec3(0, 0, 0), 0, 1, 0, f->radius);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    out->natural = shape_angles(shape_local_point(surface));
}

const ShapeOps shape_julia_fractal = {
    .name = "julia_fractal",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
};
