/* Layout `paper`: per hit count the dependent and independent radiance, cross terms of two and three hits, and per
 * target and hit index the UV statistics, unweighted over all connections (supplement 2, 4.2, 4.3). With several
 * targets the dependent radiance is kept by the number of factors of each target. */
#ifndef RENDERER_FILM_PAPER_PAPER_H
#define RENDERER_FILM_PAPER_PAPER_H

#include "film/noise.h"

typedef struct PaperFilm PaperFilm;
typedef struct PaperPixel PaperPixel;

int paper_create(PaperFilm **film, const Scene *scene, const FilmParams *params, Bands *bands /* borrowed */,
                 RetexError *err);
void paper_close(PaperFilm **film);
int paper_pixel_create(PaperPixel **pixel, PaperFilm *film, RetexError *err);
void paper_pixel_close(PaperPixel **pixel);

void paper_path_end(PaperPixel *pixel, const PathHits *hits, UvRange *range);
/* Terms by the target of their first factor, each further factor as albedo 1/2. */
void paper_totals(const PaperPixel *pixel, SignalTotals *totals);
void paper_pixel_end(PaperPixel *pixel, BandRows *rows, int spp, int x, int y);
/* Of a finished band: albedo and coverage. */
void paper_band_stats(const PaperFilm *film, const BandRows *rows, RetexBandStats *stats);

/* Make all images parts of the set, which knows its targets' names. */
int paper_finish(PaperFilm *film, RetexSet *set, RetexError *err);

#endif
