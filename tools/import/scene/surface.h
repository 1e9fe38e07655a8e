/* A material as the model has it, in the terms of glTF, before it is written. */
#ifndef RETEX_IMPORT_SURFACE_H
#define RETEX_IMPORT_SURFACE_H

#include <math.h>

#include "import/base/model.h"
#include "import/scene/images.h"

/* An image of a material. */
typedef struct Map {
    char source[TEXT_SIZE]; /* "" = none */
    int uv_set;
    Affine place; /* of UV, v up: from the mesh's to the image's */
} Map;

/* Colours are linear. */
typedef struct Surface {
    float base[3], opacity;
    float metallic, roughness, ior, tint; /* tint: scales the reflectance of the coat */
    float transmission, emission[3];
    float dispersion; /* 20 over Abbe's number */
    float fade_distance, fade_color[3]; /* 0 = none */
    AlphaMode alpha;
    float cutoff;
    int unlit;
    float clearcoat, clearcoat_roughness, clearcoat_normal_scale, sheen[3], sheen_roughness;
    Map base_map, opacity_map, emission_map, metallic_map, roughness_map, normal_map, transmission_map;
    Map clearcoat_map, clearcoat_roughness_map, clearcoat_normal_map, sheen_map;
    int metallic_channel, roughness_channel;
    float normal_scale;
    int has_heights; /* normal_map has heights, in widths of the image times normal_scale */
    GltfBump bump;   /* it has heights in units of the scene, if it is there */
} Surface;

int surface_read(Import *import, int index, Surface *surface, RetexError *err);
/* The inverse of a transform of UV; itself where it has none. */
Affine uv_inverse(const Affine *a);

static inline float largest(const float c[3])
{
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

static inline float unit(float x)
{
    return fminf(fmaxf(x, 0), 1);
}

#endif
