/* The expected error of one row of a retexture: the formula of estimate.c. Private to libretex. */
#ifndef RETEX_RETEXTURE_ESTIMATE_ROW_H
#define RETEX_RETEXTURE_ESTIMATE_ROW_H

#include "retexture/edited.h"

/* Which images of a view the picture is derived by: footprints, mixtures and gates. Further hits and parts do not
 * vary. */
typedef struct RetexDerivatives {
    const RetexEdited *edited; /* opened with EDITED_TERMS */
    int *rows;                 /* by image of the view, the number of its row of derivatives, or -1 */
    int count;                 /* of rows; behind them are those of light that meets a target with a map again */
} RetexDerivatives;

int retex_derivatives_open(RetexDerivatives *derivatives, const RetexEdited *edited, RetexError *err);
void retex_derivatives_close(RetexDerivatives *derivatives);

/* Number of scratch floats that a row needs. */
size_t retex_estimate_scratch(const RetexDerivatives *derivatives);

/* Compute row y of the error, RGB interleaved. variances: by footprint the variance of its texture, RGB, at the
 * footprint's own size; NULL: 0. means: the same of its colour; only read where the texture has a map of finishes. */
int retex_estimate_row(const RetexDerivatives *derivatives, RetexViewReader *reader, int y,
                       const float *const *variances, const float *const *means, float *scratch, float *out,
                       RetexError *err);

#endif
