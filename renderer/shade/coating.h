/* What may lie on the base of a surface with the extension `retex`: a clear coat and, below it, sheen. Both are
 * glTF's (KHR_materials_clearcoat, KHR_materials_sheen). The coat is a GGX lobe of a dielectric of index 1.5; sheen
 * is the lobe of fibres by Estevez and Kulla 2017, 'Production Friendly Microfacet Sheen BRDF'. What a layer
 * reflects of light that comes along wo does not reach what is below: no light is made. Neither looks at the albedo,
 * so both add to i. */
#ifndef RENDERER_SHADE_COATING_H
#define RENDERER_SHADE_COATING_H

#include "shade/split.h"

typedef struct Coating {
    int present;
    float under; /* factor of the base's lobes */
    struct {
        float weight; /* 0: there is none */
        float alpha;  /* of GGX; 0 = a mirror */
        float p;      /* of sampling it */
        Vec3 normal;  /* on wo's side */
        Vec3 s, t;    /* its frame */
    } coat;
    struct {
        Rgb color;
        float alpha;
        float p; /* of sampling it */
    } sheen;
} Coating;

typedef struct CoatingNumbers {
    float clearcoat, clearcoat_roughness;
    Rgb sheen;
    float sheen_roughness;
    float coverage; /* share of the surface that is there */
    Vec3 coat_normal, normal, wo;
} CoatingNumbers;

/* Sets all but the probabilities. Returns how much the coat and the sheen reflect of light along wo. */
void coating_set(Coating *coating, const CoatingNumbers *numbers, float *of_coat, float *of_sheen);
/* What the coat mirrors, where it is a mirror. */
float coating_mirrored(const Coating *coating, Vec3 wo);
/* Value times the cosine of wi, of the lobes that are no deltas; their density is added to *pdf. normal: the base's. */
Rgb coating_eval(const Coating *coating, Vec3 normal, Vec3 wo, Vec3 wi, float *pdf);
/* A direction by the coat's lobe. */
Vec3 coating_sample_coat(const Coating *coating, Vec3 wo, float u1, float u2);

/* Share that each reflects of light from one direction, by tables. */
float clearcoat_albedo(float cosine, float roughness);
float sheen_albedo(float cosine, float roughness);

#endif
