/* The statements of an edit about lamps: see retex/edit.h. */
#include "edit/lights.h"

#include <string.h>

#include "edit/edit.h"
#include "set/set.h"

#define OTHERS "*"

int retex_edit_light(RetexEdit *edit, const char *arg, RetexError *err)
{
    return retex_keyed_option(&edit->keyed[RETEX_EDIT_LIGHTS], &retex_keyed_light, arg, err);
}

int retex_edit_solo(RetexEdit *edit, const char *lamp, RetexError *err)
{
    RetexKeyedList next = edit->keyed[RETEX_EDIT_LIGHTS];
    int code = RETEX_OK;
    if (!retex_keyed_find(&next, OTHERS))
        code = retex_keyed_add(&next, &retex_keyed_light, OTHERS, "0", err);
    if (!code && !retex_keyed_find(&next, lamp))
        code = retex_keyed_add(&next, &retex_keyed_light, lamp, "1", err);
    if (!code)
        edit->keyed[RETEX_EDIT_LIGHTS] = next;
    return code;
}

static int parse(RetexKeyed *statement, const char *text, RetexError *err)
{
    return retex_lamp_value_parse(&statement->light, text, err);
}

static void write(const RetexKeyed *statement, char text[RETEX_KEYED_TEXT_MAX])
{
    retex_lamp_value_text(&statement->light, text);
}

static int bind(RetexKeyed *statement, const RetexSet *set, RetexError *err)
{
    int lamp, code = RETEX_OK;
    if (strcmp(statement->name, OTHERS) != 0 || !retex_set_has_lamps(set)) {
        code = retex_lamp_find(&lamp, set, statement->name, err);
        if (!code)
            strcpy(statement->name, retex_parameter_lamp(set, lamp));
    }
    return code;
}

const RetexLampValue *retex_edit_light_of(const RetexEdit *edit, const char *lamp)
{
    const RetexKeyedList *lights = &edit->keyed[RETEX_EDIT_LIGHTS];
    const RetexKeyed *own = retex_keyed_find(lights, lamp), *said = own ? own : retex_keyed_find(lights, OTHERS);
    return said ? &said->light : NULL;
}

const RetexKeyedKind retex_keyed_light = {
    .word = "light",
    .form = "LAMP=VALUE",
    .expected = "a lamp and a number, colour or kelvins",
    .names = "a lamp's name has",
    .many = {"values for", "lamps"},
    .most = RETEX_KEYED_MAX,
    .parse = parse,
    .write = write,
    .bind = bind,
};
