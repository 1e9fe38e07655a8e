/* Patterns of pigments and textures: checker and gradient are kept, all others are read and averaged. */
#include <string.h>
#include "sdl/build/builder.h"

/* What follows a pattern's name. */
typedef enum Args {
    ARGS_NONE,
    ARGS_FLOAT,
    ARGS_BLOCK,
    ARGS_LIST,
    ARGS_FILE,
    ARGS_JULIA,
    ARGS_MAGNET,
    ARGS_SLOPE,
    ARGS_OBJECT,
    ARGS_AVERAGE
} Args;

static const struct Pattern {
    const char *word;
    Args args;
    Gap gap;
    int list; /* how many colours or pigments may stand in a list */
} patterns[] = {
    {"agate", ARGS_NONE, GAP_AGATE, 0},
    {"aoi", ARGS_NONE, GAP_AOI, 0},
    {"average", ARGS_AVERAGE, GAP_AVERAGE, 0},
    {"boxed", ARGS_NONE, GAP_BOXED, 0},
    {"bozo", ARGS_NONE, GAP_BOZO, 0},
    {"brick", ARGS_LIST, GAP_BRICK, 2},
    {"bumps", ARGS_NONE, GAP_BUMPS, 0},
    {"cells", ARGS_NONE, GAP_CELLS, 0},
    {"crackle", ARGS_NONE, GAP_CRACKLE, 0},
    {"cubic", ARGS_LIST, GAP_CUBIC_PATTERN, 6},
    {"cylindrical", ARGS_NONE, GAP_CYLINDRICAL, 0},
    {"density_file", ARGS_FILE, GAP_DENSITY_FILE, 0},
    {"dents", ARGS_NONE, GAP_DENTS, 0},
    {"facets", ARGS_NONE, GAP_FACETS, 0},
    {"function", ARGS_BLOCK, GAP_FUNCTION, 0},
    {"granite", ARGS_NONE, GAP_GRANITE, 0},
    {"hexagon", ARGS_LIST, GAP_HEXAGON, 3},
    {"image_pattern", ARGS_BLOCK, GAP_IMAGE_PATTERN, 0},
    {"julia", ARGS_JULIA, GAP_JULIA, 0},
    {"leopard", ARGS_NONE, GAP_LEOPARD, 0},
    {"magnet", ARGS_MAGNET, GAP_MAGNET, 0},
    {"mandel", ARGS_FLOAT, GAP_MANDEL, 0},
    {"marble", ARGS_NONE, GAP_MARBLE, 0},
    {"object", ARGS_OBJECT, GAP_OBJECT_PATTERN, 2},
    {"onion", ARGS_NONE, GAP_ONION, 0},
    {"pavement", ARGS_NONE, GAP_PAVEMENT, 0},
    {"pigment_pattern", ARGS_BLOCK, GAP_PIGMENT_PATTERN, 0},
    {"planar", ARGS_NONE, GAP_PLANAR, 0},
    {"projection", ARGS_BLOCK, GAP_PROJECTION, 0},
    {"quilted", ARGS_NONE, GAP_QUILTED, 0},
    {"radial", ARGS_NONE, GAP_RADIAL, 0},
    {"ripples", ARGS_NONE, GAP_RIPPLES, 0},
    {"slope", ARGS_SLOPE, GAP_SLOPE, 0},
    {"spherical", ARGS_NONE, GAP_SPHERICAL, 0},
    {"spiral1", ARGS_FLOAT, GAP_SPIRAL, 0},
    {"spiral2", ARGS_FLOAT, GAP_SPIRAL, 0},
    {"spotted", ARGS_NONE, GAP_SPOTTED, 0},
    {"square", ARGS_LIST, GAP_SQUARE, 4},
    {"tiling", ARGS_FLOAT, GAP_TILING, 0},
    {"triangular", ARGS_LIST, GAP_TRIANGULAR, 6},
    {"waves", ARGS_NONE, GAP_WAVES, 0},
    {"wood", ARGS_NONE, GAP_WOOD, 0},
    {"wrinkles", ARGS_NONE, GAP_WRINKLES, 0},
};

static const struct Pattern *find_pattern(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    if (token->kind != TOKEN_WORD)
        return NULL;
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
        if (strcmp(token->text, patterns[i].word) == 0)
            return &patterns[i];
    return NULL;
}

/* ---- lists of colours, pigments or textures ---- */

static int list_item(Sdl *sdl, Rgbft *color, ParsedPigment *pigment, const ParsedTexture **first, int textures)
{
    if (textures && sdl_accept(sdl, "texture")) {
        const ParsedTexture *texture = parse_texture(sdl);
        const ParsedTexture *shown = texture_visible(texture);
        const ParsedPigment *of = (const ParsedPigment *)shown->texture.pigment;
        *color = pigment_mean(of);
        gaps_join(&pigment->gaps, &of->gaps);
        gaps_join(&pigment->gaps, &texture->gaps);
        /* Textures of one finish and plain colours are the same as a pattern of those colours. */
        if (of->pigment.kind != PIGMENT_COLOR || texture->below ||
            (*first && memcmp((*first)->texture.finish, shown->texture.finish, sizeof(Finish)) != 0))
            gaps_add(&pigment->gaps, GAP_TEXTURE_MAP);
        if (!*first)
            *first = texture;
        return 1;
    }
    if (!textures && sdl_accept(sdl, "pigment")) {
        ParsedPigment *of = parse_pigment(sdl, default_pigment(sdl));
        *color = pigment_mean(of);
        gaps_join(&pigment->gaps, &of->gaps);
        if (of->pigment.kind != PIGMENT_COLOR)
            gaps_add(&pigment->gaps, GAP_PIGMENT_MAP);
        return 1;
    }
    if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl)) {
        *color = sdl_color(sdl);
        return 1;
    }
    return 0;
}

void parse_color_list(Sdl *sdl, Rgbft *list, int n, ParsedPigment *pigment, const ParsedTexture **first, int textures)
{
    for (int i = 0; i < n && list_item(sdl, &list[i], pigment, first, textures); i++)
        sdl_optional_comma(sdl);
}

/* ---- patterns ---- */

static void set_average(Sdl *sdl, ParsedPigment *pigment, const Rgbft *list, int n)
{
    ParsedColorMap *map = sdl_alloc(sdl, sizeof *map);
    map->map.count = 2 * n;
    map->map.entries = sdl_alloc(sdl, 2 * (size_t)n * sizeof(ColorMapEntry));
    for (int i = 0; i < n; i++) {
        map->map.entries[2 * i] = (ColorMapEntry){(double)i / n, list[i]};
        map->map.entries[2 * i + 1] = (ColorMapEntry){(double)(i + 1) / n, list[i]};
    }
    map->next = builder_of(sdl)->maps;
    builder_of(sdl)->maps = map;
    pigment->pigment.map = map->map;
}

/* brick's second colour is the brick; the mortar between is thin. */
static void list_pattern(Sdl *sdl, const struct Pattern *pattern, ParsedPigment *pigment, const ParsedTexture **first,
                         int textures)
{
    Rgbft list[6] = {{0, 0, 1, 0, 0}, {0, 1, 0, 0, 0}, {1, 0, 0, 0, 0},
                     {1, 0, 1, 0, 0}, {1, 1, 0, 0, 0}, {0, 1, 1, 0, 0}};
    parse_color_list(sdl, list, pattern->list, pigment, first, textures);
    if (pattern->gap == GAP_BRICK)
        set_average(sdl, pigment, list + 1, 1);
    else
        set_average(sdl, pigment, list, pattern->list);
}

static void object_pattern(Sdl *sdl, ParsedPigment *pigment, const ParsedTexture **first, int textures)
{
    Rgbft list[2] = {{0, 0, 1, 0, 0}, {0, 1, 0, 0, 0}};
    sdl_expect(sdl, "{");
    if (!accept_ident(sdl, VALUE_OBJECT) && !accept_object(sdl))
        sdl_expected(sdl, "an object");
    sdl_optional_comma(sdl);
    parse_color_list(sdl, list, 2, pigment, first, textures);
    sdl_expect(sdl, "}");
    set_average(sdl, pigment, list, 1);
}

static void slope_arguments(Sdl *sdl)
{
    if (sdl_is(sdl, "{")) {
        sdl_skip_block(sdl);
        return;
    }
    sdl_vector(sdl);
    sdl_optional_comma(sdl);
    for (int i = 0; i < 2 && is_float_start(sdl); i++)
        sdl_float(sdl), sdl_optional_comma(sdl);
}

static void magnet_arguments(Sdl *sdl)
{
    sdl_float(sdl);
    if (sdl_accept(sdl, "julia")) {
        sdl_vector2(sdl);
        sdl_optional_comma(sdl);
    } else
        sdl_expect(sdl, "mandel");
    sdl_float(sdl);
}

static void averaged_pattern(Sdl *sdl, const struct Pattern *pattern, ParsedPigment *pigment,
                             const ParsedTexture **first, int textures)
{
    sdl_next(sdl);
    pigment->pigment.kind = PIGMENT_COLOR;
    pigment->averaged = pattern->args == ARGS_AVERAGE ? AVERAGED_BY_WEIGHT : AVERAGED;
    gaps_add(&pigment->gaps, pattern->gap);
    switch (pattern->args) {
    case ARGS_FLOAT:
        sdl_float(sdl);
        break;
    case ARGS_BLOCK:
        sdl_skip_block(sdl);
        break;
    case ARGS_LIST:
        list_pattern(sdl, pattern, pigment, first, textures);
        break;
    case ARGS_FILE:
        sdl_accept(sdl, "df3"), sdl_string(sdl);
        break;
    case ARGS_JULIA:
        sdl_vector2(sdl), sdl_optional_comma(sdl), sdl_float(sdl);
        break;
    case ARGS_MAGNET:
        magnet_arguments(sdl);
        break;
    case ARGS_SLOPE:
        slope_arguments(sdl);
        break;
    case ARGS_OBJECT:
        object_pattern(sdl, pigment, first, textures);
        break;
    case ARGS_AVERAGE:
    case ARGS_NONE:
        break;
    }
}

int accept_pattern(Sdl *sdl, ParsedPigment *pigment, const ParsedTexture **first, int textures)
{
    Pigment *p = &pigment->pigment;
    if (sdl_accept(sdl, "checker")) {
        p->kind = PIGMENT_CHECKER;
        p->checker[0] = (Rgbft){0, 0, 1, 0, 0};
        p->checker[1] = (Rgbft){0, 1, 0, 0, 0};
        parse_color_list(sdl, p->checker, 2, pigment, first, textures);
    } else if (sdl_accept(sdl, "gradient")) {
        p->kind = PIGMENT_GRADIENT;
        p->gradient = sdl_vector(sdl);
        if (vec_length(p->gradient) == 0)
            sdl_error(sdl, "gradient needs a direction, not the zero vector");
        p->wave = WAVE_RAMP;
    } else if (sdl_accept(sdl, "image_map"))
        parse_image_map(sdl, pigment);
    else {
        const struct Pattern *pattern = find_pattern(sdl);
        if (!pattern)
            return 0;
        averaged_pattern(sdl, pattern, pigment, first, textures);
        return 1;
    }
    pigment->averaged = AVERAGED_NOT;
    return 1;
}

/* ---- what may follow any pattern ---- */

static int accept_wave(Sdl *sdl, Pigment *p)
{
    static const struct {
        const char *word;
        WaveKind wave;
    } waves[] = {
        {"ramp_wave", WAVE_RAMP},       {"triangle_wave", WAVE_TRIANGLE}, {"sine_wave", WAVE_SINE},
        {"scallop_wave", WAVE_SCALLOP}, {"cubic_wave", WAVE_CUBIC},
    };
    for (size_t i = 0; i < sizeof waves / sizeof *waves; i++)
        if (sdl_accept(sdl, waves[i].word)) {
            p->wave = waves[i].wave;
            return 1;
        }
    if (!sdl_accept(sdl, "poly_wave"))
        return 0;
    p->wave = WAVE_POLY;
    p->wave_exponent = optional_float(sdl, 1);
    return 1;
}

/* Modifiers of patterns that are averaged, and of noise: read over. */
static int accept_ignored(Sdl *sdl)
{
    static const char *const floats[] = {"octaves",  "omega",       "lambda",   "agate_turb",      "metric",
                                         "control0", "control1",    "mortar",   "noise_generator", "coords",
                                         "accuracy", "interpolate", "exponent", "blend_mode",      NULL};
    static const char *const expressions[] = {"form", "offset", "brick_size", "size", "altitude", NULL};
    static const char *const pairs[] = {"exterior", "interior", NULL};
    for (int i = 0; floats[i]; i++)
        if (sdl_accept(sdl, floats[i])) {
            sdl_float(sdl);
            return 1;
        }
    for (int i = 0; expressions[i]; i++)
        if (sdl_accept(sdl, expressions[i])) {
            sdl_expression(sdl);
            return 1;
        }
    for (int i = 0; pairs[i]; i++)
        if (sdl_accept(sdl, pairs[i])) {
            sdl_float(sdl);
            sdl_optional_comma(sdl);
            sdl_float(sdl);
            return 1;
        }
    if (sdl_accept(sdl, "solid")) {
        sdl_optional_bool(sdl, 1);
        return 1;
    }
    return 0;
}

int accept_pattern_modifier(Sdl *sdl, ParsedPigment *pigment)
{
    Pigment *p = &pigment->pigment;
    if (sdl_accept(sdl, "frequency"))
        p->frequency = sdl_float(sdl);
    else if (sdl_accept(sdl, "phase"))
        p->phase = sdl_float(sdl);
    else if (sdl_accept(sdl, "turbulence")) {
        Vec3 amount = sdl_vector(sdl);
        pigment->disturbed = amount.x != 0 || amount.y != 0 || amount.z != 0;
    } else if (sdl_accept(sdl, "warp")) {
        pigment->disturbed = 1;
        sdl_skip_block(sdl);
    } else
        return accept_wave(sdl, p) || accept_ignored(sdl);
    return 1;
}
