/* A set and its textures as a polynomial, row by row: every term with the pixels of its factors. What is smaller than
 * the picture is made once, at its own size; everything else only while its row is at hand, so that no image of the
 * picture's size is ever whole in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_H
#define RETEX_RETEXTURE_POLYNOMIAL_H

#include <retex/combine.h>
#include <retex/samples.h>

#include "set/rows.h"

typedef struct RetexPolynomial {
    const RetexSet *set;
    const RetexSamples *samples;   /* or NULL */
    RetexTexture *const *textures; /* by target; they go before samples. Or NULL */
    int cross;
    int apart;                                 /* 1: every term is a monomial of its own, with all its factors */
    RetexImage *footprints, *mixtures, *gains; /* those that are smaller, by number; of gains that of the part */
    struct RetexPolynomialGroup *groups;            /* unless apart: see polynomial_groups.h */
    int ngroups;
} RetexPolynomial;

/* The terms that params ask for (NULL = defaults). Borrows set, samples and textures. */
int retex_polynomial_open(RetexPolynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, int apart, int nthreads,
                          RetexError *err);
void retex_polynomial_close(RetexPolynomial *polynomial);

/* Room for a row of colours, which is 0 but for the span that was filled last. */
typedef struct RetexRowBuffer {
    float *values;
    RetexRowSpan filled;
} RetexRowBuffer;

/* One term over one row, or several that differ in what is smaller than the picture only. */
typedef struct RetexMonomial {
    RetexRowSpan span;                                /* beside which one of the factors is 0 */
    const float *radiance;                       /* RGB, 3 * width numbers */
    int nfactors;                                /* footprints and mixtures, */
    int nimages;                                 /* and with what else multiplies radiance, which comes last */
    const float *factors[RETEX_MAX_FACTORS + 2]; /* RGB: samples, or the original albedo */
    int footprints[RETEX_MAX_FACTORS];           /* or mixtures: as in RetexTerm */
} RetexMonomial;

typedef struct RetexPolynomialRow {
    const RetexPolynomial *polynomial;
    RetexRowReader *reader;
    RetexMonomial *monomials; /* those that are not black all over the row */
    int count;
    const float **made; /* rows of footprints, mixtures and gains, as soon as they are made; see polynomial.c */
    RetexRowSpan *spans;     /* beside which they are 0 */
    RetexRowBuffer *buffers;     /* where they are made, if they have to be */
    float *weights;
} RetexPolynomialRow;

/* One a thread. */
int retex_polynomial_row_open(RetexPolynomialRow *row, const RetexPolynomial *polynomial, RetexError *err);
void retex_polynomial_row_close(RetexPolynomialRow *row);
/* Fill in the monomials of row y. */
int retex_polynomial_row_make(RetexPolynomialRow *row, int y, RetexError *err);

#endif
