/* Which footprints of a set are distributed and pooled together, and with which parts. Private to denoising's
 * footprints. */
#ifndef RETEX_DENOISE_POOLS_H
#define RETEX_DENOISE_POOLS_H

#include <retex/color.h>

#include "denoise/footprints.h"

#define FOOTPRINT_VALUE_MAX 1e12f /* larger numbers stand for none */
#define POOL_GROUP_MAX RETEX_SHARES_MAX

/* An image of the set that is of its size; part is -1 and pixels NULL where there is none. */
typedef struct RetexFootprintImage {
    const float *pixels;
    size_t channels;
    int part;
} RetexFootprintImage;

/* The images of one footprint. */
typedef struct RetexFootprintImages {
    RetexFootprintImage uv, spread, albedo;
    RetexFootprintImage light; /* of clusters */
    RetexFootprintImage share; /* in the light that meets targets again */
} RetexFootprintImages;

/* Footprints that are distributed or pooled together. */
typedef struct RetexPoolGroup {
    RetexFootprintKind kind;
    int periodic[2];
    int count, nlit; /* those with light come first */
    RetexFootprintImages *of;
    int movable;        /* the footprints are whole, and no one else's: they may be written */
    const float *interreflected; /* luminance of the light that the shares share, by pixel; NULL = none */
} RetexPoolGroup;

struct RetexDenoiseFootprints {
    size_t width, pixels;
    double spp;
    RetexPoolGroup *signals;      /* by signal */
    RetexPoolGroup *interreflections, *hits; /* by target; one for each footprint */
    int nsignals, ninterreflections, nhits;
    float **interreflected; /* by signal, then that of all: NULL = none */
    RetexFootprintImages *places; /* of all groups */
    int nplaces;
    int *uses; /* by part: how many footprints, terms and shares it is of */
};

static inline float footprint_luminance(const float *c)
{
    return retex_luminancef(c[0], c[1], c[2]);
}

#endif
