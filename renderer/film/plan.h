/* Which coefficients a cluster of layout `footprints` keeps: what further hits a monomial may have.
 *
 * A coefficient belongs to a combination of powers, one for each target: how many hits of it follow the first. They
 * form a tree that is walked hit by hit; a hit with no way on is folded into the light with its original albedo. */
#ifndef RENDERER_FILM_PLAN_H
#define RENDERER_FILM_PLAN_H

#include <stdint.h>
#include <retex/set.h>

#define PLAN_COEFFICIENTS_MAX 32
#define PLAN_SURVEY_SLOTS 4096

typedef struct Plan {
    int ntargets, most;
    int count[RETEX_MAX_TARGETS]; /* coefficients of clusters on each target; the first has no further hit */
    unsigned char powers[RETEX_MAX_TARGETS][PLAN_COEFFICIENTS_MAX][RETEX_MAX_TARGETS];
    /* [target of the cluster][coefficient][target of the next hit]: the coefficient then, or -1 */
    signed char next[RETEX_MAX_TARGETS][PLAN_COEFFICIENTS_MAX][RETEX_MAX_TARGETS];
} Plan;

/* What light there is between targets, from some paths. Whole numbers, so that the order of adding does not matter. */
typedef struct PlanSurvey {
    uint64_t total;
    uint32_t keys[PLAN_SURVEY_SLOTS]; /* plan_key + 1, 0 = empty */
    uint64_t energy[PLAN_SURVEY_SLOTS];
} PlanSurvey;

/* A first hit's target and the powers after it: 3 bits each. */
uint32_t plan_key(int first, const unsigned char powers[RETEX_MAX_TARGETS]);

void plan_survey_add(PlanSurvey *survey, uint32_t key, float luminance);
void plan_survey_total(PlanSurvey *survey, float luminance);
void plan_survey_merge(PlanSurvey *into, const PlanSurvey *from);

typedef struct PlanLimits {
    int orders;       /* most factors of one target, the first hit included */
    int factors;      /* of all targets together */
    int coefficients; /* of clusters on one target; more than PLAN_COEFFICIENTS_MAX is as many */
} PlanLimits;

/* One target: all powers up to orders - 1. Several: those that the survey shows light for. */
void plan_make(Plan *plan, int ntargets, const PlanLimits *limits, const PlanSurvey *survey);

/* Coefficients that clusters keep at least, if there is room. */
int plan_least(int ntargets, int orders);

#endif
