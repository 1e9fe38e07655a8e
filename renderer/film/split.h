/* The sink of contributions that splits light by targets, as sets need it: the hits of a path keep the factors of
 * targets, and each contribution is added to the hit that its light met last, counted from the camera. What becomes of
 * the tree is the layout's. */
#ifndef RENDERER_FILM_SPLIT_H
#define RENDERER_FILM_SPLIT_H

#include "film/contribution.h"
#include "film/film.h"

/* Throughput of a path in one combination of finishes. */
typedef struct SplitThroughput {
    Float4 rest; /* without the factors that hits keep */
    Float4 all;  /* with all factors */
} SplitThroughput;

/* Of one thread. */
typedef struct SplitSink {
    int orders, most_hits; /* of one target, and of all together, that are kept apart */
    const Scene *scene;
    int ncombinations;     /* of finishes; 1 where there are no finishes */
    TargetNode *nodes;     /* memory for the trees of all paths that are traced side by side */
    int count;             /* of them in use */
    LampLight *lamp_light; /* memory for kept light, of all these paths */
    int nlamp_light;       /* in use */
    SplitThroughput *throughput; /* memory for ncombinations of each path */
    FinishFactor (*finishes)[FINISHES_MAX]; /* and for factors by finish, of the hits before nodes, */
    FinishFactor (*last_finishes)[FINISHES_MAX]; /* and of the last hits of paths; NULL: there are no finishes */
} SplitSink;

/* Of one path. */
typedef struct SplitPath {
    SplitThroughput *throughput; /* by combination */
    TargetCounts counts; /* of the hits between the camera and the path's end */
    int folded;          /* a hit beyond the last order was multiplied in with its original albedo */
    int met;             /* a target with several finishes */
    TargetTree tree;
    TargetNode *last;        /* the last hit between the camera and the path's end, or NULL, */
    Float4 last_d, last_i;   /* and its factor, */
    const FinishFactor *last_finishes; /* by finish, in own_finishes; or NULL: the same in all */
    FinishFactor *own_finishes;
    TargetNode *current_hit; /* the hit of the current vertex, once light came by it; or NULL */
} SplitPath;

/* paths: that are traced side by side. */
/* pixel: of the film that paths go to. */
int split_open(SplitSink *sink, const FilmPixel *pixel, size_t paths, const Scene *scene, RetexError *err);
void split_close(SplitSink *sink);
/* Begin the k-th of them. */
static inline void split_start(const SplitSink *sink, SplitPath *path, int k)
{
    const SplitThroughput one = {color4(rgb_grey(1)), color4(rgb_grey(1))};
    path->throughput = sink->throughput ? &sink->throughput[k * sink->ncombinations] : NULL; /* NULL in plain renders */
    for (int c = 0; c < sink->ncombinations; c++)
        path->throughput[c] = one;
    path->counts = TARGET_COUNTS_INIT, path->folded = path->met = 0;
    path->tree = (TargetTree){.seen = {.target = -1}};
    path->last = path->current_hit = NULL;
    path->last_finishes = NULL, path->own_finishes = sink->last_finishes ? sink->last_finishes[k] : NULL;
}
/* Multiply throughput by what is no factor of a target. */
static inline void split_scale(const SplitSink *sink, SplitPath *path, Float4 by)
{
    for (int c = 0; c < sink->ncombinations; c++)
        path->throughput[c].rest *= by, path->throughput[c].all *= by;
}
/* Whether any light can come by it, whatever the textures and finishes are. */
static inline int split_is_alive(const SplitSink *sink, const SplitPath *path)
{
    int alive = 0;
    for (int c = 0; c < sink->ncombinations && !alive; c++)
        alive = !is_black4(path->throughput[c].rest);
    return alive;
}
/* Multiply throughput by a factor, which may become a hit. */
void split_multiply(SplitSink *sink, SplitPath *path, const Factor *factor);
/* Returns 0 if a sum is not finite: then nothing is added. */
int split_add(SplitSink *sink, SplitPath *path, const Contribution *contribution);

#endif
