/* The machine that runs compiled functions, and the operations on numbers by themselves. */
#include <string.h>
#include <retex/host/cpu.h>
#include "base/noise.h"
#include "function/function.h"

double function_apply(FunctionOp op, double a, double b)
{
    switch (op) {
#define X(name, value)                                                                                                 \
    case FUNCTION_##name:                                                                                              \
        return value;
        FUNCTION_UNARY(X)
        FUNCTION_BINARY(X)
#undef X
    default:
        return 0;
    }
}

/* Constants are few: to call memcpy for them costs more than it saves. */
#define PLAIN_LOOPS RETEX_CPU_OPTIONS("no-tree-loop-distribute-patterns")

/* Registers of the program, with those of the functions that it calls behind them. */
PLAIN_LOOPS static double run(const FunctionProgram *restrict program, double *restrict r, long *restrict steps)
{
    const FunctionInstruction *restrict i = program->code;

    for (int k = 0; k < program->nconstants; k++)
        r[program->nargs + k] = program->constants[k];
    *steps -= program->ninstructions;
    for (;; i++) {
        switch (i->op) {
#define X(name, value)                                                                                                 \
    case FUNCTION_##name: {                                                                                            \
        const double a = r[i->a];                                                                                      \
        r[i->to] = value;                                                                                              \
        break;                                                                                                         \
    }
            FUNCTION_UNARY(X)
#undef X
#define X(name, value)                                                                                                 \
    case FUNCTION_##name: {                                                                                            \
        const double a = r[i->a], b = r[i->b];                                                                         \
        r[i->to] = value;                                                                                              \
        break;                                                                                                         \
    }
            FUNCTION_BINARY(X)
#undef X
        case FUNCTION_COPY:
            r[i->to] = r[i->a];
            break;
        case FUNCTION_JUMP:
            i = program->code + i->b - 1;
            break;
        case FUNCTION_JUMP_BACK:
            *steps -= (i - program->code) - (long)i->b + 1;
            if (*steps < 0)
                return NAN;
            i = program->code + i->b - 1;
            break;
        case FUNCTION_JUMP_ZERO:
            if (r[i->a] == 0)
                i = program->code + i->b - 1;
            break;
        case FUNCTION_JUMP_NOT_NEGATIVE:
            if (!(r[i->a] < 0))
                i = program->code + i->b - 1;
            break;
        case FUNCTION_JUMP_POSITIVE:
            if (r[i->a] > 0)
                i = program->code + i->b - 1;
            break;
        case FUNCTION_NOISE:
            r[i->to] = noise_value(vec3(r[i->a], r[i->a + 1], r[i->a + 2]), *program->noise_generator);
            break;
        case FUNCTION_INTERNAL:
            r[i->to] = function_internal((int)i->b, r + i->a, *program->noise_generator);
            break;
        case FUNCTION_CALL: {
            const FunctionProgram *callee = program->callees[i->b];
            double *registers = r + program->nregisters;
            if (*steps < 0)
                return NAN;
            memcpy(registers, r + i->a, (size_t)callee->nargs * sizeof *r);
            r[i->to] = run(callee, registers, steps);
            break;
        }
        case FUNCTION_FOREIGN: {
            double results[FUNCTION_RESULTS_MAX] = {0};
            const FunctionForeign *foreign = &program->foreign[i->b];
            foreign->call(foreign->data, r + i->a, results);
            memcpy(r + i->to, results, (size_t)foreign->nresults * sizeof *r);
            break;
        }
        default:
            return r[i->a];
        }
    }
}

/* Most functions need few registers; those of others take a stack that costs time to touch. */
static double __attribute__((noinline)) run_large(const FunctionProgram *program, const double *args, long *steps)
{
    double registers[FUNCTION_STACK_MAX];

    memcpy(registers, args, (size_t)program->nargs * sizeof *args);
    return run(program, registers, steps);
}

double function_evaluate(const FunctionProgram *program, const double *args, long *steps)
{
    enum { FEW = 128 };
    double registers[FEW];
    long many = 100000000;

    if (!steps)
        steps = &many;
    if (program->stack > FEW)
        return run_large(program, args, steps);
    for (int i = 0; i < program->nargs; i++)
        registers[i] = args[i];
    return run(program, registers, steps);
}
