/* Participating media on a path's way: what they emit and scatter, and what they do to throughput.
 *
 * Along a segment throughput is exact where media are the same everywhere, else it is tracked (path/media.c); at one of
 * the tentative collisions the path may be scattered. Absorption is a weight and ends no path. Which of the channels
 * the distance is chosen for depends on what media have done to the path so far, and on no surface.
 *
 * Light of light sources, which no path can hit, is scattered once at one point of each segment, chosen by the distance
 * to the light and by extinction; all other light where the path itself is scattered. */
#include "light/source.h"
#include "medium/phase.h"
#include "path/media.h"

/* Pairs of sample numbers of a segment. */
enum { PAIR_DISTANCE, PAIR_SOURCE, PAIR_SOURCE_POINT, PAIR_LIGHT, PAIR_LIGHT_POINT, PAIR_DIRECTION, PAIRS_PER_SEGMENT };

/* ---- numbers and colours ---- */

static void segment_pair(const Path *path, unsigned pair, float *u, float *v)
{
    const Sampler sampler = {path->key, path->sample};
    const unsigned segment = (unsigned)(path->segments + path->straight);
    sampler_pair(&sampler, DIMENSION_MEDIA + segment * PAIRS_PER_SEGMENT + pair, u, v);
}

static float mean4(Float4 v)
{
    return (v[0] + v[1] + v[2]) / 3;
}

static Float4 ratio4(Float4 a, Float4 b)
{
    return (Float4){b[0] > 0 ? a[0] / b[0] : 0, b[1] > 0 ? a[1] / b[1] : 0, b[2] > 0 ? a[2] / b[2] : 0, 0};
}

/* Shares of the channels, by which what is chosen at random is chosen; their sum is 1. */
static Float4 channel_shares(Float4 weight)
{
    const Float4 w = {fabsf(weight[0]), fabsf(weight[1]), fabsf(weight[2]), 0};
    const float sum = w[0] + w[1] + w[2];
    return sum > 0 && isfinite(sum) ? w / splat(sum) : (Float4){1.0f / 3, 1.0f / 3, 1.0f / 3, 0};
}

static float dot4(Float4 a, Float4 b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* ---- light of light sources ---- */

/* A distance in that part of a segment where a light shines, its density the mean of two: by the angle at which the
 * light sees the ray, and falling with extinction. */
typedef struct SourceDistance {
    double begin, length, rate;        /* rate: of extinction */
    int angular;                       /* 0: the light is no point */
    double along, across, first, last; /* of the light's point; angles at which it sees the ends */
} SourceDistance;

static SourceDistance source_distance(const Light *light, const Ray *ray, const MediumSet *set, double begin,
                                      double end)
{
    SourceDistance d = {.begin = begin, .length = end - begin, .rate = set->varies ? 0 : mean4(set->sums.extinction)};
    const Vec3 to = vec_sub(light->location, vec_mad(ray->origin, ray->direction, ray->tmin));
    d.along = vec_dot(to, ray->direction);
    d.across = vec_length(vec_mad(to, ray->direction, -d.along));
    d.first = atan2(begin - d.along, d.across), d.last = atan2(end - d.along, d.across);
    d.angular = !light_is_beam(light) && d.across > 1e-9 * vec_length(to) && d.last - d.first > 1e-9;
    return d;
}

static double source_distance_sample(const SourceDistance *d, double u)
{
    if (d->angular && u < 0.5)
        return d->along + d->across * tan(d->first + 2 * u * (d->last - d->first));
    u = d->angular ? 2 * u - 1 : u;
    if (d->rate * d->length < 1e-3)
        return d->begin + u * d->length;
    return d->begin - log1p(u * expm1(-d->rate * d->length)) / d->rate;
}

static double source_distance_density(const SourceDistance *d, double t)
{
    const double off = t - d->along, x = d->rate * d->length,
                 falling = x < 1e-3 ? 1 / d->length : d->rate * exp(-d->rate * (t - d->begin)) / -expm1(-x);
    if (!d->angular)
        return falling;
    return 0.5 * falling + 0.5 * d->across / ((d->last - d->first) * (d->across * d->across + off * off));
}

/* Light of a source that media scatter at a point towards the ray's origin, over its irradiance. What is seen directly
 * or sharply has POV-Ray's brightness; what goes on to other surfaces is the share that media take away. */
static Float4 source_scattering(const MediumSet *set, Vec3 p, double cosine, int is_seen)
{
    MediumSums here;
    Float4 sum = splat(0);
    medium_at(set, p, 0, &here);
    for (int k = 0; k < set->count; k++) {
        const Medium *m = set->media[k];
        sum += is_seen ? medium_scattering_of_sources(m, here.density[k]) * splat((float)phase_of_sources(m, cosine))
                       : medium_scattering(m, here.density[k]) * splat((float)phase_density(m, cosine));
    }
    return sum;
}

/* Bound of what a light source may give to a segment. */
static float source_weight(const Light *light, const Ray *ray, double most)
{
    double begin, end;
    if (light->passes_media || !light_reaches(light, NULL) || !source_lit_part(light, ray, most, &begin, &end))
        return 0;
    return source_most_irradiance(light, ray, most);
}

static const Light *pick_source(const Scene *scene, const Ray *ray, double most, float u, float *probability)
{
    const Light *picked = NULL;
    float sum = 0, weight = 0;
    for (int k = 0; k < scene->nlights; k++)
        sum += source_weight(&scene->lights[k], ray, most);
    u *= sum;
    for (int k = 0; sum > 0 && k < scene->nlights && (!picked || u >= 0); k++) {
        const float x = source_weight(&scene->lights[k], ray, most);
        if (x > 0)
            picked = &scene->lights[k], weight = x;
        u -= x;
    }
    *probability = weight / sum;
    return picked;
}

static void add_source_light(PathWorker *w, Path *path, const Ray *ray, const MediumSet *set, double most)
{
    const Vec3 from = vec_mad(ray->origin, ray->direction, ray->tmin);
    DirectLightSample sample = {.found = 1};
    Factor factors[SHADOW_FACTORS_MAX];
    float u_source, u_point1, u_point2, u_distance, probability;
    double begin, end;
    segment_pair(path, PAIR_SOURCE, &u_distance, &u_source);
    const Light *light = pick_source(w->context->scene, ray, most, u_source, &probability);
    if (!light || !source_lit_part(light, ray, most, &begin, &end))
        return;
    segment_pair(path, PAIR_SOURCE_POINT, &u_point1, &u_point2);
    const SourceDistance distance = source_distance(light, ray, set, begin, end);
    const double t = source_distance_sample(&distance, u_distance), density = source_distance_density(&distance, t);
    const Vec3 p = vec_mad(from, ray->direction, t);
    if (!(t >= 0 && t <= most && density > 0) || !source_sample(light, p, u_point1, u_point2, &sample.light))
        return;
    Float4 value = source_scattering(set, p, vec_dot(sample.light.direction, ray->direction), path->sharp);
    if (is_black4(value))
        return;
    const Vec3 towards = sample.light.shadow_direction;
    sample.ray = (Ray){p, towards, 0, shadow_ray_end(p, &sample.light)};
    const int passed = trace_shadow_ray(w, path, NULL, &sample, factors, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    value *= media_set_transmittance(w, path, set, from, ray->direction, t) * color4(sample.light.radiance);
    path_contribute(
        w, path,
        &(Contribution){light->lamp, rgb_of4(value / splat((float)(density * probability))), factors, passed, NULL});
}

/* ---- scattering of the path ---- */

/* Light of what paths can hit, which the path's next ray may find as well. */
static void add_other_light(PathWorker *w, Path *path, const Medium *medium, Vec3 p, Vec3 before)
{
    const PathContext *c = w->context;
    const LightSampleContext context = {p, {0, 0, 0}, NULL};
    Factor factors[1 + LIGHT_FACTORS_MAX + SHADOW_FACTORS_MAX];
    DirectLightSample sample = {.found = 1};
    LightSample *light = &sample.light;
    float u1, u2, u_point1, u_point2;
    segment_pair(path, PAIR_LIGHT, &u1, &u2);
    segment_pair(path, PAIR_LIGHT_POINT, &u_point1, &u_point2);
    const LightPick pick = lights_pick(c->lights, &context, u1, u2);
    if (!lights_sample(c->lights, &context, &pick, u_point1, u_point2, light) || light->source)
        return;
    sample.pdf = (float)phase_density(medium, vec_dot(light->direction, before));
    sample.ray = (Ray){p, light->direction, 0, shadow_ray_end(p, light)};
    const int n = light_factors(w, path, 0, light, factors);
    const int passed = trace_shadow_ray(w, path, NULL, &sample, factors + n, SHADOW_FACTORS_MAX);
    if (passed < 0)
        return;
    const float pdf = path_pdf_of_light(c, &sample.ray, RAY_BOUNCE, light, sample.pdf);
    const float light_pdf = light->pdf * light->pick_probability;
    if (pdf < 0)
        return;
    path_contribute(w, path,
                    &(Contribution){light->lamp,
                                    rgb_scale(light->radiance, sample.pdf * mis_weight(light_pdf, pdf) / light_pdf),
                                    factors, n + passed, NULL});
}

/* Which of the media scatters the path. *weight: its share over the probability. */
static const Medium *pick_medium(const MediumSet *set, const MediumSums *here, Float4 shares, float u, Float4 *weight)
{
    const float all = dot4(shares, here->scattering);
    const Medium *medium = NULL;
    float probability = 0;
    for (int k = 0; k < set->count && (!medium || u >= 0); k++) {
        const Float4 scattering = medium_scattering(set->media[k], here->density[k]);
        const float p = dot4(shares, scattering) / all;
        if (p > 0)
            medium = set->media[k], probability = p, *weight = ratio4(scattering, here->scattering);
        u -= p;
    }
    if (medium)
        *weight /= splat(probability);
    return medium;
}

/* Throughput, and what media have done to it, whose mean is kept at 1. Returns path_is_alive. */
static int apply_weight(PathWorker *w, Path *path, Float4 weight)
{
    const Float4 product = path->media_weight * weight;
    path->beta_neutral *= at_most(fabsf(mean4(product)), 1);
    path->media_weight = channel_shares(product) * splat(3);
    return path_scale(w, path, rgb_of4(weight));
}

static MediumEvent scatter_at(PathWorker *w, Path *path, Ray *ray, const MediumSet *set, double t, Float4 weight,
                              float u)
{
    const PathContext *c = w->context;
    const Vec3 p = vec_mad(ray->origin, ray->direction, ray->tmin + t), before = ray->direction;
    MediumSums here;
    Float4 share;
    double pdf;
    float u1, u2;
    medium_at(set, p, 0, &here);
    const Medium *medium = pick_medium(set, &here, channel_shares(path->media_weight * weight), u, &share);
    if (path->segments >= c->max_depth || !medium || !apply_weight(w, path, weight * share))
        return MEDIUM_ENDED;
    if (c->trace)
        fprintf(c->trace, "scattered at %.6g %.6g %.6g distance %.6g weight %.5g %.5g %.5g\n", p.x, p.y, p.z, t,
                (weight * share)[0], (weight * share)[1], (weight * share)[2]);
    add_other_light(w, path, medium, p, before);
    segment_pair(path, PAIR_DIRECTION, &u1, &u2);
    *ray = (Ray){p, phase_sample(medium, before, u1, u2, &pdf), 0, INFINITY};
    path->kind = RAY_BOUNCE;
    path->prev_context = (LightSampleContext){p, {0, 0, 0}, NULL};
    path->specular = SPECULAR_BEGINS, path->light_group = NULL;
    path->source_scale = path->sharp ? (float)(phase_source_scale(medium) / fmin(medium->extinction, 1)) : 1;
    path_next_segment(path, (float)pdf, (float)pdf);
    return MEDIUM_SCATTERED;
}

/* ---- a segment ---- */

static MediumEvent pass(PathWorker *w, Path *path, Float4 weight)
{
    if (w->context->trace)
        fprintf(w->context->trace, "media let %.5g %.5g %.5g pass\n", weight[0], weight[1], weight[2]);
    return apply_weight(w, path, weight) ? MEDIUM_PASSED : MEDIUM_ENDED;
}

/* Emission over a distance. */
static Float4 uniform_glow(const MediumSums *sums, double distance)
{
    Float4 glow = splat(0);
    for (int k = 0; k < 3; k++) {
        const double e = sums->extinction[k], x = e * distance;
        glow[k] = (float)(sums->emission[k] * (x > 1e-6 ? -expm1(-x) / e : distance));
    }
    return glow;
}

/* Distances are chosen by scattering alone, of a channel that is chosen by its share. */
static MediumEvent cross_uniform(PathWorker *w, Path *path, Ray *ray, const MediumSet *set, double distance)
{
    const Float4 extinction = set->sums.extinction, scattering = set->sums.scattering;
    const Float4 shares = channel_shares(path->media_weight);
    float u, v;
    if (set->emits)
        path_contribute(w, path,
                        &(Contribution){scene_rest_lamp(w->context->scene),
                                        rgb_of4(uniform_glow(&set->sums, distance)), NULL, 0, NULL});
    if (is_black4(scattering))
        return pass(w, path, exp4(extinction * splat(-(float)distance)));
    segment_pair(path, PAIR_DISTANCE, &u, &v);
    int channel = 0;
    for (; channel < 2 && u >= shares[channel]; channel++)
        u -= shares[channel];
    const double t = scattering[channel] > 0 ? -log(1 - (double)v) / scattering[channel] : INFINITY;
    if (t >= distance)
        return pass(w, path,
                    exp4(extinction * splat(-(float)distance)) /
                        splat(dot4(shares, exp4(scattering * splat(-(float)distance)))));
    const float density = dot4(shares, scattering * exp4(scattering * splat(-(float)t)));
    return scatter_at(w, path, ray, set, t, scattering * exp4(extinction * splat(-(float)t)) / splat(density),
                      u / fmaxf(shares[channel], 1e-6f));
}

static MediumEvent cross_varying(PathWorker *w, Path *path, Ray *ray, const MediumSet *set, double distance)
{
    const Vec3 from = vec_mad(ray->origin, ray->direction, ray->tmin);
    const float rate = media_tracking_rate(set, distance);
    Float4 weight = splat(1), glow = splat(0);
    MediumSums here;
    double t = media_free_distance(w, path, rate);
    int scattered = 0;
    for (; t < distance; t += media_free_distance(w, path, rate)) {
        medium_at(set, vec_mad(from, ray->direction, t), rate, &here);
        glow += weight * here.emission / splat(rate);
        const Float4 scattering = here.scattering / splat(rate), rest = splat(1) - here.extinction / splat(rate);
        const Float4 shares = channel_shares(path->media_weight * weight);
        const float s = dot4(shares, scattering), r = dot4(shares, rest), probability = s > 0 ? s / (s + r) : 0;
        scattered = probability > 0 && media_draw(w, path) < probability;
        weight *= scattered ? scattering / splat(probability) : rest / splat(1 - probability);
        if (scattered || !media_weight_survives(w, path, &weight))
            break;
    }
    if (set->emits)
        path_contribute(w, path, &(Contribution){scene_rest_lamp(w->context->scene), rgb_of4(glow), NULL, 0, NULL});
    if (scattered)
        return scatter_at(w, path, ray, set, t, weight, media_draw(w, path));
    return t < distance ? MEDIUM_ENDED : pass(w, path, weight);
}

MediumEvent path_cross_media(PathWorker *w, Path *path, Ray *ray, const Hit *hit)
{
    const PathContext *c = w->context;
    MediumSet set;
    if (!path_is_seen(c, path, ray))
        return MEDIUM_PASSED;
    media_find(c->scene, &path->media, 1, &set);
    if (set.count == 0)
        return MEDIUM_PASSED;
    const double distance = media_distance(c, &set, hit->primitive < 0 ? INFINITY : hit->t - ray->tmin);
    if (!(distance > 0))
        return MEDIUM_PASSED;
    if (set.scatters && path->segments < c->max_depth)
        add_source_light(w, path, ray, &set, distance);
    return set.varies ? cross_varying(w, path, ray, &set, distance) : cross_uniform(w, path, ray, &set, distance);
}
