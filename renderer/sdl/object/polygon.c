/* polygon: rings of points in a plane, filled by the even-odd rule, cut into triangles.
 *
 * A convex ring becomes a fan. All else is cut into horizontal slabs between consecutive heights at which something
 * happens (a corner, a crossing of two edges); within a slab no edges cross, so that sorted from left to right each
 * pair of edges bounds a trapezoid. That is right for holes, islands and rings that cross themselves alike. */
#include <stdlib.h>
#include <string.h>
#include "sdl/object/shape.h"

#define MAX_POINTS 20000
#define EDGES_A_STEP 16 /* that are looked at in the time of a step */

typedef struct Edge {
    Vec2 low, high;
} Edge; /* low.v < high.v */
typedef struct Crossing {
    double bottom, top, middle;
} Crossing; /* u of an edge within a slab */

typedef struct Triangles {
    Vec2 *corners; /* three each */
    int count, capacity;
} Triangles;

static void add(Sdl *sdl, Triangles *out, Vec2 a, Vec2 b, Vec2 c)
{
    double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    if (area == 0)
        return;
    for (int i = 0; i < 3; i++) {
        out->corners = sdl_grow(sdl, out->corners, out->count, &out->capacity, sizeof *out->corners);
        out->corners[out->count++] = i == 0 ? a : (i == 1) == (area > 0) ? b : c;
    }
}

/* ---- a convex ring ---- */

static double turn(Vec2 a, Vec2 b, Vec2 c)
{
    return (b.u - a.u) * (c.v - b.v) - (b.v - a.v) * (c.u - b.u);
}

static int is_convex(const Vec2 *p, int n)
{
    int left = 0, right = 0, flips = 0;
    for (int i = 0; i < n; i++) {
        double t = turn(p[i], p[(i + 1) % n], p[(i + 2) % n]);
        left |= t > 0;
        right |= t < 0;
        /* A star turns one way all along too, but changes direction in u more than twice. */
        double before = p[(i + 1) % n].u - p[i].u, after = p[(i + 2) % n].u - p[(i + 1) % n].u;
        flips += before * after < 0 || (before != 0 && after == 0);
    }
    return !(left && right) && flips <= 2;
}

/* ---- slabs ---- */

static int by_height(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int by_middle(const void *a, const void *b)
{
    double x = ((const Crossing *)a)->middle, y = ((const Crossing *)b)->middle;
    return (x > y) - (x < y);
}

static double edge_at(const Edge *e, double v)
{
    if (v <= e->low.v)
        return e->low.u;
    if (v >= e->high.v)
        return e->high.u;
    return e->low.u + (e->high.u - e->low.u) * ((v - e->low.v) / (e->high.v - e->low.v));
}

static int collect_edges(Edge *edges, const Vec2 *points, const int *starts, int nrings)
{
    int n = 0;
    for (int r = 0; r < nrings; r++)
        for (int i = starts[r]; i < starts[r + 1]; i++) {
            Vec2 a = points[i], b = points[i + 1 < starts[r + 1] ? i + 1 : starts[r]];
            if (a.v != b.v)
                edges[n++] = a.v < b.v ? (Edge){a, b} : (Edge){b, a};
        }
    return n;
}

static int crossing_height(const Edge *a, const Edge *b, double *v)
{
    double low = fmax(a->low.v, b->low.v), high = fmin(a->high.v, b->high.v);
    if (!(low < high))
        return 0;
    double d0 = edge_at(a, low) - edge_at(b, low), d1 = edge_at(a, high) - edge_at(b, high);
    if (!(d0 * d1 < 0))
        return 0;
    *v = low + (high - low) * (d0 / (d0 - d1));
    return *v > low && *v < high;
}

static double *heights(Sdl *sdl, const Edge *edges, int n, int *count)
{
    int capacity = 0;
    double *all = NULL, v;
    *count = 0;
    for (int i = 0; i < n; i++) {
        sdl_step(sdl, 1 + i / EDGES_A_STEP);
        for (int end = 0; end < 2; end++) {
            all = sdl_grow(sdl, all, *count, &capacity, sizeof *all);
            all[(*count)++] = end ? edges[i].high.v : edges[i].low.v;
        }
        for (int j = 0; j < i; j++)
            if (crossing_height(&edges[i], &edges[j], &v)) {
                all = sdl_grow(sdl, all, *count, &capacity, sizeof *all);
                all[(*count)++] = v;
            }
    }
    if (*count > 0)
        qsort(all, (size_t)*count, sizeof *all, by_height);
    return all;
}

static void slab(Sdl *sdl, Triangles *out, const Edge *edges, int n, Crossing *crossings, double low, double high)
{
    int count = 0;
    double middle = low + (high - low) * 0.5;
    sdl_step(sdl, 1 + n / EDGES_A_STEP);
    for (int i = 0; i < n; i++)
        if (edges[i].low.v <= low && edges[i].high.v >= high)
            crossings[count++] =
                (Crossing){edge_at(&edges[i], low), edge_at(&edges[i], high), edge_at(&edges[i], middle)};
    qsort(crossings, (size_t)count, sizeof *crossings, by_middle);
    for (int i = 0; i + 1 < count; i += 2) {
        const Crossing *l = &crossings[i], *r = &crossings[i + 1];
        add(sdl, out, (Vec2){l->bottom, low}, (Vec2){r->bottom, low}, (Vec2){r->top, high});
        add(sdl, out, (Vec2){l->bottom, low}, (Vec2){r->top, high}, (Vec2){l->top, high});
    }
}

/* starts[r]..starts[r + 1] are the points of ring r. The corners come three for a triangle, counter-clockwise. */
static int triangulate(Sdl *sdl, const Vec2 *points, const int *starts, int nrings, Vec2 **corners, int *ncorners)
{
    Triangles out = {0};
    if (nrings == 1 && is_convex(points, starts[1])) {
        for (int i = 1; i + 1 < starts[1]; i++)
            add(sdl, &out, points[0], points[i], points[i + 1]);
    } else {
        int count;
        Edge *edges = sdl_alloc(sdl, (size_t)starts[nrings] * sizeof *edges);
        int n = collect_edges(edges, points, starts, nrings);
        Crossing *crossings = sdl_alloc(sdl, (size_t)(n + 1) * sizeof *crossings);
        double *all = heights(sdl, edges, n, &count);
        for (int i = 0; i + 1 < count; i++)
            if (all[i] < all[i + 1])
                slab(sdl, &out, edges, n, crossings, all[i], all[i + 1]);
    }
    *corners = out.corners;
    *ncorners = out.count;
    return out.count / 3;
}

/* ---- reading ---- */

static int same_point(Vec3 a, Vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Rings: each ends where its first point comes again. Gives starts[] and packs the points. */
static int split_rings(Sdl *sdl, Vec3 *points, int n, int *starts)
{
    int rings = 0, packed = 0, i = 0;
    while (i < n) {
        int first = packed;
        starts[rings] = first;
        points[packed++] = points[i++];
        while (i < n && !same_point(points[i], points[first]))
            points[packed++] = points[i++];
        if (i == n)
            sdl_warn(sdl, "a polygon whose last point is not its first: it is closed");
        i++;
        if (packed - first >= 3)
            rings++;
        else
            packed = first;
    }
    starts[rings] = packed;
    return rings;
}

/* Newell's normal over all rings: right for any ring, however its first corners lie. */
static Vec3 newell(const Vec3 *p, const int *starts, int nrings)
{
    Vec3 best = vec3(0, 0, 0);
    for (int r = 0; r < nrings; r++) {
        Vec3 sum = vec3(0, 0, 0), o = p[starts[r]];
        for (int i = starts[r]; i < starts[r + 1]; i++) {
            int j = i + 1 < starts[r + 1] ? i + 1 : starts[r];
            sum = vec_add(sum, vec_cross(vec_sub(p[i], o), vec_sub(p[j], o)));
        }
        if (vec_length(sum) > vec_length(best))
            best = sum;
    }
    return best;
}

/* A ring that crosses itself evenly (a bow tie) has Newell normal zero: then any corner that turns. */
static Vec3 polygon_normal(const Vec3 *p, const int *starts, int nrings)
{
    Vec3 normal = newell(p, starts, nrings);
    for (int i = 1; i + 1 < starts[nrings] && vec_length(normal) == 0; i++)
        normal = vec_cross(vec_sub(p[i], p[0]), vec_sub(p[i + 1], p[0]));
    return vec_normalize(normal);
}

static Mesh *flat_mesh(Sdl *sdl, const Vec2 *corners, int n, Vec3 origin, Vec3 s, Vec3 t)
{
    Mesh *mesh = sdl_alloc(sdl, sizeof *mesh);
    mesh->nvertices = n;
    mesh->vertices = sdl_alloc(sdl, (size_t)n * sizeof *mesh->vertices);
    mesh->nfaces = n / 3;
    mesh->faces = sdl_alloc(sdl, (size_t)mesh->nfaces * sizeof *mesh->faces);
    for (int i = 0; i < n; i++) {
        mesh->vertices[i] = vec_mad(vec_mad(origin, s, corners[i].u), t, corners[i].v);
        MeshFace *face = &mesh->faces[i / 3];
        face->vertex[i % 3] = i;
        face->normal[i % 3] = face->uv[i % 3] = -1;
        face->texture = -1;
    }
    return mesh;
}

static void build(Sdl *sdl, Object *object, Vec3 *points, int n)
{
    int *starts = sdl_alloc(sdl, (size_t)(n + 1) * sizeof *starts);
    int nrings = split_rings(sdl, points, n, starts), ncorners;
    Vec3 normal = polygon_normal(points, starts, nrings), s, t;
    Vec2 *flat = sdl_alloc(sdl, (size_t)(n + 1) * sizeof *flat), *corners;
    vec_frame(normal, &s, &t);
    for (int i = 0; i < starts[nrings]; i++) {
        Vec3 d = vec_sub(points[i], points[0]);
        flat[i] = (Vec2){vec_dot(d, s), vec_dot(d, t)};
    }
    object->shape.ops = &shape_mesh;
    if (vec_length(normal) == 0 || nrings == 0 ||
        triangulate(sdl, flat, starts, nrings, &corners, &ncorners) == 0) {
        sdl_warn(sdl, "a polygon without area: it is left out");
        object->kind = OBJECT_EMPTY;
        return;
    }
    object->polygon = 1;
    object->shape.mesh = flat_mesh(sdl, corners, ncorners, points[0], s, t);
}

void parse_polygon(Sdl *sdl, Object *object)
{
    double count = sdl_float(sdl);
    if (!(count >= 3 && count <= MAX_POINTS))
        sdl_error(sdl, "a polygon has 3 to %d points, not %g", MAX_POINTS, count);
    int n = (int)count;
    Vec3 *points = sdl_alloc(sdl, (size_t)n * sizeof *points);
    for (int i = 0; i < n; i++) {
        sdl_optional_comma(sdl);
        points[i] = sdl_vector(sdl);
    }
    build(sdl, object, points, n);
}
