/* Vertices on targets with several finishes. Directions are sampled from the mixture of their BSDFs, in which all have
 * the same share; each finish has weights of its own, so that the picture with each is unbiased. Balance-heuristic
 * weights of Veach's multiple importance sampling come to the same. */
#include <string.h>

#include <retex/host/texture_lookup.h>

#include "path/internal.h"

#define SAME_DIRECTION 1e-12 /* of delta lobes: squared distance */

/* Fills finishes.weights: of each variant, the weights of the target's finishes at the vertex. They are those of its
 * texture's map, of finishes, which sum to 1, or of normals; without one, 1 of the finish that is shown. Returns
 * whether any variant has a map. */
static __attribute__((noinline)) int look_up_weights(Vertex *v, const RenderVariant *variants, int nvariants)
{
    VertexFinishes *finishes = &v->finishes;
    int any = 0;
    memset(finishes->weights, 0, sizeof *finishes->weights * (size_t)nvariants);
    for (int i = 0; i < nvariants; i++) {
        const RetexTexture *texture = variants[i].constants ? NULL : variants[i].textures[v->s.surface.target];
        if (texture && retex_texture_finishes(texture, v->s.uv.u, v->s.uv.v, finishes->shown, finishes->weights[i]))
            any = 1;
        else
            finishes->weights[i][finishes->shown] = 1;
    }
    return any;
}

/* ---- normal maps ---- */

/* Components of a normal that is tilted along one axis. */
static void tilted_components(int axis, double components[3])
{
    components[axis] = sin(NORMAL_TILT * PI / 180);
    components[!axis] = 0;
    components[2] = cos(NORMAL_TILT * PI / 180);
}

/* The normals of which the weights are. */
static void set_normals(VertexFinishes *finishes, int nvariants)
{
    double tilted[2][3];
    tilted_components(0, tilted[0]);
    tilted_components(1, tilted[1]);
    for (int i = 0; i < nvariants; i++) {
        const float *weights = finishes->weights[i];
        for (int c = 0; c < 3; c++)
            finishes->normals[i][c] = (c == 2 ? (double)weights[0] : 0) + (double)weights[1] * tilted[0][c] +
                                      (double)weights[2] * tilted[1][c];
    }
    finishes->has_normals = 1;
}

/* The surface as the normal map of a variant has it. */
static Split eval_normal(const Vertex *v, int variant, Vec3 wi, BsdfLight light)
{
    Bsdf bsdf = v->finishes.of[0];
    float unused;
    shading_tilt(&v->s, v->finishes.normals[variant], &bsdf);
    return bsdf_eval(&bsdf, wi, light, &unused);
}

const FinishFactor *finishes_variants(const Vertex *v, Vec3 wi, BsdfLight light, float pdf, float times,
                                      const FinishFactor *by_finish, int nvariants, FinishFactor out[VARIANTS_MAX])
{
    if (!v->finishes.count || !v->finishes.has_normals || nvariants < 2)
        return NULL;
    for (int i = 0; i < nvariants; i++) {
        if (by_finish) {
            out[i] = by_finish[0];
            continue;
        }
        const Split f = eval_normal(v, i, wi, light);
        out[i] = (FinishFactor){color4(rgb_scale(f.d, 1 / pdf)) * splat(times),
                                color4(rgb_scale(f.i, 1 / pdf)) * splat(times)}; /* the same bits as of one variant */
    }
    return out;
}

/* ---- finishes ---- */

/* What is shown, of values by finish. */
static inline Split shown(const VertexFinishes *finishes, const Split values[FINISHES_MAX])
{
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    if (!finishes->has_weights) /* also of a delta lobe, which normal maps leave as it is */
        return values[finishes->shown];
    for (int k = 0; k < finishes->count; k++) {
        sum.d = rgb_add(sum.d, rgb_scale(values[k].d, finishes->weights[0][k]));
        sum.i = rgb_add(sum.i, rgb_scale(values[k].i, finishes->weights[0][k]));
    }
    return sum;
}

void finishes_setup(Vertex *v, const Scene *scene, const RenderVariant *variants, int nvariants, Vec3 wo)
{
    const Target *target = &scene->targets[v->s.surface.target];
    VertexFinishes *finishes = &v->finishes;
    finishes->count = target->nfinishes;
    finishes->shown = scene->finish_of[scene->shown][v->s.surface.target];
    for (int k = 0; k < target->nfinishes; k++) {
        double components[3];
        shading_bsdf_finish(&v->s, target_finish(target, k, v->s.surface.texture->finish), wo, &finishes->of[k]);
        if (!target->has_normals || k == 0)
            continue;
        tilted_components(k - 1, components);
        shading_tilt(&v->s, components, &finishes->of[k]);
    }
    v->s.bsdf = finishes->of[finishes->shown];
    const int has_maps = variants && look_up_weights(v, variants, nvariants);
    finishes->has_weights = has_maps && !target->has_normals;
    finishes->has_normals = 0;
    if (has_maps && target->has_normals)
        set_normals(finishes, nvariants);
}

Split finishes_eval(const Vertex *v, Vec3 wi, BsdfLight light, Split values[FINISHES_MAX], float *pdf)
{
    const VertexFinishes *finishes = &v->finishes;
    float sum = 0, own;
    for (int k = 0; k < finishes->count; k++) {
        values[k] = bsdf_eval(&finishes->of[k], wi, light, &own);
        sum += own;
    }
    *pdf = sum / (float)finishes->count;
    return finishes->has_normals ? eval_normal(v, 0, wi, light) : shown(finishes, values);
}

/* A delta lobe of one finish was sampled. Those of the others in the same direction could have been, too. */
static void weigh_deltas(const VertexFinishes *finishes, const BsdfSample *sample, Split weights[FINISHES_MAX])
{
    float sum = 0;
    for (int k = 0; k < finishes->count; k++) {
        float p;
        weights[k] = bsdf_delta(&finishes->of[k], sample->wi, SAME_DIRECTION, &p);
        sum += p;
    }
    for (int k = 0; k < finishes->count; k++)
        weights[k] = split_times(weights[k], sum > 0 ? (float)finishes->count / sum : 0);
}

/* The finish by whose BSDF a direction is sampled; *u becomes the number that chooses among its lobes. Delta lobes of
 * all finishes come first, as they do in each BSDF: the guide to caustics takes its share from the rest. */
static int choose_finish(const VertexFinishes *finishes, float *u)
{
    float delta[FINISHES_MAX], sum = 0;
    int k = 0;
    for (int i = 0; i < finishes->count; i++)
        sum += delta[i] = 1 - at_most(bsdf_wide_probability(&finishes->of[i]), 1);
    float left = *u * (float)finishes->count;
    const int is_wide = left >= sum;
    for (left -= is_wide ? sum : 0; k < finishes->count - 1; k++) {
        const float own = is_wide ? 1 - delta[k] : delta[k];
        if (left < own)
            break;
        left -= own;
    }
    *u = at_most(is_wide ? delta[k] + left : left, 1 - 0x1p-24f);
    return k;
}

int finishes_sample(const Vertex *v, float u_lobe, float u1, float u2, BsdfSample *sample, Split weights[FINISHES_MAX])
{
    const VertexFinishes *finishes = &v->finishes;
    const int k = choose_finish(finishes, &u_lobe);
    if (!bsdf_sample(&finishes->of[k], u_lobe, u1, u2, sample))
        return 0;
    if (sample->pdf > 0) {
        const Split whole = finishes_eval(v, sample->wi, BSDF_ANY_LIGHT, weights, &sample->pdf);
        sample->weight = split_times(whole, 1 / sample->pdf);
        for (int i = 0; i < finishes->count; i++)
            weights[i] = split_times(weights[i], 1 / sample->pdf);
    } else {
        weigh_deltas(finishes, sample, weights);
        sample->weight = shown(finishes, weights);
    }
    return 1;
}

float finishes_wide_probability(const Vertex *v)
{
    float sum = 0;
    for (int k = 0; k < v->finishes.count; k++)
        sum += bsdf_wide_probability(&v->finishes.of[k]);
    return sum / (float)v->finishes.count;
}

float finishes_neutral(const Vertex *v, const Split weights[FINISHES_MAX])
{
    float sum = 0;
    for (int k = 0; k < v->finishes.count; k++)
        sum += split_neutral(weights[k]);
    return sum / (float)v->finishes.count;
}
