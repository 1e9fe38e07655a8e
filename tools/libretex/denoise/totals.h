/* The totals of signals, filtered as whole pictures by a denoiser of another maker. Private to libretex. */
#ifndef RETEX_DENOISE_TOTALS_H
#define RETEX_DENOISE_TOTALS_H

#include "denoise/denoiser.h"

/* 1 if `name` is one of params.denoiser. */
int retex_denoiser_is_known(const char *name);

/* Filter the total of each signal of the denoiser's set, which may be in memory or open, as params.denoiser says.
 * *totals is NULL where that asks for none. */
int retex_denoise_totals_open(RetexDenoiseTotals **totals, const RetexDenoiser *denoiser, int nthreads,
                              RetexError *err);
/* Put in what another denoiser made of a signal's total at a pixel of denoiser->set, if one was asked for. Where the
 * filter finds no light at all nothing can take any: there is no member, and no footprint, that it could be of. */
void retex_denoise_mix_total(float total[3], const RetexDenoiser *denoiser, int signal, int x, int y);
void retex_denoise_totals_close(RetexDenoiseTotals **totals); /* NULL and pointers to NULL are fine */

#endif
