/* What a surface looks like where a ray met it. */
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

static Vec2 target_uv_of(const Surface *surface, const SurfaceUv *of)
{
    const Pigment *pigment = surface->texture->pigment;
    return target_uv(pigment, surface->position, surface->geometric_normal, pigment->uv_mapping ? &of->uv : NULL,
                     of->has_natural ? &of->natural : NULL);
}

Vec2 surface_target_uv(const Surface *surface)
{
    SurfaceUv of = surface_uv(surface);
    return target_uv_of(surface, &of);
}

static Vec3 image_point(const Surface *surface, const Pigment *pigment)
{
    return pigment_point(pigment, surface->position, pigment->uv_mapping ? surface_uv(surface).uv : (Vec2){0, 0});
}

/* The colour of a surface, and, of a target, where a replacement is looked up. */
static Rgbft color_at(const Surface *surface, const ImagePlace *place, Vec2 *target)
{
    const Pigment *pigment = surface->texture->pigment;
    SurfaceUv of = {.has_natural = 0};
    if (pigment->kind == PIGMENT_IMAGE)
        return pigment_eval_image(pigment, place && place->is_known ? place->point : image_point(surface, pigment),
                                  target);
    if (pigment->uv_mapping || surface->target >= 0)
        of = surface_uv(surface);
    if (surface->target >= 0)
        *target = target_uv_of(surface, &of);
    return pigment_eval(pigment, surface->position, of.uv);
}

void shading_color(Shading *s, const ImagePlace *place, const RenderVariant *variants, int nvariants)
{
    const Surface *surface = &s->surface;
    const Rgbft c = color_at(surface, place, &s->uv);
    s->albedo = rgb(not_negative(c.r), not_negative(c.g), not_negative(c.b));
    s->filter = not_negative(c.filter), s->transmit = not_negative(c.transmit);
    s->replaced = 0;
    if (surface->target < 0)
        return;
    for (int v = 0; variants && v < nvariants; v++)
        s->replaced |= variants[v].constants || variants[v].textures[surface->target];
    for (int v = 0; s->replaced && v < nvariants; v++) {
        const RetexTexture *replacement = variants[v].textures[surface->target];
        s->albedos[v] = variants[v].constants ? variants[v].constants[surface->target]
                        : replacement         ? replaced_color(s, replacement)
                                              : s->albedo;
    }
}

ImagePlace shading_prefetch(const Surface *surface)
{
    const Pigment *pigment = surface->texture->pigment;
    ImagePlace place = {.is_known = pigment->kind == PIGMENT_IMAGE};
    if (!place.is_known)
        return place;
    place.point = image_point(surface, pigment);
    pigment_prefetch_image(pigment, place.point);
    return place;
}

void shading_at(Shading *s, const Scene *scene, const RenderVariant *variants, int nvariants, const Ray *ray,
                const Hit *hit)
{
    surface_at(&s->surface, scene, ray, hit);
    shading_color(s, NULL, variants, nvariants);
    bsdf_setup(&s->bsdf, &s->surface, vec_neg(ray->direction), s->filter, s->transmit);
}

static int is_mirror(const Finish *finish)
{
    return !rgb_is_black(finish->reflection_min) || !rgb_is_black(finish->reflection_max);
}

/* Of the sharpest lobe: POV-Ray's reflection and clear refraction are mirrors. */
float shading_roughness(const Shading *s)
{
    const Bsdf *b = &s->bsdf;
    if (b->disney)
        return b->roughness;
    if (is_mirror(s->surface.texture->finish) || !rgb_is_black(b->passing.d) || !rgb_is_black(b->passing.i))
        return 0;
    return b->alpha > 0 ? sqrtf(b->alpha) : 1;
}

float shading_metallic(const Shading *s)
{
    const Bsdf *b = &s->bsdf;
    const Finish *finish = s->surface.texture->finish;
    if (b->disney)
        return b->metallic;
    double most = fmax(is_mirror(finish) ? finish->reflection_metallic : 0, b->alpha > 0 ? finish->metallic : 0);
    return (float)fmin(1, fmax(0, most));
}
