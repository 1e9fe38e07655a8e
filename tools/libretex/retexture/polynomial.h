/* A set and its textures as a polynomial, row by row: every term with the pixels of its factors. Factors that are
 * smaller than the picture (reduced) are made once, at their own size. All others exist for one row at a time, so
 * that no image of the picture's size is ever complete in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_H
#define RETEX_RETEXTURE_POLYNOMIAL_H

#include "retexture/polynomial_terms.h"

/* Open the polynomial with the terms that params select (NULL = defaults). Borrows set, samples and textures. */
int retex_polynomial_open(RetexPolynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, RetexPolynomialTerms apart,
                          int nthreads, RetexError *err);
void retex_polynomial_close(RetexPolynomial *polynomial);
/* What the lamps with the polynomial's parameters have in common, in times of what they are kept with: the least.
 * That much of all light counts, with its corrections; of each lamp what it has beyond. least: the parameter that has
 * it, or -1. Returns 1, with nothing in common, where light of single lamps stands for all. */
int retex_polynomial_common(const RetexPolynomial *polynomial, float common[3], int least[3]);
/* What a lamp has beyond: value - common * kept, exactly 0 of the least. */
float retex_polynomial_beyond(float value, float kept, float common);

/* Terms over one row that differ only in radiance, or in reduced factors: radiance times the product of factors. */
typedef struct RetexMonomial {
    RetexRowSpan span;     /* outside of it one of the factors is 0 */
    const float *radiance; /* RGB, 3 * width numbers; times its parameters */
    int nfactors;
    const float *factors[RETEX_MAX_FACTORS + 1]; /* RGB rows: samples, the original albedo, images; reduced factors'
                                                    product */
    int slots[RETEX_MAX_FACTORS + 1];            /* of factors, see polynomial_factors.h; -1: that product */
    int term;                                    /* its first term */
} RetexMonomial;

typedef struct RetexPolynomialRow {
    const RetexPolynomial *polynomial;
    RetexRowReader *reader;
    RetexMonomial *monomials; /* those that are not black in all of the row */
    int count;
    const float **made;      /* rows that are made already, by slot; see polynomial.c */
    RetexRowSpan *spans;     /* outside of which these rows are 0 */
    RetexRowBuffer *buffers; /* memory for the rows that must be made */
    float *weights;
} RetexPolynomialRow;

/* Open a reader of rows, one for each thread. */
int retex_polynomial_row_open(RetexPolynomialRow *row, const RetexPolynomial *polynomial, RetexError *err);
void retex_polynomial_row_close(RetexPolynomialRow *row);
/* Make the monomials of row y. */
int retex_polynomial_row_make(RetexPolynomialRow *row, int y, RetexError *err);
/* Begin row y without monomials; then make the rows of single factors, by slot, of a polynomial whose terms are apart.
 * *values is NULL where all is black. */
void retex_polynomial_row_begin(RetexPolynomialRow *row);
int retex_polynomial_row_factor(RetexPolynomialRow *row, int slot, int y, const float **values, RetexError *err);

#endif
