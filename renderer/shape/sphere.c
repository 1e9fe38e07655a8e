/* The unit sphere about the origin. Natural parametrisation: POV-Ray's uv, u around y from +x towards +z (.75 at -z), v
 * from the lower pole to the upper. */
#include "shape/shape.h"

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    shape_bound_circle(low, high, &primitive->transform, vec3(0, 0, 0), 0, 1, 0, 1);
}

/* A ray that starts on the surface must not hit it at its start. The surface's equation decides: where its value at the
 * start is within rounding of 0, one root is 0 and is dropped. To compare t with a small number instead fails at
 * grazing angles, where a rounding error of the equation moves the root by far more. Plane, disc and cone do so too. */
static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    Vec3 o = ray->origin, d = ray->direction;
    double dd = vec_dot(d, d), b = vec_dot(o, d), oo = vec_dot(o, o), c = oo - 1, nearest = -b / dd, half;
    Vec3 closest = vec_mad(o, d, nearest);

    (void)primitive, (void)face;
    if (fabs(c) <= ray->slack * (2 + oo))
        return shape_accept(ray, 2 * nearest, t);
    /* From the point of closest approach: exact however far away the ray begins. */
    half = (1 - vec_dot(closest, closest)) / dd;
    if (!(half >= 0))
        return 0;
    half = sqrt(half);
    return shape_accept(ray, nearest - half, t) || shape_accept(ray, nearest + half, t);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    (void)primitive, (void)face;
    out->p = out->normal = vec_normalize(p);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    Vec3 p = shape_local_point(surface);
    double rho = hypot(p.x, p.z);

    out->uv.u = rho > 0 ? shape_turn(p.x, p.z) : 0;
    out->uv.v = 0.5 + atan2(p.y, rho) / PI;
    out->natural = out->uv;
    out->has_uv = !surface->primitive->shape.data; /* that of an ellipsoid by its equation has none in POV-Ray */
}

static void extent(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out)
{
    (void)primitive, (void)face;
    out->lengths[0] = shape_circumference(1, axes[0], axes[2]);
    out->lengths[1] = (shape_circumference(1, axes[0], axes[1]) + shape_circumference(1, axes[2], axes[1])) / 4;
}

static int inside(const Shape *shape, Vec3 p)
{
    (void)shape;
    return vec_dot(p, p) < 1;
}

/* ---- sampling ---- */

/* World area of a unit of the unit sphere's area at p. */
static double stretch(const Transform *t, Vec3 p)
{
    double scale = shape_similarity(t);
    Vec3 e, f;

    if (scale > 0)
        return scale * scale;
    vec_frame(p, &e, &f);
    return shape_stretch(t, e, f);
}

static double area(const Primitive *primitive)
{
    const Transform *t = &primitive->transform;
    double scale = shape_similarity(t), sum = 0;
    const int rows = 64, turns = 64;

    if (scale > 0)
        return 4 * PI * scale * scale;
    /* Equal areas of the unit sphere; good to about 1e-4 for axes up to 10 : 1. */
    for (int i = 0; i < rows; i++) {
        double z = 2 * (i + 0.5) / rows - 1, rho = sqrt(1 - z * z);
        for (int j = 0; j < turns; j++) {
            double angle = 2 * PI * (j + 0.5) / turns;
            sum += stretch(t, vec3(rho * cos(angle), rho * sin(angle), z));
        }
    }
    return 4 * PI * sum / (rows * turns);
}

static double density_at(const Primitive *primitive, Vec3 unit)
{
    return shape_inverse(4 * PI * stretch(&primitive->transform, unit));
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    double angle = 2 * PI * u2, z = 1 - 2 * u1;

    *face = 0;
    point(primitive, vec3(sqrt(fmax(0, 1 - z * z)) * cos(angle), sqrt(fmax(0, 1 - z * z)) * sin(angle), z), 0, out);
    return density_at(primitive, out->p);
}

static double density(const Primitive *primitive, Vec3 p, int face)
{
    (void)face;
    return density_at(primitive, vec_normalize(p));
}

const ShapeOps shape_sphere = {
    .name = "sphere",
    .properties = SHAPE_U_PERIODIC | SHAPE_UV_NATURAL,
    SHAPE_BOUNDED,
    .extent = extent,
    SHAPE_SAMPLED,
};
