/* Adaptive sampling: how many samples a tile needs for a given noise.
 *
 * A pilot estimates the variance of a tile from a few samples of each pixel. The picture does not use these samples, so
 * that its number of samples does not depend on their values, and it stays unbiased (Kirk and Arvo, 'Unbiased sampling
 * techniques for image synthesis', 1991). */
#ifndef RENDERER_RENDER_ADAPTIVE_H
#define RENDERER_RENDER_ADAPTIVE_H

#include "path/path.h"

#define ADAPTIVE_PILOT 4  /* samples of each pixel in the pilot */
#define ADAPTIVE_LEAST 16 /* fewest samples of each pixel in the picture, unless the limit is lower */

/* One thread's pilot. */
typedef struct Adaptive Adaptive;

/* context, variants: of the picture. The pilot's paths do not split contributions and have one variant. */
int adaptive_create(Adaptive **adaptive, const PathContext *context, const RenderVariant *variants, RetexError *err);
void adaptive_close(Adaptive **adaptive);
/* The worker that traces the pilot's paths. Call adaptive_pixel_end with those of each pixel. */
PathWorker *adaptive_worker(Adaptive *adaptive);
void adaptive_pixel_end(Adaptive *adaptive, const PathResult paths[ADAPTIVE_PILOT]);
/* The samples of each pixel that the tile needs: whole packets, at most `most`. Then the next tile begins. noise: the
 * standard deviation of a pixel over the square root of its value, as root mean square over the tile. A display encodes
 * values by about their square root, so that this is about twice the standard deviation of what is shown. */
int adaptive_tile_samples(Adaptive *adaptive, double noise, int most);

#endif
