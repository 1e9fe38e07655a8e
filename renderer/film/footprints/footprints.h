/* Layout `footprints`: light is kept apart by where it met a target first.
 *
 * A monomial of a light path, c_S times the textures at its hits S, goes by the first hit of S: into one of few
 * clusters of UV that a pixel has for each target, those seen sharply apart from the rest. A cluster holds the radiance
 * that its texture multiplies: once, and again for each combination of further hits that the plan keeps; these
 * take the target's pooled `later` footprint. I = C0 + sum over clusters k of A_k (c_k0 + sum over i of c_ki B^i). */
#ifndef RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H
#define RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H

#include <retex/band_stats.h>
#include "film/noise.h"

typedef struct FootprintFilm FootprintFilm;
typedef struct FootprintPixel FootprintPixel;

int footprints_create(FootprintFilm **film, const Scene *scene, const FilmParams *params, Bands *bands /* borrowed */,
                      RetexError *err);
void footprints_close(FootprintFilm **film);
/* range grows by what is met; light gets what had to be folded, and what there is with white targets. */
int footprints_pixel_create(FootprintPixel **pixel, FootprintFilm *film, LightSums *light, UvRange *range,
                            RetexError *err);
void footprints_pixel_close(FootprintPixel **pixel);

void footprints_path_end(FootprintPixel *pixel, const PathHits *hits);
/* Between paths: sharp and broad clusters with the light that goes on to targets, each further hit as albedo 1/2. */
void footprints_totals(const FootprintPixel *pixel, SignalTotals *totals);
void footprints_pixel_end(FootprintPixel *pixel, BandRows *rows, int spp, int x, int y);
/* Of a finished band: albedo and coverage. */
void footprints_band_stats(const FootprintFilm *film, const BandRows *rows, RetexBandStats *stats);

/* Make all images parts of the set, which knows its targets' names; those that no pixel has too. */
int footprints_finish(FootprintFilm *film, RetexSet *set, RetexError *err);

#endif
