/* See surface_color.h. */
#include "path/surface_color.h"
#include "path/target_units.h"
#include "shade/pigment.h"

PatternPoint surface_pattern_point(const Surface *surface)
{
    const Vec3 normal = surface->shading_normal;
    return (PatternPoint){surface_texture_point(surface), surface->backside ? vec_neg(normal) : normal,
                          surface->direction};
}

static Vec2 target_uv_of(const Surface *surface, const SurfaceUv *of)
{
    const Pigment *pigment = surface->texture->pigment;
    Vec2 uv;
    if (surface->primitive->unit_targets && target_units_uv(surface, of, &uv))
        return uv;
    return target_uv(pigment, surface_texture_point(surface), surface_texture_normal(surface),
                     pigment->uv_mapping ? &of->uv : NULL, of->has_natural ? &of->natural : NULL);
}

Vec2 surface_target_uv(const Surface *surface)
{
    SurfaceUv of = surface_uv(surface);
    return target_uv_of(surface, &of);
}

static Vec3 image_point(const Surface *surface, const Pigment *pigment)
{
    return pigment_point(pigment, surface_texture_point(surface),
                         pigment->uv_mapping ? surface_uv(surface).uv : (Vec2){0, 0});
}

Rgbft surface_color(const Surface *surface, const ImagePlace *place, Vec2 *target)
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
    const PatternPoint point = surface_pattern_point(surface);
    return pigment_eval_at(pigment, &point, of.uv);
}

ImagePlace shading_prefetch(const Surface *surface)
{
    const Pigment *pigment = surface->texture->pigment;
    ImagePlace place = {.is_known = pigment->kind == PIGMENT_IMAGE && !surface->texture->tree};
    if (!place.is_known)
        return place;
    place.point = image_point(surface, pigment);
    pigment_prefetch_image(pigment, place.point);
    return place;
}
