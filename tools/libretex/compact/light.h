/* A set of layout footprints, sorted by kinds of footprints: which light belongs to which. Private to libretex. */
#ifndef RETEX_COMPACT_LIGHT_H
#define RETEX_COMPACT_LIGHT_H

#include <retex/color.h>
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

/* Sort footprints and terms. *unknown: what of the set cannot be made compact, or NULL. light is then of no use. */
int retex_compact_light_open(RetexCompactLight *light, const RetexSet *set, double noise, const char **unknown,
                             RetexError *err);
void retex_compact_light_close(RetexCompactLight *light);

/* Light of a cluster in a pixel, RGB: of paths with this hit only, and of those with interreflections, these on
 * RETEX_COMPACT_GREY. */
typedef struct RetexCompactClusterLight {
    double single[3], interreflected[3];
} RetexCompactClusterLight;
enum { RETEX_COMPACT_ALL_LAMPS = -1 };
/* Light of each of a kind's clusters; not for interreflection footprints. lamps: the light that these multiply, but not
 * that of a single lamp; or RETEX_COMPACT_ALL_LAMPS, all light with parameters as rendered. */
void retex_compact_cluster_light(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps, size_t pixel,
                                 RetexCompactClusterLight of[RETEX_SHARES_MAX]);
/* Whether a kind has light of single hits of these lamps; of interreflections; and any. */
int retex_compact_has_single(const RetexCompactKind *kind, int lamps);
int retex_compact_has_light(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps);
int retex_compact_has_further(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps);
/* The product of a term's parameters as rendered; 1 where that is black. */
void retex_compact_rendered(const RetexSet *set, const RetexTerm *term, double value[3]);
/* Whether a path with interreflections has its first hit on a footprint of this kind in the pixel. */
int retex_compact_has_interreflections(const RetexCompactLight *light, const RetexCompactKind *kind, size_t pixel);

/* The term of all light that meets no target, of which that of single lamps is a share; -1: there is none, or
 * several. */
int retex_compact_light_without_hits(const RetexSet *set);
/* Whether a term is light of a single lamp that meets no target. */
int retex_compact_is_lamp_share(const RetexTerm *term);

static inline double retex_compact_luminance(const double rgb[3])
{
    return retex_luminance(rgb[0], rgb[1], rgb[2]);
}

#endif
