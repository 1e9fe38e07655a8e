/* The factors of a polynomial, and the gains: their numbers in one list, their sizes, and rows of them, each at its own
 * size. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H
#define RETEX_RETEXTURE_POLYNOMIAL_FACTORS_H

#include "retexture/polynomial.h"

/* Slots: footprints, mixtures and the parts that gains are, in one list. */
int slot_of_factor(const RetexSet *set, int factor);
int slot_of_gain(const RetexSet *set, int part);
int slot_count(const RetexSet *set);

/* A part that has so many channels, or NULL. */
const RetexImage *find_part(const RetexSet *set, int part, int least, int most);
/* The image whose size a factor has; NULL where it is not there. */
const RetexImage *factor_shape(const Polynomial *polynomial, int factor);

/* A footprint's samples, or its original albedo, in the room or wherever they are, and beside what span they are 0;
 * NULL in *row where all is black. */
int make_footprint_row(const Polynomial *polynomial, RowReader *reader, int footprint, int y, RowRoom *room,
                       const float **row, RowSpan *span, RetexError *err);

/* One factor of a mixture: its row, or NULL where it is black. */
typedef int FactorRow(void *context, int footprint, int y, const float **row, RetexError *err);

/* A mixture's row into sum; weights is scratch of as many numbers. */
int make_mixture_row(const Polynomial *polynomial, RowReader *reader, int mixture, int y, FactorRow *factor_row,
                     void *context, float *weights, RowRoom *sum, RetexError *err);

#endif
