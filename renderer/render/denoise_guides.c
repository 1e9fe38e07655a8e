/* Guides for denoising: albedo, normal and coverage of each pixel. See denoise_guides.h. */
#include <stdlib.h>
#include "render/denoise_guides.h"

#define MORE_SAMPLES 4          /* times as many sample points where the first do not all see the same surface */
#define ONE_NORMAL 0.999        /* minimum length of the mean normal for normals that count as equal */
#define ONE_ALBEDO 1e-4         /* maximum variance of luminance for albedos that count as equal */
#define SPECULAR_BOUNCES_MAX 16 /* specular reflections and refractions along a ray, at most */

/* Sums over those sample points of a pixel that see a surface. */
typedef struct SurfaceSums {
    int samples;
    Vec3 normal, position;
} SurfaceSums;

/* Begins with zeros. */
struct PixelGuides {
    const DenoiseGuides *guides;
    int samples, varied;                 /* so far; varied: they do not all see the same surface */
    SurfaceSums first, seen;             /* at first hits; at the first hits that are neither mirror nor clear glass */
    int specular;                        /* sample points whose first hit is a mirror or clear glass */
    double luminance, luminance_squared; /* of the albedos */
    const Instance *instance;            /* as in Hit, as what follows */
    int primitive, varied_primitive;     /* that the first point sees; 1: another point sees another one */
    Rgb albedo;
    double roughness, metallic;
    double cover[RETEX_MAX_TARGETS];
};

/* Of a surface, the mean of its texture's leaves. */
typedef struct SeenMean {
    const DenoiseGuides *job;
    Rgb albedo; /* known_albedo */
    float roughness, metallic;
    float cover[RETEX_MAX_TARGETS]; /* share of the leaves that are the target, or below a layer that is */
} SeenMean;

static void add_surface(SurfaceSums *surface, const Shading *s)
{
    surface->samples++;
    surface->normal = vec_add(surface->normal, bsdf_surface_normal(&s->bsdf));
    surface->position = vec_add(surface->position, s->surface.position);
}

/* Albedo of a surface. A target's albedo is unknown, because the target may be retextured. */
static Rgb known_albedo(const DenoiseGuides *job, const Shading *s)
{
    return job->split && s->surface.target >= 0 ? rgb_grey(1) : shading_albedo(s, 0);
}

static void add_leaf(void *context, const SeenLeaf *leaf)
{
    SeenMean *mean = context;
    const int known = !(mean->job->split && leaf->targets);
    mean->albedo = rgb_add(mean->albedo, rgb_scale(known ? leaf->albedo : rgb_grey(1), leaf->share));
    mean->roughness += leaf->share * shading_roughness(&leaf->s);
    mean->metallic += leaf->share * shading_metallic(&leaf->s);
    for (int t = 0; t < mean->job->window.scene->ntargets; t++)
        mean->cover[t] += leaf->targets >> t & 1 ? leaf->share : 0;
}

static SeenMean mean_seen(const DenoiseGuides *job, const Shading *s, const Ray *ray, const Hit *hit)
{
    SeenMean mean = {.job = job};
    if (s->is_leaf) {
        shading_each_leaf(job->window.scene, job->window.variants, ray, hit, add_leaf, &mean);
        return mean;
    }
    mean.albedo = known_albedo(job, s);
    mean.roughness = shading_roughness(s), mean.metallic = shading_metallic(s);
    if (s->surface.target >= 0)
        mean.cover[s->surface.target] = 1;
    return mean;
}

/* 1 if the surface emits light: its pigment is not an albedo. */
static int is_emitter(const Shading *s)
{
    return rgb_luminance(s->surface.texture->finish->emission) > s->bsdf.diffuse;
}

static void add_albedo(PixelGuides *sums, Rgb albedo)
{
    double l = rgb_luminance(albedo);
    sums->albedo = rgb_add(sums->albedo, albedo);
    sums->luminance += l, sums->luminance_squared += l * l;
}

static void add_seen(PixelGuides *sums, const Shading *s, const SeenMean *mean)
{
    add_surface(&sums->seen, s);
    add_albedo(sums, is_emitter(s) ? rgb_grey(1) : mean->albedo);
    sums->roughness += mean->roughness;
    sums->metallic += mean->metallic;
}

/* Continue the ray by specular reflection or refraction, if that lobe is the most likely one. The throughput is
 * multiplied by the lobe's weight. Returns 0 if the surface itself is seen. */
static int continue_specular(const SeenMean *mean, const Shading *s, const Hit *hit, Ray *ray, RayKind *kind,
                             float *throughput)
{
    const Bsdf *b = &s->bsdf;
    int mirror = b->p_mirror > b->p_passing;
    float likely = mirror ? b->p_mirror : b->p_passing;
    BsdfSample next;
    if (!(likely > fmaxf(b->p_diffuse, fmaxf(b->p_back, b->p_glossy))))
        return 0;
    if (!bsdf_sample(b, mirror ? likely / 2 : b->p_mirror + likely / 2, 0, 0, &next))
        return 0;
    *throughput *= fminf(1, rgb_luminance(split_apply(mirror ? b->mirror : b->passing, mean->albedo)));
    if (next.straight) {
        ray->tmin = hit->t;
        return 1;
    }
    *kind = path_next_kind(*kind, b, next.transmitted);
    *ray = (Ray){accel_offset(s->surface.position, s->surface.geometric_normal, next.wi), next.wi, 0, INFINITY};
    return 1;
}

/* Add the coverage of targets at their first hits along the ray, also if they are specular. */
static void add_cover(double cover[RETEX_MAX_TARGETS], unsigned *met, const SeenMean *mean, float throughput)
{
    for (int t = 0; t < mean->job->window.scene->ntargets; t++)
        if (mean->cover[t] > 0 && !(*met >> t & 1)) {
            cover[t] += throughput * mean->cover[t];
            *met |= 1u << t;
        }
}

/* Record the primitive that a sample point sees; -1: none. */
static void record_primitive(PixelGuides *sums, int primitive, const Instance *instance)
{
    if (sums->samples++ == 0)
        sums->primitive = primitive, sums->instance = instance;
    sums->varied_primitive |= primitive != sums->primitive || instance != sums->instance;
}

/* hit: the ray's first hit. first: the shading at that hit; not read if there is none. */
static void add_sample(PixelGuides *sums, Ray ray, Hit hit, const Shading *first)
{
    const DenoiseGuides *job = sums->guides;
    const FirstHitWindow *w = &job->window;
    RayKind kind = RAY_CAMERA;
    float throughput = 1;
    unsigned met = 0;
    Shading next;
    const Shading *s = first;
    SeenMean mean;
    for (int bounces = 0;; bounces++) {
        if (bounces ? !accel_intersect(w->accel, &ray, kind, &hit) : hit.primitive < 0) {
            add_albedo(sums, rgb_grey(1));
            record_primitive(sums, -1, NULL);
            return;
        }
        if (bounces > 0 || s->is_leaf) /* of first hits too, paths choose leaves at random */
            shading_at(&next, w->scene, w->variants, 1, &ray, &hit), s = &next;
        if (bounces == 0)
            add_surface(&sums->first, s);
        mean = mean_seen(job, s, &ray, &hit);
        add_cover(sums->cover, &met, &mean, throughput);
        if (bounces == SPECULAR_BOUNCES_MAX || !continue_specular(&mean, s, &hit, &ray, &kind, &throughput))
            break;
        sums->specular += bounces == 0;
    }
    add_seen(sums, s, &mean);
    record_primitive(sums, hit.primitive, hit.instance);
}

/* Destination of a pixel's guides. */
typedef struct GuidePixel {
    FilmPixel *pixel;
    int x, y;
} GuidePixel;

static void store(const GuidePixel *at, int image, double scale, double a, double b, double c)
{
    float *p = film_image_pixel(at->pixel, image, at->x, at->y);
    p[0] = (float)(a * scale), p[1] = (float)(b * scale), p[2] = (float)(c * scale);
}

/* Store one channel. Zeros are not written, so that memory pages without data are not allocated. */
static void store_channel(const GuidePixel *at, int image, double value)
{
    if (value != 0)
        *film_image_pixel(at->pixel, image, at->x, at->y) = (float)value;
}

static void store_surface(const GuidePixel *at, int normal, int position, const SurfaceSums *surface)
{
    if (!surface->samples)
        return;
    store(at, normal, 1.0 / surface->samples, surface->normal.x, surface->normal.y, surface->normal.z);
    store(at, position, 1.0 / surface->samples, surface->position.x, surface->position.y, surface->position.z);
}

static int has_one_normal(const SurfaceSums *surface)
{
    return surface->samples == 0 || vec_length(surface->normal) > ONE_NORMAL * surface->samples;
}

/* 1 if all sample points see the same surface. */
static int is_uniform(const PixelGuides *s)
{
    double mean = s->luminance / s->samples;
    return !s->varied_primitive && (s->first.samples == 0 || s->first.samples == s->samples) &&
           (s->specular == 0 || s->specular == s->samples) && has_one_normal(&s->first) && has_one_normal(&s->seen) &&
           s->luminance_squared / s->samples - mean * mean < ONE_ALBEDO;
}

int denoise_guides_observe(void *pixel, const Ray *ray, const Hit *hit, const Shading *shading)
{
    PixelGuides *p = pixel;
    if (denoise_guides_missing(p) == 0)
        return 0;
    add_sample(p, *ray, *hit, shading);
    if (p->samples == p->guides->samples)
        p->varied = !is_uniform(p);
    return denoise_guides_missing(p);
}

int denoise_guides_missing(const PixelGuides *p)
{
    return (p->varied ? MORE_SAMPLES : 1) * p->guides->samples - p->samples;
}

void denoise_guides_trace(PixelGuides *p, const Ray *rays, int count)
{
    const FirstHitWindow *w = &p->guides->window;
    RayKind kinds[ACCEL_PACKET] = {RAY_CAMERA};
    Hit hits[ACCEL_PACKET];
    Shading s;
    for (int i = 0; i < count; i++)
        kinds[i] = RAY_CAMERA;
    accel_intersect_packet(w->accel, rays, kinds, count, 1, hits);
    for (int i = 0; i < count; i++) {
        if (hits[i].primitive >= 0)
            shading_at(&s, w->scene, w->variants, 1, &rays[i], &hits[i]);
        denoise_guides_observe(p, &rays[i], &hits[i], &s);
    }
}

void denoise_guides_pixel_end(PixelGuides *p, FilmPixel *pixel, int x, int y)
{
    const DenoiseGuides *job = p->guides;
    const int *to = job->guides;
    const GuidePixel at = {pixel, x, y};
    const double share = 1.0 / p->samples;
    store_surface(&at, to[RETEX_FEATURE_NORMAL], to[RETEX_FEATURE_POSITION], &p->first);
    store_channel(&at, to[RETEX_FEATURE_SPECULAR], share * p->specular);
    store_surface(&at, to[RETEX_FEATURE_SEEN_NORMAL], to[RETEX_FEATURE_SEEN_POSITION], &p->seen);
    store(&at, to[RETEX_FEATURE_SEEN_ALBEDO], share, p->albedo.r, p->albedo.g, p->albedo.b);
    double each = p->seen.samples ? 1.0 / p->seen.samples : 0;
    store(&at, to[RETEX_FEATURE_SEEN_MATERIAL], 1, p->roughness * each, p->metallic * each,
          1 - p->seen.samples * share);
    for (int t = 0; t < job->window.scene->ntargets && job->split; t++)
        store_channel(&at, job->covers[t], share * p->cover[t]);
    *p = (PixelGuides){.guides = job};
}

int pixel_guides_create(PixelGuides **pixels, int count, const DenoiseGuides *guides, RetexError *err)
{
    if (!(*pixels = calloc((size_t)count, sizeof **pixels)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for guides");
    for (int k = 0; k < count; k++)
        (*pixels)[k].guides = guides;
    return RETEX_OK;
}

void pixel_guides_close(PixelGuides **pixels)
{
    free(*pixels);
    *pixels = NULL;
}

PixelGuides *pixel_guides_at(PixelGuides *pixels, int k)
{
    return pixels + k;
}

int denoise_guides_create(DenoiseGuides *g, Film *film, const FirstHitWindow *window, int split, int samples,
                          RetexError *err)
{
    int code = RETEX_OK;
    *g = (DenoiseGuides){.window = *window, .split = split, .samples = samples};
    const RetexFeatureInfo *info;
    for (int k = 0; !code && (info = retex_feature_info(k)); k++)
        code = bands_add(film_images(film), info->name, info->letters, info->type, &g->guides[k], err);
    for (int t = 0; t < window->scene->ntargets && split && !code; t++) {
        char name[RETEX_NAME_MAX];
        retex_cover_part_name(name, window->scene->targets[t].name);
        code = bands_add(film_images(film), name, "R", RETEX_HALF, &g->covers[t], err);
    }
    return code;
}

int denoise_guides_finish(const DenoiseGuides *g, Film *film, RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < RETEX_FEATURE_COUNT && !code; k++)
        code = bands_move_part(film_images(film), g->guides[k], set, NULL, err);
    for (int t = 0; t < g->window.scene->ntargets && g->split && !code; t++)
        code = bands_move_part(film_images(film), g->covers[t], set, NULL, err);
    return code;
}
