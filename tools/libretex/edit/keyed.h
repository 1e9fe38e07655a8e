/* Statements PREFIX:NAME=VALUE: of lamps and of finishes of targets, which a set has by a name, and of how the picture
 * is developed. Each kind of them is a row, with a list in the edit, sorted by name. Private to libretex. */
#ifndef RETEX_EDIT_KEYED_H
#define RETEX_EDIT_KEYED_H

#include <retex/lamp.h>
#include <retex/set.h>

/* The most of a kind, and bytes of a value's text with the final NUL. */
enum { RETEX_KEYED_MAX = 32, RETEX_KEYED_TEXT_MAX = RETEX_LAMP_TEXT_MAX };

typedef struct RetexKeyed {
    char name[RETEX_NAME_MAX]; /* not empty */
    union {
        RetexLampValue light;
        char finish[RETEX_NAME_MAX];
        char view[RETEX_NAME_MAX];
        double number;
    };
} RetexKeyed;

typedef struct RetexKeyedList {
    int count;
    RetexKeyed of[RETEX_KEYED_MAX]; /* sorted by name */
} RetexKeyedList;

typedef struct RetexKeyedKind {
    const char *word;     /* the prefix, without the colon; the name of the option of command lines too */
    const char *form;     /* NAME=VALUE, for messages */
    const char *expected; /* what NAME and VALUE are */
    const char *names;    /* of which this many bytes are said */
    const char *many[2];  /* what there may be no more of than `most`, before and after that number */
    int most;             /* up to RETEX_KEYED_MAX */
    /* RETEX_EPARSE where the text is no value. statement: has its name. */
    int (*parse)(RetexKeyed *statement, const char *text, RetexError *err);
    void (*write)(const RetexKeyed *statement, char text[RETEX_KEYED_TEXT_MAX]);
    /* Give the statement the names that the set has. */
    int (*bind)(RetexKeyed *statement, const RetexSet *set, RetexError *err);
} RetexKeyedKind;

/* The statement of that name, or NULL. */
const RetexKeyed *retex_keyed_find(const RetexKeyedList *list, const char *name);
/* RETEX_EPARSE: a name is missing or too long. */
int retex_keyed_bad_name(const RetexKeyedKind *kind, const char *name, RetexError *err);

/* These leave the list as it was where they fail. */

/* Add a statement: RETEX_EPARSE where there is one of its name. */
int retex_keyed_add(RetexKeyedList *list, const RetexKeyedKind *kind, const char *name, const char *value,
                    RetexError *err);
/* Add that of an option of a command line, NAME=VALUE. */
int retex_keyed_option(RetexKeyedList *list, const RetexKeyedKind *kind, const char *arg, RetexError *err);
/* Add those of another list whose names this one has not. */
int retex_keyed_complete(RetexKeyedList *list, const RetexKeyedKind *kind, const RetexKeyedList *from, RetexError *err);
/* Give all the names that a set has. RETEX_EPARSE where two are one there. */
int retex_keyed_bind(RetexKeyedList *list, const RetexKeyedKind *kind, const RetexSet *set, RetexError *err);

#endif
