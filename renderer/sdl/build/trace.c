/* Rays against objects that are not placed: trace(), and the crossings of a mesh for inside().
 *
 * An object is flattened once into primitives in world space with a tree of boxes over them, and a mesh has a tree of
 * its own over its faces, in its own space. Both are kept for the next call, by the address of what they were made of:
 * objects and meshes never change, and live as long as the scene. */
#include "sdl/build/builder.h"
#include "shape/shape.h"

#define NEAREST 1e-4 /* nothing is hit closer than that, as in POV-Ray */
#define LEAF 4
#define MAX_SPLITS 48 /* by position; below, by halves */

/* ---- boxes ---- */

typedef struct Bounds {
    Vec3 low, high;
} Bounds;

typedef struct Node {
    Bounds bounds;
    int first, count; /* of items in the order of the tree; count 0: children at first and first + 1 */
} Node;

typedef struct Tree {
    Node *nodes;
    int nnodes;
    int *items;
    Bounds *bounds; /* of each item */
} Tree;

static const Bounds nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void widen(Bounds *b, Vec3 p)
{
    b->low = vec3(fmin(b->low.x, p.x), fmin(b->low.y, p.y), fmin(b->low.z, p.z));
    b->high = vec3(fmax(b->high.x, p.x), fmax(b->high.y, p.y), fmax(b->high.z, p.z));
}

/* A little larger, so that rounding loses nothing. */
static Bounds padded(Bounds b)
{
    double size = fmax(vec_length(b.low), vec_length(b.high)) * 1e-12;
    Vec3 more = vec3(size, size, size);
    return (Bounds){vec_sub(b.low, more), vec_add(b.high, more)};
}

static double along(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static double middle(const Bounds *b, int axis)
{
    return 0.5 * along(b->low, axis) + 0.5 * along(b->high, axis);
}

/* Reorders the items of a node by the middle of where they are; the number of those below. */
static int partition(const Tree *tree, int first, int count)
{
    Bounds range = nothing;
    int *items = tree->items + first, below = 0, axis = 0;
    for (int i = 0; i < count; i++) {
        const Bounds *b = &tree->bounds[items[i]];
        widen(&range, vec3(middle(b, 0), middle(b, 1), middle(b, 2)));
    }
    Vec3 size = vec_sub(range.high, range.low);
    for (int k = 1; k < 3; k++)
        if (along(size, k) > along(size, axis))
            axis = k;
    const double split = middle(&range, axis);
    for (int i = 0; i < count; i++)
        if (middle(&tree->bounds[items[i]], axis) < split) {
            int swapped = items[below];
            items[below++] = items[i];
            items[i] = swapped;
        }
    return below;
}

static void split(Tree *tree, int index, int depth)
{
    Node *node = &tree->nodes[index];
    node->bounds = nothing;
    for (int i = node->first; i < node->first + node->count; i++) {
        widen(&node->bounds, tree->bounds[tree->items[i]].low);
        widen(&node->bounds, tree->bounds[tree->items[i]].high);
    }
    if (node->count <= LEAF)
        return;
    int below = depth < MAX_SPLITS ? partition(tree, node->first, node->count) : 0;
    if (below == 0 || below == node->count)
        below = node->count / 2;
    const int left = tree->nnodes;
    tree->nnodes += 2;
    tree->nodes[left] = (Node){.first = node->first, .count = below};
    tree->nodes[left + 1] = (Node){.first = node->first + below, .count = node->count - below};
    node->first = left;
    node->count = 0;
    split(tree, left, depth + 1);
    split(tree, left + 1, depth + 1);
}

static void tree_make(Sdl *sdl, Tree *tree, Bounds *bounds, int count)
{
    sdl_step(sdl, count);
    tree->bounds = bounds;
    tree->items = sdl_alloc(sdl, (size_t)(count + 1) * sizeof *tree->items);
    tree->nodes = sdl_alloc(sdl, (size_t)(2 * count + 2) * sizeof *tree->nodes);
    for (int i = 0; i < count; i++)
        tree->items[i] = i;
    tree->nnodes = 1;
    tree->nodes[0] = (Node){.count = count};
    if (count > 0)
        split(tree, 0, 0);
}

static int crosses(const Bounds *b, const Ray *ray)
{
    double from = ray->tmin, to = ray->tmax;
    for (int k = 0; k < 3; k++) {
        double o = along(ray->origin, k), d = along(ray->direction, k);
        double low = along(b->low, k) - o, high = along(b->high, k) - o;
        if (d == 0) {
            if (low > 0 || high < 0)
                return 0;
            continue;
        }
        from = fmax(from, fmin(low / d, high / d));
        to = fmin(to, fmax(low / d, high / d));
    }
    return from <= to;
}

/* Calls item for everything whose box the ray crosses; item may shorten the ray. */
typedef void Visit(Sdl *sdl, void *context, Ray *ray, int item);

static void tree_walk(Sdl *sdl, const Tree *tree, int index, Ray *ray, Visit *visit, void *context)
{
    const Node *node = &tree->nodes[index];
    sdl_step(sdl, 1);
    if (!crosses(&node->bounds, ray))
        return;
    for (int i = node->first; i < node->first + node->count; i++)
        if (crosses(&tree->bounds[tree->items[i]], ray))
            visit(sdl, context, ray, tree->items[i]);
    if (node->count == 0 && tree->nnodes > 1) {
        tree_walk(sdl, tree, node->first, ray, visit, context);
        tree_walk(sdl, tree, node->first + 1, ray, visit, context);
    }
}

/* ---- what is kept ---- */

/* An object or a mesh, ready for rays. */
typedef struct Traced {
    const void *made_of;
    Tree tree;
    Primitive *primitives;  /* of an object: first those without bounds, then those of the tree */
    const Object **objects; /* … which they were made of */
    int nprimitives, nunbounded;
    struct Traced *next;
} Traced;

enum { BUCKETS = 1024 };
struct Tracer {
    Traced *buckets[BUCKETS];
    Scene scene; /* borrows the primitives of the object in question, for surface_at */
};

static struct Tracer *tracer_of(Sdl *sdl)
{
    Builder *builder = builder_of(sdl);
    if (!builder->tracer)
        builder->tracer = sdl_alloc(sdl, sizeof *builder->tracer);
    return builder->tracer;
}

/* The one made of that; *fresh: it has to be made. */
static Traced *traced(Sdl *sdl, const void *made_of, int *fresh)
{
    Traced **bucket = &tracer_of(sdl)->buckets[((uintptr_t)made_of >> 4) * 2654435761u % BUCKETS];
    *fresh = 0;
    for (Traced *t = *bucket; t; t = t->next)
        if (t->made_of == made_of)
            return t;
    Traced *t = sdl_alloc(sdl, sizeof *t);
    t->made_of = made_of;
    t->next = *bucket;
    *bucket = t;
    *fresh = 1;
    return t;
}

/* ---- meshes ---- */

static const Tree *mesh_tree(Sdl *sdl, const Mesh *mesh)
{
    int fresh;
    Traced *t = traced(sdl, mesh, &fresh);
    if (!fresh)
        return &t->tree;
    Bounds *bounds = sdl_alloc(sdl, (size_t)(mesh->nfaces + 1) * sizeof *bounds);
    for (int i = 0; i < mesh->nfaces; i++) {
        bounds[i] = nothing;
        for (int k = 0; k < 3; k++)
            widen(&bounds[i], mesh->vertices[mesh->faces[i].vertex[k]]);
        bounds[i] = padded(bounds[i]);
    }
    tree_make(sdl, &t->tree, bounds, mesh->nfaces);
    return &t->tree;
}

typedef struct MeshHit {
    const Mesh *mesh;
    int face, crossings;
    double b1, b2;
} MeshHit;

static int triangle_hit(const Mesh *mesh, int face, const Ray *ray, double *t, double *b1, double *b2)
{
    const int *v = mesh->faces[face].vertex;
    Vec3 p0 = mesh->vertices[v[0]], e1 = vec_sub(mesh->vertices[v[1]], p0), e2 = vec_sub(mesh->vertices[v[2]], p0);
    Vec3 across = vec_cross(ray->direction, e2), from = vec_sub(ray->origin, p0), over = vec_cross(from, e1);
    const double volume = vec_dot(e1, across);
    *b1 = vec_dot(from, across) / volume;
    *b2 = vec_dot(ray->direction, over) / volume;
    *t = vec_dot(e2, over) / volume;
    return volume != 0 && *b1 >= 0 && *b2 >= 0 && *b1 + *b2 <= 1 && *t > ray->tmin && *t < ray->tmax;
}

static void nearest_face(Sdl *sdl, void *context, Ray *ray, int face)
{
    (void)sdl;
    MeshHit *hit = context;
    double t, b1, b2;
    if (!triangle_hit(hit->mesh, face, ray, &t, &b1, &b2))
        return;
    ray->tmax = t;
    *hit = (MeshHit){hit->mesh, face, 1, b1, b2};
}

static void count_face(Sdl *sdl, void *context, Ray *ray, int face)
{
    (void)sdl;
    MeshHit *hit = context;
    double t, b1, b2;
    hit->crossings += triangle_hit(hit->mesh, face, ray, &t, &b1, &b2);
}

int mesh_contains(Sdl *sdl, const Mesh *mesh, Vec3 p)
{
    MeshHit hit = {.mesh = mesh};
    Ray ray = {p, vec3(0.4472135, 0.8944272, 0.0031415), 0, INFINITY}; /* any that is along no edges */
    tree_walk(sdl, mesh_tree(sdl, mesh), 0, &ray, count_face, &hit);
    return hit.crossings & 1;
}

static Ray ray_into(const Transform *t, const Ray *ray)
{
    return (Ray){transform_inverse_point(t, ray->origin), transform_inverse_vector(t, ray->direction), ray->tmin,
                 ray->tmax};
}

/* Normals as POV-Ray has them: of smooth triangles what is written, of others by the order of the corners, which turn
 * the other way round in polygons. (POV-Ray reorders a single triangle's corners when it is transformed, so that its
 * normal may come out turned round there.) */
static Vec3 mesh_normal(const Object *object, const Transform *t, const MeshHit *hit)
{
    const Mesh *mesh = hit->mesh;
    const MeshFace *f = &mesh->faces[hit->face];
    if (f->normal[0] >= 0 && f->normal[1] >= 0 && f->normal[2] >= 0) {
        const double weights[3] = {1 - hit->b1 - hit->b2, hit->b1, hit->b2};
        Vec3 sum = {0, 0, 0};
        for (int i = 0; i < 3; i++) {
            Vec3 n = transform_normal(t, vec_normalize(mesh->normals[f->normal[i]]));
            sum = vec_mad(sum, object->single_triangle ? vec_normalize(n) : n, weights[i]);
        }
        return sum;
    }
    Vec3 p0 = mesh->vertices[f->vertex[0]];
    Vec3 n = vec_cross(vec_sub(mesh->vertices[f->vertex[1]], p0), vec_sub(mesh->vertices[f->vertex[2]], p0));
    n = transform_normal(t, n);
    return object->polygon ? n : vec_neg(n);
}

/* ---- objects ---- */

typedef struct Flattener {
    Traced *traced;
    int capacity, object_capacity;
} Flattener;

static void flatten(Sdl *sdl, Flattener *f, const Object *object, const Transform *outer, unsigned inverse)
{
    object_report(sdl, object);
    sdl_step(sdl, 1);
    const Transform to_world = transform_then(object->transform, *outer);
    inverse ^= object->flags & OBJECT_INVERSE;
    if (object->kind == OBJECT_SHAPE) {
        Traced *t = f->traced;
        t->primitives = builder_grow(sdl, t->primitives, t->nprimitives, &f->capacity, sizeof *t->primitives);
        t->objects = builder_grow(sdl, t->objects, t->nprimitives, &f->object_capacity, sizeof *t->objects);
        t->objects[t->nprimitives] = object;
        t->primitives[t->nprimitives++] =
            (Primitive){.shape = object->shape, .transform = to_world, .inverse = inverse != 0, .target = -1};
        return;
    }
    Transform within = to_world;
    if (object->kind == OBJECT_LIGHT) /* what it looks like */
        within = transform_then(transform_translate(object->light->location), to_world);
    for (const ObjectList *list = object->children; list; list = list->next)
        flatten(sdl, f, list->object, &within, inverse);
}

/* Shapes without bounds go to the front. */
static void unbounded_first(Traced *t)
{
    for (int i = 0; i < t->nprimitives; i++)
        if (!t->primitives[i].shape.ops->bounds) {
            const Primitive p = t->primitives[i];
            const Object *o = t->objects[i];
            t->primitives[i] = t->primitives[t->nunbounded];
            t->objects[i] = t->objects[t->nunbounded];
            t->primitives[t->nunbounded] = p;
            t->objects[t->nunbounded++] = o;
        }
}

static Traced *traced_object(Sdl *sdl, const Object *object)
{
    int fresh;
    Traced *t = traced(sdl, object, &fresh);
    if (!fresh)
        return t;
    const Transform none = transform_identity();
    flatten(sdl, &(Flattener){.traced = t}, object, &none, 0);
    unbounded_first(t);
    const int count = t->nprimitives - t->nunbounded;
    Bounds *bounds = sdl_alloc(sdl, (size_t)(count + 1) * sizeof *bounds);
    for (int i = 0; i < count; i++) {
        shape_bounds(&t->primitives[t->nunbounded + i], &bounds[i].low, &bounds[i].high);
        bounds[i] = padded(bounds[i]);
    }
    tree_make(sdl, &t->tree, bounds, count);
    return t;
}

typedef struct ObjectHit {
    const Traced *traced;
    Hit hit;
    MeshHit mesh;
} ObjectHit;

static void nearest_primitive(Sdl *sdl, void *context, Ray *ray, int index)
{
    ObjectHit *found = context;
    const Primitive *p = &found->traced->primitives[index];
    Hit hit = {.primitive = index};
    if (p->shape.mesh) {
        MeshHit mesh = {.mesh = p->shape.mesh};
        Ray local = ray_into(&p->transform, ray);
        tree_walk(sdl, mesh_tree(sdl, p->shape.mesh), 0, &local, nearest_face, &mesh);
        if (!mesh.crossings)
            return;
        hit.t = local.tmax;
        found->mesh = mesh;
    } else if (!shape_intersect(p, ray, &hit.t, &hit.face))
        return;
    else if (p->shape.ops->face_normal)
        hit.normal = p->shape.ops->face_normal(p, hit.face, NULL);
    ray->tmax = hit.t;
    found->hit = hit;
}

static void nearest_bounded(Sdl *sdl, void *context, Ray *ray, int item)
{
    nearest_primitive(sdl, context, ray, ((ObjectHit *)context)->traced->nunbounded + item);
}

static Vec3 normal_at(Sdl *sdl, const ObjectHit *found, const Ray *ray)
{
    const Traced *t = found->traced;
    const Primitive *p = &t->primitives[found->hit.primitive];
    if (p->shape.mesh) {
        const Object *object = t->objects[found->hit.primitive];
        Vec3 n = vec_normalize(mesh_normal(object, &p->transform, &found->mesh));
        return p->inverse && !object->single_triangle ? vec_neg(n) : n;
    }
    Scene *scene = &tracer_of(sdl)->scene;
    Surface surface;
    scene->primitives = t->primitives;
    surface_at(&surface, scene, ray, &found->hit);
    return surface.geometric_normal;
}

int object_trace(Sdl *sdl, const Value *value, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal)
{
    *point = *normal = vec3(0, 0, 0);
    if (value->kind != VALUE_OBJECT && value->kind != VALUE_LIGHT)
        return 0;
    Ray ray = {from, vec_normalize(direction), NEAREST, INFINITY};
    ObjectHit found = {.traced = traced_object(sdl, value->data), .hit.primitive = -1};
    const Vec3 all = vec_add(from, ray.direction);
    if (!isfinite(all.x + all.y + all.z) || vec_length(ray.direction) == 0)
        return 1;
    sdl_step(sdl, found.traced->nunbounded);
    for (int i = 0; i < found.traced->nunbounded; i++)
        nearest_primitive(sdl, &found, &ray, i);
    tree_walk(sdl, &found.traced->tree, 0, &ray, nearest_bounded, &found);
    if (found.hit.primitive < 0)
        return 1;
    *point = vec_mad(ray.origin, ray.direction, found.hit.t);
    *normal = normal_at(sdl, &found, &ray);
    return 1;
}
