/* Shadow rays: which lights a vertex sees, and how fading interiors and transparent surfaces dim them. */
#include "light/environment.h"
#include <retex/host/assert.h>
#include "path/internal.h"
#include "shade/fresnel.h"
#include "shade/material.h"

static float fade_channel(float color, double x, double power)
{
    if (power > 1000)
        return (float)exp(-(1 - color) * x);
    return color + (1 - color) * (float)(1 / (1 + pow(x, power)));
}

static Rgb fade_over(const Interior *in, double distance)
{
    double x = distance / in->fade_distance, power = in->fade_power;
    return rgb(fade_channel(in->fade_color.r, x, power), fade_channel(in->fade_color.g, x, power),
               fade_channel(in->fade_color.b, x, power));
}

static int media_find(const Media *media, const Interior *interior)
{
    int k = media->count - 1;
    while (k >= 0 && media->interiors[k] != interior)
        k--;
    return k;
}

static const Interior *fading_interior(const Surface *surface)
{
    const Interior *in = surface->primitive->interior;
    return in && in->fade_power > 0 && in->fade_distance > 0 ? in : NULL;
}

/* POV-Ray's fading of light over a distance, up to a surface or NULL. A ray that leaves an interior that it never
 * entered started in it: the camera or a light stands there. */
Rgb media_fade(const Media *media, double distance, const Surface *met)
{
    Rgb fade = rgb_grey(1);
    for (int k = 0; k < media->count; k++)
        fade = rgb_mul(fade, fade_over(media->interiors[k], distance));
    const Interior *in = met && met->backside ? fading_interior(met) : NULL;
    return in && media_find(media, in) < 0 ? rgb_mul(fade, fade_over(in, distance)) : fade;
}

static void cross_filled(Media *media, const Surface *surface)
{
    const Interior *in = surface->primitive->interior;
    int k = media->nfilled - 1;
    if (!surface->backside) {
        if (media->nfilled < FILLED_MAX)
            media->filled[media->nfilled++] = in;
        return;
    }
    while (k >= 0 && media->filled[k] != in)
        k--;
    if (k >= 0)
        media->filled[k] = media->filled[--media->nfilled];
}

/* A ray passes through a surface: it enters or leaves an interior. */
void media_cross(Media *media, const Surface *surface)
{
    const Interior *in = fading_interior(surface);
    if (surface->primitive->is_solid)
        media->solids += surface->backside ? -1 : 1;
    if (surface->primitive->interior && surface->primitive->interior->media)
        cross_filled(media, surface);
    if (!in)
        return;
    int k = media_find(media, in);
    if (!surface->backside && k < 0 && media->count < MEDIA_MAX)
        media->interiors[media->count++] = in;
    if (surface->backside && k >= 0)
        media->interiors[k] = media->interiors[--media->count];
}

/* What a surface on a shadow ray does to the light: let it pass straight, or block it (0). Light sources that have no
 * caustics, which no path can hit, shine through glass unbent. Refracted light of all other lights is found by paths.
 * source: NULL for other lights. */
static int shadow_factor(const Shading *s, const Light *source, Factor *factor)
{
    if (s->bsdf.refracts && (!source || (source->caustics & s->surface.primitive->caustics & CAUSTICS_REFRACT)))
        return 0;
    Split passing = s->bsdf.passing;
    if (s->bsdf.disney && s->bsdf.transmission > 0) {
        passing.d = rgb_grey(s->bsdf.transmission * (1 - fresnel_dielectric((float)s->bsdf.cos_o, s->bsdf.eta)));
        passing.i = rgb_grey(0);
    }
    if (rgb_is_black(passing.d) && rgb_is_black(passing.i))
        return 0;
    *factor = shading_factor(s, color4(passing.d), color4(passing.i));
    return 1;
}

/* A surface as a ray that passes through it unbent sees it. Reflectance is that from outside on either side: light that
 * entered a pane through one face leaves through the other and is never totally reflected. */
static Surface seen_from_outside(Surface surface)
{
    if (surface.backside) {
        surface.backside = 0;
        surface.geometric_normal = vec_neg(surface.geometric_normal);
        surface.shading_normal = vec_neg(surface.shading_normal);
    }
    return surface;
}

/* The k-th surface on the ray. Returns 0 where no light passes. */
static int pass_surface(PathWorker *w, const Path *path, const Surface *surface, int k, Vec3 wo, const Light *source,
                        LightFactors *to)
{
    Shading s;
    Factor factor;
    s.surface = *surface;
    if (surface->texture->tree) {
        s.surface = seen_from_outside(*surface);
        if (!choose_leaf_of_light(w, path, &s, wo, 1, TEXTURE_SHADOW + (unsigned)k, to))
            return 0;
    } else {
        shading_color(&s, NULL, w->variants, w->context->nvariants);
        s.surface = seen_from_outside(*surface);
    }
    bsdf_setup(&s.bsdf, &s.surface, wo, s.filter, s.transmit, s.opacity);
    if (!shadow_factor(&s, source, &factor))
        return 0;
    if (factor.target < 0 || is_black4(factor.d))
        *to->light = rgb_mul(*to->light, rgb_of4(factor_whole(&factor)));
    else
        return light_factors_add(w->context, to, factor, &s);
    return 1;
}

static void dim_by_air(PathWorker *w, const Path *path, const Media *media, const Ray *ray, double distance,
                       const Surface *met, const Light *source, Rgb *light)
{
    const Scene *scene = w->context->scene;
    if ((media->count > 0 || met) && isfinite(distance))
        *light = rgb_mul(*light, media_fade(media, distance, met));
    if (scene->fogs || scene->has_media)
        *light = rgb_mul(*light, air_transmittance(w, path, media, ray, distance, source));
}

/* What is between surfaces, over a distance up to one of them or NULL. In most scenes that is nothing. */
static inline void dim(PathWorker *w, const Path *path, const Media *media, const Ray *ray, double distance,
                       const Surface *met, const Light *source, Rgb *light)
{
    const PathContext *c = w->context;
    if (media->count > 0 || met || c->has_air || c->scene->has_media)
        dim_by_air(w, path, media, ray, distance, met, source, light);
}

/* Follow a shadow ray through transparent surfaces, one after the other. */
static int trace_through_surfaces(PathWorker *w, const Path *path, Ray ray, const Light *source, Media *media,
                                  LightFactors *to)
{
    const PathContext *c = w->context;
    Hit hit;
    for (int k = 0; k < STRAIGHT_MAX; k++) {
        if (!accel_intersect(c->accel, &ray, RAY_SHADOW, &hit)) {
            dim(w, path, media, &ray, ray.tmax - ray.tmin, NULL, source, to->light);
            return to->count;
        }
        Surface surface;
        if (!accel_is_transparent(c->accel, &hit))
            return -1;
        surface_at(&surface, c->scene, &ray, &hit);
        if (!pass_surface(w, path, &surface, k, vec_neg(ray.direction), source, to))
            return -1;
        dim(w, path, media, &ray, hit.t - ray.tmin, &surface, source, to->light);
        media_cross(media, &surface);
        ray.tmin = hit.t; /* not a new ray from there: points on large triangles are good to float only */
    }
    return -1;
}

/* Of a shadow ray that is not blocked, and may leave on the other side of the surface. */
static int trace_through_media(PathWorker *w, const Path *path, const Surface *from, const DirectLightSample *t,
                               LightFactors *to)
{
    const Light *source = t->light.source;
    Media media = path->media;
    if (t->transmitted)
        media_cross(&media, from);
    if (t->visibility == VISIBILITY_TRANSPARENT)
        return trace_through_surfaces(w, path, t->ray, source, &media, to);
    dim(w, path, &media, &t->ray, t->ray.tmax - t->ray.tmin, NULL, source, to->light);
    return 0;
}

int trace_shadow_ray(PathWorker *w, const Path *path, const Surface *from, DirectLightSample *t, Factor *factors,
                     int most_factors)
{
    const Light *source = t->light.source;
    Rgb *light = &t->light.radiance;
    RETEX_ASSERT(!source || !t->light.is_sky);
    RETEX_ASSERT(!(t->ray.tmax < t->ray.tmin)); /* Embree takes an end below 0 for a ray that is blocked */
    if (t->light.shadowless)
        return 0;
    if (!t->traced) {
        w->shadow_rays++;
        t->visibility = accel_visibility(w->context->accel, &t->ray, source != NULL);
    }
    if (t->visibility == VISIBILITY_BLOCKED)
        return -1;
    if (t->light.is_sky) /* only now: the sky's picture is large, and most of these rays are blocked in a room */
        *light = sky_radiance(w->context->scene, t->light.direction, 0);
    if (t->visibility == VISIBILITY_TRANSPARENT || t->transmitted)
        return trace_through_media(w, path, from, t,
                                   &(LightFactors){light, factors, 0, most_factors, w->shadow_albedos});
    dim(w, path, &path->media, &t->ray, t->ray.tmax - t->ray.tmin, NULL, source, light);
    return 0;
}

/* Whether the front of an emitter that throws no shadow hides the sampled point of it. */
static int hidden_by_itself(const PathContext *c, Ray ray, const Primitive *emitter)
{
    Hit hit;
    while (accel_intersect(c->accel, &ray, (RayKind)(RAY_CAMERA | RAY_BOUNCE), &hit)) {
        if (!hit.instance && &c->scene->primitives[hit.primitive] == emitter)
            return 1;
        ray.tmin = hit.t;
    }
    return 0;
}

float path_pdf_of_light(const PathContext *c, const Ray *ray, RayKind kind, const LightSample *light, float pdf)
{
    const Primitive *emitter = light->surface.primitive;
    if (emitter && (kind == RAY_CAMERA ? emitter->no_image : emitter->no_reflection))
        pdf = 0;
    if (!c->has_no_shadow)
        return pdf;
    if (emitter && emitter->no_shadow && hidden_by_itself(c, *ray, emitter))
        return -1;
    return accel_occluded(c->accel, ray, kind, 1) ? 0 : pdf;
}
