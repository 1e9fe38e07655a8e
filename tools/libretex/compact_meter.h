/* What pictures of a compact set lose, measured. Private to libretex. */
#ifndef RETEX_LIBRETEX_COMPACT_METER_H
#define RETEX_LIBRETEX_COMPACT_METER_H

#include <retex/set.h>

#define COMPACT_TRIALS 5 /* pictures: with waves of four lengths on all targets, and with the originals */

/* A set, or tiles of it where it is large, with its pictures. */
typedef struct CompactMeter {
    RetexSet *set;
    int tile; /* pixels of a tile's side, with margins that do not count; 0: the set is whole */
    RetexImage pictures[COMPACT_TRIALS];
    double noise; /* of the picture, mean square, by what denoising reads; 0 where that is not there */
} CompactMeter;

int compact_meter_open(CompactMeter *meter, const RetexSet *set, int nthreads, RetexError *err);
void compact_meter_close(CompactMeter *meter);

/* Mean squared differences of the pictures of a compact form of meter->set, sRGB-encoded. */
int compact_meter_read(const CompactMeter *meter, const RetexSet *compact, double squares[COMPACT_TRIALS], int nthreads,
                       RetexError *err);

#endif
