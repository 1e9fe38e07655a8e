/* Which coefficients a cluster of layout `footprints` keeps: what further hits a monomial may have.
 *
 * A coefficient belongs to a combination of powers, one for each target: how many hits of it follow the first. Few
 * further hits are kept in every combination; of more, with several targets, only their number, as if each drew its
 * target anew (a mixture of the targets' textures). The coefficients form a graph that is walked hit by hit; a hit with
 * no way on is folded into the light with its original albedo. */
#ifndef RENDERER_FILM_FOOTPRINTS_PLAN_H
#define RENDERER_FILM_FOOTPRINTS_PLAN_H

#include <retex/set.h>

#define PLAN_COEFFICIENTS_MAX 24

typedef struct PlanCoefficient {
    unsigned char powers[RETEX_MAX_TARGETS]; /* further hits of each target; all 0 where mixed */
    unsigned char mixed;                     /* further hits of whatever target, or 0 */
    double weight;                           /* in sums of which there is noise: see plan_weigh */
    signed char next[RETEX_MAX_TARGETS];     /* the coefficient after one more hit of a target, or -1 */
} PlanCoefficient;

typedef struct Plan {
    int together, most; /* so many further hits are kept in every combination; so many at all */
    int count;          /* the first coefficient has no further hit */
    PlanCoefficient coefficients[PLAN_COEFFICIENTS_MAX];
} Plan;

/* dep_Floor_sharp_a2b1: light of sharp clusters, then two hits of the first target and one of the second;
 * dep_Floor_sharp_m5: then five of any. word: what it begins with, as dep_Floor; kind: 0 sharp, 1 broad. */
void plan_light_name(char name[RETEX_NAME_MAX], const Plan *plan, const char *word, int kind, int coefficient);

/* Without targets there is one coefficient, of light that meets none. orders: most factors of one target, the first hit
 * included, 1..RETEX_MAX_ORDERS; factors: of all targets together. */
void plan_make(Plan *plan, int ntargets, int orders, int factors);

/* Give coefficients their weights: each further hit weighs as its target is bright, one of whatever target as the
 * brightest. */
void plan_weigh(Plan *plan, int ntargets, const float *brightness);

/* Make the next smaller plan, which keeps at least so many hits in every combination, or with one target in all.
 * Returns 0 where there is none. */
int plan_shorten(Plan *plan, int ntargets, int together);

#endif
