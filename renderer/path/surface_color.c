/* See surface_color.h. */
#include "path/surface_color.h"
#include "path/projection.h"
#include "path/target_units.h"
#include "shade/pigment.h"

PatternPoint surface_pattern_point(const Surface *surface)
{
    const Vec3 normal = surface->shading_normal;
    return (PatternPoint){surface_texture_point(surface), surface->backside ? vec_neg(normal) : normal,
                          surface->direction};
}

static inline int is_projected(const Surface *surface)
{
    return surface->target >= 0 && surface->primitive->unit_targets &&
           projection_is_used(&surface->primitive->unit_targets[surface->target]);
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

/* ---- where u and v of a target grow ---- */

/* How UV change with a step to both sides over the plane that touches the surface. */
static Vec2 uv_step(const Surface *surface, Vec3 step)
{
    Surface before = *surface, after = *surface;
    before.position = vec_sub(surface->position, step), after.position = vec_add(surface->position, step);
    const Vec2 a = surface_target_uv(&before), b = surface_target_uv(&after);
    return (Vec2){uv_difference(b.u, a.u), uv_difference(b.v, a.v)};
}

/* Of UV that belong to the corners of a mesh, which a pigment may turn. */
static int mesh_target_frame(const Surface *surface, Vec3 normal, Vec3 *of_u, Vec3 *of_v)
{
    const Pigment *pigment = surface->texture->pigment;
    const Transform *placed = surface->instance ? &surface->instance->transform : NULL;
    const Vec3 inner = placed ? vec_normalize(transform_inverse_normal(placed, normal)) : normal;
    Vec3 along_u, along_v;
    if (!surface_tangents(surface, 0, surface->backside ? vec_neg(inner) : inner, &along_u, &along_v))
        return 0;
    if (surface->backside)
        along_u = vec_neg(along_u), along_v = vec_neg(along_v);
    if (pigment->uv_mapping) {
        const Vec3 x = transform_vector(&pigment->transform, vec3(1, 0, 0)),
                   y = transform_vector(&pigment->transform, vec3(0, 1, 0)), u = along_u, v = along_v;
        along_u = vec_mad(vec_scale(u, x.x), v, x.y), along_v = vec_mad(vec_scale(u, y.x), v, y.y);
    }
    *of_u = placed ? transform_vector(placed, along_u) : along_u;
    *of_v = placed ? transform_vector(placed, along_v) : along_v;
    return 1;
}

static int shape_target_frame(const Surface *surface, Vec3 normal, Vec3 *of_u, Vec3 *of_v)
{
    const double size = 1e-5 * (1 + vec_length(surface->position));
    Vec3 s, r;
    vec_frame(normal, &s, &r);
    const Vec2 a = uv_step(surface, vec_scale(s, size)), b = uv_step(surface, vec_scale(r, size));
    const double det = a.u * b.v - b.u * a.v;
    if (!(fabs(det) > 1e-9 * (a.u * a.u + a.v * a.v + b.u * b.u + b.v * b.v)))
        return 0;
    *of_u = vec_scale(vec_mad(vec_scale(s, b.v), r, -a.v), det < 0 ? -1 : 1); /* where v stays */
    *of_v = vec_scale(vec_mad(vec_scale(r, a.u), s, -b.u), det < 0 ? -1 : 1);
    return 1;
}

int surface_target_frame(const Surface *surface, Vec3 normal, Vec3 *of_u, Vec3 *of_v)
{
    const Pigment *pigment = surface->texture->pigment;
    const Mesh *mesh = is_projected(surface) ? NULL : surface->primitive->shape.mesh;
    Vec3 along_u, along_v;
    if (!(mesh && mesh->nuvs && (pigment->uv_mapping || pigment->kind != PIGMENT_IMAGE)
              ? mesh_target_frame
              : shape_target_frame)(surface, normal, &along_u, &along_v))
        return 0;
    along_u = vec_mad(along_u, normal, -vec_dot(along_u, normal));
    if (!(vec_length(along_u) > 0))
        return 0;
    *of_u = vec_normalize(along_u);
    *of_v = vec_cross(normal, *of_u);
    if (vec_dot(*of_v, along_v) < 0)
        *of_v = vec_neg(*of_v);
    return 1;
}

/* ---- colours ---- */

static Vec3 image_point(const Surface *surface, const Pigment *pigment)
{
    return pigment_point(pigment, surface_texture_point(surface),
                         pigment->uv_mapping ? surface_uv(surface).uv : (Vec2){0, 0});
}

Rgbft surface_color(const Surface *surface, const ImagePlace *place, Vec2 *target)
{
    const Pigment *pigment = surface->texture->pigment;
    SurfaceUv of = {.has_natural = 0};
    if (pigment->kind == PIGMENT_IMAGE) {
        const Rgbft c = pigment_eval_image(
            pigment, place && place->is_known ? place->point : image_point(surface, pigment), target);
        if (is_projected(surface))
            *target = surface_target_uv(surface);
        return c;
    }
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
