/* The factors of a polynomial: their slots in one list, their sizes, and their rows at their own size.
 * Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H
#define RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H

#include "retexture/polynomial_terms.h"

/* Whether a term of the set counts, with the parameters as they are. weight: their product; 1 where it has none. */
int retex_polynomial_has_term(const RetexPolynomial *polynomial, const RetexTerm *term, const float weight[3]);

/* Slots number footprints, mixtures and parts, which images are, in one list, then footprints and mixtures of quantity
 * FURTHER, and of each finish, then gates. Parameters have none. */
int retex_polynomial_slot(const RetexSet *set, RetexFactor factor);
RetexFactor retex_polynomial_factor(const RetexSet *set, int slot); /* and back */
int retex_polynomial_slot_count(const RetexSet *set);

/* 1: it is 1 everywhere, as no texture of a factor of quantity FURTHER is edited. */
int retex_polynomial_is_one(const RetexPolynomial *polynomial, RetexFactor factor);

/* The image of a part if it has `least` to `most` channels, else NULL. */
const RetexImage *retex_polynomial_part_image(const RetexSet *set, int part, int least, int most);
/* An image that has the size of the factor; NULL where the factor is absent. */
const RetexImage *retex_polynomial_factor_image(const RetexPolynomial *polynomial, RetexFactor factor);

/* Make or find the row of a footprint's samples or original albedo, or of these with a finish, and the span outside of
 * which it is 0; *row is NULL where all is black. buffer is used where the row must be made. */
int retex_polynomial_footprint_row(const RetexPolynomial *polynomial, RetexRowReader *reader, RetexFactor factor,
                                   int y, RetexRowBuffer *buffer, const float **row, RetexRowSpan *span,
                                   RetexError *err);

/* Gives the row of one factor of a mixture; NULL where it is black. */
typedef int RetexFactorRow(void *context, RetexFactor footprint, int y, const float **row, RetexError *err);

/* Compute a mixture's row into sum; weights is scratch of the same size. */
int retex_polynomial_mixture_row(const RetexPolynomial *polynomial, RetexRowReader *reader, RetexFactor mixture, int y,
                                 RetexFactorRow *factor_row, void *context, float *weights, RetexRowBuffer *sum,
                                 RetexError *err);

/* Compute the row of a footprint or mixture of quantity FURTHER into values. colors: its row of quantity COLOR, or NULL
 * where that is black. */
int retex_polynomial_further_row(const RetexPolynomial *polynomial, RetexRowReader *reader, RetexFactor factor, int y,
                                 const float *colors, float *weights, RetexRowBuffer *values, RetexError *err);

/* Expand a row of one channel to three, in place. */
void retex_row_gray_to_rgb(float *row, size_t width);

#endif
