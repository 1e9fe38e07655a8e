/* How many samples a tile needs for a given noise.
 *
 * A pilot estimates the variance of a tile by a few samples of each pixel, with sample numbers of their own. These are
 * thrown away, so that the number of samples does not depend on the samples of the picture, which stays unbiased (Kirk
 * and Arvo, 'Unbiased sampling techniques for image synthesis', 1991). */
#ifndef RENDERER_RENDER_ADAPTIVE_H
#define RENDERER_RENDER_ADAPTIVE_H

#include "path/path.h"

#define ADAPTIVE_PILOT 4  /* samples a pixel of the pilot */
#define ADAPTIVE_LEAST 16 /* least samples a pixel of the picture, unless the most is less */

/* One thread's pilot. */
typedef struct Adaptive Adaptive;

/* Its paths have the context given, but no split and no variants. */
int adaptive_create(Adaptive **adaptive, const PathContext *context, const RenderVariant *variants, RetexError *err);
void adaptive_close(Adaptive **adaptive);
/* The worker to trace a pilot's paths with; adaptive_path_end after each, adaptive_pixel_end after those of a pixel. */
PathWorker *adaptive_worker(Adaptive *adaptive);
void adaptive_path_end(Adaptive *adaptive);
void adaptive_pixel_end(Adaptive *adaptive);
/* Samples a pixel for the pilot's tile, in whole packets, up to most; then begin another tile. noise: the root mean
 * square, over the tile's pixels, of the standard deviation over the square root of the value. A picture for display is
 * encoded by about the square root: there it is about twice the visible standard deviation. */
int adaptive_tile_samples(Adaptive *adaptive, double noise, int most);

#endif
