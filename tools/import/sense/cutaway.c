/* Which faces stand between a camera outside and the free space of rooms: walls, ceilings, roofs, trees.
 *
 * The free space is that of the floor plan: above each cell where one can walk, and above furniture beside it. A point
 * is before it if the way from the camera comes through free space only after that point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/mesh.h"
#include "import/base/world.h"
#include "import/sense/sense.h"
#include "import/space/room.h"
#include "import/space/space.h"
#include "import/space/views.h"

typedef struct Range {
    float from, to; /* from >= to: none */
} Range;

typedef struct Air {
    const Room *room;
    Range *columns; /* by cell of the plan: heights that are free */
    double low[3], high[3];
} Air;

/* ---- free space ---- */

static int is_air(const Air *air, int cell)
{
    return cell >= 0 && air->columns[cell].from < air->columns[cell].to;
}

static int is_free_above(const Room *room, int a, int b, double height)
{
    double from[3], to[3];
    SpaceHit hit;
    room_point(room, a, 0, from);
    room_point(room, b, 0, to);
    from[1] = to[1] = height;
    for (int k = 0; k < 3; k++)
        to[k] -= from[k];
    return !space_ray(room->space, from, to, 0, 1, &hit);
}

/* What is free above a cell from which the next one can be looked at over what stands there; none if nothing is. */
static Range free_column(const Room *room, int cell, double beside, double *look)
{
    const RoomCell *at = &room->cells[cell];
    const double top = (double)at->top, share = (top - room->floor) / room->height;
    const double reach = at->is_covered ? (double)at->reach : fmin((double)at->reach, room->height);
    if (room_is_enclosed(at)) {
        *look = room->floor + room->eye;
        return (Range){at->floor, (float)((double)at->floor + reach)};
    }
    *look = fmax(top, beside) + 0.03 * room->height;
    if (!(share > -0.03 && share < 0.8))
        return (Range){0, 0};
    return (Range){(float)top, (float)(room->floor + 0.95 * room->height)};
}

/* Spread to all that is seen from cells beside. */
static void spread(Air *air, int *stack, int open)
{
    const Room *room = air->room;
    while (open) {
        const int at = stack[--open], x = at % room->nx, z = at / room->nx;
        const int beside[4] = {x > 0 ? at - 1 : -1, x + 1 < room->nx ? at + 1 : -1, z > 0 ? at - room->nx : -1,
                               z + 1 < room->nz ? at + room->nx : -1};
        for (int k = 0; k < 4; k++) {
            double height;
            if (beside[k] < 0 || is_air(air, beside[k]))
                continue;
            const Range column = free_column(room, beside[k], (double)air->columns[at].from, &height);
            if (column.from >= column.to || !is_free_above(room, at, beside[k], height))
                continue;
            air->columns[beside[k]] = column;
            stack[open++] = beside[k];
        }
    }
}

static void find_bounds(Air *air)
{
    const Room *room = air->room;
    for (int k = 0; k < 3; k++)
        air->low[k] = INFINITY, air->high[k] = -INFINITY;
    for (int i = 0; i < room->nx * room->nz; i++) {
        if (!is_air(air, i))
            continue;
        const double x = room->low[0] + i % room->nx * room->cell, z = room->low[2] + i / room->nx * room->cell;
        air->low[0] = fmin(air->low[0], x), air->high[0] = fmax(air->high[0], x + room->cell);
        air->low[1] = fmin(air->low[1], (double)air->columns[i].from);
        air->high[1] = fmax(air->high[1], (double)air->columns[i].to);
        air->low[2] = fmin(air->low[2], z), air->high[2] = fmax(air->high[2], z + room->cell);
    }
}

static int find_air(Air *air, RetexError *err)
{
    const Room *room = air->room;
    const int count = room->nx * room->nz;
    int *stack = malloc((size_t)count * sizeof *stack), open = 0;
    air->columns = calloc((size_t)count, sizeof *air->columns);
    if (!stack || !air->columns) {
        free(stack);
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    for (int i = 0; i < count; i++) {
        double height;
        /* not within hollow walls */
        if (!room_is_enclosed(&room->cells[i]) || !((double)room->cells[i].clearance > 0.4 * room->metre))
            continue;
        air->columns[i] = free_column(room, i, 0, &height);
        stack[open++] = i;
    }
    spread(air, stack, open);
    free(stack);
    find_bounds(air);
    return air->low[0] < air->high[0] ? RETEX_OK : RETEX_ENOTFOUND;
}

/* ---- what is before it ---- */

/* The part of a ray that is within the bounds. Returns 0 where there is none. */
static int clip(const Air *air, const double from[3], const double direction[3], double range[2])
{
    for (int k = 0; k < 3; k++) {
        if (direction[k] == 0) {
            if (from[k] < air->low[k] || from[k] > air->high[k])
                return 0;
            continue;
        }
        const double a = (air->low[k] - from[k]) / direction[k], b = (air->high[k] - from[k]) / direction[k];
        range[0] = fmax(range[0], fmin(a, b)), range[1] = fmin(range[1], fmax(a, b));
    }
    return range[0] < range[1];
}

static int is_in_column(const Air *air, int cell, double y)
{
    return is_air(air, cell) && y > (double)air->columns[cell].from && y < (double)air->columns[cell].to;
}

/* Whether nothing is between a point and the middle of its cell, or of one beside whose middle is not in a wall. */
static int is_free(const Air *air, const double point[3])
{
    const Room *room = air->room;
    const double size = room->cell;
    for (int i = 0; i < 9; i++) {
        static const int first[9] = {0, -1, 1, 0, 0, -1, 1, -1, 1}, second[9] = {0, 0, 0, -1, 1, -1, -1, 1, 1};
        const int cell = room_cell_at(room, point[0] + first[i] * size, point[2] + second[i] * size);
        double middle[3], way[3];
        SpaceHit hit;
        if (!is_in_column(air, cell, point[1]))
            continue;
        room_point(room, cell, 0, middle);
        middle[1] = point[1];
        for (int k = 0; k < 3; k++)
            way[k] = middle[k] - point[k];
        if (!space_ray(room->space, point, way, 0, 1, &hit))
            return 1;
    }
    return 0;
}

/* Whether a ray comes through free space within a distance. */
static int comes_through(const Air *air, const double from[3], const double direction[3], double distance)
{
    const double step = air->room->cell / 3;
    double range[2] = {0.02 * air->room->metre, distance};
    if (!clip(air, from, direction, range))
        return 0;
    const int count = (int)fmin((range[1] - range[0]) / step + 1, 10000); /* far away, t + step may be t */
    for (int i = 0; i < count; i++) {
        const double t = range[0] + i * step;
        double point[3];
        for (int k = 0; k < 3; k++)
            point[k] = from[k] + t * direction[k];
        if (is_free(air, point))
            return 1;
    }
    return 0;
}

/* 1: before the free space, -1: in or behind it, 0: beside it. */
static int side_of(const Air *air, const double eye[3], const double point[3])
{
    double away[3], back[3], length = 0;
    for (int k = 0; k < 3; k++) {
        away[k] = point[k] - eye[k];
        length += away[k] * away[k];
    }
    length = sqrt(length);
    if (!(length > 0))
        return 1;
    for (int k = 0; k < 3; k++)
        away[k] /= length, back[k] = -away[k];
    if (comes_through(air, point, back, length))
        return -1;
    return comes_through(air, point, away, INFINITY);
}

static double longest_edge(const double p[3][3])
{
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        double squared = 0;
        for (int k = 0; k < 3; k++)
            squared += pow(p[i][k] - p[(i + 1) % 3][k], 2);
        longest = fmax(longest, squared);
    }
    return sqrt(longest);
}

/* By most of its points; those beside do not count. */
static int is_before(const Air *air, const double eye[3], const double p[3][3])
{
    const double cells = longest_edge(p) / air->room->cell;
    const int n = cells < 2 ? 1 : cells < 12 ? 4 : 8;
    int before = 0, behind = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * (n - i) - 1; j++) { /* middles of n * n equal triangles */
            const double third = j % 2 ? 2.0 / 3 : 1.0 / 3, u = (i + third) / n, v = (j / 2 + third) / n;
            double point[3];
            for (int k = 0; k < 3; k++)
                point[k] = p[0][k] + u * (p[1][k] - p[0][k]) + v * (p[2][k] - p[0][k]);
            const int side = side_of(air, eye, point);
            before += side > 0, behind += side < 0;
        }
    return before > behind;
}

/* ---- meshes and objects ---- */

typedef struct Walk {
    const Air *air;
    double eye[3];      /* in the space's lengths */
    unsigned *placed;   /* by mesh: how often */
    unsigned long at;   /* object of the walk */
    int is_counting;
} Walk;

static void corners_of(const Import *import, const struct aiMesh *mesh, unsigned face, const Affine *placed,
                       double p[3][3])
{
    for (int i = 0; i < 3; i++) {
        const struct aiVector3D *v = &mesh->mVertices[mesh->mFaces[face].mIndices[i]];
        const double q[3] = {(double)v->x, (double)v->y, -(double)v->z};
        affine_point(placed, q, p[i]);
        for (int k = 0; k < 3; k++)
            p[i][k] /= import->sense->scale;
    }
}

/* Of an opaque mesh that is placed once, faces; of others, all or nothing by the number of faces. */
static void cut(Import *import, const Affine *placed, unsigned index, Walk *walk)
{
    const struct aiMesh *mesh = import->scene->mMeshes[index];
    const int is_whole = walk->placed[index] > 1 || !import->materials[mesh->mMaterialIndex].is_opaque;
    long before = 0, all = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        double p[3][3];
        if (!mesh_is_surface(mesh, &mesh->mFaces[i]))
            continue;
        corners_of(import, mesh, i, placed, p);
        all++;
        if (!is_before(walk->air, walk->eye, (const double(*)[3])p))
            continue;
        before++;
        if (!is_whole)
            mesh->mFaces[i].mNumIndices = 0;
    }
    if (is_whole && 2 * before > all) {
        import->is_dropped[walk->at] = 1;
        before = all;
    }
    import->cutaway->count += is_whole && 2 * before <= all ? 0 : before;
}

static void visit(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    const Affine placed = affine_mirror_z(world);
    Walk *walk = context;
    for (unsigned i = 0; i < node->mNumMeshes; i++, walk->at++) {
        const unsigned index = node->mMeshes[i];
        if (index >= import->scene->mNumMeshes || !affine_is_finite(&placed))
            continue;
        if (import->is_dropped[walk->at] ||
            import->scene->mMeshes[index]->mMaterialIndex >= import->scene->mNumMaterials) /* refused later */
            continue;
        if (walk->is_counting)
            walk->placed[index]++;
        else
            cut(import, &placed, index, walk);
    }
}

/* The camera sees the rooms from the right in front and above. */
static void place(const Import *import, const Air *air, Cutaway *cutaway, double eye[3])
{
    const double side[3] = {0.4, 0.75, -0.75}, scale = import->sense->scale;
    cutaway->angle = 40;
    view_fit(air->low, air->high, side, cutaway->angle, eye, cutaway->target);
    for (int k = 0; k < 3; k++) {
        cutaway->eye[k] = eye[k] * scale;
        cutaway->target[k] *= scale;
    }
}

static int fail_without_room(const Import *import, RetexError *err)
{
    return retex_fail(err, RETEX_ENOTFOUND, "--camera cutaway: %s: there is no room in it", import->options->model);
}

static int find(Import *import, Air *air, RetexError *err)
{
    Walk walk = {.air = air, .is_counting = 1};
    Cutaway *cutaway = import->cutaway = calloc(1, sizeof *cutaway);
    const int code = cutaway ? find_air(air, err) : retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (code == RETEX_ENOTFOUND)
        return fail_without_room(import, err);
    if (code)
        return code;
    place(import, air, cutaway, walk.eye);
    walk.placed = calloc((size_t)import->scene->mNumMeshes + 1, sizeof *walk.placed);
    int done = walk.placed && import_visit_nodes(import, visit, &walk);
    walk.at = 0, walk.is_counting = 0;
    done = done && import_visit_nodes(import, visit, &walk);
    free(walk.placed);
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}

int cutaway_find(Import *import, RetexError *err)
{
    const Sense *sense = import->sense;
    if (!sense_camera_is(import, "cutaway"))
        return RETEX_OK;
    if (!sense || !sense->space || !sense->room.is_found || sense->room.is_solid || !(sense->room.enclosed > 0.5))
        return fail_without_room(import, err);
    Air air = {.room = &sense->room};
    const int code = find(import, &air, err);
    free(air.columns);
    return code;
}
