/* bicubic_patch: tessellated as POV-Ray does it, with its number of steps and flatness, into a smooth mesh. The 16
 * points are p[i][j]. Steps in u go along i, those in v along j; but texture coordinates go from (0, 0) at p[0][0] to
 * (1, 0) at p[0][3], unless uv_vectors say otherwise. */
#include "sdl/object/shape.h"
#include "shape/surface.h"

enum { MAX_STEPS = 12 };

typedef struct Patch {
    Vec3 p[4][4];
    double flatness;
    int u_steps, v_steps;
    Vec2 uv[4]; /* of p[0][0], p[0][3], p[3][3], p[3][0] */
} Patch;

/* The part of the patch between these parameters. */
typedef struct Part {
    double u0, u1, v0, v1;
    Vec3 p[4][4];
} Part;

typedef struct MeshGrower {
    Sdl *sdl;
    const Patch *patch;
    Mesh *mesh;
    int vertex_capacity, normal_capacity, uv_capacity, face_capacity;
} MeshGrower;

/* ---- the surface ---- */

static void weights(double x, double value[4], double slope[4])
{
    const double y = 1 - x;

    value[0] = y * y * y, value[1] = 3 * y * y * x, value[2] = 3 * y * x * x, value[3] = x * x * x;
    slope[0] = -3 * y * y, slope[1] = 3 * y * (y - 2 * x), slope[2] = 3 * x * (2 * y - x), slope[3] = 3 * x * x;
}

static Vec3 combined(const Patch *patch, const double a[4], const double b[4])
{
    Vec3 sum = vec3(0, 0, 0);

    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            sum = vec_mad(sum, patch->p[i][j], a[i] * b[j]);
    return sum;
}

static Vec3 normal_at(const Patch *patch, double u, double v)
{
    double bu[4], bv[4], du[4], dv[4];

    weights(u, bu, du);
    weights(v, bv, dv);
    return vec_normalize(vec_cross(combined(patch, du, bv), combined(patch, bu, dv)));
}

/* Where an edge is one point, the normal is that of a point beside it. */
static void evaluate(const Patch *patch, double u, double v, Vec3 *p, Vec3 *normal)
{
    double bu[4], bv[4], slope[4];

    weights(u, bu, slope);
    weights(v, bv, slope);
    *p = combined(patch, bu, bv);
    *normal = normal_at(patch, u, v);
    for (double step = 1e-5; vec_length(*normal) < 0.5 && step < 0.1; step *= 10)
        *normal = normal_at(patch, u + (u < 0.5 ? step : -step), v + (v < 0.5 ? step : -step));
}

/* ---- subdivision ---- */

static void halve(const Vec3 in[4], Vec3 low[4], Vec3 high[4])
{
    const Vec3 a = vec_scale(vec_add(in[0], in[1]), 0.5), b = vec_scale(vec_add(in[1], in[2]), 0.5);
    const Vec3 c = vec_scale(vec_add(in[2], in[3]), 0.5);
    const Vec3 ab = vec_scale(vec_add(a, b), 0.5), bc = vec_scale(vec_add(b, c), 0.5);

    low[0] = in[0], low[1] = a, low[2] = ab;
    low[3] = high[0] = vec_scale(vec_add(ab, bc), 0.5);
    high[1] = bc, high[2] = c, high[3] = in[3];
}

static void halve_in_u(const Part *in, Part *low, Part *high)
{
    *low = *high = *in;
    low->u1 = high->u0 = 0.5 * (in->u0 + in->u1);
    for (int j = 0; j < 4; j++) {
        Vec3 line[4], a[4], b[4];
        for (int i = 0; i < 4; i++)
            line[i] = in->p[i][j];
        halve(line, a, b);
        for (int i = 0; i < 4; i++)
            low->p[i][j] = a[i], high->p[i][j] = b[i];
    }
}

static void halve_in_v(const Part *in, Part *low, Part *high)
{
    *low = *high = *in;
    low->v1 = high->v0 = 0.5 * (in->v0 + in->v1);
    for (int i = 0; i < 4; i++)
        halve(in->p[i], low->p[i], high->p[i]);
}

/* No point is farther from the plane through three corners than the flatness. */
static int is_flat(const Part *part, double flatness)
{
    const Vec3 a = part->p[0][0];
    Vec3 normal = vec_cross(vec_sub(part->p[0][3], a), vec_sub(part->p[3][3], a));

    if (vec_length(normal) == 0)
        normal = vec_cross(vec_sub(part->p[3][3], a), vec_sub(part->p[3][0], a));
    if (!(flatness > 0) || vec_length(normal) == 0)
        return 0;
    normal = vec_normalize(normal);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            if (fabs(vec_dot(normal, vec_sub(part->p[i][j], a))) > flatness)
                return 0;
    return 1;
}

/* ---- the mesh ---- */

static void add_vertex(MeshGrower *g, double u, double v)
{
    Mesh *mesh = g->mesh;
    const Vec2 *uv = g->patch->uv;
    const double w[4] = {(1 - u) * (1 - v), (1 - u) * v, u * v, u * (1 - v)};

    mesh->vertices = sdl_grow(g->sdl, mesh->vertices, mesh->nvertices, &g->vertex_capacity, sizeof(Vec3));
    mesh->normals = sdl_grow(g->sdl, mesh->normals, mesh->nnormals, &g->normal_capacity, sizeof(Vec3));
    mesh->uvs = sdl_grow(g->sdl, mesh->uvs, mesh->nuvs, &g->uv_capacity, sizeof(Vec2));
    evaluate(g->patch, u, v, &mesh->vertices[mesh->nvertices++], &mesh->normals[mesh->nnormals++]);
    mesh->uvs[mesh->nuvs] = (Vec2){0, 0};
    for (int k = 0; k < 4; k++) {
        mesh->uvs[mesh->nuvs].u += w[k] * uv[k].u;
        mesh->uvs[mesh->nuvs].v += w[k] * uv[k].v;
    }
    mesh->nuvs++;
}

static void add_face(MeshGrower *g, int a, int b, int c)
{
    Mesh *mesh = g->mesh;

    mesh->faces = sdl_grow(g->sdl, mesh->faces, mesh->nfaces, &g->face_capacity, sizeof *mesh->faces);
    mesh->faces[mesh->nfaces++] = (MeshFace){{a, b, c}, {a, b, c}, {a, b, c}, -1};
}

/* Two triangles for a part that is not divided further. */
static void add_part(MeshGrower *g, const Part *part)
{
    const int first = g->mesh->nvertices;

    sdl_step(g->sdl, 8);
    add_vertex(g, part->u0, part->v0);
    add_vertex(g, part->u0, part->v1);
    add_vertex(g, part->u1, part->v1);
    add_vertex(g, part->u1, part->v0);
    add_face(g, first, first + 1, first + 2);
    add_face(g, first, first + 2, first + 3);
}

static void divide(MeshGrower *g, const Part *part, int depth)
{
    const int in_u = depth < g->patch->u_steps, in_v = depth < g->patch->v_steps;
    Part low, high, parts[4];
    int count = 0;

    if ((!in_u && !in_v) || is_flat(part, g->patch->flatness)) {
        add_part(g, part);
        return;
    }
    if (in_u)
        halve_in_u(part, &low, &high);
    if (in_u && in_v) {
        halve_in_v(&low, &parts[0], &parts[1]);
        halve_in_v(&high, &parts[2], &parts[3]);
        count = 4;
    } else if (in_u) {
        parts[count++] = low;
        parts[count++] = high;
    } else {
        halve_in_v(part, &parts[0], &parts[1]);
        count = 2;
    }
    for (int i = 0; i < count; i++)
        divide(g, &parts[i], depth + 1);
}

/* ---- reading ---- */

static int steps(Sdl *sdl)
{
    const double count = sdl_float(sdl);
    if (!(count >= 0 && count <= MAX_STEPS))
        sdl_error(sdl, "a bicubic_patch of %g steps: there are 0 to %d", count, MAX_STEPS);
    return (int)count;
}

static void options(Sdl *sdl, Patch *patch)
{
    for (;;) {
        if (sdl_accept(sdl, "type")) {
            const double type = sdl_float(sdl);
            if (type != 0 && type != 1)
                sdl_error(sdl, "a bicubic_patch of type %g: there are 0 and 1", type);
        } else if (sdl_accept(sdl, "flatness"))
            patch->flatness = sdl_float(sdl);
        else if (sdl_accept(sdl, "u_steps"))
            patch->u_steps = steps(sdl);
        else if (sdl_accept(sdl, "v_steps"))
            patch->v_steps = steps(sdl);
        else if (sdl_accept(sdl, "accuracy"))
            sdl_float(sdl);
        else if (sdl_accept(sdl, "uv_vectors"))
            for (int k = 0; k < 4; k++) {
                sdl_optional_comma(sdl);
                patch->uv[k] = sdl_vector2(sdl);
            }
        else
            return;
        sdl_optional_comma(sdl);
    }
}

void parse_bicubic_patch(Sdl *sdl, Object *object)
{
    Patch patch = {.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    Part whole = {0, 1, 0, 1, {{{0, 0, 0}}}};
    MeshGrower g = {.sdl = sdl, .patch = &patch, .mesh = sdl_alloc(sdl, sizeof(Mesh))};
    options(sdl, &patch);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            patch.p[i][j] = whole.p[i][j] = sdl_vector(sdl);
            sdl_optional_comma(sdl);
        }
    divide(&g, &whole, 0);
    object->shape.ops = &shape_mesh;
    object->shape.mesh = g.mesh;
}
