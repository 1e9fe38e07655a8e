/* See casters.h. */
#include <math.h>
#include "shade/casters.h"
#include "shape/csg.h"
#include "shape/shape.h"
#include "shape/surface.h"

#define STRONG_MIRROR 0.25f /* reflectance from which on a mirror is worth photons */

static int finish_casts(const Finish *f, const Primitive *p, const Texture *texture)
{
    int bends = interior_bends(p->interior);
    if (f->retex.present)
        return f->retex.roughness < 0.02 && ((bends && finish_transmits(f)) || f->retex.metallic > 0.5);
    if (rgb_luminance(f->reflection_max) >= STRONG_MIRROR && !f->reflection_fresnel)
        return 1;
    const Pigment *pigment = texture->pigment;
    return bends && (pigment->kind != PIGMENT_COLOR || pigment->color.filter + pigment->color.transmit > 0.1f);
}

static int texture_casts(const Primitive *p, const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (finish_casts(texture_leaf(texture, k)->finish, p, texture_leaf(texture, k)))
            return 1;
    return 0;
}

/* Whether it is one of its own accord, as CASTERS_OF_EMITTERS. instance: whose texture it may have, or NULL. */
static int casts_by_itself(const Primitive *p, const Instance *instance)
{
    const FaceTextures *textures = p->shape.textures;
    if (texture_casts(p, instance && p->inherits ? instance->texture : p->texture))
        return 1;
    for (int k = 0; textures && k < textures->count; k++)
        if (texture_casts(p, textures->list[k]))
            return 1;
    return 0;
}

/* ---- all of a scene ---- */

static int is_caster(const Primitive *p, const Instance *instance, CasterKind kind)
{
    if (p->caustics && kind != CASTERS_OF_EMITTERS)
        return 1;
    return kind != CASTERS_OF_SOURCES && casts_by_itself(p, instance);
}

/* Of an operand of CSG, the bounds of what can be seen of it: a plane that cuts glass throws caustics too. */
static int primitive_bounds(const Primitive *p, Vec3 *low, Vec3 *high)
{
    Bounds bounds = bounds_everywhere();
    if (!p->csg)
        return shape_bounds(p, low, high);
    for (const CsgNode *node = p->csg; node; node = node->parent)
        bounds = bounds_meet(bounds, node->surface);
    *low = bounds.low, *high = bounds.high;
    return bounds_is_finite(&bounds) && !bounds_is_empty(&bounds);
}

static void find_bounds(Caster *caster, const Primitive *p)
{
    Vec3 low, high;
    caster->is_bounded = primitive_bounds(p, &low, &high);
    caster->low = low, caster->high = high;
    if (!caster->is_bounded || !caster->instance)
        return;
    caster->low = vec3(INFINITY, INFINITY, INFINITY), caster->high = vec_neg(caster->low);
    shape_bound_box(&caster->low, &caster->high, &caster->instance->transform, low, high);
}

/* Of primitives first to end, those in prototypes only with an instance. *none: 1 where none of them is one, whatever
 * the instance. */
static int visit_range(const Scene *scene, int first, int end, const Instance *instance, CasterKind kind,
                       CasterVisitor *visit, void *context, int *none)
{
    int code = 0;
    *none = 1;
    for (int k = first; k < end && !code; k++) {
        const Primitive *p = &scene->primitives[k];
        Caster caster = {.primitive = k, .instance = instance};
        if (!instance != !p->prototype)
            continue;
        const int casts = is_caster(p, instance, kind);
        *none &= !casts && !p->inherits;
        if (!casts)
            continue;
        find_bounds(&caster, p);
        code = visit(context, &caster);
    }
    return code;
}

int casters_visit(const Scene *scene, CasterKind kind, CasterVisitor *visit, void *context)
{
    const Prototype *last = NULL;
    int none, code = visit_range(scene, 0, scene->nprimitives, NULL, kind, visit, context, &none);
    for (int k = 0; k < scene->ninstances && !code; k++) {
        const Instance *instance = &scene->instances[k];
        const Prototype *of = instance->prototype;
        if (of == last && none)
            continue;
        code = visit_range(scene, of->first, of->first + of->count, instance, kind, visit, context, &none);
        last = of;
    }
    return code;
}
