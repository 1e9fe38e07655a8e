/* A set and its samples as a polynomial: every term with its images found. Private to libretex. */
#ifndef LIBRETEX_POLYNOMIAL_H
#define LIBRETEX_POLYNOMIAL_H

#include <retex/sample.h>

typedef struct Monomial {
    const float *radiance; /* RGB of the set's size */
    int nfactors;          /* of the term, */
    int nimages;           /* and with its gain, which comes last */
    const float *factors[RETEX_MAX_FACTORS + 1]; /* RGB of the set's size: samples, or the original albedo */
    int footprints[RETEX_MAX_FACTORS];
} Monomial;

typedef struct Polynomial {
    Monomial *monomials;
    int count;
    /* Factors that are smaller than the set, at its size, and mixtures; NULL where the set's own or the samples' image
     * serves. By footprint; by mixture; by part. */
    RetexImage *footprints, *mixtures, *gains;
} Polynomial;

/* The terms that params ask for (NULL = defaults). samples may be NULL. Borrows the pixels of both. */
int polynomial_open(Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                    const RetexCombineParams *params, RetexError *err);
void polynomial_close(Polynomial *polynomial, const RetexSet *set);

#endif
