/* The footprints of a compact set. Private to libretex. */
#ifndef RETEX_COMPACT_MERGED_H
#define RETEX_COMPACT_MERGED_H

#include <retex/set.h>

/* A pixel as the footprint of whole pixels may have it: all its clusters merged, mean UV, variances uu, uv and vv, and
 * the effective number of samples. 0: it is no candidate; RETEX_UNIFORM_EXACT: the set says that it is a parallelogram,
 * and the footprint has it already. */
typedef struct RetexUniformPixel {
    double mean[2];
    float variances[3], samples;
} RetexUniformPixel;
#define RETEX_UNIFORM_EXACT 1e9f

/* Footprints of a kind at a scale: one pixel for a block of scale x scale of the picture's. The last one may be of
 * whole pixels that a surface covers evenly: parallelograms, whose axes its spread is (uniform.h). */
typedef struct RetexCompactClusters {
    int count;
    int whole; /* the one of whole pixels, or -1; while they are made it is not counted */
    RetexImage uv[RETEX_SHARES_MAX], spread[RETEX_SHARES_MAX];
    RetexImage weight[RETEX_SHARES_MAX];         /* share of all light or, with `interreflected`, of single-hit light */
    RetexImage interreflected[RETEX_SHARES_MAX]; /* share of interreflected light; unallocated without split */
    RetexImage albedo;                           /* of all of them */
    int scale, split;
    unsigned char *lit;               /* while they are made: blocks that have light */
    double *further, *all;            /* while they are made with split: sums of interreflected and all light, by row */
    RetexUniformPixel *pixels;        /* what uniform pixels are looked for in (uniform.h), or NULL */
} RetexCompactClusters;

#endif
