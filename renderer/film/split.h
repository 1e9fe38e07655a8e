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
    TargetNode *nodes;     /* memory for the trees of all paths that are traced side by side */
    int count;             /* of them in use */
    int has_lamps;
    LampLight *lamp_light; /* memory for the light of lamps, of all these paths */
    int nlamp_light;       /* in use */
} SplitSink;

/* Of one path. */
typedef struct SplitPath {
    Float4 rest;         /* throughput without the factors that hits keep */
    TargetCounts counts; /* of the hits between the camera and the path's end */
    int folded;          /* a hit beyond the last order was multiplied in with its original albedo */
    TargetTree tree;
    TargetNode *last;        /* the last hit between the camera and the path's end, or NULL, */
    Float4 last_d, last_i;   /* and its factor */
    TargetNode *current_hit; /* the hit of the current vertex, once light came by it; or NULL */
} SplitPath;

/* paths: that are traced side by side; nlamps: of the scene. */
int split_open(SplitSink *sink, FilmPixel *pixel, size_t paths, int nlamps, RetexError *err);
void split_close(SplitSink *sink);
static inline void split_start(SplitPath *path)
{
    path->rest = color4(rgb_grey(1));
    path->counts = TARGET_COUNTS_INIT, path->folded = 0;
    path->tree = (TargetTree){.seen = {.target = -1}};
    path->last = path->current_hit = NULL;
}
/* Multiply throughput by a factor, which may become a hit. */
void split_multiply(SplitSink *sink, SplitPath *path, const Factor *factor);
/* light: the contribution with all factors. Returns 0 if the sum is not finite: then nothing is added. */
int split_add(SplitSink *sink, SplitPath *path, const Contribution *contribution, Float4 light);

#endif
