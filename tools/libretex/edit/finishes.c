/* The statements of an edit about finishes: see retex/edit.h. */
#include "edit/finishes.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/nearest.h>

#include "edit/edit.h"
#include "set/set.h"

int retex_edit_finish(RetexEdit *edit, const char *arg, RetexError *err)
{
    return retex_keyed_option(&edit->keyed[RETEX_EDIT_FINISHES], &retex_keyed_finish, arg, err);
}

static int parse(RetexKeyed *statement, const char *text, RetexError *err)
{
    if (!*text || strlen(text) >= sizeof statement->finish)
        return retex_keyed_bad_name(&retex_keyed_finish, statement->name, err);
    strcpy(statement->finish, text);
    return RETEX_OK;
}

static void write(const RetexKeyed *statement, char text[RETEX_KEYED_TEXT_MAX])
{
    strcpy(text, statement->finish);
}

/* ---- the finishes that there are ---- */

/* *finish: its number, from 1. */
static int find_finish(const RetexTarget *target, const char *name, int *finish, RetexError *err)
{
    char all[sizeof err->message] = "", meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    *finish = 0;
    if (target->normal_tilt > 0)
        return retex_fail(err, RETEX_ENOTFOUND, "%s has one finish, with normals: there is none to choose",
                          target->name);
    for (int k = 0; k < target->nfinishes; k++) {
        const size_t used = strlen(all);
        if (strcasecmp(target->finishes[k], name) == 0)
            *finish = 1 + k;
        snprintf(all + used, sizeof all - used, "%s%s", k ? ", " : "", target->finishes[k]);
        retex_nearest_try(&nearest, target->finishes[k]);
    }
    if (*finish)
        return RETEX_OK;
    if (!target->nfinishes)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "the finish of %s cannot be chosen; render the set with --finish %s=NAME,NAME", target->name,
                          target->name);
    return retex_fail(err, RETEX_ENOTFOUND, "%s has no finish '%s'; it has %.700s%s", target->name, name, all,
                      retex_meant(nearest.best, meant));
}

static int bind(RetexKeyed *statement, const RetexSet *set, RetexError *err)
{
    RetexTargetNames names;
    int target, finish;
    retex_set_target_names(&names, set);
    int code = retex_target_find(&target, &names, statement->name, err);
    if (!code)
        code = find_finish(&set->targets[target], statement->finish, &finish, err);
    if (!code) {
        strcpy(statement->name, set->targets[target].name);
        strcpy(statement->finish, set->targets[target].finishes[finish - 1]);
    }
    return code;
}

int retex_edit_finish_of(const RetexEdit *edit, const RetexTarget *target)
{
    const RetexKeyed *statement = retex_keyed_find(&edit->keyed[RETEX_EDIT_FINISHES], target->name);
    int finish;
    return statement && !find_finish(target, statement->finish, &finish, NULL) ? finish : target->finish;
}

const RetexKeyedKind retex_keyed_finish = {
    .word = "finish",
    .form = "TARGET=NAME",
    .expected = "a target and one of its finishes",
    .names = "names of targets and finishes have",
    .many = {"finishes of", "targets"},
    .most = RETEX_MAX_TARGETS,
    .parse = parse,
    .write = write,
    .bind = bind,
};
