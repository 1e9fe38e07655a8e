/* Fonts: TrueType and OpenType files, through FreeType. It works in the scene's arena, so that all it takes is charged
 * to the scene's budget and goes with it; nothing is given back before. Files of other kinds are refused. */
#include <string.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include "sdl/object/shape.h"

#define SUBSTITUTE "cyrvetic.ttf"
enum { CUBIC_PIECES = 8 }; /* quadratic curves that stand for a cubic one; off by less than 1e-4 of its size */

struct Font {
    const char *path;
    FT_Face face;
    const Letter **letters; /* by index; NULL: not made yet */
    struct Font *next;
};

struct FontFiles {
    struct FT_MemoryRec_ memory;
    FT_Library library;
    Font *first;
};

/* ---- FreeType's memory ---- */

static void *take(FT_Memory memory, long size)
{
    return arena_alloc(memory->user, (size_t)size);
}

static void give_back(FT_Memory memory, void *block)
{
    (void)memory, (void)block;
}

static void *take_more(FT_Memory memory, long had, long size, void *block)
{
    if (size <= had)
        return block;
    void *more = take(memory, size);
    if (more && had > 0)
        memcpy(more, block, (size_t)had);
    return more;
}

static struct FontFiles *font_files(Sdl *sdl)
{
    ObjectState *objects = objects_of(sdl);
    if (objects->fonts)
        return objects->fonts;
    struct FontFiles *files = sdl_alloc(sdl, sizeof *files);
    files->memory = (struct FT_MemoryRec_){sdl_arena(sdl), take, give_back, take_more};
    if (FT_New_Library(&files->memory, &files->library))
        sdl_error(sdl, "FreeType, which reads fonts, does not start");
    FT_Add_Default_Modules(files->library);
    return objects->fonts = files;
}

/* ---- files ---- */

static int has_signature(const char *bytes, size_t size)
{
    static const char signatures[][5] = {{0, 1, 0, 0}, "true", "OTTO", "ttcf"};
    for (size_t i = 0; size >= 4 && i < sizeof signatures / sizeof *signatures; i++)
        if (memcmp(bytes, signatures[i], 4) == 0)
            return 1;
    return 0;
}

/* A font's file. Its name may lack the ending; in the place of a font that is not there comes POV-Ray's own. */
static const char *font_path(Sdl *sdl, const char *name)
{
    static const char *const endings[] = {"", ".ttf", ".TTF"};
    const size_t length = strlen(name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char *full = sdl_alloc(sdl, length + strlen(endings[i]) + 1);
        memcpy(full, name, length);
        memcpy(full + length, endings[i], strlen(endings[i]));
        const char *path = sdl_find_file(sdl, full);
        if (path)
            return path;
    }
    const char *substitute = sdl_find_file(sdl, SUBSTITUTE);
    if (!substitute)
        return sdl_need_file(sdl, "font", name);
    sdl_warn(sdl, "the font `%s` is not in the folders that may be read: " SUBSTITUTE " is used", name);
    return substitute;
}

Font *font_open(Sdl *sdl, const char *name)
{
    struct FontFiles *files = font_files(sdl);
    const char *path = font_path(sdl, name);
    for (Font *known = files->first; known; known = known->next)
        if (strcmp(known->path, path) == 0)
            return known;
    size_t size;
    const char *bytes = sdl_read_file(sdl, path, &size);
    Font *font = sdl_alloc(sdl, sizeof *font);
    font->path = path;
    if (!has_signature(bytes, size))
        sdl_error(sdl, "`%s` is no TrueType or OpenType font", path);
    int code = FT_New_Memory_Face(files->library, (const FT_Byte *)bytes, (FT_Long)size, 0, &font->face);
    if (code == FT_Err_Out_Of_Memory)
        sdl_alloc(sdl, SIZE_MAX / 2); /* tells of the limit */
    if (code)
        sdl_error(sdl, "the font `%s` is damaged", path);
    if (!FT_IS_SCALABLE(font->face) || font->face->units_per_EM == 0)
        sdl_error(sdl, "the font `%s` has no outlines", path);
    if (!font->face->charmap && font->face->num_charmaps > 0)
        FT_Set_Charmap(font->face, font->face->charmaps[0]);
    font->letters = sdl_alloc(sdl, ((size_t)font->face->num_glyphs + 1) * sizeof *font->letters);
    font->next = files->first;
    return files->first = font;
}

/* Fonts of symbols have their letters in a range of their own. */
unsigned font_letter_index(Font *font, unsigned long character)
{
    unsigned index = FT_Get_Char_Index(font->face, character);
    if (index == 0 && character < 256)
        index = FT_Get_Char_Index(font->face, 0xf000 + character);
    return index < (unsigned long)font->face->num_glyphs ? index : 0;
}

double font_kerning(const Font *font, unsigned left, unsigned right)
{
    FT_Vector by = {0, 0};
    if (FT_Get_Kerning(font->face, left, right, FT_KERNING_UNSCALED, &by))
        return 0;
    return (double)by.x / font->face->units_per_EM;
}

/* ---- outlines ---- */

/* An outline that is being taken apart, at first only to be counted. */
typedef struct Pieces {
    GlyphCurve *curves; /* or NULL */
    int count;
    Vec2 pen;
    double unit, length; /* length: of the contour so far */
} Pieces;

static Vec2 halfway(Vec2 a, Vec2 b, double x)
{
    return (Vec2){a.u + x * (b.u - a.u), a.v + x * (b.v - a.v)};
}

static void add_monotonic(Pieces *out, Vec2 a, Vec2 b, Vec2 c)
{
    const double length = hypot(c.u - a.u, c.v - a.v);
    if (length == 0)
        return;
    if (out->curves)
        out->curves[out->count] = (GlyphCurve){{a, b, c}, out->length, length};
    out->count++;
    out->length += length;
}

/* Where it turns in one coordinate; outside of 0..1 where it does not. */
static double turning_point(double a, double b, double c)
{
    const double bend = a - 2 * b + c;
    return bend != 0 ? (a - b) / bend : -1;
}

static void add_in_u(Pieces *out, Vec2 a, Vec2 b, Vec2 c)
{
    const double x = turning_point(a.u, b.u, c.u);
    if (!(x > 0 && x < 1)) {
        add_monotonic(out, a, b, c);
        return;
    }
    Vec2 left = halfway(a, b, x), right = halfway(b, c, x), middle = halfway(left, right, x);
    left.u = right.u = middle.u;
    add_monotonic(out, a, left, middle);
    add_monotonic(out, middle, right, c);
}

static void add_quadratic(Pieces *out, Vec2 b, Vec2 c)
{
    const Vec2 a = out->pen;
    const double x = turning_point(a.v, b.v, c.v);
    out->pen = c;
    if (!(x > 0 && x < 1)) {
        add_in_u(out, a, b, c);
        return;
    }
    Vec2 left = halfway(a, b, x), right = halfway(b, c, x), middle = halfway(left, right, x);
    left.v = right.v = middle.v;
    add_in_u(out, a, left, middle);
    add_in_u(out, middle, right, c);
}

static Vec2 point_of(const Pieces *out, const FT_Vector *p)
{
    return (Vec2){(double)p->x / out->unit, (double)p->y / out->unit};
}

static int move_to(const FT_Vector *to, void *context)
{
    Pieces *out = context;
    out->pen = point_of(out, to);
    out->length = 0;
    return 0;
}

static int line_to(const FT_Vector *to, void *context)
{
    Pieces *out = context;
    const Vec2 end = point_of(out, to);
    add_monotonic(out, out->pen, halfway(out->pen, end, 0.5), end);
    out->pen = end;
    return 0;
}

static int conic_to(const FT_Vector *control, const FT_Vector *to, void *context)
{
    Pieces *out = context;
    add_quadratic(out, point_of(out, control), point_of(out, to));
    return 0;
}

static int cubic_to(const FT_Vector *control1, const FT_Vector *control2, const FT_Vector *to, void *context)
{
    Pieces *out = context;
    const Vec2 p[4] = {out->pen, point_of(out, control1), point_of(out, control2), point_of(out, to)};
    for (int i = 1; i <= CUBIC_PIECES; i++) {
        /* A piece ends on the curve; its control point is where the tangents of both ends meet, nearly. */
        const double h = 1.0 / CUBIC_PIECES, x = i * h, m = x - h / 2;
        Vec2 end = p[3], middle;
        for (int k = 0; k < 2; k++) {
            const double y = k ? m : x;
            const Vec2 a = halfway(p[0], p[1], y), b = halfway(p[1], p[2], y), c = halfway(p[2], p[3], y);
            const Vec2 on = halfway(halfway(a, b, y), halfway(b, c, y), y);
            if (k)
                middle = on;
            else if (i < CUBIC_PIECES)
                end = on;
        }
        add_quadratic(out, (Vec2){2 * middle.u - (out->pen.u + end.u) / 2, 2 * middle.v - (out->pen.v + end.v) / 2},
                      end);
    }
    return 0;
}

static const Glyph *outline_of(Sdl *sdl, Font *font, FT_Outline *outline)
{
    static const FT_Outline_Funcs calls = {move_to, line_to, conic_to, cubic_to, 0, 0};
    Pieces out = {.unit = font->face->units_per_EM};
    if (FT_Outline_Decompose(outline, &calls, &out))
        sdl_error(sdl, "the font `%s` is damaged", font->path);
    if (out.count == 0)
        return NULL;
    Glyph *glyph = sdl_alloc(sdl, sizeof *glyph);
    glyph->ncurves = out.count;
    glyph->curves = out.curves = sdl_alloc(sdl, (size_t)out.count * sizeof *out.curves);
    out.count = 0;
    FT_Outline_Decompose(outline, &calls, &out);
    glyph->low = glyph->high = glyph->curves[0].p[0];
    for (int i = 0; i < glyph->ncurves; i++) {
        const Vec2 end = glyph->curves[i].p[2]; /* contours are closed, and their curves monotonic */
        glyph->low = (Vec2){fmin(glyph->low.u, end.u), fmin(glyph->low.v, end.v)};
        glyph->high = (Vec2){fmax(glyph->high.u, end.u), fmax(glyph->high.v, end.v)};
    }
    return glyph;
}

const Letter *font_letter(Sdl *sdl, Font *font, unsigned index)
{
    if (font->letters[index])
        return font->letters[index];
    Letter *letter = sdl_alloc(sdl, sizeof *letter);
    const int code = FT_Load_Glyph(font->face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP);
    sdl_step(sdl, 10);
    if (code == FT_Err_Out_Of_Memory)
        sdl_alloc(sdl, SIZE_MAX / 2);
    if (code || font->face->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
        sdl_error(sdl, "letter %u of the font `%s` is damaged", index, font->path);
    const double unit = font->face->units_per_EM;
    letter->advance = (double)font->face->glyph->metrics.horiAdvance / unit;
    letter->bearing = (double)font->face->glyph->metrics.horiBearingX / unit;
    letter->glyph = outline_of(sdl, font, &font->face->glyph->outline);
    return font->letters[index] = letter;
}
