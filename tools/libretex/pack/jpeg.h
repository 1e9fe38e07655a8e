/* Radiance as JPEG, strip by strip. An image is one baseline JPEG file, 4:4:4 or grey. Its restart interval is the rows
 * of one strip, so each strip's slice, put after the file's header, can be decoded alone.
 *
 * libretex has its own DCT, in floating point, for encoding and decoding. So decoded values are not rounded to 8 bits,
 * and values above white are kept; other viewers round and clip them. Private to libretex; described in
 * retex-pack(5). */
#ifndef RETEX_PACK_JPEG_H
#define RETEX_PACK_JPEG_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

enum {
    RETEX_PACK_STRIP_ROWS = 64,
    RETEX_PACK_BLOCK_ROWS = 8,        /* rows of a DCT block */
    RETEX_PACK_JPEG_SIDE_MAX = 65500, /* pixels: libjpeg's limit; a strip's blocks fit in a restart interval */
    RETEX_PACK_JPEG_STEP_MAX = 255
};

enum {
    RETEX_PACK_LEVELS_MOST = 8 * 255, /* most levels from black to white */
    RETEX_PACK_WHITES_MOST = 8        /* the highest level, as a multiple of white's level */
};

/* Maps values (linear radiance) to levels (what the DCT transforms) and back: see retex-pack(5). */
typedef struct RetexPackCurve {
    double white[3]; /* by channel, of grey the first: the value that maps to */
    double levels;   /* this level, from 255, which viewers show as white, to RETEX_PACK_LEVELS_MOST */
} RetexPackCurve;

RetexPackCurve retex_pack_curve(double white, double levels); /* of one white in all channels */
double retex_pack_curve_level(const RetexPackCurve *curve, int channel, double value);
double retex_pack_curve_value(const RetexPackCurve *curve, int channel, double level);

/* A JPEG file and the sizes of its slices: slice_bytes[0] is the header, the others are the strips, each with the
 * marker that ends it. */
typedef struct RetexPackJpeg {
    unsigned char *data; /* malloc'ed */
    size_t bytes;
    int nslices;
    size_t *slice_bytes; /* malloc'ed */
} RetexPackJpeg;

void retex_pack_jpeg_free(RetexPackJpeg *jpeg);

/* Encode width x height pixels of levels (interleaved; channels: 1 or 3) with quantizer steps of `step` levels, at
 * least 1. */
int retex_pack_jpeg_encode(RetexPackJpeg *jpeg, const float *levels, int width, int height, int channels, double step,
                           RetexError *err);

/* Decodes one JPEG strip at a time. Each thread needs its own. */
typedef struct RetexPackJpegDecoder RetexPackJpegDecoder;
int retex_pack_jpeg_decoder_create(RetexPackJpegDecoder **decoder, RetexError *err);
void retex_pack_jpeg_decoder_close(RetexPackJpegDecoder **decoder); /* NULL and pointers to NULL are fine */

/* Open one strip, in place of the one that was open. file: the header followed by the strip's slice; it is modified,
 * and may be freed after the call. RETEX_EFORMAT if libjpeg gives an error or warning, or if the size differs. */
int retex_pack_jpeg_open_strip(RetexPackJpegDecoder *decoder, unsigned char *file, size_t header, size_t bytes,
                               int width, int rows, int channels, const RetexPackCurve *curve, RetexError *err);

/* Decode one row of blocks of the open strip: 8 rows of pixels, or fewer at its end. */
int retex_pack_jpeg_decode_blocks(RetexPackJpegDecoder *decoder, int row, float *values, RetexError *err);

#endif
