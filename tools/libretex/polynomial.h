/* A set and its samples as a polynomial: every term with its images found. Private to libretex. */
#ifndef LIBRETEX_POLYNOMIAL_H
#define LIBRETEX_POLYNOMIAL_H

#include <retex/sample.h>

typedef struct Monomial {
    const float *radiance;                  /* RGB of the set's size */
    int nfactors;
    const float *factors[RETEX_MAX_FACTORS]; /* likewise: samples, or the original albedo */
    int footprints[RETEX_MAX_FACTORS];
} Monomial;

typedef struct Polynomial {
    Monomial *monomials;
    int count;
    int nmixtures;
    RetexImage mixtures[RETEX_MIXTURES_MAX]; /* the set's; their factors' footprints are RETEX_MIXTURE(index) */
} Polynomial;

/* The terms that params ask for (NULL = defaults). samples may be NULL. Borrows the pixels of both. */
int polynomial_open(Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                    const RetexCombineParams *params, RetexError *err);
void polynomial_close(Polynomial *polynomial);

#endif
