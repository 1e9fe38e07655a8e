/* The path tracer: next-event estimation of one light at every vertex, multiple importance sampling with the BSDF, Russian
 * roulette on a throughput that knows no texture.
 *
 * A path carries its throughput twice: `beta` is the whole of it, `outside` leaves out the target hits that `expansion`
 * holds as factors. Light that arrives goes to the film both ways. */
#include "integrate/path.h"

#define ROULETTE_START 4      /* segments before Russian roulette begins */
#define STRAIGHT_MAX 128      /* surfaces a path or shadow ray may pass without bending */
#define SHADOW_FACTORS_MAX 16

/* One factor of a connection: a surface it scatters at or passes. */
typedef struct Factor {
    int target;               /* -1: none */
    Split split;
    Rgb albedo;
    Vec2 uv;
} Factor;

typedef struct Path {
    Rgb beta, outside;
    Expansion expansion;
    int folded;               /* a target hit beyond the last order kept its albedo */
    float neutral;            /* throughput with NEUTRAL_ALBEDO everywhere: for Russian roulette */
    float pdf;                /* density of the direction, 0 after a delta */
    Vec3 from;                /* where that direction was sampled */
    int segments;
} Path;

static Factor shading_factor(const Shading *s, Split split)
{
    return (Factor){s->surface.target, split, s->albedo, s->uv};
}

/* A factor is worth recording if its texture matters. */
static int is_recorded(const PathContext *c, const Factor *f)
{
    return c->split && f->target >= 0 && !rgb_is_black(f->split.d);
}

/* Multiply by a factor: as a target hit while there is an order left, else as it is. */
static void apply_factor(const PathContext *c, Rgb *beta, Rgb *outside, Expansion *e, int *folded, const Factor *f)
{
    Rgb whole = split_apply(f->split, f->albedo);
    *beta = rgb_mul(*beta, whole);
    if (is_recorded(c, f) && expansion_has_room(e, f->target, c->orders)) {
        expansion_push(e, f->target, f->split, f->uv, f->albedo);
        return;
    }
    *outside = rgb_mul(*outside, whole);
    if (is_recorded(c, f)) *folded = 1;
}

/* Light reaches the path's end through some more factors. */
static void connect(PathWorker *w, const Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    Rgb beta = rgb_mul(path->beta, light), outside = rgb_mul(path->outside, light);
    const Expansion *e = &path->expansion;
    int folded = path->folded;
    if (nfactors > 0) {
        if (c->split) expansion_copy(&w->scratch, e);
        e = &w->scratch;
        for (int k = 0; k < nfactors; k++) apply_factor(c, &beta, &outside, &w->scratch, &folded, &factors[k]);
    }
    if (rgb_is_black(beta) && rgb_is_black(outside)) return;
    if (c->trace) fprintf(c->trace, "  light %.6g %.6g %.6g over %d target hits\n", beta.r, beta.g, beta.b, e->nhits);
    film_connect(w->pixel, beta, outside, e, folded);
}

static float mis_weight(float a, float b) { return a * a / (a * a + b * b); }

/* What a surface between a point and a light does to the light: pass it straight, or block it. Light sources, which no
 * path can hit, shine through glass unbent; all others leave bent light to the paths that find it. */
static int shadow_factor(const Shading *s, int light_source, Factor *factor)
{
    if (s->bsdf.refracts && !light_source) return 0;
    Split passing = s->bsdf.passing;
    if (s->bsdf.disney && s->bsdf.transmission > 0) {
        passing.d = rgb_grey(s->bsdf.transmission * (1 - fresnel_dielectric((float)s->bsdf.cos_o, s->bsdf.eta)));
        passing.i = rgb_grey(0);
    }
    if (rgb_is_black(passing.d) && rgb_is_black(passing.i)) return 0;
    *factor = shading_factor(s, passing);
    return 1;
}

/* Returns how many factors the way to the light adds, or -1 where it is blocked. */
static int trace_shadow(PathWorker *w, Ray ray, int light_source, Factor *factors, int room)
{
    const PathContext *c = w->context;
    w->shadow_rays++;
    if (!accel_has_transparent(c->accel)) return accel_occluded(c->accel, &ray, RAY_SHADOW, 0) ? -1 : 0;
    if (accel_occluded(c->accel, &ray, RAY_SHADOW, 1)) return -1;
    Hit hit;
    Shading s;
    int n = 0;
    for (int k = 0; k < STRAIGHT_MAX; k++) {
        if (!accel_intersect(c->accel, &ray, RAY_SHADOW, &hit)) return n;
        shading_at(&s, c->scene, &ray, &hit);
        if (n == room || !shadow_factor(&s, light_source, &factors[n])) return -1;
        n++;
        Vec3 start = accel_offset(s.surface.position, s.surface.geometric_normal, ray.direction);
        double moved = vec_length(vec_sub(start, ray.origin));
        ray.tmax -= moved;
        ray.origin = start;
        if (ray.tmax <= 0) return n;
    }
    return -1;
}

/* Radiance a sampled light sends, and the factor of its pigment where it is a shape. Returns the number of factors. */
static int light_factors(const PathContext *c, LightSample *light, Factor *factors)
{
    if (light->kind != LIGHT_SAMPLE_EMITTER) return 0;
    Shading s = {.surface = light->surface};
    shading_color(&s, c->scene);
    light->radiance = rgb_grey(1);
    factors[0] = shading_factor(&s, (Split){light->surface.texture->finish->emission, {0, 0, 0}});
    return 1;
}

static void sample_light(PathWorker *w, const Path *path, const Shading *s, const Sampler *sampler, uint32_t dimension)
{
    const PathContext *c = w->context;
    float u_pick, u_part, u1, u2, pdf;
    LightSample light;
    sampler_pair(sampler, dimension + VERTEX_LIGHT_CHOICE, &u_pick, &u_part);
    sampler_pair(sampler, dimension + VERTEX_LIGHT_POINT, &u1, &u2);
    if (!lights_sample(c->lights, s->surface.position, u_pick, u_part, u1, u2, &light)) return;
    int source = light.kind == LIGHT_SAMPLE_SOURCE;
    Split f = bsdf_eval(&s->bsdf, light.direction, source, &pdf);
    if (rgb_is_black(f.d) && rgb_is_black(f.i)) return;

    Factor factors[SHADOW_FACTORS_MAX + 2];
    factors[0] = shading_factor(s, f);
    int n = 1 + light_factors(c, &light, factors + 1);
    Ray ray = {accel_offset(s->surface.position, s->surface.geometric_normal, light.direction), light.direction, 0, INFINITY};
    if (isfinite(light.distance)) { /* stop just before the light, seen from where the ray starts */
        Vec3 end = vec_mad(s->surface.position, light.direction, light.distance);
        if (light.kind == LIGHT_SAMPLE_EMITTER) end = accel_offset(light.surface.position, light.surface.geometric_normal, vec_neg(light.direction));
        Vec3 way = vec_sub(end, ray.origin);
        ray.tmax = vec_length(way) * (1 - 1e-6);
    }
    if (!light.shadowless) {
        int passed = trace_shadow(w, ray, source, factors + n, SHADOW_FACTORS_MAX);
        if (passed < 0) return;
        n += passed;
    }
    float light_pdf = light.pdf * light.pick_probability;
    float weight = source ? 1 / light.pick_probability : mis_weight(light_pdf, pdf) / light_pdf;
    connect(w, path, rgb_scale(light.radiance, weight), factors, n);
}

/* The path itself ran into something that shines. */
static void hit_emitter(PathWorker *w, const Path *path, const Hit *hit, const Shading *s)
{
    Rgb emission = s->surface.texture->finish->emission;
    if (rgb_is_black(emission)) return;
    float weight = 1;
    if (path->pdf > 0) weight = mis_weight(path->pdf, lights_emitter_pdf(w->context->lights, path->from, hit->primitive, &s->surface));
    Factor factor = shading_factor(s, (Split){emission, {0, 0, 0}});
    connect(w, path, rgb_grey(weight), &factor, 1);
}

static void hit_sky(PathWorker *w, const Path *path, Vec3 direction)
{
    Rgb radiance = sky_radiance(w->context->scene, direction);
    if (rgb_is_black(radiance)) return;
    float weight = 1;
    if (path->pdf > 0) weight = mis_weight(path->pdf, lights_sky_pdf(w->context->lights, path->from, direction));
    connect(w, path, rgb_scale(radiance, weight), NULL, 0);
}

static float fade_channel(float color, double x, double power)
{
    if (power > 1000) return (float)exp(-(1 - color) * x);
    return color + (1 - color) * (float)(1 / (1 + pow(x, power)));
}

/* POV-Ray's fading inside an object, on the way out of it. */
static Rgb interior_fade(const Surface *surface, double distance)
{
    const Interior *in = surface->primitive->interior;
    if (!in || !surface->backside || in->fade_power <= 0 || in->fade_distance <= 0) return rgb_grey(1);
    double x = distance / in->fade_distance, power = in->fade_power;
    return rgb(fade_channel(in->fade_color.r, x, power), fade_channel(in->fade_color.g, x, power), fade_channel(in->fade_color.b, x, power));
}

/* Choose where the path goes on. Returns 0 where it ends. */
static int scatter(PathWorker *w, Path *path, const Shading *s, const Sampler *sampler, uint32_t dimension, Ray *ray, int *straight)
{
    float u_lobe, u_roulette, u1, u2;
    BsdfSample next;
    sampler_pair(sampler, dimension + VERTEX_LOBE, &u_lobe, &u_roulette);
    sampler_pair(sampler, dimension + VERTEX_DIRECTION, &u1, &u2);
    if (!bsdf_sample(&s->bsdf, u_lobe, u1, u2, &next)) return 0;
    Factor factor = shading_factor(s, next.weight);
    apply_factor(w->context, &path->beta, &path->outside, &path->expansion, &path->folded, &factor);
    if (!w->context->split ? rgb_is_black(path->beta) : rgb_is_black(path->outside)) return 0;
    path->neutral *= fminf(1, split_neutral(next.weight));
    if (w->context->trace)
        fprintf(w->context->trace, "  goes on along %.5f %.5f %.5f pdf %.6g d %.5g i %.5g\n", next.wi.x, next.wi.y, next.wi.z,
                next.pdf, rgb_luminance(next.weight.d), rgb_luminance(next.weight.i));
    *straight = next.straight;
    if (!next.straight) {
        path->pdf = next.pdf;
        path->from = s->surface.position;
        if (path->segments >= ROULETTE_START) {
            float survive = fminf(0.95f, path->neutral);
            if (u_roulette >= survive) return 0;
            path->beta = rgb_scale(path->beta, 1 / survive);
            path->outside = rgb_scale(path->outside, 1 / survive);
            path->neutral /= survive;
        }
    }
    ray->origin = accel_offset(s->surface.position, s->surface.geometric_normal, next.wi);
    ray->direction = next.wi;
    ray->tmin = 0, ray->tmax = INFINITY;
    return 1;
}

static void trace_hit(const PathContext *c, const Hit *hit, const Shading *s)
{
    const Vec3 p = s->surface.position, n = s->surface.shading_normal;
    fprintf(c->trace, "hit primitive %d (line %d) face %d at %.6g %.6g %.6g distance %.6g normal %.4f %.4f %.4f%s\n", hit->primitive,
            s->surface.primitive->line, hit->face, p.x, p.y, p.z, hit->t, n.x, n.y, n.z, s->surface.backside ? " from inside" : "");
    fprintf(c->trace, "  albedo %.5f %.5f %.5f", s->albedo.r, s->albedo.g, s->albedo.b);
    if (s->surface.target >= 0)
        fprintf(c->trace, " target %s uv %.6f %.6f", c->scene->targets[s->surface.target].name, s->uv.u, s->uv.v);
    fputc('\n', c->trace);
}

void path_trace(PathWorker *w, Ray ray, const Sampler *sampler)
{
    const PathContext *c = w->context;
    Path path; /* set field by field: its expansion is large, and mostly unused */
    path.beta = path.outside = rgb_grey(1);
    path.neutral = 1, path.pdf = 0, path.from = ray.origin, path.segments = 1, path.folded = 0;
    expansion_reset(&path.expansion);
    RayKind kind = RAY_CAMERA;
    Hit hit;
    Shading s;
    int straight = 0, passed = 0;
    for (;;) {
        w->segments++;
        if (!accel_intersect(c->accel, &ray, kind, &hit)) {
            hit_sky(w, &path, ray.direction);
            break;
        }
        shading_at(&s, c->scene, &ray, &hit);
        if (c->trace) trace_hit(c, &hit, &s);
        Rgb fade = interior_fade(&s.surface, hit.t);
        path.beta = rgb_mul(path.beta, fade), path.outside = rgb_mul(path.outside, fade);
        hit_emitter(w, &path, &hit, &s);
        if (path.segments >= c->max_depth) break;
        uint32_t dimension = DIMENSION_PATH + (uint32_t)(path.segments + passed - 1) * DIMENSIONS_PER_VERTEX;
        sample_light(w, &path, &s, sampler, dimension);
        if (!scatter(w, &path, &s, sampler, dimension, &ray, &straight)) break;
        if (straight && ++passed > STRAIGHT_MAX) break;
        if (!straight) path.segments++, kind = RAY_BOUNCE;
    }
    film_path_end(w->pixel);
}
