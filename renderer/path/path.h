/* One light path, from the camera on. */
#ifndef RENDERER_PATH_PATH_H
#define RENDERER_PATH_PATH_H

#include "path/context.h"

Media media_at(const Scene *scene, Vec3 point);
int path_worker_open(PathWorker *worker, RetexError *err); /* the rest is filled in */
void path_worker_close(PathWorker *worker);
/* Trace up to PATHS_MAX paths side by side, `each` of every pixel, pixel by pixel; the results are the same as of one
 * after the other. A pixel's first is of the first half of its samples. A control film takes them at once, and so has
 * one pixel at a time. With PathContext.trace it is one path at a time. */
void path_trace(PathWorker *worker, const Ray *rays, const Sampler *samplers, int count, int each,
                PathResult *results);
/* Hand a path over to the film, which takes those of one pixel after the other. */
void path_end(PathWorker *worker, const PathResult *result);

#endif
