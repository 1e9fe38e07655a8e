/* Indices of the first picture of a GIF file: height fields and maps of textures take them for numbers. Read here,
 * because what reads pictures otherwise gives colours, of which several entries of a palette may have the same. */
#include <string.h>
#include "sdl/build/builder.h"

enum { MOST_CODES = 4096, MOST_BITS = 12 };

typedef struct Source {
    const unsigned char *next, *end;
    int left; /* in the current block of data */
    unsigned bits;
    int nbits;
} Source;

/* -1 where the file has ended. */
static int next_byte(Source *s)
{
    return s->next < s->end ? *s->next++ : -1;
}

static int next_short(Source *s)
{
    const int low = next_byte(s), high = next_byte(s);
    return high < 0 ? -1 : low + 256 * high;
}

static int skip(Source *s, int count)
{
    if (count < 0 || s->end - s->next < count)
        return 0;
    s->next += count;
    return 1;
}

static int skip_table(Source *s, int flags)
{
    return !(flags & 0x80) || skip(s, 3 << ((flags & 7) + 1));
}

/* Data comes in blocks of up to 255 bytes; an empty one is the last. */
static int skip_blocks(Source *s)
{
    int size;
    while ((size = next_byte(s)) > 0)
        if (!skip(s, size))
            return 0;
    return size == 0;
}

static int next_code(Source *s, int size)
{
    while (s->nbits < size) {
        if (s->left == 0)
            s->left = next_byte(s);
        const int byte = s->left > 0 ? next_byte(s) : -1;
        if (byte < 0)
            return -1;
        s->left--;
        s->bits |= (unsigned)byte << s->nbits;
        s->nbits += 8;
    }
    const int code = (int)(s->bits & ((1u << size) - 1));
    s->bits >>= size;
    s->nbits -= size;
    return code;
}

/* The strings of bytes that codes stand for: that of another code, and one byte more. */
typedef struct Strings {
    int count, size; /* of the next code in bits */
    short before[MOST_CODES];
    int length[MOST_CODES];
    unsigned char first[MOST_CODES], last[MOST_CODES];
} Strings;

static void strings_clear(Strings *t, int bits)
{
    t->count = (1 << bits) + 2;
    t->size = bits + 1;
    for (int i = 0; i < t->count; i++)
        t->before[i] = -1, t->length[i] = 1, t->first[i] = t->last[i] = (unsigned char)i;
}

static void strings_add(Strings *t, int before, unsigned char last)
{
    const int i = t->count;
    if (i == MOST_CODES)
        return;
    t->before[i] = (short)before, t->length[i] = t->length[before] + 1;
    t->first[i] = t->first[before], t->last[i] = last;
    if (++t->count == 1 << t->size && t->size < MOST_BITS)
        t->size++;
}

/* LZW, of codes that begin with `bits` + 1 bits. Returns 0 where there are fewer bytes, or what is no code. */
static int decompress(Source *s, Strings *t, int bits, unsigned char *out, size_t count)
{
    const int clear = 1 << bits;
    int before = -1;
    size_t done = 0;
    strings_clear(t, bits);
    while (done < count) {
        const int code = next_code(s, t->size);
        if (code < 0 || code == clear + 1)
            return 0;
        if (code == clear) {
            strings_clear(t, bits), before = -1;
            continue;
        }
        if (code > t->count || (code == t->count && before < 0))
            return 0;
        if (before >= 0)
            strings_add(t, before, t->first[code < t->count ? code : before]);
        if (code >= t->count)
            return 0;
        size_t end = done + (size_t)t->length[code];
        for (int i = code; i >= 0; i = t->before[i])
            if (--end < count)
                out[end] = t->last[i];
        done += (size_t)t->length[code];
        before = code;
    }
    return 1;
}

/* The row of an interlaced picture that is stored as the k-th. */
static int interlaced_row(int k, int height)
{
    static const int first[4] = {0, 4, 2, 1}, step[4] = {8, 8, 4, 2};
    for (int pass = 0; pass < 3; pass++) {
        const int rows = (height - first[pass] + step[pass] - 1) / step[pass];
        if (k < rows)
            return first[pass] + k * step[pass];
        k -= rows;
    }
    return first[3] + k * step[3];
}

/* From after its mark on. What is wrong, or NULL. */
static const char *read_picture(Sdl *sdl, Source *s, int side_max, PaletteIndices *out)
{
    if (!skip(s, 4))
        return "the file ends early";
    const int width = next_short(s), height = next_short(s), flags = next_byte(s);
    const int known = flags >= 0 && skip_table(s, flags), bits = next_byte(s);
    if (!known || bits < 0)
        return "the file ends early";
    if (width < 1 || height < 1 || width > side_max || height > side_max)
        return "it has no pixels, or too many";
    if (bits < 2 || bits > 8)
        return "its pixels are damaged";
    const size_t row = (size_t)width;
    if (row * (size_t)height / MOST_CODES > (size_t)(s->end - s->next)) /* before there is memory for them */
        return "its pixels are damaged, or end early";
    unsigned char *stored = sdl_alloc(sdl, row * (size_t)height), *rows = stored;
    if (!decompress(s, sdl_alloc(sdl, sizeof(Strings)), bits, stored, row * (size_t)height))
        return "its pixels are damaged, or end early";
    if (flags & 0x40) {
        rows = sdl_alloc(sdl, row * (size_t)height);
        for (int k = 0; k < height; k++)
            memcpy(rows + row * (size_t)interlaced_row(k, height), stored + row * (size_t)k, row);
    }
    *out = (PaletteIndices){width, height, rows};
    return NULL;
}

static const char *read_file(Sdl *sdl, Source *s, int side_max, PaletteIndices *out)
{
    enum { EXTENSION = 0x21, PICTURE = 0x2c };
    int mark = skip(s, 6 + 4) ? next_byte(s) : -1;
    if (mark < 0 || !skip(s, 2) || !skip_table(s, mark))
        return "the file ends early";
    while ((mark = next_byte(s)) == EXTENSION)
        if (next_byte(s) < 0 || !skip_blocks(s))
            return "the file ends early";
    return mark == PICTURE ? read_picture(sdl, s, side_max, out) : "it has no picture";
}

void read_gif_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out)
{
    size_t size;
    Source source = {0};
    source.next = (const unsigned char *)sdl_read_file(sdl, path, &size);
    source.end = source.next + size;
    const char *wrong = read_file(sdl, &source, side_max, out);
    if (wrong)
        sdl_error(sdl, "`%s`: %s", path, wrong);
}
