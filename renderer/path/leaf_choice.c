/* One leaf of a tree of textures is chosen for each hit, by a sample number of its own, so that a hit has one pigment,
 * one finish and at most one target. The layers above it are passed as if they were surfaces in front: those that are
 * targets are hits in series with that of the leaf. */
#include "path/internal.h"

static double leaf_number(const Path *path, unsigned texture)
{
    const Sampler sampler = {path->key, path->sample};
    const unsigned vertex = (unsigned)(path->segments + path->straight);
    float u, v;
    sampler_pair(&sampler, DIMENSION_TEXTURE + vertex * TEXTURES_PER_VERTEX + texture, &u, &v);
    return u;
}

/* ---- a path's own vertex ---- */

/* From the topmost down, which is the order of hits along the path. */
static void pass_layers(PathWorker *w, Path *path, const Surface *whole, const Leaves *leaves, int k)
{
    if (k < 0)
        return;
    const LayerAbove *above = &leaves->above[k];
    Shading layer;
    pass_layers(w, path, whole, leaves, above->above);
    shading_above(&layer, whole, above, w->variants, w->context->nvariants);
    path_apply_factor(w, path, &layer, (Split){rgb_grey(above->d), rgb_grey(above->i)}, NULL, NULL, NULL, 0);
    if (w->context->trace)
        fprintf(w->context->trace, "  below a layer of target %s d %.5g i %.5g\n",
                w->context->scene->targets[above->target].name, above->d, above->i);
}

void choose_leaf(PathWorker *w, Path *path, Shading *s, Vec3 wo)
{
    const PathContext *c = w->context;
    const Surface whole = s->surface;
    Leaves leaves;
    float weight;
    leaves_at(&leaves, &whole, wo, 1);
    const double u = leaves.count > 1 ? leaf_number(path, TEXTURE_VERTEX) : 0;
    const Leaf *leaf = leaves_choose(&leaves, u, &weight);
    const Rgb tint = rgb_scale(leaf->tint, weight);
    pass_layers(w, path, &whole, &leaves, leaf->above);
    path->beta_neutral *= at_most(weight * leaf->neutral, 1);
    path_scale(w, path, tint);
    shading_leaf(s, &whole, leaf, w->variants, c->nvariants);
    if (c->trace)
        fprintf(c->trace, "  leaf %d of %d weight %.5g tint %.5g %.5g %.5g\n", (int)(leaf - leaves.leaf), leaves.count,
                weight, tint.r, tint.g, tint.b);
}

/* ---- what a direct-light sample meets ---- */

int choose_leaf_of_light(PathWorker *w, const Path *path, Shading *s, Vec3 wo, int passing, unsigned texture,
                         LightFactors *to)
{
    const Surface whole = s->surface;
    Leaves leaves;
    Shading layer;
    float weight;
    leaves_at(&leaves, &whole, wo, 1);
    const double u = leaves.count > 1 ? leaf_number(path, texture) : 0;
    const Leaf *leaf = passing ? leaves_choose_passing(&leaves, u, &weight) : leaves_choose(&leaves, u, &weight);
    if (!leaf)
        return 0;
    *to->light = rgb_mul(*to->light, rgb_scale(leaf->tint, weight));
    for (int k = leaf->above; k >= 0; k = leaves.above[k].above) {
        shading_above(&layer, &whole, &leaves.above[k], w->variants, w->context->nvariants);
        const Factor factor = shading_factor(&layer, splat(leaves.above[k].d), splat(leaves.above[k].i));
        if (!light_factors_add(w->context, to, factor, &layer))
            return 0;
    }
    shading_leaf(s, &whole, leaf, w->variants, w->context->nvariants);
    return 1;
}
