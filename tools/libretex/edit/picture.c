/* The statements of an edit about how the picture is developed: see retex/edit.h. */
#include "edit/picture.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/edit.h>
#include <retex/nearest.h>

#include "base/params.h"
#include "edit/edit.h"
#include "edit/number.h"

static const char EXPOSURE[] = "exposure", WHITE_BALANCE[] = "white-balance", AUTO_EXPOSURE[] = "auto-exposure",
                  VIEW[] = "view";
static const char *const words[] = {EXPOSURE, WHITE_BALANCE, AUTO_EXPOSURE, VIEW};
enum { WORDS = sizeof words / sizeof *words };

static int is(const RetexKeyed *statement, const char *word)
{
    return strcmp(statement->name, word) == 0;
}

static int no_key(const char *name, RetexError *err)
{
    char meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    for (int i = 0; i < WORDS; i++)
        retex_nearest_try(&nearest, words[i]);
    return retex_fail(err, RETEX_EPARSE, "`picture:%.80s`: expected exposure, white-balance, auto-exposure or view%s",
                      name, retex_meant(nearest.best, meant));
}

static int parse_number(RetexKeyed *statement, const char *text, double least, double most, const char *expected,
                        RetexError *err)
{
    const char *end;
    if (!retex_number_parse(text, &end, &statement->number) || *retex_skip_spaces(end) ||
        !(statement->number >= least && statement->number <= most))
        return retex_fail(err, RETEX_EPARSE, "%s '%.80s': expected %s", statement->name, text, expected);
    return RETEX_OK;
}

static int parse(RetexKeyed *statement, const char *text, RetexError *err)
{
    if (is(statement, EXPOSURE))
        return parse_number(statement, text, -RETEX_EXPOSURE_MAX, RETEX_EXPOSURE_MAX, "stops, -30 to 30, as in 0.5",
                            err);
    if (is(statement, WHITE_BALANCE))
        return parse_number(statement, text, RETEX_WHITE_BALANCE_MIN, RETEX_WHITE_BALANCE_MAX,
                            "kelvins, 1000 to 25000, as in 4000", err);
    if (is(statement, AUTO_EXPOSURE)) {
        statement->number = strcasecmp(text, "yes") == 0;
        return statement->number != 0 || strcasecmp(text, "no") == 0
                   ? RETEX_OK
                   : retex_fail(err, RETEX_EPARSE, "%s '%.80s': expected yes or no", AUTO_EXPOSURE, text);
    }
    if (!is(statement, VIEW))
        return no_key(statement->name, err);
    if (!*text || strlen(text) >= sizeof statement->view)
        return retex_fail(err, RETEX_EPARSE, "view '%.40s': the name of a view has 1 to %d bytes", text,
                          (int)sizeof statement->view - 1);
    strcpy(statement->view, text);
    return RETEX_OK;
}

static void write(const RetexKeyed *statement, char text[RETEX_KEYED_TEXT_MAX])
{
    if (is(statement, VIEW))
        strcpy(text, statement->view);
    else if (is(statement, AUTO_EXPOSURE))
        strcpy(text, statement->number != 0 ? "yes" : "no");
    else
        retex_number_text(statement->number, text);
}

/* A set has a picture whatever is in it. */
static int bind(RetexKeyed *statement, const RetexSet *set, RetexError *err)
{
    (void)statement, (void)set, (void)err;
    return RETEX_OK;
}

static const RetexKeyed *find(const RetexEdit *edit, const char *word)
{
    return retex_keyed_find(&edit->keyed[RETEX_EDIT_PICTURE], word);
}

int retex_edit_develop(const RetexEdit *edit, RetexDevelop *develop, RetexError *err)
{
    const RetexKeyed *exposure = find(edit, EXPOSURE), *white = find(edit, WHITE_BALANCE);
    const RetexKeyed *automatic = find(edit, AUTO_EXPOSURE);
    RetexDevelop own = RETEX_DEVELOP_INIT;
    const int code = RETEX_PARAMS_COPY(&own, develop, err);
    if (code)
        return code;
    own.exposure = exposure ? exposure->number : own.exposure;
    own.white_balance = white ? white->number : own.white_balance;
    own.auto_exposure = automatic ? automatic->number != 0 : own.auto_exposure;
    return RETEX_PARAMS_RETURN(develop, &own, err);
}

const char *retex_edit_view(const RetexEdit *edit)
{
    const RetexKeyed *view = find(edit, VIEW);
    return view ? view->view : NULL;
}

const RetexKeyedKind retex_keyed_picture = {
    .word = "picture",
    .form = "KEY=VALUE",
    .expected = "exposure, white-balance, auto-exposure or view, and its value",
    .names = "a key has",
    .many = {"values for", "keys of the picture"},
    .most = WORDS,
    .parse = parse,
    .write = write,
    .bind = bind,
};
