/* The path tracer: next-event estimation of one light at every vertex, multiple importance sampling with the BSDF,
 * Russian roulette on a throughput that does not depend on textures.
 *
 * trace_path tells it from top to bottom, for one path. Most paths go by packet.c, which takes the same steps for many
 * paths at once. */
#include <string.h>
#include <retex/color.h>
#include <retex/host/assert.h>
#include "light/environment.h"
#include "light/source.h"
#include "path/media.h"
#include "shade/dispersion.h"
#include "shade/material.h"

#define ROULETTE_START 2 /* segments before Russian roulette begins */

/* ---- the surface ---- */

static int is_first_hit(const Path *path)
{
    return path->segments + path->straight == 1;
}

/* Tell the film of a target that the camera sees directly. */
static void tell_place(Path *path, const Shading *s)
{
    const Sampler sampler = {path->key, path->sample};
    SeenTarget *seen = &path->split.tree.seen;
    seen->target = s->surface.target;
    seen->uv = s->uv;
    sampler_pair(&sampler, DIMENSION_PIXEL, &seen->place[0], &seen->place[1]);
}

void find_colors(PathWorker *w, Path *path, Vertex *v, const Ray *ray, const Hit *hit, const VertexSamples *numbers,
                 int lane)
{
    const PathContext *c = w->context;
    v->distance = hit->t, v->is_last = path->segments >= c->max_depth;
    v->numbers = numbers, v->lane = lane;
    v->light.found = v->picked = 0;
    if (path->leaving)
        leave_surface(v);
    else if (v->s.surface.texture->tree && !(c->white && is_first_hit(path)))
        choose_leaf(w, path, &v->s, vec_neg(ray->direction));
    else
        shading_color(&v->s, &v->place, w->variants, c->nvariants);
    if (c->places && v->s.surface.target >= 0 && is_first_hit(path))
        tell_place(path, &v->s);
}

/* Make it a white diffuse surface, of the same bumps. */
static void whiten(Vertex *v, const Ray *ray)
{
    static const Finish finish = {.diffuse = 1, .brilliance = 1, .roughness = 0.05, .phong_size = 40, .lambert = 1};
    Shading *s = &v->s;
    v->white = (Texture){.finish = &finish, .normal = s->surface.texture->normal};
    s->surface.texture = &v->white;
    s->surface.target = -1;
    s->albedo = rgb_grey(1);
    s->replaced = 0;
    s->filter = s->transmit = 0;
    bsdf_setup(&s->bsdf, &s->surface, vec_neg(ray->direction), 0, 0, 1);
}

static void print_hit(const PathContext *c, const Hit *hit, const Shading *s)
{
    const Vec3 p = s->surface.position, n = s->surface.shading_normal;
    fprintf(c->trace, "hit primitive %d (line %d) face %d at %.6g %.6g %.6g distance %.6g normal %.4f %.4f %.4f%s\n",
            hit->primitive, s->surface.primitive->line, hit->face, p.x, p.y, p.z, hit->t, n.x, n.y, n.z,
            s->surface.backside ? " from inside" : "");
    const Rgb albedo = shading_albedo(s, 0);
    fprintf(c->trace, "  albedo %.5f %.5f %.5f", albedo.r, albedo.g, albedo.b);
    if (s->surface.target >= 0)
        fprintf(c->trace, " target %s uv %.6f %.6f", c->scene->targets[s->surface.target].name, s->uv.u, s->uv.v);
    fputc('\n', c->trace);
}

void find_bsdf(PathWorker *w, Path *path, Vertex *v, const Ray *ray, const Hit *hit)
{
    const PathContext *c = w->context;
    v->finishes.count = 0;
    if (shading_has_finishes(&v->s, c->scene) && !path->leaving && !(c->white && is_first_hit(path)))
        finishes_setup(v, c->scene, w->variants, c->nvariants, vec_neg(ray->direction));
    else
        shading_bsdf(&v->s, path->leaving ? v->s.surface.shading_normal : vec_neg(ray->direction));
    if (c->white && is_first_hit(path))
        whiten(v, ray);
    v->wavelength = -1;
    if (shading_disperses(&v->s))
        disperse(w, path, v, vec_neg(ray->direction));
    if (c->trace)
        print_hit(c, hit, &v->s);
    v->cell = guide_cell(c, v);
}

void observe_first_hit(PathWorker *w, const Path *path, const Vertex *v, const Ray *ray, const Hit *hit)
{
    FirstHits *first = path->first_hits;
    if (first->wanted > 0 && is_first_hit(path))
        first->wanted = w->observe(first->pixel, ray, hit, &v->s);
}

/* ---- emission ---- */

static void add_surface_emission(PathWorker *w, Path *path, const Hit *hit, const Shading *s)
{
    if (rgb_is_black(s->surface.texture->finish->emission))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight = mis_weight(path->pdf,
                            lights_emitter_pdf(w->context->lights, &path->prev_context, hit->primitive, &s->surface));
    const Split light = surface_emission(s);
    Factor factor = shading_factor(s, color4(light.d), color4(light.i));
    set_seen(&factor, path);
    path_contribute(w, path, &(Contribution){surface_lamp(&s->surface), rgb_grey(weight), &factor, 1, NULL});
}

static void add_sky(PathWorker *w, Path *path, Vec3 direction)
{
    Rgb radiance = sky_radiance(w->context->scene, direction, path->delta);
    if (rgb_is_black(radiance))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight = mis_weight(path->pdf, lights_sky_pdf(w->context->lights, &path->prev_context, direction));
    path_contribute(w, path, &(Contribution){w->context->scene->sky_lamp, rgb_scale(radiance, weight), NULL, 0, NULL});
}

int add_emission(PathWorker *w, Path *path, const Vertex *v, const Ray *ray, const Hit *hit)
{
    if (path->leaving)
        return hit->primitive >= 0;
    if (hit->primitive < 0) {
        if (camera_ray_exists(ray) && (!w->context->white || path->segments > 1))
            add_sky(w, path, ray->direction);
        return 0;
    }
    if (path->media.count || v->s.surface.backside)
        path_scale(w, path, media_fade(&path->media, hit->t - ray->tmin, &v->s.surface));
    add_surface_emission(w, path, hit, &v->s);
    return 1;
}

/* ---- direct light ---- */

void add_direct_light(PathWorker *w, Path *path, Vertex *v)
{
    DirectLightSample *sample = &v->light;
    const LightSample *light = &sample->light;
    Factor factors[1 + LIGHT_FACTORS_MAX + SHADOW_FACTORS_MAX];
    if (!sample->found)
        return;
    int is_source = light->source != NULL, n = sample->nfactors;
    int passed = trace_shadow_ray(w, path, &v->s.surface, sample, factors + n, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    memcpy(factors, sample->factors, (size_t)n * sizeof *factors);
    set_seen(&factors[0], path);
    n += passed;
    RayKind kind = path_next_kind(path->kind, &v->s.bsdf, sample->transmitted);
    float pdf = is_source ? 0 : path_pdf_of_light(w->context, &sample->ray, kind, light, sample->pdf);
    if (pdf < 0)
        return;
    float light_pdf = light->pdf * light->pick_probability;
    float weight = is_source ? 1 / light->pick_probability : mis_weight(light_pdf, pdf) / light_pdf;
    Rgb radiance = rgb_scale(light->radiance, weight);
    if (sample->transmitted && v->wavelength >= 0)
        radiance = rgb_mul(radiance, dispersion_color(v->wavelength));
    path_contribute(w, path, &(Contribution){light->lamp, radiance, factors, n, NULL});
}

/* ---- the next direction ---- */

/* Refraction scales radiance by 1 / eta^2, and the way out of the glass scales it back. Roulette must not end paths for
 * it, so the neutral throughput leaves this scale out (etaScale of pbrt). */
static float eta_scale(const Bsdf *bsdf, const BsdfSample *next)
{
    return next->transmitted && bsdf->refracts ? bsdf->bend * bsdf->bend : 1;
}

/* Light sources that the next ray meets. No path could hit a point; but where they throw caustics they are small
 * spheres to a path that left a surface which scatters widely, and was bent since by what throws caustics. Shadow rays
 * do not find that light, which goes straight through nothing that bends it. */
static void meet_sources(PathWorker *w, Path *path, const Vertex *v, const BsdfSample *next, const Ray *ray)
{
    const PathContext *c = w->context;
    const Primitive *p = v->s.surface.primitive;
    Factor factors[SHADOW_FACTORS_MAX];
    if (next->pdf > 0) {
        path->specular = SPECULAR_BEGINS, path->light_group = p->light_group, path->source_scale = 1;
        return;
    }
    const int by = next->transmitted || v->s.surface.backside ? CAUSTICS_REFRACT : CAUSTICS_REFLECT;
    path->specular = path->specular && (p->caustics & by) ? path->specular | by : 0;
    for (int k = 0; path->specular && k < c->scene->nlights; k++) {
        const Light *light = &c->scene->lights[k];
        DirectLightSample met = {.ray = *ray};
        if (!light->caustics || (path->specular & ~light->caustics & ~SPECULAR_BEGINS) ||
            !light_reaches(light, path->light_group) || !source_meet(light, ray, &met.light))
            continue;
        met.ray.tmax = met.light.shadow_distance * (1 - 1e-6);
        const int passed = trace_shadow_ray(w, path, &v->s.surface, &met, factors, SHADOW_FACTORS_MAX);
        if (passed >= 0)
            path_contribute(
                w, path,
                &(Contribution){light->lamp, rgb_scale(met.light.radiance, path->source_scale), factors, passed, NULL});
    }
}

#define BEYOND_SEGMENTS 240 /* that paths are followed at most beyond the maximum depth */
#define BEYOND_EVERY 4      /* so many of them are one that is followed: it is not worth more time */

/* A path ends at its last vertex because it has no segment left: see how much light it would have found, by going on
 * with other numbers and on its own throughput, whose luminance is 1 to begin with. Nothing of it gets into the
 * picture. */
static void follow_beyond(PathWorker *w, Path *path, const Vertex *last, Ray ray)
{
    const PathContext *context = w->context;
    PathContext beyond = *context;
    ControlPixel *control = w->control;
    const long segments = w->segments, shadow_rays = w->shadow_rays;
    const float scale = luminance4(path->beta) * BEYOND_EVERY;
    Path on = *path;
    Vertex v = *last;
    BsdfSample next;
    if (context->is_beyond || hash_pair(path->key, path->sample) % BEYOND_EVERY || !(scale > 0) || !isfinite(scale))
        return;
    on.beta *= splat(BEYOND_EVERY / scale), on.key = hash_pair(path->key, 0x6375742e);
    on.light[0] = on.light[1] = on.light[2] = 0;
    v.is_last = 0;
    beyond.is_beyond = 1, beyond.max_depth += BEYOND_SEGMENTS;
    beyond.split = beyond.places = 0, beyond.nvariants = 1, beyond.trace = NULL;
    w->context = &beyond, w->control = NULL;
    sample_direct_light(w, &on, &v);
    add_direct_light(w, &on, &v);
    if (scatter(w, &on, &v, &next, &ray))
        trace_path(w, &on, ray);
    w->context = context, w->control = control;
    w->segments = segments, w->shadow_rays = shadow_rays;
    const double cut = (double)scale * retex_luminance(on.light[0], on.light[1], on.light[2]);
    path->cut += isfinite(cut) ? cut : 0;
}

/* Multiply throughput by what the surface does to light from the sampled direction. pdf: its density with the guide;
 * weights: of each finish. Returns path_is_alive. */
static int apply_sample(PathWorker *w, Path *path, const Vertex *v, BsdfSample *next, float pdf,
                        const Split weights[FINISHES_MAX])
{
    const Shading *s = &v->s;
    const VertexFinishes *of = &v->finishes;
    /* By the BSDF's own weight: the guide sends more paths to where light is expected, which must not end them. */
    const float neutral = of->count ? finishes_neutral(v, weights) : split_neutral(next->weight);
    path->beta_neutral *= at_most(neutral * eta_scale(&s->bsdf, next), 1);
    const float guided = pdf != next->pdf ? next->pdf / pdf : 1;
    if (pdf != next->pdf)
        next->weight = (Split){rgb_scale(next->weight.d, guided), rgb_scale(next->weight.i, guided)};
    FinishFactor by_finish[FINISHES_MAX], by_variant[VARIANTS_MAX];
    for (int k = 0; k < of->count; k++)
        by_finish[k] = (FinishFactor){color4(weights[k].d) * splat(guided), color4(weights[k].i) * splat(guided)};
    const FinishFactor *finishes = of->count ? by_finish : NULL;
    const FinishFactor *variants =
        finishes_variants(v, next->wi, BSDF_ANY_LIGHT, next->pdf, guided, next->pdf > 0 ? NULL : by_finish,
                          w->context->nvariants, by_variant);
    return path_apply_weight(w, path, s, next->weight, finishes, of->count && of->has_weights ? of->weights : NULL,
                             variants, !next->transmitted);
}

/* Begin the next segment along the sampled direction. */
static void leave_vertex(PathWorker *w, Path *path, const Vertex *v, const BsdfSample *next, float pdf, Ray *ray)
{
    const Shading *s = &v->s;
    RETEX_ASSERT(!(fabs(vec_dot(next->wi, next->wi) - 1) > 1e-4)); /* densities are per solid angle */
    path->kind = path_next_kind(path->kind, &s->bsdf, next->transmitted);
    path->prev_context = light_sample_context(s);
    ray->origin = accel_offset(s->surface.position, s->surface.geometric_normal, next->wi);
    ray->direction = next->wi;
    ray->tmin = 0, ray->tmax = INFINITY;
    path_next_segment(path, pdf, next->pdf);
    if (w->context->caustic_sources > 0)
        meet_sources(w, path, v, next, ray);
}

int scatter(PathWorker *w, Path *path, const Vertex *v, BsdfSample *next, Ray *ray)
{
    const Bsdf *bsdf = &v->s.bsdf;
    const int may_pass_straight = bsdf->p_passing > 0 && !bsdf->refracts;
    Split weights[FINISHES_MAX];
    float pdf;
    path->leaving = 0;
    if (v->is_last && !may_pass_straight) { /* no segment is left */
        follow_beyond(w, path, v, *ray);
        return 0;
    }
    if (!sample_direction(v, next, weights, &pdf) || !apply_sample(w, path, v, next, pdf, weights))
        return 0;
    RETEX_ASSERT(!next->straight || next->transmitted);
    RETEX_ASSERT(!next->straight || next->pdf == 0); /* passing straight is a delta lobe */
    RETEX_ASSERT((pdf > 0) == (next->pdf > 0));      /* the guide does not sample delta lobes */
    if (w->context->trace)
        fprintf(w->context->trace, "  goes on along %.5f %.5f %.5f pdf %.6g d %.5g i %.5g\n", next->wi.x, next->wi.y,
                next->wi.z, pdf, rgb_luminance(next->weight.d), rgb_luminance(next->weight.i));
    if (next->transmitted && v->wavelength >= 0)
        path_take_wavelength(w, path, v->wavelength);
    if (next->transmitted)
        media_cross(&path->media, &v->s.surface);
    if (next->straight) { /* the same segment goes on behind the surface */
        ray->tmin = v->distance;
        return ++path->straight <= STRAIGHT_MAX;
    }
    if (v->is_last)
        return 0;
    if (next->subsurface) {
        walk_below_surface(w, path, v, next->wi, ray);
        return path_is_alive(w, path);
    }
    leave_vertex(w, path, v, next, pdf, ray);
    return 1;
}

int survives_roulette(PathWorker *w, Path *path, float u)
{
    if (path->segments <= ROULETTE_START)
        return 1;
    float survival = at_most(w->context->is_beyond ? luminance4(path->beta) : path->beta_neutral, 1);
    if (u >= survival)
        return 0;
    path_scale(w, path, rgb_grey(1 / survival));
    path->beta_neutral /= survival;
    return 1;
}

/* ---- media ---- */

/* First hits are told of where no path gets to as well. */
static MediumEvent cross_media(PathWorker *w, Path *path, Ray *ray, const Hit *hit)
{
    const Ray before = *ray;
    FirstHits *first = path->first_hits;
    const int is_wanted = first->wanted > 0 && is_first_hit(path);
    MediumEvent event = path_cross_media(w, path, ray, hit);
    if (event == MEDIUM_SCATTERED && !survives_roulette(w, path, media_draw(w, path)))
        event = MEDIUM_ENDED;
    if (is_wanted && event != MEDIUM_PASSED) {
        Shading s = {.is_leaf = 0};
        if (hit->primitive >= 0)
            shading_at(&s, w->context->scene, w->variants, w->context->nvariants, &before, hit);
        first->wanted = w->observe(first->pixel, &before, hit, &s);
    }
    return event;
}

/* ---- the path ---- */

/* The order is that of PathIntegrator::Li in pbrt. */
void trace_path(PathWorker *w, Path *path, Ray ray)
{
    const PathContext *c = w->context;
    const uint32_t keys[VERTEX_LANES] = {path->key}, samples[VERTEX_LANES] = {path->sample};
    VertexSamples numbers;
    Vertex v = {.place = {0}};
    BsdfSample next;
    Hit hit;
    for (unsigned vertex = 0;; vertex++) {
        /* Intersect the ray with the scene. */
        w->segments++;
        accel_intersect(c->accel, &ray, path->kind, &hit);

        /* Add the light of fog and media on the way, which dim what lies behind. Media may scatter the path. */
        if (c->has_air && !path_pass_air(w, path, &ray, &hit))
            return;
        if (c->scene->has_media && !path->leaving) {
            const MediumEvent event = cross_media(w, path, &ray, &hit);
            if (event == MEDIUM_ENDED)
                return;
            if (event == MEDIUM_SCATTERED)
                continue;
        }

        /* Find the colours and the BSDF of the surface. */
        if (hit.primitive >= 0) {
            vertex_samples(keys, samples, vertex, &numbers);
            surface_at(&v.s.surface, c->scene, &ray, &hit);
            find_colors(w, path, &v, &ray, &hit, &numbers, 0);
            find_bsdf(w, path, &v, &ray, &hit);
        }
        observe_first_hit(w, path, &v, &ray, &hit);

        /* Add emission, weighted by MIS: the direct-light sample of the vertex before could have found it too. */
        if (!add_emission(w, path, &v, &ray, &hit))
            return;

        /* Sample one point on one light, and add its light if it is visible, weighted by MIS. */
        if (!v.is_last)
            sample_direct_light(w, path, &v);
        add_direct_light(w, path, &v);

        /* Sample the BSDF: its weight goes into throughput, its direction into the next ray. */
        if (!scatter(w, path, &v, &next, &ray))
            return;

        /* End the path at random where its neutral throughput is low. */
        if (!next.straight && !survives_roulette(w, path, numbers.roulette[0]))
            return;
    }
}
