/* A set of layout footprints, seen by kinds of clusters: whose light is where. Private to libretex. */
#ifndef RETEX_COMPACT_LIGHT_H
#define RETEX_COMPACT_LIGHT_H

#include <retex/color.h>
#include <retex/set.h>

/* What further hits are taken to meet where terms of several hits are added up. */
#define COMPACT_GREY 0.6f
#define COMPACT_KINDS (3 * RETEX_MAX_TARGETS)

/* What makes a term of a kind's radiance in the compact set. */
typedef struct CompactGain {
    RetexTerm term; /* its factors, of the old set */
    char name[RETEX_NAME_MAX];
} CompactGain;

/* Which of its gains a kind has: of many further hits either each target's, or those on any. */
typedef enum CompactMixed { COMPACT_APART, COMPACT_MIXED, COMPACT_CHOICES } CompactMixed;

/* An old term that goes on, and how much of its radiance is whose; gain -1 where nothing is. */
typedef struct CompactAgain {
    int term;
    struct {
        int gain;
        double share;
    } in[COMPACT_CHOICES][2];
} CompactAgain;

/* Footprints of one target and kind, with what says how much light is whose. */
typedef struct CompactKind {
    int target;
    RetexFootprintKind kind;
    int count;
    int footprints[RETEX_SHARES_MAX];
    int own[RETEX_SHARES_MAX];   /* the term of this footprint alone, or -1 */
    int share[RETEX_SHARES_MAX]; /* the part that weighs it in a mixture, or -1 */
    int first;                   /* the factor that stands for all of them */
    int nagain;                  /* terms that begin with it and go on */
    CompactAgain *again;
    int ngains[COMPACT_CHOICES];
    CompactGain *gains[COMPACT_CHOICES];
} CompactKind;

typedef struct CompactLight {
    const RetexSet *set;
    double noise; /* RetexCompactParams' */
    int nkinds;
    CompactKind kinds[COMPACT_KINDS];
    CompactAgain *again; /* of all kinds */
} CompactLight;

/* Sort a set's footprints and terms. *understood = 0 where it has others than the renderer makes. */
int compact_light_open(CompactLight *light, const RetexSet *set, double noise, int *understood, RetexError *err);
void compact_light_close(CompactLight *light);

/* A term's light where all hits but the first meet COMPACT_GREY: what its radiance is times this. */
float compact_grey(const RetexTerm *term);

/* Light of a cluster in a pixel, RGB, 0 where the set shows none: that which meets no other, and that which goes on,
 * further hits on COMPACT_GREY. */
typedef struct ClusterLight {
    double own[3], again[3];
} ClusterLight;
/* Of each of a kind's clusters; not of later footprints. */
void compact_cluster_light(const CompactLight *light, const CompactKind *kind, size_t pixel,
                           ClusterLight of[RETEX_SHARES_MAX]);
/* Whether the kind has a footprint in the pixel on which light that goes on begins. */
int compact_shows_again(const CompactLight *light, const CompactKind *kind, size_t pixel);

static inline double compact_luminance(const double rgb[3])
{
    return retex_luminance(rgb[0], rgb[1], rgb[2]);
}

#endif
