/* How many samples a tile needs for a given noise.
 *
 * A few samples of each of its pixels, with numbers of their own, tell the variance of a tile, and are thrown away: so
 * what is kept knows nothing of how many there are of it, and stays unbiased (Kirk and Arvo, 'Unbiased sampling
 * techniques for image synthesis', 1991). */
#ifndef RENDERER_RENDER_ADAPTIVE_H
#define RENDERER_RENDER_ADAPTIVE_H

#include "path/path.h"

#define ADAPTIVE_PILOT 4  /* samples a pixel that decide */
#define ADAPTIVE_LEAST 16 /* samples a pixel that are kept at least, if the most is not less */

/* One thread's. */
typedef struct Adaptive Adaptive;

/* Paths of the context, whatever it splits them into. */
int adaptive_create(Adaptive **adaptive, const PathContext *context, const RenderVariant *variants, RetexError *err);
void adaptive_close(Adaptive **adaptive);
/* The worker to trace a pilot's paths with; adaptive_path_end after each, adaptive_pixel_end after those of a pixel. */
PathWorker *adaptive_worker(Adaptive *adaptive);
void adaptive_path_end(Adaptive *adaptive);
void adaptive_pixel_end(Adaptive *adaptive);
/* Of the tile that was looked at, then begin another: samples a pixel, whole packets of them, up to most. noise: the
 * root mean square, over its pixels, of a pixel's standard deviation over the square root of its value: in a picture
 * encoded for display, which goes by the square root or nearly so, about twice the standard deviation seen. */
int adaptive_tile_samples(Adaptive *adaptive, double noise, int most);

#endif
