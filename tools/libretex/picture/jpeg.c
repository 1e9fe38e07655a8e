/* JPEG, strip by strip. Each strip is compressed separately, as if it were a picture. Quantisation and Huffman tables
 * do not depend on the content, so that of all strips but the first only the entropy-coded data are used, joined by
 * restart markers, at which decoders start again anyway. The pixels are the same as when the picture is compressed at
 * once. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include "picture/format.h"

/* A strip is a whole number of MCUs, which have 8 or 16 lines; no restart interval is too long for its 16 bits. */
_Static_assert(RETEX_PICTURE_STRIP % 16 == 0, "a strip ends where MCUs do");
_Static_assert((JPEG_MAX_DIMENSION + 7) / 8 * (RETEX_PICTURE_STRIP / 8) <= 65535, "a strip has too many MCUs");

enum { QUALITY_OF_FULL_COLOR = 90, INITIAL_CAPACITY = 1 << 16, MARKER_BYTES = 2 };

typedef struct Compressor {
    struct jpeg_compress_struct jpeg; /* first member: libjpeg passes pointers to it */
    struct jpeg_error_mgr errors;
    struct jpeg_destination_mgr to;
    jmp_buf failed;
    unsigned char *data;
    size_t capacity;
    char message[JMSG_LENGTH_MAX];
} Compressor;

static size_t bytes_written(const Compressor *c)
{
    return c->capacity - c->to.free_in_buffer;
}

static void error_exit(j_common_ptr jpeg)
{
    Compressor *c = (Compressor *)(void *)jpeg;

    jpeg->err->format_message(jpeg, c->message);
    longjmp(c->failed, 1);
}

static void discard_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

static boolean grow_output(j_compress_ptr jpeg)
{
    Compressor *c = (Compressor *)(void *)jpeg;
    const size_t capacity = c->capacity ? 2 * c->capacity : INITIAL_CAPACITY, have = c->capacity;
    unsigned char *data = realloc(c->data, capacity);

    if (!data) {
        snprintf(c->message, sizeof c->message, "not enough memory");
        longjmp(c->failed, 1);
    }
    c->data = data;
    c->capacity = capacity;
    c->to.next_output_byte = data + have;
    c->to.free_in_buffer = capacity - have;
    return TRUE;
}

static void begin_output(j_compress_ptr jpeg)
{
    grow_output(jpeg);
}

static void end_output(j_compress_ptr jpeg)
{
    (void)jpeg;
}

/* Writes the program's name and, where it is true, that the colours are sRGB, as Exif tags. */
static void write_exif(j_compress_ptr jpeg, int is_srgb)
{
    static const unsigned char is_made_by[] = "Exif\0\0II*\0\010\0\0\0\001\0\061\001\002\0\006\0\0\0\032\0\0\0\0\0\0\0"
                                              "retex";
    static const unsigned char is_shown_as[] =
        "Exif\0\0II*\0\010\0\0\0\002\0\061\001\002\0\006\0\0\0\046\0\0\0\151\207\004\0\001\0\0\0\054\0\0\0\0\0\0\0"
        "retex\0\004\0\0\220\007\0\004\0\0\0000230\001\221\007\0\004\0\0\0\001\002\003\0\0\240\007\0\004\0\0\0000100"
        "\001\240\003\0\001\0\0\0\001\0\0\0\0\0\0";

    if (is_srgb)
        jpeg_write_marker(jpeg, JPEG_APP0 + 1, is_shown_as, sizeof is_shown_as);
    else
        jpeg_write_marker(jpeg, JPEG_APP0 + 1, is_made_by, sizeof is_made_by);
}

/* Writes the file up to the coded data. */
static void begin_file(Compressor *c, const RetexPicture *picture, int lines)
{
    struct jpeg_compress_struct *jpeg = &c->jpeg;

    jpeg_create_compress(jpeg);
    jpeg->dest = &c->to;
    jpeg->image_width = (JDIMENSION)picture->width;
    jpeg->image_height = (JDIMENSION)lines;
    jpeg->input_components = picture->channels == 1 ? 1 : 3;
    jpeg->in_color_space = picture->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, picture->params.quality, TRUE);
    if (picture->params.quality >= QUALITY_OF_FULL_COLOR)
        for (int i = 0; i < jpeg->num_components; i++)
            jpeg->comp_info[i].h_samp_factor = jpeg->comp_info[i].v_samp_factor = 1;
    if (picture->nstrips > 1)
        jpeg->restart_in_rows = RETEX_PICTURE_STRIP / (DCTSIZE * jpeg->comp_info[0].v_samp_factor);
    jpeg_start_compress(jpeg, TRUE);
    write_exif(jpeg, !picture->params.colorspace);
    jpeg_write_scanlines(jpeg, NULL, 0); /* writes the tables */
}

/* Compresses a strip; *head is the number of bytes before the coded data. */
static int compress(Compressor *c, const RetexPicture *picture, const uint8_t *codes, int lines, size_t *head)
{
    const size_t row = (size_t)picture->width * (picture->channels == 1 ? 1 : 3);

    c->jpeg.err = jpeg_std_error(&c->errors);
    c->errors.error_exit = error_exit;
    c->errors.output_message = discard_message;
    c->to = (struct jpeg_destination_mgr){
        .init_destination = begin_output, .empty_output_buffer = grow_output, .term_destination = end_output};
    if (setjmp(c->failed))
        return 0;
    begin_file(c, picture, codes ? lines : picture->height);
    *head = bytes_written(c);
    if (!codes)
        return 1;
    for (int y = 0; y < lines; y++) {
        JSAMPROW line = (JSAMPROW)(codes + (size_t)y * row);
        jpeg_write_scanlines(&c->jpeg, &line, 1);
    }
    jpeg_finish_compress(&c->jpeg);
    return 1;
}

static int run_compressor(unsigned char **data, size_t *head, size_t *bytes, const RetexPicture *picture,
                          const uint8_t *codes, int lines, RetexError *err)
{
    Compressor *c = calloc(1, sizeof *c);

    if (!c)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    const int done = compress(c, picture, codes, lines, head);
    jpeg_destroy_compress(&c->jpeg);
    if (!done) {
        const int code = retex_fail(err, RETEX_EIO, "cannot write %s: %s", picture->path, c->message);
        free(c->data);
        free(c);
        return code;
    }
    *data = c->data;
    *bytes = bytes_written(c);
    free(c);
    return 0;
}

/* Encodes a strip: the header or a restart marker, the coded data, and the end marker after the last strip. */
static int encode_strip(RetexPicture *picture, int strip, const uint8_t *codes, RetexError *err)
{
    unsigned char *data, *whole = NULL;
    size_t head, bytes, start = MARKER_BYTES, unused;
    int code = run_compressor(&data, &head, &bytes, picture, codes, retex_picture_strip_lines(picture, strip), err);

    if (code)
        return code;
    if (strip + 1 < picture->nstrips)
        bytes -= MARKER_BYTES;
    if (strip == 0) {
        code = run_compressor(&whole, &start, &unused, picture, NULL, 0, err);
    } else {
        data[head - 2] = 0xff;
        data[head - 1] = (unsigned char)(JPEG_RST0 + (strip - 1) % 8);
    }
    if (!code && strip == 0) {
        /* the header of the picture is as long as that of a strip: only the height differs */
        if (start == head)
            memcpy(data, whole, head);
        else
            code = retex_fail(err, RETEX_EINTERNAL, "cannot write %s: unexpected headers", picture->path);
    }
    free(whole);
    if (code) {
        free(data);
        return code;
    }
    const size_t skip = strip == 0 ? 0 : head - MARKER_BYTES;
    memmove(data, data + skip, bytes - skip);
    return retex_picture_submit_strip(picture, strip, data, bytes - skip, err);
}

static int jpeg_begin(RetexPicture *picture, RetexError *err)
{
    if (picture->width > JPEG_MAX_DIMENSION || picture->height > JPEG_MAX_DIMENSION)
        return retex_fail(err, RETEX_EINVAL, "cannot write %s: a JPEG has at most %d x %d pixels", picture->path,
                          (int)JPEG_MAX_DIMENSION, (int)JPEG_MAX_DIMENSION);
    return 0;
}

static int jpeg_strip(RetexPicture *picture, int strip, const float *rows, RetexError *err)
{
    const int lines = retex_picture_strip_lines(picture, strip), channels = picture->channels == 1 ? 1 : 3;
    uint8_t *codes = malloc((size_t)picture->width * (size_t)(lines * channels));
    int code = codes ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);

    if (!code)
        code = retex_picture_codes(picture, codes, 8, channels, rows, lines, err);
    if (!code)
        code = encode_strip(picture, strip, codes, err);
    free(codes);
    return code;
}

static int jpeg_finish(RetexPicture *picture, RetexError *err)
{
    (void)picture, (void)err;
    return 0; /* the last strip contains the end marker */
}

const RetexPictureFormat retex_picture_jpeg = {jpeg_begin, jpeg_strip, jpeg_finish, NULL};
