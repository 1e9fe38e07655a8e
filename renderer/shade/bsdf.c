/* Evaluation and sampling of the split BSDF; what a finish means is in material.c. */
#include "shade/bsdf.h"
#include "shade/fresnel.h"
#include "shade/microfacet.h"

static float power5(float x)
{
    return x * x * x * x * x;
}

/* Fresnel term of the microfacet lobe at a half vector: supplement 4.1.2 with the base's share that transmits mixed
 * in. */
static Split microfacet_fresnel(const Bsdf *b, float cos_h)
{
    float m = b->metallic, w = power5(1 - cos_h), a = b->transmission;
    float f0 = (b->coat_eta - 1) / (b->coat_eta + 1);
    float r0_indep = (1 - m) * f0 * f0 * b->specular_tint;
    float indep = (1 - m) * fresnel_dielectric(cos_h, b->coat_eta) + m * (r0_indep + (1 - r0_indep) * w);
    float dep = m * (1 - w) * m;
    if (a > 0)
        indep = (1 - a) * indep + a * fresnel_dielectric(cos_h, b->eta), dep *= 1 - a;
    return (Split){rgb_grey(dep * b->coverage), rgb_grey(indep * b->coverage)};
}

/* Share of the choice with which light at a microfacet goes through rather than back. */
static float through_share(const Bsdf *b, float cos_h)
{
    if (b->transmission <= 0 || b->eta == 1)
        return 0;
    float through = b->transmission * (1 - fresnel_dielectric(cos_h, b->eta)) * NEUTRAL_ALBEDO;
    return through > 0 ? through / (through + split_neutral(microfacet_fresnel(b, cos_h))) : 0;
}

/* Lambert times the cosine, with POV-Ray's brilliance and grain. */
static float lambert_value(const Bsdf *b, float reflectance, float cosine)
{
    float value = reflectance / (float)PI * (b->brilliance == 1 ? 1 : powf(cosine, b->brilliance - 1)) * cosine;
    return b->grain > 0 ? not_negative(value - b->grain / (float)PI) : value;
}

/* Diffuse lobe over albedo, times the cosine: Lambert, or Burley's 2015 diffuse and retro-reflective lobes. */
static float diffuse_value(const Bsdf *b, Vec3 wi, double cos_i)
{
    if (!b->disney)
        return lambert_value(b, b->diffuse, (float)cos_i);
    Vec3 h = vec_normalize(vec_add(wi, b->wo));
    float cos_d = (float)vec_dot(wi, h), fl = power5(1 - (float)cos_i), fv = power5(1 - (float)b->cos_o);
    float rr = 2 * b->roughness * cos_d * cos_d;
    float lambert = (1 - fl / 2) * (1 - fv / 2), retro = rr * (fl + fv + fl * fv * (rr - 1));
    return b->diffuse / (float)PI * (lambert + retro) * (float)cos_i;
}

static Vec3 to_local(const Bsdf *b, Vec3 w)
{
    return vec3(vec_dot(w, b->s), vec_dot(w, b->t), vec_dot(w, b->normal));
}
static Vec3 to_world(const Bsdf *b, Vec3 w)
{
    return vec_add(vec_add(vec_scale(b->s, w.x), vec_scale(b->t, w.y)), vec_scale(b->normal, w.z));
}

static Split glossy_reflection(const Bsdf *b, Vec3 wi, float *pdf)
{
    Vec3 o = to_local(b, b->wo), i = to_local(b, wi), h = vec_normalize(vec_add(o, i));
    double d = ggx_d(h, b->alpha);
    float value = (float)(d * ggx_g2(o, i, b->alpha) / (4 * o.z)); /* times cos_i, which cancels */
    float cos_h = (float)fmin(1, vec_dot(o, h));
    Split f = microfacet_fresnel(b, cos_h);
    *pdf = (float)(ggx_visible_pdf(o, h, b->alpha) / (4 * vec_dot(o, h))) * (1 - through_share(b, cos_h));
    return (Split){rgb_scale(f.d, value), rgb_scale(f.i, value)};
}

/* Rough refraction (Walter et al. 2007, Eq. 21, for radiance), tinted by the albedo. */
static Split glossy_transmission(const Bsdf *b, Vec3 wi, float *pdf)
{
    Vec3 o = to_local(b, b->wo), i = to_local(b, wi), h = vec_normalize(vec_mad(o, i, b->bend));
    Split none = {{0, 0, 0}, {0, 0, 0}};
    *pdf = 0;
    if (h.z < 0)
        h = vec_neg(h);
    double oh = vec_dot(o, h), ih = vec_dot(i, h);
    if (oh <= 0 || ih >= 0)
        return none;
    double sum = b->bend * ih + oh;
    double transmitted = b->transmission * (1 - fresnel_dielectric((float)fmin(1, oh), b->eta));
    double value = ggx_d(h, b->alpha) * ggx_g2(o, vec3(i.x, i.y, -i.z), b->alpha) * transmitted * fabs(ih * oh) /
                   (o.z * sum * sum);
    *pdf = (float)(ggx_visible_pdf(o, h, b->alpha) * fabs(ih) * b->bend * b->bend / (sum * sum)) *
           through_share(b, (float)fmin(1, oh));
    return (Split){rgb_grey((float)value), {0, 0, 0}};
}

/* The value of a highlight, and its density: of directions about one in which its cosine is 1. By rounding the cosine
 * may be much more than 1, where light and eye are opposite each other. */
static float highlight_value(const Highlight *h, float cosine, float jacobian, float *pdf)
{
    if (h->amount <= 0 || cosine <= 0)
        return 0;
    float lobe = powf(at_most(cosine, 1), h->exponent);
    *pdf += h->p * (h->exponent + 1) / (2 * (float)PI) * lobe * jacobian;
    return h->amount * lobe / (float)PI;
}

/* POV-Ray's highlights have no cosine of the light. Divided by the larger cosine instead of it the BSDF is symmetric,
 * and the same where they are brightest. */
static Split highlight_reflection(const Bsdf *b, Vec3 wi, float cos_i, float *pdf)
{
    float between = (float)vec_dot(wi, b->wo), cos_o = (float)b->cos_o;
    float cos_h = sqrtf(not_negative(1 + between) / 2); /* between either direction and the half vector */
    if (cos_h <= 0)
        return (Split){{0, 0, 0}, {0, 0, 0}};
    float value = highlight_value(&b->blinn, (cos_i + cos_o) / (2 * cos_h), 1 / (4 * cos_h), pdf) +
                  highlight_value(&b->phong, 2 * cos_i * cos_o - between, 1, pdf);
    value *= cos_i < cos_o ? cos_i / cos_o : 1;
    float tinted = value * b->highlight_metallic;
    return metallic_tint((Split){rgb_grey(tinted), rgb_grey(value - tinted)}, cos_h);
}

float bsdf_highlight_alpha(const Bsdf *b)
{
    if (b->highlights <= 0)
        return 0;
    float blinn = b->blinn.amount > 0 ? b->blinn.exponent : 0;
    float phong = b->phong.amount > 0 ? 4 * b->phong.exponent : 0; /* its angle is about twice that of half vectors */
    return sqrtf(2 / (fmaxf(blinn, phong) + 2));
}

Rgb bsdf_irid(const Bsdf *b, float cos_i)
{
    float sum = cos_i + (float)b->cos_o;
    return rgb(1 + b->irid * cosf(b->irid_phase.r * sum), 1 + b->irid * cosf(b->irid_phase.g * sum),
               1 + b->irid * cosf(b->irid_phase.b * sum));
}

static Split under_film(const Bsdf *b, Split s, float cos_i)
{
    Rgb factor = bsdf_irid(b, cos_i);
    return (Split){rgb_mul(s.d, factor), rgb_mul(s.i, factor)};
}

static void split_add(Split *sum, Split s)
{
    sum->d = rgb_add(sum->d, s.d);
    sum->i = rgb_add(sum->i, s.i);
}

static Split eval_reflection(const Bsdf *b, Vec3 wi, double cos_i, BsdfLight light, float *pdf)
{
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    if (b->diffuse > 0) {
        sum.d = rgb_grey(diffuse_value(b, wi, cos_i));
        *pdf += b->p_diffuse * (float)(cos_i / PI);
    }
    if (b->alpha > 0) {
        float p = 0;
        split_add(&sum, glossy_reflection(b, wi, &p));
        *pdf += b->p_glossy * p;
    }
    if (b->highlights > 0 && light != BSDF_SHADOWLESS && (light == BSDF_LIGHT_SOURCE || !b->highlight_lights_only)) {
        float p = 0;
        split_add(&sum, highlight_reflection(b, wi, (float)cos_i, &p));
        *pdf += b->p_glossy * p;
    }
    return b->irid > 0 ? under_film(b, sum, (float)cos_i) : sum;
}

static Split eval_lambert(const Bsdf *b, Vec3 wi, float *pdf)
{
    float cosine = (float)vec_dot(wi, b->normal);
    int back = cosine < 0;
    Split none = {{0, 0, 0}, {0, 0, 0}};
    *pdf = 0;
    if (cosine == 0 || (vec_dot(wi, b->geometric) < 0) != back)
        return none;
    cosine = fabsf(cosine) / (float)PI;
    *pdf = (back ? b->p_back : b->p_diffuse) * cosine;
    return (Split){rgb_grey((back ? b->diffuse_back : b->diffuse) * cosine), {0, 0, 0}};
}

/* Light that goes through: by the back's diffuse lobe, or refracted by a rough surface. cos_i < 0. */
static Split eval_transmission(const Bsdf *b, Vec3 wi, double cos_i, float *pdf)
{
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    if (b->diffuse_back > 0) {
        sum.d = rgb_grey(lambert_value(b, b->diffuse_back, (float)-cos_i));
        *pdf += b->p_back * (float)(-cos_i / PI);
    }
    if (b->alpha > 0 && b->disney && b->transmission > 0 && b->eta != 1) {
        float p = 0;
        split_add(&sum, glossy_transmission(b, wi, &p));
        *pdf += b->p_glossy * p;
    }
    return sum;
}

static Vec3 mirrored(Vec3 w, Vec3 n)
{
    return vec_mad(w, n, -2 * vec_dot(w, n));
}

/* What lobes send along wi, and what they send to the wrong side, which is mirrored along wi. */
static Split eval_mirrored(const Bsdf *b, Vec3 wi, BsdfLight light, float *pdf)
{
    const Vec3 from[2] = {wi, mirrored(wi, b->geometric)};
    const double side = vec_dot(wi, b->geometric);
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < 2; k++) {
        double cos_i = vec_dot(from[k], b->normal);
        if (cos_i > 0 && side > 0)
            split_add(&sum, eval_reflection(b, from[k], cos_i, light, pdf));
        else if (cos_i < 0 && side < 0)
            split_add(&sum, eval_transmission(b, from[k], cos_i, pdf));
    }
    return sum;
}

static Split eval_bumped(const Bsdf *b, Vec3 wi, BsdfLight light, float *pdf)
{
    if (!b->hidden)
        return eval_mirrored(b, wi, light, pdf);
    Bsdf diffuse = *b, rest = *b;
    diffuse.normal = b->diffuse_normal, diffuse.alpha = diffuse.highlights = 0;
    rest.diffuse = rest.diffuse_back = 0;
    Split sum = eval_mirrored(&diffuse, wi, light, pdf);
    split_add(&sum, eval_mirrored(&rest, wi, light, pdf));
    return sum;
}

static inline Split eval_base(const Bsdf *b, Vec3 wi, BsdfLight light, float *pdf)
{
    if (b->bumped)
        return eval_bumped(b, wi, light, pdf);
    double cos_i = vec_dot(wi, b->normal), side = vec_dot(wi, b->geometric);
    if (cos_i > 0 && side > 0)
        return eval_reflection(b, wi, cos_i, light, pdf);
    if (cos_i < 0 && side < 0)
        return eval_transmission(b, wi, cos_i, pdf);
    return (Split){{0, 0, 0}, {0, 0, 0}};
}

static __attribute__((noinline)) Split eval_coating(const Bsdf *b, Vec3 wi, BsdfLight light, float *pdf)
{
    Split sum = split_times(eval_base(b, wi, light, pdf), b->coating.under);
    if (vec_dot(wi, b->geometric) > 0)
        sum.i = rgb_add(sum.i, coating_eval(&b->coating, bsdf_coated_normal(b), b->wo, wi, pdf));
    return sum;
}

Split bsdf_eval(const Bsdf *b, Vec3 wi, BsdfLight light, float *pdf)
{
    if (b->lambert)
        return eval_lambert(b, wi, pdf);
    *pdf = 0;
    return b->coating.present ? eval_coating(b, wi, light, pdf) : eval_base(b, wi, light, pdf);
}

/* About an axis, where the cosine of the angle to it and the sine are known. */
static Vec3 direction_about(Vec3 axis, double cosine, double sine, float turn)
{
    double sine_turn, cosine_turn;
    Vec3 s, t;
    turn_sincos(turn, &sine_turn, &cosine_turn);
    vec_frame(axis, &s, &t);
    return vec_mad(vec_mad(vec_scale(axis, cosine), s, sine * cosine_turn), t, sine * sine_turn);
}

static Vec3 cosine_direction(Vec3 normal, float u1, float u2)
{
    return direction_about(normal, sqrt(1 - u1), sqrt(u1), u2);
}

/* Value and density are the same but for a factor. */
static int sample_lambert(const Bsdf *b, float u_lobe, float u1, float u2, BsdfSample *sample)
{
    int back = u_lobe >= b->p_diffuse;
    float p = back ? b->p_back : b->p_diffuse;
    if (p <= 0)
        return 0;
    Vec3 wi = cosine_direction(b->normal, u1, u2);
    float cosine = (float)vec_dot(wi, b->normal);
    sample->wi = back ? vec_mad(wi, b->normal, -2 * (double)cosine) : wi;
    if (cosine <= 0 || (vec_dot(sample->wi, b->geometric) > 0) == back)
        return 0;
    sample->weight = (Split){rgb_grey((back ? b->diffuse_back : b->diffuse) / p), {0, 0, 0}};
    sample->pdf = p * cosine / (float)PI;
    sample->transmitted = back;
    sample->straight = sample->subsurface = 0;
    return 1;
}

static Vec3 reflect(Vec3 wo, Vec3 n)
{
    return vec_sub(vec_scale(n, 2 * vec_dot(wo, n)), wo);
}

/* Returns 0 on total internal reflection. eta: far over near, n on wo's side. */
static int refract(Vec3 wo, Vec3 n, double eta, Vec3 *wi)
{
    double cos_i = vec_dot(wo, n), sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1)
        return 0;
    *wi = vec_normalize(vec_sub(vec_scale(n, cos_i / eta - sqrt(1 - sin2_t)), vec_scale(wo, 1 / eta)));
    return 1;
}

/* Direction of the chosen non-delta lobe; its density and value come from bsdf_eval, over all lobes. */
static int sample_glossy(const Bsdf *b, float choice, float u1, float u2, Vec3 *wi)
{
    Vec3 h = to_world(b, ggx_sample_visible(to_local(b, b->wo), b->alpha, u1, u2));
    if (choice < through_share(b, (float)fmin(1, vec_dot(b->wo, h))))
        return refract(b->wo, h, b->bend, wi) && vec_dot(*wi, b->normal) < 0;
    *wi = reflect(b->wo, h);
    return vec_dot(*wi, b->normal) > 0; /* below the horizon: a second bounce, which the lobe leaves out */
}

/* The half vector of `specular`, or the direction of `phong`, by the power of its cosine. */
static int sample_highlight(const Bsdf *b, float choice, float u1, float u2, Vec3 *wi)
{
    int is_blinn = choice < b->blinn.p;
    double cosine = pow(1 - (double)u1, 1 / (1.0 + (double)(is_blinn ? b->blinn : b->phong).exponent));
    double sine = sqrt(fmax(0, 1 - cosine * cosine));
    *wi = direction_about(is_blinn ? b->normal : reflect(b->wo, b->normal), cosine, sine, u2);
    if (is_blinn)
        *wi = reflect(b->wo, *wi);
    return vec_dot(*wi, b->normal) > 0;
}

/* An interpolated normal may send a mirrored or refracted ray to the wrong side of the surface, which would look black
 * along its edges: the surface's own normal takes over, by which such a refracted ray is reflected totally. */
static int sample_mirror(const Bsdf *b, BsdfSample *sample)
{
    sample->wi = reflect(b->wo, b->normal);
    sample->weight = split_times(b->mirror, 1 / b->p_mirror);
    if (vec_dot(sample->wi, b->geometric) <= 0)
        sample->wi = b->bumped ? mirrored(sample->wi, b->geometric) : reflect(b->wo, b->geometric);
    return vec_dot(sample->wi, b->geometric) > 0;
}

static int sample_passing(const Bsdf *b, BsdfSample *sample)
{
    sample->weight = split_times(b->passing, 1 / b->p_passing);
    sample->transmitted = 1;
    if (!b->refracts) {
        sample->wi = vec_neg(b->wo);
        sample->straight = 1;
        return 1;
    }
    int refracted = refract(b->wo, b->normal, b->bend, &sample->wi);
    if (refracted && b->bumped && vec_dot(sample->wi, b->geometric) > 0)
        sample->wi = mirrored(sample->wi, b->geometric);
    if (refracted && vec_dot(sample->wi, b->geometric) < 0) {
        /* Radiance changes by the square of the index ratio as its beam widens or narrows. */
        sample->weight = split_times(sample->weight, 1 / (b->bend * b->bend));
        return 1;
    }
    sample->transmitted = 0;
    sample->wi = reflect(b->wo, b->geometric);
    return 1;
}

void bsdf_tilt_diffuse(Bsdf *b, Vec3 normal)
{
    if (b->lambert) /* which leaves the fields of other lobes unset */
        *b = (Bsdf){.normal = b->normal,
                    .geometric = b->geometric,
                    .wo = b->wo,
                    .cos_o = b->cos_o,
                    .eta = b->eta,
                    .bend = b->bend,
                    .refracts = b->refracts,
                    .p_diffuse = b->p_diffuse,
                    .p_back = b->p_back,
                    .diffuse = b->diffuse,
                    .diffuse_back = b->diffuse_back,
                    .brilliance = 1};
    b->flat_normal = bsdf_surface_normal(b);
    b->bumped = b->hidden = b->tilted = 1;
    b->diffuse_normal = normal;
}

Vec3 bsdf_enter(const Bsdf *b, float u1, float u2)
{
    const Vec3 wi = vec_neg(cosine_direction(bsdf_surface_normal(b), u1, u2));
    return vec_dot(wi, b->geometric) < 0 ? wi : mirrored(wi, b->geometric);
}

/* Value and density of all lobes along the direction that one of them has chosen. */
static inline int take_direction(const Bsdf *b, BsdfSample *sample)
{
    const Split f = bsdf_eval(b, sample->wi, BSDF_ANY_LIGHT, &sample->pdf);
    if (sample->pdf <= 0)
        return 0;
    sample->weight = split_times(f, 1 / sample->pdf);
    return 1;
}

static __attribute__((noinline)) int sample_coat(const Bsdf *b, float u1, float u2, BsdfSample *sample)
{
    sample->wi = coating_sample_coat(&b->coating, b->wo, u1, u2);
    if (vec_dot(sample->wi, b->geometric) <= 0)
        return 0;
    if (b->coating.coat.alpha > 0)
        return take_direction(b, sample);
    sample->weight.i = rgb_grey(coating_mirrored(&b->coating, b->wo) / b->coating.coat.p);
    return 1;
}

static __attribute__((noinline)) int sample_sheen(const Bsdf *b, float u1, float u2, BsdfSample *sample)
{
    sample->wi = cosine_direction(bsdf_coated_normal(b), u1, u2);
    return vec_dot(sample->wi, b->geometric) > 0 && take_direction(b, sample);
}

static int is_along(const BsdfSample *sample, Vec3 wi, double tolerance)
{
    const Vec3 between = vec_sub(sample->wi, wi);
    return vec_dot(between, between) < tolerance;
}

Split bsdf_delta(const Bsdf *b, Vec3 wi, double tolerance, float *p)
{
    Split sum = {{0, 0, 0}, {0, 0, 0}};
    BsdfSample sample = {.pdf = 0};
    *p = 0;
    if (b->lambert)
        return sum;
    if (b->p_mirror > 0 && sample_mirror(b, &sample) && is_along(&sample, wi, tolerance)) {
        *p = b->p_mirror;
        sum = b->mirror;
    }
    if (b->coating.present && b->coating.coat.p > 0 && !(b->coating.coat.alpha > 0) &&
        sample_coat(b, 0.5f, 0.5f, &sample) && is_along(&sample, wi, tolerance)) {
        *p += b->coating.coat.p;
        sum.i = rgb_add(sum.i, rgb_grey(coating_mirrored(&b->coating, b->wo)));
    }
    return sum;
}

int bsdf_sample(const Bsdf *b, float u_lobe, float u1, float u2, BsdfSample *sample)
{
    if (b->lambert)
        return sample_lambert(b, u_lobe, u1, u2, sample);
    *sample = (BsdfSample){0};
    float u = u_lobe;
    if ((u -= b->p_mirror) < 0)
        return sample_mirror(b, sample);
    if ((u -= b->p_passing) < 0)
        return sample_passing(b, sample);
    if ((u -= b->p_subsurface) < 0) {
        sample->wi = bsdf_enter(b, u1, u2);
        sample->weight.d = rgb_grey(b->subsurface / b->p_subsurface);
        sample->subsurface = 1;
        return 1;
    }
    if (b->coating.present && (u -= b->coating.coat.p) < 0)
        return sample_coat(b, u1, u2, sample);
    if (b->coating.present && (u -= b->coating.sheen.p) < 0)
        return sample_sheen(b, u1, u2, sample);
    if ((u -= b->p_diffuse) < 0) {
        sample->wi = cosine_direction(bsdf_surface_normal(b), u1, u2);
    } else if ((u -= b->p_back) < 0) {
        Vec3 normal = bsdf_surface_normal(b);
        sample->wi = mirrored(cosine_direction(normal, u1, u2), normal);
        sample->transmitted = 1;
    } else {
        if (b->p_glossy <= 0)
            return 0;
        float choice = u / b->p_glossy; /* the rest of u, uniform in [0,1) again */
        if (!(b->highlights > 0 ? sample_highlight : sample_glossy)(b, choice, u1, u2, &sample->wi))
            return 0;
        sample->transmitted = vec_dot(sample->wi, b->normal) < 0;
    }
    if (b->bumped && (vec_dot(sample->wi, b->geometric) < 0) != sample->transmitted)
        sample->wi = mirrored(sample->wi, b->geometric);
    return take_direction(b, sample);
}
