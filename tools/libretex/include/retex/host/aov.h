/* AOVs: pictures beside the beauty that a render may add to a set, one part each. This table says all that is common
 * to them: names, option values, messages, checks of numbers and how they are shown come from it. To add one: a row
 * here, its values in renderer/render/first_hit.c, and its description in retex-render(1). */
#ifndef RETEX_HOST_AOV_H
#define RETEX_HOST_AOV_H

#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* How an AOV becomes a picture to look at. */
typedef enum RetexAovShown {
    RETEX_AOV_COLOR,    /* scene-linear colours, 0..1 */
    RETEX_AOV_EXPOSED,  /* scene-linear colours, divided by the 99th percentile of their luminance */
    RETEX_AOV_SIGNED,   /* -1..1 */
    RETEX_AOV_RANGE,    /* from the least to the largest finite value of each channel */
    RETEX_AOV_FRACTION, /* without its whole part; the third channel is left out */
    RETEX_AOV_SHARE,    /* 0..1 */
    RETEX_AOV_NUMBER    /* whole numbers, a colour for each; 0 is black */
} RetexAovShown;

/* X(enumerator, name of the part, letters of its channels, pixel type, value where nothing is hit, shown as). Letters
 * are such that other programs show channels as they are: Blender would show R, G, A as R, 0, A. One or three. */
#define RETEX_AOV_TABLE(X)                                                                                             \
    /* distance along the ray, scene units */                                                                          \
    X(DEPTH, "depth", "R", RETEX_FLOAT, INFINITY, RETEX_AOV_RANGE)                                                     \
    /* the pigment's colour, scene-linear, without the finish: what a new texture replaces */                          \
    X(ALBEDO, "albedo", "RGB", RETEX_FLOAT, 0, RETEX_AOV_COLOR)                                                        \
    /* x, y, z of the unit shading normal, on the camera's side, world space */                                        \
    X(NORMAL, "normal", "RGB", RETEX_FLOAT, 0, RETEX_AOV_SIGNED)                                                       \
    /* x, y, z, world space */                                                                                         \
    X(POSITION, "position", "RGB", RETEX_FLOAT, 0, RETEX_AOV_RANGE)                                                    \
    /* u, v that a replacement texture would be looked up at, and 1 */                                                 \
    X(UV, "uv", "UVA", RETEX_FLOAT, 0, RETEX_AOV_FRACTION)                                                             \
    /* number of the primitive, from 1 */                                                                              \
    X(OBJECT, "object", "R", RETEX_FLOAT, 0, RETEX_AOV_NUMBER)                                                         \
    /* of the sharpest lobe: 0 mirrors and clear glass, 1 diffuse only, between the square root of GGX's alpha */      \
    X(ROUGHNESS, "roughness", "R", RETEX_FLOAT, 0, RETEX_AOV_SHARE)                                                    \
    /* 0..1, how much the surface's reflections have the pigment's colour */                                           \
    X(METALLIC, "metallic", "R", RETEX_FLOAT, 0, RETEX_AOV_SHARE)                                                      \
    /* the share of light from all sides alike that the diffuse lobes give back on the side that is seen: the albedo   \
     * times what the finish makes of it */                                                                            \
    X(REFLECTANCE, "reflectance", "RGB", RETEX_FLOAT, 0, RETEX_AOV_COLOR)                                              \
    /* direct and indirect light on the side that is seen: pi times the radiance of a white diffuse surface there */   \
    X(IRRADIANCE, "irradiance", "RGB", RETEX_FLOAT, 0, RETEX_AOV_EXPOSED)                                              \
    /* albedo and normal, not at the pixel's centre but averaged over its samples, what hits nothing as 0 */           \
    X(ALBEDO_MEAN, "albedo_mean", "RGB", RETEX_FLOAT, 0, RETEX_AOV_COLOR)                                              \
    X(NORMAL_MEAN, "normal_mean", "RGB", RETEX_FLOAT, 0, RETEX_AOV_SIGNED)

typedef enum RetexAov {
#define RETEX_AOV_ENUMERATOR(id, ...) RETEX_AOV_##id,
    RETEX_AOV_TABLE(RETEX_AOV_ENUMERATOR)
#undef RETEX_AOV_ENUMERATOR
        RETEX_AOV_COUNT
} RetexAov;

/* AOVs are chosen by an unsigned number with a bit for each. */
#define RETEX_AOV_BIT(id) (1u << RETEX_AOV_##id)
#define RETEX_AOV_ALL ((1u << RETEX_AOV_COUNT) - 1)

/* "beauty, depth, ...": the names that lists of AOVs may have. The beauty is part of every set. */
#define RETEX_AOV_NEXT_NAME(id, name, ...) ", " name
#define RETEX_AOV_NAMES "beauty" RETEX_AOV_TABLE(RETEX_AOV_NEXT_NAME)

typedef struct RetexAovInfo {
    const char *name, *letters;
    RetexPixelType type;
    float nothing; /* where nothing is hit; the part may hold infinities if this is one */
    RetexAovShown shown;
} RetexAovInfo;

/* NULL where there is no such AOV. */
const RetexAovInfo *retex_aov_info(int aov);

/* The AOV of that name, or -1. */
int retex_aov_find(const char *name);
/* Whether its values are scene-linear colours. */
int retex_aov_is_color(RetexAov aov);
/* Channels of all that are chosen, together. */
int retex_aov_channels(unsigned aovs);
/* Add the AOVs of a list, as in "depth,uv", to those that are chosen. option: its name, for messages. RETEX_EPARSE. */
int retex_aov_parse(unsigned *aovs, const char *list, const char *option, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
