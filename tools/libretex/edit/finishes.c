/* The statements of an edit about finishes: see retex/edit.h. */
#include "edit/finishes.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/nearest.h>

#include "edit/edit.h"
#include "set/set.h"

#define PREFIX "finish:"

const char *retex_edit_key_finish(const char *key)
{
    return strncmp(key, PREFIX, strlen(PREFIX)) == 0 ? key + strlen(PREFIX) : NULL;
}

/* The place of a target among the finishes; *there: 1 if it has one. */
static int place_of(const RetexEdit *edit, const char *target, int *there)
{
    int at = 0, order = 1;
    while (at < edit->nfinishes && (order = strcmp(edit->finishes[at].target, target)) < 0)
        at++;
    *there = at < edit->nfinishes && order == 0;
    return at;
}

int retex_edit_add_finish(RetexEdit *edit, const char *target, const char *finish, RetexError *err)
{
    int there, at = place_of(edit, target, &there);
    if (!*target || strlen(target) >= sizeof edit->finishes->target || !*finish ||
        strlen(finish) >= sizeof edit->finishes->finish)
        return retex_fail(err, RETEX_EPARSE, "`finish:%.40s`: names of targets and finishes have 1 to %d bytes", target,
                          RETEX_NAME_MAX - 1);
    if (there)
        return retex_fail(err, RETEX_EPARSE, "finish:%s is given twice", target);
    if (edit->nfinishes == RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EPARSE, "finishes of more than %d targets", RETEX_MAX_TARGETS);
    memmove(edit->finishes + at + 1, edit->finishes + at, (size_t)(edit->nfinishes++ - at) * sizeof *edit->finishes);
    snprintf(edit->finishes[at].target, sizeof edit->finishes->target, "%s", target);
    snprintf(edit->finishes[at].finish, sizeof edit->finishes->finish, "%s", finish);
    return RETEX_OK;
}

int retex_edit_finish(RetexEdit *edit, const char *arg, RetexError *err)
{
    char target[RETEX_NAME_MAX + 1];
    const char *equals = arg ? strrchr(arg, '=') : NULL;
    if (!equals || equals == arg || !equals[1])
        return retex_fail(err, RETEX_EPARSE, "finish '%s': expected TARGET=NAME, a target and one of its finishes",
                          arg ? arg : "");
    snprintf(target, sizeof target, "%.*s", (int)(equals - arg), arg);
    return retex_edit_add_finish(edit, target, equals + 1, err);
}

int retex_edit_complete_finishes(RetexEdit *edit, const RetexEdit *from, RetexError *err)
{
    int code = RETEX_OK, there;
    for (int i = 0; i < from->nfinishes && !code; i++) {
        place_of(edit, from->finishes[i].target, &there);
        if (!there)
            code = retex_edit_add_finish(edit, from->finishes[i].target, from->finishes[i].finish, err);
    }
    return code;
}

/* ---- the finishes that there are ---- */

static int find_finish(const RetexTarget *target, const char *name, int *finish, RetexError *err)
{
    char all[sizeof err->message] = "", meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    *finish = -1;
    for (int k = 0; k < target->nfinishes; k++) {
        const size_t used = strlen(all);
        if (strcasecmp(target->finishes[k], name) == 0)
            *finish = k;
        snprintf(all + used, sizeof all - used, "%s%s", k ? ", " : "", target->finishes[k]);
        retex_nearest_try(&nearest, target->finishes[k]);
    }
    if (*finish >= 0)
        return RETEX_OK;
    if (!target->nfinishes)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "the finish of %s cannot be chosen; render the set with --finish %s=NAME,NAME", target->name,
                          target->name);
    return retex_fail(err, RETEX_ENOTFOUND, "%s has no finish '%s'; it has %.700s%s", target->name, name, all,
                      retex_meant(nearest.best, meant));
}

static int find_target(const RetexSet *set, const char *name, int *target, RetexError *err)
{
    RetexTargetNames names;
    retex_set_target_names(&names, set);
    return retex_target_find(target, &names, name, err);
}

int retex_edit_bind_finishes(RetexEdit *edit, const RetexSet *set, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK, target, finish;
    next.nfinishes = 0;
    for (int i = 0; i < edit->nfinishes && !code; i++) {
        code = find_target(set, edit->finishes[i].target, &target, err);
        if (!code)
            code = find_finish(&set->targets[target], edit->finishes[i].finish, &finish, err);
        if (!code)
            code = retex_edit_add_finish(&next, set->targets[target].name, set->targets[target].finishes[finish], err);
    }
    if (!code)
        *edit = next;
    return code;
}

int retex_edit_finish_of(const RetexEdit *edit, const RetexTarget *target)
{
    int there, at = place_of(edit, target->name, &there), finish;
    return there && !find_finish(target, edit->finishes[at].finish, &finish, NULL) ? finish : target->finish;
}
