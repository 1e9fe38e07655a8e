/* See features.h. The scale at which a difference of features counts follows the feature's own change from pixel to
 * pixel, as in Rousselle et al. 2013. */
#include "denoise/features.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "denoise/planes_kernel.h"
#include "set/set.h"

#define STRENGTH 0.6f /* k_f of Rousselle et al. 2013 */
#define SLOPE 0.3f    /* distance from the tangent plane, per distance, that counts as one surface */

/* Squared differences below these do not count. */
static const float least[RETEX_FEATURE_KINDS] = {[RETEX_FEATURE_KIND_NORMAL] = 4e-3f,
                                                 [RETEX_FEATURE_KIND_POSITION] = 1e-20f,
                                                 [RETEX_FEATURE_KIND_ALBEDO] = 2e-3f,
                                                 [RETEX_FEATURE_KIND_SHARE] = 4e-3f};

/* Planes of features, by channel, then those of covers: offsets are numbers of planes. */
#define PLANES(id, name, letters, ...) char id[sizeof letters - 1];
typedef struct FeaturePlanes {
    RETEX_FEATURE_TABLE(PLANES)
} FeaturePlanes;
#define PLANE(id, ...) (int)offsetof(FeaturePlanes, id),
static const int first_planes[RETEX_FEATURE_COUNT] = {RETEX_FEATURE_TABLE(PLANE)};
enum { COVERS = sizeof(FeaturePlanes) };

static int clamp(int x, int size)
{
    return x < 0 ? 0 : x < size ? x : size - 1;
}

/* One row of a plane, whose first pixel is pixel x0 of the picture's row. Pixels outside of it repeat its ends. */
static void load_row(float *restrict to, const float *restrict row, int x0, int width, int channels)
{
    const int begin = clamp(-x0, DENOISE_PITCH), end = width - x0 < DENOISE_PITCH ? width - x0 : DENOISE_PITCH;
    const float first = retex_denoise_finite(row[0]),
                last = retex_denoise_finite(row[(ptrdiff_t)(width - 1) * channels]);
    for (int x = 0; x < begin; x++)
        to[x] = first;
    for (int x = begin; x < end; x++)
        to[x] = retex_denoise_finite(row[(ptrdiff_t)(x0 + x) * channels]);
    for (int x = end > 0 ? end : 0; x < DENOISE_PITCH; x++)
        to[x] = last;
}

void retex_denoise_load_plane(float *restrict plane, const RetexSet *set, int part, int channel, int x0, int y0)
{
    const RetexImage *im = &set->parts[part].image;
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++) {
        const float *row = im->pixels + retex_image_index(im, 0, clamp(y0 + y, im->height)) + channel;
        load_row(plane + denoise_at(-DENOISE_HALO, y), row, x0 - DENOISE_HALO, im->width, im->channels);
    }
}

void retex_denoise_load_kind(float *restrict kind, const RetexDenoiser *d, const RetexSignal *signal, int x0, int y0)
{
    const int sharp = signal->kind == RETEX_FOOTPRINT_SHARP && signal->target >= 0;
    if (sharp)
        retex_denoise_load_plane(kind, d->set, signal->cover, 0, x0, y0);
    for (int i = 0; i < DENOISE_PLANE; i++)
        kind[i] = sharp && !(kind[i] > DENOISE_LEAST_COVER) ? -1 : 1;
}

typedef struct FeatureList {
    RetexDenoiseFeatures *features;
    float *planes, *scales;
} FeatureList;

static RetexDenoiseFeature *add_feature(FeatureList *g, int first, int count, float factor, RetexFeatureKind kind)
{
    RetexDenoiseFeatures *f = g->features;
    float *strict = g->scales + (size_t)(2 * f->count) * DENOISE_PLANE, *loose = strict + DENOISE_PLANE;
    memset(strict, 0, sizeof *strict * 2 * DENOISE_PLANE);
    for (int k = 0; k < count; k++)
        retex_denoise_add_gradient(strict, loose, g->planes + (size_t)(first + k) * DENOISE_PLANE);
    retex_denoise_invert_plane(strict, least[kind], factor);
    retex_denoise_invert_plane(loose, least[kind], factor);
    f->of[f->count] = (RetexDenoiseFeature){.first = first, .count = count, .strict = strict, .loose = loose};
    return &f->of[f->count++];
}

/* Adds the features of a hit. Positions are similar where they lie in one plane: in that of the hit's normal. */
static void add_features(FeatureList *g, RetexFeatureHit hit)
{
    int normal = 0;
    for (int k = 0; k < RETEX_FEATURE_COUNT; k++) {
        const RetexFeatureInfo *info = retex_feature_info(k);
        const int first = first_planes[k], count = (int)strlen(info->letters);
        if (info->hit != hit)
            continue;
        if (info->kind == RETEX_FEATURE_KIND_NORMAL)
            normal = first;
        const int is_position = info->kind == RETEX_FEATURE_KIND_POSITION;
        RetexDenoiseFeature *feature =
            add_feature(g, first, count, is_position ? SLOPE * SLOPE * 0.5f : STRENGTH * STRENGTH, info->kind);
        for (int c = 0; is_position && c < 3; c++)
            feature->normal[c] = g->planes + (size_t)(normal + c) * DENOISE_PLANE;
    }
}

static int load_planes(float *planes, const RetexDenoiser *d, int x0, int y0)
{
    int n = 0;
    for (int k = 0; k < RETEX_FEATURE_COUNT; k++)
        for (int c = 0; c < d->set->parts[d->features[k]].image.channels; c++)
            retex_denoise_load_plane(planes + (size_t)n++ * DENOISE_PLANE, d->set, d->features[k], c, x0, y0);
    for (int t = 0; t < d->set->ntargets; t++)
        if (d->signals.covers[t] >= 0)
            retex_denoise_load_plane(planes + (size_t)n++ * DENOISE_PLANE, d->set, d->signals.covers[t], 0, x0, y0);
    return n;
}

void retex_denoise_load_features(RetexDenoiseFeatures *f, float *memory, const RetexDenoiser *d, int x0, int y0)
{
    FeatureList g = {f, memory, memory + (size_t)DENOISE_FEATURE_PLANES_MAX * DENOISE_PLANE};
    float *valid = g.scales + (size_t)(2 * DENOISE_FEATURES_MAX) * DENOISE_PLANE;
    int n = load_planes(g.planes, d, x0, y0);
    *f = (RetexDenoiseFeatures){.valid = valid};
    for (int k = 0; k < n; k++)
        f->planes[k] = g.planes + (size_t)k * DENOISE_PLANE;
    add_features(&g, RETEX_FEATURE_HIT_SEEN);
    if (!retex_denoise_plane_is_zero(
            f->planes[first_planes[RETEX_FEATURE_SPECULAR]])) /* else the first hit is the surface that is seen */
        add_features(&g, RETEX_FEATURE_HIT_FIRST);
    for (int k = COVERS; k < n; k++)
        add_feature(&g, k, 1, STRENGTH * STRENGTH, RETEX_FEATURE_KIND_SHARE);
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
        for (int x = -DENOISE_HALO; x < DENOISE_PITCH - DENOISE_HALO; x++)
            valid[denoise_at(x, y)] = x0 + x >= 0 && x0 + x < d->set->width && y0 + y >= 0 && y0 + y < d->set->height;
}
