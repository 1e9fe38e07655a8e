/* The state of a path and of its vertices, and the steps that a path is made of; private to this room. */
#ifndef RENDERER_PATH_INTERNAL_H
#define RENDERER_PATH_INTERNAL_H

#include "base/color4.h"
#include "camera/camera.h"
#include "path/leaves.h"
#include "path/caustics_kernel.h"
#include "path/context.h"
#include "path/vertex_samples.h"

#define STRAIGHT_MAX 128 /* surfaces a path or shadow ray may pass without bending */
#define SHARP_PDF 25     /* per steradian: a bounce into a lobe no wider than about 7 degrees keeps things sharp */

/* Of a path that may meet light sources, as caustics are found: bits of CAUSTICS_… by which it was bent, and that it
 * left a surface which scatters widely and met only what throws caustics since. */
enum { SPECULAR_BEGINS = 4 };

typedef struct Path {
    Float4 beta;        /* throughput */
    float beta_neutral; /* throughput with NEUTRAL_ALBEDO everywhere and without the eta scale: for Russian roulette */
    int leaving;        /* the ray ends where light comes out that went below a surface */
    float wavelength;   /* since light was dispersed, see shade/dispersion.h; -1: not yet */
    float pdf;          /* with which the ray's direction was sampled, per steradian; 0 after a delta lobe */
    LightSampleContext prev_context; /* of the vertex where it was sampled: for MIS */
    int segments, straight;          /* so far; straight: surfaces that did not bend the path, which end no segment */
    int sharp;                       /* so far every bounce was specular, or nearly so */
    int delta;                       /* so far every bounce was in a delta lobe */
    RayKind kind;
    uint32_t key, sample; /* of its sample numbers: of seed and pixel; in its half of the pixel's */
    int half;
    int specular;                /* what bent it since it left a surface that scatters widely, see SPECULAR_… */
    const LightGroup *light_group; /* of that surface: which light sources shine on it */
    float source_scale;          /* of light sources that it meets; not 1 where a medium is seen that scattered it */
    Media media;
    Float4 media_weight;         /* what media did to throughput, its mean 1: scattering is sampled by it */
    double light[3];             /* sum of its contributions */
    double cut;                  /* luminance of those that it would have beyond the maximum depth */
    SplitPath split;             /* in sets */
    ControlPath *control;        /* in variants */
    FirstHits *first_hits;       /* of its pixel */
} Path;

/* A direct-light sample: a point on one light, chosen for a vertex before its shadow ray is traced. */
typedef struct DirectLightSample {
    int found;  /* 0: no light, or one that gives nothing here */
    int traced; /* visibility is known */
    Visibility visibility;
    LightSample light;
    Ray ray;         /* the shadow ray */
    int transmitted; /* it leaves on the other side of the surface */
    float pdf;       /* with which the BSDF and the guide would sample its direction */
    Factor factors[1 + LIGHT_FACTORS_MAX];
    int nfactors;
    FinishFactor finishes[FINISHES_MAX]; /* of the vertex, where it has several */
    FinishFactor variants[VARIANTS_MAX]; /* of the vertex, where textures have normal maps */
} DirectLightSample;

/* What scatters at a vertex on a target with finishes, by finish. */
typedef struct VertexFinishes {
    int count; /* 0: the surface's own is the only one */
    int shown; /* the one in the picture, whose BSDF the shading has too */
    int has_weights; /* 1: a texture has a map of finishes; the picture's have these, by variant: */
    float weights[VARIANTS_MAX][FINISHES_MAX];
    int has_normals; /* 1: a texture has a normal map; surfaces have these normals, by variant, along u and v and the
                        normal: they are no sums of finishes as in sets, which is what these are compared with */
    double normals[VARIANTS_MAX][3];
    Bsdf of[FINISHES_MAX];
} VertexFinishes;

/* Where a ray met the scene, and what is chosen there. */
typedef struct Vertex {
    int is_last; /* the path has no segment left: it goes on only where it passes straight */
    double distance;
    Shading s;
    ImagePlace place;
    const VertexSamples *numbers; /* of a packet; this vertex has one lane of it */
    int lane;
    int picked; /* pick is known */
    LightPick pick;
    DirectLightSample light;
    Texture white;            /* in place of the surface's own, where PathContext.white */
    VertexFinishes finishes;
    float wavelength;         /* that light has on the far side of a surface that disperses it; -1: none of its own */
    const CausticsCell *cell; /* of the guide to caustics; NULL: none here, or nothing scatters widely */
} Vertex;

/* ---- contributions.c: throughput, and light that reaches the film ---- */

/* d times the colour at a surface, plus i. */
Factor shading_factor(const Shading *s, Float4 d, Float4 i);
/* How the camera sees the factor at a path's current vertex. */
static inline void set_seen(Factor *factor, const Path *path)
{
    factor->sharp = path->sharp, factor->direct = path->segments == 1;
}
/* Copy a surface's colours by variant, for a factor that outlives its shading. NULL: the same in all. */
const Rgb *keep_albedos(const PathContext *context, Rgb *storage, const Shading *s);
void path_start(PathWorker *worker, Path *path, const Ray *ray, const Sampler *sampler);
/* Whether any light can come by it, whatever the textures are. */
static inline int path_is_alive(const PathWorker *w, const Path *path)
{
    const PathContext *c = w->context;
    if (c->split)
        return split_is_alive(&w->split, &path->split);
    int alive = !is_black4(path->beta);
    for (int v = 1; v < c->nvariants && !alive; v++)
        alive = !rgb_is_black(path->control->betas[v]);
    return alive;
}
/* Multiply throughput by what no texture changes. Returns path_is_alive. */
static inline int path_scale(PathWorker *w, Path *path, Rgb by)
{
    path->beta *= color4(by);
    split_scale(&w->split, &path->split, color4(by));
    for (int v = 1; v < w->context->nvariants; v++)
        path->control->betas[v] = rgb_mul(path->control->betas[v], by);
    return path_is_alive(w, path);
}
/* Multiply throughput by the factor of a surface, d times its colour plus i, or by finish where it has several (else
 * NULL; weights and variants as of Factor): in sets this may be a hit. Returns path_is_alive. */
int path_apply_factor(PathWorker *worker, Path *path, const Shading *s, Split weight, const FinishFactor *finishes,
                      const float (*weights)[FINISHES_MAX], const FinishFactor *variants, int reflects);
/* Hand a contribution to all sinks. */
void path_contribute(PathWorker *worker, Path *path, const Contribution *contribution);
/* Whether factors of this surface are never hits, so that they may be multiplied into throughput or light. */
static inline int surface_is_unsplit(const PathContext *c, const Shading *s)
{
    return !c->split || s->surface.target < 0;
}

/* ---- air.c: what is between surfaces ---- */

/* Whether what lies between is part of what the ray sees: not before white first hits, of which it is asked what comes
 * to them. */
static inline int path_is_seen(const PathContext *c, const Path *path, const Ray *ray)
{
    return camera_ray_exists(ray) && !(c->white && path->segments + path->straight == 1);
}
/* Fog along the ray, up to what it hits: its own light, and what it does to throughput. The same of rainbows, which
 * only rays see that no direction was sampled for. Returns path_is_alive. */
int path_pass_air(PathWorker *worker, Path *path, const Ray *ray, const Hit *hit);
/* What a shadow ray's light is multiplied by over a distance; source: NULL for other lights. */
Rgb air_transmittance(PathWorker *worker, const Path *path, const Media *media, const Ray *ray, double distance,
                      const Light *source);

/* ---- media_path.c: participating media ---- */

typedef enum MediumEvent { MEDIUM_PASSED, MEDIUM_SCATTERED, MEDIUM_ENDED } MediumEvent;
/* Media along the ray, up to what it hits: their emission, what they scatter of light sources, and what they do to
 * throughput. Where the path is scattered on the way the ray is the next one. */
MediumEvent path_cross_media(PathWorker *worker, Path *path, Ray *ray, const Hit *hit);

/* media.c: of a shadow ray. with_air: what fills the air counts too. */
Rgb media_transmittance(PathWorker *worker, const Path *path, const Media *media, const Ray *ray, double distance,
                        int with_air);

/* ---- shadow_ray.c: visibility ---- */

/* What fading interiors do to light over a distance, up to a surface or NULL. */
Rgb media_fade(const Media *media, double distance, const Surface *met);
/* A ray passes through a surface: it enters or leaves an interior. */
void media_cross(Media *media, const Surface *surface);
/* Trace the shadow ray of a direct-light sample. The sky's radiance is looked up here; what dims light goes into
 * the sample's radiance and, where targets do it, into factors. Returns how many of these there are, or -1 where the
 * light is not visible. */
int trace_shadow_ray(PathWorker *worker, const Path *path, const Surface *from, DirectLightSample *light,
                     Factor *factors, int most_factors);
/* Density with which the path itself, going on along the shadow ray, would find the light, where pdf is that of the
 * direction: 0 where it cannot, as paths and shadow rays may see different primitives. -1: no light comes that way. */
float path_pdf_of_light(const PathContext *context, const Ray *ray, RayKind kind, const LightSample *light, float pdf);

/* ---- vertex.c: what is chosen at a surface ---- */

LightSampleContext light_sample_context(const Shading *s);
/* An emitter's radiance is a factor of its pigment, with radiance 1. Returns the number of factors. */
int emitter_factors(PathWorker *worker, const Path *path, int lane, LightSample *light, Factor *factors);
static inline int light_factors(PathWorker *w, const Path *path, int lane, LightSample *light, Factor *factors)
{
    return light_sample_is_shape(light) ? emitter_factors(w, path, lane, light, factors) : 0;
}
/* Where a shadow ray ends: just before the light, as seen from the ray's origin beside the vertex. */
static inline double shadow_ray_end(Vec3 position, const LightSample *light)
{
    double distance = light->source ? light->shadow_distance : light->distance;
    if (!isfinite(distance))
        return INFINITY;
    double margin = accel_margin(position), end = distance * (1 - 1e-6) - margin;
    if (light_sample_is_shape(light)) {
        /* The flatter the angle, the earlier the ray meets the emitter's surface. */
        double slope = fabs(vec_dot(light->direction, light->surface.geometric_normal));
        end -= (margin + accel_margin(light->surface.position)) / (slope > 1e-3 ? slope : 1e-3);
    }
    return end > 0 ? end : 0; /* Embree takes an end below 0 for a ray that is blocked */
}
/* Emitted radiance over albedo: only the opaque share of a surface emits. */
Split surface_emission(const Shading *s);
const CausticsCell *guide_cell(const PathContext *context, const Vertex *vertex);
void sample_direct_light(PathWorker *worker, const Path *path, Vertex *vertex);
/* Sample a direction by the BSDF or by the guide: first between delta lobes and the rest. The sample's weight and
 * density are the BSDF's own; *pdf gets the density of both together. weights: of each finish, where there are
 * several. */
int sample_direction(const Vertex *vertex, BsdfSample *sample, Split weights[FINISHES_MAX], float *pdf);

/* ---- finishes.c: vertices on targets with finishes ---- */

/* Make the BSDFs of all finishes, once the shading is known but for its own; that becomes the one shown. */
void finishes_setup(Vertex *vertex, const Scene *scene, const RenderVariant *variants, int nvariants, Vec3 wo);
/* As bsdf_eval, with one finish: of what is shown, and by finish; the density is the mean of theirs, by which finishes_
 * sample samples. */
Split finishes_eval(const Vertex *vertex, Vec3 wi, BsdfLight light, Split values[FINISHES_MAX], float *pdf);
int finishes_sample(const Vertex *vertex, float u_lobe, float u1, float u2, BsdfSample *sample,
                    Split weights[FINISHES_MAX]);
/* Where textures have normal maps: what is shown, by variant, over the density of the direction, times a number.
 * by_finish: of a direction that a delta lobe reflects, its weights by finish, which no normal map changes; else
 * NULL. Returns NULL where all have the same, else out. */
const FinishFactor *finishes_variants(const Vertex *vertex, Vec3 wi, BsdfLight light, float pdf, float times,
                                      const FinishFactor *by_finish, int nvariants, FinishFactor out[VARIANTS_MAX]);
/* As bsdf_wide_probability and split_neutral, their means. */
float finishes_wide_probability(const Vertex *vertex);
float finishes_neutral(const Vertex *vertex, const Split weights[FINISHES_MAX]);

static inline float mis_weight(float a, float b)
{
    float ratio = b / a; /* the squares of densities may be too large for a float */
    return 1 / (1 + ratio * ratio);
}

/* ---- leaf_choice.c: trees of textures ---- */

/* Choose a leaf at a path's vertex. What the layers above do to light goes into the path's throughput. */
void choose_leaf(PathWorker *worker, Path *path, Shading *s, Vec3 wo);
/* What a direct-light sample's light is multiplied by: its colour, and factors of targets. */
typedef struct LightFactors {
    Rgb *light;
    Factor *factors;
    int count, most;
    Rgb (*storage)[VARIANTS_MAX]; /* a row of albedos for each factor */
} LightFactors;

/* Add the factor of a surface. Returns 0 where there are too many. */
static inline int light_factors_add(const PathContext *c, LightFactors *to, Factor factor, const Shading *s)
{
    if (to->count == to->most)
        return 0;
    factor.albedos = keep_albedos(c, to->storage[to->count], s);
    to->factors[to->count++] = factor;
    return 1;
}
/* The same for an emitter that is sampled, and for a surface on a shadow ray, of which leaves that let light pass are
 * looked at: returns 0 where there is none. What the leaf and the layers above it do goes to the light's factors. */
int choose_leaf_of_light(PathWorker *worker, const Path *path, Shading *s, Vec3 wo, int passing, unsigned texture,
                         LightFactors *to);

/* ---- dispersion.c ---- */

/* At a vertex whose BSDF is that of all wavelengths, where shading_disperses. */
void disperse(PathWorker *worker, Path *path, Vertex *vertex, Vec3 wo);
/* From here on the path has one wavelength, by which its throughput is coloured. */
void path_take_wavelength(PathWorker *worker, Path *path, float wavelength);

/* ---- subsurface.c ---- */

/* Go below the surface along a direction: the ray gets one that ends where light comes out. */
void walk_below_surface(PathWorker *worker, Path *path, const Vertex *vertex, Vec3 direction, Ray *ray);
/* Make the surface there one that scatters outwards. */
void leave_surface(Vertex *vertex);

/* ---- path.c: the steps of a path, in their order; packet.c takes the same ones ---- */

/* Find the colours at a vertex whose surface is known, then what scatters there. */
void find_colors(PathWorker *worker, Path *path, Vertex *vertex, const Ray *ray, const Hit *hit,
                 const VertexSamples *numbers, int lane);
void find_bsdf(PathWorker *worker, Path *path, Vertex *vertex, const Ray *ray, const Hit *hit);
void observe_first_hit(PathWorker *worker, const Path *path, const Vertex *vertex, const Ray *ray, const Hit *hit);
/* Add the emission that the ray meets, of a surface or of the sky. Returns 0 where the path ends. */
int add_emission(PathWorker *worker, Path *path, const Vertex *vertex, const Ray *ray, const Hit *hit);
/* Add the light of the vertex's direct-light sample, if it has one. */
void add_direct_light(PathWorker *worker, Path *path, Vertex *vertex);
/* Sample the BSDF, multiply throughput, and make the ray to go on with. Returns 0 where the path ends. */
int scatter(PathWorker *worker, Path *path, const Vertex *vertex, BsdfSample *next, Ray *ray);
/* Multiply throughput by the weight of a BSDF sample. Returns path_is_alive. */
static inline int path_apply_weight(PathWorker *w, Path *path, const Shading *s, Split weight,
                                    const FinishFactor *finishes, const float (*weights)[FINISHES_MAX],
                                    const FinishFactor *variants, int reflects)
{
    if (surface_is_unsplit(w->context, s) && !s->replaced)
        return path_scale(w, path, split_apply(weight, shading_albedo(s, 0)));
    return path_apply_factor(w, path, s, weight, finishes, weights, variants, reflects);
}
/* Begin the next segment, whose direction was sampled with density pdf, of which the BSDF's own share is bsdf_pdf. */
static inline void path_next_segment(Path *path, float pdf, float bsdf_pdf)
{
    path->pdf = pdf;
    if (bsdf_pdf > 0)
        path->sharp &= bsdf_pdf > SHARP_PDF, path->delta = 0;
    path->segments++;
}
int survives_roulette(PathWorker *worker, Path *path, float u);
/* Trace one path from the camera to its end. */
void trace_path(PathWorker *worker, Path *path, Ray ray);

#endif
