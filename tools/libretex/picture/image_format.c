/* See image_format.h. */
#include "picture/image_format.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BEGIN = 32, TGA_HEADER = 18, TGA_FOOTER = 26 };

static unsigned get16(const unsigned char *at)
{
    return at[0] | (unsigned)at[1] << 8;
}

static unsigned get32(const unsigned char *at)
{
    return get16(at) | get16(at + 2) << 16;
}

static int is_tiff(const unsigned char *begin)
{
    static const char marks[][5] = {"II*\0", "MM\0*", "II+\0", "MM\0+"}; /* the last two: 64-bit offsets */

    for (int i = 0; i < 4; i++)
        if (memcmp(begin, marks[i], 4) == 0)
            return 1;
    return 0;
}

/* "BM" alone is weak evidence: the header's size must be one that exists. */
static int is_bmp(const unsigned char *begin)
{
    static const unsigned sizes[] = {12, 40, 52, 56, 64, 108, 124};

    for (size_t i = 0; memcmp(begin, "BM", 2) == 0 && i < sizeof sizes / sizeof *sizes; i++)
        if (get32(begin + 14) == sizes[i])
            return 1;
    return 0;
}

/* The palette must be inside the file and, without compression, all pixels too. */
static int is_plausible_tga(const unsigned char *h, uint64_t size)
{
    const unsigned type = h[2], packed = type & 8, kind = type & 7, bits = h[16], palette_bits = h[7];
    const uint64_t width = get16(h + 12), height = get16(h + 14), entries = get16(h + 5);
    const int palette_fits = palette_bits == 15 || palette_bits == 16 || palette_bits == 24 || palette_bits == 32;
    const int bits_fit = kind == 1   ? bits == 8 || bits == 16
                         : kind == 2 ? bits == 15 || bits == 16 || bits == 24 || bits == 32
                                     : bits == 8 || bits == 16;

    if (size < TGA_HEADER || (type & ~11u) || kind < 1 || kind > 3 || h[1] > 1 || !width || !height || !bits_fit)
        return 0;
    if ((kind == 1 && !h[1]) || (h[1] && (!palette_fits || !entries)))
        return 0;
    const uint64_t before = TGA_HEADER + h[0] + (h[1] ? entries * ((palette_bits + 7) / 8) : 0);
    return packed ? before < size : before + width * height * ((bits + 7) / 8) <= size;
}

static int is_tga(const RetexInput *input, const unsigned char *begin)
{
    static const char mark[] = "TRUEVISION-XFILE.";
    unsigned char footer[TGA_FOOTER] = {0};
    const char *name = retex_input_name(input), *dot = strrchr(name, '.');
    const uint64_t size = retex_input_size(input);

    if (!is_plausible_tga(begin, size))
        return 0;
    if (size >= TGA_HEADER + TGA_FOOTER)
        retex_input_read(input, footer, sizeof footer, size - TGA_FOOTER);
    return memcmp(footer + 8, mark, sizeof mark) == 0 || (dot && strcasecmp(dot, ".tga") == 0);
}

const char *retex_image_format(const RetexInput *input)
{
    static const struct {
        const char *name, *mark;
        size_t length;
    } marks[] = {{"png", "\x89PNG\r\n\x1a\n", 8},
                 {"jpeg", "\xff\xd8\xff", 3},
                 {"openexr", "\x76\x2f\x31\x01", 4},
                 {"gif", "GIF87a", 6},
                 {"gif", "GIF89a", 6},
                 {"hdr", "#?RADIANCE", 10},
                 {"hdr", "#?RGBE", 6}};
    unsigned char begin[BEGIN] = {0};

    retex_input_read(input, begin, sizeof begin, 0);
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (memcmp(begin, marks[i].mark, marks[i].length) == 0)
            return marks[i].name;
    if (memcmp(begin, "RIFF", 4) == 0 && memcmp(begin + 8, "WEBP", 4) == 0)
        return "webp";
    if (is_tiff(begin))
        return "tiff";
    if (is_bmp(begin))
        return "bmp";
    return is_tga(input, begin) ? "targa" : NULL;
}

uint64_t retex_image_header_pixels(const RetexInput *input, const char *format)
{
    unsigned char begin[BEGIN] = {0};

    retex_input_read(input, begin, sizeof begin, 0);
    if (format && strcmp(format, "gif") == 0)
        return (uint64_t)get16(begin + 6) * get16(begin + 8);
    if (!format || strcmp(format, "bmp") != 0)
        return 0;
    if (get32(begin + 14) == 12)
        return (uint64_t)get16(begin + 18) * get16(begin + 20);
    const int32_t height = (int32_t)get32(begin + 22); /* below 0: rows from the top */
    return (uint64_t)get32(begin + 18) * (uint64_t)(height < 0 ? -(int64_t)height : height);
}

/* Reads the bytes of an input in order. */
typedef struct Reader {
    const RetexInput *input;
    uint64_t next; /* after those of the buffer */
    int64_t used, filled;
    unsigned char buffer[1 << 16];
} Reader;

/* The next byte; below 0 at the end. */
static int next_byte(Reader *reader)
{
    if (reader->used == reader->filled) {
        reader->filled = retex_input_read(reader->input, reader->buffer, sizeof reader->buffer, reader->next);
        reader->used = 0;
        if (reader->filled <= 0) {
            reader->filled = 0;
            return -1;
        }
        reader->next += (uint64_t)reader->filled;
    }
    return reader->buffer[reader->used++];
}

static void skip(Reader *reader, int64_t bytes)
{
    if (bytes <= reader->filled - reader->used) {
        reader->used += bytes;
        return;
    }
    reader->next += (uint64_t)(bytes - (reader->filled - reader->used));
    reader->used = reader->filled = 0;
}

/* The number of the next marker, below 0 at the end: what follows 0xff and is neither 0 nor 0xff again. */
static int next_marker(Reader *reader)
{
    for (int byte = next_byte(reader), before = 0; byte >= 0; before = byte, byte = next_byte(reader))
        if (before == 0xff && byte != 0 && byte != 0xff)
            return byte;
    return -1;
}

int retex_image_has_more_scans(const RetexInput *input, int most)
{
    enum { RESTART = 0xd0, START = 0xd8, SCAN = 0xda };
    Reader *reader = calloc(1, sizeof *reader);
    int scans = 0;

    if (!reader)
        return 0;
    reader->input = input;
    for (int marker; scans <= most && (marker = next_marker(reader)) >= 0;) {
        if (marker >= RESTART && marker <= START)
            continue;
        const int high = next_byte(reader), low = next_byte(reader);
        if (low < 0)
            break;
        scans += marker == SCAN;
        skip(reader, (high << 8 | low) - 2 > 0 ? (high << 8 | low) - 2 : 0);
    }
    free(reader);
    return scans > most;
}
