/* Built-in constants and the built-in functions that return numbers. String functions are in function_string.c. User
 * functions are in function_user.c, which calls builtin_float too. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/noise.h"
#include "sdl/lang/internal.h"

enum {
    /* constants */
    ID_X,
    ID_Y,
    ID_Z,
    ID_T,
    ID_U,
    ID_V,
    ID_PI,
    ID_TAU,
    ID_TRUE,
    ID_FALSE,
    ID_CLOCK,
    ID_CLOCK_DELTA,
    ID_CLOCK_ON,
    ID_IMAGE_WIDTH,
    ID_IMAGE_HEIGHT,
    ID_FRAME_NUMBER,
    ID_INITIAL_FRAME,
    ID_FINAL_FRAME,
    ID_INITIAL_CLOCK,
    ID_FINAL_CLOCK,
    ID_NOW,
    ID_VERSION,
    /* functions of floats that return a float */
    ID_ABS,
    ID_ACOS,
    ID_ACOSH,
    ID_ASIN,
    ID_ASINH,
    ID_ATAN,
    ID_ATANH,
    ID_ATAN2,
    ID_CEIL,
    ID_COS,
    ID_COSH,
    ID_DEGREES,
    ID_DIV,
    ID_EXP,
    ID_FLOOR,
    ID_INT,
    ID_LN,
    ID_LOG,
    ID_MAX,
    ID_MIN,
    ID_MOD,
    ID_POW,
    ID_RADIANS,
    ID_SELECT,
    ID_SIN,
    ID_SINH,
    ID_SQR,
    ID_SQRT,
    ID_TAN,
    ID_TANH,
    ID_BITWISE_AND,
    ID_BITWISE_OR,
    ID_BITWISE_XOR,
    /* functions with arguments of other types */
    ID_ASC,
    ID_DEFINED,
    ID_DIMENSIONS,
    ID_DIMENSION_SIZE,
    ID_FILE_EXISTS,
    ID_INSIDE,
    ID_RAND,
    ID_SEED,
    ID_STRCMP,
    ID_STRLEN,
    ID_VAL,
    ID_VDOT,
    ID_VLENGTH,
    ID_VAXIS_ROTATE,
    ID_VCROSS,
    ID_VNORMALIZE,
    ID_VROTATE,
    ID_VTURBULENCE,
    ID_MIN_EXTENT,
    ID_MAX_EXTENT,
    ID_TRACE
};

enum { ANY = 64 };
#define CONSTANT(name, id)                                                                                             \
    {                                                                                                                  \
        name, BUILTIN_CONSTANT, id, 0, 0                                                                               \
    }
#define FLOAT(name, id, min, max)                                                                                      \
    {                                                                                                                  \
        name, BUILTIN_FLOAT, id, min, max                                                                              \
    }
#define NUMBER(name, id)                                                                                               \
    {                                                                                                                  \
        name, BUILTIN_NUMBER, id, 0, 0                                                                                 \
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
    CONSTANT("x", ID_X),
    CONSTANT("y", ID_Y),
    CONSTANT("z", ID_Z),
    CONSTANT("t", ID_T),
    CONSTANT("u", ID_U),
    CONSTANT("v", ID_V),
    CONSTANT("pi", ID_PI),
    CONSTANT("tau", ID_TAU),
    CONSTANT("true", ID_TRUE),
    CONSTANT("yes", ID_TRUE),
    CONSTANT("on", ID_TRUE),
    CONSTANT("false", ID_FALSE),
    CONSTANT("no", ID_FALSE),
    CONSTANT("off", ID_FALSE),
    CONSTANT("clock", ID_CLOCK),
    CONSTANT("clock_delta", ID_CLOCK_DELTA),
    CONSTANT("clock_on", ID_CLOCK_ON),
    CONSTANT("image_width", ID_IMAGE_WIDTH),
    CONSTANT("image_height", ID_IMAGE_HEIGHT),
    CONSTANT("frame_number", ID_FRAME_NUMBER),
    CONSTANT("initial_frame", ID_INITIAL_FRAME),
    CONSTANT("final_frame", ID_FINAL_FRAME),
    CONSTANT("initial_clock", ID_INITIAL_CLOCK),
    CONSTANT("final_clock", ID_FINAL_CLOCK),
    CONSTANT("now", ID_NOW),
    CONSTANT("version", ID_VERSION),
    FLOAT("abs", ID_ABS, 1, 1),
    FLOAT("acos", ID_ACOS, 1, 1),
    FLOAT("acosh", ID_ACOSH, 1, 1),
    FLOAT("asin", ID_ASIN, 1, 1),
    FLOAT("asinh", ID_ASINH, 1, 1),
    FLOAT("atan", ID_ATAN, 1, 1),
    FLOAT("atanh", ID_ATANH, 1, 1),
    FLOAT("atan2", ID_ATAN2, 2, 2),
    FLOAT("ceil", ID_CEIL, 1, 1),
    FLOAT("cos", ID_COS, 1, 1),
    FLOAT("cosh", ID_COSH, 1, 1),
    FLOAT("degrees", ID_DEGREES, 1, 1),
    FLOAT("div", ID_DIV, 2, 2),
    FLOAT("exp", ID_EXP, 1, 1),
    FLOAT("floor", ID_FLOOR, 1, 1),
    FLOAT("int", ID_INT, 1, 1),
    FLOAT("ln", ID_LN, 1, 1),
    FLOAT("log", ID_LOG, 1, 1),
    FLOAT("max", ID_MAX, 1, ANY),
    FLOAT("min", ID_MIN, 1, ANY),
    FLOAT("mod", ID_MOD, 2, 2),
    FLOAT("pow", ID_POW, 2, 2),
    FLOAT("radians", ID_RADIANS, 1, 1),
    FLOAT("select", ID_SELECT, 3, 4),
    FLOAT("sin", ID_SIN, 1, 1),
    FLOAT("sinh", ID_SINH, 1, 1),
    FLOAT("sqr", ID_SQR, 1, 1),
    FLOAT("sqrt", ID_SQRT, 1, 1),
    FLOAT("tan", ID_TAN, 1, 1),
    FLOAT("tanh", ID_TANH, 1, 1),
    FLOAT("bitwise_and", ID_BITWISE_AND, 2, ANY),
    FLOAT("bitwise_or", ID_BITWISE_OR, 2, ANY),
    FLOAT("bitwise_xor", ID_BITWISE_XOR, 2, ANY),
    NUMBER("asc", ID_ASC),
    NUMBER("defined", ID_DEFINED),
    NUMBER("dimensions", ID_DIMENSIONS),
    NUMBER("dimension_size", ID_DIMENSION_SIZE),
    NUMBER("file_exists", ID_FILE_EXISTS),
    NUMBER("inside", ID_INSIDE),
    NUMBER("rand", ID_RAND),
    NUMBER("seed", ID_SEED),
    NUMBER("strcmp", ID_STRCMP),
    NUMBER("strlen", ID_STRLEN),
    NUMBER("val", ID_VAL),
    NUMBER("vdot", ID_VDOT),
    NUMBER("vlength", ID_VLENGTH),
    NUMBER("vaxis_rotate", ID_VAXIS_ROTATE),
    NUMBER("vcross", ID_VCROSS),
    NUMBER("vnormalize", ID_VNORMALIZE),
    NUMBER("vrotate", ID_VROTATE),
    NUMBER("vturbulence", ID_VTURBULENCE),
    NUMBER("min_extent", ID_MIN_EXTENT),
    NUMBER("max_extent", ID_MAX_EXTENT),
    NUMBER("trace", ID_TRACE),
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

Num builtin_constant(Sdl *sdl, int id)
{
    switch (id) {
    case ID_X:
        return unit(0, 3);
    case ID_Y:
        return unit(1, 3);
    case ID_Z:
        return unit(2, 3);
    case ID_T:
        return unit(3, 4);
    case ID_U:
        return unit(0, 2);
    case ID_V:
        return unit(1, 2);
    case ID_PI:
        return num_float(PI);
    case ID_TAU:
        return num_float(2 * PI);
    case ID_TRUE:
        return num_float(1);
    case ID_CLOCK:
        sdl->frame_reads |= READ_CLOCK;
        return num_float(sdl->clock);
    case ID_IMAGE_WIDTH:
        return num_float(sdl->options.width ? sdl->options.width : 640);
    case ID_IMAGE_HEIGHT:
        return num_float(sdl->options.height ? sdl->options.height : 480);
    case ID_FRAME_NUMBER:
        sdl->frame_reads |= READ_FRAME_NUMBER;
        return num_float(sdl->frame_number);
    case ID_INITIAL_FRAME:
        return num_float(sdl->initial_frame);
    case ID_FINAL_FRAME:
        return num_float(sdl->final_frame);
    case ID_INITIAL_CLOCK:
        return num_float(sdl->initial_clock);
    case ID_FINAL_CLOCK:
        return num_float(sdl->final_clock);
    case ID_NOW:
        return num_float(now());
    case ID_VERSION:
        return num_float(sdl->version);
    default:
        return num_float(0); /* false, clock_delta, clock_on: a still image has no animation clock */
    }
}

static double bitwise(int id, const double *args, int count)
{
    int64_t bits = 0;
    for (int i = 0; i < count; i++) {
        int64_t value = fabs(args[i]) < 9e18 ? (int64_t)args[i] : 0;
        if (!i)
            bits = value;
        else
            bits = id == ID_BITWISE_AND ? bits & value : id == ID_BITWISE_OR ? bits | value : bits ^ value;
    }
    return (double)bits;
}

static double extreme(int id, const double *args, int count)
{
    double best = args[0];
    for (int i = 1; i < count; i++)
        best = id == ID_MAX ? fmax(best, args[i]) : fmin(best, args[i]);
    return best;
}

double builtin_float(Sdl *sdl, int id, const double *args, int count)
{
    double a = args[0], b = count > 1 ? args[1] : 0;
    switch (id) {
    case ID_ABS:
        return fabs(a);
    case ID_ACOS:
        return acos(fmin(1, fmax(-1, a)));
    case ID_ACOSH:
        return acosh(a);
    case ID_ASIN:
        return asin(fmin(1, fmax(-1, a)));
    case ID_ASINH:
        return asinh(a);
    case ID_ATAN:
        return atan(a);
    case ID_ATANH:
        return atanh(a);
    case ID_ATAN2:
        return atan2(a, b);
    case ID_CEIL:
        return ceil(a);
    case ID_COS:
        return cos(a);
    case ID_COSH:
        return cosh(a);
    case ID_DEGREES:
        return a * (180 / PI);
    case ID_DIV:
        return trunc(a / b);
    case ID_EXP:
        return exp(a);
    case ID_FLOOR:
        return floor(a);
    case ID_INT:
        return trunc(a);
    case ID_LN:
        if (a <= 0)
            sdl_error(sdl, "ln of %g: only numbers above 0 have a logarithm", a);
        return log(a);
    case ID_LOG:
        if (a <= 0)
            sdl_error(sdl, "log of %g: only numbers above 0 have a logarithm", a);
        return log10(a);
    case ID_MAX:
    case ID_MIN:
        return extreme(id, args, count);
    case ID_MOD:
        return fmod(a, b);
    case ID_POW:
        return pow(a, b);
    case ID_RADIANS:
        return a * (PI / 180);
    case ID_SELECT:
        return a < 0 ? b : a == 0 || count == 3 ? args[2] : args[3];
    case ID_SIN:
        return sin(a);
    case ID_SINH:
        return sinh(a);
    case ID_SQR:
        return a * a;
    case ID_SQRT:
        if (a < 0)
            sdl_error(sdl, "sqrt of %g: a negative number has no square root", a);
        return sqrt(a);
    case ID_TAN:
        return tan(a);
    case ID_TANH:
        return tanh(a);
    default:
        return bitwise(id, args, count);
    }
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
    if (sdl->nseeds == sdl->seeds_capacity) {
        int capacity = sdl->seeds_capacity ? sdl->seeds_capacity * 2 : 16;
        uint32_t *seeds = sdl_alloc(sdl, (size_t)capacity * sizeof *seeds);
        if (sdl->nseeds)
            memcpy(seeds, sdl->seeds, (size_t)sdl->nseeds * sizeof *seeds);
        sdl->seeds = seeds;
        sdl->seeds_capacity = capacity;
    }
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
        sdl_unsupported(sdl, high ? "max_extent" : "min_extent", "of this object it is taken as <0,0,0>");
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
        sdl_unsupported(sdl, "trace", "of this object it hits nothing");
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
    sdl_unsupported(sdl, "POV-Ray's own noise", "noise of the same kind gives other values");
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
        sdl_unsupported(sdl, "inside", "of this object it is taken as 0");
    return inside > 0;
}

static Num call_number(Sdl *sdl, int id)
{
    switch (id) {
    case ID_ASC:
        return num_float((unsigned char)*sdl_string(sdl));
    case ID_DIMENSIONS:
        return num_float(array_argument(sdl)->dimensions);
    case ID_DIMENSION_SIZE:
        return num_float(dimension_size(sdl));
    case ID_FILE_EXISTS:
        return num_float(file_exists(sdl));
    case ID_INSIDE:
        return num_float(is_inside(sdl));
    case ID_RAND:
        return num_float(next_random(sdl, expression_parameter(sdl)));
    case ID_SEED:
        return num_float(seed(sdl, expression_parameter(sdl)));
    case ID_STRCMP:
        return num_float(compare_strings(sdl));
    case ID_STRLEN:
        return num_float((double)strlen(sdl_string(sdl)));
    case ID_VAL:
        return num_float(value_of(sdl));
    case ID_VDOT:
        return num_float(dot(sdl));
    case ID_VLENGTH:
        return num_float(vector_length(sdl));
    case ID_VAXIS_ROTATE:
        return rotation(sdl, 1);
    case ID_VCROSS:
        return num_vector(cross(sdl));
    case ID_VNORMALIZE:
        return num_vector(vec_normalize(vector_argument(sdl, NULL)));
    case ID_VROTATE:
        return rotation(sdl, 0);
    case ID_VTURBULENCE:
        return turbulence(sdl);
    case ID_MIN_EXTENT:
        return extent(sdl, 0);
    case ID_MAX_EXTENT:
        return extent(sdl, 1);
    default:
        return trace(sdl);
    }
}

Num builtin_number(Sdl *sdl, const Builtin *builtin)
{
    if (builtin->kind == BUILTIN_FLOAT)
        return call_float(sdl, builtin);
    if (builtin->id == ID_DEFINED) { /* the argument of defined() may be undeclared, so it is read without evaluation */
        if (!sdl_raw_accept(sdl, '('))
            sdl_expected(sdl, "`(`");
        int is_defined = declare_is_defined(sdl);
        if (!sdl_raw_accept(sdl, ')'))
            sdl_expected(sdl, "`)`");
        return num_float(is_defined);
    }
    sdl_expect(sdl, "(");
    Num result = call_number(sdl, builtin->id);
    sdl_expect(sdl, ")");
    return result;
}
