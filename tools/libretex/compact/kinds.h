/* Kinds of footprints of a set, with the terms that they have. Private to libretex. */
#ifndef RETEX_COMPACT_KINDS_H
#define RETEX_COMPACT_KINDS_H

#include <retex/set.h>

/* Albedo that interreflections are assumed to meet where terms of several hits are added up. */
#define RETEX_COMPACT_GREY 0.6f
#define RETEX_COMPACT_KINDS (3 * RETEX_MAX_TARGETS)
/* Parameters of a term: what a term of most hits has room for beside a gain. */
#define RETEX_COMPACT_PARAMETERS (RETEX_MAX_FACTORS - RETEX_MAX_HITS - 1)

/* The parameters of a term, mostly one lamp's colour, or none. Terms that differ in nothing else share clusters and
 * mixtures, but light of different parameters is stored apart, so that it stays exact in them. */
typedef struct RetexCompactLamps {
    int count;
    RetexFactor factors[RETEX_COMPACT_PARAMETERS];
    double value[3]; /* the product of their values as rendered; 1 where that is black */
    int alone;       /* 1: terms of role LAMP, whose light is in that of all light as well: it is stored as gains of the
                        radiance of all light */
} RetexCompactLamps;

/* A term of the compact set: the kind's radiance times a gain. */
typedef struct RetexCompactGain {
    RetexTerm term; /* its factors, of the old set: hits, then parameters */
    int lamps;
    char name[RETEX_NAME_MAX];
} RetexCompactGain;

/* Terms of three and more interreflections: one for each target, or one for the mixture of all targets. */
typedef enum RetexCompactMixed { RETEX_COMPACT_APART, RETEX_COMPACT_MIXED, RETEX_COMPACT_CHOICES } RetexCompactMixed;

/* A term with interreflections, and the gains among which its radiance is divided; gain -1: none. */
typedef struct RetexCompactInterreflection {
    int term;
    struct {
        int gain;
        double share;
    } in[RETEX_COMPACT_CHOICES][2];
} RetexCompactInterreflection;

/* Footprints of one target and kind, and their terms. */
typedef struct RetexCompactKind {
    int target;
    RetexFootprintKind kind;
    int count;
    int footprints[RETEX_SHARES_MAX];
    int (*single)[RETEX_SHARES_MAX]; /* by lamps: the term with this footprint as only hit, or -1; of single lamps the
                                        term of all footprints, of each of them */
    int share[RETEX_SHARES_MAX];     /* the part of its weight in a mixture, or -1 */
    RetexFactor first;               /* the first hit of terms with interreflections */
    int ninterreflections;           /* terms whose first hit is of this kind, with more hits */
    RetexCompactInterreflection *interreflections;
    int ngains[RETEX_COMPACT_CHOICES];
    RetexCompactGain *gains[RETEX_COMPACT_CHOICES];
} RetexCompactKind;

typedef struct RetexCompactLight {
    const RetexSet *set;
    double noise; /* RetexCompactParams' */
    int nkinds;
    RetexCompactKind kinds[RETEX_COMPACT_KINDS];
    RetexCompactInterreflection *interreflections; /* of all kinds */
    int nlamps, *lamps_of;                         /* by term with hits: its number in lamps */
    RetexCompactLamps *lamps;
    int all; /* the lamps that light of single ones is a part of; -1: no term is of role LAMP */
    int (*singles)[RETEX_SHARES_MAX]; /* of all kinds */
    float *greys; /* by term with interreflections: its radiance's factor if all of these meet RETEX_COMPACT_GREY; 0 of
                     other terms */
} RetexCompactLight;

#endif
