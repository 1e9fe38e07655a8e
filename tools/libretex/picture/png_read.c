/* PNG through libpng. */
#include "picture/png_read.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "io/checksum.h"

typedef struct Source {
    const unsigned char *next, *end;
    unsigned char *row;
    char message[64]; /* of the error */
} Source;

static void read_bytes(png_structp png, png_bytep out, size_t count)
{
    Source *source = png_get_io_ptr(png);

    if ((size_t)(source->end - source->next) < count)
        png_error(png, "the file ends early");
    memcpy(out, source->next, count);
    source->next += count;
}

/* Also of warnings: they mean damage, or something rare. */
static void stop(png_structp png, png_const_charp message)
{
    Source *source = png_get_error_ptr(png);

    snprintf(source->message, sizeof source->message, "%s", message);
    png_longjmp(png, 1);
}

/* Texts may say how the picture is turned and what its numbers mean: OpenImageIO takes them for attributes. */
static int has_plain_texts(png_const_structp png, png_infop info)
{
    static const char *const words[] = {"orientation", "xmp", "profile", "alpha"};
    png_textp texts;
    const int count = png_get_text(png, info, &texts, NULL);

    for (int i = 0; i < count; i++)
        for (size_t k = 0; k < sizeof words / sizeof *words; k++)
            if (strcasestr(texts[i].key, words[k]))
                return 0;
    return 1;
}

/* Whether the bridge would take the numbers as they are, or as sRGB. */
static int is_plain(png_const_structp png, png_infop info)
{
    png_unknown_chunkp unknown;
    const png_uint_32 colors = png_get_valid(png, info, PNG_INFO_gAMA | PNG_INFO_cHRM | PNG_INFO_iCCP | PNG_INFO_sRGB);

    return (colors == 0 || (colors & PNG_INFO_sRGB)) && !(colors & PNG_INFO_iCCP) &&
           png_get_valid(png, info, PNG_INFO_eXIf) == 0 && png_get_unknown_chunks(png, info, &unknown) == 0 &&
           png_get_interlace_type(png, info) == PNG_INTERLACE_NONE && has_plain_texts(png, info);
}

static int decode(RetexLevels *levels, png_structp png, png_infop info, png_infop end, Source *source)
{
    if (setjmp(png_jmpbuf(png)))
        return RETEX_LEVELS_LEFT;
    png_set_read_fn(png, source, read_bytes);
    png_set_user_limits(png, RETEX_MAX_SIZE, RETEX_MAX_SIZE);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, NULL, 0);
    png_read_info(png, info);
    if (!is_plain(png, info))
        return RETEX_LEVELS_LEFT;
    png_set_expand(png); /* palettes to colours, fewer than 8 bits to 8, transparent colours to alpha */
    const unsigned one = 1;
    if (*(const unsigned char *)&one)
        png_set_swap(png);
    png_read_update_info(png, info);
    const int height = (int)png_get_image_height(png, info);
    const int code = retex_levels_begin(levels, (int)png_get_image_width(png, info), height,
                                        png_get_channels(png, info), png_get_bit_depth(png, info));
    if (code != RETEX_LEVELS_READ)
        return code;
    source->row = malloc(png_get_rowbytes(png, info));
    if (!source->row)
        return RETEX_LEVELS_NO_MEMORY;
    for (int y = 0; y < height; y++) {
        png_read_row(png, source->row, NULL);
        retex_levels_row(levels, y, source->row);
    }
    png_read_end(png, end);
    return is_plain(png, end) ? RETEX_LEVELS_READ : RETEX_LEVELS_LEFT;
}

int retex_png_read(RetexLevels *levels, const void *data, size_t bytes)
{
    Source source = {.next = data, .end = (const unsigned char *)data + bytes};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, stop, stop);
    png_infop info = png ? png_create_info_struct(png) : NULL, end = info ? png_create_info_struct(png) : NULL;
    const int done = end ? decode(levels, png, info, end, &source) : RETEX_LEVELS_NO_MEMORY;

    png_destroy_read_struct(&png, &info, &end);
    free(source.row);
    return done;
}

/* Warnings of the compressed pixels mean damage, unless they only go on after the last row. Others are of what stands
 * beside the pixels. */
static void stop_at_damage(png_structp png, png_const_charp message)
{
    if (strncmp(message, "IDAT: ", 6) == 0 && !strstr(message, "Too much") && !strstr(message, "Extra compressed"))
        stop(png, message);
}

/* 0 where libpng gave up or warned. */
static int decode_rows(png_structp png, png_infop info, Source *source, long max_pixels)
{
    if (setjmp(png_jmpbuf(png)))
        return 0;
    png_set_read_fn(png, source, read_bytes);
    png_set_user_limits(png, RETEX_MAX_SIZE, RETEX_MAX_SIZE);
    png_read_info(png, info);
    if (max_pixels > 0 && (long)png_get_image_width(png, info) * png_get_image_height(png, info) > max_pixels)
        return 1;
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    source->row = malloc(png_get_rowbytes(png, info));
    if (!source->row)
        return 1; /* whoever decodes it will tell */
    for (int pass = 0; pass < passes; pass++)
        for (unsigned y = 0; y < png_get_image_height(png, info); y++)
            png_read_row(png, source->row, NULL);
    png_read_end(png, NULL);
    return 1;
}

/* What is wrong with the chunks, or NULL. */
static const char *find_wrong_chunk(const void *data, size_t bytes)
{
    enum { SIGNATURE = 8, LENGTH = 4, TYPE = 4, CRC = 4 };
    const unsigned char *at = (const unsigned char *)data + SIGNATURE, *end = (const unsigned char *)data + bytes;

    while (bytes > SIGNATURE && end - at >= LENGTH + TYPE + CRC) {
        const size_t length = png_get_uint_32(at);
        const unsigned char *type = at + LENGTH, *crc = type + TYPE + length;
        if ((size_t)(end - type) < TYPE + length + CRC)
            break;
        if (retex_crc32(CRC32_OF_NONE, type, TYPE + length) != png_get_uint_32(crc))
            return "the file is damaged: a checksum is wrong";
        if (memcmp(type, "IEND", TYPE) == 0)
            return NULL;
        at = crc + CRC;
    }
    return "the file is truncated";
}

int retex_png_is_whole(const void *data, size_t bytes)
{
    return bytes > 8 && png_sig_cmp(data, 0, 8) == 0 && !find_wrong_chunk(data, bytes);
}

int retex_png_is_damaged(const void *data, size_t bytes, long max_pixels, RetexDamage damage)
{
    const char *chunks = find_wrong_chunk(data, bytes);
    Source source = {.next = data, .end = (const unsigned char *)data + bytes};

    if (chunks) {
        snprintf(damage, sizeof(RetexDamage), "%s", chunks);
        return 1;
    }
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, stop, stop_at_damage);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    const int is_whole = !info || decode_rows(png, info, &source, max_pixels);
    png_destroy_read_struct(&png, &info, NULL);
    free(source.row);
    if (!is_whole)
        snprintf(damage, sizeof(RetexDamage), "the file is damaged: %s", source.message);
    return !is_whole;
}
