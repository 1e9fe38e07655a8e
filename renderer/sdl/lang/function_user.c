/* User functions: `function(a, b) { a*a + f(b) }` is compiled to a tree once and evaluated at each call. Floats and
 * vectors in the body have the values of the time of the declaration. Transforms and splines can be functions too.
 * Pattern and pigment functions are parsed; a call of one is reported as unsupported. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "sdl/lang/internal.h"

enum { MAX_VARIABLES = 64, MAX_HEIGHT = 2000 };

typedef enum Op {
    OP_NUMBER,
    OP_VARIABLE,
    OP_NEGATE,
    OP_NOT,
    OP_BINARY,
    OP_CHOOSE,
    OP_BUILTIN,
    OP_CALL,
    OP_SUM,
    OP_PRODUCT
} Op;

typedef struct Node {
    Op op;
    int id; /* index of the variable, operator character, or id of the built-in function */
    int count;
    int height; /* height of the subtree, with called functions: limits the recursion */
    double number;
    struct Node **args;
    const Function *function;
    const char *component; /* component of a function that returns a vector */
} Node;

typedef enum FunctionKind {
    FUNCTION_TREE,
    FUNCTION_INTERNAL,
    FUNCTION_TRANSFORM,
    FUNCTION_SPLINE,
    FUNCTION_UNSUPPORTED
} FunctionKind;

struct Function {
    FunctionKind kind;
    int nparameters;
    const char *parameters[MAX_PARAMETERS];
    Node *body;
    int internal;
    Transform transform;
    Value spline;
    const char *unsupported; /* keyword of an unsupported function's body */
};

/* Names that are visible in a function's body: parameters, and loop variables of sum and prod. */
typedef struct Compiler {
    Sdl *sdl;
    const char *names[MAX_VARIABLES];
    int count, defaults; /* defaults: 1 if the parameters are x, y, z; then u and v are x and y */
} Compiler;

static Node *parse_full(Compiler *compiler);
static double evaluate(Sdl *sdl, const Node *node, double *variables);

static Node *node_new(Compiler *compiler, Op op, int id, int count)
{
    Node *node = sdl_alloc(compiler->sdl, sizeof *node);
    node->op = op;
    node->id = id;
    node->count = count;
    node->height = 1;
    if (count)
        node->args = sdl_alloc(compiler->sdl, (size_t)count * sizeof *node->args);
    return node;
}

static void set_arg(Compiler *compiler, Node *node, int index, Node *arg)
{
    node->args[index] = arg;
    if (arg->height + 1 > node->height)
        node->height = arg->height + 1;
    if (node->height > MAX_HEIGHT)
        sdl_fail(compiler->sdl, RETEX_ELIMIT, "a function nested more than %d deep", MAX_HEIGHT);
}

static Node *constant(Compiler *compiler, double value)
{
    Node *node = node_new(compiler, OP_NUMBER, 0, 0);
    node->number = value;
    return node;
}

static Node *binary(Compiler *compiler, int op, Node *a, Node *b)
{
    Node *node = node_new(compiler, OP_BINARY, op, 2);
    set_arg(compiler, node, 0, a);
    set_arg(compiler, node, 1, b);
    return node;
}

static int find_variable(const Compiler *compiler, const char *name)
{
    for (int i = compiler->count - 1; i >= 0; i--)
        if (strcmp(compiler->names[i], name) == 0)
            return i;
    if (compiler->defaults && !strcmp(name, "u"))
        return 0;
    if (compiler->defaults && !strcmp(name, "v"))
        return 1;
    return -1;
}

/* Parse `( a, b, … )` as a node's arguments. */
static Node *parse_arguments(Compiler *compiler, Op op, int id)
{
    Node *args[MAX_VARIABLES];
    int count = 0;
    sdl_expect(compiler->sdl, "(");
    if (!sdl_is(compiler->sdl, ")"))
        do {
            if (count == MAX_PARAMETERS)
                sdl_error(compiler->sdl, "more than %d arguments", MAX_PARAMETERS);
            args[count++] = parse_full(compiler);
        } while (sdl_accept(compiler->sdl, ","));
    sdl_expect(compiler->sdl, ")");
    Node *node = node_new(compiler, op, id, count);
    for (int i = 0; i < count; i++)
        set_arg(compiler, node, i, args[i]);
    return node;
}

static const char *component_name(Sdl *sdl)
{
    const Token *token = sdl_next(sdl);
    if (token->kind != TOKEN_WORD)
        sdl_error(sdl, "expected a component such as x or red after the `.`");
    return token->text;
}

static int arguments_wanted(const Function *function)
{
    switch (function->kind) {
    case FUNCTION_TREE:
        return function->nparameters;
    case FUNCTION_INTERNAL:
        return -1;
    case FUNCTION_SPLINE:
        return 1;
    default:
        return function->kind == FUNCTION_TRANSFORM ? 3 : -1;
    }
}

static Node *parse_call(Compiler *compiler, const Function *function)
{
    Sdl *sdl = compiler->sdl;
    Node *node = parse_arguments(compiler, OP_CALL, 0);
    int wanted = arguments_wanted(function);
    if (wanted >= 0 && node->count != wanted)
        sdl_error(sdl, "the function takes %d arguments, %d given", wanted, node->count);
    node->function = function;
    if (function->body && function->body->height + node->height > MAX_HEIGHT)
        sdl_fail(sdl, RETEX_ELIMIT, "a function nested more than %d deep", MAX_HEIGHT);
    if (function->body)
        node->height += function->body->height;
    if (sdl_accept(sdl, "."))
        node->component = component_name(sdl);
    return node;
}

/* Parse the arguments of sum or prod: `(i, from, to, term)`. */
static Node *parse_loop(Compiler *compiler, Op op)
{
    Sdl *sdl = compiler->sdl;
    if (compiler->count == MAX_VARIABLES)
        sdl_error(sdl, "sum and prod nested too deep");
    sdl_expect(sdl, "(");
    const Token *token = sdl_next(sdl);
    if (token->kind != TOKEN_WORD && token->kind != TOKEN_IDENT)
        sdl_error(sdl, "expected the variable of sum or prod");
    const char *name = token->text;
    Node *node = node_new(compiler, op, compiler->count, 3);
    for (int i = 0; i < 3; i++) {
        sdl_expect(sdl, ",");
        if (i == 2)
            compiler->names[compiler->count++] = name;
        set_arg(compiler, node, i, parse_full(compiler));
    }
    compiler->count--;
    sdl_expect(sdl, ")");
    return node;
}

static Node *parse_builtin(Compiler *compiler, const Builtin *builtin)
{
    Sdl *sdl = compiler->sdl;
    if (builtin->kind == BUILTIN_FLOAT) {
        sdl_next(sdl);
        Node *node = parse_arguments(compiler, OP_BUILTIN, builtin->id);
        if (node->count < builtin->min || node->count > builtin->max)
            sdl_error(sdl, "`%s` does not take %d arguments", builtin->name, node->count);
        return node;
    }
    if (builtin->kind == BUILTIN_FORM) {
        sdl_next(sdl);
        return parse_loop(compiler, builtin->id ? OP_PRODUCT : OP_SUM);
    }
    if (builtin->kind == BUILTIN_STRING || builtin->kind == BUILTIN_COLOR)
        sdl_expected(sdl, "a float");
    sdl_next(sdl);
    Num num = builtin->kind == BUILTIN_CONSTANT ? builtin_constant(sdl, builtin->id) : builtin_number(sdl, builtin);
    if (sdl_accept(sdl, "."))
        num_component(sdl, &num, component_name(sdl));
    if (num.count != 1)
        sdl_error(sdl, "`%s` is a vector; a function is made of floats", builtin->name);
    return constant(compiler, num.n[0]);
}

static Node *parse_identifier(Compiler *compiler)
{
    Sdl *sdl = compiler->sdl;
    Value value = *sdl_next(sdl)->value;
    if (value.kind == VALUE_FUNCTION)
        return parse_call(compiler, value.data);
    if (value.kind == VALUE_SPLINE) {
        Function *function = sdl_alloc(sdl, sizeof *function);
        function->kind = FUNCTION_SPLINE;
        function->spline = value;
        return parse_call(compiler, function);
    }
    if (value.kind != VALUE_FLOAT && value.kind != VALUE_VECTOR)
        sdl_error(sdl, "a function is made of floats");
    Num num = {{0}, value.kind == VALUE_FLOAT ? 1 : value.count, 0};
    memcpy(num.n, value.number, sizeof num.n);
    if (sdl_accept(sdl, "."))
        num_component(sdl, &num, component_name(sdl));
    if (num.count != 1)
        sdl_error(sdl, "a function is made of floats, not vectors");
    return constant(compiler, num.n[0]);
}

static Node *parse_primary(Compiler *compiler)
{
    Sdl *sdl = compiler->sdl;
    const Token *token = sdl_peek(sdl);
    if (token->kind == TOKEN_WORD || token->kind == TOKEN_IDENT) {
        int variable = find_variable(compiler, token->text);
        if (variable >= 0) {
            sdl_next(sdl);
            return node_new(compiler, OP_VARIABLE, variable, 0);
        }
    }
    if (token->kind == TOKEN_NUMBER)
        return constant(compiler, sdl_next(sdl)->number);
    if (token->kind == TOKEN_IDENT)
        return parse_identifier(compiler);
    if (token->kind == TOKEN_WORD) {
        const Builtin *builtin = word_intern(sdl, token->text, strlen(token->text))->builtin;
        if (builtin)
            return parse_builtin(compiler, builtin);
    }
    if (sdl_accept(sdl, "(")) {
        Node *node = parse_full(compiler);
        sdl_expect(sdl, ")");
        return node;
    }
    /* A vector literal is allowed only if one of its components is selected. */
    if (sdl_is(sdl, "<")) {
        Num num = expression_sum(sdl);
        if (num.count != 1)
            sdl_error(sdl, "a function is made of floats, not vectors");
        return constant(compiler, num.n[0]);
    }
    sdl_expected(sdl, "a float");
}

static Node *parse_unary(Compiler *compiler)
{
    Sdl *sdl = compiler->sdl;
    if (++sdl->expression_depth > MAX_EXPRESSION_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "expressions nested more than %d deep", MAX_EXPRESSION_DEPTH);
    Node *node;
    if (sdl_accept(sdl, "+"))
        node = parse_unary(compiler);
    else if (sdl_is(sdl, "-") || sdl_is(sdl, "!")) {
        Op op = sdl_next(sdl)->punct == '-' ? OP_NEGATE : OP_NOT;
        node = node_new(compiler, op, 0, 1);
        set_arg(compiler, node, 0, parse_unary(compiler));
    } else
        node = parse_primary(compiler);
    sdl->expression_depth--;
    return node;
}

/* Precedence level. 0: & |, 1: comparisons, 2: + -, 3: * /. */
static int operator_level(const Token *token)
{
    if (token->kind != TOKEN_PUNCT)
        return -1;
    switch (token->punct) {
    case '&':
    case '|':
        return 0;
    case '<':
    case '>':
    case '=':
    case PUNCT_LE:
    case PUNCT_GE:
    case PUNCT_NE:
        return 1;
    case '+':
    case '-':
        return 2;
    case '*':
    case '/':
        return 3;
    default:
        return -1;
    }
}

static Node *parse_level(Compiler *compiler, int level)
{
    if (level == 4)
        return parse_unary(compiler);
    Node *node = parse_level(compiler, level + 1);
    while (operator_level(sdl_peek(compiler->sdl)) == level) {
        int op = sdl_next(compiler->sdl)->punct;
        node = binary(compiler, op, node, parse_level(compiler, level + 1));
    }
    return node;
}

static Node *parse_full(Compiler *compiler)
{
    Sdl *sdl = compiler->sdl;
    if (++sdl->expression_depth > MAX_EXPRESSION_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "expressions nested more than %d deep", MAX_EXPRESSION_DEPTH);
    Node *node = parse_level(compiler, 0);
    if (sdl_accept(sdl, "?")) {
        Node *choice = node_new(compiler, OP_CHOOSE, 0, 3);
        set_arg(compiler, choice, 0, node);
        set_arg(compiler, choice, 1, parse_full(compiler));
        sdl_expect(sdl, ":");
        set_arg(compiler, choice, 2, parse_full(compiler));
        node = choice;
    }
    sdl->expression_depth--;
    return node;
}

/* ---- declaration ---- */

/* The parameter list `(a, b)`. Without a list the parameters are x, y and z. */
static void parse_parameters(Sdl *sdl, Function *function)
{
    static const char *const defaults[] = {"x", "y", "z"};
    if (!sdl_raw_accept(sdl, '(')) {
        function->nparameters = 3;
        for (int i = 0; i < 3; i++)
            function->parameters[i] = word_intern(sdl, defaults[i], 1)->text;
        return;
    }
    while (!sdl_raw_accept(sdl, ')')) {
        const Raw *raw = sdl_raw(sdl);
        if (raw->kind != RAW_WORD)
            sdl_error(sdl, "expected the name of a parameter");
        if (function->nparameters == MAX_PARAMETERS)
            sdl_error(sdl, "more than %d parameters", MAX_PARAMETERS);
        function->parameters[function->nparameters++] = raw->as.word->text;
        sdl_raw_accept(sdl, ',');
    }
}

/* The function of a `transform { … }`, which the builder parses. */
static void parse_transform(Sdl *sdl, Function *function)
{
    Value value = {.kind = VALUE_NONE};
    if (!sdl->builder->declare(sdl, &value) || value.kind != VALUE_TRANSFORM || !value.data)
        sdl_error(sdl, "expected a transform");
    function->kind = FUNCTION_TRANSFORM;
    function->transform = *(const Transform *)value.data;
}

static void parse_spline(Sdl *sdl, Function *function)
{
    sdl_next(sdl);
    function->kind = FUNCTION_SPLINE;
    spline_declare(sdl, &function->spline);
}

static void parse_internal(Sdl *sdl, Function *function)
{
    sdl_next(sdl);
    sdl_expect(sdl, "(");
    double number = expression_parameter(sdl);
    sdl_expect(sdl, ")");
    function->kind = FUNCTION_INTERNAL;
    function->internal = number >= 0 && number < 1000 ? (int)number : -1;
}

static void parse_body(Sdl *sdl, Function *function)
{
    static const char *const foreign[] = {"pattern", "pigment"};
    for (int i = 0; i < 2; i++)
        if (sdl_is(sdl, foreign[i])) {
            sdl_next(sdl);
            sdl_skip_block(sdl);
            function->kind = FUNCTION_UNSUPPORTED;
            function->unsupported = foreign[i];
            return;
        }
    if (sdl_is(sdl, "transform"))
        parse_transform(sdl, function);
    else if (sdl_is(sdl, "spline"))
        parse_spline(sdl, function);
    else if (sdl_is(sdl, "internal"))
        parse_internal(sdl, function);
    else {
        Compiler compiler = {.sdl = sdl, .count = function->nparameters};
        for (int i = 0; i < function->nparameters; i++)
            compiler.names[i] = function->parameters[i];
        compiler.defaults = function->nparameters == 3 && strcmp(function->parameters[0], "x") == 0;
        function->body = parse_full(&compiler);
    }
}

void function_declare(Sdl *sdl, Value *value)
{
    Function *function = sdl_alloc(sdl, sizeof *function);
    /* `function 100, 100 { pattern … }` is an image of this size, for height fields. */
    while (!sdl->have &&
           (sdl->cursor->kind == RAW_NUMBER || (sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == ',')))
        sdl_raw(sdl);
    parse_parameters(sdl, function);
    sdl_expect(sdl, "{");
    const Token *token = sdl_peek(sdl);
    int function_follows = 0;
    if (token->kind == TOKEN_IDENT && token->value->kind == VALUE_FUNCTION)
        function_follows = sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '}';
    if (function_follows) { /* function { f } is the same function as f */
        *function = *(const Function *)sdl_next(sdl)->value->data;
    } else
        parse_body(sdl, function);
    sdl_expect(sdl, "}");
    *value = (Value){.kind = VALUE_FUNCTION, .data = function};
}

/* ---- evaluation ---- */

static Num apply_function(Sdl *sdl, const Function *function, const double *args, int count)
{
    double variables[MAX_VARIABLES] = {0};
    switch (function->kind) {
    case FUNCTION_TREE:
        memcpy(variables, args, (size_t)count * sizeof *args);
        return num_float(evaluate(sdl, function->body, variables));
    case FUNCTION_TRANSFORM: {
        Vec3 p = transform_point(&function->transform, vec3(args[0], args[1], args[2]));
        return (Num){{p.x, p.y, p.z}, 3, 0};
    }
    case FUNCTION_SPLINE:
        return spline_value(sdl, &function->spline, args[0]);
    case FUNCTION_INTERNAL:
        if (internal_arguments(function->internal) > count)
            sdl_error(sdl, "the function needs %d arguments, %d given", internal_arguments(function->internal), count);
        return num_float(internal_call(sdl, function->internal, args, count));
    default: {
        char name[64];
        snprintf(name, sizeof name, "function{%s}", function->unsupported);
        sdl_unsupported(sdl, name, "it gives 0");
        return strcmp(function->unsupported, "pigment") == 0 ? (Num){{0}, 5, 1} : num_float(0);
    }
    }
}

/* Sum or product over integers, from the first argument to the second. */
static double evaluate_loop(Sdl *sdl, const Node *node, double *variables)
{
    double from = evaluate(sdl, node->args[0], variables), to = evaluate(sdl, node->args[1], variables);
    double total = node->op == OP_SUM ? 0 : 1;
    double hidden = variables[node->id];
    for (double i = floor(from); i <= to; i += 1) {
        variables[node->id] = i;
        double value = evaluate(sdl, node->args[2], variables);
        total = node->op == OP_SUM ? total + value : total * value;
    }
    variables[node->id] = hidden;
    return total;
}

static double evaluate_binary(Sdl *sdl, const Node *node, double *variables)
{
    double a = evaluate(sdl, node->args[0], variables), b = evaluate(sdl, node->args[1], variables);
    switch (node->id) {
    case '+':
        return a + b;
    case '-':
        return a - b;
    case '*':
        return a * b;
    case '/':
        return a / b;
    case '<':
        return a < b;
    case '>':
        return a > b;
    case '=':
        return a == b;
    case '&':
        return a != 0 && b != 0;
    case '|':
        return a != 0 || b != 0;
    case PUNCT_LE:
        return a <= b;
    case PUNCT_GE:
        return a >= b;
    default:
        return a != b;
    }
}

static double evaluate_call(Sdl *sdl, const Node *node, double *variables)
{
    double args[MAX_VARIABLES] = {0};
    for (int i = 0; i < node->count; i++)
        args[i] = evaluate(sdl, node->args[i], variables);
    if (node->op == OP_BUILTIN)
        return builtin_float(sdl, node->id, args, node->count);
    Num num = apply_function(sdl, node->function, args, node->count);
    if (node->component)
        num_component(sdl, &num, node->component);
    return num.n[0];
}

static double evaluate(Sdl *sdl, const Node *node, double *variables)
{
    sdl_step(sdl, 1);
    switch (node->op) {
    case OP_NUMBER:
        return node->number;
    case OP_VARIABLE:
        return variables[node->id];
    case OP_NEGATE:
        return -evaluate(sdl, node->args[0], variables);
    case OP_NOT:
        return evaluate(sdl, node->args[0], variables) == 0;
    case OP_BINARY:
        return evaluate_binary(sdl, node, variables);
    case OP_CHOOSE:
        return evaluate(sdl, node->args[evaluate(sdl, node->args[0], variables) != 0 ? 1 : 2], variables);
    case OP_SUM:
    case OP_PRODUCT:
        return evaluate_loop(sdl, node, variables);
    default:
        return evaluate_call(sdl, node, variables);
    }
}

Value sdl_function(Sdl *sdl)
{
    Value value;
    sdl_expect(sdl, "function");
    function_declare(sdl, &value);
    return value;
}

Num function_call(Sdl *sdl, const Value *value)
{
    const Function *function = value->data;
    double args[MAX_PARAMETERS] = {0};
    int count = 0, wanted = arguments_wanted(function);
    sdl_expect(sdl, "(");
    if (!sdl_is(sdl, ")"))
        do {
            if (count == MAX_PARAMETERS)
                sdl_error(sdl, "more than %d arguments", MAX_PARAMETERS);
            args[count++] = expression_parameter(sdl);
        } while (sdl_accept(sdl, ","));
    sdl_expect(sdl, ")");
    if (wanted >= 0 && count != wanted)
        sdl_error(sdl, "the function takes %d arguments, %d given", wanted, count);
    return apply_function(sdl, function, args, count);
}
