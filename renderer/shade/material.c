/* From a finish to a BSDF: what POV-Ray's keywords mean to a path tracer. Described for users in retex-scene(5),
 * section FINISH AND PHYSICS; keep the two in step. */
#include "pattern/pattern.h"
#include "shade/dispersion.h"
#include "shade/fresnel.h"
#include "shade/material.h"
#include "shade/normal.h"
#include "shade/pigment.h"

#define LEAST_COSINE 1e-4  /* between a normal and where it is seen from */
#define SMOOTH_ALPHA 1e-3f /* below this width a microfacet lobe is a delta */

static float clamp01(double x)
{
    return (float)(x < 0 ? 0 : x > 1 ? 1 : x);
}

/* At most `left` of the light is reflected by them. Their amounts, times share, are the peaks in POV-Ray's pictures. */
static void setup_highlights(Bsdf *b, const Finish *f, double share, float left)
{
    double n = fmax(0, 1 / fmax(f->roughness, 1e-6)), p = fmax(0, f->phong_size);
    /* What a highlight of amount 1 reflects, seen head-on: the integral of its power. With `albedo`, what it reflects
     * is written in place of the amount. */
    double per_blinn = 4 * (2 - exp2(-n / 2)) / (n + 2), per_phong = 2 / (p + 1);
    double blinn = share * fmax(0, f->specular_albedo ? f->specular / per_blinn : f->specular);
    double phong = share * fmax(0, f->phong_albedo ? f->phong / per_phong : f->phong);
    double of_blinn = blinn * per_blinn, of_phong = phong * per_phong, sum = of_blinn + of_phong;
    if (!(sum > 0))
        return;
    double scale = sum > (double)left ? (double)left / sum : 1;
    b->highlights = (float)(sum * scale);
    b->blinn = (Highlight){(float)(blinn * scale), (float)n, (float)(of_blinn / sum)};
    b->phong = (Highlight){(float)(phong * scale), (float)p, (float)(of_phong / sum)};
    b->highlight_metallic = clamp01(f->metallic);
}

/* `reflection`: from the minimum seen head-on to the maximum at grazing angles, by Fresnel's equations or POV-Ray's
 * falloff curve. */
static void setup_mirror(Bsdf *b, const Finish *f, int transparent)
{
    if (!finish_is_mirror(f) && !(transparent && b->refracts))
        return; /* most surfaces: spares them powf */
    float rise = f->reflection_fresnel ? fresnel_dielectric((float)b->cos_o, b->eta)
                                       : powf(1 - (float)b->cos_o, (float)f->reflection_falloff);
    Rgb r = rgb_lerp(f->reflection_min, f->reflection_max, rise);
    if (transparent && b->refracts && fresnel_dielectric((float)b->cos_o, b->eta) >= 1)
        r = rgb_grey(1);
    r = rgb(clamp01(r.r), clamp01(r.g), clamp01(r.b));
    float metallic = clamp01(f->reflection_metallic);
    b->mirror = metallic_tint((Split){rgb_scale(r, metallic), rgb_scale(r, 1 - metallic)}, (float)b->cos_o);
}

/* How thick the film is at a point, over its thickness without turbulence, by POV-Ray's formula. */
static float film_thickness(const Finish *f, Vec3 p)
{
    static const Turbulence octaves = {.lambda = 2, .omega = 0.5, .octaves = 5};
    if (f->irid_turbulence == 0)
        return 1;
    return (float)(1 + f->irid_turbulence * (2 * turbulence_value(&octaves, f->irid_noise, p) - 1));
}

/* mirror: what it may reflect without the film. */
static void setup_film(Bsdf *b, const Finish *f, Vec3 p, float mirror)
{
    b->irid = at_most((float)f->irid, 1);
    b->irid_phase = rgb_scale(f->irid_phase, film_thickness(f, p));
    float most = rgb_max(split_apply(b->mirror, rgb_grey(1)));
    Rgb factor = rgb_scale(bsdf_irid(b, (float)b->cos_o), most > mirror ? mirror / most : 1);
    b->mirror = (Split){rgb_mul(b->mirror.d, factor), rgb_mul(b->mirror.i, factor)};
}

/* The brightest component of the pigment, as far as opacity tells it (see pigment_opacity); 1 is the most. */
static float brightness(float filter, float transmit, float opacity)
{
    return opacity == clamp01(1 - filter - transmit) ? 1 : clamp01((1 - transmit - opacity) / filter);
}

/* No surface gives back more light than it gets: what the mirror (specular, by channel) and highlights reflect is taken
 * first, and what is below has the rest. Its share for a pigment of that brightness is at most 1, or `diffuse` where
 * that is more: then the pigment is dark. gain: the most by which a film brightens reflected light. */
static void limit_energy(Bsdf *b, const Finish *f, Rgb specular, float gain, float bright)
{
    float grow = 2 / (b->brilliance + 1), most = fmaxf(1, (float)fmax(f->diffuse, f->diffuse_back));
    float reflected = (b->diffuse + b->diffuse_back) * bright * grow * gain, scale = 1;
    const Rgb passing = split_apply(b->passing, rgb_grey(bright));
    if (reflected + rgb_max(passing) <= not_negative(1 - rgb_max(specular) * gain) * most)
        return; /* most surfaces */
    const float specular_of[3] = {specular.r, specular.g, specular.b},
                passing_of[3] = {passing.r, passing.g, passing.b};
    for (int c = 0; c < 3; c++) {
        const float sum = reflected + passing_of[c], left = not_negative(1 - specular_of[c] * gain) * most;
        scale = sum > left ? fminf(scale, left / sum) : scale;
    }
    b->diffuse *= scale, b->diffuse_back *= scale, b->grain *= scale;
    b->passing = (Split){rgb_scale(b->passing.d, scale), rgb_scale(b->passing.i, scale)};
}

static Rgb specular_by_channel(const Bsdf *b, Rgb mirrored, float most)
{
    const Rgb m = rgb(at_most(mirrored.r, most), at_most(mirrored.g, most), at_most(mirrored.b, most));
    const float h = b->highlights;
    return b->highlight_lights_only ? rgb(fmaxf(m.r, h), fmaxf(m.g, h), fmaxf(m.b, h)) : rgb(m.r + h, m.g + h, m.b + h);
}

/* `double_illuminate`: light from behind counts as light from the front. */
static double diffuse_from_behind(const Finish *f, const Primitive *primitive)
{
    return primitive->double_illuminate ? fmax(f->diffuse, f->diffuse_back) : f->diffuse_back;
}

static void setup_povray(Bsdf *b, const Surface *surface, float filter, float transmit, float opacity)
{
    const Finish *f = surface->texture->finish;
    float gain = f->irid > 0 ? 1 + at_most((float)f->irid, 1) : 1;
    b->brilliance = not_negative((float)f->brilliance);
    float norm = f->diffuse_albedo ? (b->brilliance + 1) / 2 : 1;
    b->diffuse = (float)fmax(0, f->diffuse) * opacity * norm;
    b->diffuse_back = (float)fmax(0, diffuse_from_behind(f, surface->primitive)) * opacity * norm;
    b->grain = (float)fmax(0, f->crand) / 2;
    setup_mirror(b, f, opacity < 1);
    if (f->use_alpha)
        b->mirror = (Split){rgb_scale(b->mirror.d, opacity), rgb_scale(b->mirror.i, opacity)};
    const Rgb mirrored = split_apply(b->mirror, rgb_grey(1));
    float mirror = at_most(rgb_max(mirrored), 1 / gain);
    b->highlight_lights_only = finish_is_mirror(f);
    setup_highlights(b, f, f->use_alpha ? (double)opacity : 1, 1 / gain - (b->highlight_lights_only ? 0 : mirror));
    /* Mirrored light does not pass: POV-Ray does so with conserve_energy only. */
    const Rgb passes = rgb(1 - clamp01(mirrored.r), 1 - clamp01(mirrored.g), 1 - clamp01(mirrored.b));
    b->passing = (Split){rgb_scale(passes, filter), rgb_scale(passes, transmit)};
    limit_energy(b, f, specular_by_channel(b, mirrored, 1 / gain), gain, brightness(filter, transmit, opacity));
    if (gain > 1)
        setup_film(b, f, surface->position, mirror);
    if (!surface->backside && finish_is_subsurface(f))
        b->subsurface = b->diffuse, b->diffuse = 0;
}

/* A number of the extension block: the same everywhere, or varied over the surface by a map. */
static float map_value(double value, const Pigment *map, const Surface *surface)
{
    const Rgbft c = pigment_eval_on(map, surface);
    return clamp01(value * (double)rgb_luminance(rgb(c.r, c.g, c.b)));
}

static inline float mapped(double value, const Pigment *map, const Surface *surface)
{
    return map ? map_value(value, map, surface) : clamp01(value);
}

/* The extension block: the supplement's simplified Disney BSDF, its dielectric share and cut-outs by image alpha. */
static void setup_disney(Bsdf *b, const Finish *f, const Surface *surface, float filter, float transmit, float opacity)
{
    b->metallic = mapped(f->retex.metallic, f->retex.metallic_map, surface);
    float a = mapped(f->retex.transmission, f->retex.transmission_map, surface) * (1 - b->metallic);
    opacity = a > 0 ? 1 : opacity; /* a finish that transmits ignores the pigment here */
    b->coverage = opacity;
    b->disney = 1;
    b->roughness = mapped(f->retex.roughness, f->retex.roughness_map, surface);
    b->specular_tint = clamp01(f->retex.specular_tint);
    b->coat_eta = (float)f->retex.ior;
    b->transmission = a;
    b->diffuse = (1 - b->metallic) * (1 - a) * opacity;
    float alpha = b->roughness * b->roughness;
    b->smooth = alpha < SMOOTH_ALPHA;
    if (b->smooth) {
        b->alpha = 0;
        float m = b->metallic, w = powf(1 - (float)b->cos_o, 5), f0 = (b->coat_eta - 1) / (b->coat_eta + 1);
        float r0 = (1 - m) * f0 * f0 * b->specular_tint, outer = fresnel_dielectric((float)b->cos_o, b->eta);
        float indep = (1 - m) * fresnel_dielectric((float)b->cos_o, b->coat_eta) + m * (r0 + (1 - r0) * w);
        b->mirror.i = rgb_grey(opacity * ((1 - a) * indep + a * outer));
        b->mirror.d = rgb_grey(opacity * (1 - a) * m * m * (1 - w));
        if (a > 0)
            b->passing.d = rgb_grey(a * (1 - outer));
    } else {
        b->alpha = alpha;
        if (b->eta == 1)
            b->passing.d = rgb_grey(a); /* index 1: no refraction, however rough */
    }
    if (a == 0 && opacity < 1)
        b->passing = (Split){rgb_grey(filter), rgb_grey(transmit)}, b->refracts = 0;
}

/* Estimate of the reflectance of the microfacet lobe at cos_o, for the probability of sampling it. */
static float glossy_estimate(const Bsdf *b)
{
    if (b->alpha <= 0)
        return 0;
    float m = b->metallic, f = fresnel_dielectric((float)b->cos_o, b->coat_eta);
    const float reflectance = (1 - m) * f + m * m * NEUTRAL_ALBEDO + m * (1 - m) * 0.04f;
    return (reflectance > 0.02f ? reflectance : 0.02f) * (1 - b->transmission) * b->coverage;
}

/* The colours of the extension's sheen: the same everywhere, or times a map. */
static Rgb sheen_color(const Finish *f, const Surface *surface)
{
    Rgb color = f->retex.sheen;
    if (f->retex.sheen_map) {
        const Rgbft c = pigment_eval_on(f->retex.sheen_map, surface);
        color = rgb_mul(color, rgb(c.r, c.g, c.b));
    }
    return rgb(clamp01(color.r), clamp01(color.g), clamp01(color.b));
}

/* The normal of the coat is not that of the bumps below it. Towards one that faces away nothing is reflected. */
static Vec3 coat_normal(const Finish *f, const Surface *surface, Vec3 wo)
{
    Vec3 normal, geometric;
    bsdf_normals(surface, wo, &normal, &geometric);
    if (!f->retex.clearcoat_normal)
        return normal;
    const Vec3 tilted = normal_tilted(f->retex.clearcoat_normal, surface, normal, vec_neg(wo));
    return vec_dot(wo, tilted) > LEAST_COSINE ? tilted : normal;
}

static int finish_has_coating(const Finish *f)
{
    return f->retex.clearcoat > 0 || !rgb_is_black(f->retex.sheen);
}

/* of_coat, of_sheen: what they reflect. Glass has them on its outside. */
static __attribute__((noinline)) void setup_coating(Bsdf *b, const Finish *f, const Surface *surface, float *of_coat,
                                                    float *of_sheen)
{
    const CoatingNumbers numbers = {
        .clearcoat = mapped(f->retex.clearcoat, f->retex.clearcoat_map, surface),
        .clearcoat_roughness = mapped(f->retex.clearcoat_roughness, f->retex.clearcoat_roughness_map, surface),
        .sheen = sheen_color(f, surface),
        .sheen_roughness = clamp01(f->retex.sheen_roughness),
        .coverage = b->coverage,
        .coat_normal = coat_normal(f, surface, b->wo),
        .normal = bsdf_surface_normal(b),
        .wo = b->wo,
    };
    if (surface->backside && finish_transmits(f))
        return;
    coating_set(&b->coating, &numbers, of_coat, of_sheen);
    const float under = b->coating.under;
    b->mirror = (Split){rgb_scale(b->mirror.d, under), rgb_scale(b->mirror.i, under)};
    if (b->transmission > 0) /* else it passes by holes, where no coat is */
        b->passing = (Split){rgb_scale(b->passing.d, under), rgb_scale(b->passing.i, under)};
}

static void setup_choice(Bsdf *b, float of_coat, float of_sheen)
{
    float glossy = b->disney ? glossy_estimate(b) : b->highlight_lights_only ? 0 : b->highlights;
    if (b->disney && !b->smooth && b->eta != 1)
        glossy += b->transmission;
    float w[6] = {b->diffuse * NEUTRAL_ALBEDO, b->diffuse_back * NEUTRAL_ALBEDO, glossy,
                  split_neutral(b->mirror),    split_neutral(b->passing),        b->subsurface * NEUTRAL_ALBEDO};
    if (b->coating.present) /* mirror and passing are scaled already */
        w[0] *= b->coating.under, w[1] *= b->coating.under, w[2] *= b->coating.under;
    float sum = w[0] + w[1] + w[2] + w[3] + w[4] + w[5] + of_coat + of_sheen;
    if (!(sum > 0))
        return;
    if (b->coating.present)
        b->coating.coat.p = of_coat / sum, b->coating.sheen.p = of_sheen / sum;
    b->p_diffuse = w[0] / sum, b->p_back = w[1] / sum, b->p_glossy = w[2] / sum;
    b->p_mirror = w[3] / sum, b->p_passing = w[4] / sum, b->p_subsurface = w[5] / sum;
}

static void setup_lambert(Bsdf *b, const Finish *f, const Primitive *primitive)
{
    const double behind = diffuse_from_behind(f, primitive);
    float diffuse = f->diffuse > 0 ? (float)f->diffuse : 0, back = behind > 0 ? (float)behind : 0;
    b->lambert = 1, b->disney = 0, b->alpha = b->transmission = b->highlights = 0;
    b->passing = (Split){{0, 0, 0}, {0, 0, 0}};
    b->p_glossy = b->p_mirror = b->p_passing = b->p_diffuse = b->p_back = 0;
    float sum = diffuse + back, scale = fmaxf(1, fmaxf(diffuse, back)) / sum; /* see limit_energy */
    if (scale < 1)
        diffuse *= scale, back *= scale, sum *= scale;
    b->diffuse = diffuse, b->diffuse_back = back;
    if (sum > 0)
        b->p_diffuse = diffuse / sum, b->p_back = back / sum;
}

void bsdf_normals(const Surface *surface, Vec3 wo, Vec3 *normal, Vec3 *geometric)
{
    *geometric = surface->backside ? vec_neg(surface->geometric_normal) : surface->geometric_normal;
    *normal = surface->backside ? vec_neg(surface->shading_normal) : surface->shading_normal;
    if (vec_dot(wo, *normal) <= LEAST_COSINE) /* the interpolated normal faces away: fall back on the surface's own */
        *normal = *geometric;
}

/* A slope that faces away from the viewer is hidden: the opposite slope of the same groove is seen, which is tilted as
 * much towards the viewer (Torrance and Sparrow's V-cavities). */
static void set_bumps(Bsdf *b, const Surface *surface)
{
    const Vec3 n = normal_tilted(surface->texture->normal, surface, b->normal, vec_neg(b->wo));
    b->hidden = vec_dot(n, b->wo) <= 0;
    b->normal = b->diffuse_normal = n;
    if (!b->hidden)
        return;
    const Vec3 across = vec_normalize(vec_mad(b->wo, b->geometric, -vec_dot(b->wo, b->geometric)));
    const Vec3 opposite = vec_mad(n, across, -2 * vec_dot(n, across));
    b->normal = vec_dot(opposite, b->wo) > LEAST_COSINE ? opposite : b->geometric;
}

static void set_side(Bsdf *b, const Surface *surface, Vec3 wo)
{
    b->wo = wo;
    bsdf_normals(surface, wo, &b->normal, &b->geometric);
    b->bumped = surface->texture->normal != NULL;
    if (b->bumped)
        set_bumps(b, surface);
    b->cos_o = vec_dot(wo, b->normal);
    b->cos_o = b->cos_o > LEAST_COSINE ? b->cos_o : LEAST_COSINE;
    b->cos_o = b->cos_o < 1 ? b->cos_o : 1;
}

static void setup(Bsdf *b, const Surface *surface, Vec3 wo, float filter, float transmit, float opacity,
                  double ior_scale)
{
    const Finish *finish = surface->texture->finish;
    const Interior *interior = surface->primitive->interior;
    const int transmits = finish_transmits(finish), transparent = filter + transmit > 0 || transmits;
    const double ior = (transmits ? finish->retex.ior : interior_bends(interior) ? interior->ior : 1) * ior_scale;
    int lambert = !transparent && finish->lambert && !surface->texture->normal;
    if (!lambert)
        *b = (Bsdf){.brilliance = 1};
    set_side(b, surface, wo);
    b->refracts = ior != 1 || interior_disperses(interior);
    /* an opaque sheet has a coat on both sides */
    b->eta = b->bend = (float)(surface->backside && transparent ? 1 / ior : ior);
    if (lambert) {
        setup_lambert(b, finish, surface->primitive);
        return;
    }
    if (finish->retex.present)
        setup_disney(b, finish, surface, filter, transmit, opacity);
    else
        setup_povray(b, surface, filter, transmit, opacity);
    float of_coat = 0, of_sheen = 0;
    if (finish->retex.present && finish_has_coating(finish))
        setup_coating(b, finish, surface, &of_coat, &of_sheen);
    setup_choice(b, of_coat, of_sheen);
    if (b->alpha > 0)
        vec_frame(b->normal, &b->s, &b->t);
}

void bsdf_setup(Bsdf *b, const Surface *surface, Vec3 wo, float filter, float transmit, float opacity)
{
    setup(b, surface, wo, filter, transmit, opacity, 1);
}

void bsdf_setup_wavelength(Bsdf *b, const Surface *surface, Vec3 wo, float filter, float transmit, float opacity,
                           double wavelength)
{
    const double scale = dispersion_scale(surface->primitive->interior->dispersion, wavelength);
    setup(b, surface, wo, filter, transmit, opacity, scale);
}

void bsdf_stop_passing(Bsdf *b)
{
    const float rest = 1 - b->p_passing, scale = rest > 0 ? 1 / rest : 0;
    b->passing = (Split){{0, 0, 0}, {0, 0, 0}};
    b->p_passing = 0;
    b->p_diffuse *= scale, b->p_back *= scale, b->p_glossy *= scale, b->p_mirror *= scale;
    b->p_subsurface *= scale;
    b->coating.coat.p *= scale, b->coating.sheen.p *= scale;
}
