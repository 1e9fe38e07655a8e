/* Choosing codec and quantizer of each part of a set. */
#ifndef RETEX_PACK_PLAN_H
#define RETEX_PACK_PLAN_H

#include "pack/format.h"

typedef struct RetexPackFootprintSteps {
    int sigma_share; /* means are multiples of at most this share of their standard deviation */
    int per_octave;  /* steps of standard deviations */
    int angle_steps; /* of correlations, from 0 to 1 */
} RetexPackFootprintSteps;

/* Quantizer steps of all kinds of parts, in levels; 255 levels are white. */
typedef struct RetexPackQuantizer {
    double jpeg_step;     /* of light, gains and albedo */
    double original_step; /* of original textures */
    double picture_step;  /* of the picture, which only viewers see */
    RetexPackFootprintSteps sharp, broad;
    int weight_steps;    /* to the largest weight */
    double coarser_most; /* times jpeg_step, of light so noisy that nothing is seen of it */
    double gain_noise;   /* steps of gains may be so many times the noise of their light */
} RetexPackQuantizer;

/* The quantizer whose own errors have about this PSNR. That of pictures differs: see loss.h. */
RetexPackQuantizer retex_pack_quantizer(double psnr);

/* The PSNR that a quality of 1 to 100, or above, aims at. */
double retex_pack_quality_psnr(double quality);

/* Plan all parts: packed[set->nparts]. quantizer: NULL = every part keeps its bits. */
int retex_pack_plan(RetexPackPart *packed, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                    RetexError *err);

#endif
