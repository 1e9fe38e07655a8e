/* Maps of finishes in a polynomial. Light is kept for each finish of a target; with a map, light whose first hit on the
 * target is at u counts with finish k by the weight w_k(u). Where that hit is a factor of the term, its texture is
 * multiplied by the weight before it is filtered: quantity FINISHED. Else the term has a gate: the weight, averaged
 * over the target's footprints in the pixel. Later hits have the finish of the first. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_FINISHES_H
#define RETEX_RETEXTURE_POLYNOMIAL_FINISHES_H

#include "retexture/polynomial_terms.h"

/* Find the targets that have a map, and the finishes that show where it is transparent. Parameters must be known. */
int retex_polynomial_find_maps(RetexPolynomial *polynomial, RetexError *err);
/* The weight of a term by its parameters, and its factors besides them. With a map of Floor, a term of lamp L with
 * Floor's second finish:
 *     radiance * L * (colour at Floor's sharp1)    L is the weight; the factor is (colour * w_1 at sharp1)
 *     radiance * L * (colour at Wall's broad1)     L is the weight; the factors are that colour, and Floor's gate 1 */
void retex_polynomial_factor_finishes(const RetexPolynomial *polynomial, const RetexTerm *term,
                                      RetexPolynomialTerm *made);

/* Compute what gates need of footprints that are smaller than the picture. */
int retex_polynomial_gates_open(RetexPolynomial *polynomial, int nthreads, RetexError *err);
void retex_polynomial_gates_close(RetexPolynomial *polynomial);

/* Compute a target's gates for row y of the picture: weights of the second finish and later ones, RGB. scratch: 8 *
 * width numbers. */
int retex_polynomial_gate_row(const RetexPolynomial *polynomial, RetexRowReader *reader, int target, int y,
                              float *scratch, float *rgb, RetexError *err);
/* The same as rows of the weights of each finish, the weight in all three channels. */
int retex_polynomial_gate_rows(const RetexPolynomial *polynomial, RetexRowReader *reader, int target, int y,
                               float *scratch, float *const rows[RETEX_FINISHES_MAX], RetexError *err);

#endif
