/* See coating.h. */
#include "shade/coating.h"
#include "shade/fresnel.h"
#include "shade/microfacet.h"

#define COAT_ETA 1.5f
#define LEAST_COSINE 1e-4
#define MIRROR_ALPHA 1e-3f         /* a coat below this width is a delta */
#define LEAST_SHEEN_ROUGHNESS 0.2f /* below it the lobe is no wider than grazing angles */

enum { TABLE = 16 };

/* Integrals of the lobes below, by roughness from 0 to 1 and cosine from 0 to 1, of sheen by its square root.
 * tests/unit/test_coat.c integrates them again. Of the coat it is the share over Fresnel's reflectance. */
static const float coat_table[TABLE][TABLE] = {
    {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
    {0.843f, 0.993f, 0.998f, 0.999f, 0.999f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
    {0.746f, 0.907f, 0.965f, 0.982f, 0.991f, 0.995f, 0.999f, 1, 1, 1, 1, 1, 1, 1, 1, 1},
    {0.611f, 0.736f, 0.859f, 0.921f, 0.954f, 0.975f, 0.988f, 0.997f, 1, 1.01f, 1.01f, 1.01f, 1.01f, 1, 1, 1},
    {0.488f, 0.585f, 0.706f, 0.803f, 0.871f, 0.919f, 0.954f, 0.979f, 0.995f, 1.01f, 1.01f, 1.01f, 1.01f, 1, 1, 0.997f},
    {0.388f, 0.467f, 0.564f, 0.662f, 0.75f, 0.824f, 0.884f, 0.932f, 0.967f, 0.991f, 1, 1.01f, 1.01f, 1, 0.996f, 0.989f},
    {0.31f, 0.374f, 0.452f, 0.537f, 0.624f, 0.709f, 0.787f, 0.855f, 0.91f, 0.952f, 0.979f, 0.993f, 0.996f, 0.991f,
     0.983f, 0.973f},
    {0.251f, 0.302f, 0.365f, 0.437f, 0.515f, 0.597f, 0.68f, 0.76f, 0.831f, 0.889f, 0.931f, 0.956f, 0.966f, 0.964f,
     0.957f, 0.946f},
    {0.207f, 0.248f, 0.299f, 0.359f, 0.427f, 0.502f, 0.582f, 0.664f, 0.742f, 0.81f, 0.862f, 0.897f, 0.915f, 0.918f,
     0.912f, 0.902f},
    {0.173f, 0.206f, 0.249f, 0.299f, 0.358f, 0.425f, 0.498f, 0.576f, 0.653f, 0.724f, 0.782f, 0.823f, 0.845f, 0.853f,
     0.849f, 0.839f},
    {0.149f, 0.175f, 0.21f, 0.253f, 0.303f, 0.362f, 0.428f, 0.499f, 0.572f, 0.64f, 0.697f, 0.739f, 0.763f, 0.772f,
     0.769f, 0.759f},
    {0.13f, 0.15f, 0.18f, 0.217f, 0.26f, 0.311f, 0.37f, 0.433f, 0.499f, 0.561f, 0.614f, 0.653f, 0.675f, 0.683f, 0.679f,
     0.667f},
    {0.116f, 0.132f, 0.157f, 0.188f, 0.225f, 0.269f, 0.32f, 0.376f, 0.434f, 0.489f, 0.535f, 0.568f, 0.587f, 0.591f,
     0.585f, 0.571f},
    {0.105f, 0.117f, 0.138f, 0.164f, 0.196f, 0.234f, 0.278f, 0.327f, 0.376f, 0.423f, 0.462f, 0.489f, 0.502f, 0.502f,
     0.493f, 0.478f},
    {0.0971f, 0.105f, 0.122f, 0.145f, 0.172f, 0.205f, 0.242f, 0.283f, 0.325f, 0.364f, 0.395f, 0.415f, 0.424f, 0.421f,
     0.409f, 0.392f},
    {0.0907f, 0.096f, 0.11f, 0.128f, 0.152f, 0.179f, 0.211f, 0.245f, 0.279f, 0.311f, 0.335f, 0.35f, 0.354f, 0.348f,
     0.335f, 0.318f},
};

static const float sheen_table[TABLE][TABLE] = {
    {2.85f, 2.83f, 2.1f, 1.32f, 0.72f, 0.336f, 0.129f, 0.0381f, 0.00801f, 0.00106f, 0, 0, 0, 0, 0, 0},
    {2.85f, 2.83f, 2.1f, 1.32f, 0.72f, 0.336f, 0.129f, 0.0381f, 0.00801f, 0.00106f, 0, 0, 0, 0, 0, 0},
    {1.56f, 1.64f, 1.4f, 1.06f, 0.754f, 0.5f, 0.307f, 0.172f, 0.0859f, 0.037f, 0.0131f, 0.00352f, 0.000641f, 0, 0, 0},
    {1.11f, 1.19f, 1.07f, 0.882f, 0.69f, 0.518f, 0.372f, 0.254f, 0.163f, 0.0967f, 0.0518f, 0.0242f, 0.00939f, 0.00267f,
     0, 0},
    {0.898f, 0.984f, 0.913f, 0.781f, 0.643f, 0.513f, 0.398f, 0.299f, 0.215f, 0.147f, 0.0942f, 0.0553f, 0.0291f, 0.0127f,
     0.00381f, 0},
    {0.791f, 0.876f, 0.829f, 0.728f, 0.618f, 0.513f, 0.416f, 0.33f, 0.254f, 0.188f, 0.133f, 0.0885f, 0.0546f, 0.0297f,
     0.0126f, 0.00242f},
    {0.736f, 0.822f, 0.79f, 0.705f, 0.611f, 0.52f, 0.435f, 0.357f, 0.287f, 0.224f, 0.169f, 0.121f, 0.0825f, 0.0514f,
     0.0268f, 0.00859f},
    {0.714f, 0.802f, 0.778f, 0.704f, 0.619f, 0.536f, 0.458f, 0.386f, 0.319f, 0.258f, 0.203f, 0.153f, 0.111f, 0.0758f,
     0.0453f, 0.0197f},
    {0.712f, 0.804f, 0.786f, 0.717f, 0.637f, 0.558f, 0.484f, 0.415f, 0.351f, 0.291f, 0.235f, 0.185f, 0.141f, 0.102f,
     0.0667f, 0.0353f},
    {0.726f, 0.821f, 0.807f, 0.74f, 0.662f, 0.586f, 0.514f, 0.446f, 0.383f, 0.323f, 0.267f, 0.215f, 0.169f, 0.128f,
     0.0898f, 0.054f},
    {0.749f, 0.848f, 0.836f, 0.77f, 0.693f, 0.617f, 0.545f, 0.477f, 0.414f, 0.354f, 0.297f, 0.244f, 0.197f, 0.154f,
     0.113f, 0.0746f},
    {0.777f, 0.88f, 0.868f, 0.801f, 0.724f, 0.647f, 0.575f, 0.507f, 0.443f, 0.383f, 0.325f, 0.271f, 0.223f, 0.178f,
     0.136f, 0.0957f},
    {0.806f, 0.911f, 0.899f, 0.831f, 0.752f, 0.675f, 0.602f, 0.533f, 0.469f, 0.408f, 0.35f, 0.295f, 0.246f, 0.2f,
     0.157f, 0.116f},
    {0.828f, 0.934f, 0.923f, 0.853f, 0.773f, 0.695f, 0.622f, 0.554f, 0.489f, 0.428f, 0.369f, 0.314f, 0.265f, 0.219f,
     0.176f, 0.135f},
    {0.838f, 0.944f, 0.932f, 0.863f, 0.783f, 0.706f, 0.633f, 0.565f, 0.501f, 0.441f, 0.383f, 0.328f, 0.28f, 0.235f,
     0.192f, 0.151f},
    {0.829f, 0.933f, 0.922f, 0.854f, 0.777f, 0.702f, 0.631f, 0.566f, 0.504f, 0.445f, 0.389f, 0.336f, 0.289f, 0.245f,
     0.204f, 0.164f},
};

static float look_up(const float table[TABLE][TABLE], float roughness, float column)
{
    const float x = at_most(not_negative(roughness), 1) * (TABLE - 1),
                y = at_most(not_negative(column), 1) * (TABLE - 1);
    const int i = x < TABLE - 2 ? (int)x : TABLE - 2, j = y < TABLE - 2 ? (int)y : TABLE - 2;
    const float s = x - (float)i, t = y - (float)j;
    return (1 - s) * ((1 - t) * table[i][j] + t * table[i][j + 1]) +
           s * ((1 - t) * table[i + 1][j] + t * table[i + 1][j + 1]);
}

float clearcoat_albedo(float cosine, float roughness)
{
    return look_up(coat_table, roughness, cosine) * fresnel_dielectric(at_most(cosine, 1), COAT_ETA);
}

float sheen_albedo(float cosine, float roughness)
{
    return look_up(sheen_table, roughness, sqrtf(not_negative(cosine)));
}

static float cosine_between(Vec3 w, Vec3 normal)
{
    const double cosine = vec_dot(w, normal);
    return (float)(cosine < LEAST_COSINE ? LEAST_COSINE : cosine > 1 ? 1 : cosine);
}

void coating_set(Coating *coating, const CoatingNumbers *numbers, float *of_coat, float *of_sheen)
{
    const float width = numbers->clearcoat_roughness * numbers->clearcoat_roughness;
    const float coat_alpha = width < MIRROR_ALPHA ? 0 : width;
    const float sheen_roughness = fmaxf(numbers->sheen_roughness, LEAST_SHEEN_ROUGHNESS);
    const float of_full_sheen = sheen_albedo(cosine_between(numbers->wo, numbers->normal), sheen_roughness);
    *of_coat =
        numbers->clearcoat * clearcoat_albedo(cosine_between(numbers->wo, numbers->coat_normal), sqrtf(coat_alpha));
    *of_sheen = at_most(of_full_sheen, 1);
    /* at grazing angles the lobe of smooth fibres would reflect more than it gets */
    Rgb color = rgb_scale(numbers->sheen, of_full_sheen > 1 ? 1 / of_full_sheen : 1);
    const float sheen_passes = 1 - at_most(rgb_max(numbers->sheen) * *of_sheen, 1);
    *of_sheen *= rgb_luminance(numbers->sheen) * (1 - *of_coat) * numbers->coverage;
    coating->present = 1;
    coating->under = (1 - *of_coat) * sheen_passes;
    color = rgb_scale(color, (1 - *of_coat) * numbers->coverage);
    *of_coat *= numbers->coverage;
    coating->coat.weight = numbers->clearcoat * numbers->coverage;
    coating->coat.alpha = coat_alpha;
    coating->coat.normal = numbers->coat_normal;
    vec_frame(coating->coat.normal, &coating->coat.s, &coating->coat.t);
    coating->sheen.color = color;
    coating->sheen.alpha = sheen_roughness * sheen_roughness;
}

float coating_mirrored(const Coating *coating, Vec3 wo)
{
    return coating->coat.weight * fresnel_dielectric(cosine_between(wo, coating->coat.normal), COAT_ETA);
}

/* ---- the coat ---- */

static Vec3 to_coat(const Coating *l, Vec3 w)
{
    return vec3(vec_dot(w, l->coat.s), vec_dot(w, l->coat.t), vec_dot(w, l->coat.normal));
}

static float coat_value(const Coating *l, Vec3 wo, Vec3 wi, float *pdf)
{
    Vec3 o = to_coat(l, wo), i = to_coat(l, wi);
    o.z = fmax(o.z, LEAST_COSINE);
    if (i.z <= 0)
        return 0;
    const Vec3 h = vec_normalize(vec_add(o, i));
    const double alpha = (double)l->coat.alpha, cos_h = vec_dot(o, h);
    *pdf += l->coat.p * (float)(ggx_visible_pdf(o, h, alpha) / (4 * cos_h));
    return l->coat.weight * fresnel_dielectric((float)fmin(1, cos_h), COAT_ETA) *
           (float)(ggx_d(h, alpha) * ggx_g2(o, i, alpha) / (4 * o.z));
}

Vec3 coating_sample_coat(const Coating *l, Vec3 wo, float u1, float u2)
{
    if (l->coat.alpha == 0)
        return vec_sub(vec_scale(l->coat.normal, 2 * vec_dot(wo, l->coat.normal)), wo);
    Vec3 o = to_coat(l, wo);
    o.z = fmax(o.z, LEAST_COSINE);
    const Vec3 h = ggx_sample_visible(o, (double)l->coat.alpha, (double)u1, (double)u2);
    const Vec3 i = vec_sub(vec_scale(h, 2 * vec_dot(o, h)), o);
    return vec_add(vec_add(vec_scale(l->coat.s, i.x), vec_scale(l->coat.t, i.y)), vec_scale(l->coat.normal, i.z));
}

/* ---- sheen ---- */

/* Shadowing, fitted by its authors for two widths; between them by (1 - alpha)^2. */
static double fitted(double x, double alpha)
{
    static const double wide[5] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054},
                        narrow[5] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    const double t = (1 - alpha) * (1 - alpha);
    double c[5];
    for (int k = 0; k < 5; k++)
        c[k] = wide[k] + t * (narrow[k] - wide[k]);
    return c[0] / (1 + c[1] * pow(x, c[2])) + c[3] * x + c[4];
}

static double sheen_lambda(double cosine, double alpha)
{
    return exp(cosine < 0.5 ? fitted(cosine, alpha) : 2 * fitted(0.5, alpha) - fitted(1 - cosine, alpha));
}

static float sheen_value(double alpha, double cos_o, double cos_i, double cos_h)
{
    const double sine = sqrt(fmax(0, 1 - cos_h * cos_h)), d = (2 + 1 / alpha) * pow(sine, 1 / alpha) / (2 * PI);
    return (float)(d / ((1 + sheen_lambda(cos_o, alpha) + sheen_lambda(cos_i, alpha)) * 4 * cos_o));
}

Rgb coating_eval(const Coating *l, Vec3 normal, Vec3 wo, Vec3 wi, float *pdf)
{
    Rgb sum = rgb_grey(l->coat.weight > 0 && l->coat.alpha > 0 ? coat_value(l, wo, wi, pdf) : 0);
    const double cos_i = vec_dot(wi, normal);
    if (rgb_is_black(l->sheen.color) || cos_i <= 0)
        return sum;
    const double cos_o = fmax(vec_dot(wo, normal), LEAST_COSINE);
    const double cos_h = vec_dot(vec_normalize(vec_add(wi, wo)), normal);
    *pdf += l->sheen.p * (float)(cos_i / PI);
    return rgb_add(sum, rgb_scale(l->sheen.color, sheen_value((double)l->sheen.alpha, cos_o, cos_i, cos_h)));
}
