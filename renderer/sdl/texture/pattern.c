/* Patterns of pigments and textures: what follows a keyword is read as the pattern's row says. Patterns that are not
 * supported are replaced by their mean colour. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"

/* ---- lists of colours or pigments ---- */

static int list_item(Sdl *sdl, ParsedColorMap *map, int entry)
{
    if (sdl_accept(sdl, "pigment"))
        color_map_set(sdl, map, entry, parse_pigment(sdl, default_pigment(sdl)));
    else if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl))
        map->map.entries[entry].color = sdl_color(sdl);
    else
        return 0;
    return 1;
}

/* Or of textures. */
static void parse_list(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures)
{
    const PatternOps *ops = pigment->pigment.pattern.ops;
    const int n = ops->colors;
    ParsedColorMap *map = color_list_new(sdl, ops);
    if (textures)
        parse_texture_list(sdl, textures, n);
    for (int i = 0; !textures && i < n && list_item(sdl, map, i); i++)
        sdl_optional_comma(sdl);
    pigment_set_map(pigment, map);
}

/* ---- patterns ---- */

/* What stands between the keyword and a list of colours. */
static void pattern_arguments(Sdl *sdl, ParsedPigment *pigment)
{
    Pattern *pattern = &pigment->pigment.pattern;
    switch (pattern->ops->arguments) {
    case ARGUMENTS_FLOAT:
        pattern->number = sdl_float(sdl);
        break;
    case ARGUMENTS_VECTOR:
        pattern->vector = sdl_vector(sdl);
        if (vec_length(pattern->vector) == 0)
            sdl_error(sdl, "%s needs a direction, not the zero vector", pattern->ops->keyword);
        pattern->vector = vec_normalize(pattern->vector);
        break;
    case ARGUMENTS_BLOCK:
        sdl_skip_block(sdl);
        break;
    case ARGUMENTS_NONE:
        break;
    default:
        parse_pattern_data(sdl, pigment);
        break;
    }
}

int accept_pattern_word(Sdl *sdl, ParsedPigment *pigment)
{
    const Token *token = sdl_peek(sdl);
    const int index = token->kind == TOKEN_WORD ? pattern_find(token->text) : -1;
    if (index < 0)
        return 0;
    sdl_next(sdl);
    const PatternOps *ops = pattern_at(index);
    Pigment *p = &pigment->pigment;
    p->kind = PIGMENT_PATTERN;
    p->pattern.ops = ops;
    p->pattern.wave = ops->wave;
    if (!p->pattern.noise_generator)
        p->pattern.noise_generator = &sdl_scene(sdl)->noise_generator;
    p->pattern.number_of_waves = &sdl_scene(sdl)->number_of_waves;
    if (!ops->value)
        gaps_add_pattern(&pigment->gaps, index);
    pigment->averaged = !ops->value;
    pattern_arguments(sdl, pigment);
    return 1;
}

int accept_pattern(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures)
{
    if (accept_pattern_word(sdl, pigment)) {
        const PatternOps *ops = pigment->pigment.pattern.ops;
        if (ops->colors)
            parse_list(sdl, pigment, textures);
        if (ops->arguments == ARGUMENTS_OBJECT)
            sdl_expect(sdl, "}");
        return 1;
    }
    if (sdl_accept(sdl, "average"))
        pigment->pigment.kind = PIGMENT_AVERAGE;
    else if (sdl_accept(sdl, "image_map"))
        parse_image_map(sdl, pigment);
    else
        return 0;
    pigment->averaged = 0;
    return 1;
}

/* ---- what may follow any pattern ---- */

static int accept_wave(Sdl *sdl, Pattern *p)
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
    p->wave_exponent = (float)optional_float(sdl, 1);
    return 1;
}

/* Modifiers of patterns that are averaged, and of noise: read over. */
static int accept_ignored(Sdl *sdl)
{
    static const char *const floats[] = {"coords", "accuracy", "blend_mode", NULL};
    static const char *const expressions[] = {"size", "altitude", NULL};
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
    return 0;
}

/* What only some rows read. */
static int accept_row_modifier(Sdl *sdl, Pattern *p)
{
    if (sdl_accept(sdl, "agate_turb"))
        p->agate_turbulence = (float)sdl_float(sdl);
    else if (sdl_accept(sdl, "control0"))
        p->control[0] = (float)sdl_float(sdl);
    else if (sdl_accept(sdl, "control1"))
        p->control[1] = (float)sdl_float(sdl);
    else if (sdl_accept(sdl, "form"))
        p->crackle.form = sdl_vector(sdl);
    else if (sdl_accept(sdl, "metric"))
        p->crackle.metric = sdl_float(sdl);
    else if (sdl_accept(sdl, "offset"))
        p->crackle.offset = sdl_float(sdl);
    else if (sdl_accept(sdl, "solid"))
        p->crackle.is_solid = sdl_optional_bool(sdl, 1);
    else
        return 0;
    return 1;
}

static int accept_noise_generator(Sdl *sdl, Pattern *p)
{
    if (!sdl_accept(sdl, "noise_generator"))
        return 0;
    const double number = sdl_float(sdl);
    if (!(number >= 1 && number < 4))
        sdl_error(sdl, "noise_generator %g: there are 1, 2 and 3", number);
    int *generator = sdl_alloc(sdl, sizeof *generator);
    *generator = (int)number;
    p->noise_generator = generator;
    return 1;
}

int accept_pattern_modifier(Sdl *sdl, ParsedPigment *pigment)
{
    Pattern *p = &pigment->pigment.pattern;
    if (sdl_accept(sdl, "frequency"))
        p->frequency = (float)sdl_float(sdl); /* as POV-Ray keeps it */
    else if (sdl_accept(sdl, "phase"))
        p->phase = (float)sdl_float(sdl);
    else if (accept_pattern_data_modifier(sdl, p))
        return 1;
    else
        return accept_turbulence(sdl, &p->turbulence) || accept_warp(sdl, &pigment->pigment) || accept_wave(sdl, p) ||
               accept_noise_generator(sdl, p) || accept_row_modifier(sdl, p) || accept_ignored(sdl);
    return 1;
}
