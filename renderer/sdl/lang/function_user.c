/* User functions: `function(a, b) { a*a + f(b) }` is parsed to a tree, which function_compile.c makes a program of.
 * Floats and vectors in the body have the values of the time of the declaration. Transforms, splines, patterns and
 * pigments can be functions too. */
#include <stdio.h>
#include <string.h>
#include "sdl/lang/function.h"

/* Names that are visible in a function's body: parameters, and loop variables of sum and prod. */
typedef struct Compiler {
    Sdl *sdl;
    Function *function;
    const char *names[MAX_VARIABLES];
    int count, defaults; /* defaults: 1 if the parameters are x, y, z; then u and v are x and y */
} Compiler;

static Node *parse_full(Compiler *compiler);

static Node *node_new(Compiler *compiler, NodeOp op, int id, int count)
{
    Node *node = sdl_alloc(compiler->sdl, sizeof *node);
    node->op = op;
    node->id = id;
    node->count = count;
    node->height = 1;
    node->size = 1;
    if (count)
        node->args = sdl_alloc(compiler->sdl, (size_t)count * sizeof *node->args);
    return node;
}

static void set_arg(Compiler *compiler, Node *node, int index, Node *arg)
{
    node->args[index] = arg;
    node->size += arg->size;
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

static Node *binary(Compiler *compiler, FunctionOp op, Node *a, Node *b)
{
    Node *node = node_new(compiler, OP_APPLY, (int)op, 2);
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
static Node *parse_arguments(Compiler *compiler, NodeOp op, int id)
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

/* How many numbers it gives. */
static int results_of(const Function *function)
{
    return function->kind == FUNCTION_KIND_FOREIGN ? function->foreign.nresults : 1;
}

static int arguments_wanted(const Function *function)
{
    switch (function->kind) {
    case FUNCTION_KIND_TREE:
        return function->nparameters;
    case FUNCTION_KIND_FOREIGN:
        return function->foreign.nargs;
    default:
        return -1;
    }
}

/* The number of arguments is what the function takes. */
static void check_arguments(Sdl *sdl, const Function *function, int given)
{
    const int wanted = arguments_wanted(function);
    if (wanted >= 0 && given != wanted)
        sdl_error(sdl, "the function takes %d arguments, %d given", wanted, given);
    const int least = function->kind == FUNCTION_KIND_INTERNAL ? function_internal_arguments(function->internal) : 0;
    if (given < least)
        sdl_error(sdl, "the function needs %d arguments, %d given", least, given);
}

static Node *parse_call(Compiler *compiler, const Function *function)
{
    Sdl *sdl = compiler->sdl;
    Node *node = parse_arguments(compiler, OP_CALL, 0);
    check_arguments(sdl, function, node->count);
    node->function = function;
    if (function->unsupported && !compiler->function->unsupported)
        compiler->function->unsupported = function->unsupported;
    if (function->body && function->body->height + node->height > MAX_HEIGHT)
        sdl_fail(sdl, RETEX_ELIMIT, "a function nested more than %d deep", MAX_HEIGHT);
    if (function->body)
        node->height += function->body->height;
    if (sdl_accept(sdl, ".")) {
        node->component = component_name(sdl);
        Num any = {{0}, results_of(function), 0}; /* is there such a component? */
        num_component(sdl, &any, node->component);
    }
    return node;
}

/* Parse the arguments of sum or prod: `(i, from, to, term)`. */
static Node *parse_loop(Compiler *compiler, NodeOp op)
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
        Node *node = parse_arguments(compiler, OP_APPLY, builtin->id);
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
        function->kind = FUNCTION_KIND_FOREIGN;
        function->foreign = spline_foreign(&value);
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
        const Builtin *builtin = token->word->builtin;
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
        const FunctionOp op = sdl_next(sdl)->punct == '-' ? FUNCTION_NEGATE : FUNCTION_NOT;
        node = node_new(compiler, OP_APPLY, (int)op, 1);
        set_arg(compiler, node, 0, parse_unary(compiler));
    } else
        node = parse_primary(compiler);
    sdl->expression_depth--;
    return node;
}

static const struct {
    char punct;
    char level; /* of precedence */
    FunctionOp op;
} operators[] = {
    {'&', 0, FUNCTION_AND},
    {'|', 0, FUNCTION_OR},
    {'<', 1, FUNCTION_LESS},
    {'>', 1, FUNCTION_GREATER},
    {'=', 1, FUNCTION_EQUAL},
    {PUNCT_LE, 1, FUNCTION_LESS_EQUAL},
    {PUNCT_GE, 1, FUNCTION_GREATER_EQUAL},
    {PUNCT_NE, 1, FUNCTION_NOT_EQUAL},
    {'+', 2, FUNCTION_ADD},
    {'-', 2, FUNCTION_SUBTRACT},
    {'*', 3, FUNCTION_MULTIPLY},
    {'/', 3, FUNCTION_DIVIDE},
};
enum { LEVELS = 4 };

/* The index of the operator that the token is, or -1. */
static int find_operator(const Token *token)
{
    for (int i = 0; i < (int)(sizeof operators / sizeof *operators) && token->kind == TOKEN_PUNCT; i++)
        if (operators[i].punct == token->punct)
            return i;
    return -1;
}

static Node *parse_level(Compiler *compiler, int level)
{
    if (level == LEVELS)
        return parse_unary(compiler);
    Node *node = parse_level(compiler, level + 1);
    int found;
    while ((found = find_operator(sdl_peek(compiler->sdl))) >= 0 && operators[found].level == level) {
        sdl_next(compiler->sdl);
        node = binary(compiler, operators[found].op, node, parse_level(compiler, level + 1));
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

static void default_parameters(Sdl *sdl, Function *function)
{
    static const char *const defaults[] = {"x", "y", "z"};
    function->nparameters = 3;
    for (int i = 0; i < 3; i++)
        function->parameters[i] = word_intern(sdl, defaults[i], 1)->text;
}

/* The parameter list `(a, b)`. Without a list the parameters are x, y and z. */
static void parse_parameters(Sdl *sdl, Function *function)
{
    if (!sdl_raw_accept(sdl, '(')) {
        default_parameters(sdl, function);
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

static void call_transform(const void *data, const double *args, double *results)
{
    const Vec3 p = transform_point(data, vec3(args[0], args[1], args[2]));
    results[0] = p.x, results[1] = p.y, results[2] = p.z;
}

/* The function of a `transform { … }`, which the builder parses. */
static void parse_transform(Sdl *sdl, Function *function)
{
    Value value = {.kind = VALUE_NONE};
    if (!sdl->builder->declare(sdl, &value) || value.kind != VALUE_TRANSFORM || !value.data)
        sdl_error(sdl, "expected a transform");
    function->kind = FUNCTION_KIND_FOREIGN;
    function->foreign = (FunctionForeign){call_transform, value.data, 3, 3};
}

static void parse_spline(Sdl *sdl, Function *function)
{
    Value value;
    sdl_next(sdl);
    spline_declare(sdl, &value);
    function->kind = FUNCTION_KIND_FOREIGN;
    function->foreign = spline_foreign(&value);
}

static void parse_internal(Sdl *sdl, Function *function)
{
    sdl_next(sdl);
    sdl_expect(sdl, "(");
    double number = expression_parameter(sdl);
    sdl_expect(sdl, ")");
    function->kind = FUNCTION_KIND_INTERNAL;
    function->internal = number >= 0 && number < 1000 ? (int)number : -1;
    if (!function_internal_arguments(function->internal)) {
        char name[32];
        snprintf(name, sizeof name, "internal(%d)", function->internal);
        function->unsupported = word_intern(sdl, name, strlen(name))->text;
    }
}

/* A pattern or pigment as a function, which the builder parses. 1 if it is one. */
static int accept_field(Sdl *sdl, Function *function)
{
    static const char *const words[] = {"pattern", "pigment"};
    for (int i = 0; i < 2; i++)
        if (sdl_accept(sdl, words[i])) {
            function->kind = FUNCTION_KIND_FOREIGN;
            function->foreign = (FunctionForeign){NULL, NULL, 3, i ? 5 : 1};
            if (!sdl->builder->field(sdl, words[i], &function->foreign))
                function->unsupported = i ? "function{pigment}" : "function{pattern}";
            return 1;
        }
    return 0;
}

static void parse_body(Sdl *sdl, Function *function)
{
    if (accept_field(sdl, function))
        return;
    if (sdl_is(sdl, "transform"))
        parse_transform(sdl, function);
    else if (sdl_is(sdl, "spline"))
        parse_spline(sdl, function);
    else if (sdl_is(sdl, "internal"))
        parse_internal(sdl, function);
    else {
        Compiler compiler = {.sdl = sdl, .function = function, .count = function->nparameters};
        for (int i = 0; i < function->nparameters; i++)
            compiler.names[i] = function->parameters[i];
        compiler.defaults = function->nparameters == 3 && strcmp(function->parameters[0], "x") == 0;
        function->body = parse_full(&compiler);
        function->program = function_compile(sdl, function->body, function->nparameters);
    }
}

static void parse_definition(Sdl *sdl, Function *function)
{
    const Token *token = sdl_peek(sdl);
    int function_follows = 0;
    if (token->kind == TOKEN_IDENT && token->value->kind == VALUE_FUNCTION)
        function_follows = sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '}';
    if (function_follows) { /* function { f } is the same function as f */
        *function = *(const Function *)sdl_next(sdl)->value->data;
    } else
        parse_body(sdl, function);
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
    parse_definition(sdl, function);
    sdl_expect(sdl, "}");
    *value = (Value){.kind = VALUE_FUNCTION, .data = function};
}

Value sdl_function_body(Sdl *sdl)
{
    Function *function = sdl_alloc(sdl, sizeof *function);
    default_parameters(sdl, function);
    parse_definition(sdl, function);
    return (Value){.kind = VALUE_FUNCTION, .data = function};
}

/* ---- evaluation ---- */

static Num apply_function(Sdl *sdl, const Function *function, const double *args)
{
    Num num = {{0}, results_of(function), 0};
    num.color = num.count == 5;
    if (function->unsupported)
        sdl_unsupported(sdl, function->unsupported, "it gives 0");
    if (function->kind == FUNCTION_KIND_TREE) {
        const long most = sdl->options.max_steps > 0 ? sdl->options.max_steps : 1;
        long steps = most;
        num.n[0] = function_evaluate(function->program, args, &steps);
        sdl_step(sdl, most - steps);
    } else if (function->kind == FUNCTION_KIND_INTERNAL && !function->unsupported)
        num.n[0] = function_internal(function->internal, args, sdl->scene->noise_generator);
    else if (function->kind == FUNCTION_KIND_FOREIGN && function->foreign.call)
        function->foreign.call(function->foreign.data, args, num.n);
    sdl_step(sdl, 1);
    return num;
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
    int count = 0;
    sdl_expect(sdl, "(");
    if (!sdl_is(sdl, ")"))
        do {
            if (count == MAX_PARAMETERS)
                sdl_error(sdl, "more than %d arguments", MAX_PARAMETERS);
            args[count++] = expression_parameter(sdl);
        } while (sdl_accept(sdl, ","));
    sdl_expect(sdl, ")");
    check_arguments(sdl, function, count);
    return apply_function(sdl, function, args);
}

/* Without a list of parameters, a function of two has them as its first ones. */
static int takes(const Function *function, int nargs)
{
    const int wanted = arguments_wanted(function);
    return nargs == 2 && wanted == 3 ? 3 : nargs;
}

const FunctionProgram *sdl_function_program(Sdl *sdl, const Value *value, int nargs)
{
    const Function *function = value->data;
    if (function->unsupported)
        sdl_unsupported_geometry(sdl, function->unsupported, "it gives 0");
    if (function->kind == FUNCTION_KIND_TREE && function->nparameters == nargs)
        return function->program;
    /* a call of it */
    Compiler compiler = {.sdl = sdl, .count = nargs};
    Node *node = node_new(&compiler, OP_CALL, 0, takes(function, nargs));
    for (int i = 0; i < node->count; i++)
        set_arg(&compiler, node, i, i < nargs ? node_new(&compiler, OP_VARIABLE, i, 0) : constant(&compiler, 0));
    check_arguments(sdl, function, node->count);
    node->function = function;
    return function_compile(sdl, node, nargs);
}
