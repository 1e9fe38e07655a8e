/* JPEG through libjpeg. */
#include "picture/jpeg_read.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <jerror.h> /* needs the one above */

enum { LINES = 16, TAG_ORIENTATION = 0x0112, TAG_BYTES = 12 };

typedef struct Decoder {
    struct jpeg_decompress_struct jpeg; /* first: libjpeg hands back pointers to it */
    struct jpeg_error_mgr errors;
    jmp_buf failed;
    unsigned char *lines;
    int is_damaged; /* libjpeg has warned of it */
} Decoder;

static void error_exit(j_common_ptr jpeg)
{
    Decoder *d = (Decoder *)(void *)jpeg;

    longjmp(d->failed, 1);
}

/* Warnings of odd headers that change nothing of the pixels. */
static int is_harmless(int code)
{
    return code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR || code == JWRN_NOT_SEQUENTIAL;
}

/* Other warnings mean damage: libjpeg goes on with whatever it makes of the data. */
static void message(j_common_ptr jpeg, int level)
{
    Decoder *d = (Decoder *)(void *)jpeg;

    if (level >= 0 || is_harmless(jpeg->err->msg_code))
        return;
    d->is_damaged = 1;
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

static int is_plain(const struct jpeg_decompress_struct *jpeg)
{
    const int colors = jpeg->jpeg_color_space == JCS_YCbCr || jpeg->jpeg_color_space == JCS_RGB;

    if (!(colors || jpeg->jpeg_color_space == JCS_GRAYSCALE))
        return 0;
    for (jpeg_saved_marker_ptr marker = jpeg->marker_list; marker; marker = marker->next)
        if (find_orientation(marker->data, marker->data_length) != 1 || is_profile(marker))
            return 0;
    return 1;
}

static int decode(RetexLevels *levels, Decoder *d, const void *data, size_t bytes)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    unsigned char *lines[LINES];

    if (setjmp(d->failed))
        return RETEX_LEVELS_LEFT;
    jpeg_create_decompress(jpeg);
    jpeg_mem_src(jpeg, data, (unsigned long)bytes);
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(jpeg, JPEG_APP0 + 2, 0xffff);
    if (jpeg_read_header(jpeg, TRUE) != JPEG_HEADER_OK || !is_plain(jpeg))
        return RETEX_LEVELS_LEFT;
    jpeg->out_color_space = jpeg->jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
    const int channels = jpeg->out_color_space == JCS_GRAYSCALE ? 1 : 3,
              code = retex_levels_begin(levels, (int)jpeg->image_width, (int)jpeg->image_height, channels, 8);
    if (code != RETEX_LEVELS_READ)
        return code;
    jpeg_start_decompress(jpeg);
    const size_t row = (size_t)jpeg->output_width * (size_t)channels;
    d->lines = malloc(row * LINES);
    if (!d->lines)
        return RETEX_LEVELS_NO_MEMORY;
    for (int i = 0; i < LINES; i++)
        lines[i] = d->lines + row * (size_t)i;
    while (jpeg->output_scanline < jpeg->output_height) {
        const int first = (int)jpeg->output_scanline, count = (int)jpeg_read_scanlines(jpeg, lines, LINES);
        for (int i = 0; i < count; i++)
            retex_levels_row(levels, first + i, lines[i]);
    }
    jpeg_finish_decompress(jpeg);
    return RETEX_LEVELS_READ;
}

static Decoder *new_decoder(void)
{
    Decoder *d = calloc(1, sizeof *d);

    if (d) {
        d->jpeg.err = jpeg_std_error(&d->errors);
        d->errors.error_exit = error_exit;
        d->errors.emit_message = message;
    }
    return d;
}

static void free_decoder(Decoder *d)
{
    jpeg_destroy_decompress(&d->jpeg);
    free(d->lines);
    free(d);
}

/* Decodes a file at an eighth of its size, which takes little more than reading all coefficients. 0 where libjpeg gave
 * up or warned. */
static int decode_small(Decoder *d, const void *data, size_t bytes)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;

    if (setjmp(d->failed))
        return 0;
    jpeg_create_decompress(jpeg);
    jpeg_mem_src(jpeg, data, (unsigned long)bytes);
    jpeg_read_header(jpeg, TRUE);
    jpeg->scale_num = 1, jpeg->scale_denom = DCTSIZE;
    jpeg->out_color_space = jpeg->jpeg_color_space;
    jpeg->do_fancy_upsampling = FALSE;
    jpeg_start_decompress(jpeg);
    d->lines = malloc((size_t)jpeg->output_width * (size_t)jpeg->output_components);
    while (d->lines && jpeg->output_scanline < jpeg->output_height)
        jpeg_read_scanlines(jpeg, &d->lines, 1);
    jpeg_finish_decompress(jpeg);
    return 1;
}

int retex_jpeg_read(RetexLevels *levels, const void *data, size_t bytes)
{
    Decoder *d = new_decoder();

    if (!d)
        return RETEX_LEVELS_NO_MEMORY;
    const int done = decode(levels, d, data, bytes);
    free_decoder(d);
    return done;
}

int retex_jpeg_is_damaged(const void *data, size_t bytes, RetexDamage damage)
{
    char text[JMSG_LENGTH_MAX];
    Decoder *d = new_decoder();

    if (!d) /* whoever decodes it will tell */
        return 0;
    const int is_damaged = !decode_small(d, data, bytes) && d->is_damaged;
    if (is_damaged) {
        d->errors.format_message((j_common_ptr)&d->jpeg, text);
        snprintf(damage, sizeof(RetexDamage), "the file is damaged: %.100s", text);
    }
    free_decoder(d);
    return is_damaged;
}
