/* How much of a set's pictures is lost in smaller images, told from one pass over the set. Private to libretex. */
#ifndef RETEX_COMPACT_DETAIL_H
#define RETEX_COMPACT_DETAIL_H

#include "compact/scales.h"

/* Of an image: mean squares of errors of sRGB-encoded colours, by step (scale 1 << step), where a block of pixels has
 * one value; and what they would be of noise alone at an infinite scale. Real images lose less: values in between are
 * interpolated. Noise n and detail, which doubles at least from one step to the next, are told apart by the first two:
 *     squares[1] = 3/4 n + d, squares[2] = 15/16 n + 2 d
 */
typedef struct RetexCompactDetail {
    double squares[RETEX_COMPACT_STEPS], noise;
} RetexCompactDetail;

typedef struct RetexCompactDetails {
    RetexCompactDetail clusters[RETEX_COMPACT_KINDS]; /* of broad footprints, and those of further hits */
    RetexCompactDetail gains[RETEX_COMPACT_KINDS];    /* of all gains of all light together */
    double mixed[RETEX_COMPACT_KINDS]; /* mean square of light whose further hits may be a mixture of all targets */
    RetexCompactDetail *lamps; /* by place, as the lamps of RetexCompactScales, in the picture by that lamp; NULL: no
                                  term is of role LAMP */
    double noise;              /* mean square noise of the picture, with flat textures */
} RetexCompactDetails;

int retex_compact_details_open(RetexCompactDetails *details, const RetexCompactLight *light, int nthreads,
                               RetexError *err);
void retex_compact_details_close(RetexCompactDetails *details);

#endif
