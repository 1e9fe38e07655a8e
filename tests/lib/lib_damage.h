/* All roads that a set in a file can go, each to a checksum of what came of it: a damaged file must be refused, or give
 * what the whole one does. */
#ifndef LIB_DAMAGE_H
#define LIB_DAMAGE_H

#include "lib_test.h"

typedef enum DamageRoad {
    ROAD_ROWS,     /* open, retextured row by row */
    ROAD_READ,     /* read whole, retextured */
    ROAD_ESTIMATE, /* open, its error estimated */
    ROAD_SAMPLE,   /* open, sampled into a band store, recombined from there */
    ROAD_STREAM,   /* the same, but written as a stream */
    ROAD_WRITE,    /* open, written as another file */
    ROAD_PACK,     /* open, loaded, packed without loss */
    ROAD_STRIPS,   /* open, denoised, recombined */
    ROAD_DENOISE,  /* read whole, the same */
    ROADS
} DamageRoad;

extern const char *const damage_road_names[ROADS];

/* Beforehand: a texture and files of their own are in that folder. */
void damage_begin(const char *folder);
void damage_end(void);

/* A set for them, with all that they need: small, but of more than one band of any kind; and, of layout footprints,
 * with a part that no compression makes smaller. */
RetexSet *damage_set(const char *layout, uint32_t seed);
/* Write it as a file of one of these kinds; a stream has samples of one of its two targets. */
typedef enum DamageFile { FILE_SET, FILE_PLAIN, FILE_STREAM, FILE_PACK, FILE_LOSSLESS, DAMAGE_FILES } DamageFile;
extern const char *const damage_file_names[DAMAGE_FILES];
void damage_write(RetexSet *set, DamageFile kind, const char *path);
/* Make it one of before there were checksums of manifests and bands; a pack stays as it is. */
void damage_make_old(const char *path);

/* Go one. 0, and *sum tells what came of it; or what refused it. What it writes is gone when it returns. */
int damage_go(DamageRoad road, const char *path, uint32_t *sum, RetexError *err);

/* What may happen to a file on a disk or on its way. */
typedef enum DamageKind {
    DAMAGE_BIT,   /* one is the other */
    DAMAGE_BYTE,  /* one is another */
    DAMAGE_NUMBER, /* four bytes are a number at the edge of something, or a float that is none */
    DAMAGE_CUT,   /* its end is missing */
    DAMAGE_LOST,  /* a run is missing in between */
    DAMAGE_TWICE, /* a run is there once more, and all behind it moves */
    DAMAGE_ZEROS, /* a run is 0 */
    DAMAGE_SWAP,  /* two runs have changed places */
    DAMAGE_MOVED, /* a run has been written over another one */
    DAMAGE_TAIL,  /* the last run is one byte again and again */
    DAMAGE_KINDS
} DamageKind;
extern const char *const damage_kind_names[DAMAGE_KINDS];
enum { DAMAGE_ROOM = 64 }; /* what it may be longer by */

/* Damage a file's bytes, which have room for DAMAGE_ROOM more: its size then. In a quarter of all cases near the
 * beginning, where headers are. */
size_t damage_change(unsigned char *bytes, size_t size, DamageKind kind, uint32_t *seed);

#endif
