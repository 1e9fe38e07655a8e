/* Reflectance by angle. */
#ifndef RENDERER_SHADE_FRESNEL_H
#define RENDERER_SHADE_FRESNEL_H

#include "shade/split.h"

/* Unpolarised Fresnel reflectance of a dielectric; cos_i >= 0 on the incoming side, eta = far over near. */
static inline float fresnel_dielectric(float cos_i, float eta)
{
    if (eta == 1)
        return 0;
    float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1)
        return 1;
    float cos_t = sqrtf(1 - sin2_t);
    float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/* POV-Ray's `metallic`: the tint by the pigment wears off towards grazing angles. */
static inline Split metallic_tint(Split head_on, float cosine)
{
    /* POV-Ray's curve over the angle, 0 head-on and 1 at 90 degrees */
    float x = acosf(fminf(1, cosine)) * (float)(2 / PI) - 1.12f;
    float white = 0.014567225f / (x * x) - 0.011612903f;
    white = white < 0 ? 0 : white > 1 ? 1 : white;
    return (Split){rgb_scale(head_on.d, 1 - white), rgb_add(head_on.i, rgb_scale(head_on.d, white))};
}

#endif
