/* Functions of numbers, compiled: a program for a machine of registers, which any thread may run. The scene language
 * compiles them (sdl/lang/function_compile.c); shapes and patterns evaluate them while the picture is made. */
#ifndef RENDERER_FUNCTION_FUNCTION_H
#define RENDERER_FUNCTION_FUNCTION_H

#include <math.h>
#include <stdint.h>
#include "base/vec.h"

/* Operations on one number a, or two numbers a and b: what both the machine and the scene language compute. */
#define FUNCTION_UNARY(X)                                                                                              \
    X(NEGATE, -a)                                                                                                      \
    X(NOT, a == 0)                                                                                                     \
    X(ABS, fabs(a))                                                                                                    \
    X(ACOS, acos(fmin(1, fmax(-1, a))))                                                                                \
    X(ACOSH, acosh(a))                                                                                                 \
    X(ASIN, asin(fmin(1, fmax(-1, a))))                                                                                \
    X(ASINH, asinh(a))                                                                                                 \
    X(ATAN, atan(a))                                                                                                   \
    X(ATANH, atanh(a))                                                                                                 \
    X(CEIL, ceil(a))                                                                                                   \
    X(COS, cos(a))                                                                                                     \
    X(COSH, cosh(a))                                                                                                   \
    X(DEGREES, a *(180 / PI))                                                                                          \
    X(EXP, exp(a))                                                                                                     \
    X(FLOOR, floor(a))                                                                                                 \
    X(INT, trunc(a))                                                                                                   \
    X(LN, log(a))                                                                                                      \
    X(LOG, log10(a))                                                                                                   \
    X(RADIANS, a *(PI / 180))                                                                                          \
    X(SIN, sin(a))                                                                                                     \
    X(SINH, sinh(a))                                                                                                   \
    X(SQR, a *a)                                                                                                       \
    X(SQRT, sqrt(a))                                                                                                   \
    X(TAN, tan(a))                                                                                                     \
    X(TANH, tanh(a))
#define FUNCTION_BINARY(X)                                                                                             \
    X(ADD, a + b)                                                                                                      \
    X(SUBTRACT, a - b)                                                                                                 \
    X(MULTIPLY, a *b)                                                                                                  \
    X(DIVIDE, a / b)                                                                                                   \
    X(LESS, a < b)                                                                                                     \
    X(GREATER, a > b)                                                                                                  \
    X(EQUAL, a == b)                                                                                                   \
    X(LESS_EQUAL, a <= b)                                                                                              \
    X(GREATER_EQUAL, a >= b)                                                                                           \
    X(NOT_EQUAL, a != b)                                                                                               \
    X(AND, a != 0 && b != 0)                                                                                           \
    X(OR, a != 0 || b != 0)                                                                                            \
    X(ATAN2, atan2(a, b))                                                                                              \
    X(DIV, trunc(a / b))                                                                                               \
    X(MAX, fmax(a, b))                                                                                                 \
    X(MIN, fmin(a, b))                                                                                                 \
    X(MOD, fmod(a, b))                                                                                                 \
    X(POW, pow(a, b))                                                                                                  \
    X(BITWISE_AND, (double)(function_bits(a) & function_bits(b)))                                                      \
    X(BITWISE_OR, (double)(function_bits(a) | function_bits(b)))                                                       \
    X(BITWISE_XOR, (double)(function_bits(a) ^ function_bits(b)))

typedef enum FunctionOp {
#define X(name, value) FUNCTION_##name,
    FUNCTION_UNARY(X) FUNCTION_BINARY(X)
#undef X
        FUNCTION_SELECT, /* of the language only: compiled to jumps */
    FUNCTION_COPY,       /* to = a */
    FUNCTION_JUMP,       /* to the instruction b */
    FUNCTION_JUMP_BACK,  /* the same; counts steps */
    FUNCTION_JUMP_ZERO,  /* to the instruction b if a is 0 */
    FUNCTION_JUMP_NOT_NEGATIVE,
    FUNCTION_JUMP_POSITIVE,
    FUNCTION_NOISE,    /* to = noise at the three registers from a, of the scene's generator */
    FUNCTION_INTERNAL, /* to = internal function b of the registers from a */
    FUNCTION_CALL,     /* to = callee b of the registers from a */
    FUNCTION_FOREIGN,  /* the registers from `to` = results of foreign function b of the registers from a */
    FUNCTION_RETURN    /* a */
} FunctionOp;

typedef struct FunctionInstruction {
    uint32_t op, to, a, b;
} FunctionInstruction;

/* A function that is no program: of a spline, a transform, a pattern. */
enum { FUNCTION_RESULTS_MAX = 5, FUNCTION_ARGUMENTS_MAX = 56 };
typedef struct FunctionForeign {
    void (*call)(const void *data, const double *args, double *results);
    const void *data;
    int nargs, nresults;
} FunctionForeign;

/* Registers: arguments, constants, then all others. */
typedef struct FunctionProgram {
    int nargs, nconstants, nregisters, ninstructions;
    int stack; /* registers of it and of all that it calls at once */
    const double *constants;
    const FunctionInstruction *code;
    const struct FunctionProgram *const *callees;
    const FunctionForeign *foreign;
    const int *noise_generator; /* the scene's, which may be set after the function */
} FunctionProgram;
enum { FUNCTION_STACK_MAX = 1 << 15 };

/* Its value. steps: how many it may take, from which those taken are subtracted; below 0 afterwards, the value is not a
 * number because there were not enough. NULL: many. */
double function_evaluate(const FunctionProgram *program, const double *args, long *steps);

static inline double function_at(const FunctionProgram *program, Vec3 p)
{
    const double args[3] = {p.x, p.y, p.z};
    return function_evaluate(program, args, 0);
}

static inline int64_t function_bits(double a)
{
    return fabs(a) < 9e18 ? (int64_t)a : 0;
}
double function_apply(FunctionOp op, double a, double b); /* one of the operations on numbers; unary ones take a */

/* internal.c: `internal(N)` of functions.inc. */
enum { INTERNAL_NOISE3D = 76, INTERNAL_COUNT = 79 };
int function_internal_arguments(int number); /* 0: there is none of this number */
double function_internal(int number, const double *args, int noise_generator);

#endif
