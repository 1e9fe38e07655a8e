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
    RETEX_PACK_BAND_ROWS = 64,
    RETEX_PACK_BLOCK_ROWS = 8,        /* of a JPEG's blocks */
    RETEX_PACK_JPEG_SIDE_MAX = 65500, /* pixels; libjpeg's own limit. A band's 8 rows of 8188 blocks are within 65535 */
    RETEX_PACK_JPEG_STEP_MAX = 255
};

enum {
    RETEX_PACK_LEVELS_MOST = 8 * 255, /* to white */
    RETEX_PACK_WHITES_MOST = 8        /* times white's is the highest level */
};

/* Which value a level stands for: see retex-pack(5). */
typedef struct RetexPackCurve {
    double white;  /* a value, which is */
    double levels; /* this level: 255, which viewers show as white, to RETEX_PACK_LEVELS_MOST */
} RetexPackCurve;

double retex_pack_curve_level(const RetexPackCurve *curve, double value);
double retex_pack_curve_value(const RetexPackCurve *curve, double level);

/* A JPEG file taken apart: bytes pieces[0] of header, then those of each band with the marker that ends it. */
typedef struct RetexPackJpeg {
    unsigned char *data; /* malloc'ed */
    size_t bytes;
    int npieces;
    size_t *pieces; /* malloc'ed */
} RetexPackJpeg;

void retex_pack_jpeg_free(RetexPackJpeg *jpeg);

/* Encode levels (channels: 1 or 3, interleaved, width x height) with quantisation steps of `step` levels, 1 or more. */
int retex_pack_jpeg_encode(RetexPackJpeg *jpeg, const float *levels, int width, int height, int channels, double step,
                           RetexError *err);

/* A thread's means of decoding one JPEG. */
typedef struct RetexPackJpegDecoder RetexPackJpegDecoder;
int retex_pack_jpeg_decoder_create(RetexPackJpegDecoder **decoder, RetexError *err);
void retex_pack_jpeg_decoder_close(RetexPackJpegDecoder **decoder); /* NULL and pointers to NULL are fine */

/* Take one band of rows, which is the open one then: file is the header followed by the band's piece, and not needed
 * any more afterwards. What does not decode without complaint, or is of another size, is RETEX_EFORMAT. */
int retex_pack_jpeg_open_band(RetexPackJpegDecoder *decoder, unsigned char *file, size_t header, size_t bytes,
                              int width, int rows, int channels, const RetexPackCurve *curve, RetexError *err);

/* The values of one row of blocks of the open band: 8 rows of pixels, or those that are left. */
int retex_pack_jpeg_decode_blocks(RetexPackJpegDecoder *decoder, int row, float *values, RetexError *err);

#endif
