/* What a surface looks like where a ray met it: its colours and its BSDF. */
#ifndef RENDERER_PATH_SHADING_H
#define RENDERER_PATH_SHADING_H

#include "accel/accel.h"
#include "path/surface_color.h"
#include "scene/variant.h"
#include "shade/bsdf.h"

struct Leaf;
struct LayerAbove;

/* Everything shading needs at a hit: the surface, its colour and its BSDF. */
typedef struct Shading {
    Surface surface;
    Rgb albedo;   /* the original's */
    int is_leaf;  /* of a tree of textures: the surface has others too */
    int is_layer; /* of that leaf, see leaves.h: nothing passes it by itself */
    int replaced; /* some variant has another one: by variant */
    Rgb albedos[VARIANTS_MAX];
    float filter, transmit, opacity; /* see pigment_opacity */
    Vec2 uv;                         /* of a target: where a replacement is looked up */
    Bsdf bsdf;
} Shading;

/* The colours at a surface (shading->surface is filled), the original's and those of variants (NULL = none). place:
 * what shading_prefetch found, or NULL. */
void shading_color(Shading *shading, const ImagePlace *place, const RenderVariant *variants, int nvariants);
/* Everything, for the texture of the surface, or for the leaf of its tree that is seen most. */
void shading_at(Shading *shading, const Scene *scene, const RenderVariant *variants, int nvariants, const Ray *ray,
                const Hit *hit);
static inline Rgb shading_albedo(const Shading *s, int variant)
{
    return s->replaced ? s->albedos[variant] : s->albedo;
}

/* Whether its target is rendered with other finishes than its own. */
static inline int shading_has_finishes(const Shading *s, const Scene *scene)
{
    return s->surface.target >= 0 && scene->targets[s->surface.target].nfinishes > 0;
}
/* Make the BSDF, once the rest is known; below, for light of one wavelength. */
void shading_bsdf(Shading *shading, Vec3 wo);
/* The same with another finish. */
void shading_bsdf_finish(const Shading *shading, const Finish *finish, Vec3 wo, Bsdf *bsdf);
/* Tilt the normal of diffuse lobes, with all bumps that the scene has: components along u and v of the target, and
 * along the normal, on wo's side. */
void shading_tilt(const Shading *shading, const double components[3], Bsdf *bsdf);
/* Whether it lets light through, which it refracts by wavelength. */
static inline int shading_disperses(const Shading *s)
{
    return interior_disperses(s->surface.primitive->interior) && !s->is_layer &&
           (s->filter + s->transmit > 0 || finish_transmits(s->surface.texture->finish));
}
void shading_bsdf_wavelength(Shading *shading, Vec3 wo, double wavelength);

/* ---- trees of textures, see leaves.h ---- */

/* All but the BSDF: of a leaf that is known, and of a layer above leaves. */
void shading_leaf(Shading *shading, const Surface *whole, const struct Leaf *leaf, const RenderVariant *variants,
                  int nvariants);
void shading_above(Shading *shading, const Surface *whole, const struct LayerAbove *above,
                   const RenderVariant *variants, int nvariants);
/* What is seen of a surface: the leaves of its tree, or its one texture. */
typedef struct SeenLeaf {
    Shading s;
    float share;      /* of the surface, at this point; the sum is 1 */
    Rgb albedo;       /* as seen through the layers above; that of the first variant */
    Rgb reflectance;  /* the same of its diffuse lobes; times the share it is the leaf's part of the whole */
    unsigned targets; /* bits: its own, and those of the layers above */
} SeenLeaf;
typedef void LeafVisitor(void *context, const SeenLeaf *leaf);
void shading_each_leaf(const Scene *scene, const RenderVariant *variants, const Ray *ray, const Hit *hit,
                       LeafVisitor *visit, void *context);

/* The AOVs of these names, see <retex/host/aov.h>. */
float shading_roughness(const Shading *shading);
float shading_metallic(const Shading *shading);

/* The kind of a path's next ray: rays that the camera sends through refracting glass stay camera rays. */
static inline RayKind path_next_kind(RayKind kind, const Bsdf *bsdf, int transmitted)
{
    return transmitted && bsdf->refracts ? kind : RAY_BOUNCE;
}

#endif
