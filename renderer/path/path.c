/* The path tracer: next-event estimation of one light at every vertex, multiple importance sampling with the BSDF,
 * Russian roulette on a throughput that knows no texture.
 *
 * The paths of a pixel go side by side, a segment at a time, in packets of those that are still on their way: rays, the
 * numbers of their vertices and what is chosen at plain surfaces are worked out for a packet at once. All rays of a
 * segment are traced before anything is done where they met the scene: tracing and shading together are more code than
 * a processor's first cache holds. */
#include <string.h>
#include "path/matte.h"
#include "path/internal.h"
#include "shade/material.h"

#define ROULETTE_START 2 /* segments before Russian roulette begins */
#define PACKET_LEAST 4   /* rays that are traced together; fewer go one by one */
#define SHARP_PDF 25     /* per steradian: a bounce into a lobe no wider than about 7 degrees keeps things sharp */

/* Paths that are still on their way, the rays they go on with and what these meet. */
typedef struct Wave {
    Path paths[PATHS_MAX];
    Path *live[PATHS_MAX];
    Ray rays[PATHS_MAX];
    Hit hits[PATHS_MAX];
    int count;
} Wave;

/* The path itself ran into something that shines. */
static void hit_emitter(PathWorker *w, Path *path, const Hit *hit, const Shading *s)
{
    if (rgb_is_black(s->surface.texture->finish->emission))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight =
            mis_weight(path->pdf, lights_emitter_pdf(w->context->lights, &path->from, hit->primitive, &s->surface));
    const Split light = emitted(s);
    Factor factor = shading_factor(s, colour4(light.d), colour4(light.i));
    factor.sharp = path->sharp;
    path_connect(w, path, rgb_grey(weight), &factor, 1);
}

static void hit_sky(PathWorker *w, Path *path, Vec3 direction)
{
    Rgb radiance = sky_radiance(w->context->scene, direction);
    if (rgb_is_black(radiance))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight = mis_weight(path->pdf, lights_sky_pdf(w->context->lights, &path->from, direction));
    path_connect(w, path, rgb_scale(radiance, weight), NULL, 0);
}

/* Light that was picked for the path's end reaches it, if nothing is in the way. */
static void connect_light(PathWorker *w, Path *path, Vertex *v)
{
    LightTry *t = &v->light;
    int source = t->light.kind == LIGHT_SAMPLE_SOURCE, n = t->nfactors;
    Factor factors[SHADOW_FACTORS_MAX + 2];
    if (!t->found)
        return;
    int passed = way_to_light(w, path, &v->s.surface, t, factors + n, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    memcpy(factors, t->factors, (size_t)n * sizeof *factors);
    factors[0].sharp = path->sharp;
    n += passed;
    RayKind kind = path_next_kind(path->kind, &v->s.bsdf, t->other_side);
    float pdf = source ? 0 : path_density(w->context, &t->ray, kind, &t->light, t->pdf);
    if (pdf < 0)
        return;
    float light_pdf = t->light.pdf * t->light.pick_probability;
    float weight = source ? 1 / t->light.pick_probability : mis_weight(light_pdf, pdf) / light_pdf;
    path_connect(w, path, rgb_scale(t->light.radiance, weight), factors, n);
}

/* Radiance in glass is that outside times the square of the index, and back again on the way out: no reason to end a
 * path. */
static float squeeze_undone(const Bsdf *bsdf, const BsdfSample *next)
{
    return next->transmitted && bsdf->refracts ? bsdf->eta * bsdf->eta : 1;
}

/* Where a path goes on from a surface, in a direction of some density. Returns 0 where roulette ends it. */
static int bounce(PathWorker *w, Path *path, float pdf, int is_sharp, float roulette)
{
    path->pdf = pdf;
    path->sharp &= is_sharp;
    if (path->segments++ < ROULETTE_START)
        return 1;
    float survive = at_most(path->neutral, 1);
    if (roulette >= survive)
        return 0;
    path_scale(w, path, rgb_grey(1 / survive));
    path->neutral /= survive;
    return 1;
}

/* What a surface makes of the light that comes by the path from here on. Returns 0 where none can come. */
static inline int leave(PathWorker *w, Path *path, const Shading *s, Split weight, int reflects)
{
    if (path_sees_plain(w->context, s) && !s->replaced)
        return path_scale(w, path, split_apply(weight, shading_albedo(s, 0)));
    return path_scatter(w, path, s, colour4(weight.d), colour4(weight.i), reflects);
}

/* Choose where the path goes on. Returns 0 where it ends. */
static int scatter(PathWorker *w, Path *path, const Vertex *v, Ray *ray)
{
    const Shading *s = &v->s;
    BsdfSample next;
    float pdf;
    if (!sample_direction(v, &next, &pdf))
        return 0;
    /* Where the guide goes light is expected: roulette does not count how often it goes there. */
    path->neutral *= at_most(split_neutral(next.weight) * squeeze_undone(&s->bsdf, &next), 1);
    if (pdf != next.pdf) {
        float guided = next.pdf / pdf;
        next.weight = (Split){rgb_scale(next.weight.d, guided), rgb_scale(next.weight.i, guided)};
    }
    if (!leave(w, path, s, next.weight, !next.transmitted))
        return 0;
    if (w->context->trace)
        fprintf(w->context->trace, "  goes on along %.5f %.5f %.5f pdf %.6g d %.5g i %.5g\n", next.wi.x, next.wi.y,
                next.wi.z, pdf, rgb_luminance(next.weight.d), rgb_luminance(next.weight.i));
    if (next.transmitted)
        media_cross(&path->media, &s->surface);
    if (next.straight) {
        ray->tmin = v->distance;
        return ++path->passed <= STRAIGHT_MAX;
    }
    path->kind = path_next_kind(path->kind, &s->bsdf, next.transmitted);
    path->from = lit_point(s);
    ray->origin = accel_offset(s->surface.position, s->surface.geometric_normal, next.wi);
    ray->direction = next.wi;
    ray->tmin = 0;
    return !v->last && bounce(w, path, pdf, next.pdf == 0 || next.pdf > SHARP_PDF, v->numbers->roulette[v->lane]);
}

/* Make it a white diffuse surface. */
static void whiten(Shading *s, const Ray *ray)
{
    static const Finish finish = {.diffuse = 1, .brilliance = 1, .roughness = 0.05, .phong_size = 40};
    static const Texture texture = {.finish = &finish};
    s->surface.texture = &texture;
    s->surface.target = -1;
    s->albedo = rgb_grey(1);
    s->replaced = 0;
    s->filter = s->transmit = 0;
    bsdf_setup(&s->bsdf, &s->surface, vec_neg(ray->direction), 0, 0);
}

static void trace_hit(const PathContext *c, const Hit *hit, const Shading *s)
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

/* A packet of paths at their next vertices. */
typedef struct Packet {
    Path **paths;
    Ray *rays; /* that they came along */
    int count;
    Vertex vertices[ACCEL_PACKET];
    VertexSamples numbers[2]; /* by half of the samples */
    int matte[ACCEL_PACKET];  /* lane of the matte ones, or -1 */
    MattePacket mattes;
    MatteLights lights;
    MatteBounces bounces;
    const MeshLightFace *faces[MATTE_LANES];
    AccelWay ways[MATTE_LANES];
    int looked[MATTE_LANES];
} Packet;

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
    double density;
    Vec3 normal, geometric;
    if (!c->matte || v->last || s->filter + s->transmit > 0 || !finish->matte)
        return 0;
    bsdf_normals(&s->surface, vec_neg(p->rays[lane].direction), &normal, &geometric);
    LitPoint point = {s->surface.position, normal};
    v->pick = lights_pick(c->lights, &point, u->light_choice[lane], u->light_part[lane]);
    v->picked = 1;
    const MeshLightFace *face = lights_even_face(c->lights, &v->pick, &density);
    if (!face)
        return 0;
    matte_set(&m->position, k, s->surface.position);
    matte_set(&m->normal, k, normal);
    matte_set(&m->geometric, k, geometric);
    matte_set(&m->corner, k, face->corner);
    matte_set(&m->edge1, k, face->edge1);
    matte_set(&m->edge2, k, face->edge2);
    matte_set(&m->face_normal, k, face->normal);
    m->density[k] = density, m->pick_probability[k] = v->pick.probability;
    m->diffuse[k] = (float)finish->diffuse;
    m->light_u[k] = u->light_point_u[lane], m->light_v[k] = u->light_point_v[lane];
    m->direction_u[k] = u->direction_u[lane], m->direction_v[k] = u->direction_v[lane];
    p->faces[k] = face;
    p->matte[lane] = m->count++;
    return 1;
}

/* What a ray looks like where it met the scene, and the light picked there. */
static void fill_vertex(PathWorker *w, Packet *p, int lane, const Hit *hit)
{
    const PathContext *c = w->context;
    const Path *path = p->paths[lane];
    const Ray *ray = &p->rays[lane];
    Vertex *v = &p->vertices[lane];
    v->distance = hit->t, v->last = path->segments >= c->max_depth;
    v->numbers = &p->numbers[path->half], v->lane = lane;
    v->light.found = v->picked = 0;
    shading_color(&v->s, &v->place, w->variants, c->nvariants);
    if (add_matte(w, p, lane))
        return;
    bsdf_setup(&v->s.bsdf, &v->s.surface, vec_neg(ray->direction), v->s.filter, v->s.transmit);
    if (c->white && path->segments + path->passed == 1)
        whiten(&v->s, ray);
    if (c->trace)
        trace_hit(c, hit, &v->s);
    v->cell = guide_cell(c, &v->s);
    if (!v->last)
        pick_light(w, v);
}

/* Guides look on from what rays from the camera meet. */
static void look_on(PathWorker *w, const Ray *ray, const Hit *hit, Vertex *v, int is_matte)
{
    if (!w->first_hit)
        return;
    if (hit->primitive >= 0 && is_matte)
        bsdf_setup(&v->s.bsdf, &v->s.surface, vec_neg(ray->direction), v->s.filter, v->s.transmit);
    w->first_hit(w->first_hit_context, ray, hit, &v->s);
}

/* A ray met something, or the sky: what shines there reaches the path. Returns 0 where it ends. */
static int arrive(PathWorker *w, Packet *p, int lane, const Hit *hit)
{
    const PathContext *c = w->context;
    Path *path = p->paths[lane];
    const Ray *ray = &p->rays[lane];
    Vertex *v = &p->vertices[lane];
    int is_first = path->segments + path->passed == 1;
    p->matte[lane] = -1;
    w->segments++;
    if (hit->primitive >= 0)
        fill_vertex(w, p, lane, hit);
    if (is_first)
        look_on(w, ray, hit, v, p->matte[lane] >= 0);
    if (hit->primitive < 0) {
        if (!c->white || path->segments > 1)
            hit_sky(w, path, ray->direction);
        return 0;
    }
    if (path->media.count || v->s.surface.backside)
        path_scale(w, path, media_fade(&path->media, hit->t - ray->tmin, &v->s.surface));
    hit_emitter(w, path, hit, &v->s);
    /* what is passed straight is no segment of its own */
    return p->matte[lane] >= 0 || !v->last || (v->s.bsdf.p_passing > 0 && !v->s.bsdf.refracts);
}

static Ray matte_light_ray(const MatteLights *lights, int k)
{
    return (Ray){matte_get(&lights->origin, k), matte_get(&lights->direction, k), 0, lights->reach[k]};
}

/* What is on the way to the lights picked for some vertices? */
static void look_for_lights(PathWorker *w, Packet *p)
{
    AccelWay *to[ACCEL_PACKET], ways[ACCEL_PACKET];
    Ray rays[ACCEL_PACKET];
    int sources[ACCEL_PACKET], n = 0;
    for (int i = 0; i < p->count; i++) {
        LightTry *t = &p->vertices[i].light;
        int k = p->matte[i];
        if (!p->vertices[i].met)
            continue;
        if (k >= 0 && p->lights.found[k]) {
            rays[n] = matte_light_ray(&p->lights, k);
            sources[n] = 0;
            to[n++] = &p->ways[k];
            p->looked[k] = 1;
        } else if (k < 0 && t->found && !t->light.shadowless) {
            rays[n] = t->ray;
            sources[n] = t->light.kind == LIGHT_SAMPLE_SOURCE;
            to[n++] = &t->way;
            t->looked = 1;
        }
    }
    if (n == 0)
        return;
    accel_way_packet(w->context->accel, rays, sources, n, ways);
    for (int i = 0; i < n; i++)
        *to[i] = ways[i];
    w->shadow_rays += n;
}

/* Light from a face reaches a matte surface, if nothing is in the way. */
static void connect_matte(PathWorker *w, Packet *p, int lane, int k)
{
    const MatteLights *lights = &p->lights;
    Path *path = p->paths[lane];
    Vertex *v = &p->vertices[lane];
    LightTry try, *t = &try;
    if (!lights->found[k])
        return;
    t->ray = matte_light_ray(lights, k);
    t->light.kind = LIGHT_SAMPLE_EMITTER, t->light.shadowless = 0, t->light.radiance = rgb_grey(1);
    t->other_side = 0, t->looked = p->looked[k], t->way = p->ways[k];
    Factor factors[SHADOW_FACTORS_MAX + 1];
    int passed = way_to_light(w, path, &v->s.surface, t, factors + 1, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    Split value = {rgb_grey(lights->value[k]), {0, 0, 0}};
    Rgb light = rgb_mul(rgb_scale(t->light.radiance, lights->weight[k]), p->faces[k]->shine[lights->behind[k]]);
    if (passed == 0 && path_sees_plain(w->context, &v->s)) {
        Rgb by_variant[VARIANTS_MAX];
        for (int i = 0; i < w->context->nvariants; i++)
            by_variant[i] = rgb_mul(light, split_apply(value, shading_albedo(&v->s, i)));
        path_bring(w, path, by_variant);
        return;
    }
    factors[0] = shading_factor(&v->s, colour4(value.d), colour4(value.i));
    factors[0].sharp = path->sharp;
    path_connect(w, path, light, factors, 1 + passed);
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
    path->neutral *= at_most(split_neutral(weight), 1);
    if (!leave(w, path, s, weight, 1))
        return 0;
    path->kind = RAY_BOUNCE;
    path->from = (LitPoint){s->surface.position, matte_get(&p->mattes.normal, k)};
    ray->origin = matte_get(&bounces->origin, k);
    ray->direction = matte_get(&bounces->direction, k);
    ray->tmin = 0;
    return bounce(w, path, bounces->pdf[k], bounces->pdf[k] > SHARP_PDF, p->vertices[lane].numbers->roulette[lane]);
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

/* Of those from `first` on, as many as go in one packet. */
static int packet_size(int alive, int first)
{
    return alive - first < ACCEL_PACKET ? alive - first : ACCEL_PACKET;
}

static void trace_rays(PathWorker *w, Wave *wave, int step)
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

static void meet(PathWorker *w, Packet *p, const Hit *hits, int step)
{
    uint32_t samples[VERTEX_LANES] = {0};
    for (int i = 0; i < p->count; i++)
        samples[i] = p->paths[i]->sample;
    for (int half = 0; half < w->context->halves; half++)
        vertex_samples(&w->keys[half], w->key[half], samples, (unsigned)step, &p->numbers[half]);
    find_surfaces(w->context->scene, p, hits);
    p->mattes.count = 0;
    for (int i = 0; i < p->count; i++)
        p->vertices[i].met = arrive(w, p, i, &hits[i]);
}

/* A packet of paths goes on by a segment; those that are still on their way go to the end of the wave's. */
static void advance(PathWorker *w, Wave *wave, int first, int count, int step)
{
    Packet p;
    p.paths = wave->live + first, p.rays = wave->rays + first, p.count = count;
    meet(w, &p, wave->hits + first, step);
    memset(p.looked, 0, sizeof p.looked);
    if (p.mattes.count > 0) {
        matte_lights(&p.lights, &p.mattes);
        matte_bounces(&p.bounces, &p.mattes);
    }
    if (step == 0 && count >= PACKET_LEAST)
        look_for_lights(w, &p);
    for (int i = 0; i < count; i++) {
        Path *path = p.paths[i];
        Ray *ray = &p.rays[i];
        int k = p.matte[i], goes_on;
        if (!p.vertices[i].met)
            continue;
        if (k >= 0) {
            connect_matte(w, &p, i, k);
            goes_on = scatter_matte(w, &p, i, k, ray);
        } else {
            connect_light(w, path, &p.vertices[i]);
            goes_on = scatter(w, path, &p.vertices[i], ray);
        }
        if (goes_on) {
            wave->rays[wave->count] = *ray;
            wave->live[wave->count++] = path;
        }
    }
}

void path_trace(PathWorker *w, const Ray *rays, const Sampler *samplers, int count)
{
    Wave wave;
    wave.count = count;
    w->nhits = w->log.count = 0;
    for (int i = 0; i < count; i++) {
        Path *path = wave.live[i] = &wave.paths[i];
        wave.rays[i] = rays[i];
        path->half = w->context->halves == 2 ? i & 1 : 0;
        path->betas = w->betas[i];
        w->key[path->half] = samplers[i].key;
        path_start(w, path, &rays[i], &samplers[i]);
    }
    for (int step = 0; wave.count > 0; step++) {
        int alive = wave.count;
        trace_rays(w, &wave, step);
        wave.count = 0;
        for (int first = 0; first < alive; first += ACCEL_PACKET)
            advance(w, &wave, first, packet_size(alive, first), step);
    }
    for (int i = 0; i < count; i++)
        path_end(w, &wave.paths[i]);
}
