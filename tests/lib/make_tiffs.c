/* make_tiffs FOLDER: TIFF files of every kind that libtiff writes, and strange ones that are whole. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tiffio.h>

enum { WIDTH = 61, HEIGHT = 47, TILE = 32, PRIVATE_TAG = 65001 };

/* How one is written. */
typedef struct Kind {
    const char *name, *mode;
    int compression, photometric, channels, bits, predictor, is_float, is_tiled, is_planar, has_alpha, has_tag;
} Kind;

#define RGB PHOTOMETRIC_RGB
#define GREY PHOTOMETRIC_MINISBLACK
static const Kind kinds[] = {
    {.name = "plain", "w", COMPRESSION_NONE, RGB, 3, 8},
    {.name = "plain-alpha", "w", COMPRESSION_NONE, RGB, 4, 8, .has_alpha = 1},
    {.name = "plain-16-big-endian", "wb", COMPRESSION_NONE, RGB, 3, 16},
    {.name = "plain-float", "w", COMPRESSION_NONE, RGB, 3, 32, .is_float = 1},
    {.name = "plain-planar", "w", COMPRESSION_NONE, RGB, 3, 8, .is_planar = 1},
    {.name = "plain-tiled", "w", COMPRESSION_NONE, RGB, 3, 8, .is_tiled = 1},
    {.name = "plain-bigtiff", "w8", COMPRESSION_NONE, RGB, 3, 8},
    {.name = "private-tag", "w", COMPRESSION_NONE, RGB, 3, 8, .has_tag = 1},
    {.name = "lzw", "w", COMPRESSION_LZW, RGB, 3, 8},
    {.name = "lzw-predictor", "w", COMPRESSION_LZW, RGB, 3, 8, 2},
    {.name = "lzw-16-tiled", "w", COMPRESSION_LZW, RGB, 3, 16, 2, .is_tiled = 1},
    {.name = "zip", "w", COMPRESSION_ADOBE_DEFLATE, RGB, 3, 8},
    {.name = "zip-predictor", "w", COMPRESSION_ADOBE_DEFLATE, RGB, 3, 16, 2},
    {.name = "zip-old", "w", COMPRESSION_DEFLATE, RGB, 3, 8},
    {.name = "zip-float", "w", COMPRESSION_ADOBE_DEFLATE, RGB, 3, 32, 3, .is_float = 1},
    {.name = "zip-tiled", "w", COMPRESSION_ADOBE_DEFLATE, RGB, 4, 8, .is_tiled = 1, .has_alpha = 1},
    {.name = "zip-planar", "w", COMPRESSION_ADOBE_DEFLATE, RGB, 3, 8, .is_planar = 1},
    {.name = "zip-big-endian", "wb", COMPRESSION_ADOBE_DEFLATE, RGB, 3, 16, 2},
    {.name = "zip-grey", "w", COMPRESSION_ADOBE_DEFLATE, GREY, 1, 16},
    {.name = "zip-white", "w", COMPRESSION_ADOBE_DEFLATE, PHOTOMETRIC_MINISWHITE, 1, 8},
    {.name = "packbits", "w", COMPRESSION_PACKBITS, RGB, 3, 8},
    {.name = "packbits-palette", "w", COMPRESSION_PACKBITS, PHOTOMETRIC_PALETTE, 1, 8},
    {.name = "cmyk", "w", COMPRESSION_LZW, PHOTOMETRIC_SEPARATED, 4, 8},
    {.name = "bits-1", "w", COMPRESSION_NONE, GREY, 1, 1},
    {.name = "bits-4", "w", COMPRESSION_LZW, GREY, 1, 4},
    {.name = "fax-3", "w", COMPRESSION_CCITTFAX3, PHOTOMETRIC_MINISWHITE, 1, 1},
    {.name = "fax-4", "w", COMPRESSION_CCITTFAX4, PHOTOMETRIC_MINISWHITE, 1, 1},
    {.name = "jpeg", "w", COMPRESSION_JPEG, RGB, 3, 8},
    {.name = "jpeg-ycbcr", "w", COMPRESSION_JPEG, PHOTOMETRIC_YCBCR, 3, 8},
    {.name = "jpeg-tiled", "w", COMPRESSION_JPEG, RGB, 3, 8, .is_tiled = 1},
    {.name = "zstd", "w", COMPRESSION_ZSTD, RGB, 3, 8},
    {.name = "lzma", "w", COMPRESSION_LZMA, RGB, 3, 8},
    {.name = "lerc", "w", COMPRESSION_LERC, RGB, 3, 8},
    {.name = "webp", "w", COMPRESSION_WEBP, RGB, 3, 8},
};

static const TIFFFieldInfo private_field[] = {{PRIVATE_TAG, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, (char *)"Private"}};

static void set_fields(TIFF *tiff, const Kind *kind)
{
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, WIDTH);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, HEIGHT);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind->bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind->channels);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind->compression);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind->photometric);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind->is_planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    if (kind->is_float)
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    if (kind->predictor)
        TIFFSetField(tiff, TIFFTAG_PREDICTOR, kind->predictor);
    if (kind->has_alpha)
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &(uint16_t){EXTRASAMPLE_UNASSALPHA});
    if (kind->photometric == PHOTOMETRIC_YCBCR)
        TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (kind->is_tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, TILE);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, TILE);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 16);
    }
    if (kind->photometric == PHOTOMETRIC_PALETTE) {
        uint16_t map[3][256];
        for (int i = 0; i < 256; i++)
            for (int c = 0; c < 3; c++)
                map[c][i] = (uint16_t)(i * 257 * (c + 1));
        TIFFSetField(tiff, TIFFTAG_COLORMAP, map[0], map[1], map[2]);
    }
    if (kind->has_tag) {
        TIFFMergeFieldInfo(tiff, private_field, 1);
        TIFFSetField(tiff, PRIVATE_TAG, "what nobody knows");
    }
}

/* Edges, a gradient and noise. */
static double value_at(int x, int y, int c)
{
    const unsigned noise = ((unsigned)(x * 73 + y * 151 + c * 37) * 2654435761u) >> 28;
    return (x * 2 + y + ((x / 9 + y / 7 + c) % 3 == 0 ? 60 : 0) + (int)noise) / 255.0;
}

/* Samples of one strip or tile, at (x0, y0); returns the bytes of its rows. */
static size_t fill(unsigned char *data, const Kind *kind, int x0, int y0, int width, int height, int plane)
{
    const int channels = kind->is_planar ? 1 : kind->channels;
    const size_t row = ((size_t)(width * channels * kind->bits) + 7) / 8;
    memset(data, 0, row * (size_t)height);
    for (int y = 0; y < height; y++)
        for (int i = 0; i < width * channels; i++) {
            const double v = value_at(x0 + i / channels, y0 + y, plane + i % channels);
            unsigned char *to = data + (size_t)y * row;
            if (kind->is_float)
                ((float *)(void *)to)[i] = (float)v;
            else if (kind->bits == 16)
                ((uint16_t *)(void *)to)[i] = (uint16_t)(v * 65535);
            else if (kind->bits == 8)
                to[i] = (unsigned char)(v * 255);
            else
                to[i * kind->bits / 8] |=
                    (unsigned char)((int)(v * ((1 << kind->bits) - 1) + 0.5) << (8 - kind->bits - i * kind->bits % 8));
        }
    return row * (size_t)height;
}

static int write_blocks(TIFF *tiff, const Kind *kind)
{
    static unsigned char data[WIDTH * HEIGHT * 16];
    const int planes = kind->is_planar ? kind->channels : 1;
    for (int plane = 0, block = 0; plane < planes; plane++)
        for (int y = 0; y < HEIGHT; y += kind->is_tiled ? TILE : 16)
            for (int x = 0; x < WIDTH; x += kind->is_tiled ? TILE : WIDTH, block++) {
                const int width = kind->is_tiled ? TILE : WIDTH;
                const int height = kind->is_tiled ? TILE : HEIGHT - y < 16 ? HEIGHT - y : 16;
                const tmsize_t size = (tmsize_t)fill(data, kind, x, y, width, height, plane);
                if ((kind->is_tiled ? TIFFWriteEncodedTile(tiff, (uint32_t)block, data, size)
                                    : TIFFWriteEncodedStrip(tiff, (uint32_t)block, data, size)) < 0)
                    return 0;
            }
    return 1;
}

int main(int argc, char **argv)
{
    char path[4096];
    int failed = argc != 2;
    for (size_t i = 0; !failed && i < sizeof kinds / sizeof *kinds; i++) {
        if (!TIFFIsCODECConfigured((uint16_t)kinds[i].compression))
            continue;
        snprintf(path, sizeof path, "%s/tiff-%s.tif", argv[1], kinds[i].name);
        TIFF *tiff = TIFFOpen(path, kinds[i].mode);
        failed = !tiff;
        if (!failed) {
            set_fields(tiff, &kinds[i]);
            failed = !write_blocks(tiff, &kinds[i]);
            TIFFClose(tiff);
        }
    }
    return failed ? 2 : 0;
}
