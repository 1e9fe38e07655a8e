/* Macros. A definition stores the position of the macro's body. A call creates a scope with the parameters and
 * continues at the body. An identifier as argument is passed by reference, any other argument by value. */
#include <string.h>
#include "sdl/lang/internal.h"

static int raw_is(const Raw *raw, char punct)
{
    return raw->kind == RAW_PUNCT && raw->punct == punct;
}

void macro_define(Sdl *sdl, const Raw *opener)
{
    Frame *frame = &sdl->frames[sdl->nframes - 1];
    if (opener->as.directive.link == LINK_NONE)
        sdl_error(sdl, "#macro without its #end");
    const Raw *name = sdl_raw(sdl);
    if (name->kind != RAW_WORD)
        sdl_error(sdl, "expected the name of the macro");
    Word *word = name->as.word;
    if (word->reserved)
        sdl_error(sdl, "`%s` is a keyword and cannot be a macro", word->text);
    if (!raw_is(sdl_raw(sdl), '('))
        sdl_error(sdl, "expected `(` after the name of the macro");
    Macro *macro = sdl_alloc(sdl, sizeof *macro);
    Word *parameters[MAX_PARAMETERS];
    while (!raw_is(sdl_raw_peek(sdl), ')')) {
        const Raw *raw = sdl_raw(sdl);
        if (raw->kind != RAW_WORD || raw->as.word->reserved)
            sdl_error(sdl, "expected the name of a parameter%s%s", raw->kind == RAW_WORD ? ", found the keyword " : "",
                      raw->kind == RAW_WORD ? raw->as.word->text : "");
        if (macro->count == MAX_PARAMETERS)
            sdl_error(sdl, "a macro has at most %d parameters", MAX_PARAMETERS);
        parameters[macro->count++] = raw->as.word;
        if (raw_is(sdl_raw_peek(sdl), ','))
            sdl_raw(sdl);
    }
    sdl_raw(sdl);
    macro->parameters = sdl_alloc(sdl, (size_t)macro->count * sizeof *parameters + 1);
    memcpy(macro->parameters, parameters, (size_t)macro->count * sizeof *parameters);
    macro->name = word;
    macro->source = frame->source;
    macro->start = (uint32_t)(opener - frame->source->tokens);
    macro->body = stream_index(sdl);
    frame->source->keep = 1;
    if (!word->symbol)
        symbol_add(sdl, word, 0);
    else if (!word->symbol->macro)
        sdl_error(sdl, "`%s` is declared already, and not as a macro", word->text);
    word->symbol->macro = macro;
    stream_jump(sdl, opener->as.directive.link + 1);
}

/* Parse one argument. A name followed by `,` or `)` is passed by reference, anything else by value. */
static void argument(Sdl *sdl, Symbol *parameter)
{
    const Token *token = sdl_peek(sdl);
    if (token->kind == TOKEN_IDENT && (raw_is(sdl->cursor, ',') || raw_is(sdl->cursor, ')'))) {
        if (token->value->kind == VALUE_NONE)
            sdl_error(sdl, "`%s` has no value yet", token->text);
        parameter->value = token->value;
        sdl_next(sdl);
        return;
    }
    if (sdl_is(sdl, "function")) {
        sdl_next(sdl);
        function_declare(sdl, &parameter->own);
    } else if (sdl_is(sdl, "array")) {
        sdl_next(sdl);
        array_declare(sdl, &parameter->own);
    } else if (sdl_is(sdl, "spline")) {
        sdl_next(sdl);
        spline_declare(sdl, &parameter->own);
    } else if (sdl_is_expression_start(sdl) || sdl_is_color_start(sdl))
        parameter->own = sdl_expression(sdl);
    else if (token->kind == TOKEN_IDENT)
        parameter->own = *sdl_next(sdl)->value;
    else if (!sdl->builder->declare(sdl, &parameter->own))
        sdl_expected(sdl, "an argument of the macro");
}

void macro_invoke(Sdl *sdl, Symbol *symbol)
{
    const Macro *macro = symbol->macro;
    /* All arguments are evaluated in the caller's scope, then bound in the macro's scope: an argument may be a macro
     * call itself. */
    Symbol *arguments[MAX_PARAMETERS];
    if (!raw_is(sdl_raw(sdl), '('))
        sdl_error(sdl, "expected `(` after the macro `%s`", macro->name->text);
    if (++sdl->expression_depth > MAX_EXPRESSION_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "expressions nested more than %d deep", MAX_EXPRESSION_DEPTH);
    for (int i = 0; i < macro->count; i++) {
        if (i)
            sdl_optional_comma(sdl);
        if (sdl_is(sdl, ")"))
            sdl_error(sdl, "the macro `%s` has %d parameters, %d given", macro->name->text, macro->count, i);
        arguments[i] = symbol_new(sdl);
        argument(sdl, arguments[i]);
    }
    if (!sdl_accept(sdl, ")")) {
        if (sdl_is(sdl, ","))
            sdl_error(sdl, "the macro `%s` has only %d parameters", macro->name->text, macro->count);
        sdl_expected(sdl, "`)` after the macro's arguments");
    }
    sdl->expression_depth--;
    stream_push_macro(sdl, macro);
    for (int i = 0; i < macro->count; i++)
        symbol_bind(sdl, arguments[i], macro->parameters[i], sdl->nframes);
}
