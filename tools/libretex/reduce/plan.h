/* What becomes of each part of a set whose blocks of pixels become pixels. Private to libretex. */
#ifndef RETEX_REDUCE_PLAN_H
#define RETEX_REDUCE_PLAN_H

#include <retex/set.h>

enum { RETEX_REDUCE_NONE = -1 };

/* What a part of the set becomes. */
typedef enum RetexReduceRule {
    RETEX_REDUCE_DROPPED,   /* only denoising reads it */
    RETEX_REDUCE_MEAN,      /* the mean over the block */
    RETEX_REDUCE_CENTRE,    /* the value in the middle of the block: what is not of a kind that has a mean */
    RETEX_REDUCE_FOOTPRINT, /* UV, spread or albedo of merged footprints */
    RETEX_REDUCE_MEMBERS,     /* light or weights of merged footprints */
    RETEX_REDUCE_ORIGINAL   /* an original texture, which has a size of its own */
} RetexReduceRule;

/* Radiance of a term, or the product of it with parameters as rendered. */
typedef struct RetexReduceLight {
    int part;
    double value[3];
} RetexReduceLight;

/* Light, or weights in mixtures, of each footprint of a kind. Merged footprints have the sum. */
typedef struct RetexReduceColumn {
    int term;    /* one of those whose radiance it is, or RETEX_REDUCE_NONE */
    int mixture; /* the mixture whose weights it has, or RETEX_REDUCE_NONE */
    int weights; /* of a mixture: which weights; RETEX_REDUCE_NONE: they are the radiance of terms */
    int channels;
    double value[3];                                  /* what it counts as light when footprints are merged */
    int from[RETEX_SHARES_MAX], to[RETEX_SHARES_MAX]; /* parts of the set and of the reduced one, by member */
} RetexReduceColumn;

/* Footprints of one target and kind: its members, among which the merged ones are distributed. */
typedef struct RetexReduceKind {
    int target;
    RetexFootprintKind kind;
    int count;
    int from[RETEX_SHARES_MAX], to[RETEX_SHARES_MAX]; /* footprints, by member */
    int albedo_of[RETEX_SHARES_MAX];                  /* the first member that has the same albedo */
    int nellipses, ellipses[RETEX_SHARES_MAX];        /* members of merged footprints */
    int map[RETEX_QUADRANTS]; /* members of a pixel that is a parallelogram, by its quarters; all the same where it has
                                 none; RETEX_REDUCE_NONE: there is no such */
    int nlight;               /* of a kind of one member: the terms that have it as a factor */
    RetexReduceLight *light;
    int ncolumns;
    RetexReduceColumn *columns;
} RetexReduceKind;

/* Weights of mixtures that share parts, and the light that they divide. */
typedef struct RetexReduceWeights {
    int nparts, *parts; /* all of their parts */
    int nlight;
    RetexReduceLight *light;
} RetexReduceWeights;

typedef struct RetexReducePlan {
    RetexSet *reduced; /* made with the plan; its pixels come later */
    RetexReduceRule *rules;
    int *to; /* by part of the set, the reduced set's */
    int nkinds;
    RetexReduceKind kinds[3 * RETEX_MAX_TARGETS];
    int nweights;
    RetexReduceWeights weights[RETEX_MIXTURES_MAX];
} RetexReducePlan;

/* Plan the reduction of a set, and make the reduced one without pixels. RETEX_EUNSUPPORTED: it cannot be reduced. */
int retex_reduce_plan_open(RetexReducePlan *plan, const RetexSet *set, int scale, RetexError *err);
/* Leaves plan->reduced, which is the caller's. */
void retex_reduce_plan_close(RetexReducePlan *plan);

#endif
