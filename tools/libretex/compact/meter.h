/* What pictures of a compact set lose, measured. Private to libretex. */
#ifndef RETEX_COMPACT_METER_H
#define RETEX_COMPACT_METER_H

#include "compact/build.h"

#define COMPACT_TRIALS (COMPACT_WAVES + 1) /* pictures: with waves or one colour on all targets, and the originals */
#define COMPACT_TILES 16

/* A set, or tiles of it where it is large, with its pictures. */
typedef struct CompactMeter {
    RetexSet *set;
    int tile;                      /* pixels of a tile's side, with margins that do not count; 0: the set is whole */
    double weights[COMPACT_TILES]; /* how many of the picture's tiles each stands for */
    RetexImage pictures[COMPACT_TRIALS]; /* sRGB-encoded */
    double noise; /* of the picture, mean square, by what denoising reads; 0 where that is not there */
} CompactMeter;

int compact_meter_open(CompactMeter *meter, const CompactLight *light, int nthreads, RetexError *err);
void compact_meter_close(CompactMeter *meter);

/* Pictures, linear, of a kind's terms in compact form: see compact_build_kind. Light is of meter->set. */
int compact_meter_show(RetexImage pictures[COMPACT_TRIALS], const CompactLight *light, int kind,
                       const CompactScales *scales, CompactCache *cache, int nthreads, RetexError *err);

/* Mean squared differences of the pictures that parts of light add up to, sRGB-encoded. */
int compact_meter_read(const CompactMeter *meter, const RetexImage *const parts[], int count,
                       double squares[COMPACT_TRIALS], int nthreads, RetexError *err);

#endif
