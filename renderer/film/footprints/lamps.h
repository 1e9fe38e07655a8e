/* Kept light, of each lamp and combination of finishes, in layout `footprints`: of a pixel the totals of each kind of
 * light, for the value 1 of its parameter. Clusters are those of all light. Kept light is spread over them as all light
 * is: the mixture of a kind's clusters, weighted by their light, stands for each of them. */
#ifndef RENDERER_FILM_FOOTPRINTS_LAMPS_H
#define RENDERER_FILM_FOOTPRINTS_LAMPS_H

#include "film/footprints/pixel.h"

/* Images of one lamp's light. */
typedef struct LampImages {
    int picture, indep;
    int (*kinds)[2][PLAN_COEFFICIENTS_MAX]; /* [target][sharp, broad][coefficient] */
} LampImages;

/* Of one thread. */
typedef struct LampPixel LampPixel;

/* Number of images that each lamp needs. */
int lamps_images_needed(const FootprintFilm *film);
int lamps_create(FootprintFilm *film, RetexError *err);
void lamps_close(FootprintFilm *film);
int lamps_pixel_create(LampPixel **pixel, const FootprintFilm *film, RetexError *err);
void lamps_pixel_close(LampPixel **pixel);
/* Add the light of a path, whose hits are nodes[k] by number, where there is more than one. combination: -1: all of
 * it; else what is of that combination of finishes, in which the nodes are; what is of none is added with the first. */
void lamps_end_path(LampPixel *pixel, const TargetTree *path, const TargetNode *const *hits, const Node *nodes,
                    int combination);
/* Sums of the signals of each lamp, from totals->of[first] on. */
void lamps_totals(const LampPixel *pixel, SignalTotals *totals, int first);
/* Store and reset. */
void lamps_store(LampPixel *pixel, BandRows *rows, int spp, int x, int y);

#endif
