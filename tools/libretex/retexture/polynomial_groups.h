/* Groups of terms that are multiplied together. Terms with the same radiance and the same factors of the picture's size
 * share one product: the reduced factors of each are multiplied at the finest of their sizes, to which coarser ones are
 * enlarged, and summed over the group, so that only one image a group is enlarged to the picture's size. Terms without
 * reduced factors share one sum of radiance where parameters weight it, so that a lamp costs one addition. Private to
 * libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H
#define RETEX_RETEXTURE_POLYNOMIAL_GROUPS_H

#include "retexture/polynomial_terms.h"

/* A part, and what the parameters of its term multiply it by. */
typedef struct RetexWeightedRadiance {
    int part;
    float weight[3];
} RetexWeightedRadiance;

struct RetexPolynomialGroup {
    int nfactors;
    RetexFactor factors[RETEX_MAX_FACTORS]; /* textures and images of the picture's size */
    int weighted;                           /* 0: one radiance, of weight 1 */
    int nradiances;
    RetexWeightedRadiance *radiances;
    int scale;          /* scale of the product, or 0 where there is none */
    RetexImage product; /* RGB */
    int *terms, nterms; /* of the product */
};

/* Form the groups and compute their products; all factors must be open. */
int retex_polynomial_groups_open(RetexPolynomial *polynomial, int nthreads, RetexError *err);
void retex_polynomial_groups_close(RetexPolynomial *polynomial);

/* The finest scale above 1 among a term's factors; 0 where all have the picture's size. */
int retex_polynomial_group_scale(const RetexPolynomial *polynomial, const RetexPolynomialTerm *term);

#endif
