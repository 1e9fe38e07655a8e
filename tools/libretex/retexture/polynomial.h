/* A set and its textures as a polynomial, row by row: every term with the pixels of its factors. Factors that are
 * smaller than the picture (reduced) are made once, at their own size. All others exist for one row at a time, so
 * that no image of the picture's size is ever complete in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_H
#define RETEX_RETEXTURE_POLYNOMIAL_H

#include <retex/combine.h>
#include <retex/samples.h>

#include "set/rows.h"

/* A term of the set as it counts here. */
typedef struct RetexPolynomialTerm {
    int radiance;                         /* part; -1: the term does not count */
    int nfactors;                         /* without parameters, */
    RetexFactor factors[RETEX_MAX_FACTORS]; /* see polynomial_finishes.h for kinds that sets do not have */
    int weighted;                         /* 1: it has parameters, whose product is */
    float weight[3];
} RetexPolynomialTerm;

typedef struct RetexPolynomial {
    const RetexSet *set;
    const RetexSamples *samples;   /* or NULL */
    RetexTexture *const *textures; /* by target, or NULL; textures replace samples of the same target */
    RetexKeptSamples *const *kept; /* samples of these textures, by target, or NULL */
    int cross;
    int apart;                                 /* 1: one monomial for each term, with all its factors, and no
                                                 corrections; 2: with corrections; 0: terms are grouped */
    char edited[RETEX_MAX_TARGETS];            /* 1: the target has a texture or samples */
    int picture;                               /* 1: part 0 is the result, and there are no terms */
    int lamps, relit;                          /* 1: the set has terms of lamps; they stand for all others, */
    int lamp_pictures;                         /* or the lamps' pictures do */
    RetexRowSpan columns;                      /* outside of them rows of the picture's size may be 0 */
    float parameters[RETEX_PARAMETERS_MAX][3]; /* their values here */
    int has_normals;                           /* 1: a target has a normal map */
    int mapped[RETEX_MAX_TARGETS];             /* by target, the number of finishes that a map tells apart; 0: no map */
    int shown[RETEX_MAX_TARGETS];              /* of these, the finish that shows where the map is transparent */
    RetexImage *gates;                         /* see polynomial_finishes.c */
    RetexPolynomialTerm *terms;                /* by term of the set */
    RetexImage *reduced;                       /* factors that are smaller than the picture, by slot */
    struct RetexPolynomialGroup *groups;       /* see polynomial_groups.h */
    int ngroups;
} RetexPolynomial;

/* Open the polynomial with the terms that params select (NULL = defaults). Borrows set, samples and textures. */
int retex_polynomial_open(RetexPolynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, int apart, int nthreads,
                          RetexError *err);
void retex_polynomial_close(RetexPolynomial *polynomial);
/* A row of colours that is 0 outside of the span that was filled last. */
typedef struct RetexRowBuffer {
    float *values;
    RetexRowSpan filled;
} RetexRowBuffer;

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
