/* Pictures whose files have 8- or 16-bit integers, decoded row by row without OpenImageIO, which takes a sixth of a
 * second to load. The result is the same to the bit as the bridge's. Private to libretex. */
#ifndef RETEX_PICTURE_LEVELS_H
#define RETEX_PICTURE_LEVELS_H

#include <stdint.h>

#include <retex/image.h>

/* What is damaged in a picture file, for messages. */
typedef char RetexDamage[128];

/* An image of 16-bit integers, 65535 for 1: R,G,B,A, scene-linear Rec.709, premultiplied, rows from the top. The
 * pixels are freed with free(). */
typedef struct RetexNarrowImage {
    int width, height;
    uint16_t *pixels;
} RetexNarrowImage;

/* Where a decoder puts its rows: into one of the two images. */
typedef struct RetexLevels {
    RetexImage *image;        /* floats, unassociated alpha, or NULL */
    RetexNarrowImage *narrow; /* or NULL */
    int is_linear;            /* 1: the file's numbers are linear, for floats only; 0: they are sRGB */
    long max_pixels;          /* 0 = no limit */
    /* Private: of the picture that is decoded. */
    int width, height, channels, bits;
    void *values; /* by the file's numbers, of the image's type */
} RetexLevels;

/* What came of it. LEFT: the file is not of the format, has rare features, more than max_pixels pixels, or damage: then
 * the bridge must read it and report problems. */
enum { RETEX_LEVELS_LEFT, RETEX_LEVELS_READ, RETEX_LEVELS_NO_MEMORY };

/* Start a picture of 1 (grey), 2 (grey, alpha), 3 or 4 channels of 8 or 16 bits: allocates its pixels. */
int retex_levels_begin(RetexLevels *levels, int width, int height, int channels, int bits);
/* 16-bit numbers are in the machine's byte order. */
void retex_levels_row(const RetexLevels *levels, int y, const void *row);
/* Free what the picture needed, and its pixels if they are not wanted. */
void retex_levels_end(RetexLevels *levels, int keep);

#endif
