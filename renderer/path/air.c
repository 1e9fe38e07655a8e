/* What is between surfaces: what a ray is in, fog and rainbows. */
#include "medium/fog.h"
#include "medium/rainbow.h"
#include "path/internal.h"
#include "path/path.h"
#include "shape/csg.h"
#include "shape/shape.h"

/* ---- what the camera is in ---- */

static const Primitive *first_leaf(const CsgNode *node)
{
    while (node && node->kind != CSG_LEAF)
        node = node->children;
    return node ? node->primitive : NULL;
}

static int is_inside(const Primitive *p, Vec3 at)
{
    const Vec3 here = transform_inverse_point(&p->transform, at);
    return (p->shape.ops->inside && p->shape.ops->inside(&p->shape, here)) != p->inverse;
}

static void enter(Media *media, const Primitive *p)
{
    media->solids += p->is_solid;
    if (p->interior && p->interior->media && media->nfilled < FILLED_MAX)
        media->filled[media->nfilled++] = p->interior;
}

Media media_at(const Scene *scene, Vec3 at)
{
    const int has_air = scene->fogs || scene->rainbows || scene->has_media;
    Media media = {.count = 0};
    for (int k = 0; has_air && k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        if (!p->csg && !p->prototype && is_inside(p, at))
            enter(&media, p);
    }
    for (int k = 0; has_air && k < scene->ncsgs; k++) {
        const Primitive *p = first_leaf(scene->csgs[k]->root);
        if (p && csg_inside(scene->csgs[k]->root, at))
            enter(&media, p);
    }
    return media;
}

/* ---- fog ---- */

static int pass(PathWorker *w, Path *path, const char *what, Rgb passing, Rgb own)
{
    if (w->context->trace)
        fprintf(w->context->trace, "%s lets %.5g %.5g %.5g pass, adds\n", what, passing.r, passing.g, passing.b);
    path_contribute(w, path, &(Contribution){scene_rest_lamp(w->context->scene), own, NULL, 0, NULL});
    path->beta_neutral *= at_most(rgb_max(passing), 1);
    return path_scale(w, path, passing);
}

static int pass_fog(PathWorker *w, Path *path, const Ray *ray, double distance)
{
    Rgb own;
    const Rgb passing = fog_transmittance(w->context->scene, ray, distance, &own);
    return pass(w, path, "fog", passing, own);
}

static int pass_rainbows(PathWorker *w, Path *path, const Ray *ray, double distance)
{
    const Sampler sampler = {path->key, path->sample};
    const unsigned segment = (unsigned)(path->segments + path->straight) % JITTER_SEGMENTS;
    float u, unused;
    Rgb passing, own;
    sampler_pair(&sampler, DIMENSION_JITTER + segment, &u, &unused);
    return !rainbow_transmittance(w->context->scene, ray, distance, (double)u, &passing, &own) ||
           pass(w, path, "rainbow", passing, own);
}

int path_pass_air(PathWorker *w, Path *path, const Ray *ray, const Hit *hit)
{
    const PathContext *c = w->context;
    const double distance = hit->primitive < 0 ? INFINITY : hit->t - ray->tmin;
    if (path->media.solids > 0 || path->leaving || !path_is_seen(c, path, ray))
        return 1;
    if (c->scene->fogs && !pass_fog(w, path, ray, distance))
        return 0;
    return !c->scene->rainbows || path->pdf > 0 || pass_rainbows(w, path, ray, distance);
}

Rgb air_transmittance(PathWorker *w, const Path *path, const Media *media, const Ray *ray, double distance,
                      const Light *source)
{
    const Scene *scene = w->context->scene;
    const int is_dimmed = !source || source->dimmed_by_air;
    Rgb own, passing = rgb_grey(1);
    if (media->solids > 0)
        return passing;
    if (scene->fogs && is_dimmed)
        passing = fog_transmittance(scene, ray, distance, &own);
    return scene->has_media ? rgb_mul(passing, media_transmittance(w, path, media, ray, distance, is_dimmed)) : passing;
}
