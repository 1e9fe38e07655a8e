/* Identifiers that are legal, unique whatever the case, and no keywords. */
#ifndef RETEX_IMPORT_NAMES_H
#define RETEX_IMPORT_NAMES_H

#include <stddef.h>

enum { NAME_MAX_LENGTH = 48, NAME_SIZE = 64 };

typedef struct Names {
    struct NamesEntry *entries;
    size_t size, count;
} Names;

/* Make an identifier of a text; of `fallback` where the text has no letters. Returns 0 without memory. */
int names_make(Names *names, const char *text, const char *fallback, char name[NAME_SIZE]);
/* Whether that is one of them, with the same case of letters. */
int names_have(const Names *names, const char *text);
/* Keep a text as it is. Returns 0 if it was there, whatever its case; -1 without memory. */
int names_add(Names *names, const char *text);
void names_free(Names *names);

#endif
