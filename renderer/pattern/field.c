/* Patterns whose values are computed outside this room: functions, objects, pigments, images. These may have such
 * patterns again: nesting and steps are limited, and beyond the limit the value is 0. */
#include "pattern/field.h"

enum { DEPTH_MAX = 16 };
#define STEPS_MAX 10000000L

static _Thread_local struct {
    int depth;
    long steps; /* of the outermost pattern */
} nested;

static double field(const Pattern *pattern, const PatternPoint *point)
{
    const PatternField *f = pattern->data;
    double value;

    if (nested.depth == 0)
        nested.steps = STEPS_MAX;
    if (nested.depth == DEPTH_MAX || nested.steps-- <= 0)
        return 0;
    nested.depth++;
    value = f->value(f->data, point, &nested.steps);
    nested.depth--;
    return isfinite(value) ? value : 0;
}

static double function(const Pattern *pattern, const PatternPoint *point)
{
    const double value = field(pattern, point);

    return value > 1 ? fmod(value, 1) : value;
}

const PatternOps pattern_function = {.keyword = "function", .arguments = ARGUMENTS_FUNCTION, .value = function};
const PatternOps pattern_object = {
    .keyword = "object", .arguments = ARGUMENTS_OBJECT, .colors = 2, .map = &pattern_blue_green_red, .value = field};
const PatternOps pattern_pigment_pattern = {
    .keyword = "pigment_pattern", .arguments = ARGUMENTS_PIGMENT, .value = field};
const PatternOps pattern_image_pattern = {.keyword = "image_pattern", .arguments = ARGUMENTS_IMAGE, .value = field};
