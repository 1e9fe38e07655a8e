/* Which footprints of a set are distributed and pooled together, and their parts. Private to libretex. */
#ifndef RETEX_DENOISE_POOLS_H
#define RETEX_DENOISE_POOLS_H

#include <retex/color.h>

#include "denoise/denoiser.h"

#define FOOTPRINT_VALUE_MAX 1e12f /* larger values count as absent */
#define FOOTPRINT_CLASS_MAX RETEX_SHARES_MAX

/* An image of the set's size; part is -1 and pixels NULL where there is none. */
typedef struct RetexFootprintImage {
    const float *pixels;
    size_t channels;
    int part;
} RetexFootprintImage;

/* The images of one footprint. */
typedef struct RetexFootprintImages {
    RetexFootprintImage uv, spread, albedo;
    RetexFootprintImage light; /* radiance of a cluster */
    RetexFootprintImage share; /* share in interreflected light */
} RetexFootprintImages;

/* Footprints of one target and kind, which are distributed or pooled together. */
typedef struct RetexFootprintClass {
    RetexFootprintKind kind;
    int periodic[2];
    int count, nlit; /* clusters with light of their own come first */
    RetexFootprintImages *of;
    int movable;        /* 1: all parts are there and used by nothing else: they may be written */
    const float *interreflected; /* luminance of the interreflected light that the shares divide, by pixel; NULL =
                                    none */
} RetexFootprintClass;

/* How the footprints of a set are distributed and pooled; found once for each call. */
typedef struct RetexDenoiseFootprints {
    size_t width, pixels;
    int radius; /* of the window */
    double spp;
    RetexFootprintClass *signals;      /* by signal */
    RetexFootprintClass *interreflections, *hits; /* interreflections by target; hits: one class for each footprint */
    int nsignals, ninterreflections, nhits;
    float **interreflected; /* by signal, then the sum of all; NULL = none */
    RetexFootprintImages *places; /* of all classes */
    int nplaces;
    int *uses; /* by part: the number of footprints, terms and shares that use it */
} RetexDenoiseFootprints;

int retex_denoise_footprints_open(RetexDenoiseFootprints **footprints, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_footprints_close(RetexDenoiseFootprints **footprints);
/* Set written[part] = 1 for the parts of the set that the calls of footprints.h write. */
void retex_denoise_mark_written(const RetexDenoiseFootprints *footprints, const RetexDenoiser *denoiser,
                                unsigned char *written);

static inline float footprint_luminance(const float *c)
{
    return retex_luminancef(c[0], c[1], c[2]);
}

#endif
