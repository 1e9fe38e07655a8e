/* A set of layout footprints, sorted by kinds of footprints: which light belongs to which. Private to libretex. */
#ifndef RETEX_COMPACT_LIGHT_H
#define RETEX_COMPACT_LIGHT_H

#include <retex/color.h>

#include "compact/kinds.h"

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
