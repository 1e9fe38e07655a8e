/* A tree of boxes. Nodes are split in the middle of where their items are, along the longest side. */
#include "base/bvh.h"

enum {
    LEAF = 2,
    MAX_SPLITS = 48, /* by position; below, by halves */
    MAX_DEPTH = MAX_SPLITS + 32,
};

/* ---- boxes ---- */

static double lesser(double a, double b)
{
    return a < b ? a : b;
}
static double greater(double a, double b)
{
    return a > b ? a : b;
}

Bounds bounds_empty(void)
{
    return (Bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

Bounds bounds_everywhere(void)
{
    return (Bounds){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
}

void bounds_add(Bounds *b, Vec3 p)
{
    *b = bounds_join(*b, (Bounds){p, p});
}

Bounds bounds_join(Bounds a, Bounds b)
{
    return (Bounds){vec3(lesser(a.low.x, b.low.x), lesser(a.low.y, b.low.y), lesser(a.low.z, b.low.z)),
                    vec3(greater(a.high.x, b.high.x), greater(a.high.y, b.high.y), greater(a.high.z, b.high.z))};
}

Bounds bounds_meet(Bounds a, Bounds b)
{
    return (Bounds){vec3(greater(a.low.x, b.low.x), greater(a.low.y, b.low.y), greater(a.low.z, b.low.z)),
                    vec3(lesser(a.high.x, b.high.x), lesser(a.high.y, b.high.y), lesser(a.high.z, b.high.z))};
}

int bounds_is_empty(const Bounds *b)
{
    return !(b->low.x <= b->high.x && b->low.y <= b->high.y && b->low.z <= b->high.z);
}

int bounds_is_finite(const Bounds *b)
{
    return isfinite(b->low.x) && isfinite(b->low.y) && isfinite(b->low.z) && isfinite(b->high.x) &&
           isfinite(b->high.y) && isfinite(b->high.z);
}

Bounds bounds_padded(Bounds b)
{
    const double all[6] = {b.low.x, b.low.y, b.low.z, b.high.x, b.high.y, b.high.z};
    double pad = 0;

    for (int i = 0; i < 6; i++)
        if (isfinite(all[i]))
            pad = greater(pad, 1e-12 * fabs(all[i]));
    return (Bounds){vec_sub(b.low, vec3(pad, pad, pad)), vec_add(b.high, vec3(pad, pad, pad))};
}

static double middle(const Bounds *b, int axis)
{
    return 0.5 * vec_component(b->low, axis) + 0.5 * vec_component(b->high, axis);
}

/* ---- building ---- */

static void swap_items(Bvh *bvh, int i, int j)
{
    const int item = bvh->items[i];
    const Bounds bounds = bvh->bounds[i];

    bvh->items[i] = bvh->items[j], bvh->bounds[i] = bvh->bounds[j];
    bvh->items[j] = item, bvh->bounds[j] = bounds;
}

/* Reorders the items of a node by where their middles are; returns how many lie below. */
static int partition(Bvh *bvh, int first, int count)
{
    Bounds range = bounds_empty();
    int below = first, axis = 0;
    Vec3 size;

    for (int i = first; i < first + count; i++) {
        const Bounds *b = &bvh->bounds[i];
        bounds_add(&range, vec3(middle(b, 0), middle(b, 1), middle(b, 2)));
    }
    size = vec_sub(range.high, range.low);
    for (int k = 1; k < 3; k++)
        if (vec_component(size, k) > vec_component(size, axis))
            axis = k;
    const double split = middle(&range, axis);
    for (int i = first; i < first + count; i++)
        if (middle(&bvh->bounds[i], axis) < split)
            swap_items(bvh, below++, i);
    return below - first;
}

static void split(Bvh *bvh, int index, int depth)
{
    BvhNode *node = &bvh->nodes[index];
    int below, left;

    node->bounds = bounds_empty();
    for (int i = node->first; i < node->first + node->count; i++)
        node->bounds = bounds_join(node->bounds, bvh->bounds[i]);
    if (node->count <= LEAF)
        return;
    below = depth < MAX_SPLITS ? partition(bvh, node->first, node->count) : 0;
    if (below == 0 || below == node->count)
        below = node->count / 2;
    left = bvh->nnodes;
    bvh->nnodes += 2;
    bvh->nodes[left] = (BvhNode){.first = node->first, .count = below};
    bvh->nodes[left + 1] = (BvhNode){.first = node->first + below, .count = node->count - below};
    node->first = left;
    node->count = 0;
    split(bvh, left, depth + 1);
    split(bvh, left + 1, depth + 1);
}

int bvh_create(Bvh *bvh, Arena *arena, const Bounds *bounds, int count)
{
    const size_t n = (size_t)count + 1;

    *bvh = (Bvh){.nitems = count};
    bvh->items = arena_alloc(arena, n * sizeof *bvh->items);
    bvh->bounds = arena_alloc(arena, n * sizeof *bvh->bounds);
    bvh->nodes = arena_alloc(arena, 2 * n * sizeof *bvh->nodes);
    if (!bvh->items || !bvh->bounds || !bvh->nodes)
        return 0;
    for (int i = 0; i < count; i++)
        bvh->items[i] = i, bvh->bounds[i] = bounds[i];
    bvh->nodes[0] = (BvhNode){.count = count};
    bvh->nnodes = 1;
    if (count > 0)
        split(bvh, 0, 0);
    return 1;
}

/* ---- walks ---- */

/* A ray with the reciprocals of its direction; no part is 0, so that none of the products is NaN. */
typedef struct BoxRay {
    Vec3 origin, reciprocal;
} BoxRay;

static double reciprocal(double d)
{
    return 1 / (fabs(d) > 1e-300 ? d : 1e-300);
}

static BoxRay box_ray(const Ray *ray)
{
    const Vec3 d = ray->direction;

    return (BoxRay){ray->origin, vec3(reciprocal(d.x), reciprocal(d.y), reciprocal(d.z))};
}

/* Where the ray enters the box; INFINITY where it does not before tmax. */
static inline double enters(const Bounds *b, const BoxRay *ray, double tmin, double tmax)
{
    double x0 = (b->low.x - ray->origin.x) * ray->reciprocal.x, x1 = (b->high.x - ray->origin.x) * ray->reciprocal.x;
    double y0 = (b->low.y - ray->origin.y) * ray->reciprocal.y, y1 = (b->high.y - ray->origin.y) * ray->reciprocal.y;
    double z0 = (b->low.z - ray->origin.z) * ray->reciprocal.z, z1 = (b->high.z - ray->origin.z) * ray->reciprocal.z;
    double near = greater(greater(lesser(x0, x1), lesser(y0, y1)), greater(lesser(z0, z1), tmin));
    double far = lesser(lesser(greater(x0, x1), greater(y0, y1)), lesser(greater(z0, z1), tmax));

    /* Each distance is good to a few roundings of itself. */
    return near <= far + 1e-15 * fabs(far) ? near : INFINITY;
}

int bvh_along_ray(const Bvh *bvh, Ray *ray, BvhRayVisit *visit, void *context)
{
    struct {
        int node;
        double near;
    } stack[MAX_DEPTH + 1];
    const BoxRay box = box_ray(ray);
    int depth = 0;

    if (bvh->nitems == 0 || enters(&bvh->nodes[0].bounds, &box, ray->tmin, ray->tmax) == INFINITY)
        return 0;
    stack[depth++].node = 0, stack[0].near = ray->tmin;
    while (depth > 0) {
        const BvhNode *node = &bvh->nodes[stack[--depth].node];
        if (!(stack[depth].near <= ray->tmax))
            continue;
        for (int i = node->first; i < node->first + node->count; i++)
            if (enters(&bvh->bounds[i], &box, ray->tmin, ray->tmax) < INFINITY && visit(context, ray, bvh->items[i]))
                return 1;
        if (node->count > 0)
            continue;
        double a = enters(&bvh->nodes[node->first].bounds, &box, ray->tmin, ray->tmax);
        double b = enters(&bvh->nodes[node->first + 1].bounds, &box, ray->tmin, ray->tmax);
        const int second = b < a;
        if (greater(a, b) < INFINITY)
            stack[depth].node = node->first + !second, stack[depth++].near = greater(a, b);
        if (lesser(a, b) < INFINITY)
            stack[depth].node = node->first + second, stack[depth++].near = lesser(a, b);
    }
    return 0;
}

int bvh_at_point(const Bvh *bvh, Vec3 p, BvhPointVisit *visit, void *context)
{
    int stack[MAX_DEPTH + 1], depth = 0;

    if (bvh->nitems == 0)
        return 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const BvhNode *node = &bvh->nodes[stack[--depth]];
        if (!bounds_contain(&node->bounds, p))
            continue;
        for (int i = node->first; i < node->first + node->count; i++)
            if (bounds_contain(&bvh->bounds[i], p) && visit(context, p, bvh->items[i]))
                return 1;
        if (node->count == 0) {
            stack[depth++] = node->first;
            stack[depth++] = node->first + 1;
        }
    }
    return 0;
}
