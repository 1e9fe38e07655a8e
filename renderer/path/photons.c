/* Photons, each followed until it lands. */
#include "path/photons.h"
#include <stdlib.h>
#include <string.h>
#include <retex/parallel.h>
#include "light/source.h"
#include "medium/fog.h"
#include "path/media.h"
#include "path/sampler.h"
#include "path/shading.h"
#include "shade/casters.h"

#define PATHS_PER_PHOTON 20 /* of the picture, for each photon that is tried */
#define PHOTONS_MIN (1 << 14)
#define PHOTONS_MAX (1 << 20)        /* tried */
#define PHOTONS_OF_SOURCES (1 << 17) /* at least; lamps that small need lobes that narrow */
#define BATCH (1 << 12)              /* photons of one job */
#define BOUNCES_MAX 12
#define WAVELENGTH_NUMBER 64  /* of a photon's numbers; bounces have those before */
#define CASTERS_MAX (1 << 20) /* no photon is aimed at more of them */

/* The bounding sphere of what may refract or mirror light. */
typedef struct Aim {
    int primitive;
    const Instance *instance; /* whose copy of it, or NULL */
    Vec3 center;
    double radius;
} Aim;

/* State of tracing them. */
typedef struct Tracing {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    const RetexBudget *budget;
    int of_emitters, nsources; /* what photons start from: shapes that emit, light sources that have caustics */
    Aim *casters;
    double *caster_sums;
    int ncasters, capacity;
    Landing *landings; /* BATCH for each batch */
    int *counts;       /* by batch: how many of them */
} Tracing;

/* ---- casters ---- */

static int make_room(Tracing *m)
{
    const int capacity = m->capacity ? 2 * m->capacity : 64;
    Aim *casters = realloc(m->casters, (size_t)capacity * sizeof *casters);
    if (casters)
        m->casters = casters;
    double *sums = realloc(m->caster_sums, (size_t)capacity * sizeof *sums);
    if (sums)
        m->caster_sums = sums;
    if (!casters || !sums)
        return 0;
    m->capacity = capacity;
    return 1;
}

static int add_caster(void *context, const Caster *caster)
{
    Tracing *m = context;
    if (!caster->is_bounded)
        return 0;
    if (m->ncasters == m->capacity && !make_room(m))
        return RETEX_ENOMEM;
    const double radius = vec_length(vec_sub(caster->high, caster->low)) / 2;
    const double before = m->ncasters > 0 ? m->caster_sums[m->ncasters - 1] : 0;
    m->casters[m->ncasters] =
        (Aim){caster->primitive, caster->instance, vec_scale(vec_add(caster->low, caster->high), 0.5), radius};
    m->caster_sums[m->ncasters++] = before + radius * radius;
    return m->ncasters == CASTERS_MAX;
}

static int find_casters(Tracing *m, RetexError *err)
{
    const CasterKind kind = m->of_emitters ? CASTERS_OF_BOTH : CASTERS_OF_SOURCES;
    if (casters_visit(m->scene, kind, add_caster, m) == RETEX_ENOMEM)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the guide to caustics");
    return RETEX_OK;
}

/* ---- photons ---- */

static float photon_number(uint32_t photon, uint32_t dimension)
{
    return unit_float(hash_pair(hash_mix(photon ^ 0x43415553u), dimension));
}

static int pick_caster(const Tracing *m, double u)
{
    int low = 0, high = m->ncasters - 1;
    u *= m->caster_sums[high];
    while (low < high) {
        int middle = (low + high) / 2;
        if (m->caster_sums[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Sample a direction in the cone of a caster. Returns the solid angle. */
static double aim(const Aim *c, Vec3 from, float u1, float u2, Vec3 *direction)
{
    Vec3 axis = vec_sub(c->center, from), s, t;
    double distance2 = vec_dot(axis, axis), sin2 = c->radius * c->radius / distance2, less = 2, sine, cosine;
    if (sin2 < 1)
        less = sin2 / (1 + sqrt(1 - sin2));
    axis = vec_normalize(axis);
    vec_frame(axis, &s, &t);
    turn_sincos(u2, &sine, &cosine);
    double down = u1 * less, across = sqrt(down * (2 - down));
    *direction = vec_mad(vec_mad(vec_scale(axis, 1 - down), s, across * cosine), t, across * sine);
    return 2 * PI * less;
}

/* Where a photon starts, and what it carries. */
typedef struct Start {
    Ray ray;
    double power;
    int caster;          /* that it must meet first */
    const Light *source; /* NULL: an emitter. Its irradiance where the photon is first met is still to be multiplied, */
    int beam;            /* and unless it is a beam the squared distance */
} Start;

static void start_from_emitter(const Tracing *m, uint32_t photon, Start *start)
{
    const Aim *c = &m->casters[start->caster];
    EmissionPoint point;
    if (!lights_emission(m->lights, photon_number(photon, 0), photon_number(photon, 2), photon_number(photon, 3),
                         &point))
        return;
    double angle = aim(c, point.position, photon_number(photon, 5), photon_number(photon, 6), &start->ray.direction);
    start->ray.origin = accel_offset(point.position, point.normal, start->ray.direction);
    start->power = point.power * fabs(vec_dot(start->ray.direction, point.normal)) * angle;
}

/* Estimate of the light that a source sends to a caster. Spots and light distributions may light a part of it only. */
static double source_weight(const Light *light, const Aim *c)
{
    Vec3 direction;
    double distance;
    Light whole = *light;
    if (!light->caustics)
        return 0;
    const double seen = rgb_luminance(source_irradiance(light, c->center, light->location, &direction, &distance));
    whole.ops = &light_point, whole.ies = NULL;
    return fmax(seen,
                0.05 * rgb_luminance(source_irradiance(&whole, c->center, light->location, &direction, &distance)));
}

/* A source by its light on a caster; *probability. */
static const Light *pick_source(const Tracing *m, const Aim *c, double u, double *probability)
{
    const Scene *scene = m->scene;
    const Light *last = NULL;
    double sum = 0, weight = 0;
    for (int k = 0; k < scene->nlights; k++)
        sum += source_weight(&scene->lights[k], c);
    u *= sum;
    for (int k = 0; k < scene->nlights && (!last || u >= 0); k++) {
        const double w = source_weight(&scene->lights[k], c);
        if (w > 0)
            last = &scene->lights[k], weight = w, u -= w;
    }
    *probability = sum > 0 ? weight / sum : 0;
    return last;
}

/* A point of the disc round a point across an axis. */
static Vec3 disc_point(Vec3 center, Vec3 axis, double radius, float u1, float u2)
{
    Vec3 s, t;
    double sine, cosine, r = radius * sqrt(u1);
    vec_frame(axis, &s, &t);
    turn_sincos(u2, &sine, &cosine);
    return vec_mad(vec_mad(center, s, r * cosine), t, r * sine);
}

/* The cone of a spot, where it is narrower than that of the caster. Returns its solid angle, 0: it is wider. */
static double aim_spot(const Light *light, const Aim *c, Vec3 from, float u1, float u2, Vec3 *direction)
{
    const double half = light->ops->cone ? light->ops->cone(light) : 0;
    if (!(half > 0 && half < 1.5))
        return 0;
    const Vec3 axis = light_axis(light);
    const Aim spot = {c->primitive, c->instance, vec_add(from, axis), sin(half)};
    return vec_length(vec_sub(c->center, from)) * sin(half) < c->radius ? aim(&spot, from, u1, u2, direction) : 0;
}

static void start_from_source(const Tracing *m, uint32_t photon, Start *start)
{
    const Aim *c = &m->casters[start->caster];
    const float u1 = photon_number(photon, 2), u2 = photon_number(photon, 3), u3 = photon_number(photon, 5),
                u4 = photon_number(photon, 6);
    double probability;
    const Light *light = start->source = pick_source(m, c, photon_number(photon, 1), &probability);
    if (!light || !(probability > 0))
        return;
    start->beam = light_is_beam(light);
    if (start->beam) {
        const Vec3 to = vec_normalize(vec_sub(light->location, light->point_at));
        const double back = fmax(vec_dot(vec_sub(light->location, c->center), to), c->radius);
        const double size = light->size / vec_length(vec_sub(light->location, light->point_at));
        start->ray.direction = vec_normalize(vec_sub(disc_point(vec3(0, 0, 0), to, size, u3, u4), to));
        start->ray.origin = vec_mad(disc_point(c->center, to, c->radius, u1, u2), start->ray.direction, -back);
        start->power = PI * c->radius * c->radius / probability;
        return;
    }
    const Vec3 axis = vec_normalize(vec_sub(c->center, light->location));
    const Vec3 from =
        light->area ? source_point(light, c->center, u1, u2) : disc_point(light->location, axis, light->size, u1, u2);
    double angle = aim_spot(light, c, from, u3, u4, &start->ray.direction);
    if (!(angle > 0))
        angle = aim(c, from, u3, u4, &start->ray.direction);
    start->ray.origin = from;
    start->power = angle / probability;
}

/* Half of the photons are of light sources, where emitters have some too. */
static void start_photon(const Tracing *m, uint32_t photon, Start *start)
{
    *start = (Start){.ray = {.tmin = 0, .tmax = INFINITY}};
    start->caster = pick_caster(m, photon_number(photon, 4));
    const double r = m->casters[start->caster].radius, part = r * r / m->caster_sums[m->ncasters - 1];
    const int both = m->of_emitters && m->nsources > 0;
    if (m->nsources > 0 && (!both || photon & 1))
        start_from_source(m, photon, start);
    else
        start_from_emitter(m, photon, start);
    start->power *= (both ? 2 : 1) / part;
}

/* The light of a source where a photon first meets something. */
static double first_irradiance(const Start *start, Vec3 position)
{
    Vec3 direction, d = vec_sub(position, start->ray.origin);
    double distance;
    if (!start->source)
        return 1;
    const Rgb e = source_irradiance(start->source, position, start->source->location, &direction, &distance);
    return rgb_luminance(e) * (start->beam ? 1 : vec_dot(d, d));
}

/* The share of its power that fog, media and fading interiors let pass up to what it hits. in: what it is in; it starts
 * in the open, as a guess. */
static double passing_power(const Tracing *m, const Media *in, const Ray *ray, double distance, const Start *start)
{
    const int with_air = !start || !start->source || start->source->dimmed_by_air;
    Rgb passing = media_fade(in, distance, NULL), own;
    if (m->scene->has_media)
        passing = rgb_mul(passing, media_expected_transmittance(m->scene, in, ray, distance, with_air));
    if (m->scene->fogs && with_air && in->solids <= 0)
        passing = rgb_mul(passing, fog_transmittance(m->scene, ray, distance, &own));
    return rgb_luminance(passing);
}

/* To the caster that a photon was aimed at, straight through what is clear. Returns 0 where something else is in the
 * way; a photon that meets another caster first is counted there. */
static int reach_caster(const Tracing *m, const Start *start, Ray *ray, Media *in, Hit *hit, double *power)
{
    const Aim *aimed = &m->casters[start->caster];
    const RayKind kind = start->source ? RAY_SHADOW : RAY_BOUNCE; /* light sources shine through their looks_like */
    for (int k = 0; k<STRAIGHT_MAX && * power> 0; k++) {
        Shading s;
        if (!accel_intersect(m->accel, ray, kind, hit))
            return 0;
        *power *= passing_power(m, in, ray, hit->t - ray->tmin, start);
        if (hit->instance == aimed->instance && hit->primitive == aimed->primitive)
            return 1;
        if (!accel_is_transparent(m->accel, hit) || m->scene->primitives[hit->primitive].caustics)
            return 0;
        shading_at(&s, m->scene, NULL, 1, ray, hit);
        if (s.bsdf.refracts)
            return 0;
        *power *= split_neutral(s.bsdf.passing);
        media_cross(in, &s.surface);
        ray->tmin = hit->t;
    }
    return 0;
}

/* Follow a photon while it is refracted or mirrored. Returns 1 where it lands after that. */
static int trace_photon(const Tracing *m, uint32_t photon, Landing *landing)
{
    Start start;
    Media in = {.count = 0};
    int bent = 0;
    start_photon(m, photon, &start);
    Ray ray = start.ray;
    double power = start.power;
    for (uint32_t k = 0; k < BOUNCES_MAX && power > 0; k++) {
        Hit hit;
        Shading s;
        BsdfSample next;
        if (k == 0 ? !reach_caster(m, &start, &ray, &in, &hit, &power)
                   : !accel_intersect(m->accel, &ray, RAY_BOUNCE, &hit))
            return 0;
        shading_at(&s, m->scene, NULL, 1, &ray, &hit);
        if (k > 0)
            power *= passing_power(m, &in, &ray, hit.t - ray.tmin, NULL);
        if (shading_disperses(&s)) /* each photon has one wavelength */
            shading_bsdf_wavelength(&s, vec_neg(ray.direction), photon_number(photon, WAVELENGTH_NUMBER));
        if (k == 0)
            power *= first_irradiance(&start, s.surface.position);
        float straight = s.bsdf.lambert ? 0 : s.bsdf.p_mirror + s.bsdf.p_passing;
        if (bent && straight < 0.99f) {
            landing->position = s.surface.position;
            landing->power = (float)power * (1 - straight);
            return landing->power > 0;
        }
        if (!(straight > 0))
            return 0;
        /* light that is mirrored first is weak but spreads widely: it gets as many photons */
        float mirrored = s.bsdf.p_mirror / straight, u = photon_number(photon, 7 + k);
        float chosen = bent || mirrored <= 0 || mirrored >= 1 ? mirrored : 0.5f;
        int mirrors = u < chosen;
        u = mirrors ? u / chosen * mirrored : mirrored + (u - chosen) / (1 - chosen) * (1 - mirrored);
        if (!bsdf_sample(&s.bsdf, at_most(straight * u, 1 - 0x1p-24f), 0.5f, 0.5f, &next))
            return 0;
        power *= split_neutral(next.weight) * straight;
        power *= mirrors ? mirrored / chosen : (1 - mirrored) / (1 - chosen);
        if (next.transmitted)
            media_cross(&in, &s.surface);
        if (next.straight) {
            ray.tmin = hit.t;
            continue;
        }
        bent = 1;
        landing->from = s.surface.position;
        ray.origin = accel_offset(s.surface.position, s.surface.geometric_normal, next.wi);
        ray.direction = next.wi;
        ray.tmin = 0;
    }
    return 0;
}

static void trace_batch(void *context, int index, int thread)
{
    Tracing *m = context;
    Landing *landings = m->landings + (size_t)index * BATCH;
    uint32_t first = (uint32_t)index * BATCH;
    int count = 0;
    (void)thread;
    for (uint32_t k = 0; k < BATCH && !retex_budget_is_stopped(m->budget); k++)
        count += trace_photon(m, first + k, &landings[count]);
    m->counts[index] = count;
}

/* Trace batches; landings are collected in the order of batches. Returns their number. */
static int trace_batches(Tracing *m, int batches, int nthreads)
{
    int count = 0;
    retex_parallel(nthreads, batches, trace_batch, m);
    for (int k = 0; k < batches; k++) {
        memmove(m->landings + count, m->landings + (size_t)k * BATCH, (size_t)m->counts[k] * sizeof *m->landings);
        count += m->counts[k];
    }
    return count;
}

/* Trace photons, in rounds of batches, until there are enough landings or photons. */
static int trace_photons(Tracing *m, long paths, int nthreads, Photons *photons, RetexError *err)
{
    const long least = m->nsources > 0 ? PHOTONS_OF_SOURCES : PHOTONS_MIN;
    long wanted = paths / PATHS_PER_PHOTON;
    wanted = wanted < least ? least : wanted > PHOTONS_MAX ? PHOTONS_MAX : wanted;
    int batches = (int)(wanted / BATCH);
    m->landings = malloc((size_t)batches * BATCH * sizeof *m->landings);
    m->counts = malloc((size_t)batches * sizeof *m->counts);
    if (!m->landings || !m->counts)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for photons");
    photons->count = trace_batches(m, batches, nthreads);
    photons->tried = batches * BATCH;
    return retex_budget_check(m->budget, err);
}

static int is_by_small_emitter(void *context, const Caster *caster)
{
    return caster->is_bounded && lights_small_emitter(context, vec_scale(vec_add(caster->low, caster->high), 0.5));
}

int photons_small_emitters(const Scene *scene, const Lights *lights)
{
    return casters_visit(scene, CASTERS_OF_EMITTERS, is_by_small_emitter, (void *)lights);
}

int photons_trace(Photons *photons, const PhotonSources *sources, int nthreads, RetexError *err)
{
    Tracing m = {.scene = sources->scene,
                 .accel = sources->accel,
                 .lights = sources->lights,
                 .budget = sources->budget,
                 .of_emitters = sources->of_emitters && lights_emit(sources->lights),
                 .nsources = scene_caustic_sources(sources->scene)};
    *photons = (Photons){NULL, 0, 0};
    int code = find_casters(&m, err);
    if (!code && m.ncasters > 0 && (m.of_emitters || m.nsources > 0))
        code = trace_photons(&m, sources->paths, nthreads, photons, err);
    photons->landings = m.landings;
    free(m.casters);
    free(m.caster_sums);
    free(m.counts);
    return code;
}
