/* The sink of contributions that splits light by targets, as sets need it: the hits of a path keep the factors of
 * targets, and each contribution is added to the hit that its light met last, counted from the camera. What becomes of
 * the tree is the layout's. */
#ifndef RENDERER_FILM_SPLIT_H
#define RENDERER_FILM_SPLIT_H

#include "film/contribution.h"
#include "film/film.h"

/* Of one thread. */
typedef struct SplitSink {
    FilmPixel *pixel;
    int orders, most_hits; /* of one target, and of all together, that are kept apart */
    const Scene *scene;
    TargetNode *nodes;     /* memory for the trees of all paths that are traced side by side */
    int count;             /* of them in use */
    LampLight *lamp_light; /* memory for kept light, of all these paths */
    int nlamp_light;       /* in use */
    struct NodeFinishes *finishes; /* memory for factors of nodes by finish, one for each node */
    struct SplitCombined *combined; /* one for each path */
} SplitSink;

/* Of one path, in scenes with combinations of finishes: throughput in each of them. */
typedef struct SplitCombined {
    Float4 rest[COMBINATIONS_MAX];   /* as SplitPath.rest */
    Float4 beta[COMBINATIONS_MAX];   /* with all factors */
    FinishFactor last[FINISHES_MAX]; /* the factor of the last hit, where last_differs */
    int last_differs;
    int met; /* a target with several finishes */
} SplitCombined;

/* Of one path. */
typedef struct SplitPath {
    Float4 rest;         /* throughput without the factors that hits keep; with combinations their mean */
    SplitCombined *combined; /* or NULL: there are no combinations */
    TargetCounts counts; /* of the hits between the camera and the path's end */
    int folded;          /* a hit beyond the last order was multiplied in with its original albedo */
    TargetTree tree;
    TargetNode *last;        /* the last hit between the camera and the path's end, or NULL, */
    Float4 last_d, last_i;   /* and its factor */
    TargetNode *current_hit; /* the hit of the current vertex, once light came by it; or NULL */
} SplitPath;

/* paths: that are traced side by side. */
int split_open(SplitSink *sink, FilmPixel *pixel, size_t paths, const Scene *scene, RetexError *err);
void split_close(SplitSink *sink);
/* Begin the k-th of them. */
static inline void split_start(SplitSink *sink, SplitPath *path, int k)
{
    path->combined = sink->combined ? &sink->combined[k] : NULL;
    for (int c = 0; path->combined && c < sink->scene->ncombinations; c++)
        path->combined->rest[c] = path->combined->beta[c] = color4(rgb_grey(1));
    if (path->combined)
        path->combined->last_differs = path->combined->met = 0;
    path->rest = color4(rgb_grey(1));
    path->counts = TARGET_COUNTS_INIT, path->folded = 0;
    path->tree = (TargetTree){.seen = {.target = -1}};
    path->last = path->current_hit = NULL;
}
/* Multiply throughput by what is no factor of a target. */
static inline void split_scale(const SplitSink *sink, SplitPath *path, Float4 by)
{
    path->rest *= by;
    for (int c = 0; path->combined && c < sink->scene->ncombinations; c++)
        path->combined->rest[c] *= by, path->combined->beta[c] *= by;
}
/* Multiply throughput by a factor, which may become a hit. */
void split_multiply(SplitSink *sink, SplitPath *path, const Factor *factor);
/* light: the contribution with all factors. Returns 0 if the sum is not finite: then nothing is added. */
int split_add(SplitSink *sink, SplitPath *path, const Contribution *contribution, Float4 light);

#endif
