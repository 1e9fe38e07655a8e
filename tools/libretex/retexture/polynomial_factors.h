/* The factors of a polynomial, and the gains: their numbers in one list, their sizes, and rows of them, each at its own
 * size. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H
#define RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H

#include "retexture/polynomial.h"

/* Slots: footprints, mixtures and the parts that gains are, in one list. */
int retex_polynomial_slot_of_factor(const RetexSet *set, int factor);
int retex_polynomial_slot_of_gain(const RetexSet *set, int part);
int retex_polynomial_slot_count(const RetexSet *set);

/* A part that has so many channels, or NULL. */
const RetexImage *retex_polynomial_part_image(const RetexSet *set, int part, int least, int most);
/* The image whose size a factor has; NULL where it is not there. */
const RetexImage *retex_polynomial_factor_image(const RetexPolynomial *polynomial, int factor);

/* A footprint's samples, or its original albedo, in the buffer or wherever they are, and beside what span they are 0;
 * NULL in *row where all is black. */
int retex_polynomial_footprint_row(const RetexPolynomial *polynomial, RetexRowReader *reader, int footprint, int y,
                                   RetexRowBuffer *buffer, const float **row, RetexRowSpan *span, RetexError *err);

/* One factor of a mixture: its row, or NULL where it is black. */
typedef int RetexFactorRow(void *context, int footprint, int y, const float **row, RetexError *err);

/* A mixture's row into sum; weights is scratch of as many numbers. */
int retex_polynomial_mixture_row(const RetexPolynomial *polynomial, RetexRowReader *reader, int mixture, int y,
                                 RetexFactorRow *factor_row, void *context, float *weights, RetexRowBuffer *sum,
                                 RetexError *err);

#endif
