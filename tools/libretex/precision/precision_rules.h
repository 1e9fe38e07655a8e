/* By what kinds of numbers are rounded. Private to libretex. */
#ifndef RETEX_SET_PRECISION_RULES_H
#define RETEX_SET_PRECISION_RULES_H

#include <math.h>

/* The kinds of numbers. A number's step is a power of two, at most scale * clamp(fraction * relative noise, finest,
 * coarsest); relative noise is that of the light which the number multiplies. */
typedef enum RetexPrecisionKind {
    RETEX_PRECISION_LIGHT,      /* scale: the pixel's value with white targets */
    RETEX_PRECISION_CHOICE_LIGHT, /* of sets with finishes to choose from, which have more of it; scale: the same */
    RETEX_PRECISION_CORRECTION, /* scale: the same */
    RETEX_PRECISION_PICTURE,    /* scale: the value */
    RETEX_PRECISION_MEAN,       /* of UV; scale: the standard deviation */
    RETEX_PRECISION_BROAD_MEAN, /* of what is not seen directly, in mirrors or through glass */
    RETEX_PRECISION_SPREAD,     /* scale: the value */
    RETEX_PRECISION_BROAD_SPREAD,
    RETEX_PRECISION_CORRELATION,       /* scale: 1 - |correlation| */
    RETEX_PRECISION_BROAD_CORRELATION, /* scale: 1 */
    RETEX_PRECISION_COVERAGE,          /* scale: the value */
    RETEX_PRECISION_ALBEDO,            /* scale: 1 */
    RETEX_PRECISION_WEIGHT,            /* in mixtures; scale: 1 */
    RETEX_PRECISION_NOISE,             /* scale: the value */
    RETEX_PRECISION_CHOICE_PICTURE,    /* of each choice of finishes; scale: the value */
    RETEX_PRECISION_CHOICE_NOISE,      /* of its light; scale: the value */
    RETEX_PRECISION_GUIDE,             /* scale: 1 */
    RETEX_PRECISION_POSITION,          /* scale: the value */
    RETEX_PRECISION_KINDS
} RetexPrecisionKind;

typedef struct RetexPrecisionRule {
    double fraction, finest, coarsest;
} RetexPrecisionRule;

/* Fractions are such that rounding adds little to the noise that a picture has anyway, finest steps such that nothing
 * is seen in pictures without noise. */
static const RetexPrecisionRule retex_precision_rules[RETEX_PRECISION_KINDS] = {
    [RETEX_PRECISION_LIGHT] = {0.15, 1.0 / 8192, INFINITY},
    [RETEX_PRECISION_CHOICE_LIGHT] = {0.3, 1.0 / 8192, INFINITY},
    [RETEX_PRECISION_CORRECTION] = {0.05, 1.0 / 8192, 1.0 / 512},
    [RETEX_PRECISION_PICTURE] = {0, 1.0 / 1024, 1.0 / 1024},
    [RETEX_PRECISION_MEAN] = {0.5, 1.0 / 1024, 1.0 / 2},
    [RETEX_PRECISION_BROAD_MEAN] = {1, 1.0 / 1024, 1},
    [RETEX_PRECISION_SPREAD] = {0.25, 1.0 / 1024, 1.0 / 16},
    [RETEX_PRECISION_BROAD_SPREAD] = {1.5, 1.0 / 1024, 1},
    [RETEX_PRECISION_CORRELATION] = {0.25, 1.0 / 512, 1.0 / 8},
    [RETEX_PRECISION_BROAD_CORRELATION] = {1, 1.0 / 512, 1},
    [RETEX_PRECISION_COVERAGE] = {0.5, 1.0 / 128, 1.0 / 8},
    [RETEX_PRECISION_ALBEDO] = {0.05, 1.0 / 4096, 1.0 / 16},
    [RETEX_PRECISION_WEIGHT] = {0.25, 1.0 / 512, 1.0 / 32},
    [RETEX_PRECISION_NOISE] = {0, 1.0 / 2, 1.0 / 2},
    [RETEX_PRECISION_CHOICE_PICTURE] = {0, 1.0 / 256, 1.0 / 256},
    [RETEX_PRECISION_CHOICE_NOISE] = {0, 1, 1},
    [RETEX_PRECISION_GUIDE] = {0, 1.0 / 256, 1.0 / 256},
    [RETEX_PRECISION_POSITION] = {0, 1.0 / 2048, 1.0 / 2048},
};

/* Of a scale; relative: the noise of what the number multiplies, divided by that. */
static inline double retex_precision_step(RetexPrecisionKind kind, double scale, double relative)
{
    const RetexPrecisionRule *rule = &retex_precision_rules[kind];
    return scale * fmax(fmin(rule->fraction * relative, rule->coarsest), rule->finest);
}

#endif
