/* The kinds of statements about a target's texture. Private to libretex. */
#ifndef RETEX_EDIT_STATEMENT_H
#define RETEX_EDIT_STATEMENT_H

#include <stdio.h>

#include <retex/texture.h>

/* Words of options that text may have. */
enum { STATEMENT_KINDS = 10, STATEMENT_TEXT_MAX = 1100 };

/* A row of the table: KEY is TARGET.word, or TARGET alone where the word is "". */
typedef struct RetexStatementKind {
    const char *word;
    /* RETEX_EPARSE where the value is none. */
    int (*parse)(RetexTextureSpec *spec, const char *value, RetexError *err);
    /* The value as text; 0 where it is the default. */
    int (*write)(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX]);
} RetexStatementKind;

/* The first is the image; the others, options, follow in the order of the canonical text. */
extern const RetexStatementKind retex_statement_kinds[STATEMENT_KINDS];

/* Of an option's word of `length` bytes; -1 = none. */
int retex_statement_option(const char *word, size_t length);
/* RETEX_EPARSE: no option has this word. */
int retex_statement_unknown(const char *word, RetexError *err);
/* RETEX_EPARSE: options of the texture contradict each other. */
int retex_statement_check(const RetexTextureSpec *spec, RetexError *err);

#endif
