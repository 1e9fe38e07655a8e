/* From the tree of a function to its program (function/function.h). Registers above arguments and constants are used as
 * a stack: a node's value is left in the lowest register that was free. Calls of small functions are compiled in place;
 * what has no variables is computed here. */
#include <string.h>
#include "sdl/lang/function.h"

enum { INLINE_SIZE = 100, INLINE_DEPTH = 20, INLINE_TOTAL = 5000 };

/* Where a value is. Constants are counted only when the program is complete, so registers get their numbers then. */
typedef enum Place { PLACE_ARGUMENT, PLACE_CONSTANT, PLACE_REGISTER } Place;
typedef struct Operand {
    Place place;
    int index;
} Operand;

typedef struct Emitted {
    FunctionOp op;
    Operand to, a, b;
    int number; /* instead of b: a target, or an index */
} Emitted;

typedef struct Compilation {
    Sdl *sdl;
    Emitted *code;
    int ninstructions, code_capacity;
    double *constants;
    int nconstants, constant_capacity;
    const FunctionProgram **callees;
    int ncallees, callee_capacity;
    FunctionForeign *foreign;
    int nforeign, foreign_capacity;
    int free, nregisters; /* the lowest free register, and how many there are */
    int depth;            /* of functions compiled in place */
} Compilation;

typedef struct Scope {
    Operand variables[MAX_VARIABLES];
} Scope;

static Operand compile(Compilation *c, const Node *node, Scope *scope);

static const Operand nowhere = {PLACE_ARGUMENT, 0};

static int emit(Compilation *c, FunctionOp op, Operand to, Operand a, Operand b)
{
    const int at = c->ninstructions;
    sdl_step(c->sdl, 1);
    c->code = sdl_grow(c->sdl, c->code, at, &c->code_capacity, sizeof *c->code);
    c->code[c->ninstructions++] = (Emitted){op, to, a, b, 0};
    return at;
}

static Operand constant(Compilation *c, double value)
{
    for (int i = c->nconstants - 1; i >= 0 && i >= c->nconstants - 32; i--)
        if (memcmp(&c->constants[i], &value, sizeof value) == 0)
            return (Operand){PLACE_CONSTANT, i};
    c->constants = sdl_grow(c->sdl, c->constants, c->nconstants, &c->constant_capacity, sizeof *c->constants);
    c->constants[c->nconstants] = value;
    return (Operand){PLACE_CONSTANT, c->nconstants++};
}

static Operand reserve(Compilation *c, int count)
{
    const Operand first = {PLACE_REGISTER, c->free};
    c->free += count;
    if (c->free > c->nregisters)
        c->nregisters = c->free;
    return first;
}

/* The value of the node in this register, which is the lowest free one, and taken after. */
static void compile_to(Compilation *c, const Node *node, Scope *scope, Operand to)
{
    c->free = to.index;
    const Operand value = compile(c, node, scope);
    if (value.place != PLACE_REGISTER || value.index != to.index)
        emit(c, FUNCTION_COPY, to, value, nowhere);
    c->free = to.index;
    reserve(c, 1);
}

/* Jumps that are not known yet get their target when it is reached. */
static void land(Compilation *c, int jump)
{
    c->code[jump].number = c->ninstructions;
}

/* ---- nodes ---- */

static Operand apply(Compilation *c, FunctionOp op, Operand a, Operand b, int mark)
{
    c->free = mark;
    if (a.place == PLACE_CONSTANT && b.place == PLACE_CONSTANT)
        return constant(c, function_apply(op, c->constants[a.index], c->constants[b.index]));
    if (op == FUNCTION_POW && b.place == PLACE_CONSTANT && c->constants[b.index] == 2) {
        op = FUNCTION_SQR;
        b = a;
    }
    const Operand to = reserve(c, 1);
    emit(c, op, to, a, b);
    return to;
}

/* select(a, negative, zero or positive[, positive]) */
static Operand compile_select(Compilation *c, const Node *node, Scope *scope)
{
    const Operand to = reserve(c, 1), condition = compile(c, node->args[0], scope);
    const int not_negative = emit(c, FUNCTION_JUMP_NOT_NEGATIVE, nowhere, condition, nowhere);
    int positive = 0, ends[2];
    if (node->count == 4) { /* the condition's register is free while either value is computed: it is tested first */
        ends[0] = ends[1] = 0;
        compile_to(c, node->args[1], scope, to);
        ends[0] = emit(c, FUNCTION_JUMP, nowhere, nowhere, nowhere);
        land(c, not_negative);
        positive = emit(c, FUNCTION_JUMP_POSITIVE, nowhere, condition, nowhere);
        compile_to(c, node->args[2], scope, to);
        ends[1] = emit(c, FUNCTION_JUMP, nowhere, nowhere, nowhere);
        land(c, positive);
        compile_to(c, node->args[3], scope, to);
        land(c, ends[0]);
        land(c, ends[1]);
        return to;
    }
    compile_to(c, node->args[1], scope, to);
    ends[0] = emit(c, FUNCTION_JUMP, nowhere, nowhere, nowhere);
    land(c, not_negative);
    compile_to(c, node->args[2], scope, to);
    land(c, ends[0]);
    return to;
}

static Operand compile_choice(Compilation *c, const Node *node, Scope *scope)
{
    const Operand to = reserve(c, 1), condition = compile(c, node->args[0], scope);
    const int otherwise = emit(c, FUNCTION_JUMP_ZERO, nowhere, condition, nowhere);
    compile_to(c, node->args[1], scope, to);
    const int end = emit(c, FUNCTION_JUMP, nowhere, nowhere, nowhere);
    land(c, otherwise);
    compile_to(c, node->args[2], scope, to);
    land(c, end);
    return to;
}

static Operand compile_apply(Compilation *c, const Node *node, Scope *scope)
{
    const int mark = c->free;
    if (node->id == FUNCTION_SELECT)
        return compile_select(c, node, scope);
    Operand value = compile(c, node->args[0], scope);
    if (node->count == 1 && node->id < FUNCTION_ADD)
        return apply(c, (FunctionOp)node->id, value, value, mark);
    for (int i = 1; i < node->count; i++)
        value = apply(c, (FunctionOp)node->id, value, compile(c, node->args[i], scope), mark);
    return value;
}

/* Sum or product over whole numbers from the first argument's floor to the second. */
static Operand compile_loop(Compilation *c, const Node *node, Scope *scope)
{
    const Operand total = reserve(c, 1), i = reserve(c, 1), last = reserve(c, 1);
    const int mark = c->free;
    compile_to(c, node->args[0], scope, i);
    emit(c, FUNCTION_FLOOR, i, i, i);
    compile_to(c, node->args[1], scope, last);
    emit(c, FUNCTION_COPY, total, constant(c, node->op == OP_SUM ? 0 : 1), nowhere);
    const Operand hidden = scope->variables[node->id], more = reserve(c, 1);
    const int start = emit(c, FUNCTION_LESS_EQUAL, more, i, last);
    const int end = emit(c, FUNCTION_JUMP_ZERO, nowhere, more, nowhere);
    scope->variables[node->id] = i;
    c->free = mark;
    const Operand term = compile(c, node->args[2], scope);
    emit(c, node->op == OP_SUM ? FUNCTION_ADD : FUNCTION_MULTIPLY, total, total, term);
    emit(c, FUNCTION_ADD, i, i, constant(c, 1));
    const int back = emit(c, FUNCTION_JUMP_BACK, nowhere, nowhere, nowhere);
    c->code[back].number = start;
    land(c, end);
    scope->variables[node->id] = hidden;
    c->free = total.index + 1;
    return total;
}

/* ---- calls ---- */

static int can_be_inlined(const Compilation *c, const Function *function)
{
    return function->kind == FUNCTION_KIND_TREE && function->body->size <= INLINE_SIZE && c->depth < INLINE_DEPTH &&
           c->ninstructions < INLINE_TOTAL;
}

static Operand compile_in_place(Compilation *c, const Node *node, Scope *scope)
{
    const int mark = c->free;
    Scope inner;
    for (int i = 0; i < node->count; i++)
        inner.variables[i] = compile(c, node->args[i], scope);
    c->depth++;
    const Operand value = compile(c, node->function->body, &inner);
    c->depth--;
    /* below it are the arguments, which nothing needs any more */
    if (value.place != PLACE_REGISTER || value.index <= mark) {
        c->free = value.place == PLACE_REGISTER && value.index == mark ? mark + 1 : mark;
        return value;
    }
    c->free = mark;
    const Operand to = reserve(c, 1);
    emit(c, FUNCTION_COPY, to, value, nowhere);
    return to;
}

/* What of the results is meant, which are at the front of the free registers. */
static Operand component_of(Compilation *c, const Node *node, Operand results, int count)
{
    const int index = node->component && count > 1 ? component_index(node->component) : 0;
    c->free = results.index + 1;
    if (index > 0)
        emit(c, FUNCTION_COPY, results, (Operand){PLACE_REGISTER, results.index + index}, nowhere);
    if (index < 0) {
        static const double weights[3] = {0.297, 0.589, 0.114};
        for (int i = 0; i < 3; i++) {
            const Operand part = {PLACE_REGISTER, results.index + i};
            emit(c, FUNCTION_MULTIPLY, part, part, constant(c, weights[i]));
            if (i)
                emit(c, FUNCTION_ADD, results, results, part);
        }
    }
    return results;
}

static Operand compile_call(Compilation *c, const Node *node, Scope *scope)
{
    const Function *function = node->function;
    if (function->unsupported && function->kind != FUNCTION_KIND_TREE)
        return constant(c, 0);
    if (can_be_inlined(c, function))
        return compile_in_place(c, node, scope);
    const int nresults = function->kind == FUNCTION_KIND_FOREIGN ? function->foreign.nresults : 1;
    const Operand first = reserve(c, nresults > node->count ? nresults : node->count + !node->count);
    for (int i = 0; i < node->count; i++)
        compile_to(c, node->args[i], scope, (Operand){PLACE_REGISTER, first.index + i});
    int index = function->internal;
    FunctionOp op = index == INTERNAL_NOISE3D ? FUNCTION_NOISE : FUNCTION_INTERNAL;
    if (function->kind == FUNCTION_KIND_TREE) {
        op = FUNCTION_CALL;
        index = c->ncallees;
        c->callees = sdl_grow(c->sdl, c->callees, index, &c->callee_capacity, sizeof *c->callees);
        c->callees[c->ncallees++] = function->program;
    } else if (function->kind == FUNCTION_KIND_FOREIGN) {
        op = FUNCTION_FOREIGN;
        index = c->nforeign;
        c->foreign = sdl_grow(c->sdl, c->foreign, index, &c->foreign_capacity, sizeof *c->foreign);
        c->foreign[c->nforeign++] = function->foreign;
    }
    const int call = emit(c, op, first, first, nowhere);
    c->code[call].number = index;
    return component_of(c, node, first, nresults);
}

static Operand compile(Compilation *c, const Node *node, Scope *scope)
{
    sdl_step(c->sdl, 1);
    switch (node->op) {
    case OP_NUMBER:
        return constant(c, node->number);
    case OP_VARIABLE:
        return scope->variables[node->id];
    case OP_APPLY:
        return compile_apply(c, node, scope);
    case OP_CHOOSE:
        return compile_choice(c, node, scope);
    case OP_SUM:
    case OP_PRODUCT:
        return compile_loop(c, node, scope);
    default:
        return compile_call(c, node, scope);
    }
}

/* ---- the program ---- */

static uint32_t register_of(const Operand *operand, int nargs, int nconstants)
{
    const int before[] = {[PLACE_ARGUMENT] = 0, [PLACE_CONSTANT] = nargs, [PLACE_REGISTER] = nargs + nconstants};
    return (uint32_t)(before[operand->place] + operand->index);
}

static FunctionInstruction instruction(const Emitted *e, int nargs, int nconstants)
{
    const int computes = e->op < FUNCTION_SELECT; /* then b is a register */
    return (FunctionInstruction){(uint32_t)e->op, register_of(&e->to, nargs, nconstants),
                                 register_of(&e->a, nargs, nconstants),
                                 computes ? register_of(&e->b, nargs, nconstants) : (uint32_t)e->number};
}

const FunctionProgram *function_compile(Sdl *sdl, const Node *body, int nargs)
{
    Compilation c = {.sdl = sdl};
    FunctionProgram *program = sdl_alloc(sdl, sizeof *program);
    Scope scope = {{{PLACE_ARGUMENT, 0}}};
    for (int i = 0; i < nargs; i++)
        scope.variables[i] = (Operand){PLACE_ARGUMENT, i};
    emit(&c, FUNCTION_RETURN, nowhere, compile(&c, body, &scope), nowhere);
    FunctionInstruction *code = sdl_alloc(sdl, (size_t)c.ninstructions * sizeof *code);
    for (int i = 0; i < c.ninstructions; i++)
        code[i] = instruction(&c.code[i], nargs, c.nconstants);
    *program = (FunctionProgram){.nargs = nargs,
                                 .nconstants = c.nconstants,
                                 .nregisters = nargs + c.nconstants + c.nregisters,
                                 .ninstructions = c.ninstructions,
                                 .constants = c.constants ? c.constants : sdl_alloc(sdl, sizeof *c.constants),
                                 .code = code,
                                 .callees = c.callees,
                                 .foreign = c.foreign,
                                 .noise_generator = &sdl->scene->noise_generator};
    for (int i = 0; i < c.ncallees; i++)
        if (c.callees[i]->stack > program->stack)
            program->stack = c.callees[i]->stack;
    program->stack += program->nregisters;
    if (program->stack > FUNCTION_STACK_MAX)
        sdl_fail(sdl, RETEX_ELIMIT, "a function of more than %d values at once", FUNCTION_STACK_MAX);
    return program;
}
