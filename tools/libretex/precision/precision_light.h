/* Rounding the light of one pixel so that pictures with new colours keep it. Private to libretex.
 *
 * Numbers are rounded by their noise, and their errors added to the brightest number of the same signal, which is
 * rounded by its light. So the sum of a signal is as precise as a picture needs, whatever its noise. What rounding
 * moves in pictures where one target alone is edited is added to the corrections of that target. */
#ifndef RETEX_SET_PRECISION_LIGHT_H
#define RETEX_SET_PRECISION_LIGHT_H

#include "precision/edited.h"
#include "set/signals.h"

typedef struct RetexPixelLight {
    const RetexSignals *signals;
    const RetexEdited *edited;
    const RetexSet *rows;
    size_t at;            /* the pixel's number in them */
    int has_noise;        /* 0: all steps are the finest */
    int has_finishes;     /* 1: finishes to choose from, not denoised: light of role lamp is that of each choice */
    const double *noise;  /* by signal, then of all together */
    double white;         /* the largest channel of the sum of all terms of light */
    const double *whites; /* the same of each lamp's, by parameter, a row of the set apart */
    int *lit, nlit;       /* terms that are not black; memory for retex_edited_light_count */
    RetexEditedLight before[RETEX_MAX_TARGETS];
} RetexPixelLight;

/* Before anything of the pixel is rounded, and after all else is. */
void retex_pixel_light_keep(RetexPixelLight *light);
void retex_pixel_light_round(RetexPixelLight *light);

double retex_mean_size(const float color[3]);

#endif
