/* A set of layout footprints, seen by kinds of clusters: whose light is where. Private to libretex. */
#ifndef RETEX_COMPACT_LIGHT_H
#define RETEX_COMPACT_LIGHT_H

#include <retex/color.h>
#include <retex/set.h>

/* What further hits are taken to meet where terms of several hits are added up. */
#define RETEX_COMPACT_GREY 0.6f
#define RETEX_COMPACT_KINDS (3 * RETEX_MAX_TARGETS)

/* What makes a term of a kind's radiance in the compact set. */
typedef struct RetexCompactGain {
    RetexTerm term; /* its factors, of the old set */
    char name[RETEX_NAME_MAX];
} RetexCompactGain;

/* Which of its gains a kind has: of many further hits either each target's, or those on any. */
typedef enum RetexCompactMixed { RETEX_COMPACT_APART, RETEX_COMPACT_MIXED, RETEX_COMPACT_CHOICES } RetexCompactMixed;

/* An old term that goes on, and how much of its radiance is whose; gain -1 where nothing is. */
typedef struct RetexCompactInterreflection {
    int term;
    struct {
        int gain;
        double share;
    } in[RETEX_COMPACT_CHOICES][2];
} RetexCompactInterreflection;

/* Footprints of one target and kind, with what says how much light is whose. */
typedef struct RetexCompactKind {
    int target;
    RetexFootprintKind kind;
    int count;
    int footprints[RETEX_SHARES_MAX];
    int single[RETEX_SHARES_MAX]; /* the term of this footprint alone, or -1 */
    int share[RETEX_SHARES_MAX];  /* the part that weighs it in a mixture, or -1 */
    int first;                    /* the factor that stands for all of them */
    int ninterreflections;        /* terms that begin with it and go on */
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
} RetexCompactLight;

/* Sort a set's footprints and terms. *understood = 0 where it has others than the renderer makes. */
int retex_compact_light_open(RetexCompactLight *light, const RetexSet *set, double noise, int *understood,
                             RetexError *err);
void retex_compact_light_close(RetexCompactLight *light);

/* A term's light where all hits but the first meet RETEX_COMPACT_GREY: what its radiance is times this. */
float retex_compact_grey(const RetexTerm *term);

/* Light of a cluster in a pixel, RGB, 0 where the set shows none: that which meets no other, and that which goes on,
 * further hits on RETEX_COMPACT_GREY. */
typedef struct RetexCompactClusterLight {
    double single[3], interreflected[3];
} RetexCompactClusterLight;
/* Of each of a kind's clusters; not of later footprints. */
void retex_compact_cluster_light(const RetexCompactLight *light, const RetexCompactKind *kind, size_t pixel,
                                 RetexCompactClusterLight of[RETEX_SHARES_MAX]);
/* Whether the kind has a footprint in the pixel on which light that goes on begins. */
int retex_compact_has_interreflections(const RetexCompactLight *light, const RetexCompactKind *kind, size_t pixel);

static inline double retex_compact_luminance(const double rgb[3])
{
    return retex_luminance(rgb[0], rgb[1], rgb[2]);
}

#endif
