/* Images that a scene draws itself: `function WIDTH, HEIGHT { … }` in place of a file. A function or a pattern gives
 * grey values, a pigment colours. They are evaluated from (0, 0), for the upper left texel, to (1, 1), for the lower
 * right one: upside down, as in POV-Ray. */
#include "sdl/texture/texture.h"
#include "shade/pigment.h"

enum { SIDE_MAX = 65536, LEVELS = 65535 };

void parse_drawn_image(Sdl *sdl, DrawnImage *image, const char *of, int least, Gaps *gaps)
{
    *image = (DrawnImage){0};
    const double width = floor(sdl_float(sdl));
    sdl_optional_comma(sdl);
    const double height = floor(sdl_float(sdl));
    if (!(width >= least && width <= SIDE_MAX && height >= least && height <= SIDE_MAX))
        sdl_error(sdl, "%s of %g by %g points: there are %d to %d", of, width, height, least, SIDE_MAX);
    image->width = (int)width, image->height = (int)height;
    sdl_expect(sdl, "{");
    if (sdl_accept(sdl, "pigment")) {
        const ParsedPigment *pigment = parse_pigment(sdl, default_pigment(sdl));
        gaps_join(gaps, &pigment->gaps);
        load_pigment_images(sdl, &pigment->pigment, 1);
        image->pigment = &pigment->pigment;
    } else {
        const Value function = sdl_function_body(sdl);
        image->program = sdl_function_program(sdl, &function, 3);
    }
    sdl_expect(sdl, "}");
}

static Vec3 point_of(const DrawnImage *image, int column, int row)
{
    const int w = image->width, h = image->height;
    return vec3(w > 1 ? (double)column / (w - 1) : 0, h > 1 ? (double)row / (h - 1) : 0, 0);
}

double drawn_image_grey(const DrawnImage *image, int column, int row)
{
    const Vec3 p = point_of(image, column, row);
    if (image->program)
        return function_at(image->program, p);
    const Rgbft c = pigment_as_written(image->pigment, &(PatternPoint){.p = p});
    return 0.297 * (double)c.r + 0.589 * (double)c.g + 0.114 * (double)c.b;
}

/* As POV-Ray keeps it, by 16 bits; but not a number becomes 0, and what is too bright white. */
static float level(float value)
{
    return value > 0 ? floorf(fminf(value, 1) * LEVELS) / LEVELS : 0;
}

void drawn_image_texel(const DrawnImage *image, int column, int row, float rgba[4])
{
    if (image->program) {
        rgba[0] = rgba[1] = rgba[2] = level((float)drawn_image_grey(image, column, row));
        rgba[3] = 1;
        return;
    }
    const Rgbft c = pigment_as_written(image->pigment, &(PatternPoint){.p = point_of(image, column, row)});
    rgba[0] = level(c.r), rgba[1] = level(c.g), rgba[2] = level(c.b);
    rgba[3] = level(1 - c.transmit);
}
