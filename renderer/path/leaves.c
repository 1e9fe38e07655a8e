/* See leaves.h. */
#include <string.h>
#include "path/leaves.h"
#include "path/surface_color.h"
#include "pattern/pattern.h"
#include "shade/material.h"
#include "shade/pigment.h"
#include "shape/csg.h"
#include "shade/working_space.h"

/* Where leaves are asked for. */
typedef struct Point {
    const Surface *surface;
    Vec3 wo;
    const WorkingSpace *space; /* of the scene; NULL: linear */
} Point;

static void add_texture(Leaves *leaves, const Point *at, const Texture *texture, Leaf from);

Surface leaf_surface(const Surface *surface, const Texture *texture, int target)
{
    Surface of = *surface;
    of.texture = texture, of.target = target;
    return of;
}

static int is_opaque(const Leaf *leaf)
{
    return leaf->color.filter + leaf->color.transmit <= 0;
}

/* 1: light may pass it by itself. */
static int leaf_passes(const Leaf *leaf)
{
    return !leaf->is_layer && (!is_opaque(leaf) || finish_transmits(leaf->texture->finish));
}

/* ---- leaves ---- */

static void add_leaf(Leaves *leaves, const Leaf *leaf)
{
    if (leaves->count < LEAVES_MAX)
        leaves->leaf[leaves->count++] = *leaf;
}

static void set_color(Leaf *leaf, const Point *at, const Texture *texture)
{
    leaf->texture = texture;
    leaf->target = first_target(texture->target, at->surface->target);
    const Surface surface = leaf_surface(at->surface, texture, leaf->target);
    Vec2 ignored;
    const Rgbft c = surface_color(&surface, NULL, &ignored);
    leaf->color = (Rgbft){not_negative(c.r), not_negative(c.g), not_negative(c.b), not_negative(c.filter),
                          not_negative(c.transmit)};
    leaf->opacity = pigment_opacity(texture->pigment, leaf->color);
}

/* ---- layers ---- */

/* What a layer sends on of the light from below, where its albedo is 1: *d of it by the colour. Mirrors send less, a
 * coloured one in all colours what it sends in that which it mirrors most; they and highlights are the more seen, by
 * *coat. */
static void layer_passage(const Leaf *layer, const Point *at, float *d, float *i, float *coat)
{
    const float sum = layer->color.filter + layer->color.transmit, scale = sum > 1 ? 1 / sum : 1;
    *d = layer->color.filter * scale, *i = layer->color.transmit * scale, *coat = 0;
    if (finish_is_lambert(layer->texture->finish))
        return;
    const Surface surface = leaf_surface(at->surface, layer->texture, layer->target);
    Bsdf b;
    bsdf_setup(&b, &surface, at->wo, *d, *i, layer->opacity);
    const float passes_d = rgb_min(b.passing.d), passes_i = rgb_min(b.passing.i);
    *coat = 1 - (passes_d + passes_i) / (*d + *i);
    *coat = at_most(not_negative(*coat), 1) + at_most(b.highlights, 1);
    *d = passes_d, *i = passes_i;
}

/* Goes below a layer. */
static void add_above(Leaves *leaves, const Point *at, Leaf *from, float d, float i)
{
    const float sum = d + i;
    const Rgb c = rgb(from->color.r, from->color.g, from->color.b);
    from->weight *= sum;
    d /= sum, i /= sum;
    from->neutral *= d * NEUTRAL_ALBEDO + i;
    if (from->target < 0 || d == 0) {
        const Rgb working = working_encode(at->space, c);
        from->tint = rgb_mul(from->tint, rgb_add(rgb_scale(c, d), rgb_grey(i)));
        from->working_tint = rgb_mul(from->working_tint, rgb_add(rgb_scale(working, d), rgb_grey(i)));
    } else if (leaves->nabove < LEAVES_MAX) {
        leaves->above[leaves->nabove] = (LayerAbove){from->texture, from->target, from->color, d, i, from->above};
        from->above = leaves->nabove++;
    }
}

static void set_untinted(Leaf *layer)
{
    layer->color.transmit += layer->color.filter, layer->color.filter = 0;
    layer->opacity = pigment_opacity(layer->texture->pigment, layer->color);
}

/* The layer itself. Returns 0 where nothing below it is seen; else from is what is below. */
static int add_layer(Leaves *leaves, const Point *at, Leaf *from)
{
    const Finish *finish = from->texture->finish;
    float d, i, coat;
    if (is_opaque(from) || finish_transmits(finish)) {
        from->chance = from->weight;
        add_leaf(leaves, from);
        return 0;
    }
    layer_passage(from, at, &d, &i, &coat);
    Leaf self = *from;
    if (finish_is_lambert(finish)) /* as an opaque one that counts less */
        self.weight *= self.opacity, self.color.filter = self.color.transmit = 0, self.opacity = 1,
                                     self.chance = self.weight;
    else
        self.is_layer = 1, self.chance = self.weight * (self.opacity + coat);
    if (self.chance > 0)
        add_leaf(leaves, &self);
    if (!(d + i > 0))
        return 0;
    add_above(leaves, at, from, d, i);
    return 1;
}

static void add_layers(Leaves *leaves, const Point *at, const TextureTree *tree, Leaf from)
{
    for (int k = 0; k < tree->count; k++) {
        if (tree->parts[k]->tree || k == tree->count - 1) {
            add_texture(leaves, at, tree->parts[k], from);
            return;
        }
        set_color(&from, at, tree->parts[k]);
        if (tree->is_untinted)
            set_untinted(&from);
        if (!add_layer(leaves, at, &from))
            return;
    }
}

/* ---- maps ---- */

static void add_part(Leaves *leaves, const Point *at, const TextureTree *tree, int part, float weight, Leaf from)
{
    from.weight *= weight;
    if (weight > 0)
        add_texture(leaves, at, tree->parts[part], from);
}

/* Turbulence and warps of a map's pattern disturb its textures too. */
static Surface warped_surface(const Point *at, const TextureTree *tree)
{
    Surface surface = *at->surface;
    Vec3 p = surface_texture_point(&surface);
    if (pigment_warp(tree->selector, &p))
        surface.position = surface.instance ? transform_point(&surface.instance->transform, p) : p;
    return surface;
}

static Vec2 selector_uv(const Point *at, const Pigment *selector)
{
    return selector->uv_mapping ? surface_uv(at->surface).uv : (Vec2){0, 0};
}

/* As pigment maps: of several entries at exactly the value the first one counts. */
static void add_map(Leaves *leaves, const Point *at, const TextureTree *tree, Leaf from)
{
    const double *values = tree->values;
    const PatternPoint point = surface_pattern_point(at->surface);
    const int last = tree->count - 1, chooses = tree->selector->pattern.ops->colors > 0;
    const double value = pigment_value(tree->selector, &point, selector_uv(at, tree->selector));
    const Surface warped = warped_surface(at, tree);
    const Point within = {&warped, at->wo, at->space};
    int k = 0;
    if (chooses) {
        add_part(leaves, &within, tree, value < last ? (int)value : last, 1, from);
        return;
    }
    while (k < last && value > values[k])
        k++;
    const float share = k > 0 && value < values[k] && values[k] > values[k - 1]
                            ? (float)((value - values[k - 1]) / (values[k] - values[k - 1]))
                            : 1;
    add_part(leaves, &within, tree, k, share, from);
    if (share < 1)
        add_part(leaves, &within, tree, k - 1, 1 - share, from);
}

/* ---- operands ---- */

static int is_within(const CsgNode *node, const CsgNode *ancestor)
{
    while (node && node != ancestor)
        node = node->parent;
    return node != NULL;
}

/* Whether the point is inside an operand as far as the compounds around it let it be; those that contain the surface
 * itself are not asked. */
static int operand_contains(const CsgNode *node, const CsgNode *surface, Vec3 p)
{
    for (; node && !is_within(surface, node); node = node->parent)
        if (!csg_inside(node, p))
            return 0;
    return 1;
}

static void add_operands(Leaves *leaves, const Point *at, const TextureTree *tree, Leaf from)
{
    const CsgNode *surface = at->surface->primitive->csg;
    const Vec3 p = surface_texture_point(at->surface);
    int counts[LEAVES_MAX], parts[LEAVES_MAX], nparts = 0, sum = 0;
    for (int k = 0; k < tree->count && nparts < LEAVES_MAX; k++) {
        int count = 0;
        for (int j = 0; j < tree->operands[k].count; j++)
            count += operand_contains(tree->operands[k].nodes[j], surface, p);
        if (count > 0)
            parts[nparts] = k, counts[nparts++] = count, sum += count;
    }
    for (int i = 0; i < nparts; i++)
        add_part(leaves, at, tree, parts[i], (float)counts[i] / (float)sum, from);
    if (!nparts)
        add_part(leaves, at, tree, 0, 1, from);
}

/* By the index, round and round. */
static int material_at(const Point *at, const TextureTree *tree)
{
    return pigment_index(tree->selector, surface_texture_point(at->surface), selector_uv(at, tree->selector)) %
           tree->count;
}

/* ---- the tree ---- */

static void add_texture(Leaves *leaves, const Point *at, const Texture *texture, Leaf from)
{
    const TextureTree *tree = texture->tree;
    if (!tree) {
        set_color(&from, at, texture);
        from.chance = from.weight;
        add_leaf(leaves, &from);
        return;
    }
    switch (tree->kind) {
    case TEXTURE_LAYERS:
        add_layers(leaves, at, tree, from);
        break;
    case TEXTURE_MAP:
        add_map(leaves, at, tree, from);
        break;
    case TEXTURE_AVERAGE:
        for (int k = 0; k < tree->count; k++)
            add_part(leaves, at, tree, k, (float)tree->values[k], from);
        break;
    case TEXTURE_OPERANDS:
        add_operands(leaves, at, tree, from);
        break;
    case TEXTURE_MATERIALS:
        add_part(leaves, at, tree, material_at(at, tree), 1, from);
        break;
    }
}

/* ---- leaves together ---- */

static float seen(const Leaf *leaf)
{
    return leaf->weight * (leaf->is_layer ? leaf->opacity : 1);
}

static Rgb tinted(const Leaf *leaf, float weight)
{
    return rgb_scale(rgb_mul(rgb(leaf->color.r, leaf->color.g, leaf->color.b), leaf->tint), weight);
}

/* POV-Ray adds colours as numbers of the working space. */
static int blends_as_written(const Leaf *leaf)
{
    return leaf->target < 0 && leaf->above < 0 && (leaf->is_layer || leaf->color.filter <= 0);
}

static float ratio(float a, float b)
{
    return b > 0 ? a / b : 1;
}

/* Darkens the colours of leaves so that they show together what POV-Ray shows. Light that passes is none of it, and
 * what targets show stays linear in their albedo. */
static void blend_in_working_space(Leaves *leaves, const WorkingSpace *space)
{
    Rgb written = {0, 0, 0}, linear = {0, 0, 0};
    float weights = 0;
    for (int k = 0; k < leaves->count; k++) {
        const Leaf *leaf = &leaves->leaf[k];
        const float weight = blends_as_written(leaf) ? seen(leaf) : 0;
        const Rgb c = rgb(leaf->color.r, leaf->color.g, leaf->color.b);
        written = rgb_add(written, rgb_scale(rgb_mul(working_encode(space, c), leaf->working_tint), weight));
        linear = rgb_add(linear, tinted(leaf, weight));
        weights += weight;
    }
    if (!(weights > 0))
        return;
    weights = at_most(weights, 1);
    const Rgb sum = rgb_scale(working_decode(space, rgb_scale(written, 1 / weights)), weights);
    const Rgb by = rgb(ratio(sum.r, linear.r), ratio(sum.g, linear.g), ratio(sum.b, linear.b));
    for (int k = 0; k < leaves->count; k++) {
        Rgbft *c = &leaves->leaf[k].color;
        if (blends_as_written(&leaves->leaf[k]))
            c->r *= by.r, c->g *= by.g, c->b *= by.b;
    }
}

static int same_finish(const Texture *a, const Texture *b)
{
    return a->normal == b->normal && (a->finish == b->finish || memcmp(a->finish, b->finish, sizeof *a->finish) == 0);
}

/* What an opaque surface scatters and emits is linear in its colour. */
static int may_merge(const Leaf *leaf)
{
    return leaf->target < 0 && leaf->above < 0 && !leaf->is_layer && is_opaque(leaf);
}

static int merge_leaf(Leaves *leaves, const Leaf *leaf)
{
    for (int k = 0; k < leaves->count && may_merge(leaf); k++) {
        Leaf *to = &leaves->leaf[k];
        const float weight = to->weight + leaf->weight;
        if (!may_merge(to) || !same_finish(to->texture, leaf->texture) || !(weight > 0))
            continue;
        const Rgb sum = rgb_add(tinted(to, to->weight / weight), tinted(leaf, leaf->weight / weight));
        to->color = (Rgbft){sum.r, sum.g, sum.b, 0, 0};
        to->opacity = 1;
        to->tint = rgb_grey(1);
        to->neutral = (to->neutral * to->weight + leaf->neutral * leaf->weight) / weight;
        to->weight = weight, to->chance += leaf->chance;
        return 1;
    }
    return 0;
}

static void merge_leaves(Leaves *leaves)
{
    const int count = leaves->count;
    leaves->count = 0;
    for (int k = 0; k < count; k++)
        if (!merge_leaf(leaves, &leaves->leaf[k]))
            leaves->leaf[leaves->count++] = leaves->leaf[k];
}

void leaves_at(Leaves *leaves, const Surface *surface, Vec3 wo, int merge)
{
    const Point at = {surface, wo, surface->texture->pigment->space};
    leaves->count = leaves->nabove = 0;
    add_texture(leaves, &at, surface->texture,
                (Leaf){.weight = 1, .tint = {1, 1, 1}, .working_tint = {1, 1, 1}, .neutral = 1, .above = -1});
    if (leaves->count == 0) /* filters and weights beyond all numbers: black */
        add_leaf(leaves, &(Leaf){.texture = texture_leaf(surface->texture, 0), .target = -1, .above = -1});
    if (leaves->count > 1 && !working_is_linear(at.space))
        blend_in_working_space(leaves, at.space);
    if (merge)
        merge_leaves(leaves);
}

/* ---- choosing ---- */

float leaves_opacity(const Leaves *leaves)
{
    float sum = 0;
    for (int k = 0; k < leaves->count; k++)
        sum += seen(&leaves->leaf[k]);
    return sum;
}

float leaves_share(const Leaves *leaves, int k)
{
    const float sum = leaves_opacity(leaves);
    return sum > 0 ? seen(&leaves->leaf[k]) / sum : k == leaves->count - 1;
}

static const Leaf *choose(const Leaves *leaves, double u, float *weight, int passing)
{
    const Leaf *found = NULL;
    double sum = 0;
    for (int k = 0; k < leaves->count; k++)
        sum += !passing || leaf_passes(&leaves->leaf[k]) ? leaves->leaf[k].chance : 0;
    double rest = u * sum;
    for (int k = 0; k < leaves->count; k++) {
        const Leaf *leaf = &leaves->leaf[k];
        if ((passing && !leaf_passes(leaf)) || !(leaf->chance > 0))
            continue;
        found = leaf;
        if (rest < leaf->chance)
            break;
        rest -= leaf->chance;
    }
    *weight = found ? (float)(found->weight / (found->chance / sum)) : 0;
    return found;
}

const Leaf *leaves_choose(const Leaves *leaves, double u, float *weight)
{
    const Leaf *leaf = choose(leaves, u, weight, 0);
    return leaf ? leaf : &leaves->leaf[0];
}

const Leaf *leaves_choose_passing(const Leaves *leaves, double u, float *weight)
{
    return choose(leaves, u, weight, 1);
}
