/* Built-in constants and the built-in functions that return numbers. String functions are in function_string.c. User
 * functions are in function_user.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/noise.h"
#include "function/function.h"
#include "sdl/lang/internal.h"

/* Constants by name, and what each is. */
#define CONSTANTS(X)                                                                                                   \
    X(x, unit(0, 3))                                                                                                   \
    X(y, unit(1, 3))                                                                                                   \
    X(z, unit(2, 3))                                                                                                   \
    X(t, unit(3, 4))                                                                                                   \
    X(u, unit(0, 2))                                                                                                   \
    X(v, unit(1, 2))                                                                                                   \
    X(pi, num_float(PI))                                                                                               \
    X(tau, num_float(2 * PI))                                                                                          \
    X(true, num_float(1))                                                                                              \
    X(yes, num_float(1))                                                                                               \
    X(on, num_float(1))                                                                                                \
    X(false, num_float(0))                                                                                             \
    X(no, num_float(0))                                                                                                \
    X(off, num_float(0))                                                                                               \
    X(clock, num_of_frame(sdl, READ_CLOCK, sdl->clock))                                                                \
    X(clock_delta, num_float(sdl->clock_delta))                                                                        \
    X(clock_on, num_float(sdl->clock_on))                                                                              \
    X(image_width, num_float(sdl->options.width ? sdl->options.width : 640))                                           \
    X(image_height, num_float(sdl->options.height ? sdl->options.height : 480))                                        \
    X(frame_number, num_of_frame(sdl, READ_FRAME_NUMBER, sdl->frame_number))                                           \
    X(initial_frame, num_float(sdl->initial_frame))                                                                    \
    X(final_frame, num_float(sdl->final_frame))                                                                        \
    X(initial_clock, num_float(sdl->initial_clock))                                                                    \
    X(final_clock, num_float(sdl->final_clock))                                                                        \
    X(now, num_float(now()))                                                                                           \
    X(version, num_float(sdl->version))
/* The same of functions with arguments of other types than numbers. */
#define NUMBERS(X)                                                                                                     \
    X(asc, num_float((unsigned char)*sdl_string(sdl)))                                                                 \
    X(defined, num_float(declare_is_defined(sdl)))                                                                     \
    X(dimensions, num_float(array_argument(sdl)->dimensions))                                                          \
    X(dimension_size, num_float(dimension_size(sdl)))                                                                  \
    X(file_exists, num_float(file_exists(sdl)))                                                                        \
    X(inside, num_float(is_inside(sdl)))                                                                               \
    X(rand, num_float(next_random(sdl, expression_parameter(sdl))))                                                    \
    X(seed, num_float(seed(sdl, expression_parameter(sdl))))                                                           \
    X(strcmp, num_float(compare_strings(sdl)))                                                                         \
    X(strlen, num_float((double)strlen(sdl_string(sdl))))                                                              \
    X(val, num_float(value_of(sdl)))                                                                                   \
    X(vdot, num_float(dot(sdl)))                                                                                       \
    X(vlength, num_float(vector_length(sdl)))                                                                          \
    X(vaxis_rotate, rotation(sdl, 1))                                                                                  \
    X(vcross, num_vector(cross(sdl)))                                                                                  \
    X(vnormalize, num_vector(vec_normalize(vector_argument(sdl, NULL))))                                               \
    X(vrotate, rotation(sdl, 0))                                                                                       \
    X(vturbulence, turbulence(sdl))                                                                                    \
    X(min_extent, extent(sdl, 0))                                                                                      \
    X(max_extent, extent(sdl, 1))                                                                                      \
    X(trace, trace(sdl))

enum {
#define X(name, value) CONSTANT_##name,
    CONSTANTS(X)
#undef X
#define X(name, value) NUMBER_##name,
    NUMBERS(X)
#undef X
};

enum { ANY = 64 };
#define FLOAT(name, id, min, max)                                                                                      \
    {                                                                                                                  \
        name, BUILTIN_FLOAT, id, min, max                                                                              \
    }
#define COLOR(name)                                                                                                    \
    {                                                                                                                  \
        name, BUILTIN_COLOR, 0, 0, 0                                                                                   \
    }
#define STRING(name)                                                                                                   \
    {                                                                                                                  \
        name, BUILTIN_STRING, 0, 0, 0                                                                                  \
    }

const Builtin builtins[] = {
#define X(name, value) {#name, BUILTIN_CONSTANT, CONSTANT_##name, 0, 0},
    CONSTANTS(X)
#undef X
#define X(name, value) {#name, BUILTIN_NUMBER, NUMBER_##name, 0, 0},
    NUMBERS(X)
#undef X
    FLOAT("abs", FUNCTION_ABS, 1, 1),
    FLOAT("acos", FUNCTION_ACOS, 1, 1),
    FLOAT("acosh", FUNCTION_ACOSH, 1, 1),
    FLOAT("asin", FUNCTION_ASIN, 1, 1),
    FLOAT("asinh", FUNCTION_ASINH, 1, 1),
    FLOAT("atan", FUNCTION_ATAN, 1, 1),
    FLOAT("atanh", FUNCTION_ATANH, 1, 1),
    FLOAT("atan2", FUNCTION_ATAN2, 2, 2),
    FLOAT("ceil", FUNCTION_CEIL, 1, 1),
    FLOAT("cos", FUNCTION_COS, 1, 1),
    FLOAT("cosh", FUNCTION_COSH, 1, 1),
    FLOAT("degrees", FUNCTION_DEGREES, 1, 1),
    FLOAT("div", FUNCTION_DIV, 2, 2),
    FLOAT("exp", FUNCTION_EXP, 1, 1),
    FLOAT("floor", FUNCTION_FLOOR, 1, 1),
    FLOAT("int", FUNCTION_INT, 1, 1),
    FLOAT("ln", FUNCTION_LN, 1, 1),
    FLOAT("log", FUNCTION_LOG, 1, 1),
    FLOAT("max", FUNCTION_MAX, 1, ANY),
    FLOAT("min", FUNCTION_MIN, 1, ANY),
    FLOAT("mod", FUNCTION_MOD, 2, 2),
    FLOAT("pow", FUNCTION_POW, 2, 2),
    FLOAT("radians", FUNCTION_RADIANS, 1, 1),
    FLOAT("select", FUNCTION_SELECT, 3, 4),
    FLOAT("sin", FUNCTION_SIN, 1, 1),
    FLOAT("sinh", FUNCTION_SINH, 1, 1),
    FLOAT("sqr", FUNCTION_SQR, 1, 1),
    FLOAT("sqrt", FUNCTION_SQRT, 1, 1),
    FLOAT("tan", FUNCTION_TAN, 1, 1),
    FLOAT("tanh", FUNCTION_TANH, 1, 1),
    FLOAT("bitwise_and", FUNCTION_BITWISE_AND, 2, ANY),
    FLOAT("bitwise_or", FUNCTION_BITWISE_OR, 2, ANY),
    FLOAT("bitwise_xor", FUNCTION_BITWISE_XOR, 2, ANY),
    COLOR("color"),
    COLOR("colour"),
    COLOR("rgb"),
    COLOR("rgbf"),
    COLOR("rgbt"),
    COLOR("rgbft"),
    COLOR("srgb"),
    COLOR("srgbf"),
    COLOR("srgbt"),
    COLOR("srgbft"),
    STRING("chr"),
    STRING("concat"),
    STRING("datetime"),
    STRING("str"),
    STRING("strlwr"),
    STRING("strupr"),
    STRING("substr"),
    STRING("vstr"),
    STRING("input_file_name"),
    {"sum", BUILTIN_FORM, 0, 4, 4},
    {"prod", BUILTIN_FORM, 1, 4, 4},
};
int builtin_count(void)
{
    return (int)(sizeof builtins / sizeof *builtins);
}

/* The current time in days since the start of 2000. */
static double now(void)
{
    return ((double)time(NULL) - 946684800.0) / 86400;
}

static Num unit(int axis, int count)
{
    Num num = {{0}, count, 0};
    num.n[axis] = 1;
    return num;
}

/* A number that differs from frame to frame: it is noted that the scene reads it. */
static Num num_of_frame(Sdl *sdl, int reads, double value)
{
    sdl->frame_reads |= reads;
    return num_float(value);
}

#define X(name, value)                                                                                                 \
    case CONSTANT_##name:                                                                                              \
        return value;
Num builtin_constant(Sdl *sdl, int id)
{
    switch (id) {
        CONSTANTS(X)
    default:
        return num_float(0);
    }
}
#undef X

static double call_select(const double *args, int count)
{
    return args[0] < 0 ? args[1] : args[0] == 0 || count == 3 ? args[2] : args[3];
}

static double builtin_float(Sdl *sdl, int id /* FunctionOp */, const double *args, int count)
{
    const FunctionOp op = (FunctionOp)id;
    if ((op == FUNCTION_LN || op == FUNCTION_LOG) && args[0] <= 0)
        sdl_error(sdl, "%s of %g: only numbers above 0 have a logarithm", op == FUNCTION_LN ? "ln" : "log", args[0]);
    if (op == FUNCTION_SQRT && args[0] < 0)
        sdl_error(sdl, "sqrt of %g: a negative number has no square root", args[0]);
    if (op == FUNCTION_SELECT)
        return call_select(args, count);
    double value = count == 1 ? function_apply(op, args[0], args[0]) : args[0];
    for (int i = 1; i < count; i++)
        value = function_apply(op, value, args[i]);
    return value;
}

static Num call_float(Sdl *sdl, const Builtin *builtin)
{
    double args[ANY];
    int count = 0;
    sdl_expect(sdl, "(");
    do {
        if (count == builtin->max)
            sdl_error(sdl, "`%s` takes %d arguments at most", builtin->name, builtin->max);
        args[count++] = expression_parameter(sdl);
    } while (sdl_accept(sdl, ","));
    sdl_expect(sdl, ")");
    if (count < builtin->min)
        sdl_error(sdl, "`%s` needs %d arguments, %d given", builtin->name, builtin->min, count);
    return num_float(builtin_float(sdl, builtin->id, args, count));
}

/* ---- arguments of other types ---- */

static Vec3 vector_argument(Sdl *sdl, int *count)
{
    Num num = expression_full(sdl);
    if (count)
        *count = num.count;
    num_promote(&num, 3);
    return vec3(num.n[0], num.n[1], num.n[2]);
}

static Num num_vector(Vec3 v)
{
    return (Num){{v.x, v.y, v.z}, 3, 0};
}

/* POV-Ray's random generator: s = s * 1812433253 + 12345 modulo 2^32. A stream is identified by its index. */
static double seed(Sdl *sdl, double start)
{
    sdl->seeds = sdl_grow(sdl, sdl->seeds, sdl->nseeds, &sdl->seeds_capacity, sizeof *sdl->seeds);
    sdl->seeds[sdl->nseeds] = fabs(start) < 9e18 ? (uint32_t)(int64_t)start : 0;
    return sdl->nseeds++;
}

static double next_random(Sdl *sdl, double stream)
{
    if (!(stream >= 0 && stream < sdl->nseeds))
        sdl_error(sdl, "rand needs a number that seed gave, not %g", stream);
    uint32_t *state = &sdl->seeds[(int)stream];
    *state = *state * 1812433253u + 12345u;
    return *state / 4294967295.0;
}

static const Array *array_argument(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    if (token->kind != TOKEN_IDENT || token->value->kind != VALUE_ARRAY)
        sdl_expected(sdl, "an array");
    return sdl_next(sdl)->value->data;
}

static Value object_argument(Sdl *sdl)
{
    Value value = {.kind = VALUE_NONE};
    if (sdl_peek(sdl)->kind == TOKEN_IDENT)
        value = *sdl_next(sdl)->value;
    else if (!sdl->builder->declare(sdl, &value))
        sdl_expected(sdl, "an object");
    return value;
}

static Num extent(Sdl *sdl, int high)
{
    Value object = object_argument(sdl);
    Vec3 bounds[2] = {{0, 0, 0}, {0, 0, 0}};
    if (!sdl->builder->extent(sdl, &object, &bounds[0], &bounds[1]))
        sdl_unsupported_geometry(sdl, high ? "max_extent" : "min_extent", "of this object it is taken as <0,0,0>");
    return num_vector(bounds[high]);
}

/* trace(object, from, direction[, normal variable]): the nearest intersection, or zeros if there is none. */
static Num trace(Sdl *sdl)
{
    Value object = object_argument(sdl);
    Vec3 point, normal;
    sdl_optional_comma(sdl);
    Vec3 from = vector_argument(sdl, NULL);
    sdl_optional_comma(sdl);
    Vec3 direction = vector_argument(sdl, NULL);
    Value *variable = NULL;
    if (sdl_accept(sdl, ",")) {
        if (sdl_peek(sdl)->kind != TOKEN_IDENT)
            sdl_expected(sdl, "a variable for the normal");
        variable = sdl_next(sdl)->value;
    }
    if (!sdl->builder->trace(sdl, &object, from, direction, &point, &normal))
        sdl_unsupported_geometry(sdl, "trace", "of this object it hits nothing");
    if (variable)
        *variable = value_from_num(num_vector(normal));
    return num_vector(point);
}

static Num rotation(Sdl *sdl, int about_axis)
{
    Vec3 v = vector_argument(sdl, NULL);
    sdl_expect(sdl, ",");
    Vec3 by = vector_argument(sdl, NULL);
    Transform transform;
    if (about_axis) {
        sdl_expect(sdl, ",");
        double degrees = expression_parameter(sdl);
        if (vec_length(by) == 0)
            return num_vector(v);
        transform = transform_axis_rotate(by, degrees);
    } else
        transform = transform_rotate(by);
    return num_vector(transform_vector(&transform, v));
}

static Num turbulence(Sdl *sdl)
{
    double args[3]; /* lambda, omega, octaves */
    for (int i = 0; i < 3; i++) {
        args[i] = expression_parameter(sdl);
        sdl_expect(sdl, ",");
    }
    Vec3 p = vector_argument(sdl, NULL);
    sdl_step(sdl, 10);
    return num_vector(noise_turbulence(p, args[0], args[1], args[2]));
}

static double vector_length(Sdl *sdl)
{
    Num num = expression_full(sdl);
    double sum = 0;
    if (num.count == 1)
        num_promote(&num, 3);
    for (int i = 0; i < num.count; i++)
        sum += num.n[i] * num.n[i];
    return sqrt(sum);
}

static double dimension_size(Sdl *sdl)
{
    const Array *array = array_argument(sdl);
    sdl_expect(sdl, ",");
    double dimension = expression_parameter(sdl);
    if (!(dimension >= 1 && dimension < array->dimensions + 1))
        sdl_error(sdl, "the array has %d dimensions, not %g", array->dimensions, dimension);
    return array->size[(int)dimension - 1];
}

static double compare_strings(Sdl *sdl)
{
    const char *a = sdl_string(sdl);
    sdl_expect(sdl, ",");
    int order = strcmp(a, sdl_string(sdl));
    return (order > 0) - (order < 0);
}

static double value_of(Sdl *sdl)
{
    const char *text = sdl_string(sdl);
    char *end;
    double value = strtod(text, &end);
    return isfinite(value) ? value : 0;
}

static double dot(Sdl *sdl)
{
    Vec3 a = vector_argument(sdl, NULL);
    sdl_expect(sdl, ",");
    return vec_dot(a, vector_argument(sdl, NULL));
}

static Vec3 cross(Sdl *sdl)
{
    Vec3 a = vector_argument(sdl, NULL);
    sdl_expect(sdl, ",");
    return vec_cross(a, vector_argument(sdl, NULL));
}

static double file_exists(Sdl *sdl)
{
    const char *name = sdl_string(sdl);
    return memory_file_find(sdl, name) || sdl_find_file(sdl, name);
}

static double is_inside(Sdl *sdl)
{
    Value object = object_argument(sdl);
    sdl_optional_comma(sdl);
    int inside = sdl->builder->inside(sdl, &object, vector_argument(sdl, NULL));
    if (inside < 0)
        sdl_unsupported_geometry(sdl, "inside", "of this object it is taken as 0");
    return inside > 0;
}

#define X(name, value)                                                                                                 \
    case NUMBER_##name:                                                                                                \
        return value;
static Num call_number(Sdl *sdl, int id)
{
    switch (id) {
        NUMBERS(X)
    default:
        return num_float(0);
    }
}
#undef X

Num builtin_number(Sdl *sdl, const Builtin *builtin)
{
    if (builtin->kind == BUILTIN_FLOAT)
        return call_float(sdl, builtin);
    if (builtin->id == NUMBER_defined)
        return call_number(sdl, builtin->id);
    sdl_expect(sdl, "(");
    Num result = call_number(sdl, builtin->id);
    sdl_expect(sdl, ")");
    return result;
}
