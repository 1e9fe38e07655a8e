/* See jpeg_read.h. Files with rare features are left to OpenImageIO. */
#include "picture/jpeg_read.h"

#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include <retex/color.h>
#include <retex/image.h>

enum { LINES = 16, TAG_ORIENTATION = 0x0112, TAG_BYTES = 12 };

typedef struct Decoder {
    struct jpeg_decompress_struct jpeg; /* first: libjpeg hands back pointers to it */
    struct jpeg_error_mgr errors;
    jmp_buf failed;
    uint16_t *pixels;
    unsigned char *lines;
} Decoder;

static void error_exit(j_common_ptr jpeg)
{
    Decoder *d = (Decoder *)(void *)jpeg;

    longjmp(d->failed, 1);
}

/* Counts warnings, which mean damage; other messages are ignored. */
static void message(j_common_ptr jpeg, int level)
{
    if (level < 0)
        error_exit(jpeg);
}

static unsigned get_number(const unsigned char *at, int bytes, int big)
{
    unsigned value = 0;

    for (int i = 0; i < bytes; i++)
        value |= (unsigned)at[i] << 8 * (big ? bytes - 1 - i : i);
    return value;
}

/* The orientation by Exif, 1 where it is absent; 0 where the data are not understood. */
static unsigned find_orientation(const unsigned char *exif, size_t bytes)
{
    if (bytes < 14 || memcmp(exif, "Exif\0", 6) != 0)
        return 1;
    const unsigned char *tiff = exif + 6;
    const int big = tiff[0] == 'M';
    const size_t size = bytes - 6, first = get_number(tiff + 4, 4, big);
    if (first + 2 > size)
        return 0;
    const size_t count = get_number(tiff + first, 2, big);
    for (size_t i = 0; i < count; i++) {
        const size_t at = first + 2 + i * TAG_BYTES;
        if (at + TAG_BYTES > size)
            return 0;
        if (get_number(tiff + at, 2, big) == TAG_ORIENTATION)
            return get_number(tiff + at + 8, 2, big);
    }
    return 1;
}

/* Whether the marker is a part of an ICC profile. */
static int is_profile(jpeg_saved_marker_ptr marker)
{
    return marker->marker == JPEG_APP0 + 2 && marker->data_length >= 12 && memcmp(marker->data, "ICC_PROFILE", 12) == 0;
}

static int is_plain(const struct jpeg_decompress_struct *jpeg, long max_pixels)
{
    const long pixels = (long)jpeg->image_width * (long)jpeg->image_height;
    const int colors = jpeg->jpeg_color_space == JCS_YCbCr || jpeg->jpeg_color_space == JCS_RGB;

    if (jpeg->image_width > RETEX_MAX_SIZE || jpeg->image_height > RETEX_MAX_SIZE ||
        (max_pixels > 0 && pixels > max_pixels) || !(colors || jpeg->jpeg_color_space == JCS_GRAYSCALE))
        return 0;
    for (jpeg_saved_marker_ptr marker = jpeg->marker_list; marker; marker = marker->next)
        if (find_orientation(marker->data, marker->data_length) != 1 || is_profile(marker))
            return 0;
    return 1;
}

/* Linear values of the file's levels, the same as the bridge's. */
static void fill_table(uint16_t table[256])
{
    for (int i = 0; i < 256; i++) {
        const float linear = (float)retex_srgb_decode(i / 255.0);
        table[i] = (uint16_t)(linear * 65535.0f + 0.5f);
    }
}

static void convert(uint16_t *restrict to, const unsigned char *restrict from, size_t pixels, int channels,
                    const uint16_t *restrict table)
{
    for (size_t i = 0; i < pixels; i++, to += 4, from += channels) {
        to[0] = table[from[0]];
        to[1] = table[from[channels == 3 ? 1 : 0]];
        to[2] = table[from[channels == 3 ? 2 : 0]];
        to[3] = 65535;
    }
}

/* 1: decoded into d->pixels; 0: a file for OpenImageIO; -1: out of memory. */
static int decode(Decoder *d, const void *data, size_t bytes, long max_pixels)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    unsigned char *lines[LINES];
    uint16_t table[256];

    if (setjmp(d->failed))
        return 0;
    jpeg_create_decompress(jpeg);
    jpeg_mem_src(jpeg, data, (unsigned long)bytes);
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(jpeg, JPEG_APP0 + 2, 0xffff);
    if (jpeg_read_header(jpeg, TRUE) != JPEG_HEADER_OK || !is_plain(jpeg, max_pixels))
        return 0;
    jpeg->out_color_space = jpeg->jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(jpeg);
    const size_t width = jpeg->output_width, row = width * (size_t)jpeg->output_components;
    d->pixels = malloc(sizeof *d->pixels * 4 * width * jpeg->output_height);
    d->lines = malloc(row * LINES);
    if (!d->pixels || !d->lines)
        return -1;
    for (int i = 0; i < LINES; i++)
        lines[i] = d->lines + row * (size_t)i;
    fill_table(table);
    while (jpeg->output_scanline < jpeg->output_height) {
        const JDIMENSION first = jpeg->output_scanline, count = jpeg_read_scanlines(jpeg, lines, LINES);
        for (JDIMENSION i = 0; i < count; i++)
            convert(d->pixels + 4 * width * (first + i), lines[i], width, jpeg->output_components, table);
    }
    jpeg_finish_decompress(jpeg);
    return 1;
}

int retex_jpeg_read_narrow(RetexNarrowImage *dst, RetexInput *input, long max_pixels, RetexError *err)
{
    const void *data;
    size_t bytes;
    unsigned char begin[3];

    *dst = (RetexNarrowImage){0};
    if (retex_input_read(input, begin, sizeof begin, 0) != sizeof begin || memcmp(begin, "\xff\xd8\xff", 3) != 0)
        return retex_input_check(input, RETEX_OK, err);
    const int code = retex_input_load(input, &data, &bytes, err);
    if (code)
        return code;
    Decoder *d = calloc(1, sizeof *d);
    if (!d)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", retex_input_name(input));
    d->jpeg.err = jpeg_std_error(&d->errors);
    d->errors.error_exit = error_exit;
    d->errors.emit_message = message;
    const int done = decode(d, data, bytes, max_pixels);
    if (done > 0) {
        *dst = (RetexNarrowImage){(int)d->jpeg.output_width, (int)d->jpeg.output_height, d->pixels};
        d->pixels = NULL;
    }
    jpeg_destroy_decompress(&d->jpeg);
    free(d->pixels);
    free(d->lines);
    free(d);
    return done < 0 ? retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", retex_input_name(input)) : 0;
}
