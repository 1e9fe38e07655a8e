/* Light of single lamps in a compact set: gains of the radiance of all light, each at a scale of its own. Private to
 * libretex. */
#ifndef RETEX_COMPACT_LAMPS_H
#define RETEX_COMPACT_LAMPS_H

#include "compact/distortion.h"

/* The term of all light that meets no target, of which that of single lamps is a share; -1: there is none, or several. */
int retex_compact_light_without_hits(const RetexSet *set);
/* Whether a term is light of a single lamp that meets no target. */
int retex_compact_is_lamp_share(const RetexTerm *term);

/* The scale of a kind's gain of a single lamp; place: see gains.h. The scale of a parameter's share of light that
 * meets no target. */
unsigned char *retex_compact_lamp_scale(const RetexCompactScales *scales, const RetexCompactLight *light, int kind,
                                        int place);
unsigned char *retex_compact_share_scale(const RetexCompactScales *scales, const RetexCompactLight *light,
                                         int parameter);

/* Make scales->lamps, which the caller frees, for sets with terms of role LAMP. All have this scale. */
int retex_compact_lamps_fixed(RetexCompactScales *scales, const RetexCompactLight *light, int scale, RetexError *err);
/* Choose them, after the others: of each lamp the fewest numbers by which its own picture, as bright as that by all
 * lamps but at most 20 times as bright as rendered, with textures of RETEX_COMPACT_GREY, is off by `bound` at most, a
 * mean squared error of sRGB-encoded colours. light is that of reference->set. */
int retex_compact_lamps_choose(RetexCompactScales *scales, const RetexCompactReference *reference,
                               const RetexCompactLight *light, double bound, int nthreads, RetexError *err);

#endif
