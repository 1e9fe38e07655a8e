/* Lists of statements that a prefix and a name are the key of. */
#include "edit/keyed.h"

#include <stdio.h>
#include <string.h>

/* The place of a name; *there: 1 if it is in the list. */
static int place_of(const RetexKeyedList *list, const char *name, int *there)
{
    int at = 0, order = 1;
    while (at < list->count && (order = strcmp(list->of[at].name, name)) < 0)
        at++;
    *there = at < list->count && order == 0;
    return at;
}

const RetexKeyed *retex_keyed_find(const RetexKeyedList *list, const char *name)
{
    int there, at = place_of(list, name, &there);
    return there ? &list->of[at] : NULL;
}

static int insert(RetexKeyedList *list, const RetexKeyedKind *kind, const RetexKeyed *statement, RetexError *err)
{
    int there, at = place_of(list, statement->name, &there);
    if (there)
        return retex_fail(err, RETEX_EPARSE, "%s:%s is given twice", kind->word, statement->name);
    if (list->count == kind->most)
        return retex_fail(err, RETEX_EPARSE, "%s more than %d %s", kind->many[0], kind->most, kind->many[1]);
    memmove(list->of + at + 1, list->of + at, (size_t)(list->count++ - at) * sizeof *list->of);
    list->of[at] = *statement;
    return RETEX_OK;
}

int retex_keyed_bad_name(const RetexKeyedKind *kind, const char *name, RetexError *err)
{
    return retex_fail(err, RETEX_EPARSE, "`%s:%.40s`: %s 1 to %d bytes", kind->word, name, kind->names,
                      RETEX_NAME_MAX - 1);
}

int retex_keyed_add(RetexKeyedList *list, const RetexKeyedKind *kind, const char *name, const char *value,
                    RetexError *err)
{
    RetexKeyed statement = {.name = ""};
    if (!*name || strlen(name) >= sizeof statement.name)
        return retex_keyed_bad_name(kind, name, err);
    strcpy(statement.name, name);
    const int code = kind->parse(&statement, value, err);
    return code ? code : insert(list, kind, &statement, err);
}

int retex_keyed_option(RetexKeyedList *list, const RetexKeyedKind *kind, const char *arg, RetexError *err)
{
    char name[RETEX_NAME_MAX + 1];
    const char *equals = arg ? strrchr(arg, '=') : NULL;
    if (!equals || equals == arg || !equals[1])
        return retex_fail(err, RETEX_EPARSE, "%s '%s': expected %s, %s", kind->word, arg ? arg : "", kind->form,
                          kind->expected);
    snprintf(name, sizeof name, "%.*s", (int)(equals - arg), arg);
    return retex_keyed_add(list, kind, name, equals + 1, err);
}

int retex_keyed_complete(RetexKeyedList *list, const RetexKeyedKind *kind, const RetexKeyedList *from, RetexError *err)
{
    RetexKeyedList next = *list;
    int code = RETEX_OK;
    for (int i = 0; i < from->count && !code; i++)
        if (!retex_keyed_find(&next, from->of[i].name))
            code = insert(&next, kind, &from->of[i], err);
    if (!code)
        *list = next;
    return code;
}

int retex_keyed_bind(RetexKeyedList *list, const RetexKeyedKind *kind, const RetexSet *set, RetexError *err)
{
    RetexKeyedList next = {.count = 0};
    int code = RETEX_OK;
    for (int i = 0; i < list->count && !code; i++) {
        RetexKeyed statement = list->of[i];
        code = kind->bind(&statement, set, err);
        if (!code)
            code = insert(&next, kind, &statement, err);
    }
    if (!code)
        *list = next;
    return code;
}
