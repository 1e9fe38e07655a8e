/* The kinds of statements about a target's texture. Private to libretex. */
#ifndef RETEX_EDIT_STATEMENT_H
#define RETEX_EDIT_STATEMENT_H

#include <stdio.h>

#include <retex/texture.h>

/* The first kind is the image, the others are options. The last ones are adjustments of colours, in the order of
 * RetexAdjust. */
enum {
    RETEX_STATEMENT_ADJUSTMENTS = 16,
    RETEX_STATEMENTS = RETEX_STATEMENT_ADJUSTMENTS + RETEX_ADJUSTS,
    STATEMENT_TEXT_MAX = 2100
};

/* KEY is TARGET.word, or TARGET alone where the word is "". */
const char *retex_statement_word(int kind);
/* RETEX_EPARSE where the value is none. */
int retex_statement_parse(RetexTextureSpec *spec, int kind, const char *value, RetexError *err);
/* The value as text; 0 where it is the default. */
int retex_statement_write(const RetexTextureSpec *spec, int kind, char text[STATEMENT_TEXT_MAX]);
/* The kind of statement number `index`, below RETEX_STATEMENTS, in the canonical text of a texture: adjustments stand
 * in the order in which they are made. -1: it has no statement of that number. */
int retex_statement_ordered(const RetexTextureSpec *spec, int index);

/* The layer, from 1, that a key is of, over:NAME or overN:NAME; 0: it is of the target itself. *name: the target's. */
int retex_statement_layer(const char *key, const char **name);
/* RETEX_EPARSE where the value is none, or a layer has no such statement. Layers are added as far as needed. */
int retex_statement_parse_layer(RetexTextureSpec *spec, int layer, int kind, const char *value, RetexError *err);

/* 1: it says what lies beyond the image, which layers do not have. */
int retex_statement_is_wrap(int kind);

/* Of an option's word of `length` bytes; -1 = none. */
int retex_statement_option(const char *word, size_t length);
/* RETEX_EPARSE: no option has this word. */
int retex_statement_unknown(const char *word, RetexError *err);
/* RETEX_EPARSE: options of the texture contradict each other. */
int retex_statement_check(const RetexTextureSpec *spec, RetexError *err);

#endif
