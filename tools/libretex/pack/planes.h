/* Coding of planes: a plane is one channel of one strip as integers, which are predicted from their neighbours and
 * compressed. Maps turn samples into integers and back. Private to libretex; described in retex-pack(5). */
#ifndef RETEX_PACK_PLANES_H
#define RETEX_PACK_PLANES_H

#include <stddef.h>
#include <stdint.h>
#include <retex/image.h>

#include "pack/jpeg.h"
#include "base/row_span.h"

/* Which sample value an integer stands for. */
typedef enum RetexPackMapKind {
    RETEX_PACK_MAP_BITS,    /* the bits of a half or float, reordered so that larger values have larger numbers */
    RETEX_PACK_MAP_LATTICE, /* c * 2^-LATTICE_BITS; c is a multiple of 2^shift, by the standard deviation */
    RETEX_PACK_MAP_LOG,     /* code 0: 0; code c: first * 2^((c - 1) / per_octave) */
    RETEX_PACK_MAP_LINEAR,  /* c * first */
    RETEX_PACK_MAP_ANGLE,   /* sin((c - 128) / per_octave * pi / 2): a correlation */
    RETEX_PACK_MAP_STEP,    /* axes, which are the steps of means (set/steps.h): c is the size along u or v as in LOG */
    RETEX_PACK_MAP_PALETTE, /* where few samples differ, as in textures of 8 bits: c-th of them, in the order of BITS */
    RETEX_PACK_MAPS
} RetexPackMapKind;

extern const char *const retex_pack_map_names[RETEX_PACK_MAPS];

enum { RETEX_PACK_LATTICE_BITS = 18, RETEX_PACK_LATTICE_SHIFT_MAX = 24, RETEX_PACK_CODES = 256 };

typedef struct RetexPackMap {
    RetexPackMapKind kind;
    double first;
    int per_octave;
    float value[RETEX_PACK_CODES];     /* by code, for kinds from LOG on */
    int32_t palette[RETEX_PACK_CODES]; /* of PALETTE: by code, the number that BITS has, ascending */
    int count;                         /* of numbers in the palette */
} RetexPackMap;

int retex_pack_map_is_coded(const RetexPackMap *map); /* 1: numbers are codes from 0 to 255 */
void retex_pack_map_fill(RetexPackMap *map);          /* compute value[] from first and per_octave */
void retex_pack_map_fill_palette(RetexPackMap *map, RetexPixelType type); /* and from the palette */
/* Make a map of BITS one of PALETTE, if that is small for so many samples, `stride` floats apart. */
void retex_pack_map_find_palette(RetexPackMap *map, const float *samples, size_t stride, size_t count,
                                 RetexPixelType type);
/* Turn `count` samples, `stride` floats apart, into numbers, and numbers into samples; of steps into the numbers of
 * their sizes: samples are those to the right, two channels on are those down. */
void retex_pack_map_numbers(int32_t *numbers, const float *samples, size_t stride, size_t count,
                            const RetexPackMap *map, RetexPixelType type);
void retex_pack_map_samples(float *samples, size_t stride, const int32_t *numbers, size_t count,
                            const RetexPackMap *map, RetexPixelType type);
/* Turn codes into samples. */
void retex_pack_map_codes(float *samples, size_t stride, const unsigned char *codes, size_t count,
                          const RetexPackMap *map);

/* The runs of pixels that are present in a plane, row by row. */
typedef struct RetexPackRuns {
    size_t pixels;                        /* that are present */
    int first[RETEX_PACK_STRIP_ROWS + 1]; /* runs of row y: run[first[y]] to run[first[y + 1] - 1] */
    RetexRowSpan *run;
} RetexPackRuns;

/* The largest possible number of runs. */
static inline size_t retex_pack_runs_bound(int width, int rows)
{
    return (size_t)(width / 2 + 1) * (size_t)rows;
}

/* A plane of numbers: width x rows, of which there are at most RETEX_PACK_STRIP_ROWS. */
typedef struct RetexPackPlane {
    int width, rows;
    int bits;                     /* of a number: 8, 16 or 32; arithmetic wraps around */
    const unsigned char *present; /* by pixel, 0: absent, not stored; NULL: all are present */
    const unsigned char *shift;   /* by pixel: the number is a multiple of 2^shift; NULL: shift 0 */
    int32_t *numbers;
    const RetexPackRuns *runs; /* the present pixels as runs, for decoding */
    unsigned char *codes;      /* output of decoding if bits is 8 */
} RetexPackPlane;

/* Upper bound on the bytes of a plane's residuals, and of the compressed plane. */
size_t retex_pack_plane_bound(const RetexPackPlane *plane);

/* Encode into data. data and scratch have retex_pack_plane_bound bytes each. effort: 1 to 9. Returns the number of
 * bytes, 0 if every present number is 0, or -1 if compression fails. */
long retex_pack_plane_encode(unsigned char *data, const RetexPackPlane *plane, unsigned char *scratch, int effort);

/* The residuals alone, *bytes bytes each, little-endian, by the predictor that makes them smallest. `to` has 4 bytes a
 * pixel. Returns their size in bytes, 0 if every present number is 0. */
size_t retex_pack_plane_residuals(unsigned char *to, const RetexPackPlane *plane, int *predictor, int *bytes);

/* Decode into plane->numbers, or into plane->codes if bits is 8. Absent pixels are not written. Returns 1, or 0 if the
 * data is damaged. */
int retex_pack_plane_decode(const RetexPackPlane *plane, const unsigned char *data, size_t bytes,
                            unsigned char *scratch);

#endif
