/* The height field: a surface over x and z from 0 to 1, two triangles for each cell of its grid, cut along the line
 * from the cell's upper left to its lower right. There are no sides and no bottom. Natural parametrisation: x and z.
 * There is no uv_mapping.
 *
 * Along a ray the height above the surface is linear between the lines of the grid and the diagonals. It is followed
 * from one to the next, and where it changes its sign there is a crossing: each is found once, whichever triangle
 * rounding gives it to. A tree of squares with the range of their heights tells where the sign cannot change. */
#include "shape/height_field.h"
#include "shape/shape.h"

/* A ray in the grid: cells are 1 by 1, heights in units. */
typedef struct GridRay {
    const HeightField *field;
    const ShapeRay *ray;
    const ShapeLine *line;
    double ox, oy, oz, dx, dy, dz; /* at s of the line */
    int above;                     /* the ray is above the surface where `reached` is */
    double reached;
    double start; /* what ends before does not count */
    double *t;
} GridRay;

static double height_at(const HeightField *f, int i, int j)
{
    return f->heights[(size_t)j * (size_t)f->width + (size_t)i];
}

/* Of the plane of the cell's triangle. */
static double plane_height(const HeightField *f, int i, int j, int upper, double x, double z)
{
    const double u = x - i, v = z - j, right = height_at(f, i + 1, j), back = height_at(f, i, j + 1);

    if (upper) {
        const double corner = height_at(f, i + 1, j + 1);
        return corner + (1 - u) * (back - corner) + (1 - v) * (right - corner);
    }
    const double corner = height_at(f, i, j);
    return corner + u * (right - corner) + v * (back - corner);
}

static double above_triangle(const GridRay *g, int i, int j, int upper, double s)
{
    return g->oy + s * g->dy - plane_height(g->field, i, j, upper, g->ox + s * g->dx, g->oz + s * g->dz);
}

/* On from what is reached to s, across one triangle. 1: it is the answer. The sign that was reached goes on from
 * triangle to triangle; where the crossing is, this triangle alone decides, so that every call finds it there. */
static int follow(GridRay *g, int i, int j, int upper, double from, double s)
{
    const double end = above_triangle(g, i, j, upper, s);
    const int was_above = g->reached == from ? g->above : above_triangle(g, i, j, upper, from) > 0;

    g->above = end > 0;
    g->reached = s;
    if (was_above == g->above)
        return 0;
    const double begin = above_triangle(g, i, j, upper, from), share = begin != end ? begin / (begin - end) : 1;
    const double at = from + (s - from) * fmin(fmax(share, 0), 1);
    return shape_accept(g->ray, shape_line_t(g->line, at), g->t);
}

static int cross_cell(GridRay *g, int i, int j, double from, double to)
{
    /* Where u + v = 1. */
    const double diagonal = (i + j + 1 - g->ox - g->oz) / (g->dx + g->dz), middle = 0.5 * (from + to);

    if (diagonal > from && diagonal < to) {
        const int upper = g->dx + g->dz < 0;
        return follow(g, i, j, upper, from, diagonal) || follow(g, i, j, !upper, diagonal, to);
    }
    return follow(g, i, j, g->ox + middle * g->dx + g->oz + middle * g->dz > i + j + 1, from, to);
}

/* The ray passes through this square of the level from `from` to `to`. */
static int cross_square(GridRay *g, int level, int i, int j, double from, double to)
{
    const HeightLevel *l = &g->field->levels[level];
    const HeightRange *range = &l->ranges[(size_t)j * (size_t)l->width + (size_t)i];
    const double y0 = g->oy + from * g->dy, y1 = g->oy + to * g->dy, size = (double)(1 << level);
    double cuts[4] = {from, to, to, to};
    int pieces = 1;

    if (fmin(y0, y1) > range->high || fmax(y0, y1) < range->low || to < g->start)
        return 0;
    if (level == 0)
        return cross_cell(g, i, j, from, to);
    const double x = size * (i + 0.5), z = size * (j + 0.5), half = size / 2;
    const double at_x = (x - g->ox) / g->dx, at_z = (z - g->oz) / g->dz;
    for (int k = 0; k < 2; k++) {
        const double at = (k == 0) == (at_x < at_z) ? at_x : at_z;
        if (at > from && at < to && at != cuts[pieces - 1])
            cuts[pieces++] = at;
    }
    cuts[pieces] = to;
    for (int k = 0; k < pieces; k++) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const int right = g->ox + middle * g->dx > x, back = g->oz + middle * g->dz > z;
        const int a = 2 * i + right, b = 2 * j + back;
        if (a < (l - 1)->width && b < (l - 1)->height && half > 0 &&
            cross_square(g, level - 1, a, b, cuts[k], cuts[k + 1]))
            return 1;
    }
    return 0;
}

static const HeightRange *whole_range(const HeightField *f)
{
    return f->levels[f->nlevels - 1].ranges;
}

/* What lies under water is outside, so that rays do not meet it. */
static void local_bounds(const HeightField *f, Vec3 *low, Vec3 *high)
{
    *low = vec3(0, fmin(fmax(whole_range(f)->low, f->water), whole_range(f)->high) / HEIGHT_UNITS, 0);
    *high = vec3(1, (double)whole_range(f)->high / HEIGHT_UNITS, 1);
}

/* Along y there is one height. */
static int intersect_upright(const HeightField *f, const ShapeRay *ray, double *t)
{
    const double x = ray->origin.x * (f->width - 1), z = ray->origin.z * (f->height - 1);
    const int i = (int)fmin(fmax(x, 0), f->width - 2), j = (int)fmin(fmax(z, 0), f->height - 2);
    const double height = plane_height(f, i, j, x - i + z - j > 1, x, z);

    return height >= f->water && shape_accept(ray, (height / HEIGHT_UNITS - ray->origin.y) / ray->direction.y, t);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const HeightField *f = primitive->shape.data;
    Vec3 low, high;

    (void)face;
    local_bounds(f, &low, &high);
    const ShapeLine line = shape_line(ray, vec_scale(vec_add(low, high), 0.5));
    const double wide = f->width - 1, deep = f->height - 1;
    double from = -INFINITY, to = INFINITY;
    if (!shape_line_clip(&line, vec3(0, low.y - 1e-9, 0), vec3(1, high.y + 1e-9, 1), &from, &to))
        return 0;
    if (ray->direction.x == 0 && ray->direction.z == 0)
        return intersect_upright(f, ray, t);
    GridRay g = {f,
                 ray,
                 &line,
                 line.origin.x * wide,
                 line.origin.y * HEIGHT_UNITS,
                 line.origin.z * deep,
                 line.direction.x * wide,
                 line.direction.y * HEIGHT_UNITS,
                 line.direction.z * deep,
                 0,
                 INFINITY,
                 0,
                 t};
    /* Well before tmin: how the first triangle begins, which rounding may decide another way in each call, must not
     * matter. */
    g.start = ray->tmin * line.length - line.shift;
    g.start -= 1e-9 * (fabs(g.start) + fabs(line.shift) + 1);
    return cross_square(&g, f->nlevels - 1, 0, 0, from, to);
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    Vec3 a, b;

    local_bounds(primitive->shape.data, &a, &b);
    shape_bound_box(low, high, &primitive->transform, a, b);
}

/* What lies below is inside, without end. */
static void solid_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    (void)primitive;
    *low = vec3(-INFINITY, -INFINITY, -INFINITY);
    *high = vec3(INFINITY, INFINITY, INFINITY);
}

/* The normal of a surface with these slopes, in grid units. */
static Vec3 normal_of(const HeightField *f, double du, double dv)
{
    return vec3(-du * (f->width - 1) / HEIGHT_UNITS, 1, -dv * (f->height - 1) / HEIGHT_UNITS);
}

/* Of a smooth field at a point of the grid, of length 1 in grid units: the mean of the normals of the cells around it,
 * as POV-Ray takes it. A height is thousands of units, so that flat cells count much more than steep ones. */
static Vec3 smooth_normal_at(const HeightField *f, int i, int j)
{
    const double height = height_at(f, i, j);
    Vec3 sum = {0, 0, 0};

    for (int k = 0; k < 4; k++) {
        const int x = k & 1 ? 1 : -1, z = k & 2 ? 1 : -1;
        if (i + x < 0 || i + x >= f->width || j + z < 0 || j + z >= f->height)
            continue;
        const double du = x * (height_at(f, i + x, j) - height), dv = z * (height_at(f, i, j + z) - height);
        sum = vec_add(sum, vec_normalize(vec3(-du, 1, -dv)));
    }
    return vec_normalize(sum);
}

static Vec3 smooth_normal(const HeightField *f, int i, int j, double u, double v)
{
    Vec3 n = vec_scale(smooth_normal_at(f, i, j), (1 - u) * (1 - v));

    n = vec_mad(n, smooth_normal_at(f, i + 1, j), u * (1 - v));
    n = vec_mad(n, smooth_normal_at(f, i, j + 1), (1 - u) * v);
    n = vec_mad(n, smooth_normal_at(f, i + 1, j + 1), u * v);
    return vec3(n.x * (f->width - 1), n.y * HEIGHT_UNITS, n.z * (f->height - 1));
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const HeightField *f = primitive->shape.data;
    const double x = fmin(fmax(p.x, 0), 1) * (f->width - 1), z = fmin(fmax(p.z, 0), 1) * (f->height - 1);
    const int i = (int)fmin(x, f->width - 2), j = (int)fmin(z, f->height - 2);
    const double u = x - i, v = z - j;
    const int upper = u + v > 1;
    const double right = height_at(f, i + 1, j), back = height_at(f, i, j + 1);
    const double corner = height_at(f, i + upper, j + upper);

    (void)face;
    out->p = vec3(p.x, plane_height(f, i, j, upper, x, z) / HEIGHT_UNITS, p.z);
    out->normal = upper ? normal_of(f, corner - back, corner - right) : normal_of(f, right - corner, back - corner);
    if (f->smooth)
        out->shading_normal = smooth_normal(f, i, j, u, v);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Vec3 p = shape_local_point(surface);

    out->natural = (Vec2){p.x, p.z};
}

/* All that lies below the surface, however low and under water too, as in POV-Ray. */
static int inside(const Shape *shape, Vec3 p)
{
    const HeightField *f = shape->data;
    const double x = p.x * (f->width - 1), z = p.z * (f->height - 1);

    if (!(p.x >= 0 && p.x < 1 && p.z >= 0 && p.z < 1))
        return 0;
    const int i = (int)fmin(x, f->width - 2), j = (int)fmin(z, f->height - 2);
    return p.y * HEIGHT_UNITS < plane_height(f, i, j, x - i + z - j > 1, x, z);
}

const ShapeOps shape_height_field = {
    .name = "height_field",
    SHAPE_BOUNDED,
    .solid_bounds = solid_bounds,
};
