/* The box [0,1]^3. Paths trace it as triangles; trace() and sampling use the exact faces. Faces 0..5 are
 * -x +x -y +y -z +z. Natural parametrisation: each face 0..1, upright and unmirrored seen from outside, with y up; the
 * top and the bottom as they unfold from the -z face. */
#include "shape/shape.h"

/* Bit 0 of the index is x, bit 1 y, bit 2 z. */
static const Vec3 vertices[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};

/* Two triangles a face, wound so that edge 01 x edge 02 points outward. */
static const int corners[12][3] = {
    {0, 4, 6}, {0, 6, 2}, /* -x */
    {1, 3, 7}, {1, 7, 5}, /* +x */
    {0, 1, 5}, {0, 5, 4}, /* -y */
    {2, 6, 7}, {2, 7, 3}, /* +y */
    {0, 2, 3}, {0, 3, 1}, /* -z */
    {4, 5, 7}, {4, 7, 6}, /* +z */
};

static void triangles(const Shape *shape, ShapeTriangles *out)
{
    (void)shape;
    *out = (ShapeTriangles){
        .nvertices = 8, .ntriangles = 12, .vertices = vertices, .corners = corners[0], .stride = 3, .per_face = 2};
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    for (int i = 0; i < 8; i++)
        shape_bound_point(low, high, transform_point(&primitive->transform, vertices[i]));
}

/* The box between its three pairs of planes. A ray that starts on one of them, within rounding, does not meet it. */
static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    double times[2] = {-INFINITY, INFINITY};
    int faces[2] = {0, 0}, starts_on[2] = {0, 0};

    (void)primitive;
    for (int k = 0; k < 3; k++) {
        double o = vec_component(ray->origin, k), d = vec_component(ray->direction, k);
        if (d == 0 && (o < 0 || o > 1))
            return 0;
        if (d == 0)
            continue;
        double near = ((d < 0) - o) / d, far = ((d > 0) - o) / d;
        if (near > times[0])
            times[0] = near, faces[0] = 2 * k + (d < 0), starts_on[0] = fabs((d < 0) - o) <= ray->slack;
        if (far < times[1])
            times[1] = far, faces[1] = 2 * k + (d > 0), starts_on[1] = fabs((d > 0) - o) <= ray->slack;
    }
    for (int i = 0; i < 2 && times[0] <= times[1]; i++)
        if (!starts_on[i] && shape_accept(ray, times[i], t)) {
            *face = faces[i];
            return 1;
        }
    return 0;
}

static double clamp01(double x)
{
    return fmin(fmax(x, 0), 1);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double side = face & 1;

    (void)primitive;
    out->p.x = face >> 1 == 0 ? side : clamp01(p.x);
    out->p.y = face >> 1 == 1 ? side : clamp01(p.y);
    out->p.z = face >> 1 == 2 ? side : clamp01(p.z);
    out->normal = vec3(face >> 1 == 0, face >> 1 == 1, face >> 1 == 2);
    if (face % 2 == 0)
        out->normal = vec_neg(out->normal);
}

static Vec3 face_normal(const Primitive *primitive, int face, const Vec3 corner[3])
{
    ShapePoint at;

    (void)corner;
    point(primitive, vec3(0.5, 0.5, 0.5), face, &at);
    return shape_world_normal(primitive, at.normal);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    int face = surface->face;
    ShapePoint on;
    double x, y, z;

    point(surface->primitive, shape_local_point(surface), face, &on);
    x = on.p.x, y = on.p.y, z = on.p.z;
    /* POV-Ray unfolds the box into a cross, 4 by 3 fields: -x +z +x -z from left to right in the middle row, the bottom
     * below +z and the top above it. */
    switch (face) {
    case 0:
        out->uv = (Vec2){z / 4, (1 + y) / 3};
        out->natural = (Vec2){1 - z, y};
        break;
    case 1:
        out->uv = (Vec2){(3 - z) / 4, (1 + y) / 3};
        out->natural = (Vec2){z, y};
        break;
    case 2:
        out->uv = (Vec2){(1 + x) / 4, z / 3};
        out->natural = (Vec2){x, 1 - z};
        break;
    case 3:
        out->uv = (Vec2){(1 + x) / 4, (3 - z) / 3};
        out->natural = (Vec2){x, z};
        break;
    case 4:
        out->uv = (Vec2){(4 - x) / 4, (1 + y) / 3};
        out->natural = (Vec2){x, y};
        break;
    default:
        out->uv = (Vec2){(1 + x) / 4, (1 + y) / 3};
        out->natural = (Vec2){1 - x, y};
        break;
    }
    out->has_uv = 1;
}

static void extent(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out)
{
    static const Vec3 u[6] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};

    (void)primitive, (void)axes;
    out->is_flat = 1;
    out->u = u[face];
    out->v = face == 2 ? vec3(0, 0, -1) : face == 3 ? vec3(0, 0, 1) : vec3(0, 1, 0);
}

static int inside(const Shape *shape, Vec3 p)
{
    (void)shape;
    return p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1;
}

/* ---- sampling ---- */

/* Areas of a face of each pair; returns the sum of all six. */
static double face_areas(const Transform *t, double areas[3])
{
    for (int k = 0; k < 3; k++)
        areas[k] = vec_length(vec_cross(shape_axis(t, (k + 1) % 3), shape_axis(t, (k + 2) % 3)));
    return 2 * (areas[0] + areas[1] + areas[2]);
}

static double area(const Primitive *primitive)
{
    double areas[3];

    return face_areas(&primitive->transform, areas);
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    double areas[3], pick = u1 * face_areas(&primitive->transform, areas), c[3];
    int f = 0;

    while (f < 5 && pick >= areas[f / 2])
        pick -= areas[f++ / 2];
    c[f / 2] = f & 1;
    c[(f / 2 + 1) % 3] = fmin(pick / areas[f / 2], 1);
    c[(f / 2 + 2) % 3] = u2;
    *face = f;
    point(primitive, vec3(c[0], c[1], c[2]), f, out);
    return shape_even_density(primitive, out->p, f);
}

const ShapeOps shape_box = {
    .name = "box",
    .properties = SHAPE_UV_NATURAL,
    SHAPE_BOUNDED,
    .extent = extent,
    .area = area,
    .sample = sample,
    .density = shape_even_density,
    .triangles = triangles,
    .face_normal = face_normal,
};
