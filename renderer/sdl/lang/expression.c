/* Expressions: floats, vectors and colours with POV-Ray's operator precedence. Comparisons, & | and ?: are parsed
 * only in parentheses and conditions. Therefore `<1,2,3> <4,5,6>` are two vectors, and `>` ends a vector. */
#include <math.h>
#include <string.h>
#include "sdl/lang/internal.h"

/* What these read is written through a pointer, not returned: a number has 48 bytes, and to copy it from level to level
 * right after it was written makes the processor wait. */
static void factor(Sdl *sdl, int frame, Num *result);
static void full(Sdl *sdl, Num *result);

Num num_float(double value)
{
    return (Num){{value}, 1, 0};
}

/* Extend to `count` components, as in POV-Ray: a float is copied to all of them, a short vector is padded with
 * zeros. */
void num_promote(Num *num, int count)
{
    if (num->count == 1)
        for (int i = 1; i < count; i++)
            num->n[i] = num->n[0];
    else
        for (int i = num->count; i < count; i++)
            num->n[i] = 0;
    if (num->count < count)
        num->count = count;
}

Value value_from_num(Num num)
{
    Value value = {.kind = num.count == 1 ? VALUE_FLOAT : VALUE_VECTOR, .count = num.count, .is_color = num.color};
    memcpy(value.number, num.n, (size_t)num.count * sizeof *num.n);
    return value;
}

static void num_from_value(const Value *value, Num *num)
{
    num->count = value->kind == VALUE_FLOAT ? 1 : value->count;
    num->color = value->is_color;
    memcpy(num->n, value->number, sizeof num->n);
}

static void put_float(Num *num, double value)
{
    num->n[0] = value;
    num->count = 1;
    num->color = 0;
}

static void enter(Sdl *sdl)
{
    if (++sdl->expression_depth > MAX_EXPRESSION_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "expressions nested more than %d deep", MAX_EXPRESSION_DEPTH);
}

/* The next operator, or 0. A declaration that follows in the same file or macro ends the expression. */
static char operator_next(Sdl *sdl, int frame)
{
    const Token *token = sdl_peek_operator(sdl, frame);
    return token && token->kind == TOKEN_PUNCT ? token->punct : 0;
}

int component_index(const char *name)
{
    static const char *const names[] = {"x", "u", "red", "y", "v", "green", "z", "blue", "t", "filter", "transmit"};
    static const int index[] = {0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 4};
    if (strcmp(name, "gray") == 0)
        return -1;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return index[i];
    return -2;
}

void num_component(Sdl *sdl, Num *num, const char *name)
{
    const int count = num->count, index = component_index(name);
    if (index < -1)
        sdl_error(sdl, "expected a component such as x or red after the `.`, found `%s`", name);
    if (count > 1 && index >= count)
        sdl_error(sdl, "a vector of %d components has no `%s`", count, name);
    num_promote(num, 5);
    *num = num_float(index >= 0 ? num->n[index] : 0.297 * num->n[0] + 0.589 * num->n[1] + 0.114 * num->n[2]);
}

/* Vector literal `< … >` after its `<`: two to five numbers, with optional commas. */
static void vector_literal(Sdl *sdl, Num *vector)
{
    vector->count = vector->color = 0;
    enter(sdl);
    do {
        if (vector->count == 5)
            sdl_error(sdl, "a vector has at most five components");
        vector->n[vector->count++] = sdl_float(sdl);
        sdl_optional_comma(sdl);
    } while (!sdl_is(sdl, ">"));
    sdl_next(sdl);
    sdl->expression_depth--;
    if (vector->count < 2)
        sdl_error(sdl, "a vector has two components at least");
}

static void identifier(Sdl *sdl, Num *result)
{
    /* Copy the value: the token becomes invalid at the next lookahead, and its value may belong to a macro that ends
     * there. */
    const Value *value = sdl_next(sdl)->value;
    if (value->kind == VALUE_FLOAT || value->kind == VALUE_VECTOR)
        num_from_value(value, result);
    else {
        Value callee = *value;
        *result = callee.kind == VALUE_FUNCTION ? function_call(sdl, &callee) : spline_call(sdl, &callee);
    }
}

static void word(Sdl *sdl, Num *result)
{
    const Builtin *builtin = sdl_peek(sdl)->word->builtin;
    if (!builtin)
        sdl_expected(sdl, "a number");
    switch (builtin->kind) {
    case BUILTIN_CONSTANT:
        sdl_next(sdl);
        *result = builtin_constant(sdl, builtin->id);
        break;
    case BUILTIN_FLOAT:
    case BUILTIN_NUMBER:
        sdl_next(sdl);
        *result = builtin_number(sdl, builtin);
        break;
    default:
        sdl_expected(sdl, "a number");
    }
}

static void primary(Sdl *sdl, Num *result)
{
    const Token *token = sdl_peek(sdl);
    switch (token->kind) {
    case TOKEN_NUMBER:
        put_float(result, sdl_next(sdl)->number);
        return;
    case TOKEN_IDENT:
        switch (token->value->kind) {
        case VALUE_FLOAT:
        case VALUE_VECTOR:
        case VALUE_FUNCTION:
        case VALUE_SPLINE:
            identifier(sdl, result);
            return;
        case VALUE_NONE:
            sdl_error(sdl, "`%s` has no value yet", token->text);
        default:
            sdl_expected(sdl, "a number");
        }
    case TOKEN_WORD:
        word(sdl, result);
        return;
    case TOKEN_PUNCT:
        if (token->punct == '<') {
            sdl_next(sdl);
            vector_literal(sdl, result);
            return;
        }
        if (token->punct == '(') {
            sdl_next(sdl);
            full(sdl, result);
            sdl_expect(sdl, ")");
            return;
        }
        /* fallthrough */
    default:
        sdl_expected(sdl, "a number");
    }
}

static void factor(Sdl *sdl, int frame, Num *result)
{
    const Token *token = sdl_peek(sdl);
    enter(sdl);
    char sign = token->kind == TOKEN_PUNCT ? token->punct : 0;
    if (sign == '-' || sign == '+' || sign == '!') {
        sdl_next(sdl);
        factor(sdl, frame, result);
        for (int i = 0; i < result->count; i++)
            result->n[i] = sign == '-' ? -result->n[i] : sign == '!' ? result->n[i] == 0 : result->n[i];
    } else {
        primary(sdl, result);
        while (operator_next(sdl, frame) == '.') {
            sdl_next(sdl);
            const Token *name = sdl_next(sdl);
            if (name->kind != TOKEN_WORD)
                sdl_error(sdl, "expected a component such as x or red after the `.`");
            num_component(sdl, result, name->text);
        }
    }
    sdl->expression_depth--;
}

/* a becomes `a op b`. */
static void apply(Sdl *sdl, char op, Num *a, Num *b)
{
    int count = a->count > b->count ? a->count : b->count;
    num_promote(a, count);
    num_promote(b, count);
    a->color |= b->color;
    for (int i = 0; i < count; i++) {
        if (op == '/' && b->n[i] == 0 && !sdl->warned_division) {
            sdl->warned_division = 1;
            sdl_warn(sdl, "division by zero");
        }
        a->n[i] = op == '+'   ? a->n[i] + b->n[i]
                  : op == '-' ? a->n[i] - b->n[i]
                  : op == '*' ? a->n[i] * b->n[i]
                              : a->n[i] / b->n[i];
    }
}

static void term(Sdl *sdl, int frame, Num *result)
{
    factor(sdl, frame, result);
    for (char op; (op = operator_next(sdl, frame)) == '*' || op == '/';) {
        Num right;
        sdl_next(sdl);
        factor(sdl, frame, &right);
        apply(sdl, op, result, &right);
    }
}

static void sum(Sdl *sdl, Num *result)
{
    int frame = sdl->nframes;
    term(sdl, frame, result);
    for (char op; (op = operator_next(sdl, frame)) == '+' || op == '-';) {
        Num right;
        sdl_next(sdl);
        term(sdl, frame, &right);
        apply(sdl, op, result, &right);
    }
}

Num expression_sum(Sdl *sdl)
{
    Num result;
    sum(sdl, &result);
    return result;
}

static double single(Sdl *sdl, const Num *num)
{
    if (num->count != 1)
        sdl_error(sdl, "expected a float, found a %s", num->color ? "color" : "vector");
    return num->n[0];
}

/* Numbers that differ by less than 1e-10 are equal, as in POV-Ray. */
static int compare(char op, double a, double b)
{
    int equal = fabs(a - b) < 1e-10 || a == b;
    switch (op) {
    case '<':
        return a < b && !equal;
    case '>':
        return a > b && !equal;
    case PUNCT_LE:
        return a <= b || equal;
    case PUNCT_GE:
        return a >= b || equal;
    case '=':
        return equal;
    default:
        return !equal;
    }
}

static int is_comparison(char op)
{
    return op == '<' || op == '>' || op == '=' || op == PUNCT_LE || op == PUNCT_GE || op == PUNCT_NE;
}

/* Comparison of strings: `#if (Name != "")`. */
static void string_comparison(Sdl *sdl, Num *result)
{
    int frame = sdl->nframes;
    const char *left = sdl_string(sdl);
    char op = operator_next(sdl, frame);
    if (!is_comparison(op))
        sdl_expected(sdl, "a comparison with the string");
    sdl_next(sdl);
    put_float(result, compare(op, strcmp(left, sdl_string(sdl)), 0));
}

static void comparison(Sdl *sdl, Num *result)
{
    if (expression_is_string_start(sdl)) {
        string_comparison(sdl, result);
        return;
    }
    int frame = sdl->nframes;
    sum(sdl, result);
    for (char op; is_comparison(op = operator_next(sdl, frame));) {
        Num right;
        sdl_next(sdl);
        sum(sdl, &right);
        put_float(result, compare(op, single(sdl, result), single(sdl, &right)));
    }
}

/* & and | have the same precedence and associate to the left. */
static void logical(Sdl *sdl, Num *result)
{
    int frame = sdl->nframes;
    comparison(sdl, result);
    for (char op; (op = operator_next(sdl, frame)) == '&' || op == '|';) {
        Num right;
        sdl_next(sdl);
        comparison(sdl, &right);
        int a = single(sdl, result) != 0, b = single(sdl, &right) != 0;
        put_float(result, op == '&' ? a && b : a || b);
    }
}

static void full(Sdl *sdl, Num *result)
{
    int frame = sdl->nframes;
    enter(sdl);
    if (sdl_peek(sdl)->kind == TOKEN_WORD && sdl_is_color_start(sdl))
        *result = color_parse(sdl);
    else
        logical(sdl, result);
    if (operator_next(sdl, frame) == '?') {
        Num other;
        sdl_next(sdl);
        int chosen = single(sdl, result) != 0;
        full(sdl, chosen ? result : &other);
        sdl_expect(sdl, ":");
        full(sdl, chosen ? &other : result);
    }
    sdl->expression_depth--;
}

Num expression_full(Sdl *sdl)
{
    Num result;
    full(sdl, &result);
    return result;
}

double expression_parameter(Sdl *sdl)
{
    Num num;
    full(sdl, &num);
    return single(sdl, &num);
}

double expression_condition(Sdl *sdl)
{
    sdl_expect(sdl, "(");
    double value = expression_parameter(sdl);
    sdl_expect(sdl, ")");
    return value;
}

/* ---- functions for the builder ---- */

static int ends_number(const Raw *raw)
{
    return raw->kind == RAW_PUNCT && (raw->punct == ',' || raw->punct == '>' || raw->punct == '}' || raw->punct == ';');
}

/* Fast path for long lists: parse a literal number with an optional sign before `end`, and advance *at past it. */
static int plain_number(const Raw **at, double *value)
{
    const Raw *raw = *at;
    int negative = raw->kind == RAW_PUNCT && raw->punct == '-';
    raw += negative;
    if (raw->kind != RAW_NUMBER)
        return 0;
    *value = negative ? -raw->as.number : raw->as.number;
    *at = raw + 1;
    return 1;
}

double sdl_float(Sdl *sdl)
{
    double value;
    const Raw *at = sdl->cursor;
    if (!sdl->have && plain_number(&at, &value) && ends_number(at)) {
        stream_locate(sdl, sdl->cursor);
        sdl->cursor = at;
        sdl_step(sdl, 1);
        return value;
    }
    Num num;
    sum(sdl, &num);
    return single(sdl, &num);
}

/* Fast path for `<1,2,3>` with literal numbers. Fails if an operator may follow that continues the expression. */
static int plain_vector(Sdl *sdl, int count, double *values)
{
    const Raw *at = sdl->cursor;
    if (sdl->have || at->kind != RAW_PUNCT || at->punct != '<')
        return 0;
    at++;
    for (int i = 0; i < count; i++) {
        if (!plain_number(&at, &values[i]))
            return 0;
        if (at->kind != RAW_PUNCT || at->punct != (i + 1 < count ? ',' : '>'))
            return 0;
        at++;
    }
    if (!(at->kind == RAW_PUNCT && (at->punct == ',' || at->punct == '}' || at->punct == '<')) &&
        at->kind != RAW_NUMBER)
        return 0;
    stream_locate(sdl, sdl->cursor);
    sdl->cursor = at;
    sdl_step(sdl, count);
    return 1;
}

Vec3 sdl_vector(Sdl *sdl)
{
    double v[3];
    if (plain_vector(sdl, 3, v))
        return vec3(v[0], v[1], v[2]);
    Num num;
    sum(sdl, &num);
    if (num.count > 3)
        sdl_error(sdl, "expected a vector of three components, found %s of %d", num.color ? "a color" : "one",
                  num.count);
    num_promote(&num, 3);
    return vec3(num.n[0], num.n[1], num.n[2]);
}

Vec2 sdl_vector2(Sdl *sdl)
{
    double v[2];
    if (plain_vector(sdl, 2, v))
        return (Vec2){v[0], v[1]};
    Num num;
    sum(sdl, &num);
    if (num.count > 2)
        sdl_error(sdl, "expected a vector of two components, found one of %d", num.count);
    num_promote(&num, 2);
    return (Vec2){num.n[0], num.n[1]};
}

int sdl_optional_bool(Sdl *sdl, int missing)
{
    return expression_is_number_start(sdl) ? sdl_float(sdl) != 0 : missing;
}

static const Builtin *builtin_next(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    return token->kind == TOKEN_WORD ? token->word->builtin : NULL;
}

int expression_is_number_start(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    const Builtin *builtin = builtin_next(sdl);
    switch (token->kind) {
    case TOKEN_NUMBER:
        return 1;
    case TOKEN_IDENT:
        return token->value->kind == VALUE_FLOAT || token->value->kind == VALUE_VECTOR ||
               ((token->value->kind == VALUE_FUNCTION || token->value->kind == VALUE_SPLINE) &&
                sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '(');
    case TOKEN_PUNCT:
        return strchr("<(-+!", token->punct) != NULL;
    case TOKEN_WORD:
        return builtin &&
               (builtin->kind == BUILTIN_CONSTANT || builtin->kind == BUILTIN_FLOAT || builtin->kind == BUILTIN_NUMBER);
    default:
        return 0;
    }
}

int expression_is_string_start(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    const Builtin *builtin = builtin_next(sdl);
    return token->kind == TOKEN_STRING || (token->kind == TOKEN_IDENT && token->value->kind == VALUE_STRING) ||
           (builtin && builtin->kind == BUILTIN_STRING);
}

int sdl_is_expression_start(Sdl *sdl)
{
    const Builtin *builtin = builtin_next(sdl);
    return (builtin && builtin->kind == BUILTIN_COLOR) || expression_is_number_start(sdl) ||
           expression_is_string_start(sdl);
}

const char *sdl_string(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    const Builtin *builtin = builtin_next(sdl);
    if (token->kind == TOKEN_STRING)
        return sdl_next(sdl)->text;
    if (token->kind == TOKEN_IDENT && token->value->kind == VALUE_STRING)
        return sdl_next(sdl)->value->string;
    if (!builtin || builtin->kind != BUILTIN_STRING)
        sdl_expected(sdl, "a string");
    sdl_next(sdl);
    enter(sdl);
    const char *result = builtin_string(sdl, builtin);
    sdl_step(sdl, (long)(strlen(result) / 256));
    sdl->expression_depth--;
    return result;
}

Value sdl_expression(Sdl *sdl)
{
    if (expression_is_string_start(sdl))
        return (Value){.kind = VALUE_STRING, .string = sdl_string(sdl)};
    if (sdl_peek(sdl)->kind == TOKEN_WORD && sdl_is_color_start(sdl))
        return value_from_num(color_parse(sdl));
    return value_from_num(expression_sum(sdl));
}
