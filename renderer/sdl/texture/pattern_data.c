/* Arguments of patterns that need more than a number or a direction: what Pattern.data is. What may follow such a
 * pattern changes a copy, because identifiers share it. */
#include <stdio.h>
#include <string.h>
#include "base/digest.h"
#include "pattern/density_file.h"
#include "pattern/field.h"
#include "pattern/fractal.h"
#include "pattern/pavement.h"
#include "pattern/slope.h"
#include "pattern/tiling.h"
#include "sdl/texture/texture.h"
#include "shape/csg.h"
#include "shade/pigment.h"
#include "shade/pigment_image.h"

static const PatternField *
field_new(Sdl *sdl, double (*value)(const void *data, const PatternPoint *point, long *steps), const void *data)
{
    PatternField *field = sdl_alloc(sdl, sizeof *field);
    *field = (PatternField){value, data};
    return field;
}

/* ---- functions, objects, pigments, images ---- */

static double function_value(const void *data, const PatternPoint *point, long *steps)
{
    const double args[3] = {point->p.x, point->p.y, point->p.z};
    return function_evaluate(data, args, steps);
}

static void parse_function(Sdl *sdl, Pattern *pattern)
{
    sdl_expect(sdl, "{");
    const Value function = sdl_function_body(sdl);
    sdl_expect(sdl, "}");
    pattern->data = field_new(sdl, function_value, sdl_function_program(sdl, &function, 3));
}

static double object_value(const void *data, const PatternPoint *point, long *steps)
{
    (void)steps;
    return csg_inside(((const Csg *)data)->root, point->p);
}

/* `{ OBJECT`; what the list after it is of, and the closing brace, are the caller's. */
static void parse_object_field(Sdl *sdl, Pattern *pattern)
{
    sdl_expect(sdl, "{");
    const Csg *solid = builder_of(sdl)->accept_solid(sdl);
    if (!solid)
        sdl_expected(sdl, "an object");
    sdl_optional_comma(sdl);
    pattern->data = field_new(sdl, object_value, solid);
}

static double grey(Rgbft c)
{
    return 0.297 * (double)c.r + 0.589 * (double)c.g + 0.114 * (double)c.b;
}

static double pigment_grey(const void *data, const PatternPoint *point, long *steps)
{
    (void)steps;
    return grey(pigment_as_written(data, point));
}

/* Of an image_pattern's image: 0 outside of one with `once`. */
static double image_grey(const void *data, const PatternPoint *point, long *steps)
{
    const ImageMap *image = ((const Pigment *)data)->image;
    return image_is_outside(image, pigment_image_uv(image, point->p)) ? 0 : pigment_grey(data, point, steps);
}

/* With `use_alpha`; of an image without alpha POV-Ray takes the red. */
static double image_transmit(const void *data, const PatternPoint *point, long *steps)
{
    const ImageMap *image = ((const Pigment *)data)->image;
    (void)steps;
    if (image_is_outside(image, pigment_image_uv(image, point->p)))
        return 0;
    const Rgbft c = pigment_as_written(data, point);
    return (double)(image->has_alpha ? c.transmit : c.r);
}

/* A copy whose colour is not decoded at the end of the scene. */
static const Pigment *as_written(Sdl *sdl, const ParsedPigment *from)
{
    Pigment *pigment = sdl_alloc(sdl, sizeof *pigment);
    *pigment = from->pigment;
    load_pigment_images(sdl, pigment, 1);
    return pigment;
}

static void parse_pigment_field(Sdl *sdl, ParsedPigment *pigment)
{
    const ParsedPigment *of = parse_pigment(sdl, default_pigment(sdl));
    gaps_join(&pigment->gaps, &of->gaps);
    pigment->parts += of->parts;
    pigment->pigment.pattern.data = field_new(sdl, pigment_grey, as_written(sdl, of));
}

static void parse_image_field(Sdl *sdl, ParsedPigment *pigment)
{
    ParsedPigment *of = pigment_new(sdl, NULL);
    parse_image_map(sdl, of);
    gaps_join(&pigment->gaps, &of->gaps);
    int use_alpha = 0;
    if (of->pigment.kind == PIGMENT_IMAGE) {
        ParsedImage *image = (ParsedImage *)parsed_image(of->pigment.image);
        use_alpha = image->use_alpha;
        image->working = 0;
        if (!image->colorspace[0])
            strcpy(image->colorspace, "linear"); /* the file's numbers are values, not colours */
    }
    pigment->pigment.pattern.data = field_new(sdl, use_alpha ? image_transmit : image_grey, as_written(sdl, of));
}

/* ---- density_file ---- */

static void parse_density_file(Sdl *sdl, Pattern *pattern)
{
    sdl_accept(sdl, "df3");
    const char *name = sdl_string(sdl), *path = sdl_find_file(sdl, name);
    size_t size = 0, n = 1;
    if (!path)
        path = sdl_need_file(sdl, "density_file", name);
    const unsigned char *bytes = (const unsigned char *)sdl_read_file(sdl, path, &size);
    DensityFile *file = sdl_alloc(sdl, sizeof *file);
    for (int axis = 0; size >= 6 && axis < 3; axis++)
        n *= (size_t)(file->size[axis] = 256 * bytes[2 * axis] + bytes[2 * axis + 1]);
    if (size >= 6 && n > 0)
        file->bytes = (size - 6) / n >= 4 ? 4 : (int)((size - 6) / n);
    if (file->bytes == 3)
        file->bytes = 2;
    if (file->bytes == 0)
        sdl_error(sdl, "`%s` is no density file: it ends early", path);
    file->values = bytes + 6;
    Scene *scene = sdl_scene(sdl);
    scene->digest = digest_bytes(scene->digest, bytes, size);
    pattern->data = file;
    pattern->number = 0;
}

/* ---- slope ---- */

static void slope_range(Sdl *sdl, int braces, double *low, double *high)
{
    const int comma = sdl_is(sdl, ",");
    sdl_optional_comma(sdl);
    if (!is_float_start(sdl) || (!comma && !braces)) /* a normal's size may follow */
        return;
    *low = sdl_float(sdl);
    sdl_optional_comma(sdl);
    *high = sdl_float(sdl);
    if (*low == *high)
        sdl_error(sdl, "a slope from %g to %g", *low, *high);
}

static void parse_slope(Sdl *sdl, Pattern *pattern)
{
    Slope *slope = sdl_alloc(sdl, sizeof *slope);
    const int braces = sdl_accept(sdl, "{");
    *slope = (Slope){.high = 1, .altitude_high = 1};
    const Vec3 direction = sdl_vector(sdl);
    const double length = vec_length(direction);
    if (length == 0)
        sdl_error(sdl, "slope needs a direction, not the zero vector");
    pattern->vector = vec_normalize(direction);
    slope_range(sdl, braces, &slope->low, &slope->high);
    if (braces && sdl_accept(sdl, "altitude")) {
        const Vec3 altitude = sdl_vector(sdl);
        const double height = vec_length(altitude);
        slope->altitude = height > 0 ? vec_normalize(altitude) : altitude;
        slope->altitude_weight = height / (height + length);
        slope_range(sdl, braces, &slope->altitude_low, &slope->altitude_high);
    }
    if (braces)
        sdl_expect(sdl, "}");
    pattern->data = slope;
}

/* ---- fractals ---- */

static void parse_constant(Sdl *sdl, Fractal *fractal)
{
    const Vec2 c = sdl_vector2(sdl);
    sdl_optional_comma(sdl);
    fractal->is_julia = 1;
    fractal->constant[0] = c.u, fractal->constant[1] = c.v;
}

static void parse_fractal(Sdl *sdl, Pattern *pattern)
{
    const char *word = pattern->ops->keyword;
    Fractal *fractal = sdl_alloc(sdl, sizeof *fractal);
    *fractal = (Fractal){.exponent = 2, .exterior = 1, .exterior_factor = 1, .interior_factor = 1};
    if (strcmp(word, "magnet") == 0) {
        const double formula = sdl_float(sdl);
        if (formula != 1 && formula != 2)
            sdl_error(sdl, "magnet %g: there are 1 and 2", formula);
        fractal->magnet = (int)formula;
        if (sdl_accept(sdl, "julia"))
            parse_constant(sdl, fractal);
        else
            sdl_expect(sdl, "mandel");
    } else if (strcmp(word, "julia") == 0)
        parse_constant(sdl, fractal);
    fractal->iterations = floor(sdl_float(sdl));
    if (!(fractal->iterations >= 1 && fractal->iterations <= 1e6))
        sdl_error(sdl, "%s needs from 1 to 1000000 iterations", word);
    pattern->data = fractal;
}

static int accept_fractal_modifier(Sdl *sdl, Pattern *pattern)
{
    Fractal *fractal = sdl_alloc(sdl, sizeof *fractal);
    *fractal = *(const Fractal *)pattern->data;
    if (sdl_accept(sdl, "exponent")) {
        const double exponent = sdl_float(sdl);
        if (!(exponent >= 2 && exponent <= FRACTAL_EXPONENT_MAX))
            sdl_error(sdl, "an exponent of %g: it is from 2 to %d", exponent, FRACTAL_EXPONENT_MAX);
        fractal->exponent = (int)exponent;
    } else {
        const int outside = sdl_accept(sdl, "exterior");
        if (!outside && !sdl_accept(sdl, "interior"))
            return 0;
        const double type = sdl_float(sdl);
        sdl_optional_comma(sdl);
        *(outside ? &fractal->exterior_factor : &fractal->interior_factor) = sdl_float(sdl);
        if (!(type >= 0 && type < FRACTAL_TYPE_MAX + 1))
            sdl_error(sdl, "colouring type %g: there are 0 to %d", type, FRACTAL_TYPE_MAX);
        *(outside ? &fractal->exterior : &fractal->interior) = (int)type;
    }
    pattern->data = fractal;
    return 1;
}

/* ---- tiling ---- */

static void parse_tiling(Sdl *sdl, Pattern *pattern)
{
    const double number = floor(sdl_float(sdl));
    if (!(number >= 1 && number <= TILING_RHOMBS))
        sdl_error(sdl, "tiling %g: there are 1 to %d", number, TILING_RHOMBS);
    pattern->number = number;
}

/* ---- pavement ---- */

static int accept_pavement_number(Sdl *sdl, Pavement *pavement)
{
    const struct {
        const char *word;
        int *number, low, high;
    } numbers[] = {
        {"number_of_sides", &pavement->sides, 3, 6}, {"number_of_tiles", &pavement->tiles, 1, PAVEMENT_POLYGONS},
        {"pattern", &pavement->pattern, 1, 35},      {"exterior", &pavement->exterior, 0, 2},
        {"interior", &pavement->interior, 0, 2},     {"form", &pavement->form, 0, 3},
    };
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (sdl_accept(sdl, numbers[k].word)) {
            const double value = floor(sdl_float(sdl));
            if (!(value >= numbers[k].low && value <= numbers[k].high))
                sdl_error(sdl, "%s %g of a pavement: it goes from %d to %d", numbers[k].word, value, numbers[k].low,
                          numbers[k].high);
            *numbers[k].number = (int)value;
            return 1;
        }
    return 0;
}

static void parse_pavement(Sdl *sdl, Pattern *pattern)
{
    Pavement *pavement = sdl_alloc(sdl, sizeof *pavement);
    *pavement = (Pavement){.sides = 3, .tiles = 1, .pattern = 1};
    while (accept_pavement_number(sdl, pavement))
        ;
    pattern->data = pavement;
    if (pavement->sides == 5)
        sdl_error(sdl, "number_of_sides 5 of a pavement: it is 3, 4 or 6");
    const int count = pavement_count(pavement->sides, pavement->tiles);
    if (pavement->pattern > count)
        sdl_error(sdl, "pattern %d of a pavement of %d polygons of %d sides: it has %d", pavement->pattern,
                  pavement->tiles, pavement->sides, count);
}

/* ---- brick ---- */

static int accept_brick_modifier(Sdl *sdl, Pattern *pattern)
{
    if (sdl_accept(sdl, "mortar")) {
        pattern->number = sdl_float(sdl);
        return 1;
    }
    if (!sdl_accept(sdl, "brick_size"))
        return 0;
    pattern->vector = sdl_vector(sdl);
    if (pattern->vector.x == 0 || pattern->vector.y == 0 || pattern->vector.z == 0)
        sdl_error(sdl, "a brick without an extent");
    return 1;
}

/* ---- */

void parse_pattern_data(Sdl *sdl, ParsedPigment *pigment)
{
    Pattern *pattern = &pigment->pigment.pattern;
    switch (pattern->ops->arguments) {
    case ARGUMENTS_FUNCTION:
        parse_function(sdl, pattern);
        break;
    case ARGUMENTS_OBJECT:
        parse_object_field(sdl, pattern);
        break;
    case ARGUMENTS_PIGMENT:
        parse_pigment_field(sdl, pigment);
        break;
    case ARGUMENTS_IMAGE:
        parse_image_field(sdl, pigment);
        break;
    case ARGUMENTS_DENSITY_FILE:
        parse_density_file(sdl, pattern);
        break;
    case ARGUMENTS_SLOPE:
        parse_slope(sdl, pattern);
        break;
    case ARGUMENTS_FRACTAL:
        parse_fractal(sdl, pattern);
        break;
    case ARGUMENTS_PAVEMENT:
        parse_pavement(sdl, pattern);
        break;
    case ARGUMENTS_TILING:
        parse_tiling(sdl, pattern);
        break;
    case ARGUMENTS_BRICK: /* POV-Ray's */
        pattern->vector = vec3(8, 3, 4.5);
        pattern->number = 0.5;
        break;
    default:
        break;
    }
}

int accept_pattern_data_modifier(Sdl *sdl, Pattern *pattern)
{
    switch (pattern->ops ? pattern->ops->arguments : ARGUMENTS_NONE) {
    case ARGUMENTS_FRACTAL:
        return accept_fractal_modifier(sdl, pattern);
    case ARGUMENTS_BRICK:
        return accept_brick_modifier(sdl, pattern);
    case ARGUMENTS_DENSITY_FILE:
        if (!sdl_accept(sdl, "interpolate"))
            return 0;
        pattern->number = fmin(2, fmax(0, floor(sdl_float(sdl))));
        return 1;
    default:
        return 0;
    }
}
