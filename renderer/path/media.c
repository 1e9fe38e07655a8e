/* Participating media between two points: how much light passes.
 *
 * It is exact where media are the same everywhere; else it is estimated by tracking: tentative collisions at a constant
 * rate, of which each multiplies by what it leaves (ratio tracking). */
#include "path/media.h"

#define SKY_DISTANCE 1e7 /* that of the sky to POV-Ray's media */
#define STEPS_MAX 2048   /* tentative collisions on a segment: what is denser is taken as that dense */
#define STEPS_LEAST 4    /* for smoothness, where there are few */
#define ROULETTE_BELOW 0.1f
#define PARTS 16 /* of a segment, for an expected transmittance */

float media_draw(PathWorker *w, const Path *path)
{
    return unit_float(hash_pair(hash_pair(path->key ^ 0x6d656469u, path->sample), w->draws++));
}

static float largest4(Float4 v)
{
    return fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2])));
}

/* ---- the media that a ray is in ---- */

static int is_first_of(const Media *media, int k)
{
    for (int i = 0; i < k; i++)
        if (media->filled[i] == media->filled[k])
            return 0;
    return 1;
}

void media_find(const Scene *scene, const Media *media, int with_air, MediumSet *set)
{
    set->count = 0;
    if (media->solids > 0)
        return;
    if (with_air)
        medium_set_add(set, scene->media);
    for (int k = 0; k < media->nfilled; k++)
        if (is_first_of(media, k)) /* where objects with the same interior overlap it is there once */
            medium_set_add(set, media->filled[k]->media);
    if (set->count > 0)
        medium_set_complete(set);
}

double media_distance(const PathContext *c, const MediumSet *set, double distance)
{
    return fmin(distance, set->varies || set->majorant == 0 ? c->reach : SKY_DISTANCE);
}

/* ---- tracking ---- */

float media_tracking_rate(const MediumSet *set, double distance)
{
    return fminf(fmaxf(set->majorant, (float)(STEPS_LEAST / distance)), (float)(STEPS_MAX / distance));
}

double media_free_distance(PathWorker *w, const Path *path, float rate)
{
    return -log(1 - (double)media_draw(w, path)) / rate;
}

int media_weight_survives(PathWorker *w, const Path *path, Float4 *weight)
{
    const float most = largest4(*weight);
    if (most >= ROULETTE_BELOW)
        return 1;
    if (!(most > 0) || media_draw(w, path) >= 0.5f)
        return 0;
    *weight *= splat(2);
    return 1;
}

static Float4 track_transmittance(PathWorker *w, const Path *path, const MediumSet *set, Vec3 from, Vec3 direction,
                                  double distance)
{
    const float rate = media_tracking_rate(set, distance);
    Float4 weight = splat(1);
    MediumSums here;
    for (double t = media_free_distance(w, path, rate); t < distance; t += media_free_distance(w, path, rate)) {
        medium_at(set, vec_mad(from, direction, t), rate, &here);
        weight *= splat(1) - here.extinction / splat(rate);
        if (!media_weight_survives(w, path, &weight))
            return splat(0);
    }
    return weight;
}

Float4 media_set_transmittance(PathWorker *w, const Path *path, const MediumSet *set, Vec3 from, Vec3 direction,
                               double distance)
{
    if (!(distance > 0) || set->majorant == 0)
        return splat(1);
    return set->varies ? track_transmittance(w, path, set, from, direction, distance)
                       : exp4(set->sums.extinction * splat(-(float)distance));
}

Rgb media_transmittance(PathWorker *w, const Path *path, const Media *media, const Ray *ray, double distance,
                        int with_air)
{
    MediumSet set;
    media_find(w->context->scene, media, with_air, &set);
    if (set.count == 0)
        return rgb_grey(1);
    return rgb_of4(media_set_transmittance(w, path, &set, vec_mad(ray->origin, ray->direction, ray->tmin),
                                           ray->direction, media_distance(w->context, &set, distance)));
}

Rgb media_expected_transmittance(const Scene *scene, const Media *media, const Ray *ray, double distance, int with_air)
{
    MediumSet set;
    MediumSums here;
    Float4 depth = splat(0);
    media_find(scene, media, with_air, &set);
    if (set.count == 0 || set.majorant == 0)
        return rgb_grey(1);
    const int parts = set.varies ? PARTS : 1;
    for (int k = 0; k < parts; k++) {
        medium_at(&set, vec_mad(ray->origin, ray->direction, ray->tmin + (k + 0.5) * distance / parts), 0, &here);
        depth += here.extinction * splat((float)(distance / parts));
    }
    return rgb_of4(exp4(-depth));
}
