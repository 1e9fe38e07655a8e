/* What is asked of a compact set. Private to libretex. */
#ifndef RETEX_COMPACT_PARAMS_H
#define RETEX_COMPACT_PARAMS_H

#include <retex/set.h>

/* Begin with RETEX_COMPACT_INIT. */
typedef struct RetexCompactParams {
    double psnr; /* dB, 20 to 120: what pictures of the compact set should have about against the set's own, by what the
                    set tells of itself, and not counting noise that averages away; default 55 */
    int broad;   /* How many times smaller than the picture broad footprints are, 1, 2, 4 or 8, */
    int interreflection; /* later ones, */
    int gain;            /* and gains. 0, the default: as many times as psnr allows by a table. */
    int least;           /* as many times at least are later ones smaller, if the table chooses; default 1 */
    double noise; /* 0 to 1: how freely noise of the set is taken away, by which pictures of the compact set differ from
                     the set's more than by psnr, but not from the truth; default 1 */
    double lamps; /* dB: the same of pictures by one lamp, looked at as brightly as the whole; default 0: some less than
                     psnr */
    RetexWarn *warn; /* told, in the calling thread, why a set of layout footprints stays as it is; NULL = nobody */
    void *warn_context;
} RetexCompactParams;
#define RETEX_COMPACT_INIT { 55, 0, 0, 0, 1, 1, 0, NULL, NULL }

#endif
