/* Helpers of all rooms of statements, and the report of what is not supported. */
#include "sdl/state/builder.h"

#include <string.h>

#include "pattern/pattern.h"

#define MAX_NESTING 200

static const struct {
    const char *name, *instead;
} gap_names[GAP_COUNT] = {
#define X(id, name, instead) [GAP_##id] = {name, instead},
    GAP_TABLE(X)
#undef X
};

void gaps_add(Gaps *gaps, Gap gap)
{
    gaps->bits |= (uint64_t)1 << gap;
}

void gaps_add_pattern(Gaps *gaps, int pattern)
{
    gaps->patterns |= (uint64_t)1 << pattern;
}

void gaps_join(Gaps *gaps, const Gaps *other)
{
    gaps->bits |= other->bits;
    gaps->patterns |= other->patterns;
}

void gaps_report(Sdl *sdl, const Gaps *gaps)
{
    for (int i = 0; gaps->patterns >> i && i < pattern_count(); i++)
        if (gaps->patterns >> i & 1) {
            const PatternOps *pattern = pattern_at(i);
            sdl_unsupported(sdl, pattern->name, "its mean colour is used");
        }
    for (int i = 0; gaps->bits >> i && i < GAP_COUNT; i++)
        if (gaps->bits >> i & 1)
            sdl_unsupported(sdl, gap_names[i].name, gap_names[i].instead);
}

/* ---- small helpers of all files ---- */

void statement_begin(Sdl *sdl)
{
    if (++builder_of(sdl)->depth > MAX_NESTING)
        sdl_error(sdl, "statements are nested more than %d deep", MAX_NESTING);
}

void statement_end(Sdl *sdl)
{
    builder_of(sdl)->depth--;
}

Value *peek_ident(Sdl *sdl, ValueKind kind)
{
    const Token *token = sdl_peek(sdl);
    return token->kind == TOKEN_IDENT && token->value && token->value->kind == kind ? token->value : NULL;
}

void *accept_ident(Sdl *sdl, ValueKind kind)
{
    Value *value = peek_ident(sdl, kind);
    if (!value)
        return NULL;
    void *data = value->data;
    sdl_next(sdl);
    return data;
}

void *accept_ident_of_word(Sdl *sdl, const char *word)
{
    const Value *value = peek_ident(sdl, VALUE_OTHER);
    return value && value->word && strcmp(value->word, word) == 0 ? accept_ident(sdl, VALUE_OTHER) : NULL;
}

int is_float_start(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    switch (token->kind) {
    case TOKEN_NUMBER:
        return 1;
    case TOKEN_IDENT:
        return token->value && token->value->kind == VALUE_FLOAT;
    case TOKEN_PUNCT:
        return token->punct == '-' || token->punct == '+' || token->punct == '(';
    default:
        return !sdl_is_color_start(sdl) && sdl_is_expression_start(sdl) && !sdl_is(sdl, "<");
    }
}

double optional_float(Sdl *sdl, double missing)
{
    return is_float_start(sdl) ? sdl_float(sdl) : missing;
}

void skip_statement(Sdl *sdl)
{
    sdl_next(sdl);
    sdl_skip_block(sdl);
}
