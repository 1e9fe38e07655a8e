/* Identifiers. They begin with a capital letter, as no keyword of POV-Ray does. */
#include <stdint.h>
#include <stdio.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "import/base/names.h"

struct NamesEntry {
    char *name;
    int next; /* the number with which to make another one of it */
};

static size_t hash(const char *name)
{
    uint64_t h = 0xcbf29ce484222325u;
    for (; *name; name++)
        h = (h ^ (unsigned char)tolower((unsigned char)*name)) * 0x100000001b3u;
    return (size_t)(h ^ h >> 29);
}

static struct NamesEntry *find(const Names *names, const char *name)
{
    for (size_t k = hash(name);; k++) {
        struct NamesEntry *entry = &names->entries[k & (names->size - 1)];
        if (!entry->name || strcasecmp(entry->name, name) == 0)
            return entry;
    }
}

static int grow(Names *names)
{
    if (2 * (names->count + 1) <= names->size)
        return 1;
    Names more = {calloc(names->size ? 2 * names->size : 64, sizeof *more.entries), names->size ? 2 * names->size : 64,
                  names->count};
    if (!more.entries)
        return 0;
    for (size_t k = 0; k < names->size; k++)
        if (names->entries[k].name)
            *find(&more, names->entries[k].name) = names->entries[k];
    free(names->entries);
    *names = more;
    return 1;
}

static void make_legal(const char *text, const char *fallback, char name[NAME_SIZE])
{
    int n = 0, gap = 0;
    for (const char *c = text; *c && n < NAME_MAX_LENGTH; c++)
        if ((unsigned char)*c < 128 && isalnum((unsigned char)*c)) {
            if (gap && n)
                name[n++] = '_';
            gap = 0;
            name[n++] = *c;
        } else
            gap = 1;
    name[n] = '\0';
    if (!n)
        snprintf(name, NAME_SIZE, "%s", fallback);
    else if (isdigit((unsigned char)name[0])) {
        char rest[NAME_SIZE];
        memcpy(rest, name, (size_t)n + 1);
        snprintf(name, NAME_SIZE, "%.12s_%.48s", fallback, rest);
    }
    name[0] = (char)toupper((unsigned char)name[0]);
}

int names_make(Names *names, const char *text, const char *fallback, char name[NAME_SIZE])
{
    char base[NAME_SIZE];
    make_legal(text, fallback, base);
    if (!grow(names))
        return 0;
    struct NamesEntry *first = find(names, base), *entry = first;
    snprintf(name, NAME_SIZE, "%s", base);
    for (int number = first->name ? first->next : 2; entry->name; number++) {
        snprintf(name, NAME_SIZE, "%.52s_%d", base, number);
        entry = find(names, name);
        first->next = number + 1;
    }
    entry->name = strdup(name);
    entry->next = 2;
    names->count++;
    return entry->name != NULL;
}

int names_have(const Names *names, const char *text)
{
    const struct NamesEntry *entry = names->size ? find(names, text) : NULL;
    return entry && entry->name && strcmp(entry->name, text) == 0;
}

int names_add(Names *names, const char *text)
{
    struct NamesEntry *entry = grow(names) ? find(names, text) : NULL;
    if (!entry)
        return -1;
    if (entry->name)
        return 0;
    entry->name = strdup(text);
    names->count++;
    return entry->name ? 1 : -1;
}

void names_free(Names *names)
{
    for (size_t k = 0; k < names->size; k++)
        free(names->entries[k].name);
    free(names->entries);
    *names = (Names){0};
}
