/* What is between surfaces: fog and rainbows. */
#include "medium/fog.h"
#include "medium/rainbow.h"
#include "path/internal.h"
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
}

Media media_at(const Scene *scene, Vec3 at)
{
    const int has_air = scene->fogs || scene->rainbows;
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
    path_add_light(w, path, own, NULL, 0);
    path->beta_neutral *= at_most(rgb_max(passing), 1);
    return path_scale(w, path, passing);
}

int path_pass_fog(PathWorker *w, Path *path, const Ray *ray, double distance)
{
    Rgb own;
    const Rgb passing = fog_transmittance(w->context->scene, ray, distance, &own);
    return pass(w, path, "fog", passing, own);
}

int path_pass_rainbows(PathWorker *w, Path *path, const Ray *ray, double distance)
{
    const Sampler sampler = {w->key[path->half], path->sample};
    const unsigned segment = (unsigned)(path->segments + path->straight) % JITTER_SEGMENTS;
    float u, unused;
    Rgb passing, own;
    sampler_pair(&sampler, DIMENSION_JITTER + segment, &u, &unused);
    return !rainbow_transmittance(w->context->scene, ray, distance, (double)u, &passing, &own) ||
           pass(w, path, "rainbow", passing, own);
}

Rgb air_transmittance(const PathContext *c, const Media *media, const Ray *ray, double distance, const Light *source)
{
    Rgb own;
    if (media->solids > 0 || !c->scene->fogs || (source && !source->dimmed_by_air))
        return rgb_grey(1);
    return fog_transmittance(c->scene, ray, distance, &own);
}
