/* What a surface looks like where a ray met it. */
#include <retex/host/texture_lookup.h>

#include "path/leaves.h"
#include "path/shading.h"
#include "shade/material.h"
#include "shade/pigment.h"

/* A replacement takes the pigment's colour, not its opacity; where it is transparent the original shows through. */
static Rgb replaced_color(const Shading *s, const RetexTexture *replacement)
{
    float rgba[4];
    retex_texture_point(replacement, s->uv.u, s->uv.v, rgba);
    return rgb_lerp(s->albedo, rgb(rgba[0], rgba[1], rgba[2]), rgba[3]);
}

static __attribute__((noinline)) void replace_color(Shading *s, const RenderVariant *variants, int nvariants)
{
    const int target = s->surface.target;
    for (int v = 0; v < nvariants; v++)
        s->replaced |= variants[v].constants || variants[v].textures[target];
    for (int v = 0; s->replaced && v < nvariants; v++) {
        const RetexTexture *replacement = variants[v].textures[target];
        s->albedos[v] = variants[v].constants ? variants[v].constants[target]
                        : replacement         ? replaced_color(s, replacement)
                                              : s->albedo;
    }
}

/* The colours of a surface whose pigment's is known, and which is opaque unless the caller knows better. */
static inline void set_colors(Shading *s, const Rgbft *c, const RenderVariant *variants, int nvariants)
{
    s->albedo = rgb(not_negative(c->r), not_negative(c->g), not_negative(c->b));
    s->filter = not_negative(c->filter), s->transmit = not_negative(c->transmit), s->opacity = 1;
    s->replaced = s->is_leaf = s->is_layer = 0;
    if (s->surface.target >= 0 && variants)
        replace_color(s, variants, nvariants);
}

void shading_color(Shading *s, const ImagePlace *place, const RenderVariant *variants, int nvariants)
{
    const Rgbft c = surface_color(&s->surface, place, &s->uv);
    set_colors(s, &c, variants, nvariants);
    if (s->filter + s->transmit > 0)
        s->opacity = pigment_opacity(s->surface.texture->pigment, c);
}

static inline void setup(const Shading *s, const Surface *surface, Vec3 wo, Bsdf *bsdf)
{
    bsdf_setup(bsdf, surface, wo, s->filter, s->transmit, s->opacity);
    if (s->is_layer)
        bsdf_stop_passing(bsdf);
}

void shading_bsdf(Shading *s, Vec3 wo)
{
    setup(s, &s->surface, wo, &s->bsdf);
}

void shading_bsdf_finish(const Shading *s, const Finish *finish, Vec3 wo, Bsdf *bsdf)
{
    Surface surface = s->surface;
    Texture texture = *surface.texture;
    texture.finish = finish;
    surface.texture = &texture;
    setup(s, &surface, wo, bsdf);
}

void shading_tilt(const Shading *s, const double components[3], Bsdf *bsdf)
{
    const Vec3 normal = bsdf_surface_normal(bsdf);
    Vec3 of_u, of_v;
    if ((components[0] == 0 && components[1] == 0) || !surface_target_frame(&s->surface, normal, &of_u, &of_v))
        return;
    const Vec3 tilted = vec_mad(vec_mad(vec_scale(normal, components[2]), of_u, components[0]), of_v, components[1]);
    bsdf_tilt_diffuse(bsdf, vec_normalize(tilted));
}

void shading_bsdf_wavelength(Shading *s, Vec3 wo, double wavelength)
{
    bsdf_setup_wavelength(&s->bsdf, &s->surface, wo, s->filter, s->transmit, s->opacity, wavelength);
}

/* ---- trees of textures ---- */

void shading_leaf(Shading *s, const Surface *whole, const Leaf *leaf, const RenderVariant *variants, int nvariants)
{
    s->surface = leaf_surface(whole, leaf->texture, leaf->target);
    if (leaf->target >= 0)
        s->uv = surface_target_uv(&s->surface);
    set_colors(s, &leaf->color, variants, nvariants);
    s->opacity = leaf->opacity;
    s->is_leaf = 1;
    s->is_layer = leaf->is_layer;
}

void shading_above(Shading *s, const Surface *whole, const LayerAbove *above, const RenderVariant *variants,
                   int nvariants)
{
    const Leaf leaf = {.texture = above->texture, .target = above->target, .color = above->color, .opacity = 1};
    shading_leaf(s, whole, &leaf, variants, nvariants);
}

/* The colour of a leaf as it is seen through the layers above it. */
static Rgb seen_albedo(const Shading *s, const Surface *whole, const Leaves *leaves, const Leaf *leaf,
                       const RenderVariant *variants)
{
    Rgb albedo = rgb_mul(shading_albedo(s, 0), leaf->tint);
    Shading layer;
    for (int k = leaf->above; k >= 0; k = leaves->above[k].above) {
        const LayerAbove *above = &leaves->above[k];
        shading_above(&layer, whole, above, variants, 1);
        albedo = rgb_mul(albedo, rgb_add(rgb_scale(shading_albedo(&layer, 0), above->d), rgb_grey(above->i)));
    }
    return albedo;
}

static unsigned leaf_targets(const Leaves *leaves, const Leaf *leaf)
{
    unsigned targets = leaf->target >= 0 ? 1u << leaf->target : 0;
    for (int k = leaf->above; k >= 0; k = leaves->above[k].above)
        targets |= 1u << leaves->above[k].target;
    return targets;
}

/* What the albedo is multiplied by to be the reflectance of the diffuse lobes, for light from all sides alike. A cosine
 * to the power of the brilliance has the integral 2 pi / (brilliance + 1). Light that goes below the surface counts
 * where it goes in. */
static float reflectance_of(const Shading *s)
{
    const Bsdf *b = &s->bsdf;
    if (b->lambert)
        return b->diffuse;
    const float of_lobe = b->disney ? 1 : 2 / (b->brilliance + 1), under = b->coating.present ? b->coating.under : 1;
    return (b->diffuse + b->subsurface) * of_lobe * under;
}

void shading_each_leaf(const Scene *scene, const RenderVariant *variants, const Ray *ray, const Hit *hit,
                       LeafVisitor *visit, void *context)
{
    const Vec3 wo = vec_neg(ray->direction);
    Surface whole;
    Leaves leaves;
    surface_at(&whole, scene, ray, hit);
    if (!whole.texture->tree) {
        SeenLeaf seen = {.share = 1};
        shading_at(&seen.s, scene, variants, 1, ray, hit);
        seen.albedo = shading_albedo(&seen.s, 0);
        seen.reflectance = rgb_scale(seen.albedo, reflectance_of(&seen.s));
        seen.targets = whole.target >= 0 ? 1u << whole.target : 0;
        visit(context, &seen);
        return;
    }
    leaves_at(&leaves, &whole, wo, 0);
    const float surplus = fmaxf(1, leaves_opacity(&leaves));
    for (int k = 0; k < leaves.count; k++) {
        const Leaf *leaf = &leaves.leaf[k];
        SeenLeaf seen = {.share = leaves_share(&leaves, k), .targets = leaf_targets(&leaves, leaf)};
        shading_leaf(&seen.s, &whole, leaf, variants, 1);
        shading_bsdf(&seen.s, wo);
        const Rgb albedo = seen_albedo(&seen.s, &whole, &leaves, leaf, variants);
        seen.albedo = rgb_scale(albedo, surplus);
        if (seen.share > 0)
            seen.reflectance = rgb_scale(albedo, leaf->weight / seen.share * reflectance_of(&seen.s));
        visit(context, &seen);
    }
}

/* The leaf that is seen most. */
static void most_seen_leaf(Shading *s, const RenderVariant *variants, int nvariants, Vec3 wo)
{
    const Surface whole = s->surface;
    Leaves leaves;
    int most = 0;
    leaves_at(&leaves, &whole, wo, 0);
    for (int k = 1; k < leaves.count; k++)
        if (leaves_share(&leaves, k) > leaves_share(&leaves, most))
            most = k;
    shading_leaf(s, &whole, &leaves.leaf[most], variants, nvariants);
}

void shading_at(Shading *s, const Scene *scene, const RenderVariant *variants, int nvariants, const Ray *ray,
                const Hit *hit)
{
    const Vec3 wo = vec_neg(ray->direction);
    surface_at(&s->surface, scene, ray, hit);
    if (s->surface.texture->tree)
        most_seen_leaf(s, variants, nvariants, wo);
    else
        shading_color(s, NULL, variants, nvariants);
    shading_bsdf(s, wo);
}

/* Of the sharpest lobe: POV-Ray's reflection and clear refraction are mirrors. */
float shading_roughness(const Shading *s)
{
    const Bsdf *b = &s->bsdf;
    if (b->disney)
        return b->roughness;
    if (finish_is_mirror(s->surface.texture->finish) || !rgb_is_black(b->passing.d) || !rgb_is_black(b->passing.i))
        return 0;
    return b->highlights > 0 ? sqrtf(bsdf_highlight_alpha(b)) : 1;
}

float shading_metallic(const Shading *s)
{
    const Bsdf *b = &s->bsdf;
    const Finish *finish = s->surface.texture->finish;
    if (b->disney)
        return b->metallic;
    double most =
        fmax(finish_is_mirror(finish) ? finish->reflection_metallic : 0, b->highlights > 0 ? finish->metallic : 0);
    return (float)fmin(1, fmax(0, most));
}
