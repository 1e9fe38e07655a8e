/* How noisy each signal of a set is, for denoising: half of the difference between the mean of the first half of a
 * pixel's samples and that of the rest. What signals are, and the names of the parts: <retex/host/denoise_data.h>. */
#ifndef RENDERER_FILM_NOISE_H
#define RENDERER_FILM_NOISE_H

#include "film/layout.h"

typedef struct NoiseImages {
    int count; /* signals, 0 = none are kept */
    int prunes; /* all become parts of the set; else those that its terms belong to */
    int of[NOISE_SIGNALS_MAX]; /* images of the film */
} NoiseImages;

/* How many signals there are; 0 without params->noise, and of a single sample, which has no halves. */
int noise_count(const FilmParams *params, int ntargets);
int noise_create(NoiseImages *images, const FilmParams *params, const Scene *scene, Bands *bands, RetexError *err);
/* half: totals of the first spp / 2 samples; all: of all spp. */
void noise_store(const NoiseImages *images, BandRows *rows, const SignalTotals *half, const SignalTotals *all, int spp,
                 int x, int y);
/* A part for each signal that terms of the set belong to, or for the beauty of a set without terms. Where the layout
 * prunes all become parts, of which retex_set_prune leaves those. */
int noise_finish(const NoiseImages *images, Bands *bands, RetexSet *set, RetexError *err);

#endif
