/* Parser of parametric surfaces, which become meshes with the surface's normals, and its parameters as UVs. The lines
 * of a grid of parameters are halved until the middles of all cells and of their sides are where the mesh has them, up
 * to accuracy. What is outside of the container is cut off. */
#include <string.h>
#include "sdl/object/shape.h"

enum { FIRST_LINES = 33, MOST_CELLS = 400000, MOST_PASSES = 14 };

typedef struct Lines {
    double *at; /* ascending */
    int count;
} Lines;

typedef struct Grid {
    Sdl *sdl;
    const FunctionProgram *function[3];
    double low[2], high[2];
    Lines u, v;
    Vec3 *points; /* of u line i and v line j: i * v.count + j */
    double tolerance;
    Container container;
} Grid;

static Vec3 surface(const Grid *grid, double u, double v)
{
    const double args[3] = {u, v, 0};
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = function_evaluate(grid->function[k], args, NULL);
    return vec3(at[0], at[1], at[2]);
}

static Vec3 at(const Grid *grid, int i, int j)
{
    return grid->points[(size_t)i * (size_t)grid->v.count + (size_t)j];
}

/* ---- the grid ---- */

static Lines first_lines(Sdl *sdl, double low, double high)
{
    Lines lines = {sdl_alloc(sdl, FIRST_LINES * sizeof(double)), FIRST_LINES};
    for (int i = 0; i < FIRST_LINES; i++)
        lines.at[i] = low + (high - low) * i / (FIRST_LINES - 1);
    return lines;
}

static void evaluate_points(Grid *grid)
{
    const size_t count = (size_t)grid->u.count * (size_t)grid->v.count;
    const int length =
        grid->function[0]->ninstructions + grid->function[1]->ninstructions + grid->function[2]->ninstructions;
    grid->points = sdl_alloc(grid->sdl, count * sizeof *grid->points);
    for (int i = 0; i < grid->u.count; i++) {
        sdl_step(grid->sdl, 5L * grid->v.count * length); /* also for the middles */
        for (int j = 0; j < grid->v.count; j++)
            grid->points[(size_t)i * (size_t)grid->v.count + (size_t)j] = surface(grid, grid->u.at[i], grid->v.at[j]);
    }
}

/* Whether a cell may have to do with what is in the container. */
static int may_be_seen(const Grid *grid, int i, int j)
{
    const Vec3 corners[4] = {at(grid, i, j), at(grid, i + 1, j), at(grid, i, j + 1), at(grid, i + 1, j + 1)};
    Vec3 low = corners[0], high = low;
    for (int k = 1; k < 4; k++) {
        low = vec3(fmin(low.x, corners[k].x), fmin(low.y, corners[k].y), fmin(low.z, corners[k].z));
        high = vec3(fmax(high.x, corners[k].x), fmax(high.y, corners[k].y), fmax(high.z, corners[k].z));
    }
    const Container *c = &grid->container;
    return low.x <= c->high.x && high.x >= c->low.x && low.y <= c->high.y && high.y >= c->low.y && low.z <= c->high.z &&
           high.z >= c->low.z;
}

static int is_off(const Grid *grid, Vec3 is, Vec3 a, Vec3 b)
{
    const Vec3 off = vec_sub(is, vec_scale(vec_add(a, b), 0.5));
    return vec_is_finite(off) && vec_length(off) > grid->tolerance;
}

/* Marks the intervals of lines that are too wide; returns how many. */
static int mark_intervals(const Grid *grid, char *of_u, char *of_v)
{
    int count = 0;
    for (int i = 0; i + 1 < grid->u.count; i++)
        for (int j = 0; j + 1 < grid->v.count; j++) {
            if ((of_u[i] && of_v[j]) || !may_be_seen(grid, i, j))
                continue;
            const double u0 = grid->u.at[i], v0 = grid->v.at[j], u = 0.5 * (u0 + grid->u.at[i + 1]),
                         v = 0.5 * (v0 + grid->v.at[j + 1]);
            const Vec3 a = at(grid, i, j), b = at(grid, i + 1, j + 1);
            of_u[i] |= (char)is_off(grid, surface(grid, u, v0), a, at(grid, i + 1, j));
            of_v[j] |= (char)is_off(grid, surface(grid, u0, v), a, at(grid, i, j + 1));
            if (!of_u[i] && !of_v[j] && is_off(grid, surface(grid, u, v), a, b))
                of_u[i] = of_v[j] = 1;
        }
    for (int i = 0; i + 1 < grid->u.count; i++)
        count += of_u[i];
    for (int j = 0; j + 1 < grid->v.count; j++)
        count += of_v[j];
    return count;
}

static Lines halved(Sdl *sdl, Lines lines, const char *marked)
{
    Lines more = {sdl_alloc(sdl, 2 * (size_t)lines.count * sizeof(double)), 0};
    for (int i = 0; i < lines.count; i++) {
        more.at[more.count++] = lines.at[i];
        if (i + 1 < lines.count && marked[i])
            more.at[more.count++] = 0.5 * (lines.at[i] + lines.at[i + 1]);
    }
    return more;
}

/* 1 if the lines are close enough in the end. */
static int refine(Grid *grid)
{
    Sdl *sdl = grid->sdl;
    grid->u = first_lines(sdl, grid->low[0], grid->high[0]);
    grid->v = first_lines(sdl, grid->low[1], grid->high[1]);
    for (int pass = 0;; pass++) {
        evaluate_points(grid);
        char *of_u = sdl_alloc(sdl, (size_t)grid->u.count), *of_v = sdl_alloc(sdl, (size_t)grid->v.count);
        if (!mark_intervals(grid, of_u, of_v))
            return 1;
        const Lines u = halved(sdl, grid->u, of_u), v = halved(sdl, grid->v, of_v);
        if (pass == MOST_PASSES || (double)u.count * v.count > MOST_CELLS)
            return 0;
        grid->u = u;
        grid->v = v;
    }
}

/* ---- the mesh ---- */

/* The unit normal, by differences. Where it is none, as at a pole, that of parameters a little farther in. */
static Vec3 normal_at(const Grid *grid, double u, double v)
{
    const double du = 1e-6 * (grid->high[0] - grid->low[0]), dv = 1e-6 * (grid->high[1] - grid->low[1]);
    for (int i = 0; i < 2; i++) {
        const Vec3 along_u = vec_sub(surface(grid, u + du, v), surface(grid, u - du, v));
        const Vec3 along_v = vec_sub(surface(grid, u, v + dv), surface(grid, u, v - dv));
        const double sizes = vec_length(along_u) * vec_length(along_v);
        const Vec3 n = vec_cross(along_u, along_v);
        if (vec_length(n) > 1e-4 * sizes && sizes > 1e-16 * grid->tolerance * grid->tolerance && vec_is_finite(n))
            return vec_normalize(n);
        u += (u < 0.5 * (grid->low[0] + grid->high[0]) ? 100 : -100) * du;
        v += (v < 0.5 * (grid->low[1] + grid->high[1]) ? 100 : -100) * dv;
    }
    return vec3(0, 0, 0);
}

typedef struct Corner {
    Vec3 p, normal;
    Vec2 uv;
    int index; /* in the mesh, or -1: not there yet */
} Corner;

typedef struct Cutter {
    Grid *grid;
    Mesh *mesh;
    int vertex_capacity, normal_capacity, uv_capacity, face_capacity;
    int *index; /* of each point of the grid in the mesh, plus 1 */
} Cutter;

static int add_corner(Cutter *c, const Corner *corner)
{
    Mesh *m = c->mesh;
    Sdl *sdl = c->grid->sdl;
    m->vertices = sdl_grow(sdl, m->vertices, m->nvertices, &c->vertex_capacity, sizeof *m->vertices);
    m->normals = sdl_grow(sdl, m->normals, m->nnormals, &c->normal_capacity, sizeof *m->normals);
    m->uvs = sdl_grow(sdl, m->uvs, m->nuvs, &c->uv_capacity, sizeof *m->uvs);
    m->vertices[m->nvertices++] = corner->p;
    m->normals[m->nnormals++] = corner->normal;
    m->uvs[m->nuvs++] = corner->uv;
    return m->nvertices - 1;
}

static void add_face(Cutter *c, Corner *corners[3])
{
    Mesh *m = c->mesh;
    MeshFace face = {.texture = -1};
    int smooth = 1;
    for (int k = 0; k < 3; k++) {
        if (corners[k]->index < 0)
            corners[k]->index = add_corner(c, corners[k]);
        face.vertex[k] = face.uv[k] = face.normal[k] = corners[k]->index;
        smooth = smooth && vec_length(corners[k]->normal) > 0;
    }
    for (int k = 0; k < 3 && !smooth; k++)
        face.normal[k] = -1;
    m->faces = sdl_grow(c->grid->sdl, m->faces, m->nfaces, &c->face_capacity, sizeof *m->faces);
    m->faces[m->nfaces++] = face;
}

/* How far outside of a side of the container; a sphere has one, whose distances are linear enough within a cell. */
static double outside_of(const Container *c, int side, Vec3 p)
{
    if (c->spherical)
        return vec_length(vec_sub(p, c->centre)) - c->radius;
    const double x = side / 2 == 0   ? p.x
                     : side / 2 == 1 ? p.y
                                     : p.z,
                 low = side / 2 == 0   ? c->low.x
                       : side / 2 == 1 ? c->low.y
                                       : c->low.z,
                 high = side / 2 == 0   ? c->high.x
                        : side / 2 == 1 ? c->high.y
                                        : c->high.z;
    return side % 2 ? x - high : low - x;
}

static Corner between(const Corner *a, const Corner *b, double share)
{
    return (Corner){vec_mad(a->p, vec_sub(b->p, a->p), share),
                    vec_normalize(vec_mad(a->normal, vec_sub(b->normal, a->normal), share)),
                    {a->uv.u + (b->uv.u - a->uv.u) * share, a->uv.v + (b->uv.v - a->uv.v) * share},
                    -1};
}

enum { MOST_CORNERS = 16 };

/* What of the polygon is inside that side; returns how many corners. */
static int cut(const Container *container, int side, const Corner *from, int count, Corner *to)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        const Corner *a = &from[k], *b = &from[(k + 1) % count];
        const double da = outside_of(container, side, a->p), db = outside_of(container, side, b->p);
        if (da <= 0)
            to[kept++] = *a;
        if ((da > 0) != (db > 0))
            to[kept++] = between(a, b, da / (da - db));
    }
    return kept;
}

static void add_triangle(Cutter *c, const Corner corners[3], int *indices[3])
{
    const Container *container = &c->grid->container;
    Corner polygon[2][MOST_CORNERS];
    int count = 3, current = 0;
    memcpy(polygon[0], corners, 3 * sizeof *corners);
    for (int side = 0; side < (container->spherical ? 1 : 6) && count >= 3; side++, current = !current)
        count = cut(container, side, polygon[current], count, polygon[!current]);
    Corner *p = polygon[current];
    for (int k = 1; k + 1 < count; k++)
        add_face(c, (Corner *[3]){&p[0], &p[k], &p[k + 1]});
    /* remember corners of the grid that are in the mesh now */
    for (int k = 0; k < count; k++)
        for (int i = 0; i < 3; i++)
            if (p[k].index >= 0 && memcmp(&p[k].uv, &corners[i].uv, sizeof p[k].uv) == 0)
                *indices[i] = p[k].index + 1;
}

static void add_cell(Cutter *c, int i, int j)
{
    static const int way[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const int triangles[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
    const Grid *grid = c->grid;
    Corner corners[4];
    int *indices[4];
    for (int k = 0; k < 4; k++) {
        const int a = i + way[k][0], b = j + way[k][1];
        indices[k] = &c->index[(size_t)a * (size_t)grid->v.count + (size_t)b];
        corners[k] = (Corner){.p = at(grid, a, b), .uv = {grid->u.at[a], grid->v.at[b]}, .index = *indices[k] - 1};
        if (!vec_is_finite(corners[k].p))
            return;
        corners[k].normal = corners[k].index >= 0 ? c->mesh->normals[corners[k].index]
                                                  : normal_at(grid, corners[k].uv.u, corners[k].uv.v);
    }
    const int other = vec_length(vec_sub(corners[0].p, corners[2].p)) > vec_length(vec_sub(corners[1].p, corners[3].p));
    for (int t = 0; t < 2; t++) {
        const int *k = triangles[other][t];
        for (int n = 0; n < 3; n++)
            corners[k[n]].index = *indices[k[n]] - 1;
        add_triangle(c, (Corner[3]){corners[k[0]], corners[k[1]], corners[k[2]]},
                     (int *[3]){indices[k[0]], indices[k[1]], indices[k[2]]});
    }
}

static Mesh *make_mesh(Grid *grid)
{
    Cutter cutter = {.grid = grid, .mesh = sdl_alloc(grid->sdl, sizeof *cutter.mesh)};
    cutter.index = sdl_alloc(grid->sdl, (size_t)grid->u.count * (size_t)grid->v.count * sizeof *cutter.index);
    for (int i = 0; i + 1 < grid->u.count; i++) {
        sdl_step(grid->sdl, grid->v.count);
        for (int j = 0; j + 1 < grid->v.count; j++)
            if (may_be_seen(grid, i, j))
                add_cell(&cutter, i, j);
    }
    return cutter.mesh;
}

/* ---- parsing ---- */

static const FunctionProgram *coordinate(Sdl *sdl)
{
    const Value function = sdl_is(sdl, "function") ? sdl_function(sdl) : sdl_function_body(sdl);
    sdl_optional_comma(sdl);
    return sdl_function_program(sdl, &function, 2);
}

static void precompute(Sdl *sdl)
{
    sdl_float(sdl);
    sdl_optional_comma(sdl);
    while (sdl_accept(sdl, "x") || sdl_accept(sdl, "y") || sdl_accept(sdl, "z"))
        sdl_optional_comma(sdl);
}

void parse_parametric(Sdl *sdl, Object *object)
{
    Grid grid = {.sdl = sdl, .tolerance = 0.001, .container = CONTAINER_INIT};
    for (int k = 0; k < 3; k++)
        grid.function[k] = coordinate(sdl);
    const Vec2 a = sdl_vector2(sdl);
    sdl_optional_comma(sdl);
    const Vec2 b = sdl_vector2(sdl);
    grid.low[0] = fmin(a.u, b.u), grid.high[0] = fmax(a.u, b.u);
    grid.low[1] = fmin(a.v, b.v), grid.high[1] = fmax(a.v, b.v);
    for (;;) {
        if (sdl_accept(sdl, "accuracy"))
            grid.tolerance = positive_or(sdl, "accuracy", sdl_float(sdl), 0.001);
        else if (sdl_accept(sdl, "max_gradient"))
            sdl_float(sdl);
        else if (sdl_accept(sdl, "precompute"))
            precompute(sdl);
        else if (!accept_container(sdl, &grid.container))
            break;
    }
    /* small surfaces are not coarser for that */
    grid.tolerance = fmin(grid.tolerance, 5e-4 * vec_length(vec_sub(grid.container.high, grid.container.low)));
    object->shape.ops = &shape_mesh;
    const int done = grid.low[0] < grid.high[0] && grid.low[1] < grid.high[1] ? refine(&grid) : -1;
    Mesh *mesh = done >= 0 ? make_mesh(&grid) : NULL;
    if (!mesh || !mesh->nfaces) {
        sdl_warn(sdl, "a parametric surface of which nothing is in its container: it is left out");
        object->kind = OBJECT_EMPTY;
        return;
    }
    if (!done)
        sdl_warn(sdl, "a parametric surface needs more than %d cells for its accuracy: it is coarser", MOST_CELLS);
    object->shape.mesh = mesh;
}
