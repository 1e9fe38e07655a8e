/* Chooses the codec and the quantizer of each part of a set. */
#ifndef RETEX_PACK_PLAN_H
#define RETEX_PACK_PLAN_H

#include "pack/format.h"

typedef struct RetexPackFootprintSteps {
    int sigma_share; /* a mean's step is at most its standard deviation divided by this */
    int per_octave;  /* logarithmic steps of standard deviations */
    int angle_steps; /* steps of correlations from 0 to 1, even in the arc sine */
} RetexPackFootprintSteps;

/* Quantizer steps by kind of part. Steps of JPEGs are in levels, of which white is 255. */
typedef struct RetexPackQuantizer {
    double jpeg_step;     /* of radiance, gains and albedo */
    double original_step; /* of original textures */
    double picture_step;  /* of the picture, which only viewers use */
    RetexPackFootprintSteps sharp, broad;
    int weight_steps;    /* from 0 to the largest weight */
    double coarser_most; /* most factor on jpeg_step where noise hides quantization errors */
    double gain_noise;   /* limit on steps of gains, as a multiple of the noise of their radiance */
} RetexPackQuantizer;

/* The quantizer whose errors in the parts have about this PSNR. The PSNR of pictures differs: see loss.h. */
RetexPackQuantizer retex_pack_quantizer(double psnr);

/* The PSNR for a quality: 1 to 100, or above. */
double retex_pack_quality_psnr(double quality);

/* Choose codecs and quantizers of all parts: packed[set->nparts]. quantizer: NULL = lossless. */
int retex_pack_plan(RetexPackPart *packed, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                    RetexError *err);

#endif
