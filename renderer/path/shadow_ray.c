/* Shadow rays: which lights a vertex sees, and how fading interiors and transparent surfaces dim them. */
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

/* A ray passes through a surface: it enters or leaves an interior. */
void media_cross(Media *media, const Surface *surface)
{
    const Interior *in = fading_interior(surface);
    if (!in)
        return;
    int k = media_find(media, in);
    if (!surface->backside && k < 0 && media->count < MEDIA_MAX)
        media->interiors[media->count++] = in;
    if (surface->backside && k >= 0)
        media->interiors[k] = media->interiors[--media->count];
}

/* What a surface on a shadow ray does to the light: let it pass straight, or block it (0). Light sources, which no path
 * can hit, shine through glass unbent. Refracted light of all other lights is found by paths. */
static int shadow_factor(const Shading *s, int light_source, Factor *factor)
{
    if (s->bsdf.refracts && !light_source)
        return 0;
    Split passing = s->bsdf.passing;
    if (s->bsdf.disney && s->bsdf.transmission > 0) {
        passing.d = rgb_grey(s->bsdf.transmission * (1 - fresnel_dielectric((float)s->bsdf.cos_o, s->bsdf.eta)));
        passing.i = rgb_grey(0);
    }
    if (rgb_is_black(passing.d) && rgb_is_black(passing.i))
        return 0;
    *factor = shading_factor(s, colour4(passing.d), colour4(passing.i));
    return 1;
}

const Rgb *keep_albedos(const PathContext *c, Rgb *storage, const Shading *s)
{
    if (!s->replaced)
        return NULL;
    for (int v = 0; v < c->nvariants; v++)
        storage[v] = s->albedos[v];
    return storage;
}

/* What a surface is to a ray that passes through it unbent. Reflectance is that from outside on either side: light that
 * entered a pane through one face leaves through the other and is never totally reflected. */
static void shading_straight(Shading *s, const PathWorker *w, const Ray *ray, Surface *surface)
{
    s->surface = *surface;
    shading_color(s, NULL, w->variants, w->context->nvariants);
    if (surface->backside) {
        s->surface.backside = 0;
        s->surface.geometric_normal = vec_neg(surface->geometric_normal);
        s->surface.shading_normal = vec_neg(surface->shading_normal);
    }
    bsdf_setup(&s->bsdf, &s->surface, vec_neg(ray->direction), s->filter, s->transmit);
}

/* Follow a shadow ray through transparent surfaces, one after the other. */
static int trace_through_surfaces(PathWorker *w, Ray ray, int light_source, Media *media, Rgb *light, Factor *factors,
                                  int most_factors)
{
    const PathContext *c = w->context;
    int n = 0;
    Hit hit;
    Shading s;
    for (int k = 0; k < STRAIGHT_MAX; k++) {
        if (!accel_intersect(c->accel, &ray, RAY_SHADOW, &hit)) {
            if (media->count > 0 && isfinite(ray.tmax))
                *light = rgb_mul(*light, media_fade(media, ray.tmax - ray.tmin, NULL));
            return n;
        }
        Surface surface;
        Factor factor;
        if (!accel_is_transparent(c->accel, hit.primitive))
            return -1;
        surface_at(&surface, c->scene, &ray, &hit);
        shading_straight(&s, w, &ray, &surface);
        if (!shadow_factor(&s, light_source, &factor))
            return -1;
        if (factor.target < 0 || is_black4(factor.d)) {
            *light = rgb_mul(*light, rgb_of4(factor_whole(&factor)));
        } else {
            if (n == most_factors)
                return -1;
            factor.albedos = keep_albedos(c, w->shadow_albedos[n], &s);
            factors[n++] = factor;
        }
        *light = rgb_mul(*light, media_fade(media, hit.t - ray.tmin, &surface));
        media_cross(media, &surface);
        ray.tmin = hit.t; /* not a new ray from there: points on large triangles are good to float only */
    }
    return -1;
}

int trace_shadow_ray(PathWorker *w, const Path *path, const Surface *from, DirectLightSample *t, Factor *factors,
                     int most_factors)
{
    int source = t->light.kind == LIGHT_SAMPLE_SOURCE;
    Rgb *light = &t->light.radiance;
    if (t->light.shadowless)
        return 0;
    if (!t->traced) {
        w->shadow_rays++;
        t->visibility = accel_visibility(w->context->accel, &t->ray, source);
    }
    if (t->visibility == VISIBILITY_BLOCKED)
        return -1;
    Media media = path->media;
    if (t->transmitted)
        media_cross(&media, from);
    if (t->visibility == VISIBILITY_TRANSPARENT)
        return trace_through_surfaces(w, t->ray, source, &media, light, factors, most_factors);
    if (media.count > 0 && isfinite(t->ray.tmax))
        *light = rgb_mul(*light, media_fade(&media, t->ray.tmax - t->ray.tmin, NULL));
    return 0;
}

/* Whether the front of an emitter that throws no shadow hides the sampled point of it. */
static int hidden_by_itself(const PathContext *c, Ray ray, const Primitive *emitter)
{
    Hit hit;
    while (accel_intersect(c->accel, &ray, (RayKind)(RAY_CAMERA | RAY_BOUNCE), &hit)) {
        if (&c->scene->primitives[hit.primitive] == emitter)
            return 1;
        ray.tmin = hit.t;
    }
    return 0;
}

float path_pdf_of_light(const PathContext *c, const Ray *ray, RayKind kind, const LightSample *light, float pdf)
{
    const Primitive *emitter = light->kind == LIGHT_SAMPLE_EMITTER ? light->surface.primitive : NULL;
    if (emitter && (kind == RAY_CAMERA ? emitter->no_image : emitter->no_reflection))
        pdf = 0;
    if (!c->has_no_shadow)
        return pdf;
    if (emitter && emitter->no_shadow && hidden_by_itself(c, *ray, emitter))
        return -1;
    return accel_occluded(c->accel, ray, kind, 1) ? 0 : pdf;
}
