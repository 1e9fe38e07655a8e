/* What a surface looks like where a ray met it: its colours and its BSDF. */
#ifndef RENDERER_PATH_SHADING_H
#define RENDERER_PATH_SHADING_H

#include "accel/accel.h"
#include "scene/variant.h"
#include "shade/bsdf.h"

/* Everything shading needs at a hit: the surface, its colour and its BSDF. */
typedef struct Shading {
    Surface surface;
    Rgb albedo;   /* the original's */
    int replaced; /* some variant has another one: by variant */
    Rgb albedos[VARIANTS_MAX];
    float filter, transmit;
    Vec2 uv; /* of a target: where a replacement is looked up */
    Bsdf bsdf;
} Shading;

/* Where a replacement texture is looked up on a surface, were it a target. */
Vec2 surface_target_uv(const Surface *surface);
/* Where an image is looked up on a surface: a point of its pattern space, if it is known already. */
typedef struct ImagePlace {
    int is_known;
    Vec3 point;
} ImagePlace;

/* The colours at a surface (shading->surface is filled), the original's and those of variants (NULL = none). place:
 * what shading_prefetch found, or NULL. */
void shading_color(Shading *shading, const ImagePlace *place, const RenderVariant *variants, int nvariants);
/* Prefetch what shading_color will read. */
ImagePlace shading_prefetch(const Surface *surface);
void shading_at(Shading *shading, const Scene *scene, const RenderVariant *variants, int nvariants, const Ray *ray,
                const Hit *hit);
static inline Rgb shading_albedo(const Shading *s, int variant)
{
    return s->replaced ? s->albedos[variant] : s->albedo;
}

/* The AOVs of these names, see <retex/aov.h>. */
float shading_roughness(const Shading *shading);
float shading_metallic(const Shading *shading);

/* The kind of a path's next ray: rays that the camera sends through refracting glass stay camera rays. */
static inline RayKind path_next_kind(RayKind kind, const Bsdf *bsdf, int transmitted)
{
    return transmitted && bsdf->refracts ? kind : RAY_BOUNCE;
}

#endif
