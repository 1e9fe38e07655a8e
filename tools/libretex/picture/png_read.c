/* PNG through libpng. */
#include "picture/png_read.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "io/checksum.h"

typedef struct Source {
    const unsigned char *next, *end;
    unsigned char *row;
} Source;

static void read_bytes(png_structp png, png_bytep out, size_t count)
{
    Source *source = png_get_io_ptr(png);

    if ((size_t)(source->end - source->next) < count)
        png_longjmp(png, 1);
    memcpy(out, source->next, count);
    source->next += count;
}

/* Also of warnings: they mean damage, or something rare. */
static void stop(png_structp png, png_const_charp message)
{
    (void)message;
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
    Source source = {data, (const unsigned char *)data + bytes, NULL};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, stop, stop);
    png_infop info = png ? png_create_info_struct(png) : NULL, end = info ? png_create_info_struct(png) : NULL;
    const int done = end ? decode(levels, png, info, end, &source) : RETEX_LEVELS_NO_MEMORY;

    png_destroy_read_struct(&png, &info, &end);
    free(source.row);
    return done;
}

int retex_png_is_whole(const void *data, size_t bytes)
{
    enum { SIGNATURE = 8, LENGTH = 4, TYPE = 4, CRC = 4 };
    const unsigned char *at = data, *end = at + bytes;

    if (bytes < SIGNATURE || png_sig_cmp(at, 0, SIGNATURE) != 0)
        return 0;
    for (at += SIGNATURE; end - at >= LENGTH + TYPE + CRC;) {
        const size_t length = png_get_uint_32(at);
        const unsigned char *type = at + LENGTH, *crc = type + TYPE + length;
        if ((size_t)(end - type) < TYPE + length + CRC ||
            retex_crc32(CRC32_OF_NONE, type, TYPE + length) != png_get_uint_32(crc))
            return 0;
        if (memcmp(type, "IEND", TYPE) == 0)
            return 1;
        at = crc + CRC;
    }
    return 0;
}
