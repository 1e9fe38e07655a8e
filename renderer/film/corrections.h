/* Corrections: what the terms of a set lack where one target alone is edited.
 *
 * A target that keeps its original is a factor by the mean albedo of its footprint. Paths multiply albedos before they
 * are averaged, so a product of means is not the mean of products. For each target, a layout sums the light of all
 * paths as a polynomial in that target's texture, with the original albedos of all other hits. The same polynomial
 * follows from its stored images, with the mean albedos of all other footprints. The difference is stored. */
#ifndef RENDERER_FILM_CORRECTIONS_H
#define RENDERER_FILM_CORRECTIONS_H

#include <retex/host/rounding.h>
#include "base/color4.h"
#include "film/bands.h"
#include "scene/scene.h"

/* Light is told apart by the number of the edited target's hits: none to CORRECTION_POWERS, and more. */
#define CORRECTION_POWERS 3

static inline int correction_power(int hits)
{
    return hits < CORRECTION_POWERS ? hits : CORRECTION_POWERS;
}

/* The number of targets that have corrections: all, where there is another one that may keep its original. None with
 * combinations of finishes: corrections are of the mean over all of them, which no picture is. */
static inline int corrected_targets(const Scene *scene)
{
    return scene->ntargets > 1 && !scene->ncombinations ? scene->ntargets : 0;
}

/* The stored colour of a pixel. */
static inline Float4 correction_stored(BandRows *rows, int image, int x, int y)
{
    const float *pixel = bands_pixel(rows, image, x, y);
    return (Float4){pixel[0], pixel[1], pixel[2], 0};
}

/* unit: what is smaller is an error of rounding, as of retex_coefficient_unit. */
static inline void correction_store(BandRows *rows, int image, Float4 difference, double unit, int x, int y)
{
    float rounded[3];
    for (int c = 0; c < 3; c++)
        rounded[c] = (float)retex_round_by((double)difference[c], unit);
    if (rounded[0] == 0 && rounded[1] == 0 && rounded[2] == 0)
        return; /* memory that is never touched is never taken */
    float *to = bands_pixel(rows, image, x, y);
    for (int c = 0; c < 3; c++)
        to[c] = rounded[c];
}

#endif
