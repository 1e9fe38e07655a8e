/* A set and its textures as a polynomial, row by row: every term with the pixels of its factors. What is smaller than
 * the picture is made once, at its own size; everything else only while its row is at hand, so that no image of the
 * picture's size is ever whole in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_H
#define RETEX_RETEXTURE_POLYNOMIAL_H

#include <retex/sample.h>

#include "set/rows.h"

typedef struct Polynomial {
    const RetexSet *set;
    const RetexSamples *samples;   /* or NULL */
    RetexTexture *const *textures; /* by target; they go before samples. Or NULL */
    int cross;
    int apart;                                 /* 1: every term is a monomial of its own, with all its factors */
    RetexImage *footprints, *mixtures, *gains; /* those that are smaller, by number; of gains that of the part */
    struct PolynomialGroup *groups;            /* unless apart: see polynomial_groups.h */
    int ngroups;
} Polynomial;

/* The terms that params ask for (NULL = defaults). Borrows set, samples and textures. */
int polynomial_open(Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                    RetexTexture *const *textures, const RetexCombineParams *params, int apart, int nthreads,
                    RetexError *err);
void polynomial_close(Polynomial *polynomial);

/* Room for a row of colours, which is 0 but for the span that was filled last. */
typedef struct RowRoom {
    float *values;
    RowSpan filled;
} RowRoom;

/* One term over one row, or several that differ in what is smaller than the picture only. */
typedef struct Monomial {
    RowSpan span;                                /* beside which one of the factors is 0 */
    const float *radiance;                       /* RGB, 3 * width numbers */
    int nfactors;                                /* footprints and mixtures, */
    int nimages;                                 /* and with what else multiplies radiance, which comes last */
    const float *factors[RETEX_MAX_FACTORS + 2]; /* RGB: samples, or the original albedo */
    int footprints[RETEX_MAX_FACTORS];           /* or mixtures: as in RetexTerm */
} Monomial;

typedef struct PolynomialRow {
    const Polynomial *polynomial;
    RowReader *reader;
    Monomial *monomials; /* those that are not black all over the row */
    int count;
    const float **made; /* rows of footprints, mixtures and gains, as soon as they are made; see polynomial.c */
    RowSpan *spans;     /* beside which they are 0 */
    RowRoom *rooms;     /* where they are made, if they have to be */
    float *weights;
} PolynomialRow;

/* One a thread. */
int polynomial_row_open(PolynomialRow *row, const Polynomial *polynomial, RetexError *err);
void polynomial_row_close(PolynomialRow *row);
/* Fill in the monomials of row y. */
int polynomial_row_make(PolynomialRow *row, int y, RetexError *err);

#endif
