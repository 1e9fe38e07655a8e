/* Building the light tree. */
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>
#include "light/light_tree_nodes.h"

#define WIDTH LIGHT_TREE_WIDTH
#define BUCKETS 12 /* along each axis: a range may be split between any two of them */

typedef struct Builder {
    LightTree *tree;
    const LightBounds *lights;
    int *order;     /* the lights, so that every cluster has a range of them */
    double extent2; /* squared, of all lights: at this distance intensity and constant are compared */
    int nnodes;
} Builder;

/* Lights of one cluster, by their places in the order. */
typedef struct Range {
    int first, end;
    double cost; /* of having them together */
} Range;

/* Lights of one bucket. */
typedef struct Bucket {
    int count;
    double power;
    Vec3 low, high, facing; /* facing: sum of their axes by power */
} Bucket;

static double light_power(const Builder *b, const LightBounds *l)
{
    return l->intensity + l->constant * b->extent2;
}

static Vec3 center_of(const LightBounds *l)
{
    return vec_scale(vec_add(l->low, l->high), 0.5);
}

static void bucket_clear(Bucket *b)
{
    *b = (Bucket){0, 0, {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, {0, 0, 0}};
}

static void grow(Bucket *b, Vec3 low, Vec3 high)
{
    b->low = vec_min(b->low, low), b->high = vec_max(b->high, high);
}

/* The axis of a light that emits on both sides has no sign: it is turned to the side of another axis. */
static Vec3 turned_axis(const LightBounds *l, Vec3 to)
{
    return l->back_share == 1 && vec_dot(l->axis, to) < 0 ? vec_neg(l->axis) : l->axis;
}

static void bucket_add(Bucket *b, const LightBounds *l, double power, Vec3 facing)
{
    b->count++;
    b->power += power;
    grow(b, l->low, l->high);
    if (l->theta_o < PI)
        b->facing = vec_mad(b->facing, turned_axis(l, facing), power);
}

static void bucket_merge(Bucket *b, const Bucket *other)
{
    b->count += other->count;
    b->power += other->power;
    grow(b, other->low, other->high);
    b->facing = vec_add(b->facing, other->facing);
}

/* Power times surface area times the solid angle of emission (the paper's SAOH). The solid angle is estimated by how
 * well the axes agree, as that can be summed and cones cannot. */
static double bucket_cost(const Bucket *b)
{
    if (b->count == 0 || b->power <= 0)
        return 0;
    Vec3 d = vec_sub(b->high, b->low);
    double agree = fmin(1, vec_length(b->facing) / b->power);
    return b->power * (d.x * d.y + d.y * d.z + d.z * d.x) * (1 + 3 * sqrt(1 - agree));
}

/* The cone round the axes of a range; returns the half-angle. */
static double range_cone(const Builder *b, int first, int end, Vec3 *axis)
{
    Vec3 reference = b->lights[b->order[first]].axis, sum = {0, 0, 0};
    for (int k = first; k < end; k++)
        sum = vec_add(sum, turned_axis(&b->lights[b->order[k]], reference));
    *axis = vec_normalize(sum);
    double theta_o = vec_dot(*axis, *axis) > 0 ? 0 : PI;
    for (int k = first; k < end && theta_o < PI; k++) {
        const LightBounds *l = &b->lights[b->order[k]];
        double cosine = vec_dot(turned_axis(l, *axis), *axis);
        if (l->theta_o > 0 || cosine < cos(theta_o))
            theta_o = fmin(PI, fmax(theta_o, l->theta_o + acos(fmax(-1, fmin(1, cosine)))));
    }
    return theta_o;
}

static void fill_child(const Builder *b, LightTreeNode *node, int k, const Range *range)
{
    double constant = 0, intensity = 0, peak = 0, theta_e = 0, power = 0;
    float both_sides = 0, least = 0;
    Bucket box;
    Vec3 axis;
    bucket_clear(&box);
    for (int i = range->first; i < range->end; i++) {
        const LightBounds *l = &b->lights[b->order[i]];
        grow(&box, l->low, l->high);
        constant += l->constant, intensity += l->intensity, peak += l->peak, power += light_power(b, l);
        theta_e = fmax(theta_e, l->theta_e);
        if (l->back_share == 1)
            both_sides = 1;
        else
            least = fmaxf(least, (float)l->back_share);
    }
    double theta_o = range_cone(b, range->first, range->end, &axis);
    Vec3 center = vec_scale(vec_add(box.low, box.high), 0.5);
    double radius = vec_length(vec_sub(box.high, box.low)) / 2;
    node->x[k] = (float)center.x, node->y[k] = (float)center.y, node->z[k] = (float)center.z;
    node->radius[k] = (float)(radius * 1.0001);
    node->axis_x[k] = (float)axis.x, node->axis_y[k] = (float)axis.y, node->axis_z[k] = (float)axis.z;
    node->cos_theta_o[k] = (float)cos(theta_o), node->sin_theta_o[k] = (float)sin(theta_o);
    node->cos_theta_e[k] = (float)cos(theta_e);
    node->both_sides[k] = both_sides, node->least[k] = least;
    node->constant[k] = (float)constant, node->intensity[k] = (float)intensity, node->power[k] = (float)power;
    node->soft2[k] = fmaxf(1e-12f, (float)(radius * radius + (peak > 0 ? intensity / peak : 0)));
}

/* The bucket of a place along an axis. */
static int bucket_of(double x, double low, double high)
{
    int k = (int)((x - low) / (high - low) * BUCKETS);
    return k < 0 ? 0 : k >= BUCKETS ? BUCKETS - 1 : k;
}

/* Cheapest way to split buckets in two: before bucket *at. */
static double cheapest_split(const Bucket *buckets, int *at)
{
    double above[BUCKETS + 1], best = INFINITY;
    Bucket sum;
    bucket_clear(&sum);
    for (int k = BUCKETS - 1; k > 0; k--) {
        bucket_merge(&sum, &buckets[k]);
        above[k] = sum.count > 0 ? bucket_cost(&sum) : INFINITY;
    }
    bucket_clear(&sum);
    for (int k = 1; k < BUCKETS; k++) {
        bucket_merge(&sum, &buckets[k - 1]);
        double cost = sum.count > 0 ? bucket_cost(&sum) + above[k] : INFINITY;
        if (cost < best)
            best = cost, *at = k;
    }
    return best;
}

typedef struct Cut {
    int axis, at; /* axis -1: in halves, as they are */
    double low, high;
} Cut;

static Cut find_cut(const Builder *b, int first, int end)
{
    Bucket centers, buckets[3][BUCKETS];
    bucket_clear(&centers);
    for (int k = first; k < end; k++) {
        Vec3 c = center_of(&b->lights[b->order[k]]);
        grow(&centers, c, c);
    }
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < BUCKETS; k++)
            bucket_clear(&buckets[axis][k]);
    Vec3 facing = b->lights[b->order[first]].axis, extent = vec_sub(centers.high, centers.low);
    double longest = fmax(extent.x, fmax(extent.y, extent.z));
    for (int k = first; k < end; k++) {
        const LightBounds *l = &b->lights[b->order[k]];
        Vec3 c = center_of(l);
        double power = light_power(b, l);
        for (int axis = 0; axis < 3; axis++)
            if (vec_component(extent, axis) > 0)
                bucket_add(&buckets[axis][bucket_of(vec_component(c, axis), vec_component(centers.low, axis),
                                                    vec_component(centers.high, axis))],
                           l, power, facing);
    }
    Cut best = {-1, 0, 0, 0};
    double least = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        int at = 0;
        if (!(vec_component(extent, axis) > 0))
            continue;
        /* thin slabs cost more than their surface area tells */
        double cost = cheapest_split(buckets[axis], &at) * longest / vec_component(extent, axis);
        if (cost < least || best.axis < 0)
            least = cost, best = (Cut){axis, at, vec_component(centers.low, axis), vec_component(centers.high, axis)};
    }
    return best;
}

static double range_cost(const Builder *b, const Range *range)
{
    Bucket sum;
    bucket_clear(&sum);
    Vec3 facing = b->lights[b->order[range->first]].axis;
    for (int k = range->first; k < range->end; k++) {
        const LightBounds *l = &b->lights[b->order[k]];
        bucket_add(&sum, l, light_power(b, l), facing);
    }
    return bucket_cost(&sum);
}

/* Split a range in two; `range` keeps the first part. */
static void cut_range(Builder *b, Range *range, Range *rest)
{
    Cut cut = find_cut(b, range->first, range->end);
    int middle = range->first;
    for (int k = range->first; k < range->end && cut.axis >= 0; k++) {
        int light = b->order[k];
        if (bucket_of(vec_component(center_of(&b->lights[light]), cut.axis), cut.low, cut.high) < cut.at) {
            b->order[k] = b->order[middle];
            b->order[middle++] = light;
        }
    }
    if (middle == range->first || middle == range->end)
        middle = range->first + (range->end - range->first) / 2;
    RETEX_ASSERT(middle > range->first && middle < range->end); /* neither part is empty */
    *rest = (Range){middle, range->end, 0};
    range->end = middle;
    range->cost = range_cost(b, range);
    rest->cost = range_cost(b, rest);
}

/* The range of the highest cost that can be split, or -1. */
static int costliest(const Range *ranges, int count)
{
    int best = -1;
    for (int k = 0; k < count; k++)
        if (ranges[k].end - ranges[k].first > 1 && (best < 0 || ranges[k].cost > ranges[best].cost))
            best = k;
    return best;
}

static void build(Builder *b, Range range, int parent)
{
    LightTree *tree = b->tree;
    Range ranges[WIDTH] = {range};
    int count = 1, index = b->nnodes++, dear;
    /* the first node is the whole alone */
    while (index > 0 && count < WIDTH && (dear = costliest(ranges, count)) >= 0) {
        cut_range(b, &ranges[dear], &ranges[count]);
        count++;
    }
    RETEX_ASSERT(index == 0 ? count == 1 : count >= 2); /* so there are at most as many nodes as lights, and one */
    LightTreeNode *node = &tree->nodes[index];
    memset(node, 0, sizeof *node);
    node->count = count;
    node->parent = parent;
    for (int k = 0; k < WIDTH; k++)
        node->soft2[k] = 1;
    for (int k = 0; k < count; k++) {
        int place = index * WIDTH + k;
        fill_child(b, node, k, &ranges[k]);
        if (ranges[k].end - ranges[k].first == 1) {
            node->child[k] = -1 - b->order[ranges[k].first];
            tree->places[b->order[ranges[k].first]] = place;
        } else {
            node->child[k] = b->nnodes;
            build(b, ranges[k], place);
        }
    }
}

int light_tree_create(LightTree **out, const LightBounds *lights, int count, RetexError *err)
{
    LightTree *tree = calloc(1, sizeof *tree);
    Builder b = {.tree = tree, .lights = lights};
    Bucket all;
    *out = tree;
    b.order = malloc((size_t)count * sizeof *b.order);
    if (tree) {
        /* every node but the first has two children at least */
        tree->nodes = malloc(((size_t)count + 1) * sizeof *tree->nodes);
        tree->places = malloc((size_t)count * sizeof *tree->places);
    }
    if (!tree || !b.order || !tree->nodes || !tree->places) {
        free(b.order);
        light_tree_close(out);
        return retex_fail(err, RETEX_ENOMEM, "out of memory for a tree over %d lights", count);
    }
    bucket_clear(&all);
    for (int k = 0; k < count; k++) {
        b.order[k] = k;
        grow(&all, lights[k].low, lights[k].high);
    }
    Vec3 extent = vec_sub(all.high, all.low);
    b.extent2 = fmax(vec_dot(extent, extent), 1e-12);
    build(&b, (Range){0, count, 0}, -1);
    LightTreeNode *fitting = realloc(tree->nodes, (size_t)b.nnodes * sizeof *tree->nodes);
    if (fitting)
        tree->nodes = fitting;
    free(b.order);
    return RETEX_OK;
}

void light_tree_close(LightTree **tree)
{
    if (!*tree)
        return;
    free((*tree)->nodes);
    free((*tree)->places);
    free(*tree);
    *tree = NULL;
}
