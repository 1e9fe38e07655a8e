/* Planes: one channel of one band as whole numbers, predicted from their neighbours and compressed, and what the
 * numbers stand for. Private to libretex; described in retex-pack(5). */
#ifndef RETEX_PACK_PLANES_H
#define RETEX_PACK_PLANES_H

#include <stddef.h>
#include <stdint.h>
#include <retex/image.h>

#include "pack/jpeg.h"
#include "base/row_span.h"

/* What a number stands for. */
typedef enum RetexPackMapKind {
    RETEX_PACK_MAP_BITS,    /* the bits of a half or float, in the order of the values they mean */
    RETEX_PACK_MAP_LATTICE, /* multiples of 2^-LATTICE_BITS; coarser where standard deviations are large */
    RETEX_PACK_MAP_LOG,     /* 0: zero; c: first * 2^((c - 1) / per_octave) */
    RETEX_PACK_MAP_LINEAR,  /* c * first */
    RETEX_PACK_MAP_ANGLE,   /* sin((c - 128) / per_octave * pi / 2): a correlation */
    RETEX_PACK_MAPS
} RetexPackMapKind;

extern const char *const retex_pack_map_names[RETEX_PACK_MAPS];

enum {
    RETEX_PACK_LATTICE_BITS = 18,
    RETEX_PACK_LATTICE_SHIFT_MAX = 24,
    RETEX_PACK_MEAN_BITS = 5,
    RETEX_PACK_CODES = 256
};

typedef struct RetexPackMap {
    RetexPackMapKind kind;
    double first;
    int per_octave;
    float value[RETEX_PACK_CODES]; /* of each code, for the last three kinds */
} RetexPackMap;

int retex_pack_map_is_coded(const RetexPackMap *map); /* 1: numbers are codes of a byte */
void retex_pack_map_fill(RetexPackMap *map);          /* the values, from the other fields */
/* Numbers of `count` samples, `stride` floats apart, and back. */
void retex_pack_map_numbers(int32_t *numbers, const float *samples, size_t stride, size_t count,
                            const RetexPackMap *map, RetexPixelType type);
void retex_pack_map_samples(float *samples, size_t stride, const int32_t *numbers, size_t count,
                            const RetexPackMap *map, RetexPixelType type);
/* Back, of codes of a byte. */
void retex_pack_map_codes(float *samples, size_t stride, const unsigned char *codes, size_t count,
                          const RetexPackMap *map);

/* Numbers side by side that matter: all of a plane's, row by row. */
typedef struct RetexPackRuns {
    size_t pixels;                       /* that matter */
    int first[RETEX_PACK_BAND_ROWS + 1]; /* row y has run[first[y]] to run[first[y + 1] - 1] */
    RetexRowSpan *run;
} RetexPackRuns;

/* Most runs that there can be. */
static inline size_t retex_pack_runs_bound(int width, int rows)
{
    return (size_t)(width / 2 + 1) * (size_t)rows;
}

/* A plane of numbers: width x rows, of which there are at most RETEX_PACK_BAND_ROWS. */
typedef struct RetexPackPlane {
    int width, rows;
    int bits;                     /* of a number: 8, 16 or 32; sums wrap around there */
    const unsigned char *present; /* 0: this number does not matter and is not stored; NULL: all matter */
    const unsigned char *shift;   /* numbers are multiples of 2^shift; NULL: of 1 */
    int32_t *numbers;
    const RetexPackRuns *runs; /* of what is present, which decoding needs */
    unsigned char *codes;      /* where decoding puts numbers of 8 bits */
} RetexPackPlane;

/* Most bytes that a plane's residuals, and its compressed form, may need. */
size_t retex_pack_plane_bound(const RetexPackPlane *plane);

/* Compress into data, of retex_pack_plane_bound bytes; scratch is as large. Returns the number of bytes, 0 where every
 * number that matters is 0, or -1 if compression fails. effort 1..9. */
long retex_pack_plane_encode(unsigned char *data, const RetexPackPlane *plane, unsigned char *scratch, int effort);

/* And back, into plane->numbers, or plane->codes; those that do not matter are left alone. 1, or 0 where the data is
 * damaged. */
int retex_pack_plane_decode(const RetexPackPlane *plane, const unsigned char *data, size_t bytes,
                            unsigned char *scratch);

#endif
