/* PNG of 8 or 16 bits, strip by strip. Each strip is filtered and deflated separately, as a part of one zlib stream: it
 * begins and ends at a whole byte, refers to nothing before it, and is an IDAT chunk. The checksum of the stream is
 * combined from those of the strips. Renders have noise in their low bits, where filters leave little to compress: with
 * the best of all filters ISA-L's fast level gives files as small as zlib's level 6, in much less time. */
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "io/checksum.h"
#include "io/deflate.h"
#include "picture/format.h"
#include "picture/png_filter.h"

enum { CHUNK_HEAD = 8, CHUNK_TAIL = 4, ZLIB_HEAD = 2, HEADER_ROOM = 256 };

typedef struct Sum {
    uint32_t adler;
    size_t bytes;
} Sum;

static void put_32(unsigned char *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* Completes a chunk whose bytes are in place; returns its whole length. */
static size_t close_chunk(unsigned char *chunk, const char *type, size_t bytes)
{
    put_32(chunk, (uint32_t)bytes);
    memcpy(chunk + 4, type, 4);
    put_32(chunk + CHUNK_HEAD + bytes, retex_crc32(CRC32_OF_NONE, chunk + 4, bytes + 4));
    return CHUNK_HEAD + bytes + CHUNK_TAIL;
}

static size_t add_chunk(unsigned char *to, const char *type, const void *data, size_t bytes)
{
    if (bytes)
        memcpy(to + CHUNK_HEAD, data, bytes);
    return close_chunk(to, type, bytes);
}

static int bits_of(const RetexPicture *picture)
{
    return picture->params.depth ? picture->params.depth : 8;
}

/* Writes everything before the pixels. Colours that went through a display transform are tagged as sRGB; gamma and
 * primaries are for readers that do not know that tag. */
static size_t write_header(unsigned char *to, const RetexPicture *picture)
{
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const uint32_t gamma = 45455, primaries[8] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    static const unsigned char color_types[5] = {[1] = 0, [3] = 2, [4] = 6}, intent = 3;
    unsigned char header[13] = {[8] = (unsigned char)bits_of(picture), [9] = color_types[picture->channels]};
    unsigned char numbers[32];
    size_t at = sizeof signature;

    memcpy(to, signature, sizeof signature);
    put_32(header, (uint32_t)picture->width);
    put_32(header + 4, (uint32_t)picture->height);
    at += add_chunk(to + at, "IHDR", header, sizeof header);
    if (!picture->params.colorspace) {
        put_32(numbers, gamma);
        at += add_chunk(to + at, "gAMA", numbers, 4);
        at += add_chunk(to + at, "sRGB", &intent, 1);
        for (int i = 0; i < 8; i++)
            put_32(numbers + 4 * i, primaries[i]);
        at += add_chunk(to + at, "cHRM", numbers, sizeof numbers);
    }
    at += add_chunk(to + at, "tEXt", "Software\0retex", 14);
    return at;
}

static size_t pixel_bytes(const RetexPicture *picture)
{
    return (size_t)picture->channels * (size_t)bits_of(picture) / 8;
}

static size_t line_bytes(const RetexPicture *picture)
{
    return (size_t)picture->width * pixel_bytes(picture);
}

/* PNG stores the high byte first. */
static void order_bytes(unsigned char *codes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t code;
        memcpy(&code, codes + 2 * i, sizeof code);
        codes[2 * i] = (unsigned char)(code >> 8);
        codes[2 * i + 1] = (unsigned char)code;
    }
}

/* Filters lines; the first line of a strip must not use the line above, which is in another strip. */
static int filter_lines(unsigned char *filtered, const RetexPicture *picture, const uint8_t *codes, int lines)
{
    const size_t bytes = line_bytes(picture);
    unsigned char *trial = malloc(bytes);

    for (int y = 0; trial && y < lines; y++) {
        const uint8_t *line = codes + (size_t)y * bytes;
        retex_png_filter(filtered + (size_t)y * (bytes + 1), trial, line, y ? line - bytes : NULL, bytes,
                         pixel_bytes(picture));
    }
    free(trial);
    return trial != NULL;
}

/* Deflates into new memory with head bytes before and tail bytes after; NULL where memory is short. */
static unsigned char *deflate_lines(const unsigned char *filtered, size_t bytes, int is_last, size_t head, size_t tail,
                                    size_t *packed_bytes)
{
    const size_t bound = retex_deflate_bound(bytes);
    unsigned char *data = malloc(head + bound + tail);

    *packed_bytes = data ? retex_deflate(data + head, bound, filtered, bytes, is_last) : 0;
    if (*packed_bytes)
        return data;
    free(data);
    return NULL;
}

/* Encodes a strip: an IDAT chunk, for the first strip preceded by the header. */
static unsigned char *encode_strip(const RetexPicture *picture, int strip, const unsigned char *filtered, size_t bytes,
                                   size_t *encoded_bytes)
{
    unsigned char header[HEADER_ROOM];
    const size_t before = strip == 0 ? write_header(header, picture) : 0, prefix = strip == 0 ? ZLIB_HEAD : 0;
    size_t packed_bytes;
    unsigned char *data = deflate_lines(filtered, bytes, strip + 1 == picture->nstrips, before + CHUNK_HEAD + prefix,
                                        CHUNK_TAIL, &packed_bytes);

    if (!data)
        return NULL;
    memcpy(data, header, before);
    if (prefix)
        memcpy(data + before + CHUNK_HEAD, "\x78\x01", ZLIB_HEAD); /* deflate, 32 KB, fastest */
    *encoded_bytes = before + close_chunk(data + before, "IDAT", prefix + packed_bytes);
    unsigned char *less = realloc(data, *encoded_bytes);
    return less ? less : data;
}

static int png_begin(RetexPicture *picture, RetexError *err)
{
    picture->state = calloc((size_t)picture->nstrips, sizeof(Sum));
    return picture->state ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
}

static int png_strip(RetexPicture *picture, int strip, const float *rows, RetexError *err)
{
    const int lines = retex_picture_strip_lines(picture, strip);
    const size_t bytes = (line_bytes(picture) + 1) * (size_t)lines;
    uint8_t *codes = malloc(line_bytes(picture) * (size_t)lines);
    unsigned char *filtered = malloc(bytes), *encoded = NULL;
    size_t encoded_bytes;
    int code = codes && filtered ? 0 : RETEX_ENOMEM;

    if (!code) {
        code = retex_picture_codes(picture, codes, bits_of(picture), picture->channels, rows, lines, err);
        if (!code && bits_of(picture) == 16)
            order_bytes(codes, line_bytes(picture) / 2 * (size_t)lines);
        if (!code && !filter_lines(filtered, picture, codes, lines))
            code = RETEX_ENOMEM;
    }
    if (!code) {
        ((Sum *)picture->state)[strip] = (Sum){retex_adler32(ADLER32_OF_NONE, filtered, bytes), bytes};
        encoded = encode_strip(picture, strip, filtered, bytes, &encoded_bytes);
        code = encoded ? retex_picture_submit_strip(picture, strip, encoded, encoded_bytes, err) : RETEX_ENOMEM;
    }
    free(codes);
    free(filtered);
    return code == RETEX_ENOMEM ? retex_fail(err, code, "no memory to write %s", picture->path) : code;
}

/* Writes the stream's checksum, in a chunk of its own, and the end. */
static int png_finish(RetexPicture *picture, RetexError *err)
{
    const Sum *sums = picture->state;
    unsigned char end[2 * (CHUNK_HEAD + CHUNK_TAIL) + 4], number[4];
    uLong adler = ADLER32_OF_NONE;

    for (int strip = 0; strip < picture->nstrips; strip++)
        adler = adler32_combine(adler, sums[strip].adler, (z_off_t)sums[strip].bytes);
    put_32(number, (uint32_t)adler);
    const size_t at = add_chunk(end, "IDAT", number, sizeof number);
    return retex_picture_append(picture, end, at + add_chunk(end + at, "IEND", NULL, 0), err);
}

static void png_end(RetexPicture *picture)
{
    free(picture->state);
}

const RetexPictureFormat retex_picture_png = {png_begin, png_strip, png_finish, png_end};
