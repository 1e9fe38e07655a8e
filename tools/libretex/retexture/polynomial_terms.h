/* The terms of a polynomial (polynomial.h), its factors, and all else that is known before its rows. Private to
 * libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_TERMS_H
#define RETEX_RETEXTURE_POLYNOMIAL_TERMS_H

#include <retex/combine.h>
#include <retex/samples.h>

#include "set/rows.h"

/* A term of the set as it counts here. */
typedef struct RetexPolynomialTerm {
    int radiance;                         /* part; -1: the term does not count */
    int nfactors;                         /* without parameters, */
    RetexFactor factors[RETEX_MAX_FACTORS]; /* also of kinds that sets do not have, below */
    int weighted;                         /* 1: it has parameters, whose product is */
    float weight[3];
} RetexPolynomialTerm;

/* Which terms are monomials. */
typedef enum RetexPolynomialTerms {
    POLYNOMIAL_GROUPED,    /* groups of terms, see polynomial_groups.h */
    POLYNOMIAL_APART,      /* each term, with all its factors; no corrections */
    POLYNOMIAL_CORRECTED,  /* with corrections */
    POLYNOMIAL_LAMPS_APART /* and both all light as it is kept and that of each lamp, which nothing is taken from */
} RetexPolynomialTerms;

typedef struct RetexPolynomial {
    const RetexSet *set;
    const RetexSamples *samples;   /* or NULL */
    RetexTexture *const *textures; /* by target, or NULL; textures replace samples of the same target */
    RetexKeptSamples *const *kept; /* samples of these textures, by target, or NULL */
    int cross;
    RetexPolynomialTerms apart;
    char edited[RETEX_MAX_TARGETS];            /* 1: the target has a texture or samples */
    int picture;                               /* 1: part 0 is the result, and there are no terms */
    int lamps;                                 /* 1: the set has terms of lamps */
    int lamp_pictures;                         /* 1: the lamps' pictures stand for all other terms */
    float common[3];                           /* what terms of all light are multiplied by */
    RetexRowSpan columns;                      /* outside of them rows of the picture's size may be 0 */
    float parameters[RETEX_PARAMETERS_MAX][3]; /* their values here; of lamps, what these have beyond `common` */
    int has_normals;                           /* 1: a target has a normal map */
    int mapped[RETEX_MAX_TARGETS];             /* by target, the number of finishes that a map tells apart; 0: no map */
    int shown[RETEX_MAX_TARGETS];              /* of these, the finish that shows where the map is transparent */
    RetexImage *gates;                         /* see polynomial_finishes.c */
    RetexPolynomialTerm *terms;                /* by term of the set */
    RetexImage *reduced;                       /* factors that are smaller than the picture, by slot */
    struct RetexPolynomialGroup *groups;       /* see polynomial_groups.h */
    int ngroups;
} RetexPolynomial;

/* Kinds of factors that sets do not have; see polynomial_finishes.h. A factor of a target whose index it has. */
#define POLYNOMIAL_GATE ((RetexFactorKind)RETEX_FACTOR_KINDS)
/* The colour times the weight of finish k; of a gate, the weight. */
#define POLYNOMIAL_FINISHED(k) ((RetexQuantity)(RETEX_QUANTITIES + (k)))

/* The finish of a quantity, or -1. */
static inline int retex_quantity_finish(RetexQuantity quantity)
{
    return (int)quantity - RETEX_QUANTITIES;
}

/* A row of colours that is 0 outside of the span that was filled last. */
typedef struct RetexRowBuffer {
    float *values;
    RetexRowSpan filled;
} RetexRowBuffer;

#endif
