/* Which footprints of a set are distributed and pooled together, and with which parts. Private to denoising's
 * footprints. */
#ifndef RETEX_DENOISE_PLACES_H
#define RETEX_DENOISE_PLACES_H

#include <retex/color.h>

#include "denoise/footprints.h"

#define PLACES_FINITE 1e12f /* larger numbers stand for none */
#define GROUP_MAX RETEX_SHARES_MAX

/* An image of the set that is of its size; part is -1 and pixels NULL where there is none. */
typedef struct Image {
    const float *pixels;
    size_t channels;
    int part;
} Image;

/* The images of one footprint. */
typedef struct Place {
    Image uv, spread, albedo;
    Image light; /* of clusters */
    Image share; /* in the light that meets targets again */
} Place;

/* Footprints that are distributed or pooled together. */
typedef struct Group {
    RetexFootprintKind kind;
    int periodic[2];
    int count, nlit; /* those with light come first */
    Place *of;
    int movable;        /* the footprints are whole, and no one else's: they may be written */
    const float *again; /* luminance of the light that the shares share, by pixel; NULL = none */
} Group;

struct Footprints {
    size_t width, pixels;
    double spp;
    Group *signals;      /* by signal */
    Group *later, *hits; /* by target; one for each footprint */
    int nsignals, nlater, nhits;
    float **again; /* by signal, then that of all: NULL = none */
    Place *places; /* of all groups */
    int nplaces;
    int *uses; /* by part: how many footprints, terms and shares it is of */
};

static inline float places_luminance(const float *c)
{
    return retex_luminancef(c[0], c[1], c[2]);
}

#endif
