/* The statements of an edit about lamps: see retex/edit.h. */
#include "edit/lights.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edit/edit.h"
#include "edit/finishes.h"
#include "set/set.h"

#define PREFIX "light:"
#define OTHERS "*"

const char *retex_edit_key_lamp(const char *key)
{
    return strncmp(key, PREFIX, strlen(PREFIX)) == 0 ? key + strlen(PREFIX) : NULL;
}

/* The place of a lamp among the lights; *there: 1 if it has a value. */
static int place_of(const RetexEdit *edit, const char *lamp, int *there)
{
    int at = 0, order = 1;
    while (at < edit->nlights && (order = strcmp(edit->lights[at].lamp, lamp)) < 0)
        at++;
    *there = at < edit->nlights && order == 0;
    return at;
}

static int insert(RetexEdit *edit, const char *lamp, const RetexLampValue *value, RetexError *err)
{
    int there, at = place_of(edit, lamp, &there);
    if (there)
        return retex_fail(err, RETEX_EPARSE, "light:%s is given twice", lamp);
    if (edit->nlights == RETEX_EDIT_LIGHTS_MAX)
        return retex_fail(err, RETEX_EPARSE, "values for more than %d lamps", RETEX_EDIT_LIGHTS_MAX);
    memmove(edit->lights + at + 1, edit->lights + at, (size_t)(edit->nlights++ - at) * sizeof *edit->lights);
    edit->lights[at] = (RetexEditLight){.value = *value};
    snprintf(edit->lights[at].lamp, sizeof edit->lights[at].lamp, "%s", lamp);
    return RETEX_OK;
}

int retex_edit_add_light(RetexEdit *edit, const char *lamp, const char *value, RetexError *err)
{
    RetexLampValue parsed;
    if (!*lamp || strlen(lamp) >= sizeof edit->lights->lamp)
        return retex_fail(err, RETEX_EPARSE, "`light:%.40s`: a lamp's name has 1 to %d bytes", lamp,
                          (int)sizeof edit->lights->lamp - 1);
    const int code = retex_lamp_value_parse(&parsed, value, err);
    return code ? code : insert(edit, lamp, &parsed, err);
}

int retex_edit_light(RetexEdit *edit, const char *arg, RetexError *err)
{
    char lamp[RETEX_NAME_MAX + 1];
    const char *equals = arg ? strrchr(arg, '=') : NULL;
    if (!equals || equals == arg || !equals[1])
        return retex_fail(err, RETEX_EPARSE, "light '%s': expected NAME=VALUE, a lamp and a number, colour or kelvins",
                          arg ? arg : "");
    snprintf(lamp, sizeof lamp, "%.*s", (int)(equals - arg), arg);
    return retex_edit_add_light(edit, lamp, equals + 1, err);
}

int retex_edit_solo(RetexEdit *edit, const char *lamp, RetexError *err)
{
    RetexEdit next = *edit;
    int there, code = RETEX_OK;
    place_of(&next, OTHERS, &there);
    if (!there)
        code = retex_edit_add_light(&next, OTHERS, "0", err);
    place_of(&next, lamp, &there);
    if (!code && !there)
        code = retex_edit_add_light(&next, lamp, "1", err);
    if (!code)
        *edit = next;
    return code;
}

int retex_edit_lights(const RetexEdit *edit)
{
    return edit->nlights + edit->nfinishes;
}

int retex_edit_complete_lights(RetexEdit *edit, const RetexEdit *from, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK;
    for (int i = 0; i < from->nlights && !code; i++) {
        int there;
        place_of(&next, from->lights[i].lamp, &there);
        if (!there)
            code = insert(&next, from->lights[i].lamp, &from->lights[i].value, err);
    }
    if (!code)
        code = retex_edit_complete_finishes(&next, from, err);
    if (!code)
        *edit = next;
    return code;
}

/* ---- the lamps that there are ---- */

int retex_edit_bind_lamps(RetexEdit *edit, const RetexSet *set, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK;
    next.nlights = 0;
    for (int i = 0; i < edit->nlights && !code; i++) {
        const char *name = edit->lights[i].lamp;
        int lamp = -1;
        if (strcmp(name, OTHERS) != 0 || !retex_set_has_lamps(set))
            code = retex_lamp_find(&lamp, set, name, err);
        if (!code)
            code = insert(&next, lamp < 0 ? name : retex_parameter_lamp(set, lamp), &edit->lights[i].value, err);
    }
    if (!code)
        code = retex_edit_bind_finishes(&next, set, err);
    if (!code)
        *edit = next;
    return code;
}

/* The parameter that has the value of a lamp, if another one is of its light with a finish. */
static const RetexParameter *lamp_of(const RetexSet *set, const RetexParameter *light)
{
    for (int i = 0; i < set->nparameters; i++)
        if (retex_parameter_lamp(set, i) && strcmp(retex_parameter_lamp(set, i), light->lamp) == 0)
            return &set->parameters[i];
    return NULL;
}

/* Whether light met targets with the finishes that the edit has. */
static int has_finishes(const RetexEdit *edit, const RetexSet *set, const RetexParameter *light)
{
    int same = 1;
    for (int t = 0; t < set->ntargets; t++)
        same &= !light->finishes[t] || light->finishes[t] == 1 + retex_edit_finish_of(edit, &set->targets[t]);
    return same;
}

static int light_value(const RetexEdit *edit, const RetexSet *set, const RetexParameter *light, float value[3],
                       RetexError *err)
{
    static const float white[3] = {1, 1, 1};
    const int has_name = !retex_set_has_finishes(set) || light->lamp[0];
    const RetexParameter *lamp = !retex_set_has_finishes(set) ? light : has_name ? lamp_of(set, light) : NULL;
    int there = 0, at = lamp ? place_of(edit, retex_parameter_lamp(set, (int)(lamp - set->parameters)), &there) : 0;
    if (lamp && !there)
        at = place_of(edit, OTHERS, &there);
    memcpy(value, lamp ? lamp->value : white, sizeof white);
    const int code = there ? retex_lamp_value_apply(value, &edit->lights[at].value, lamp, err) : RETEX_OK;
    if (!has_finishes(edit, set, light))
        memset(value, 0, sizeof white);
    return code;
}

int retex_edit_parameters(const RetexEdit *edit, const RetexSet *set, float *values, RetexError *err)
{
    RetexEdit *bound = malloc(sizeof *bound);
    int code = bound ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for an edit");
    if (!code) {
        *bound = *edit;
        code = retex_edit_bind_lamps(bound, set, err);
    }
    for (int i = 0; i < set->nparameters && !code; i++)
        if (set->parameters[i].kind == RETEX_PARAMETER_COLOR)
            code = light_value(bound, set, &set->parameters[i], values + 3 * i, err);
        else
            memcpy(values + 3 * i, set->parameters[i].value, sizeof set->parameters[i].value);
    free(bound);
    return code;
}
