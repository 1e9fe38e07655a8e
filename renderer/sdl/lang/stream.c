/* The token stream: a stack of frames (files and macro bodies) with one token of lookahead. Peeking at the next
 * token runs the directives before it and enters macros. Expressions, #declare and the builder all read from this
 * stream. */
#include <stdio.h>
#include <string.h>
#include "sdl/lang/internal.h"

static Frame *top(Sdl *sdl)
{
    return &sdl->frames[sdl->nframes - 1];
}

static Frame *push(Sdl *sdl, Source *source)
{
    if (sdl->nframes)
        top(sdl)->cursor = sdl->cursor;
    Frame *frame = &sdl->frames[sdl->nframes++];
    memset(frame, 0, sizeof *frame);
    frame->source = source;
    frame->macro_start = LINK_NONE;
    frame->nloops = sdl->nloops;
    source->users++;
    sdl->cursor = source->tokens;
    return frame;
}

void stream_push_file(Sdl *sdl, Source *source)
{
    if (sdl->nframes - sdl->nmacros >= MAX_INCLUDE_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "#include nested more than %d deep", MAX_INCLUDE_DEPTH);
    push(sdl, source);
}

void stream_push_macro(Sdl *sdl, const Macro *macro)
{
    if (sdl->nmacros >= MAX_MACRO_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "macros nested more than %d deep", MAX_MACRO_DEPTH);
    Frame *frame = push(sdl, macro->source);
    frame->macro_start = macro->start;
    sdl->nmacros++;
    sdl->cursor = macro->source->tokens + macro->body;
}

void stream_pop(Sdl *sdl)
{
    Frame *frame = top(sdl);
    sdl->nloops = frame->nloops;
    scope_close(sdl, frame);
    sdl->nmacros -= frame->macro_start != LINK_NONE;
    sdl->nframes--;
    if (sdl->nframes)
        sdl->cursor = top(sdl)->cursor;
    source_release(sdl, frame->source);
}

void stream_jump(Sdl *sdl, uint32_t index)
{
    sdl->cursor = top(sdl)->source->tokens + index;
}
uint32_t stream_index(Sdl *sdl)
{
    return (uint32_t)(sdl->cursor - top(sdl)->source->tokens);
}

void stream_locate(Sdl *sdl, const Raw *raw)
{
    sdl->token.file = top(sdl)->source->name;
    sdl->token.line = (int)raw->line;
    sdl->token.column = raw->column;
}

/* Set the current token from a raw token: its kind and text in the form of parser.h. */
static void set_token(Sdl *sdl, const Raw *raw, TokenKind kind)
{
    Token *token = &sdl->token;
    token->kind = kind;
    token->punct = raw->punct;
    token->text = "";
    token->value = NULL;
    token->number = 0;
    stream_locate(sdl, raw);
    sdl->have = 1;
}

/* A declared name: a macro is entered, an array is indexed, any other value becomes the token. */
static void identifier(Sdl *sdl, const Raw *raw)
{
    Symbol *symbol = raw->as.word->symbol;
    if (symbol->macro) {
        stream_locate(sdl, raw);
        macro_invoke(sdl, symbol);
        return;
    }
    Value *value = symbol->value;
    if (value->kind == VALUE_ARRAY && sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '[') {
        stream_locate(sdl, raw);
        value = array_element(sdl, value);
        sdl->have = 0;
    }
    set_token(sdl, raw, TOKEN_IDENT);
    sdl->token.text = raw->as.word->text;
    sdl->token.value = value;
}

/* End of a file. The end of the scene file itself is a token, which is never consumed. */
static void end_of_file(Sdl *sdl, const Raw *raw)
{
    if (sdl->nframes > 1 && top(sdl)->macro_start == LINK_NONE) {
        stream_pop(sdl);
        return;
    }
    sdl->cursor = raw;
    set_token(sdl, raw, TOKEN_END);
}

/* In old versions no semicolon tells where the value of a declaration ends: any directive after a number does. */
static int needs_no_semicolon(const Sdl *sdl)
{
    return sdl->declarations > 0 && sdl->version < SEMICOLON_VERSION;
}

/* Produce the next token. Returns 0, and consumes nothing, if the next raw token in frame `stop` itself is a
 * declaration or a similar directive; an expression without `;` ends in this way. stop = -1: never. With `any` it
 * also returns 0 as soon as frame `stop` is on top again. */
static int fill(Sdl *sdl, int stop, int any)
{
    while (!sdl->have) {
        if (any && sdl->nframes <= stop)
            return 0;
        const Raw *raw = sdl->cursor++;
        if (++sdl->steps > sdl->next_look)
            sdl_step(sdl, 0);
        switch ((RawKind)raw->kind) {
        case RAW_NUMBER:
            set_token(sdl, raw, TOKEN_NUMBER);
            sdl->token.number = raw->as.number;
            break;
        case RAW_PUNCT:
            set_token(sdl, raw, TOKEN_PUNCT);
            break;
        case RAW_STRING:
            set_token(sdl, raw, TOKEN_STRING);
            sdl->token.text = raw->as.string;
            break;
        case RAW_WORD:
            if (raw->as.word->symbol)
                identifier(sdl, raw);
            else {
                set_token(sdl, raw, TOKEN_WORD);
                sdl->token.text = raw->as.word->text;
                sdl->token.word = raw->as.word;
            }
            break;
        case RAW_DIRECTIVE:
            if (sdl->nframes == stop && (raw->as.directive.id >= DIR_DECLARE || needs_no_semicolon(sdl))) {
                sdl->cursor--;
                return 0;
            }
            stream_locate(sdl, raw);
            directive_run(sdl, raw);
            break;
        case RAW_END:
            end_of_file(sdl, raw);
            break;
        case RAW_BAD:
            stream_locate(sdl, raw);
            raw_fail(sdl, raw);
        }
    }
    return 1;
}

const Token *sdl_peek(Sdl *sdl)
{
    if (!sdl->have)
        fill(sdl, -1, 0);
    return &sdl->token;
}

void sdl_place(Sdl *sdl, const char **file, int *line)
{
    const Token *token = sdl_peek(sdl);
    *file = token->file, *line = token->line;
    for (int k = 1; k < sdl->nframes; k++)
        if (sdl->frames[k].macro_start != LINK_NONE) {
            const Frame *caller = &sdl->frames[k - 1];
            *file = caller->source->name, *line = (int)caller->cursor[-1].line;
            return;
        }
}

const Token *sdl_peek_operator(Sdl *sdl, int frame)
{
    if (!sdl->have && !fill(sdl, frame, 0))
        return NULL;
    return &sdl->token;
}

void stream_finish_macros(Sdl *sdl, int frame)
{
    if (sdl->nframes > frame)
        fill(sdl, frame, 1);
}

const Token *sdl_next(Sdl *sdl)
{
    if (!sdl->have)
        fill(sdl, -1, 0);
    if (sdl->token.kind == TOKEN_PUNCT) {
        if (sdl->token.punct == '{') {
            if (sdl->block_depth == MAX_BLOCK_DEPTH)
                sdl_fail(sdl, RETEX_ELIMIT, "blocks nested more than %d deep", MAX_BLOCK_DEPTH);
            sdl->blocks[sdl->block_depth].file = sdl->token.file;
            sdl->blocks[sdl->block_depth++].line = sdl->token.line;
        }
        if (sdl->token.punct == '}' && sdl->block_depth > 0)
            sdl->block_depth--;
    }
    sdl->have = sdl->token.kind == TOKEN_END;
    return &sdl->token;
}

static char punct_code(const char *text)
{
    if (!text[1])
        return text[0];
    if (text[1] == '=' && !text[2])
        return text[0] == '<' ? PUNCT_LE : text[0] == '>' ? PUNCT_GE : text[0] == '!' ? PUNCT_NE : 0;
    return 0;
}

static int is_word_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

int sdl_is(Sdl *sdl, const char *word_or_punct)
{
    const Token *token = sdl_peek(sdl);
    if (is_word_start(*word_or_punct))
        return token->kind == TOKEN_WORD && strcmp(token->text, word_or_punct) == 0;
    return token->kind == TOKEN_PUNCT && token->punct == punct_code(word_or_punct);
}

int sdl_accept(Sdl *sdl, const char *word_or_punct)
{
    if (!sdl_is(sdl, word_or_punct))
        return 0;
    sdl_next(sdl);
    return 1;
}

int sdl_accept_float(Sdl *sdl, const char *word, double *value)
{
    if (!sdl_accept(sdl, word))
        return 0;
    *value = sdl_float(sdl);
    return 1;
}

void sdl_expect(Sdl *sdl, const char *word_or_punct)
{
    if (sdl_accept(sdl, word_or_punct))
        return;
    char what[80];
    snprintf(what, sizeof what, "`%.60s`", word_or_punct);
    sdl_expected(sdl, what);
}

void sdl_optional_comma(Sdl *sdl)
{
    if (!sdl->have && sdl->cursor->kind == RAW_PUNCT) { /* fast path for long lists */
        if (sdl->cursor->punct == ',')
            sdl->cursor++;
        return;
    }
    sdl_accept(sdl, ",");
}

void sdl_skip_block(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    for (int depth = 1; depth;) {
        const Token *token = sdl_next(sdl);
        if (token->kind == TOKEN_END)
            sdl_expected(sdl, "`}`");
        if (token->kind == TOKEN_PUNCT)
            depth += (token->punct == '{') - (token->punct == '}');
    }
}

const Raw *sdl_raw_peek(Sdl *sdl)
{
    if (sdl->cursor->kind == RAW_BAD) {
        stream_locate(sdl, sdl->cursor);
        raw_fail(sdl, sdl->cursor);
    }
    return sdl->cursor;
}

const Raw *sdl_raw(Sdl *sdl)
{
    const Raw *raw = sdl_raw_peek(sdl);
    stream_locate(sdl, raw);
    if (raw->kind != RAW_END)
        sdl->cursor++;
    return raw;
}

int sdl_raw_accept(Sdl *sdl, char punct)
{
    if (sdl->have) {
        if (sdl->token.kind != TOKEN_PUNCT || sdl->token.punct != punct)
            return 0;
        sdl_next(sdl);
        return 1;
    }
    if (sdl->cursor->kind != RAW_PUNCT || sdl->cursor->punct != punct)
        return 0;
    sdl->cursor++;
    return 1;
}

void sdl_raw_expect(Sdl *sdl, char punct)
{
    char what[] = "` `";
    what[1] = punct;
    if (!sdl_raw_accept(sdl, punct))
        sdl_expected(sdl, what);
}

static const char *value_kind_name(const Value *value)
{
    static const char *const names[] = {"nothing",     "a float",     "a vector",     "a string",
                                        "an array",    "a function",  "a spline",     "a transform",
                                        "a pigment",   "a normal",    "a finish",     "a texture",
                                        "an interior", "a material",  "an object",    "a camera",
                                        "a light",     "a color_map", "a sky_sphere", "something not supported"};
    if (value->kind == VALUE_VECTOR && value->is_color)
        return "a color";
    return value->kind <= VALUE_OTHER ? names[value->kind] : "something";
}

void stream_describe(Sdl *sdl, const Token *token, char *out, size_t size)
{
    static const char *const two[] = {"<=", ">=", "!="};
    const Word *word;
    const char *nearest;
    switch (token->kind) {
    case TOKEN_END:
        snprintf(out, size, "the end of the file");
        break;
    case TOKEN_NUMBER:
        snprintf(out, size, "`%g`", token->number);
        break;
    case TOKEN_STRING:
        snprintf(out, size, "the string \"%.40s\"", token->text);
        break;
    case TOKEN_IDENT:
        snprintf(out, size, "`%.60s`, which is %s", token->text, value_kind_name(token->value));
        break;
    case TOKEN_PUNCT:
        if (token->punct == PUNCT_LE || token->punct == PUNCT_GE || token->punct == PUNCT_NE)
            snprintf(out, size, "`%s`", two[token->punct == PUNCT_LE ? 0 : token->punct == PUNCT_GE ? 1 : 2]);
        else
            snprintf(out, size, "`%c`", token->punct);
        break;
    case TOKEN_WORD:
        word = token->word;
        if (word->reserved) {
            snprintf(out, size, "`%.60s`", token->text);
            break;
        }
        nearest = word_nearest(sdl, token->text);
        if (word->declaring) /* the name's own declaration is not complete: probably a brace is missing */
            snprintf(out, size, "`%.60s`, whose declaration of line %d has not ended", token->text, word->declaring);
        else if (nearest)
            snprintf(out, size, "`%.60s`, which is not declared; is `%.60s` meant?", token->text, nearest);
        else
            snprintf(out, size, "`%.60s`, which is not declared", token->text);
        break;
    }
}

int sdl_accept_written(Sdl *sdl, const char *word)
{
    const Raw *raw = sdl->have ? NULL : sdl_raw_peek(sdl);
    return raw && raw->kind == RAW_WORD && strcmp(raw->as.word->text, word) == 0 && sdl_accept(sdl, word);
}
