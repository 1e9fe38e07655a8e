/* Patterns and pigments as functions of a point. Colours are as written, not yet decoded from the working space. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"
#include "shade/pigment.h"

static void call_pattern(const void *data, const double *args, double *results)
{
    const Pigment *pigment = data;
    const PatternPoint point = {.p = transform_inverse_point(&pigment->transform, vec3(args[0], args[1], args[2]))};
    results[0] = pattern_value(&pigment->pattern, &point);
}

static void call_pigment(const void *data, const double *args, double *results)
{
    const Rgbft c = pigment_as_written(data, &(PatternPoint){.p = vec3(args[0], args[1], args[2])});
    results[0] = c.r, results[1] = c.g, results[2] = c.b, results[3] = c.filter, results[4] = c.transmit;
}

/* A copy whose colour is not decoded at the end of the scene. */
static Pigment *as_written(Sdl *sdl, const Pigment *from)
{
    Pigment *pigment = sdl_alloc(sdl, sizeof *pigment);
    *pigment = *from;
    return pigment;
}

int parse_field(Sdl *sdl, const char *word, FunctionForeign *function)
{
    const int is_pigment = strcmp(word, "pigment") == 0;
    const ParsedPigment *parsed = parse_pigment(sdl, default_pigment(sdl));
    const Pigment *pigment = &parsed->pigment;
    if (parsed->gaps.bits || parsed->gaps.patterns)
        return 0;
    if (!is_pigment && pigment->kind != PIGMENT_PATTERN)
        return 0;
    load_pigment_images(sdl, pigment, 1);
    function->call = is_pigment ? call_pigment : call_pattern;
    function->data = as_written(sdl, pigment);
    return 1;
}
