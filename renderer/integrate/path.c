/* The path tracer: next-event estimation of one light at every vertex, multiple importance sampling with the BSDF,
 * Russian roulette on a throughput that knows no texture.
 *
 * A path carries its throughput more than once: `beta` is the whole of it, by variant of the textures, for no choice
 * along a path looks at a texture; `outside`, for sets, leaves out the target hits that `expansion` holds as factors.
 * Light that arrives goes to the film both ways. */
#include <string.h>
#include "integrate/denoise_guides.h"
#include "integrate/path.h"

#define ROULETTE_START 2 /* segments before Russian roulette begins */
#define SHARP_PDF 25     /* per steradian: a bounce into a lobe no wider than about 7 degrees keeps things sharp */
#define STRAIGHT_MAX 128 /* surfaces a path or shadow ray may pass without bending */
#define MEDIA_MAX 4      /* fading interiors that a path may be in at once */

/* One factor of a connection: a surface it scatters at or passes. */
typedef struct Factor {
    int target; /* -1: none */
    Split split;
    Rgb albedo;
    const Rgb *albedos; /* by variant, or NULL: the same in all */
    Vec2 uv;
    int reflects; /* light stays on its side of the surface */
    int sharp;    /* nothing on the way from the camera scattered widely */
} Factor;

/* The fading interiors a ray is in. */
typedef struct Media {
    const Interior *interiors[MEDIA_MAX];
    int count;
} Media;

typedef struct Path {
    Rgb beta[VARIANTS_MAX], outside;
    Media media;
    RayKind kind;
    Expansion expansion;
    int folded;    /* a target hit beyond the last order kept its albedo */
    int sharp;     /* so far every bounce was specular, or nearly so */
    float neutral; /* throughput with NEUTRAL_ALBEDO everywhere: for Russian roulette */
    float pdf;     /* density of the direction, 0 after a delta */
    LitPoint from; /* where that direction was sampled */
    int segments;
} Path;

/* Light picked for a vertex, before it is known whether anything is in the way. */
typedef struct LightTry {
    int found; /* 0: none that could give any */
    enum { WAY_UNKNOWN, WAY_FREE, WAY_BLOCKED } way;
    LightSample light;
    Ray ray;        /* to the light */
    int other_side; /* of the surface */
    float pdf;      /* with which the BSDF would find the direction */
    Factor factors[2];
    int nfactors;
} LightTry;

/* Where a ray met the scene, and what is chosen there. */
typedef struct Vertex {
    int met;
    Hit hit;
    Shading s;
    VertexSamples u;
    LightTry light;
    const CausticsCell *cell; /* where caustics come from, or NULL: none, or nothing scatters widely */
} Vertex;

static Factor shading_factor(const Shading *s, Split split)
{
    return (Factor){s->surface.target, split, shading_albedo(s, 0), s->replaced ? s->albedos : NULL, s->uv, 0, 0};
}

/* Does the target's texture matter to this factor? */
static int is_textured(const PathContext *c, const Factor *f)
{
    return c->split && f->target >= 0 && !rgb_is_black(f->split.d);
}

/* A reflection counts as a hit of its target even where the texture does not matter, so that what is seen in a polished
 * floor stays apart from what is seen on it. What merely passes a target does not count. */
static int is_hit(const PathContext *c, const Factor *f)
{
    return c->split && f->target >= 0 && (f->reflects || !rgb_is_black(f->split.d));
}

/* Multiply by a factor: as a target hit while there is an order left, else as it is. */
static void apply_factor(const PathContext *c, Rgb *beta, Rgb *outside, Expansion *e, int *folded, const Factor *f)
{
    Rgb whole = split_apply(f->split, f->albedo);
    beta[0] = rgb_mul(beta[0], whole);
    for (int v = 1; v < c->nvariants; v++)
        beta[v] = rgb_mul(beta[v], f->albedos ? split_apply(f->split, f->albedos[v]) : whole);
    if (is_hit(c, f) && expansion_has_room(e, f->target, c->orders, c->most_hits)) {
        expansion_push(e, f->target, f->split, f->uv, f->albedo, f->sharp);
        return;
    }
    *outside = rgb_mul(*outside, whole);
    if (is_textured(c, f))
        *folded = 1;
}

/* Nothing is left of it in any variant. */
static int is_spent(const PathContext *c, const Rgb *beta)
{
    for (int v = 0; v < c->nvariants; v++)
        if (!rgb_is_black(beta[v]))
            return 0;
    return 1;
}

static void scale_path(const PathContext *c, Path *path, Rgb by)
{
    for (int v = 0; v < c->nvariants; v++)
        path->beta[v] = rgb_mul(path->beta[v], by);
    path->outside = rgb_mul(path->outside, by);
}

/* Light reaches the path's end through some more factors. */
static void connect(PathWorker *w, const Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    if (c->simple) {
        Rgb sum = rgb_mul(path->beta[0], light);
        for (int k = 0; k < nfactors; k++)
            sum = rgb_mul(sum, split_apply(factors[k].split, factors[k].albedo));
        if (!rgb_is_black(sum))
            film_connect(w->pixel, sum, sum, NULL, 0);
        return;
    }
    Rgb beta[VARIANTS_MAX], outside = rgb_mul(path->outside, light);
    for (int v = 0; v < c->nvariants; v++)
        beta[v] = rgb_mul(path->beta[v], light);
    const Expansion *e = &path->expansion;
    int folded = path->folded;
    for (int k = 0; k < nfactors; k++) {
        if (e != &w->scratch && is_hit(c, &factors[k])) {
            expansion_copy(&w->scratch, e);
            e = &w->scratch;
        }
        apply_factor(c, beta, &outside, &w->scratch, &folded, &factors[k]);
    }
    if (is_spent(c, beta) && rgb_is_black(outside))
        return;
    if (c->trace)
        fprintf(c->trace, "  light %.6g %.6g %.6g over %d target hits\n", beta[0].r, beta[0].g, beta[0].b, e->nhits);
    film_connect(w->pixel, beta[0], outside, e, folded);
    if (w->control)
        control_connect(w->control, beta);
}

static float mis_weight(float a, float b)
{
    float ratio = b / a; /* the squares of densities may be too large for a float */
    return 1 / (1 + ratio * ratio);
}

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

/* POV-Ray's fading of light that went a distance and met a surface, or NULL. Leaving what was never entered: the
 * camera or a light stands in it. */
static Rgb media_fade(const Media *media, double distance, const Surface *met)
{
    Rgb fade = rgb_grey(1);
    for (int k = 0; k < media->count; k++)
        fade = rgb_mul(fade, fade_over(media->interiors[k], distance));
    const Interior *in = met && met->backside ? fading_interior(met) : NULL;
    return in && media_find(media, in) < 0 ? rgb_mul(fade, fade_over(in, distance)) : fade;
}

/* A ray goes through a surface. */
static void media_cross(Media *media, const Surface *surface)
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

/* What a surface between a point and a light does to the light: pass it straight, or block it. Light sources, which no
 * path can hit, shine through glass unbent; all others leave bent light to the paths that find it. */
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
    *factor = shading_factor(s, passing);
    return 1;
}

/* Colours of variants for a factor that outlives its shading. */
static const Rgb *keep_albedos(const PathContext *c, Rgb *room, const Shading *s)
{
    if (!s->replaced)
        return NULL;
    for (int v = 0; v < c->nvariants; v++)
        room[v] = s->albedos[v];
    return room;
}

/* What a surface is to a ray that goes through it unbent. Reflectance is taken from outside on either side: light that
 * came in through the one face of a pane goes out through the other, and is never totally reflected. */
static void shading_straight(Shading *s, const PathWorker *w, const Ray *ray, Surface *surface)
{
    s->surface = *surface;
    shading_color(s, w->variants, w->context->nvariants);
    if (surface->backside) {
        s->surface.backside = 0;
        s->surface.geometric_normal = vec_neg(surface->geometric_normal);
        s->surface.shading_normal = vec_neg(surface->shading_normal);
    }
    bsdf_setup(&s->bsdf, &s->surface, vec_neg(ray->direction), s->filter, s->transmit);
}

/* Follow a shadow ray: what the way does to the light goes into *light and, where targets do it, into factors.
 * Returns how many of these there are, or -1 where the way is blocked. */
static int trace_shadow(PathWorker *w, Ray ray, int light_source, Media *media, Rgb *light, Factor *factors, int room)
{
    const PathContext *c = w->context;
    w->shadow_rays++;
    int through = accel_has_transparent(c->accel, light_source), n = 0;
    if (!through && accel_occluded(c->accel, &ray, RAY_SHADOW, 0))
        return -1;
    Hit hit;
    Shading s;
    for (int k = 0; k < STRAIGHT_MAX; k++) {
        if (!through || !accel_intersect(c->accel, &ray, RAY_SHADOW, &hit)) {
            if (media->count > 0 && isfinite(ray.tmax))
                *light = rgb_mul(*light, media_fade(media, ray.tmax - ray.tmin, NULL));
            return n;
        }
        Surface surface;
        Factor factor;
        if (!accel_is_transparent(c->accel, hit.primitive))
            return -1;
        if (k == 0) { /* before walking through what is clear: is there anything that is not? */
            Ray rest = ray;
            rest.tmin = hit.t;
            if (accel_occluded(c->accel, &rest, RAY_SHADOW, 1))
                return -1;
        }
        surface_at(&surface, c->scene, &ray, &hit);
        shading_straight(&s, w, &ray, &surface);
        if (!shadow_factor(&s, light_source, &factor))
            return -1;
        if (factor.target < 0 || rgb_is_black(factor.split.d)) {
            *light = rgb_mul(*light, split_apply(factor.split, factor.albedo));
        } else {
            if (n == room)
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

/* Radiance over albedo: what is not there does not shine. */
static Split emitted(const Shading *s)
{
    float opacity = at_most(not_negative(1 - s->filter - s->transmit), 1);
    return (Split){rgb_scale(s->surface.texture->finish->emission, opacity), {0, 0, 0}};
}

/* Is a point of an emitter that throws no shadow behind the emitter's own front? */
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

/* Density with which the path itself finds what a shadow ray found, given that of its direction: 0 where it cannot, for
 * the ways of the two are not blocked by the same things. -1: nobody should. */
static float path_density(const PathContext *c, const Ray *ray, RayKind kind, const LightSample *light, float pdf)
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

/* Radiance a sampled light sends, and the factor of its pigment where it is a shape. Returns the number of factors. */
static int light_factors(PathWorker *w, LightSample *light, Factor *factors)
{
    const PathContext *c = w->context;
    if (light->kind != LIGHT_SAMPLE_EMITTER)
        return 0;
    Shading s;
    s.surface = light->surface;
    shading_color(&s, w->variants, c->nvariants);
    light->radiance = rgb_grey(1);
    factors[0] = shading_factor(&s, emitted(&s));
    factors[0].albedos = keep_albedos(c, w->light_albedos, &s);
    return 1;
}

static LitPoint lit_point(const Shading *s)
{
    const Vec3 none = {0, 0, 0};
    return (LitPoint){s->surface.position, bsdf_only_reflects(&s->bsdf) ? s->bsdf.normal : none};
}

/* ---- directions by the guide to caustics ---- */

/* Probability of the lobes that are no deltas: the guide takes a share of their choice. */
static float wide_probability(const Bsdf *b)
{
    return b->p_diffuse + b->p_back + b->p_glossy;
}

static const CausticsCell *guide_cell(const PathContext *c, const Shading *s)
{
    return c->caustics && wide_probability(&s->bsdf) > 0 ? caustics_find(c->caustics, s->surface.position) : NULL;
}

/* Density of a direction by either way, given the BSDF's own. The guide only knows what comes to wo's side. */
static float guided_density(const Vertex *v, Vec3 wi, float pdf)
{
    const Bsdf *b = &v->s.bsdf;
    if (!v->cell)
        return pdf;
    pdf *= 1 - v->cell->share;
    if (vec_dot(wi, b->normal) <= 0 || vec_dot(wi, b->geometric) <= 0)
        return pdf;
    return pdf + v->cell->share * wide_probability(b) * caustics_density(v->cell, v->s.surface.position, wi);
}

/* A direction by the guide, as one of the BSDF's. */
static int sample_guide(const Vertex *v, float u_lobe, BsdfSample *sample)
{
    const Bsdf *b = &v->s.bsdf;
    *sample = (BsdfSample){0};
    sample->wi = caustics_sample(v->cell, v->s.surface.position, u_lobe, v->u.direction_u, v->u.direction_v);
    if (vec_dot(sample->wi, b->normal) <= 0 || vec_dot(sample->wi, b->geometric) <= 0)
        return 0;
    Split f = bsdf_eval(b, sample->wi, 0, &sample->pdf);
    if (sample->pdf <= 0)
        return 0;
    sample->weight = (Split){rgb_scale(f.d, 1 / sample->pdf), rgb_scale(f.i, 1 / sample->pdf)};
    return 1;
}

/* Choose a direction by the BSDF or the guide: first between deltas and the rest. The sample's weight and density are
 * the BSDF's own; *pdf gets that of both ways. */
static int sample_direction(const Vertex *v, BsdfSample *sample, float *pdf)
{
    const Bsdf *b = &v->s.bsdf;
    const VertexSamples *u = &v->u;
    float u_lobe = u->lobe;
    int found;
    if (!v->cell) {
        found = bsdf_sample(b, u_lobe, u->direction_u, u->direction_v, sample);
        *pdf = sample->pdf;
        return found;
    }
    float share = v->cell->share, wide = wide_probability(b), delta = 1 - wide, rest = (u_lobe - delta) / wide;
    if (rest >= 0 && rest < share) {
        found = sample_guide(v, rest / share, sample);
    } else {
        if (rest >= 0) /* what is left of u, stretched */
            u_lobe = at_most(delta + (rest - share) / (1 - share) * wide, 1 - 0x1p-24f);
        found = bsdf_sample(b, u_lobe, u->direction_u, u->direction_v, sample);
    }
    if (!found)
        return 0;
    *pdf = sample->pdf > 0 ? guided_density(v, sample->wi, sample->pdf) : 0;
    return 1;
}

static void pick_light(PathWorker *w, Vertex *v)
{
    const PathContext *c = w->context;
    const Shading *s = &v->s;
    const VertexSamples *u = &v->u;
    LightTry *t = &v->light;
    LightSample *light = &t->light;
    LitPoint point = lit_point(s);
    t->found = 0;
    if (!lights_sample(c->lights, &point, u->light_choice, u->light_part, u->light_point_u, u->light_point_v, light))
        return;
    Split f = bsdf_eval(&s->bsdf, light->direction, light->kind == LIGHT_SAMPLE_SOURCE, &t->pdf);
    if (rgb_is_black(f.d) && rgb_is_black(f.i))
        return;
    if (light->kind != LIGHT_SAMPLE_SOURCE)
        t->pdf = guided_density(v, light->direction, t->pdf);
    t->found = 1;
    t->way = light->shadowless ? WAY_FREE : WAY_UNKNOWN;
    t->factors[0] = shading_factor(s, f);
    t->nfactors = 1 + light_factors(w, light, t->factors + 1);
    t->other_side = vec_dot(light->direction, s->bsdf.geometric) < 0;
    t->ray = (Ray){accel_offset(s->surface.position, s->surface.geometric_normal, light->direction), light->direction,
                   0, INFINITY};
    if (isfinite(light->distance)) { /* stop just before the light, seen from where the ray starts */
        double margin = accel_margin(s->surface.position);
        t->ray.tmax = light->distance * (1 - 1e-6) - margin;
        if (light->kind == LIGHT_SAMPLE_EMITTER) {
            /* Its surface is met by the ray, begun beside, the earlier the flatter. */
            double slope = fabs(vec_dot(light->direction, light->surface.geometric_normal));
            t->ray.tmax -= (margin + accel_margin(light->surface.position)) / (slope > 1e-3 ? slope : 1e-3);
        }
        t->ray.tmax = t->ray.tmax > 0 ? t->ray.tmax : 0; /* Embree takes what is below 0 for met already */
    }
}

/* Light that was picked for the path's end reaches it, if nothing is in the way. */
static void connect_light(PathWorker *w, const Path *path, Vertex *v)
{
    LightTry *t = &v->light;
    int source = t->light.kind == LIGHT_SAMPLE_SOURCE, n = t->nfactors;
    Factor factors[SHADOW_FACTORS_MAX + 2];
    if (!t->found || t->way == WAY_BLOCKED)
        return;
    memcpy(factors, t->factors, (size_t)n * sizeof *factors);
    factors[0].sharp = path->sharp;
    if (t->way == WAY_UNKNOWN) {
        Media media = path->media;
        if (t->other_side)
            media_cross(&media, &v->s.surface);
        int passed = trace_shadow(w, t->ray, source, &media, &t->light.radiance, factors + n, SHADOW_FACTORS_MAX);
        if (passed < 0)
            return;
        n += passed;
    }
    RayKind kind = path_next_kind(path->kind, &v->s.bsdf, t->other_side);
    float pdf = source ? 0 : path_density(w->context, &t->ray, kind, &t->light, t->pdf);
    if (pdf < 0)
        return;
    float light_pdf = t->light.pdf * t->light.pick_probability;
    float weight = source ? 1 / t->light.pick_probability : mis_weight(light_pdf, pdf) / light_pdf;
    connect(w, path, rgb_scale(t->light.radiance, weight), factors, n);
}

/* The path itself ran into something that shines. */
static void hit_emitter(PathWorker *w, const Path *path, const Hit *hit, const Shading *s)
{
    if (rgb_is_black(s->surface.texture->finish->emission))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight =
            mis_weight(path->pdf, lights_emitter_pdf(w->context->lights, &path->from, hit->primitive, &s->surface));
    Factor factor = shading_factor(s, emitted(s));
    factor.sharp = path->sharp;
    connect(w, path, rgb_grey(weight), &factor, 1);
}

static void hit_sky(PathWorker *w, const Path *path, Vec3 direction)
{
    Rgb radiance = sky_radiance(w->context->scene, direction);
    if (rgb_is_black(radiance))
        return;
    float weight = 1;
    if (path->pdf > 0)
        weight = mis_weight(path->pdf, lights_sky_pdf(w->context->lights, &path->from, direction));
    connect(w, path, rgb_scale(radiance, weight), NULL, 0);
}

/* Radiance in glass is that outside times the square of the index, and back again on the way out: no reason to end a
 * path. */
static float squeeze_undone(const Bsdf *bsdf, const BsdfSample *next)
{
    return next->transmitted && bsdf->refracts ? bsdf->eta * bsdf->eta : 1;
}

/* Choose where the path goes on. Returns 0 where it ends. */
static int scatter(PathWorker *w, Path *path, const Vertex *v, Ray *ray, int *straight)
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
    Factor factor = shading_factor(s, next.weight);
    factor.reflects = !next.transmitted;
    factor.sharp = path->sharp;
    apply_factor(w->context, path->beta, &path->outside, &path->expansion, &path->folded, &factor);
    if (!w->context->split ? is_spent(w->context, path->beta) : rgb_is_black(path->outside))
        return 0;
    if (w->context->trace)
        fprintf(w->context->trace, "  goes on along %.5f %.5f %.5f pdf %.6g d %.5g i %.5g\n", next.wi.x, next.wi.y,
                next.wi.z, pdf, rgb_luminance(next.weight.d), rgb_luminance(next.weight.i));
    *straight = next.straight;
    if (next.transmitted)
        media_cross(&path->media, &s->surface);
    if (!next.straight) {
        path->kind = path_next_kind(path->kind, &s->bsdf, next.transmitted);
        path->pdf = pdf;
        path->sharp &= next.pdf == 0 || next.pdf > SHARP_PDF;
        path->from = lit_point(s);
        if (path->segments >= ROULETTE_START) {
            float survive = at_most(path->neutral, 1);
            if (v->u.roulette >= survive)
                return 0;
            scale_path(w->context, path, rgb_grey(1 / survive));
            path->neutral /= survive;
        }
    }
    if (next.straight) {
        ray->tmin = v->hit.t;
        return 1;
    }
    ray->origin = accel_offset(s->surface.position, s->surface.geometric_normal, next.wi);
    ray->direction = next.wi;
    ray->tmin = 0;
    return 1;
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

/* What a ray looks like where it met the scene, and the light picked there, of so many segments before. */
static void fill_vertex(PathWorker *w, const Ray *ray, const Sampler *sampler, int number, int last, Vertex *v)
{
    const PathContext *c = w->context;
    shading_at(&v->s, c->scene, w->variants, c->nvariants, ray, &v->hit);
    if (c->white && number == 0)
        whiten(&v->s, ray);
    if (c->trace)
        trace_hit(c, &v->hit, &v->s);
    vertex_samples(&w->keys, sampler, (unsigned)number, &v->u);
    v->light.found = 0;
    v->cell = guide_cell(c, &v->s);
    if (!last)
        pick_light(w, v);
}

static void start_path(const PathContext *c, Path *path, const Ray *ray)
{
    for (int v = 0; v < c->nvariants; v++)
        path->beta[v] = rgb_grey(1);
    path->outside = rgb_grey(1);
    path->neutral = 1, path->pdf = 0, path->from = (LitPoint){ray->origin, {0, 0, 0}};
    path->segments = 1, path->folded = 0, path->sharp = 1;
    path->media.count = 0, path->kind = RAY_CAMERA;
    expansion_reset(&path->expansion);
}

/* One path, whose first vertex is known. */
static void follow(PathWorker *w, Ray ray, const Sampler *sampler, Vertex *first)
{
    const PathContext *c = w->context;
    Path path; /* not cleared: its expansion is large, and mostly unused */
    Vertex next, *v = first;
    int straight = 0, passed = 0;
    start_path(c, &path, &ray);
    if (w->guides)
        denoise_guides_look(w->guides, &ray, &first->hit, &first->s);
    for (;;) {
        int last = path.segments >= c->max_depth; /* but what is passed straight is no segment of its own */
        w->segments++;
        if (v != first && (v->met = accel_intersect(c->accel, &ray, path.kind, &v->hit)))
            fill_vertex(w, &ray, sampler, path.segments + passed - 1, last, v);
        if (!v->met) {
            if (!c->white || path.segments > 1)
                hit_sky(w, &path, ray.direction);
            break;
        }
        if (path.media.count || v->s.surface.backside)
            scale_path(c, &path, media_fade(&path.media, v->hit.t - ray.tmin, &v->s.surface));
        hit_emitter(w, &path, &v->hit, &v->s);
        if (last && (v->s.bsdf.p_passing <= 0 || v->s.bsdf.refracts))
            break;
        connect_light(w, &path, v);
        if (!scatter(w, &path, v, &ray, &straight) || (last && !straight))
            break;
        if (straight && ++passed > STRAIGHT_MAX)
            break;
        if (!straight)
            path.segments++;
        v = &next;
    }
    film_path_end(w->pixel);
}

void path_trace(PathWorker *w, const Ray *ray, const Sampler *sampler)
{
    const PathContext *c = w->context;
    Vertex first;
    if ((first.met = accel_intersect(c->accel, ray, RAY_CAMERA, &first.hit)))
        fill_vertex(w, ray, sampler, 0, c->max_depth <= 1, &first);
    follow(w, *ray, sampler, &first);
}

/* Is anything between the vertices and the lights picked for them? Only what lets light through is left open. */
static void look_for_lights(PathWorker *w, Vertex *vertices, int count)
{
    const Accel *accel = w->context->accel;
    LightTry *tries[ACCEL_PACKET];
    Ray rays[ACCEL_PACKET];
    Hit hits[ACCEL_PACKET];
    int n = 0, through = 0;
    for (int i = 0; i < count; i++) {
        LightTry *t = &vertices[i].light;
        if (!vertices[i].met || !t->found || t->way != WAY_UNKNOWN || t->other_side)
            continue;
        through |= accel_has_transparent(accel, t->light.kind == LIGHT_SAMPLE_SOURCE);
        rays[n] = t->ray;
        tries[n++] = t;
    }
    if (n == 0)
        return;
    unsigned blocked = 0;
    if (through)
        accel_intersect_packet(accel, rays, n, RAY_SHADOW, hits);
    else
        blocked = accel_occluded_packet(accel, rays, n, RAY_SHADOW);
    for (int i = 0; i < n; i++) {
        if (through && hits[i].primitive >= 0 && accel_is_transparent(accel, hits[i].primitive))
            continue;
        w->shadow_rays++;
        tries[i]->way = (through ? hits[i].primitive >= 0 : blocked >> i & 1) ? WAY_BLOCKED : WAY_FREE;
    }
}

void path_trace_packet(PathWorker *w, const Ray *rays, const Sampler *samplers, int count)
{
    const PathContext *c = w->context;
    Vertex first[ACCEL_PACKET];
    Hit hits[ACCEL_PACKET];
    accel_intersect_packet(c->accel, rays, count, RAY_CAMERA, hits);
    for (int i = 0; i < count; i++) {
        Vertex *v = &first[i];
        v->hit = hits[i];
        if ((v->met = hits[i].primitive >= 0))
            fill_vertex(w, &rays[i], &samplers[i], 0, c->max_depth <= 1, v);
    }
    look_for_lights(w, first, count);
    for (int i = 0; i < count; i++)
        follow(w, rays[i], &samplers[i], &first[i]);
}
