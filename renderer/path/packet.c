/* Many paths side by side, of a pixel or of several. Each takes the steps of trace_path, by the same functions and with
 * the same numbers; but a step is taken by all paths of a packet before the next one is: rays are traced together, and
 * memory is asked for before it is needed.
 *
 * All rays of a segment are traced before anything is shaded: tracing and shading
 * together are more code than a processor's first cache holds.
 *
 * Of matte surfaces, as most are, the direct-light sample and the BSDF sample are computed for a whole packet at once,
 * see matte.h. */
#include <string.h>
#include <retex/host/assert.h>
#include "path/internal.h"
#include "path/path.h"
#include "path/matte.h"
#include "shade/material.h"

#define PACKET_LEAST 4 /* rays that are traced together; fewer go one by one */

/* The paths that are still alive, their rays and what these meet. */
typedef struct Wavefront {
    Path paths[PATHS_MAX];
    Path *live[PATHS_MAX];
    Ray rays[PATHS_MAX];
    Hit hits[PATHS_MAX];
    int count;
} Wavefront;

/* Some of them, at their next vertices. */
typedef struct Packet {
    Path **paths;
    Ray *rays; /* that they came along */
    int count;
    Vertex vertices[ACCEL_PACKET];
    int scatters[ACCEL_PACKET]; /* by lane: the path met a surface */
    VertexSamples numbers;
    int matte[ACCEL_PACKET];    /* by lane: its lane among the matte ones, or -1 */
    /* by lane of the matte ones: */
    MattePacket mattes;
    MatteLights lights;
    MatteBounces bounces;
    const MeshLightFace *faces[MATTE_LANES];
    Visibility visibilities[MATTE_LANES];
    int traced[MATTE_LANES]; /* visibility is known */
} Packet;

/* ---- intersection ---- */

/* Of those from `first` on, as many as go in one packet. */
static int packet_size(int alive, int first)
{
    return alive - first < ACCEL_PACKET ? alive - first : ACCEL_PACKET;
}

static void trace_rays(PathWorker *w, Wavefront *wave, int step)
{
    const Accel *accel = w->context->accel;
    for (int first = 0; first < wave->count; first += ACCEL_PACKET) {
        int count = packet_size(wave->count, first);
        RayKind kinds[ACCEL_PACKET];
        for (int i = 0; i < count; i++)
            kinds[i] = wave->live[first + i]->kind;
        if (count >= PACKET_LEAST)
            accel_intersect_packet(accel, wave->rays + first, kinds, count, step == 0, wave->hits + first);
        else
            for (int i = 0; i < count; i++)
                accel_intersect(accel, &wave->rays[first + i], kinds[i], &wave->hits[first + i]);
    }
}

/* Step by step for all, so that what one step has to wait for from memory is on its way while others are at work. */
static void find_surfaces(const Scene *scene, Packet *p, const Hit *hits)
{
    for (int i = 0; i < p->count; i++)
        if (hits[i].primitive >= 0)
            surface_prefetch_face(scene, &hits[i]);
    for (int i = 0; i < p->count; i++)
        if (hits[i].primitive >= 0)
            surface_prefetch_corners(scene, &hits[i]);
    for (int i = 0; i < p->count; i++)
        if (hits[i].primitive >= 0) {
            Vertex *v = &p->vertices[i];
            surface_at(&v->s.surface, scene, &p->rays[i], &hits[i]);
            v->place = shading_prefetch(&v->s.surface);
        }
}

/* ---- matte surfaces ---- */

/* Take a vertex among the matte ones, if it is one and its light a face that the kernel knows. */
static int add_matte(PathWorker *w, Packet *p, int lane)
{
    const PathContext *c = w->context;
    Vertex *v = &p->vertices[lane];
    const VertexSamples *u = v->numbers;
    const Shading *s = &v->s;
    const Finish *finish = s->surface.texture->finish;
    MattePacket *m = &p->mattes;
    int k = m->count;
    MeshLightPoint point;
    Vec3 normal, geometric;
    if (!c->matte || v->is_last || s->filter + s->transmit > 0 || !finish->matte || s->surface.texture->normal ||
        s->surface.primitive->double_illuminate || shading_has_finishes(s, c->scene))
        return 0;
    bsdf_normals(&s->surface, vec_neg(p->rays[lane].direction), &normal, &geometric);
    LightSampleContext context = {s->surface.position, normal, s->surface.primitive->light_group};
    v->pick = lights_pick(c->lights, &context, u->light_choice[lane], u->light_more[lane]);
    v->picked = 1;
    if (!lights_uniform_point(c->lights, &v->pick, u->light_point_u[lane], u->light_point_v[lane], &point))
        return 0;
    const MeshLightFace *face = point.face;
    matte_set(&m->position, k, s->surface.position);
    matte_set(&m->normal, k, normal);
    matte_set(&m->geometric, k, geometric);
    matte_set(&m->corner, k, face->corner);
    matte_set(&m->edge1, k, face->edge1);
    matte_set(&m->edge2, k, face->edge2);
    matte_set(&m->face_normal, k, face->normal);
    m->density[k] = point.density, m->pick_probability[k] = v->pick.probability;
    m->diffuse[k] = (float)finish->diffuse;
    m->along[k] = point.along, m->across[k] = point.across;
    m->direction_u[k] = u->direction_u[lane], m->direction_v[k] = u->direction_v[lane];
    p->faces[k] = face;
    p->matte[lane] = m->count++;
    return 1;
}

static Ray matte_shadow_ray(const MatteLights *lights, int k)
{
    return (Ray){matte_get(&lights->origin, k), matte_get(&lights->direction, k), 0, lights->length[k]};
}

/* As add_direct_light, of a matte surface and a face that emits. */
static void add_matte_light(PathWorker *w, Packet *p, int lane, int k)
{
    const MatteLights *lights = &p->lights;
    Path *path = p->paths[lane];
    Vertex *v = &p->vertices[lane];
    DirectLightSample sample;
    if (!lights->found[k])
        return;
    sample.ray = matte_shadow_ray(lights, k);
    sample.light.source = NULL, sample.light.shadowless = 0, sample.light.radiance = rgb_grey(1);
    sample.light.is_sky = 0;
    sample.transmitted = 0, sample.traced = p->traced[k], sample.visibility = p->visibilities[k];
    Factor factors[SHADOW_FACTORS_MAX + 1];
    int passed = trace_shadow_ray(w, path, &v->s.surface, &sample, factors + 1, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    Split value = {rgb_grey(lights->value[k]), {0, 0, 0}};
    Contribution light = {.lamp = lights_lamp(w->context->lights, &v->pick), .factors = factors};
    light.light =
        rgb_mul(rgb_scale(sample.light.radiance, lights->weight[k]), p->faces[k]->emission[lights->behind[k]]);
    if (passed == 0 && surface_is_unsplit(w->context, &v->s)) { /* the factor is multiplied into the light */
        Rgb by_variant[VARIANTS_MAX];
        for (int i = 0; i < w->context->nvariants; i++)
            by_variant[i] = rgb_mul(light.light, split_apply(value, shading_albedo(&v->s, i)));
        light.light = by_variant[0], light.variants = by_variant;
        path_contribute(w, path, &light);
        return;
    }
    factors[0] = shading_factor(&v->s, color4(value.d), color4(value.i));
    set_seen(&factors[0], path);
    light.nfactors = 1 + passed;
    path_contribute(w, path, &light);
}

/* As scatter, of a matte surface. */
static int scatter_matte(PathWorker *w, Packet *p, int lane, int k, Ray *ray)
{
    const MatteBounces *bounces = &p->bounces;
    Path *path = p->paths[lane];
    const Shading *s = &p->vertices[lane].s;
    Split weight = {rgb_grey(p->mattes.diffuse[k]), {0, 0, 0}};
    if (!bounces->found[k])
        return 0;
    path->beta_neutral *= at_most(split_neutral(weight), 1);
    if (!path_apply_weight(w, path, s, weight, NULL, NULL, NULL, 1))
        return 0;
    path->kind = RAY_BOUNCE;
    path->prev_context =
        (LightSampleContext){s->surface.position, matte_get(&p->mattes.normal, k), s->surface.primitive->light_group};
    ray->origin = matte_get(&bounces->origin, k);
    ray->direction = matte_get(&bounces->direction, k);
    ray->tmin = 0, ray->tmax = INFINITY;
    path_next_segment(path, bounces->pdf[k], bounces->pdf[k]);
    return 1;
}

/* ---- a packet ---- */

/* The surface, and emission, of one lane. */
static void shade_lane(PathWorker *w, Packet *p, int lane, const Hit *hit)
{
    Path *path = p->paths[lane];
    const Ray *ray = &p->rays[lane];
    Vertex *v = &p->vertices[lane];
    p->matte[lane] = -1;
    w->segments++;
    const int goes_on = !w->context->has_air || path_pass_air(w, path, ray, hit);
    if (hit->primitive >= 0) {
        find_colors(w, path, v, ray, hit, &p->numbers, lane);
        if (!add_matte(w, p, lane)) {
            find_bsdf(w, path, v, ray, hit);
            if (!v->is_last)
                sample_direct_light(w, path, v);
        } else if (path->first_hits->wanted > 0 && path->segments == 1) { /* who observes first hits looks at BSDFs */
            shading_bsdf(&v->s, vec_neg(ray->direction));
        }
    }
    observe_first_hit(w, path, v, ray, hit);
    p->scatters[lane] = add_emission(w, path, v, ray, hit) & goes_on;
}

static void prefetch_lights(const PathContext *c, const Packet *p, const Hit *hits)
{
    float u[ACCEL_PACKET], v[ACCEL_PACKET];
    int n = 0;
    for (int i = 0; i < p->count; i++)
        if (hits[i].primitive >= 0)
            u[n] = p->numbers.light_point_u[i], v[n++] = p->numbers.light_point_v[i];
    lights_prefetch(c->lights, u, v, n);
}

static void shade(PathWorker *w, Packet *p, const Hit *hits, int step)
{
    uint32_t keys[VERTEX_LANES] = {0}, samples[VERTEX_LANES] = {0};
    for (int i = 0; i < p->count; i++)
        keys[i] = p->paths[i]->key, samples[i] = p->paths[i]->sample;
    vertex_samples(keys, samples, (unsigned)step, &p->numbers);
    prefetch_lights(w->context, p, hits);
    find_surfaces(w->context->scene, p, hits);
    p->mattes.count = 0;
    for (int i = 0; i < p->count; i++)
        shade_lane(w, p, i, &hits[i]);
    memset(p->traced, 0, sizeof p->traced);
    if (p->mattes.count > 0) {
        matte_lights(&p->lights, &p->mattes);
        matte_bounces(&p->bounces, &p->mattes);
    }
}

/* Trace the shadow rays of all lanes together. */
static void trace_shadow_rays(PathWorker *w, Packet *p)
{
    Visibility *to[ACCEL_PACKET], visibilities[ACCEL_PACKET];
    Ray rays[ACCEL_PACKET];
    int sources[ACCEL_PACKET], n = 0;
    for (int i = 0; i < p->count; i++) {
        DirectLightSample *sample = &p->vertices[i].light;
        int k = p->matte[i];
        if (!p->scatters[i])
            continue;
        if (k >= 0 && p->lights.found[k]) {
            rays[n] = matte_shadow_ray(&p->lights, k);
            sources[n] = 0;
            to[n++] = &p->visibilities[k];
            p->traced[k] = 1;
        } else if (k < 0 && sample->found && !sample->light.shadowless) {
            rays[n] = sample->ray;
            sources[n] = sample->light.source != NULL;
            to[n++] = &sample->visibility;
            sample->traced = 1;
        }
    }
    if (n == 0)
        return;
    accel_visibility_packet(w->context->accel, rays, sources, n, visibilities);
    for (int i = 0; i < n; i++)
        *to[i] = visibilities[i];
    w->shadow_rays += n;
}

/* Direct light and the next ray of one lane. Returns 0 where the path ends. */
static int advance_lane(PathWorker *w, Packet *p, int lane, Ray *ray)
{
    Path *path = p->paths[lane];
    Vertex *v = &p->vertices[lane];
    const int k = p->matte[lane];
    BsdfSample next;
    if (!p->scatters[lane])
        return 0;
    if (k >= 0) {
        add_matte_light(w, p, lane, k);
        return scatter_matte(w, p, lane, k, ray) && survives_roulette(w, path, v->numbers->roulette[lane]);
    }
    add_direct_light(w, path, v);
    return scatter(w, path, v, &next, ray) && (next.straight || survives_roulette(w, path, v->numbers->roulette[lane]));
}

/* A packet of paths goes on by a segment; those that stay alive go to the end of the wavefront's. */
static void advance(PathWorker *w, Wavefront *wave, int first, int count, int step)
{
    Packet p;
    RETEX_ASSERT(wave->count <= first); /* those that stay alive are put where none is left to be looked at */
    p.paths = wave->live + first, p.rays = wave->rays + first, p.count = count;
    shade(w, &p, wave->hits + first, step);
    if (step == 0 && count >= PACKET_LEAST) /* later shadow rays have little in common */
        trace_shadow_rays(w, &p);
    for (int i = 0; i < count; i++) {
        Path *path = p.paths[i];
        Ray *ray = &p.rays[i];
        if (advance_lane(w, &p, i, ray)) {
            wave->rays[wave->count] = *ray;
            wave->live[wave->count++] = path;
        }
    }
}

static void trace_wavefront(PathWorker *w, Wavefront *wave)
{
    for (int step = 0; wave->count > 0; step++) {
        int alive = wave->count;
        trace_rays(w, wave, step);
        wave->count = 0;
        for (int first = 0; first < alive; first += ACCEL_PACKET)
            advance(w, wave, first, packet_size(alive, first), step);
    }
}

/* From the camera to their ends. */
static void trace_paths(PathWorker *w, Wavefront *wave, const Ray *rays, const Sampler *samplers, int count, int each)
{
    wave->count = count;
    w->split.count = w->split.nlamp_light = 0;
    for (int i = 0; i < count; i++) {
        Path *path = wave->live[i] = &wave->paths[i];
        wave->rays[i] = rays[i];
        path->half = w->context->halves == 2 ? i & 1 : 0;
        path->control = &w->controls[i], path->first_hits = &w->first_hits[i / each];
        path_start(w, path, &rays[i], &samplers[i]);
    }
    if (w->context->scene->has_media)
        for (int i = 0; i < count; i++)
            w->draws = 0, trace_path(w, &wave->paths[i], rays[i]);
    else if (count == 1 && !w->context->matte) /* contributions of matte surfaces are rounded in another order */
        trace_path(w, &wave->paths[0], rays[0]);
    else
        trace_wavefront(w, wave);
}

void path_trace(PathWorker *w, const Ray *rays, const Sampler *samplers, int count, int each, PathResult *results)
{
    Wavefront wave;
    RETEX_ASSERT(count <= PATHS_MAX && each > 0 && count % each == 0);
    RETEX_ASSERT(!w->control || count == each); /* it has one pixel at a time */
    trace_paths(w, &wave, rays, samplers, count, each);
    for (int i = 0; i < count; i++) {
        const Path *path = &wave.paths[i];
        memcpy(results[i].light, path->light, sizeof path->light);
        results[i].cut = path->cut;
        if (w->context->split)
            results[i].hits = path->split.tree;
        if (w->control)
            control_end(w->control, path->control, path->half);
    }
}
