/* What an edit makes of a set's parameters: see retex/edit.h. */
#include <retex/edit.h>

#include <stdlib.h>
#include <string.h>

#include "edit/edit.h"
#include "edit/finishes.h"
#include "edit/lights.h"
#include "set/set.h"

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
        same &= !light->finishes[t] || light->finishes[t] == retex_edit_finish_of(edit, &set->targets[t]);
    return same;
}

static int light_value(const RetexEdit *edit, const RetexSet *set, const RetexParameter *light, float value[3],
                       RetexError *err)
{
    static const float white[3] = {1, 1, 1};
    const int has_name = !retex_set_has_finishes(set) || light->lamp[0];
    const RetexParameter *lamp = !retex_set_has_finishes(set) ? light : has_name ? lamp_of(set, light) : NULL;
    const RetexLampValue *said =
        lamp ? retex_edit_light_of(edit, retex_parameter_lamp(set, (int)(lamp - set->parameters))) : NULL;
    memcpy(value, lamp ? lamp->value : white, sizeof white);
    const int code = said ? retex_lamp_value_apply(value, said, lamp, err) : RETEX_OK;
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
