/* text: letters of a font in a row, each a shape of its own in a union. */
#include "sdl/object/shape.h"

/* The fonts that are built into POV-Ray, by their numbers. */
static const char *const built_in[] = {"povlogo.ttf", "timrom.ttf", "cyrvetic.ttf", "crystal.ttf"};

static Font *parse_font(Sdl *sdl)
{
    if (sdl_accept(sdl, "internal")) {
        const double number = sdl_float(sdl);
        const int count = (int)(sizeof built_in / sizeof *built_in);
        return font_open(sdl, built_in[number >= 0 && number < count ? (int)number : 0]);
    }
    if (!sdl_accept(sdl, "ttf"))
        sdl_expected(sdl, "ttf or internal in text");
    return font_open(sdl, sdl_string(sdl));
}

/* The next character of UTF-8. A byte that is none is a character of Latin-1. */
static unsigned long next_character(const char **text)
{
    const unsigned char *s = (const unsigned char *)*text;
    const int more = s[0] < 0xc2 ? 0 : s[0] < 0xe0 ? 1 : s[0] < 0xf0 ? 2 : s[0] < 0xf5 ? 3 : 0;
    unsigned long character = more ? s[0] & (0x3fu >> more) : s[0];
    for (int i = 1; i <= more; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            ++*text;
            return s[0];
        }
        character = character << 6 | (s[i] & 0x3f);
    }
    *text += more + 1;
    return character;
}

static Object *letter_object(Sdl *sdl, const Glyph *glyph, double thickness, Vec3 at)
{
    Object *object = object_new(sdl, OBJECT_SHAPE);
    object->shape.ops = &shape_text;
    object->shape.r0 = thickness;
    object->shape.data = glyph;
    object->transform = transform_translate(at);
    return object;
}

/* The first letter begins at x = 0. From letter to letter go its advance, the pair's kerning, and the offset. */
static void set_letters(Sdl *sdl, Object *text, Font *font, const char *string, double thickness, Vec3 offset)
{
    ObjectList **end = (ObjectList **)&text->children;
    Vec3 pen = vec3(0, 0, 0);
    unsigned last = 0;
    for (int i = 0; *string; i++) {
        const unsigned index = font_letter_index(font, next_character(&string));
        const Letter *letter = font_letter(sdl, font, index);
        sdl_step(sdl, 1);
        pen.x += i == 0 ? -letter->bearing : font_kerning(font, last, index);
        if (letter->glyph) {
            Object *object = letter_object(sdl, letter->glyph, thickness, pen);
            object_count_child(sdl, text, object);
            *end = sdl_alloc(sdl, sizeof **end);
            (*end)->object = object;
            end = &(*end)->next;
        }
        pen = vec_add(pen, vec3(letter->advance + offset.x, offset.y, 0));
        last = index;
    }
}

void parse_text(Sdl *sdl, Object *object)
{
    Font *font = parse_font(sdl);
    sdl_optional_comma(sdl);
    const char *string = sdl_string(sdl);
    sdl_optional_comma(sdl);
    const double thickness = sdl_float(sdl);
    sdl_optional_comma(sdl);
    const Vec3 offset = sdl_vector(sdl);
    object->kind = OBJECT_COMPOUND;
    object->csg = CSG_UNION;
    if (thickness == 0 || !isfinite(thickness)) {
        sdl_warn(sdl, "a text without thickness: it is left out");
        object->kind = OBJECT_EMPTY;
        return;
    }
    set_letters(sdl, object, font, string, thickness, offset);
}
