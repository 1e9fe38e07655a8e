/* TIFF of 8 or 16 bits, strip by strip: each is differenced and deflated separately. The directory, which has their
 * places, comes last, and its own place is then filled in at the file's beginning. Numbers are in the machine's byte
 * order, which the file names. Tags are those that OpenImageIO writes, but for the time: the same picture makes the
 * same file. */
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "io/deflate.h"
#include "picture/format.h"

enum { HEAD = 8, ZLIB_HEAD = 2, ZLIB_TAIL = 4, PAD = 1, ENTRIES_MOST = 17 };

enum { TYPE_TEXT = 2, TYPE_SHORT = 3, TYPE_LONG = 4, TYPE_DIRECTORY = 13 };

typedef struct Entry {
    uint16_t tag, type;
    uint32_t count, value; /* or where the values are */
} Entry;

typedef struct Directory {
    uint32_t at; /* where it will be in the file, after: */
    unsigned char *values;
    size_t bytes;
    Entry entries[ENTRIES_MOST];
    int count;
} Directory;

static int bits_of(const RetexPicture *picture)
{
    return picture->params.depth ? picture->params.depth : 16;
}

static size_t line_samples(const RetexPicture *picture)
{
    return (size_t)picture->width * (size_t)picture->channels;
}

int retex_tiff_fits(int width, int height, int channels, const RetexWriteParams *params)
{
    const uint64_t bytes = (uint64_t)width * (uint64_t)height * (uint64_t)channels * (params->depth == 8 ? 1 : 2);
    return bytes + bytes / 32 + ((uint64_t)1 << 24) < UINT32_MAX;
}

/* Each sample becomes its difference from that of the pixel before, modulo 2 to the number of bits. */
static void difference(void *codes, int bits, size_t samples, size_t channels)
{
    uint8_t *bytes = codes;
    uint16_t *words = codes;

    for (size_t i = samples; i-- > channels;) {
        if (bits == 8)
            bytes[i] = (uint8_t)(bytes[i] - bytes[i - channels]);
        else
            words[i] = (uint16_t)(words[i] - words[i - channels]);
    }
}

/* A zlib stream of the bytes, before it the file's beginning if it is the first. Strips have an even length. */
static unsigned char *encode_strip(int is_first, const uint8_t *bytes, size_t count, size_t *encoded_bytes)
{
    const size_t before = is_first ? HEAD : 0, bound = retex_deflate_bound(count);
    unsigned char *data = malloc(before + ZLIB_HEAD + bound + ZLIB_TAIL + PAD);
    const uint16_t one = 1;
    const int is_little = *(const uint8_t *)&one;
    const size_t packed = data ? retex_deflate(data + before + ZLIB_HEAD, bound, bytes, count, 1) : 0;

    if (!packed) {
        free(data);
        return NULL;
    }
    memset(data, 0, before);
    if (is_first) {
        memcpy(data, is_little ? "II" : "MM", 2);
        memcpy(data + 2, &(uint16_t){42}, 2);
    }
    unsigned char *stream = data + before;
    memcpy(stream, "\x78\x01", ZLIB_HEAD); /* deflate, 32 KB, fastest */
    const uint32_t adler = retex_adler32(ADLER32_OF_NONE, bytes, count);
    for (int i = 0; i < ZLIB_TAIL; i++)
        stream[ZLIB_HEAD + packed + (size_t)i] = (unsigned char)(adler >> (24 - 8 * i));
    *encoded_bytes = before + ZLIB_HEAD + packed + ZLIB_TAIL;
    if (*encoded_bytes % 2)
        data[(*encoded_bytes)++] = 0;
    unsigned char *less = realloc(data, *encoded_bytes);
    return less ? less : data;
}

static int tiff_begin(RetexPicture *picture, RetexError *err)
{
    picture->state = calloc((size_t)picture->nstrips, sizeof(uint32_t));
    return picture->state ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
}

static int tiff_strip(RetexPicture *picture, int strip, const float *rows, RetexError *err)
{
    const int lines = retex_picture_strip_lines(picture, strip), bits = bits_of(picture);
    const size_t samples = line_samples(picture), line = samples * (size_t)(bits / 8), bytes = line * (size_t)lines;
    uint8_t *codes = malloc(bytes);
    unsigned char *encoded = NULL;
    size_t encoded_bytes = 0;
    int code = codes ? 0 : RETEX_ENOMEM;

    if (!code)
        code = retex_picture_codes(picture, codes, bits, picture->channels, rows, lines, err);
    if (!code) {
        for (int y = 0; y < lines; y++)
            difference(codes + (size_t)y * line, bits, samples, (size_t)picture->channels);
        encoded = encode_strip(strip == 0, codes, bytes, &encoded_bytes);
        ((uint32_t *)picture->state)[strip] = (uint32_t)encoded_bytes;
        code = encoded ? retex_picture_submit_strip(picture, strip, encoded, encoded_bytes, err) : RETEX_ENOMEM;
    }
    free(codes);
    return code == RETEX_ENOMEM ? retex_fail(err, code, "no memory to write %s", picture->path) : code;
}

/* ---- the directory ---- */

/* Adds an entry; values of more than four bytes are not in it. */
static void add(Directory *d, int tag, int type, size_t count, const void *values, size_t bytes)
{
    Entry *entry = &d->entries[d->count++];

    *entry = (Entry){(uint16_t)tag, (uint16_t)type, (uint32_t)count, 0};
    if (bytes <= sizeof entry->value) {
        memcpy(&entry->value, values, bytes);
        return;
    }
    entry->value = d->at + (uint32_t)d->bytes;
    memcpy(d->values + d->bytes, values, bytes);
    d->bytes += (bytes + 1) / 2 * 2;
}

static void add_short(Directory *d, int tag, int value)
{
    add(d, tag, TYPE_SHORT, 1, &(uint16_t){(uint16_t)value}, 2);
}

static void add_long(Directory *d, int tag, uint32_t value)
{
    add(d, tag, TYPE_LONG, 1, &value, 4);
}

/* Appends a directory to the bytes. */
static void put_directory(unsigned char *bytes, size_t *at, const Entry *entries, int count)
{
    memcpy(bytes + *at, &(uint16_t){(uint16_t)count}, 2);
    *at += 2;
    for (int i = 0; i < count; i++, *at += 12) {
        memcpy(bytes + *at, &entries[i].tag, 2);
        memcpy(bytes + *at + 2, &entries[i].type, 2);
        memcpy(bytes + *at + 4, &entries[i].count, 4);
        memcpy(bytes + *at + 8, &entries[i].value, 4);
    }
    memset(bytes + *at, 0, 4); /* there is no other */
    *at += 4;
}

/* Tags of TIFF 6.0 and Exif. */
enum {
    TAG_WIDTH = 256,
    TAG_HEIGHT = 257,
    TAG_BITS = 258,
    TAG_COMPRESSION = 259,
    TAG_PHOTOMETRIC = 262,
    TAG_STRIP_OFFSETS = 273,
    TAG_ORIENTATION = 274,
    TAG_CHANNELS = 277,
    TAG_ROWS_OF_STRIP = 278,
    TAG_STRIP_BYTES = 279,
    TAG_PLANES = 284,
    TAG_SOFTWARE = 305,
    TAG_PREDICTOR = 317,
    TAG_ALPHA = 338,
    TAG_SAMPLE_FORMAT = 339,
    TAG_EXIF = 34665,
    TAG_EXIF_COLOR_SPACE = 40961
};

/* Fills the directory, in ascending order of tags as TIFF wants it. offsets and bytes: of the strips in the file. The
 * Exif directory stands among its values. */
static void list_entries(Directory *d, const RetexPicture *picture, const uint32_t *offsets, const uint32_t *bytes)
{
    const size_t channels = (size_t)picture->channels, strips = (size_t)picture->nstrips;
    const uint16_t depth = (uint16_t)bits_of(picture), bits[4] = {depth, depth, depth, depth};
    const uint16_t sample_format[4] = {1, 1, 1, 1}; /* unsigned integers */
    Entry exif = {TAG_EXIF_COLOR_SPACE, TYPE_SHORT, 1, 0};

    add_long(d, TAG_WIDTH, (uint32_t)picture->width);
    add_long(d, TAG_HEIGHT, (uint32_t)picture->height);
    add(d, TAG_BITS, TYPE_SHORT, channels, bits, 2 * channels);
    add_short(d, TAG_COMPRESSION, 8);                     /* compression: deflate */
    add_short(d, TAG_PHOTOMETRIC, channels == 1 ? 1 : 2); /* grey, or RGB */
    add(d, TAG_STRIP_OFFSETS, TYPE_LONG, strips, offsets, 4 * strips);
    add_short(d, TAG_ORIENTATION, 1); /* upright */
    add_short(d, TAG_CHANNELS, picture->channels);
    add_long(d, TAG_ROWS_OF_STRIP, RETEX_PICTURE_STRIP);
    add(d, TAG_STRIP_BYTES, TYPE_LONG, strips, bytes, 4 * strips);
    add_short(d, TAG_PLANES, 1); /* channels are interleaved */
    add(d, TAG_SOFTWARE, TYPE_TEXT, 6, "retex", 6);
    add_short(d, TAG_PREDICTOR, 2); /* differences along lines */
    if (channels == 4)
        add_short(d, TAG_ALPHA, 2); /* colours are not multiplied by alpha */
    add(d, TAG_SAMPLE_FORMAT, TYPE_SHORT, channels, sample_format, 2 * channels);
    memcpy(&exif.value, &(uint16_t){1}, 2); /* sRGB */
    add(d, TAG_EXIF, TYPE_DIRECTORY, 1, &(uint32_t){d->at + (uint32_t)d->bytes}, 4);
    put_directory(d->values, &d->bytes, &exif, 1);
}

static int tiff_finish(RetexPicture *picture, RetexError *err)
{
    uint32_t *sizes = picture->state, at = HEAD;
    uint32_t *offsets = malloc((size_t)picture->nstrips * sizeof *offsets);
    Directory d = {.values = malloc((size_t)picture->nstrips * 2 * sizeof *sizes + 1024)};
    int code = offsets && d.values ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);

    sizes[0] -= HEAD;
    for (int i = 0; !code && i < picture->nstrips; at += sizes[i++])
        offsets[i] = at;
    d.at = at;
    if (!code) {
        list_entries(&d, picture, offsets, sizes);
        const uint32_t place = at + (uint32_t)d.bytes;
        put_directory(d.values, &d.bytes, d.entries, d.count);
        code = retex_picture_append(picture, d.values, d.bytes, err);
        if (!code)
            code = retex_output_patch(picture->output, 4, &place, sizeof place, err);
    }
    free(offsets);
    free(d.values);
    return code;
}

static void tiff_end(RetexPicture *picture)
{
    free(picture->state);
}

const RetexPictureFormat retex_picture_tiff = {tiff_begin, tiff_strip, tiff_finish, tiff_end};
