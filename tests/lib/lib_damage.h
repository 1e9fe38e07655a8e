/* All ways in which a set in a file can be read and used. Each gives a checksum of its result. A damaged file must be
 * refused, or give the checksum of the undamaged one. */
#ifndef LIB_DAMAGE_H
#define LIB_DAMAGE_H

#include "lib_test.h"

typedef enum DamageRoad {
    ROAD_ROWS,     /* opened, retextured row by row */
    ROAD_READ,     /* read into memory, retextured */
    ROAD_ESTIMATE, /* opened, its expected error computed */
    ROAD_SAMPLE,   /* opened, sampled into a band store, recombined from there */
    ROAD_STREAM,   /* the same, but written as a stream */
    ROAD_WRITE,    /* opened, written as another file */
    ROAD_PACK,     /* opened, loaded, packed without loss */
    ROAD_STRIPS,   /* opened, denoised in strips, recombined */
    ROAD_DENOISE,  /* read into memory, denoised, recombined */
    ROADS
} DamageRoad;

extern const char *const damage_road_names[ROADS];

/* To be called first: writes a texture, and makes room for temporary files, in that folder. */
void damage_begin(const char *folder);
void damage_end(void);

/* A set with everything that the roads need. It is small, but has more than one band of each kind. In layout footprints
 * it has a part that cannot be compressed. */
RetexSet *damage_set(const char *layout, uint32_t seed);
/* Write it as a file of one of these kinds. A stream has samples of one of its two targets. */
typedef enum DamageFile { FILE_SET, FILE_PLAIN, FILE_STREAM, FILE_PACK, FILE_LOSSLESS, DAMAGE_FILES } DamageFile;
extern const char *const damage_file_names[DAMAGE_FILES];
void damage_write(RetexSet *set, DamageFile kind, const char *path);
/* Take the checksums of bands from the manifest of an EXR file, and compute its own checksum anew: retex-set(5) says
 * that they may be missing. Other files are not changed. */
void damage_drop_bands(unsigned char *bytes, size_t size);
void damage_drop_bands_of_file(const char *path);

/* Run one road. Returns 0, with the checksum of the result in *sum, or the code of the refusal. Removes the files that
 * it writes. */
int damage_go(DamageRoad road, const char *path, uint32_t *sum, RetexError *err);

/* Kinds of damage to a file. A run is a number of successive bytes. */
typedef enum DamageKind {
    DAMAGE_BIT,    /* one bit is inverted */
    DAMAGE_BYTE,   /* one byte has another value */
    DAMAGE_NUMBER, /* four bytes become an extreme integer, or a float that is not a number */
    DAMAGE_CUT,    /* the end of the file is missing */
    DAMAGE_LOST,   /* a run in the middle is missing */
    DAMAGE_TWICE,  /* a run is repeated, and the bytes after it move */
    DAMAGE_ZEROS,  /* a run is 0 */
    DAMAGE_SWAP,   /* two runs are exchanged */
    DAMAGE_MOVED,  /* a run is copied over another one */
    DAMAGE_TAIL,   /* all bytes of the last run are the same */
    DAMAGE_KINDS
} DamageKind;
extern const char *const damage_kind_names[DAMAGE_KINDS];
enum { DAMAGE_ROOM = 64 }; /* bytes by which a file may grow */

/* Damage the bytes of a file, whose buffer has DAMAGE_ROOM more bytes. Returns the new size. A quarter of all cases are
 * near the beginning, where headers are. */
size_t damage_change(unsigned char *bytes, size_t size, DamageKind kind, uint32_t *seed);

#endif
