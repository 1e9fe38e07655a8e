/* How many times smaller than the picture the images of a compact set are. Private to libretex. */
#ifndef RETEX_COMPACT_SCALES_H
#define RETEX_COMPACT_SCALES_H

#include "compact/light.h"

#define RETEX_COMPACT_STEPS 4 /* scales: 1, 2, 4, 8 */

/* By kind. */
typedef struct RetexCompactScales {
    int clusters[RETEX_COMPACT_KINDS]; /* footprints and weights; equal for all interreflections */
    int gains[RETEX_COMPACT_KINDS];
    RetexCompactMixed mixed[RETEX_COMPACT_KINDS];
    unsigned char *lamps; /* of gains of single lamps; NULL: no term is of role LAMP */
} RetexCompactScales;

/* The scale of a kind's gain of a single lamp; place: see gains.h. The scale of a parameter's share of light that
 * meets no target. */
unsigned char *retex_compact_lamp_scale(const RetexCompactScales *scales, const RetexCompactLight *light, int kind,
                                        int place);
unsigned char *retex_compact_share_scale(const RetexCompactScales *scales, const RetexCompactLight *light,
                                         int parameter);
/* Most places of a kind. */
int retex_compact_most_places(const RetexCompactLight *light);

#endif
