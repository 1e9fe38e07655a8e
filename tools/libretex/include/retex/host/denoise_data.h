/* What denoising reads: parts of the set's size that the renderer leaves with a set, and that recombination does not
 * read. Their names, channels and pixel types come from this header.
 *
 * Noise, by signal: noise_SIGNAL, RGB, half: half of the difference between the mean of the first half of the samples
 * (spp / 2, rounded down) and that of the rest. Its square estimates the variance of the mean of all (Rousselle et al.
 * 2012). A signal is what is filtered with weights of its own: a picture that is the sum of terms,
 *
 *     total = sum over the terms t of the signal of  C_t L_t W_t
 *
 * W_t is the term's noise_weight, which tells how bright the targets of its further hits are, and where that is 0
 * 1/2^(hits of t - 1). L_t is the luminance of the term's parameters as rendered, of terms of role LAMP 1. Corrections
 * do not count. Signals are `indep`, the terms without hits; by target and kind of the first hit's footprint
 * TARGET_sharp and TARGET_broad, in layout paper TARGET_hit; `beauty` where there are no terms at all. The light of
 * each lamp has such signals of its own: lamp_LAMP_indep, lamp_LAMP_TARGET_sharp and so on.
 *
 * Features: guide_NAME, see the table, and guide_cover_TARGET, R, half: how much of the target is seen: share of the
 * pixel times the luminance that the mirrors and glass before it leave, 0..1.
 *
 * Features are taken at the first 16 of the pixel's samples, or the first 64 where those do not all see the same, along
 * the likelier way at each mirror and glass: they are free of noise, but for how samples are spread. */
#ifndef RETEX_HOST_DENOISE_DATA_H
#define RETEX_HOST_DENOISE_DATA_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_NOISE_PREFIX "noise_"
#define RETEX_FEATURE_PREFIX "guide_"
#define RETEX_SIGNAL_INDEP "indep"
#define RETEX_SIGNAL_BEAUTY "beauty"

/* What the numbers of a feature are, and so how denoising compares them. */
typedef enum RetexFeatureKind {
    RETEX_FEATURE_KIND_NORMAL,   /* unit vectors, or 0 */
    RETEX_FEATURE_KIND_POSITION, /* points, compared with the tangent plane, whose normal is that of the same hit */
    RETEX_FEATURE_KIND_ALBEDO,   /* colours, 0..1 */
    RETEX_FEATURE_KIND_SHARE,    /* numbers 0..1 */
    RETEX_FEATURE_KINDS
} RetexFeatureKind;

/* Which hit a feature is of. Those of first hits count only where mirrors or clear glass are near: elsewhere both hits
 * are the same. */
typedef enum RetexFeatureHit {
    RETEX_FEATURE_HIT_FIRST,
    RETEX_FEATURE_HIT_SEEN /* the first one that is neither a mirror nor clear glass: what they show */
} RetexFeatureHit;

/* X(enumerator, name without prefix, letters of its channels, pixel type, kind, hit). To add a feature: a row here, its
 * values in renderer/render/denoise_guides.c, and a line in retex-set(5). */
#define RETEX_FEATURE_TABLE(X)                                                                                         \
    /* mean shading normal, world space, camera's side; 0 = nothing */                                                 \
    X(NORMAL, "normal", "RGB", RETEX_HALF, NORMAL, FIRST)                                                              \
    /* mean position, world space, over those places that hit */                                                       \
    X(POSITION, "position", "RGB", RETEX_FLOAT, POSITION, FIRST)                                                       \
    /* share of the pixel whose first hit is a mirror or clear glass */                                                \
    X(SPECULAR, "specular", "R", RETEX_HALF, SHARE, FIRST)                                                             \
    /* normal and position again */                                                                                    \
    X(SEEN_NORMAL, "seen_normal", "RGB", RETEX_HALF, NORMAL, SEEN)                                                     \
    X(SEEN_POSITION, "seen_position", "RGB", RETEX_FLOAT, POSITION, SEEN)                                              \
    /* its pigment, scene-linear; white on targets, whose texture is not known, on lamps, and where nothing is hit */  \
    X(SEEN_ALBEDO, "seen_albedo", "RGB", RETEX_HALF, ALBEDO, SEEN)                                                     \
    /* its roughness and metallic, as the AOVs of these names, and the share that hits nothing */                      \
    X(SEEN_MATERIAL, "seen_material", "RGB", RETEX_HALF, SHARE, SEEN)

typedef enum RetexFeature {
#define RETEX_FEATURE_ENUMERATOR(id, ...) RETEX_FEATURE_##id,
    RETEX_FEATURE_TABLE(RETEX_FEATURE_ENUMERATOR)
#undef RETEX_FEATURE_ENUMERATOR
        RETEX_FEATURE_COUNT
} RetexFeature;

typedef struct RetexFeatureInfo {
    const char *name, *letters; /* of the part, with its prefix, and of its channels */
    RetexPixelType type;
    RetexFeatureKind kind;
    RetexFeatureHit hit;
} RetexFeatureInfo;

/* NULL where there is no such feature. */
const RetexFeatureInfo *retex_feature_info(int feature);

/* The part of a target's cover. */
void retex_cover_part_name(char name[RETEX_NAME_MAX], const char *target);
/* The part of a signal's noise. target: NULL for the signals indep and beauty; else signal is the kind of footprint, as
 * retex_footprint_kind_name has it. */
void retex_noise_part_name(char name[RETEX_NAME_MAX], const char *target, const char *signal);
/* The same of the light of one lamp, for the value 1 of its parameter. target: NULL for the signal indep. */
void retex_lamp_noise_part_name(char name[RETEX_NAME_MAX], const char *lamp, const char *target, const char *signal);
/* Remove from a set all data that only retex_denoise reads. */
void retex_denoise_drop_data(RetexSet *set);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
