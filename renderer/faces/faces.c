/* See faces.h. */
#include <stdlib.h>
#include <string.h>
#include "base/digest.h"
#include "faces/faces.h"
#include "shape/shape.h"

enum { EDGE_FACES_MAX = 64 }; /* that are compared at one edge; where more meet, it is no surface */

int faces_count(const Primitive *p)
{
    if (p->shape.mesh)
        return p->shape.mesh->nfaces;
    return p->shape.ops == &shape_box ? 6 : p->shape.ops->properties & SHAPE_FLAT ? 1 : 0;
}

/* ---- one face ---- */

static int set_area(Face *face)
{
    const Vec3 *c = face->corners;
    face->area = vec_length(vec_cross(vec_sub(c[1], c[0]), vec_sub(c[2], c[0]))) / 2;
    if (face->ncorners == 4)
        face->area *= 2;
    return face->area > 0 && isfinite(face->area);
}

static int triangle(const Primitive *p, int number, Face *face)
{
    const Mesh *mesh = p->shape.mesh;
    face->ncorners = 3;
    for (int k = 0; k < 3; k++)
        face->corners[k] = transform_point(&p->transform, mesh->vertices[mesh->faces[number].vertex[k]]);
    if (!set_area(face))
        return 0;
    face->normal = p->shape.ops->face_normal(p, number, face->corners);
    return 1;
}

static int side_of_box(const Primitive *p, int number, Face *face)
{
    static const double around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const int axis = number / 2;
    face->ncorners = 4;
    for (int k = 0; k < 4; k++) {
        double at[3];
        at[axis] = number & 1, at[(axis + 1) % 3] = around[k][0], at[(axis + 2) % 3] = around[k][1];
        face->corners[k] = transform_point(&p->transform, vec3(at[0], at[1], at[2]));
    }
    face->normal = p->shape.ops->face_normal(p, number, face->corners);
    return set_area(face);
}

static int whole(const Primitive *p, Face *face)
{
    ShapePoint at;
    p->shape.ops->point(p, vec3(0, 0, 0), 0, &at);
    face->ncorners = 1;
    face->corners[0] = transform_point(&p->transform, at.p);
    face->normal = shape_world_normal(p, at.normal);
    face->area = p->shape.ops->area ? p->shape.ops->area(p) : INFINITY;
    return 1;
}

int faces_at(const Primitive *p, int number, Face *face)
{
    if (p->shape.mesh)
        return triangle(p, number, face);
    return p->shape.ops == &shape_box ? side_of_box(p, number, face) : whole(p, face);
}

int faces_placed(const Primitive *p, const Instance *instance, int number, Face *face)
{
    if (!faces_at(p, number, face))
        return 0;
    if (!instance)
        return 1;
    for (int k = 0; k < face->ncorners; k++)
        face->corners[k] = transform_point(&instance->transform, face->corners[k]);
    face->normal = vec_normalize(transform_normal(&instance->transform, face->normal));
    return face->ncorners < 3 || set_area(face);
}

/* ---- faces that are flat with each other ---- */

/* Vertices by their coordinates, and edges by their ends: tables of chains of equal keys. */
typedef struct Flat {
    const Primitive *primitive;
    const Mesh *mesh;
    int *same;       /* of each vertex, the first one in the same place */
    int *heads;      /* by hash: the last vertex, or the last edge + 1, in a chain; 0: none */
    int *next;       /* in its chain */
    unsigned mask;
    int *label;      /* of each face: another one that is flat with it, or itself; -1: no area */
    Vec3 *normal;    /* of each face's winding, of unit length, in the world */
} Flat;

static unsigned hash(const void *bytes, size_t size)
{
    return (unsigned)digest_bytes(DIGEST_BEGIN, bytes, size);
}

static void find_same_vertices(Flat *f)
{
    for (int v = 0; v < f->mesh->nvertices; v++) {
        const Vec3 p = f->mesh->vertices[v];
        const double key[3] = {p.x + 0.0, p.y + 0.0, p.z + 0.0}; /* no -0 */
        int *head = &f->heads[hash(key, sizeof key) & f->mask], other = *head;
        while (other) {
            const Vec3 q = f->mesh->vertices[other - 1];
            if (p.x == q.x && p.y == q.y && p.z == q.z)
                break;
            other = f->next[other - 1];
        }
        f->same[v] = other ? other - 1 : v;
        if (!other)
            f->next[v] = *head, *head = v + 1;
    }
}

/* The ends of the k-th edge of a face, the lower first; 1 where the face runs the other way. */
static int edge_ends(const Flat *f, int face, int k, int ends[2])
{
    const int *vertex = f->mesh->faces[face].vertex;
    const int a = f->same[vertex[k]], b = f->same[vertex[(k + 1) % 3]];
    ends[0] = a < b ? a : b, ends[1] = a < b ? b : a;
    return a > b;
}

/* Its label, with shorter ways to it. The label of all is the lowest. */
static int root(int *label, int face)
{
    while (label[face] != face)
        face = label[face] = label[label[face]];
    return face;
}

static void join(int *label, int a, int b)
{
    a = root(label, a), b = root(label, b);
    if (a < b)
        label[b] = a;
    else
        label[a] = b;
}

/* Faces that run along an edge in opposite ways have their windings on one side; the normals of others are turned. */
static int bends_little(const Flat *f, int a, int b, int same_way)
{
    const double cosine = vec_dot(f->normal[a], f->normal[b]);
    return (same_way ? -cosine : cosine) >= cos(FLAT_DEGREES * PI / 180);
}

static void join_over_edges(Flat *f)
{
    for (int edge = 0; edge < 3 * f->mesh->nfaces; edge++) {
        const int face = edge / 3;
        int ends[2], compared = 0;
        if (f->label[face] < 0)
            continue;
        const int way = edge_ends(f, face, edge % 3, ends);
        int *head = &f->heads[hash(ends, sizeof ends) & f->mask];
        for (int other = *head; other && compared < EDGE_FACES_MAX; other = f->next[other - 1]) {
            int theirs[2];
            const int their_way = edge_ends(f, (other - 1) / 3, (other - 1) % 3, theirs);
            if (theirs[0] != ends[0] || theirs[1] != ends[1])
                continue;
            compared++;
            if (bends_little(f, face, (other - 1) / 3, way == their_way))
                join(f->label, face, (other - 1) / 3);
        }
        f->next[edge] = *head, *head = edge + 1;
    }
}

static void set_normals(Flat *f)
{
    for (int i = 0; i < f->mesh->nfaces; i++) {
        const int *v = f->mesh->faces[i].vertex;
        Vec3 corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = transform_point(&f->primitive->transform, f->mesh->vertices[v[k]]);
        const Vec3 n = vec_cross(vec_sub(corner[1], corner[0]), vec_sub(corner[2], corner[0]));
        const double length = vec_length(n);
        f->label[i] = length > 0 && isfinite(length) ? i : -1;
        f->normal[i] = vec_scale(n, shape_inverse(length));
    }
}

static int *flat_of_mesh(const Primitive *p)
{
    Flat f = {.primitive = p, .mesh = p->shape.mesh};
    const size_t nfaces = (size_t)f.mesh->nfaces, nvertices = (size_t)f.mesh->nvertices;
    const size_t most = 3 * nfaces > nvertices ? 3 * nfaces : nvertices;
    size_t buckets = 16;
    while (buckets < most)
        buckets *= 2;
    f.mask = (unsigned)(buckets - 1);
    f.same = malloc((nvertices + 1) * sizeof *f.same);
    f.heads = calloc(buckets, sizeof *f.heads);
    f.next = malloc((most + 1) * sizeof *f.next);
    f.normal = malloc((nfaces + 1) * sizeof *f.normal);
    f.label = malloc((nfaces + 1) * sizeof *f.label);
    const int made = f.same && f.heads && f.next && f.normal && f.label;
    if (made) {
        set_normals(&f);
        find_same_vertices(&f);
        memset(f.heads, 0, buckets * sizeof *f.heads);
        join_over_edges(&f);
        for (int i = 0; i < f.mesh->nfaces; i++)
            if (f.label[i] >= 0)
                f.label[i] = root(f.label, i);
    }
    free(f.same), free(f.heads), free(f.next), free(f.normal);
    if (!made)
        free(f.label);
    return made ? f.label : NULL;
}

int *faces_flat(const Primitive *p)
{
    if (p->shape.mesh)
        return flat_of_mesh(p);
    int *label = malloc(6 * sizeof *label);
    for (int k = 0; label && k < 6; k++)
        label[k] = k;
    return label;
}

/* ---- levels ---- */

/* The areas of a closed surface, as vectors, add up to nothing. */
static int is_open(const Primitive *p)
{
    const Mesh *mesh = p->shape.mesh;
    Vec3 sum = {0, 0, 0};
    double area = 0;
    for (int i = 0; mesh && i < mesh->nfaces; i++) {
        const Vec3 *v = mesh->vertices;
        const int *at = mesh->faces[i].vertex;
        const Vec3 n = vec_cross(vec_sub(v[at[1]], v[at[0]]), vec_sub(v[at[2]], v[at[0]]));
        sum = vec_add(sum, n);
        area += vec_length(n);
    }
    return mesh ? vec_length(sum) > 1e-6 * area : p->shape.ops == &shape_disc;
}

static double diagonal(Vec3 low, Vec3 high)
{
    const double size = vec_length(vec_sub(high, low));
    return low.x <= high.x && isfinite(size) ? size : INFINITY;
}

/* Of everything that has bounds: of prototypes as they are, which is near enough for a tolerance. */
double faces_scene_size(const Scene *scene)
{
    Vec3 low = {INFINITY, INFINITY, INFINITY}, high = vec_neg(low), one_low, one_high;
    for (int k = 0; k < scene->nprimitives; k++)
        if (!scene->primitives[k].prototype && shape_bounds(&scene->primitives[k], &one_low, &one_high)) {
            shape_bound_point(&low, &high, one_low);
            shape_bound_point(&low, &high, one_high);
        }
    return diagonal(low, high);
}

static double tolerance(const Primitive *p, double scene_size)
{
    Vec3 low, high;
    const double own = shape_bounds(p, &low, &high) ? diagonal(low, high) : INFINITY;
    const double least = fmin(own / 100, scene_size / 2000);
    return isfinite(least) ? least : 1e-3;
}

FaceOwner faces_owner(const Scene *scene, const Primitive *p, double scene_size)
{
    FaceOwner owner = {p, -1, is_open(p), tolerance(p, scene_size)};
    for (int k = 0; p->prototype && owner.first_copy < 0 && k < scene->ninstances; k++)
        if (scene->instances[k].prototype == p->prototype)
            owner.first_copy = k;
    return owner;
}

int faces_is_on_level(const FaceLevel *level, const Face *face, int is_open)
{
    const double cosine = vec_dot(face->normal, level->normal);
    if ((is_open || level->is_open ? fabs(cosine) : cosine) < cos(FLAT_DEGREES * PI / 180))
        return 0;
    for (int k = 0; k < face->ncorners; k++)
        if (fabs(vec_dot(vec_sub(face->corners[k], level->point), level->normal)) > level->tolerance)
            return 0;
    /* Of a plane one point is there, and there is no end to it. */
    return isfinite(face->area) || vec_length(vec_cross(face->normal, level->normal)) < 1e-6;
}

static int is_placed_on_level(const FaceLevel *level, const FaceOwner *owner, const Instance *instance, int face)
{
    Face at;
    return faces_placed(owner->primitive, instance, face, &at) && faces_is_on_level(level, &at, owner->is_open);
}

int faces_are_on_level(const FaceLevel *level, const Scene *scene, const FaceOwner *owner, int face)
{
    const Prototype *prototype = owner->primitive->prototype;
    if (owner->first_copy < 0)
        return !prototype && is_placed_on_level(level, owner, NULL, face);
    for (int k = owner->first_copy; k < scene->ninstances; k++)
        if (scene->instances[k].prototype == prototype &&
            !is_placed_on_level(level, owner, &scene->instances[k], face))
            return 0;
    return 1;
}

int faces_check(const Scene *scene, const FaceSelection *of, RetexError *err)
{
    const Primitive *p = &scene->primitives[of->number - 1];
    const int count = faces_count(p);
    Face face;
    if (!count)
        return retex_fail(err, RETEX_EUNSUPPORTED,
                          "target `%s`: a %s has no flat faces; of meshes, boxes, planes and discs faces can be "
                          "targets: #%d, or @X:Y/object, takes all of it",
                          of->text, p->shape.ops->name, of->number);
    if (of->face > count || !faces_at(p, of->face - 1, &face))
        return retex_fail(err, RETEX_ENOTFOUND, "no face `%s`: object #%d has %d", of->text, of->number, count);
    return RETEX_OK;
}

int faces_level_of(FaceLevel *level, const Scene *scene, const FaceOwner *owner, int face_number)
{
    const Primitive *p = owner->primitive;
    const Instance *instance = owner->first_copy < 0 ? NULL : &scene->instances[owner->first_copy];
    Face face;
    if ((p->prototype && !instance) || !faces_placed(p, instance, face_number, &face))
        return RETEX_ENOTFOUND;
    *level = (FaceLevel){{0, 0, 0}, face.normal, owner->tolerance, owner->is_open};
    for (int k = 0; k < face.ncorners; k++)
        level->point = vec_mad(level->point, face.corners[k], 1.0 / face.ncorners);
    return faces_are_on_level(level, scene, owner, face_number) ? RETEX_OK : RETEX_EUNSUPPORTED;
}

int faces_level(FaceLevel *level, const Scene *scene, const FaceSelection *of, RetexError *err)
{
    int code = faces_check(scene, of, err);
    if (code)
        return code;
    const FaceOwner owner = faces_owner(scene, &scene->primitives[of->number - 1], faces_scene_size(scene));
    code = faces_level_of(level, scene, &owner, of->face - 1);
    if (code == RETEX_ENOTFOUND)
        retex_fail(err, code, "no face `%s` in the scene", of->text);
    else if (code)
        retex_fail(err, code,
                   "target `%s`: object #%d has copies on several levels; #%d/flat:%d takes the face in all of them",
                   of->text, of->number, of->number, of->face);
    return code;
}
