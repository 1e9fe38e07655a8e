/* Constructive solid geometry. Rays find operands through a tree of boxes over all leaves of a root, and points through
 * one over the children of each node, so that an operand costs something only where it is. */
#include <stdlib.h>
#include <string.h>
#include "shape/csg.h"
#include "shape/shape.h"
#include "shape/surface.h"

/* ---- inside ---- */

/* The answer of a child that decides for its node: of an intersection outside, else inside. */
static int decisive(const CsgNode *node)
{
    return node->kind != CSG_INTERSECTION;
}

typedef struct PointQuery {
    const CsgNode *node, *except;
} PointQuery;

static int local_decides(void *context, Vec3 p, int item)
{
    const PointQuery *query = context;
    const CsgNode *child = query->node->local[item];

    return child != query->except && csg_inside(child, p) == decisive(query->node);
}

/* Whether a child, but for that one, gives the deciding answer. */
static int decided(const CsgNode *node, const CsgNode *except, Vec3 p)
{
    PointQuery query = {node, except};

    for (int i = 0; i < node->nwide; i++)
        if (node->wide[i] != except && csg_inside(node->wide[i], p) == decisive(node))
            return 1;
    return bvh_at_point(&node->tree, p, local_decides, &query);
}

static int clips_keep(const CsgNode *node, Vec3 p)
{
    for (const CsgNode *clip = node->clips; clip; clip = clip->next)
        if (!csg_inside(clip, p))
            return 0;
    return 1;
}

static int leaf_inside(const Primitive *primitive, Vec3 p)
{
    const Shape *shape = &primitive->shape;

    return (shape->ops->inside && shape->ops->inside(shape, transform_inverse_point(&primitive->transform, p))) ^
           (primitive->inverse != 0);
}

int csg_inside(const CsgNode *node, Vec3 p)
{
    if (!bounds_contain(&node->solid, p))
        return node->outside;
    if (!clips_keep(node, p))
        return 0;
    if (node->kind == CSG_LEAF)
        return leaf_inside(node->primitive, p);
    return decided(node, NULL, p) == decisive(node);
}

int csg_on_surface(const CsgNode *leaf, Vec3 p)
{
    for (const CsgNode *node = leaf; node; node = node->parent) {
        const CsgNode *parent = node->parent;
        if (!clips_keep(node, p))
            return 0;
        if (parent && parent->kind != CSG_UNION && decided(parent, node, p))
            return 0;
    }
    return 1;
}

/* ---- rays ---- */

/* As in POV-Ray, where along the ray it meets the bounds does not matter. */
static int meets_bounds(const CsgNode *leaf, const Ray *ray)
{
    for (const CsgNode *node = leaf; node; node = node->parent)
        for (const Csg *bound = node->bounds; bound; bound = bound->next) {
            CsgQuery query = {.ray = {ray->origin, ray->direction, 0, INFINITY}, .any = 1};
            if (!csg_intersect(bound, &query) && !csg_inside(bound->root, ray->origin))
                return 0;
        }
    return 1;
}

/* Crossings of a leaf one after the other, until one is on the result. */
static int test_leaf(CsgQuery *query, Ray *ray, const CsgNode *leaf)
{
    Ray rest = *ray;
    double t;
    int face = 0;

    while (shape_intersect(leaf->primitive, &rest, &t, &face)) {
        if (csg_on_surface(leaf, vec_mad(ray->origin, ray->direction, t))) {
            if ((query->accept && !query->accept(query->context, leaf->index)) || !meets_bounds(leaf, ray))
                return 0;
            query->leaf = leaf, query->t = ray->tmax = t, query->face = face;
            return query->any;
        }
        if (!(t > rest.tmin))
            return 0;
        rest.tmin = t;
    }
    return 0;
}

typedef struct LeafQuery {
    const Csg *csg;
    CsgQuery *query;
} LeafQuery;

static int test_local_leaf(void *context, Ray *ray, int item)
{
    const LeafQuery *of = context;

    return test_leaf(of->query, ray, of->csg->leaves[of->csg->nunbounded + item]);
}

int csg_intersect(const Csg *csg, CsgQuery *query)
{
    LeafQuery of = {csg, query};
    Ray ray = query->ray;

    query->leaf = NULL;
    for (int i = 0; i < csg->nunbounded; i++)
        if (test_leaf(query, &ray, csg->leaves[i]))
            return 1;
    bvh_along_ray(&csg->tree, &ray, test_local_leaf, &of);
    return query->leaf != NULL;
}

/* ---- making ---- */

CsgNode *csg_node(Arena *arena, CsgKind kind, CsgNode *parent)
{
    CsgNode *node = arena_alloc(arena, sizeof *node);

    if (!node)
        return NULL;
    node->kind = kind;
    node->parent = parent;
    if (parent) {
        *(parent->last ? &parent->last->next : &parent->children) = node;
        parent->last = node;
    }
    return node;
}

static void prepare_leaf(CsgNode *node)
{
    const Primitive *p = node->primitive;

    if (!shape_bounds(p, &node->surface.low, &node->surface.high))
        node->surface = bounds_everywhere();
    node->solid = node->surface;
    node->outside = p->inverse != 0;
    if (p->shape.ops->solid_bounds) {
        p->shape.ops->solid_bounds(p, &node->solid.low, &node->solid.high);
        node->outside = 0;
    }
    node->surface = bounds_padded(node->surface);
    node->solid = bounds_padded(node->solid);
}

/* What is inside both, or with decides = 1 inside one of them. Where one of them decides outside of its bounds, the
 * bounds of the other have no more to say there. */
static void combine_solids(CsgNode *node, const CsgNode *other, int decides)
{
    if (node->outside == decides && other->outside == decides)
        node->solid = bounds_meet(node->solid, other->solid);
    else if (other->outside == decides)
        node->solid = other->solid;
    else if (node->outside != decides)
        node->solid = bounds_join(node->solid, other->solid);
    if (other->outside == decides)
        node->outside = decides;
}

static void bound_compound(CsgNode *node)
{
    const int decides = decisive(node);

    node->solid = node->surface = bounds_empty();
    node->outside = !decides;
    for (const CsgNode *child = node->children; child; child = child->next) {
        node->surface = bounds_join(node->surface, child->surface);
        combine_solids(node, child, decides);
    }
    /* What decides against points beyond its bounds does so for the surfaces of its siblings; its own are within its
     * bounds. Unions keep surfaces that lie inside. */
    if (node->kind == CSG_UNION)
        node->solid = bounds_join(node->solid, node->surface);
    else if (node->outside == decides)
        node->surface = bounds_meet(node->surface, node->solid);
}

/* Children that decide beyond their bounds are asked always, others through the tree. */
static int sort_children(Arena *arena, CsgNode *node)
{
    int count = 0, nlocal = 0, made;
    Bounds *bounds;

    for (const CsgNode *child = node->children; child; child = child->next)
        count++;
    node->wide = arena_alloc(arena, (size_t)(count + 1) * sizeof *node->wide);
    node->local = arena_alloc(arena, (size_t)(count + 1) * sizeof *node->local);
    bounds = malloc((size_t)(count + 1) * sizeof *bounds);
    made = node->wide && node->local && bounds;
    for (CsgNode *child = node->children; made && child; child = child->next) {
        if (child->outside == decisive(node) || !bounds_is_finite(&child->solid))
            node->wide[node->nwide++] = child;
        else
            bounds[nlocal] = child->solid, node->local[nlocal++] = child;
    }
    made = made && bvh_create(&node->tree, arena, bounds, nlocal);
    free(bounds);
    return made;
}

static int prepare(Arena *arena, CsgNode *node)
{
    for (CsgNode *child = node->children; child; child = child->next)
        if (!prepare(arena, child))
            return 0;
    if (node->kind == CSG_LEAF)
        prepare_leaf(node);
    else
        bound_compound(node);
    for (CsgNode *clip = node->clips; clip; clip = clip->next) {
        if (!prepare(arena, clip))
            return 0;
        combine_solids(node, clip, 0);
        if (!clip->outside)
            node->surface = bounds_meet(node->surface, clip->solid);
    }
    for (const Csg *bound = node->bounds; bound; bound = bound->next)
        node->surface = bounds_meet(node->surface, bound->surface);
    return node->kind == CSG_LEAF || sort_children(arena, node);
}

static int count_leaves(const CsgNode *node)
{
    int sum = node->kind == CSG_LEAF;

    for (const CsgNode *child = node->children; child; child = child->next)
        sum += count_leaves(child);
    return sum;
}

typedef struct Leaves {
    CsgNode **unbounded, **local;
    Bounds *bounds; /* of the local ones */
    int nunbounded, nlocal;
} Leaves;

static void gather_leaves(Leaves *leaves, CsgNode *node, Bounds within)
{
    within = bounds_meet(within, node->surface);
    if (bounds_is_empty(&within))
        return;
    for (CsgNode *child = node->children; child; child = child->next)
        gather_leaves(leaves, child, within);
    if (node->kind != CSG_LEAF)
        return;
    if (bounds_is_finite(&within))
        leaves->bounds[leaves->nlocal] = within, leaves->local[leaves->nlocal++] = node;
    else
        leaves->unbounded[leaves->nunbounded++] = node;
}

static int sort_leaves(Arena *arena, Csg *csg)
{
    const size_t count = (size_t)count_leaves(csg->root) + 1;
    Leaves leaves = {.local = malloc(count * sizeof *leaves.local), .bounds = malloc(count * sizeof *leaves.bounds)};
    int made = 0;

    leaves.unbounded = csg->leaves = arena_alloc(arena, count * sizeof *csg->leaves);
    if (leaves.unbounded && leaves.local && leaves.bounds) {
        gather_leaves(&leaves, csg->root, bounds_everywhere());
        csg->nunbounded = leaves.nunbounded;
        memcpy(csg->leaves + leaves.nunbounded, leaves.local, (size_t)leaves.nlocal * sizeof *leaves.local);
        made = bvh_create(&csg->tree, arena, leaves.bounds, leaves.nlocal);
    }
    free(leaves.local);
    free(leaves.bounds);
    return made;
}

Csg *csg_create(Arena *arena, CsgNode *root)
{
    Csg *csg = arena_alloc(arena, sizeof *csg);

    if (!csg)
        return NULL;
    csg->root = root;
    if (!prepare(arena, root) || !sort_leaves(arena, csg))
        return NULL;
    csg->surface = root->surface;
    if (csg->nunbounded == 0) {
        /* Tighter: leaves may have less to show than their node. */
        csg->surface = csg->tree.nitems > 0 ? csg->tree.nodes[0].bounds : bounds_empty();
    }
    return csg;
}
