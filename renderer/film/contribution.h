/* What a path hands to the film: light that comes to its end, and what that light met which is not in the path's
 * throughput yet.
 *
 * Contributions have several sinks: the picture, which path/contributions.c sums; of sets, the tree of hits
 * (film/split.h), which a layout reads when the path ends; and a control film (film/control.h). A sink is told all that
 * multiplies the path's throughput, and keeps that throughput as it needs it. */
#ifndef RENDERER_FILM_CONTRIBUTION_H
#define RENDERER_FILM_CONTRIBUTION_H

#include "base/color4.h"
#include <retex/host/assert.h>
#include "scene/scene.h"

/* What a surface does with one of the finishes of its target. */
typedef struct FinishFactor {
    Float4 d, i;
} FinishFactor;

/* A surface that light scatters at or passes, or that emits it. */
typedef struct Factor {
    int target;          /* -1: none */
    Float4 d, i, albedo; /* it is d albedo + i */
    const Rgb *albedos;  /* by variant, or NULL: the same in all */
    const FinishFactor *finishes; /* by finish of the target, or NULL: the same in all; d and i are those shown */
    const float (*weights)[FINISHES_MAX]; /* of finishes, by variant, where textures have maps of them; d and i are by
                                             those of the first. NULL: all have the one shown */
    const FinishFactor *variants; /* by variant, where textures have normal maps; or NULL: the same in all */
    Vec2 uv;
    int reflects; /* light stays on its side of the surface */
    int sharp;    /* no vertex between it and the camera scattered widely */
    int direct;   /* no vertex between it and the camera bent the path */
} Factor;

static inline Float4 factor_whole(const Factor *f)
{
    return f->d * f->albedo + f->i;
}

/* The same, in a variant. */
static inline Float4 factor_of_variant(const Factor *f, int variant)
{
    Float4 d = f->variants ? f->variants[variant].d : f->d, i = f->variants ? f->variants[variant].i : f->i;
    RETEX_ASSERT(!f->weights || f->finishes);    /* they weigh these */
    RETEX_ASSERT(!f->weights || !f->variants);   /* a texture has a map of finishes or a normal map */
    if (f->weights)
        d = i = splat(0);
    for (int k = 0; f->weights && k < FINISHES_MAX; k++)
        if (f->weights[variant][k] > 0)
            d += f->finishes[k].d * splat(f->weights[variant][k]),
                i += f->finishes[k].i * splat(f->weights[variant][k]);
    return d * (f->albedos ? color4(f->albedos[variant]) : f->albedo) + i;
}

/* The part of it with the finish that its target has in a combination. */
static inline FinishFactor factor_of_combination(const Factor *f, const Scene *scene, int combination)
{
    RETEX_ASSERT(!f->finishes || (f->target >= 0 && (!scene->ncombinations || combination < scene->ncombinations)));
    return f->finishes ? f->finishes[scene->finish_of[combination][f->target]] : (FinishFactor){f->d, f->i};
}

typedef struct Contribution {
    int lamp;              /* of the scene's lamps */
    Rgb light;             /* without the factors */
    const Factor *factors; /* from the path's end to the light */
    int nfactors;
    const Rgb *variants;   /* light by variant, or NULL: it is the same in all */
} Contribution;

#endif
