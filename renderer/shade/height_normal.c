/* retex_height_map: bumps by heights that a picture has at the shape's UV, in units of the scene. The slope is that of
 * the surface itself (Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU), over the distance of two pixels of
 * the picture: finer detail than that is not seen as bumps. Blender's Bump node means the same. */
#include <retex/color.h>
#include "shade/normal.h"
#include "shade/pigment.h"

/* How far apart two pixels are there. */
static double pixel_distance(const PixelSize *pixels, Vec3 p)
{
    return pixels->apart + pixels->angle * vec_length(vec_sub(p, pixels->eye));
}

/* In UV, a step of at least a part of a texel, so that rounding does not make slopes. */
static double least_step(const Pigment *heights, Vec3 of_u, Vec3 of_v)
{
    const double part = 0.25;
    const int width = heights->image ? heights->image->width : 1024,
              height = heights->image ? heights->image->height : 1024;
    const double fastest = fmax(vec_length(of_u) * width, vec_length(of_v) * height);
    return fastest > 0 ? part / fastest : 0;
}

typedef struct Heights {
    const Pigment *pigment;
    Vec3 point; /* where patterns other than images are looked up */
    Vec2 uv;
    Vec3 of_u, of_v; /* how UV grow in the world */
} Heights;

static double height_at(const Heights *h, Vec3 step)
{
    const Vec2 uv = {h->uv.u + vec_dot(h->of_u, step), h->uv.v + vec_dot(h->of_v, step)};
    const Rgbft c = pigment_eval(h->pigment, h->point, uv);
    return retex_luminance((double)c.r, (double)c.g, (double)c.b);
}

static double slope(const Heights *h, Vec3 along, double step)
{
    return (height_at(h, vec_scale(along, step / 2)) - height_at(h, vec_scale(along, -step / 2))) / step;
}

Vec3 height_normal(const Normal *bumps, const Surface *surface, Vec3 normal)
{
    const Pigment *pigment = bumps->vectors;
    Heights heights = {.pigment = pigment};
    if (!surface->primitive || !surface_uv_gradients(surface, pigment->second_uv, &heights.of_u, &heights.of_v))
        return normal;
    heights.point = surface_texture_point(surface);
    heights.uv = surface_uv_of_set(surface, pigment->second_uv);
    const Transform *t = surface->instance ? &surface->instance->transform : NULL;
    const Vec3 n = vec_normalize(t ? transform_normal(t, normal) : normal);
    const double step = fmax(pixel_distance(bumps->pixels, surface->position),
                             least_step(pigment, heights.of_u, heights.of_v));
    Vec3 s, r;
    vec_frame(surface->geometric_normal, &s, &r);
    const Vec3 across = vec_cross(r, n), up = vec_cross(n, s);
    const double det = vec_dot(s, across), size = bumps->size * (det < 0 ? -1 : 1);
    Vec3 tilted = vec_scale(n, fabs(det));
    tilted = vec_mad(tilted, across, -size * slope(&heights, s, step));
    tilted = vec_mad(tilted, up, -size * slope(&heights, r, step));
    const double length = vec_length(tilted);
    if (!(length > 0) || !isfinite(length))
        return normal;
    tilted = vec_mad(vec_scale(n, 1 - bumps->strength), tilted, bumps->strength / length);
    return t ? transform_inverse_normal(t, tilted) : tilted;
}
