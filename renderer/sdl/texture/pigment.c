/* pigment: the colour of a surface. Maps of colours and pigments, and the mean colours that stand in for what is not
 * supported. */
#include <stdlib.h>
#include <string.h>
#include "pattern/fractal.h"
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"

ParsedPigment *pigment_new(Sdl *sdl, const ParsedPigment *from)
{
    TextureState *textures = textures_of(sdl);
    ParsedPigment *pigment = textures->spare_pigment;
    textures->spare_pigment = NULL;
    if (!pigment)
        pigment = sdl_alloc(sdl, sizeof *pigment);
    if (from)
        *pigment = *from;
    else
        pigment->pigment = (Pigment){.kind = PIGMENT_COLOR,
                                     .pattern = PATTERN_INIT,
                                     .space = &sdl_scene(sdl)->working_space,
                                     .transform = transform_identity()};
    pigment->next = textures->pigments;
    textures->pigments = pigment;
    return pigment;
}

/* ---- means ---- */

static Rgbft lerp(Rgbft a, Rgbft b, double t)
{
    float f = (float)t, g = (float)(1 - t);
    return (Rgbft){a.r * g + b.r * f, a.g * g + b.g * f, a.b * g + b.b * f, a.filter * g + b.filter * f,
                   a.transmit * g + b.transmit * f};
}

static void add(Rgbft *sum, Rgbft c, double weight)
{
    float w = (float)weight;
    sum->r += c.r * w, sum->g += c.g * w, sum->b += c.b * w;
    sum->filter += c.filter * w, sum->transmit += c.transmit * w;
}

static Rgbft map_at(const ColorMap *map, double x)
{
    const ColorMapEntry *e = map->entries;
    if (x <= e[0].value)
        return e[0].color;
    for (int i = 1; i < map->count; i++)
        if (x <= e[i].value)
            return e[i].value > e[i - 1].value
                       ? lerp(e[i - 1].color, e[i].color, (x - e[i - 1].value) / (e[i].value - e[i - 1].value))
                       : e[i].color;
    return e[map->count - 1].color;
}

/* Over 0..1, exact: the map is piecewise linear between its entries. */
static Rgbft map_mean(const ColorMap *map)
{
    if (map->count == 0)
        return (Rgbft){0.5f, 0.5f, 0.5f, 0, 0};
    Rgbft sum = {0};
    double at = 0;
    Rgbft here = map_at(map, 0);
    for (int i = 0; i < map->count; i++) {
        double next = fmin(fmax(map->entries[i].value, 0), 1);
        Rgbft there = map_at(map, next);
        add(&sum, lerp(here, there, 0.5), next - at);
        /* Of two entries at one place the second one goes on. */
        at = next;
        here = map->entries[i].value >= 0 && map->entries[i].value <= 1 ? map->entries[i].color : there;
    }
    add(&sum, here, 1 - at);
    return sum;
}

/* The mean of the entries, by their values or evenly. */
static Rgbft entries_mean(const ColorMap *map, int weighted)
{
    Rgbft sum = {0};
    double weights = 0;
    for (int i = 0; i < map->count; i++)
        weights += weighted ? map->entries[i].value : 1;
    for (int i = 0; i < map->count && weights != 0; i++)
        add(&sum, map->entries[i].color, (weighted ? map->entries[i].value : 1) / weights);
    return sum;
}

static Rgbft pigment_mean(const Pigment *pigment)
{
    switch (pigment->kind) {
    case PIGMENT_COLOR:
        break;
    case PIGMENT_IMAGE:
        return (Rgbft){0.5f, 0.5f, 0.5f, 0, 0};
    case PIGMENT_PATTERN:
        return pigment->pattern.ops->colors ? entries_mean(&pigment->map, 0) : map_mean(&pigment->map);
    case PIGMENT_AVERAGE:
        return entries_mean(&pigment->map, 1);
    }
    return pigment->color;
}

/* ---- maps ---- */

/* An identifier may be in a map several times, and its map has identifiers: they are counted as if written out. */
enum { MAP_PARTS_MAX = 20000, MAP_DEPTH_MAX = 64 };

static ParsedColorMap *map_new(Sdl *sdl)
{
    return sdl_alloc(sdl, sizeof(ParsedColorMap));
}

void color_map_set(Sdl *sdl, ParsedColorMap *map, int entry, const ParsedPigment *pigment)
{
    ColorMapEntry *e = &map->map.entries[entry];
    e->color = pigment_mean(&pigment->pigment);
    e->pigment = pigment->pigment.kind == PIGMENT_COLOR ? NULL : &pigment->pigment;
    gaps_join(&map->gaps, &pigment->gaps);
    map->parts += 1 + pigment->parts;
    if (map->depth < pigment->depth + 1)
        map->depth = pigment->depth + 1;
    if (map->parts > MAP_PARTS_MAX)
        sdl_error(sdl, "a pigment_map of more than %d pigments", MAP_PARTS_MAX);
    if (map->depth > MAP_DEPTH_MAX)
        sdl_error(sdl, "pigments nested more than %d deep", MAP_DEPTH_MAX);
}

void pigment_set_map(ParsedPigment *pigment, const ParsedColorMap *map)
{
    pigment->pigment.map = map->map;
    pigment->parts = map->parts;
    pigment->depth = map->depth;
    gaps_join(&pigment->gaps, &map->gaps);
}

ParsedColorMap *color_list_new(Sdl *sdl, const PatternOps *ops)
{
    static const Rgbft colors[PATTERN_COLORS] = {{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 1, 0, 0},
                                                 {1, 1, 0, 0, 0}, {0, 1, 1, 0, 0}, {1, 0, 1, 0, 0}};
    ParsedColorMap *map = map_new(sdl);
    map->map.count = ops->colors;
    map->map.entries = sdl_alloc(sdl, (size_t)ops->colors * sizeof *map->map.entries);
    for (int i = 0; i < ops->colors; i++)
        map->map.entries[i] = (ColorMapEntry){i, ops->map ? ops->map->entries[i].color : colors[i], NULL};
    return map;
}

/* Its index. */
static int map_add(Sdl *sdl, ParsedColorMap *map, int *capacity, double value, Rgbft color)
{
    map->map.entries = sdl_grow(sdl, map->map.entries, map->map.count, capacity, sizeof(ColorMapEntry));
    int i = map->map.count++;
    /* In order of value, what was written first first. */
    for (; i > 0 && map->map.entries[i - 1].value > value; i--)
        map->map.entries[i] = map->map.entries[i - 1];
    map->map.entries[i] = (ColorMapEntry){value, color, NULL};
    return i;
}

static Rgbft value_color(Sdl *sdl, const Value *value)
{
    const double *n = value->number;
    if (value->kind == VALUE_FLOAT)
        return (Rgbft){(float)n[0], (float)n[0], (float)n[0], 0, 0};
    if (value->kind != VALUE_VECTOR || value->count < 3)
        sdl_expected(sdl, "a colour");
    return (Rgbft){(float)n[0], (float)n[1], (float)n[2], value->count > 3 ? (float)n[3] : 0,
                   value->count > 4 ? (float)n[4] : 0};
}

/* `[VALUE COLOUR]`, or the old `[FROM TO COLOUR COLOUR]`. */
static void color_map_entry(Sdl *sdl, ParsedColorMap *map, int *capacity)
{
    double from = sdl_float(sdl);
    sdl_optional_comma(sdl);
    if (sdl_is_color_start(sdl)) {
        map_add(sdl, map, capacity, from, sdl_color(sdl));
    } else {
        Value value = sdl_expression(sdl);
        sdl_optional_comma(sdl);
        if (value.kind == VALUE_FLOAT && !sdl_is(sdl, "]")) {
            map_add(sdl, map, capacity, from, sdl_color(sdl));
            sdl_optional_comma(sdl);
            map_add(sdl, map, capacity, value.number[0], sdl_color(sdl));
        } else
            map_add(sdl, map, capacity, from, value_color(sdl, &value));
    }
    sdl_optional_comma(sdl);
    sdl_expect(sdl, "]");
}

ParsedColorMap *parse_color_map(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    ParsedColorMap *known = accept_ident(sdl, VALUE_COLOR_MAP);
    if (known) {
        sdl_expect(sdl, "}");
        return known;
    }
    ParsedColorMap *map = map_new(sdl);
    int capacity = 0;
    while (sdl_accept(sdl, "["))
        color_map_entry(sdl, map, &capacity), sdl_optional_comma(sdl);
    if (map->map.count == 0)
        sdl_expected(sdl, "`[` and an entry of the color_map");
    sdl_expect(sdl, "}");
    return map;
}

static ParsedColorMap *known_map(Sdl *sdl)
{
    Value *value = peek_ident(sdl, VALUE_OTHER);
    if (!value || !value->word || strcmp(value->word, "pigment_map") != 0)
        return NULL;
    ParsedColorMap *known = value->data;
    sdl_next(sdl);
    sdl_expect(sdl, "}");
    return known;
}

/* The rest of a pigment_map: the identifier of one, or its entries. */
ParsedColorMap *parse_pigment_map(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    ParsedColorMap *map = known_map(sdl);
    if (map)
        return map;
    map = map_new(sdl);
    int capacity = 0;
    statement_begin(sdl);
    while (sdl_accept(sdl, "[")) {
        double value = optional_float(sdl, 1); /* of `average` it may be left out */
        sdl_optional_comma(sdl);
        const ParsedPigment *pigment = parse_pigment_body(sdl, default_pigment(sdl), ']');
        color_map_set(sdl, map, map_add(sdl, map, &capacity, value, pigment->pigment.color), pigment);
        sdl_optional_comma(sdl);
    }
    statement_end(sdl);
    sdl_expect(sdl, "}");
    return map;
}

/* ---- the body ---- */

static int accept_map(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures)
{
    ParsedColorMap *map;
    if (textures && sdl_accept(sdl, "texture_map")) {
        *textures = *parse_texture_map(sdl);
        return 1;
    }
    if (sdl_accept(sdl, "color_map") || sdl_accept(sdl, "colour_map"))
        map = parse_color_map(sdl);
    else if (sdl_accept(sdl, "pigment_map") || sdl_accept(sdl, "density_map"))
        map = parse_pigment_map(sdl);
    else
        return 0;
    pigment_set_map(pigment, map);
    return 1;
}

static void set_color(ParsedPigment *pigment, Rgbft color)
{
    pigment->pigment.kind = PIGMENT_COLOR;
    pigment->pigment.color = color;
    pigment->averaged = 0;
}

static int accept_named(Sdl *sdl, ParsedPigment *pigment)
{
    const ParsedPigment *known = accept_ident(sdl, VALUE_PIGMENT);
    if (!known && !(known = accept_ident_of_word(sdl, "density")))
        return 0;
    ParsedPigment *next = pigment->next;
    *pigment = *known;
    pigment->next = next;
    return 1;
}

static void pigment_item(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures)
{
    Transform by;
    const char *file = sdl_peek(sdl)->file;
    const int line = sdl_peek(sdl)->line;
    if (accept_named(sdl, pigment))
        return;
    if (accept_transform(sdl, &by)) {
        pigment->pigment.transform = transform_then(pigment->pigment.transform, by);
        return;
    }
    if (sdl_accept(sdl, "uv_mapping")) {
        pigment->pigment.uv_mapping = sdl_optional_bool(sdl, 1);
        return;
    }
    if (sdl_accept(sdl, "retex_tint")) {
        if (pigment->pigment.kind != PIGMENT_IMAGE)
            sdl_error(sdl, "retex_tint: the pigment has no image_map");
        const Rgbft c = sdl_color(sdl);
        pigment->pigment.color = (Rgbft){not_negative(c.r), not_negative(c.g), not_negative(c.b), 0, 0};
        pigment->pigment.is_tinted = 1;
        return;
    }
    const int mapped = accept_map(sdl, pigment, textures) || accept_pattern(sdl, pigment, textures);
    if (mapped)
        pigment->file = file, pigment->line = line;
    if (mapped || accept_pattern_modifier(sdl, pigment))
        return;
    if (sdl_accept(sdl, "quick_color") || sdl_accept(sdl, "quick_colour"))
        sdl_color(sdl); /* of previews only */
    else if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl))
        set_color(pigment, sdl_color(sdl)), pigment->file = file, pigment->line = line;
    else
        sdl_expected(sdl, "a colour, a pattern, a transform or the end of the pigment");
}

/* As in POV-Ray, fractals of other exponents than 2 go from black to white. */
static const ColorMap *default_map(const Pattern *pattern)
{
    if (pattern->ops->arguments == ARGUMENTS_FRACTAL && ((const Fractal *)pattern->data)->exponent != 2)
        return NULL;
    return pattern->ops->map;
}

static void pigment_items(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures, char end)
{
    const char closing[2] = {end, 0};
    statement_begin(sdl);
    while (!sdl_accept(sdl, closing))
        pigment_item(sdl, pigment, textures), sdl_optional_comma(sdl);
    statement_end(sdl);
    const ColorMap *map = pigment->pigment.kind == PIGMENT_PATTERN ? default_map(&pigment->pigment.pattern) : NULL;
    if (map && pigment->pigment.map.count == 0)
        pigment->pigment.map = *map;
    if (pigment->averaged) {
        pigment->pigment.kind = PIGMENT_PATTERN;
        pigment->pigment.color = pigment_mean(&pigment->pigment);
        pigment->pigment.kind = PIGMENT_COLOR;
    }
}

ParsedPigment *parse_pigment_body(Sdl *sdl, const ParsedPigment *from, char end)
{
    ParsedPigment *pigment = pigment_new(sdl, from);
    pigment_items(sdl, pigment, NULL, end);
    return pigment;
}

ParsedPigment *parse_pigment(Sdl *sdl, const ParsedPigment *from)
{
    sdl_expect(sdl, "{");
    return parse_pigment_body(sdl, from, '}');
}

static ParsedPigment **plain_bucket(TextureState *textures, const Rgbft *color)
{
    uint32_t words[sizeof *color / sizeof(uint32_t)], hash = 0;
    memcpy(words, color, sizeof words);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        hash = (hash ^ words[i]) * 0x9e3779b1u;
    return &textures->plain_pigments[hash >> 16 & (PLAIN_PIGMENTS - 1)];
}

/* Molecules have a colour at every corner of a face, and few colours: without this, pigments would be half of what such
 * scenes need. */
ParsedPigment *parse_shared_pigment(Sdl *sdl, const ParsedPigment *from)
{
    TextureState *textures = textures_of(sdl);
    ParsedPigment *pigment = parse_pigment(sdl, from);
    if (pigment->pigment.kind != PIGMENT_COLOR || pigment->averaged || textures->pigments != pigment)
        return pigment;
    ParsedPigment **bucket = plain_bucket(textures_of(sdl), &pigment->pigment.color);
    ParsedPigment *known = *bucket, *next = pigment->next;
    if (known) { /* the same but for its place in the file and in the list */
        const int line = pigment->line;
        pigment->line = known->line, pigment->next = known->next;
        if (memcmp(pigment, known, sizeof *pigment) == 0) {
            memset(pigment, 0, sizeof *pigment);
            textures->spare_pigment = pigment;
            textures->pigments = next;
            return known;
        }
        pigment->line = line, pigment->next = next;
    }
    *bucket = pigment;
    return pigment;
}

ParsedPigment *parse_selector(Sdl *sdl, char end, ParsedTextureMap *map)
{
    ParsedPigment *pigment = pigment_new(sdl, NULL);
    pigment_items(sdl, pigment, map, end);
    return pigment;
}
