/* Maps of finishes, in terms. Light is kept for each finish of a target; with a map, light whose first hit on the
 * target is at u counts with finish k by the weight w_k(u). Where that hit is a factor of the term, its texture is
 * multiplied by the weight before it is filtered. Else the term has a gate: the weight, averaged over the target's
 * footprints in the pixel. Later hits have the finish of the first. Private to libretex. */
#ifndef RETEX_RETEXTURE_TERM_FINISHES_H
#define RETEX_RETEXTURE_TERM_FINISHES_H

#include "retexture/view.h"

/* Find the targets of a view that have a map of finishes, and, with its parameters, the finishes that show where it is
 * transparent. parameters: the value of each, three numbers; NULL: the finish that the set was rendered with shows. */
int retex_view_find_maps(RetexView *view, const float *parameters, RetexError *err);

/* A term of a set with its parameters, and the finishes that they are of, sorted out. */
typedef struct RetexTermFinishes {
    float weight[3];  /* the product of its parameters */
    int is_weighted;  /* 1: it has some */
    int nfactors;     /* all others */
    RetexFactor factors[RETEX_MAX_FACTORS];
    int finish[RETEX_MAX_FACTORS]; /* by whose weight the factor is multiplied; -1: none */
    int ngates;
    struct {
        int target, finish;
    } gates[RETEX_MAX_TARGETS];
} RetexTermFinishes;

/* parameters: the value of each, three numbers. With a map of Floor, a term of lamp L with Floor's second finish:
 *     radiance * L * (colour at Floor's sharp1)    L is the weight; the factor has finish 1
 *     radiance * L * (colour at Wall's broad1)     L is the weight; the factor has none, and Floor has gate 1 */
void retex_term_find_finishes(RetexTermFinishes *of, const RetexView *view, const RetexTerm *term,
                              const float *parameters);

#endif
