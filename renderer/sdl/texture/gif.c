/* Indices of the first picture of a GIF file, through giflib: height fields and maps of textures take them for numbers.
 * Readers of pictures give colours, of which several entries of a palette may have the same. */
#include <gif_lib.h>
#include <string.h>
#include "sdl/texture/texture.h"

enum { MOST_PIXELS_A_BYTE = 4096 }; /* no string of LZW is longer: larger pictures are damaged */

typedef struct Source {
    const unsigned char *next, *end;
} Source;

static int read_bytes(GifFileType *gif, GifByteType *out, int count)
{
    Source *s = gif->UserData;
    const int left = (int)(s->end - s->next);
    if (count > left)
        count = left;
    memcpy(out, s->next, (size_t)count);
    s->next += count;
    return count;
}

static int skip_extension(GifFileType *gif)
{
    int kind;
    GifByteType *block;
    int status = DGifGetExtension(gif, &kind, &block);
    while (status == GIF_OK && block)
        status = DGifGetExtensionNext(gif, &block);
    return status;
}

/* 1 if the next thing in the file is a picture; 0 if there is none, or the file is damaged. */
static int find_picture(GifFileType *gif)
{
    GifRecordType type;
    while (DGifGetRecordType(gif, &type) == GIF_OK) {
        if (type == IMAGE_DESC_RECORD_TYPE)
            return DGifGetImageDesc(gif) == GIF_OK;
        if (type != EXTENSION_RECORD_TYPE || skip_extension(gif) != GIF_OK)
            return 0;
    }
    return 0;
}

/* Rows of an interlaced picture are stored every eighth first, then those in the middle, and so on. */
static int read_rows(GifFileType *gif, int width, int height, int interlaced, unsigned char *out)
{
    static const int first[4] = {0, 4, 2, 1}, step[4] = {8, 8, 4, 2};
    for (int pass = 0; pass < (interlaced ? 4 : 1); pass++)
        for (int y = first[pass]; y < height; y += interlaced ? step[pass] : 1)
            if (DGifGetLine(gif, out + (size_t)y * (size_t)width, width) != GIF_OK)
                return 0;
    return 1;
}

/* What is wrong, or NULL. */
static const char *read_picture(GifFileType *gif, const Source *source, int side_max, Arena *arena, PaletteIndices *out)
{
    if (!find_picture(gif))
        return "it has no picture, or ends early";
    const int width = gif->Image.Width, height = gif->Image.Height;
    if (width < 1 || height < 1 || width > side_max || height > side_max)
        return "it has no pixels, or too many";
    const size_t count = (size_t)width * (size_t)height;
    if (count / MOST_PIXELS_A_BYTE > (size_t)(source->end - source->next)) /* before there is memory for them */
        return "its pixels are damaged, or end early";
    unsigned char *indices = arena_alloc(arena, count);
    if (!indices)
        return "no memory for its pixels";
    if (!read_rows(gif, width, height, gif->Image.Interlace, indices))
        return "its pixels are damaged, or end early";
    *out = (PaletteIndices){width, height, indices};
    return NULL;
}

void read_gif_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out)
{
    size_t size;
    int error = 0;
    Source source = {0};
    source.next = (const unsigned char *)sdl_read_file(sdl, path, &size);
    source.end = source.next + size;
    GifFileType *gif = DGifOpen(&source, read_bytes, &error);
    const char *wrong =
        gif ? read_picture(gif, &source, side_max, sdl_arena(sdl), out) : "it is damaged, or ends early";
    if (gif)
        DGifCloseFile(gif, &error);
    if (wrong)
        sdl_error(sdl, "`%s`: %s", path, wrong);
}
