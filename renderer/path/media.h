/* The media that a ray is in, and tracking through them; private to media.c, media_path.c, path.c and photons.c. */
#ifndef RENDERER_PATH_MEDIA_H
#define RENDERER_PATH_MEDIA_H

#include "medium/medium.h"
#include "path/internal.h"

static inline Float4 exp4(Float4 v)
{
    return (Float4){expf(v[0]), expf(v[1]), expf(v[2]), 0};
}

/* A random number. Tracking needs as many as it happens to, so these are no sample numbers of the path. */
float media_draw(PathWorker *worker, const Path *path);
/* with_air: what fills the air counts too. */
void media_find(const Scene *scene, const Media *media, int with_air, MediumSet *set);
/* How far the media of a ray count. */
double media_distance(const PathContext *context, const MediumSet *set, double distance);
/* The rate of tentative collisions, per unit of length, and the distance to the next one. */
float media_tracking_rate(const MediumSet *set, double distance);
double media_free_distance(PathWorker *worker, const Path *path, float rate);
/* Russian roulette of a low weight. Returns 0 where it is given up. */
int media_weight_survives(PathWorker *worker, const Path *path, Float4 *weight);
/* About what passes a segment, without random numbers: photons may be wrong about it, the picture stays right. */
Rgb media_expected_transmittance(const Scene *scene, const Media *media, const Ray *ray, double distance, int with_air);
Float4 media_set_transmittance(PathWorker *worker, const Path *path, const MediumSet *set, Vec3 from, Vec3 direction,
                               double distance);

#endif
