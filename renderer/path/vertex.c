/* What is chosen at a surface: a light, and the next direction, by the BSDF or by the guide to caustics. */
#include "path/caustics.h"
#include "path/internal.h"
#include "shade/pigment.h"

Split surface_emission(const Shading *s)
{
    const Finish *finish = s->surface.texture->finish;
    const Pigment *map = finish->retex.emission_map;
    const Rgb emission = rgb_scale(finish->emission, s->opacity);
    if (!map)
        return (Split){emission, {0, 0, 0}};
    const Rgbft c = pigment_eval_on(map, &s->surface);
    return (Split){{0, 0, 0}, rgb_mul(emission, rgb(not_negative(c.r), not_negative(c.g), not_negative(c.b)))};
}

int emitter_factors(PathWorker *w, const Path *path, int lane, LightSample *light, Factor *factors)
{
    const PathContext *c = w->context;
    Rgb(*storage)[VARIANTS_MAX] = w->light_albedos[lane];
    LightFactors above = {&light->radiance, factors, 0, LIGHT_FACTORS_MAX - 1, storage + 1};
    Shading s;
    s.surface = light->surface;
    light->radiance = rgb_grey(1);
    if (!s.surface.texture->tree)
        shading_color(&s, NULL, w->variants, c->nvariants);
    else if (!choose_leaf_of_light(w, path, &s, vec_neg(light->direction), 0, TEXTURE_LIGHT, &above))
        light->radiance = rgb_grey(0);
    const Split emission = surface_emission(&s);
    factors[above.count] = shading_factor(&s, color4(emission.d), color4(emission.i));
    factors[above.count].albedos = keep_albedos(c, storage[0], &s);
    return above.count + 1;
}

LightSampleContext light_sample_context(const Shading *s)
{
    const Vec3 none = {0, 0, 0};
    const Bsdf *b = &s->bsdf;
    const LightGroup *light_group = s->surface.primitive->light_group;
    if (!bsdf_only_reflects(b))
        return (LightSampleContext){s->surface.position, none, light_group};
    return (LightSampleContext){s->surface.position, b->bumped ? b->geometric : b->normal, light_group};
}

/* ---- directions by the guide to caustics ---- */

static inline float wide_probability(const Vertex *v)
{
    return v->finishes.count ? finishes_wide_probability(v) : bsdf_wide_probability(&v->s.bsdf);
}

const CausticsCell *guide_cell(const PathContext *c, const Vertex *v)
{
    return c->caustics && wide_probability(v) > 0 ? caustics_find(c->caustics, v->s.surface.position) : NULL;
}

/* Values and density of a direction: of the finish shown, and of all. */
static inline Split eval(const Vertex *v, Vec3 wi, BsdfLight light, Split values[FINISHES_MAX], float *pdf)
{
    return v->finishes.count ? finishes_eval(v, wi, light, values, pdf) : bsdf_eval(&v->s.bsdf, wi, light, pdf);
}

static inline int sample_bsdf(const Vertex *v, float u_lobe, BsdfSample *sample, Split weights[FINISHES_MAX])
{
    const float u = v->numbers->direction_u[v->lane], w = v->numbers->direction_v[v->lane];
    return v->finishes.count ? finishes_sample(v, u_lobe, u, w, sample, weights)
                             : bsdf_sample(&v->s.bsdf, u_lobe, u, w, sample);
}

/* Density of a direction by BSDF and guide together, given the BSDF's own. The guide only samples wo's side. */
static float guided_density(const Vertex *v, Vec3 wi, float pdf)
{
    const Bsdf *b = &v->s.bsdf;
    if (!v->cell)
        return pdf;
    pdf *= 1 - v->cell->share;
    if (vec_dot(wi, b->normal) <= 0 || vec_dot(wi, b->geometric) <= 0)
        return pdf;
    /* the guide takes a share of the choice of lobes that are no deltas */
    return pdf + v->cell->share * wide_probability(v) * caustics_density(v->cell, v->s.surface.position, wi);
}

/* Sample a direction by the guide; weight and density are those of the BSDF for it. */
static int sample_guide(const Vertex *v, float u_lobe, BsdfSample *sample, Split weights[FINISHES_MAX])
{
    const Bsdf *b = &v->s.bsdf;
    *sample = (BsdfSample){0};
    sample->wi = caustics_sample(v->cell, v->s.surface.position, u_lobe, v->numbers->direction_u[v->lane],
                                 v->numbers->direction_v[v->lane]);
    if (vec_dot(sample->wi, b->normal) <= 0 || vec_dot(sample->wi, b->geometric) <= 0)
        return 0;
    Split f = eval(v, sample->wi, BSDF_ANY_LIGHT, weights, &sample->pdf);
    if (sample->pdf <= 0)
        return 0;
    sample->weight = (Split){rgb_scale(f.d, 1 / sample->pdf), rgb_scale(f.i, 1 / sample->pdf)};
    for (int k = 0; k < v->finishes.count; k++)
        weights[k] = (Split){rgb_scale(weights[k].d, 1 / sample->pdf), rgb_scale(weights[k].i, 1 / sample->pdf)};
    return 1;
}

int sample_direction(const Vertex *v, BsdfSample *sample, Split weights[FINISHES_MAX], float *pdf)
{
    const VertexSamples *u = v->numbers;
    float u_lobe = u->lobe[v->lane];
    int found;
    if (!v->cell) {
        found = sample_bsdf(v, u_lobe, sample, weights);
        *pdf = sample->pdf;
        return found;
    }
    float share = v->cell->share, wide = wide_probability(v), delta = 1 - wide, rest = (u_lobe - delta) / wide;
    if (rest >= 0 && rest < share) {
        found = sample_guide(v, rest / share, sample, weights);
    } else {
        if (rest >= 0) /* the rest of u, uniform in [0,1) again */
            u_lobe = at_most(delta + (rest - share) / (1 - share) * wide, 1 - 0x1p-24f);
        found = sample_bsdf(v, u_lobe, sample, weights);
    }
    if (!found)
        return 0;
    *pdf = sample->pdf > 0 ? guided_density(v, sample->wi, sample->pdf) : 0;
    return 1;
}

void sample_direct_light(PathWorker *w, const Path *path, Vertex *v)
{
    const PathContext *c = w->context;
    const Shading *s = &v->s;
    const VertexSamples *u = v->numbers;
    int k = v->lane;
    DirectLightSample *sample = &v->light;
    LightSample *light = &sample->light;
    LightSampleContext context = light_sample_context(s);
    sample->found = 0;
    if (!v->picked)
        v->pick = lights_pick(c->lights, &context, u->light_choice[k], u->light_more[k]);
    if (!lights_sample(c->lights, &context, &v->pick, u->light_point_u[k], u->light_point_v[k], light))
        return;
    const int is_source = light->source != NULL;
    if (is_source && !light_reaches(light->source, s->surface.primitive->light_group))
        return;
    const BsdfLight kind = !is_source ? BSDF_ANY_LIGHT : light->shadowless ? BSDF_SHADOWLESS : BSDF_LIGHT_SOURCE;
    Split values[FINISHES_MAX];
    Split f = eval(v, light->direction, kind, values, &sample->pdf);
    int is_black = rgb_is_black(f.d) && rgb_is_black(f.i);
    for (int i = 0; i < v->finishes.count; i++) {
        sample->finishes[i] = (FinishFactor){color4(values[i].d), color4(values[i].i)};
        is_black &= rgb_is_black(values[i].d) && rgb_is_black(values[i].i);
    }
    if (is_black)
        return;
    if (!is_source)
        sample->pdf = guided_density(v, light->direction, sample->pdf);
    sample->found = 1;
    sample->traced = 0;
    sample->factors[0] = shading_factor(s, color4(f.d), color4(f.i));
    sample->factors[0].finishes = v->finishes.count ? sample->finishes : NULL;
    sample->factors[0].weights = v->finishes.count && v->finishes.has_weights ? v->finishes.weights : NULL;
    sample->factors[0].variants =
        finishes_variants(v, light->direction, kind, 1, 1, NULL, c->nvariants, sample->variants);
    sample->nfactors = 1 + light_factors(w, path, k, light, sample->factors + 1);
    sample->transmitted = vec_dot(light->direction, s->bsdf.geometric) < 0;
    const Vec3 direction = is_source ? light->shadow_direction : light->direction;
    sample->ray = (Ray){accel_offset(s->surface.position, s->surface.geometric_normal, direction), direction, 0,
                        shadow_ray_end(s->surface.position, light)};
}
