/* Light distributions of luminaires: what a file of IES LM-63, photometric type C, says of luminous intensity by
 * direction. sdl/object/ies.c reads such files; here is what they mean.
 *
 * Angles are degrees. The vertical angle is 0 along the luminaire's axis, which is straight down as it hangs, and 180
 * opposite to it; the horizontal angle goes round the axis, counterclockwise as it is seen from above a luminaire that
 * hangs. Intensities are shares of the greatest one, 0 to 1. */
#ifndef RENDERER_LIGHT_IES_H
#define RENDERER_LIGHT_IES_H

#include "scene/scene.h"

/* Which horizontal angles a file has; the others follow by symmetry. */
typedef enum IesSymmetry {
    IES_AXIAL,    /* one: it is the same all round */
    IES_QUARTERS, /* 0 to 90 */
    IES_HALVES,   /* 0 to 180 */
    IES_ACROSS,   /* 90 to 270 */
    IES_NONE      /* 0 to 360 */
} IesSymmetry;

typedef struct Ies {
    IesSymmetry symmetry;
    int nvertical, nhorizontal;          /* angles, at least 2 and 1; of IES_NONE the last one is 360 */
    const double *vertical, *horizontal; /* rising: vertical ones within 0 to 180; of IES_AXIAL there is one of these */
    int ncolumns;                        /* nhorizontal, or one less where the last one is the first again */
    const float *shares;                 /* of each horizontal angle, then of each vertical one */
    double first_lit, last_lit;          /* vertical angles out of which it is dark */
} Ies;

/* The share in a direction, linear between the file's angles, and 0 outside of its vertical ones. vertical: 0 to 180,
 * horizontal: 0 to 360. */
double ies_share(const Ies *ies, double vertical, double horizontal);

/* Fill ies_axes of a light that has a distribution. axis: where vertical angle 0 looks in its own space, of unit
 * length; to_world is where that goes. */
void ies_place(Light *light, Vec3 axis, const Transform *to_world);
/* The share of its light that such a light gives to a direction, of unit length, away from it. */
double ies_light_share(const Light *light, Vec3 direction);
/* A cone that it does not shine out of: its half-angle in radians, and *axis in world space. */
double ies_light_cone(const Light *light, Vec3 *axis);

#endif
