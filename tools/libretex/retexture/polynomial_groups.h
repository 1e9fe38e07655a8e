/* Terms that share their radiance and the factors of the picture's size, summed where they are small: what of each is
 * smaller than the picture, its gain and factors, is multiplied at the finest of their sizes, coarser ones enlarged to
 * it; then the sum needs enlarging once. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H
#define RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H

#include "retexture/polynomial.h"

struct RetexPolynomialGroup {
    int radiance;                             /* part */
    int nfactors, factors[RETEX_MAX_FACTORS]; /* of the picture's size, as in RetexTerm */
    int gain;                                 /* part of the picture's size, or 0 */
    int scale;                                /* of the product, or 0: there is none */
    RetexImage product;                       /* RGB */
    int *terms, nterms;
};

/* All factors are open. */
int retex_polynomial_groups_open(RetexPolynomial *polynomial, int nthreads, RetexError *err);
void retex_polynomial_groups_close(RetexPolynomial *polynomial);

/* The finest scale above 1 of a term's gain and factors, or 0. */
int retex_polynomial_group_scale(const RetexPolynomial *polynomial, const RetexTerm *term);

/* ---- of polynomial.c ---- */

int retex_term_is_excluded(const RetexTerm *term, int cross);
/* A row of one channel as one of three, in place. */
void retex_row_gray_to_rgb(float *row, size_t width);

#endif
