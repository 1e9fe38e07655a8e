/* #declare, #local, #undef and the scopes of names. The scene file, every #include and every macro call has a scope.
 * Names of outer scopes are visible, as in POV-Ray. #declare assigns to the visible symbol of that name, or creates
 * a global symbol. */
#include <string.h>
#include "sdl/lang/internal.h"

/* Symbols of ended scopes are reused, oldest first. The newest ones are kept, because a token may still refer to
 * them. */
enum { UNUSED_KEPT = 512 };

Symbol *symbol_new(Sdl *sdl)
{
    Symbol *symbol;
    if (sdl->nunused > UNUSED_KEPT) {
        symbol = sdl->unused;
        sdl->unused = symbol->next;
        sdl->nunused--;
        memset(symbol, 0, sizeof *symbol);
    } else
        symbol = sdl_alloc(sdl, sizeof *symbol);
    symbol->value = &symbol->own;
    return symbol;
}

void symbol_bind(Sdl *sdl, Symbol *symbol, Word *word, int scope)
{
    symbol->word = word;
    symbol->scope = scope;
    /* A global name may be declared while a local name hides it: the global symbol is inserted below the local one. */
    Symbol **at = &word->symbol;
    while (*at && (*at)->scope > scope)
        at = &(*at)->shadowed;
    symbol->shadowed = *at;
    *at = symbol;
    if (scope > 0) {
        Frame *frame = &sdl->frames[scope - 1];
        symbol->next = frame->locals;
        frame->locals = symbol;
    }
}

Symbol *symbol_add(Sdl *sdl, Word *word, int scope)
{
    Symbol *symbol = symbol_new(sdl);
    symbol_bind(sdl, symbol, word, scope);
    return symbol;
}

static void unlink_word(Symbol *symbol)
{
    Symbol **at = &symbol->word->symbol;
    while (*at && *at != symbol)
        at = &(*at)->shadowed;
    if (*at)
        *at = symbol->shadowed;
}

void symbol_remove(Sdl *sdl, Symbol *symbol)
{
    unlink_word(symbol);
    if (symbol->scope > 0)
        for (Symbol **at = &sdl->frames[symbol->scope - 1].locals; *at; at = &(*at)->next)
            if (*at == symbol) {
                *at = symbol->next;
                break;
            }
}

void scope_close(Sdl *sdl, Frame *frame)
{
    for (Symbol *symbol = frame->locals, *next; symbol; symbol = next) {
        next = symbol->next;
        unlink_word(symbol);
        symbol->next = NULL;
        *sdl->unused_tail = symbol;
        sdl->unused_tail = &symbol->next;
        sdl->nunused++;
    }
    frame->locals = NULL;
}

static int is_definition(const Value *value)
{
    return value->kind != VALUE_NONE;
}

/* The right side of a declaration: an expression, a colour, or an item of the builder (texture, object, …). */
static Value right_side(Sdl *sdl, int *needs_semicolon)
{
    Value value = {.kind = VALUE_NONE};
    *needs_semicolon = 0;
    if (sdl_is(sdl, "array")) {
        sdl_next(sdl);
        array_declare(sdl, &value);
    } else if (sdl_is(sdl, "function")) {
        sdl_next(sdl);
        function_declare(sdl, &value);
    } else if (sdl_is(sdl, "spline")) {
        sdl_next(sdl);
        spline_declare(sdl, &value);
    } else if (sdl_is_expression_start(sdl) || sdl_is_color_start(sdl)) {
        value = sdl_expression(sdl);
        *needs_semicolon = value.kind == VALUE_FLOAT || value.kind == VALUE_VECTOR;
    } else {
        const Token *token = sdl_peek(sdl);
        if (token->kind == TOKEN_IDENT && token->value->kind == VALUE_NONE)
            sdl_error(sdl, "an element of `%s` that has no value yet", token->text);
        if (token->kind == TOKEN_IDENT)
            value = *sdl_next(sdl)->value;
        else if (!sdl->builder->declare(sdl, &value))
            sdl_expected(sdl, "a value");
    }
    if (value.kind == VALUE_ARRAY)
        array_copy(sdl, &value);
    return value;
}

/* The left side of a declaration: the name and, for an array, the element. A new symbol is created only after the
 * right side is parsed, because that side may use an outer symbol of the same name. */
typedef struct Place {
    Word *word;
    int line;
    Value *element;
} Place;

static Place left_side(Sdl *sdl)
{
    const Raw *raw = sdl_raw(sdl);
    if (raw->kind != RAW_WORD)
        sdl_error(sdl, "expected a name to declare");
    if (strcmp(raw->as.word->text, "deprecated") == 0) { /* `deprecated once "why" NAME`: the message is ignored */
        const Raw *next = sdl_raw(sdl);
        if (next->kind == RAW_WORD && strcmp(next->as.word->text, "once") == 0)
            next = sdl_raw(sdl);
        if (next->kind == RAW_STRING)
            next = sdl_raw(sdl);
        if (next->kind != RAW_WORD)
            sdl_error(sdl, "expected a name to declare");
        raw = next;
    }
    Place place = {raw->as.word, (int)raw->line, NULL};
    if (place.word->reserved)
        sdl_error(sdl, "`%s` is a keyword and cannot be declared", place.word->text);
    Symbol *symbol = place.word->symbol;
    if (symbol && symbol->macro)
        sdl_error(sdl, "`%s` is a macro; #undef it first", place.word->text);
    if (sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '[') {
        if (!symbol || symbol->value->kind != VALUE_ARRAY)
            sdl_error(sdl, "`%s` is no array", place.word->text);
        place.element = array_element(sdl, symbol->value);
    }
    return place;
}

void declare_run(Sdl *sdl, int local)
{
    int frame = sdl->nframes, needs_semicolon;
    Place place = left_side(sdl);
    sdl_raw_expect(sdl, '=');
    int outer = place.word->declaring;
    place.word->declaring = place.line;
    sdl->declarations++;
    Value value = right_side(sdl, &needs_semicolon);
    sdl->declarations--;
    place.word->declaring = outer;
    sdl->builder->name(sdl, &value, place.word->text, place.line);
    /* Macros that gave the value end before the semicolon of the declaration. */
    stream_finish_macros(sdl, frame);
    int has_semicolon = sdl_raw_accept(sdl, ';');
    Value *target = place.element;
    if (!target) {
        Symbol *symbol = place.word->symbol;
        /* In the scene file itself, outside macros and includes, #local is global. */
        int scope = frame <= 1 ? 0 : frame;
        if (local && (!symbol || symbol->scope != scope))
            symbol = symbol_add(sdl, place.word, scope);
        else if (!symbol)
            symbol = symbol_add(sdl, place.word, 0);
        symbol->handle = NULL;
        target = symbol->value;
    }
    *target = value;
    if (needs_semicolon && !has_semicolon && sdl->version >= SEMICOLON_VERSION)
        sdl_expected(sdl, "`;` after the value of a declaration");
}

void declare_undef(Sdl *sdl)
{
    const Raw *raw = sdl_raw(sdl);
    if (raw->kind != RAW_WORD || raw->as.word->reserved)
        sdl_error(sdl, "expected a name to undefine");
    Symbol *symbol = raw->as.word->symbol;
    if (!symbol)
        sdl_warn(sdl, "#undef of `%s`, which is not declared", raw->as.word->text);
    else if (sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '[' && symbol->value->kind == VALUE_ARRAY)
        memset(array_element(sdl, symbol->value), 0, sizeof(Value));
    else
        symbol_remove(sdl, symbol);
    sdl_raw_accept(sdl, ';');
}

static int name_is_defined(Sdl *sdl)
{
    const Raw *raw = sdl_raw(sdl);
    if (raw->kind == RAW_END)
        sdl_error(sdl, "expected a name");
    Symbol *symbol = raw->kind == RAW_WORD ? raw->as.word->symbol : NULL;
    int brackets = sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '[';
    if (brackets && symbol && symbol->value->kind == VALUE_ARRAY)
        return is_definition(array_element(sdl, symbol->value));
    if (brackets)
        sdl_error(sdl, "`%s` is no array", raw->kind == RAW_WORD ? raw->as.word->text : "this");
    return symbol && (symbol->macro || symbol->handle || is_definition(symbol->value));
}

int declare_is_defined(Sdl *sdl)
{
    sdl_raw_expect(sdl, '(');
    const int is_defined = name_is_defined(sdl);
    sdl_raw_expect(sdl, ')');
    return is_defined;
}
