/* Light as JPEG, band by band. A picture is one plain JPEG file, 4:4:4 or grey, with a restart interval of a band's
 * rows, so that each band's piece of it can be decoded alone, behind the file's header.
 *
 * The transform is our own, in floating point, at both ends: 8 bits are then what a viewer gets, not what is kept, and
 * values above white (which a viewer clips) are kept too. Private to libretex; described in retex-pack(5). */
#ifndef RETEX_PACK_JPEG_H
#define RETEX_PACK_JPEG_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

enum {
    PACK_BAND_ROWS = 64,
    PACK_BLOCK_ROWS = 8, /* of a JPEG's blocks */
    PACK_JPEG_SIDE_MAX = 65500, /* pixels; libjpeg's own limit. A band's 8 rows of 8188 blocks are within 65535 */
    PACK_JPEG_STEP_MAX = 255
};

enum {
    PACK_LEVELS_MOST = 8 * 255, /* to white */
    PACK_WHITES_MOST = 8        /* times white's is the highest level */
};

/* Which value a level stands for: see retex-pack(5). */
typedef struct PackCurve {
    double white;  /* a value, which is */
    double levels; /* this level: 255, which viewers show as white, to PACK_LEVELS_MOST */
} PackCurve;

double pack_curve_level(const PackCurve *curve, double value);
double pack_curve_value(const PackCurve *curve, double level);

/* A JPEG file taken apart: bytes pieces[0] of header, then those of each band with the marker that ends it. */
typedef struct PackJpeg {
    unsigned char *data; /* malloc'ed */
    size_t bytes;
    int npieces;
    size_t *pieces; /* malloc'ed */
} PackJpeg;

void pack_jpeg_free(PackJpeg *jpeg);

/* Encode levels (channels: 1 or 3, interleaved, width x height) with quantisation steps of `step` levels, 1 or more. */
int pack_jpeg_encode(PackJpeg *jpeg, const float *levels, int width, int height, int channels, double step,
                     RetexError *err);

/* A thread's means of decoding one JPEG. */
typedef struct PackJpegDecoder PackJpegDecoder;
int pack_jpeg_decoder_create(PackJpegDecoder **decoder, RetexError *err);
void pack_jpeg_decoder_close(PackJpegDecoder **decoder); /* NULL and pointers to NULL are fine */

/* Take one band of rows, which is the open one then: file is the header followed by the band's piece, and not needed
 * any more afterwards. What does not decode without complaint, or is of another size, is RETEX_EFORMAT. */
int pack_jpeg_open_band(PackJpegDecoder *decoder, unsigned char *file, size_t header, size_t bytes, int width, int rows,
                        int channels, const PackCurve *curve, RetexError *err);

/* The values of one row of blocks of the open band: 8 rows of pixels, or those that are left. */
int pack_jpeg_decode_blocks(PackJpegDecoder *decoder, int row, float *values, RetexError *err);

#endif
