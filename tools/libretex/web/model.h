/* The polynomial of a compact set as browsers evaluate it: what is smaller than the picture is summed there first, and
 * the picture is a sum over few groups. Private to libretex. */
#ifndef RETEX_WEB_MODEL_H
#define RETEX_WEB_MODEL_H

#include <retex/set.h>

enum {
    RETEX_WEB_WEIGHTINGS = 2,        /* most weights of a footprint */
    RETEX_WEB_WEIGHT_NONE = -1, /* in place of a part: 0 */
    RETEX_WEB_WEIGHT_ONE = -2,  /* 1 */
    RETEX_WEB_CLASSES_MAX = 4 * RETEX_MAX_TARGETS,
    RETEX_WEB_GROUPS_MAX = 128, /* what shaders have room for */
    RETEX_WEB_TERMS_MAX = 1024
};

/* The footprints of one target and kind: those with standard deviations, or those with axes. */
typedef struct RetexWebClass {
    int target, scale, albedo;
    RetexFootprintKind kind;
    int has_axes;
    int nfootprints, footprints[RETEX_SHARES_MAX];
    int nweightings, weights[RETEX_WEB_WEIGHTINGS][RETEX_SHARES_MAX]; /* parts, or RETEX_WEB_WEIGHT_… */
} RetexWebClass;

/* A mixture of all footprints of one class or of several, by one of their weights each. */
typedef struct RetexWebMixture {
    int nclasses;
    RetexFactor factor; /* of the set */
    struct {
        int index, weighting;
    } classes[RETEX_WEB_CLASSES_MAX];
} RetexWebMixture;

typedef struct RetexWebTerm {
    int group, gain;                          /* part, or -1 */
    int lamp;                                 /* parameter of the single lamp whose light it is; -1: all light */
    int nfactors, factors[RETEX_MAX_FACTORS]; /* mixtures that are smaller than the picture */
} RetexWebTerm;

/* Terms of the same light, parameters and mixture of the picture's size: light times parameters times mixture times the
 * sum over terms of gain times factors. Terms of single lamps are of the groups of all light, whatever their parameter:
 * their sums, each times its parameter, take the place of the sum of the others. */
typedef struct RetexWebGroup {
    int light, mixture;                             /* part; index, or -1 */
    int target;                                     /* of its first factor, or -1 */
    int nparameters, parameters[RETEX_MAX_FACTORS]; /* of the set */
} RetexWebGroup;

typedef struct RetexWebModel {
    int nclasses, nmixtures, nterms, ngroups;
    RetexWebClass classes[RETEX_WEB_CLASSES_MAX];
    RetexWebMixture mixtures[RETEX_MIXTURES_MAX + RETEX_WEB_CLASSES_MAX];
    RetexWebTerm *terms;
    RetexWebGroup groups[RETEX_WEB_GROUPS_MAX];
    int finest; /* the smallest scale of what is smaller than the picture; 1 if there is nothing */
    int lamps_finest; /* the same of the terms of single lamps, which come after the others */
} RetexWebModel;

/* Sort a compact set's terms. Corrections are left out. RETEX_EUNSUPPORTED if the set has another form. */
int retex_web_model_open(RetexWebModel *model, const RetexSet *set, RetexError *err);
void retex_web_model_close(RetexWebModel *model);

#endif
