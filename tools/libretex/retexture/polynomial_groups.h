/* Groups of terms with the same radiance and the same factors of the picture's size. The reduced factors and the gain
 * of each term are multiplied at the finest of their sizes, to which coarser ones are enlarged, and summed over the
 * group. So only one image a group is enlarged to the picture's size. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H
#define RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H

#include "retexture/polynomial.h"

struct RetexPolynomialGroup {
    int radiance;                             /* part */
    int nfactors, factors[RETEX_MAX_FACTORS]; /* factors of the picture's size, as in RetexTerm */
    int gain;                                 /* gain of the picture's size: its part, or 0 */
    int scale;                                /* scale of the product, or 0 where there is none */
    int corrects;                             /* 1: of corrections */
    RetexImage product;                       /* RGB */
    int *terms, nterms;
};

/* Form the groups and compute their products; all factors must be open. */
int retex_polynomial_groups_open(RetexPolynomial *polynomial, int nthreads, RetexError *err);
void retex_polynomial_groups_close(RetexPolynomial *polynomial);

/* The finest scale above 1 among a term's gain and factors; 0 where all have the picture's size. */
int retex_polynomial_group_scale(const RetexPolynomial *polynomial, const RetexTerm *term);

#endif
