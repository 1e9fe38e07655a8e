/* Footprints' albedos by the original textures that a set has. Private to libretex. */
#ifndef RETEX_DENOISE_ORIGINALS_H
#define RETEX_DENOISE_ORIGINALS_H

#include <retex/budget.h>
#include <retex/set.h>

/* The textures, and which footprints lie on them. */
typedef struct RetexDenoiseOriginals RetexDenoiseOriginals;

/* *originals is NULL where the set has no original textures. The set may be open. */
int retex_denoise_originals_open(RetexDenoiseOriginals **originals, const RetexSet *set, const RetexBudget *budget,
                                 int nthreads, RetexError *err);
void retex_denoise_originals_close(RetexDenoiseOriginals **originals); /* NULL and pointers to NULL are fine */

/* The mean albedo at a footprint is weighted by the light of few paths, and so has noise that stays when the light is
 * filtered. In the pixels of roi it becomes the mean of the original texture, as far as the difference of both is no
 * more than that noise explains. rows: rows of the set, in memory. */
int retex_denoise_use_originals(const RetexDenoiseOriginals *originals, RetexSet *rows, const RetexRoi *roi,
                                int nthreads, RetexError *err);

#endif
