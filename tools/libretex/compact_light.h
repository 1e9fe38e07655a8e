/* A set of layout footprints, seen by kinds of clusters: whose light is where. Private to libretex. */
#ifndef RETEX_LIBRETEX_COMPACT_LIGHT_H
#define RETEX_LIBRETEX_COMPACT_LIGHT_H

#include <retex/set.h>

/* What further hits are taken to meet where terms of several hits are added up. */
#define COMPACT_GREY 0.5f

/* Footprints of one target and kind, with what says how much light is whose. */
typedef struct CompactKind {
    int target;
    RetexFootprintKind kind;
    int count;
    int footprints[RETEX_SHARES_MAX];
    int own[RETEX_SHARES_MAX];   /* the term of this footprint alone, or -1 */
    int share[RETEX_SHARES_MAX]; /* the part that weighs it in a mixture, or -1 */
    int first;  /* the factor that stands for all of them */
    int nagain; /* terms that begin with it and go on */
    int *again;
} CompactKind;

typedef struct CompactLight {
    const RetexSet *set;
    int nkinds;
    CompactKind kinds[3 * RETEX_MAX_TARGETS];
    int *again; /* of all kinds */
} CompactLight;

/* Sort a set's footprints and terms. *understood = 0 where it has others than the renderer makes. */
int compact_light_open(CompactLight *light, const RetexSet *set, int *understood, RetexError *err);
void compact_light_close(CompactLight *light);

/* A term's light where all hits but the first meet COMPACT_GREY: what its radiance is times this. */
float compact_grey(const RetexTerm *term);

/* Light of each of a kind's clusters in a pixel, in RGB, further hits on COMPACT_GREY; 0 where the set shows none. Not
 * of later footprints. */
void compact_cluster_light(const CompactLight *light, const CompactKind *kind, size_t pixel,
                           double of[RETEX_SHARES_MAX][3]);
/* Whether the kind has a footprint in the pixel on which light that goes on begins. */
int compact_shows_again(const CompactLight *light, const CompactKind *kind, size_t pixel);

static inline double compact_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

#endif
