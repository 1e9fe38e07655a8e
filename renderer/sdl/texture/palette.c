/* Indices of a PNG picture that has a palette, through libpng: height fields take them for heights. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include "sdl/texture/texture.h"

enum { HEAD = 26, PALETTE_BYTE = 25 }; /* the signature and the chunk IHDR up to the kind of colours */

typedef struct Source {
    const unsigned char *next, *end;
    char message[120];
} Source;

static void read_bytes(png_structp png, png_bytep out, size_t count)
{
    Source *source = png_get_io_ptr(png);
    if ((size_t)(source->end - source->next) < count)
        png_error(png, "the file ends early");
    memcpy(out, source->next, count);
    source->next += count;
}

static void stop(png_structp png, png_const_charp message)
{
    Source *source = png_get_error_ptr(png);
    snprintf(source->message, sizeof source->message, "%s", message);
    png_longjmp(png, 1);
}

/* Warnings of the compressed pixels mean damage, unless they only go on after the last row. */
static void stop_at_damage(png_structp png, png_const_charp message)
{
    if (strncmp(message, "IDAT: ", 6) == 0 && !strstr(message, "Too much") && !strstr(message, "Extra compressed"))
        stop(png, message);
}

/* Reads all rows into memory of the arena. Whatever libpng finds wrong ends in stop. */
static void read_rows(png_structp png, png_infop info, Arena *arena, PaletteIndices *out)
{
    png_read_info(png, info);
    png_set_packing(png); /* an index is a byte */
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    out->width = (int)png_get_image_width(png, info);
    out->height = (int)png_get_image_height(png, info);
    unsigned char *indices = arena_alloc(arena, (size_t)out->width * (size_t)out->height);
    if (!indices || png_get_rowbytes(png, info) != (size_t)out->width)
        png_error(png, indices ? "its rows are damaged" : "no memory for its pixels");
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < out->height; y++)
            png_read_row(png, indices + (size_t)y * (size_t)out->width, NULL);
    png_read_end(png, NULL);
    out->indices = indices;
}

static int is_gif(const char *path)
{
    char head[6];
    FILE *file = fopen(path, "rb");
    const int whole = file && fread(head, 1, sizeof head, file) == sizeof head;
    if (file)
        fclose(file);
    return whole && (memcmp(head, "GIF87a", sizeof head) == 0 || memcmp(head, "GIF89a", sizeof head) == 0);
}

static int has_palette(const char *path)
{
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    unsigned char head[HEAD];
    FILE *file = fopen(path, "rb");
    const int whole = file && fread(head, 1, HEAD, file) == HEAD;
    if (file)
        fclose(file);
    return whole && memcmp(head, signature, sizeof signature) == 0 && head[PALETTE_BYTE] == PNG_COLOR_TYPE_PALETTE;
}

int read_palette_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out)
{
    *out = (PaletteIndices){0};
    if (is_gif(path)) {
        read_gif_indices(sdl, path, side_max, out);
        return 1;
    }
    if (!has_palette(path))
        return 0;
    size_t size;
    Source source = {.message = "no memory"};
    source.next = (const unsigned char *)sdl_read_file(sdl, path, &size);
    source.end = source.next + size;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, stop, stop_at_damage);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (info && !setjmp(png_jmpbuf(png))) {
        png_set_user_limits(png, (png_uint_32)side_max, (png_uint_32)side_max);
        png_set_read_fn(png, &source, read_bytes);
        read_rows(png, info, sdl_arena(sdl), out);
    }
    png_destroy_read_struct(&png, &info, NULL);
    if (!out->indices)
        sdl_error(sdl, "`%s`: %s", path, source.message);
    return 1;
}
