/* --light and --solo: the scene with other values of its lamps, as retex-combine has them. */
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <retex/edit.h>
#include <retex/host/set_build.h>
#include "retex-render.h"

static void add_lamp(Arguments *a, const char *name)
{
    for (int k = 0; k < a->nlamps; k++)
        if (strcasecmp(a->lamps[k], name) == 0)
            return;
    if (a->nlamps < LIST_MAX && strcasecmp(name, "rest") != 0)
        a->lamps[a->nlamps++] = name;
}

void name_lamps(Arguments *a)
{
    static char names[LIST_MAX][RETEX_NAME_MAX];
    a->lamps_by_light = (a->nlights || a->solo) && !a->nlamps && !a->each_lamp;
    for (int k = 0; k < a->nlights && a->lamps_by_light; k++) {
        const char *equals = strchr(a->lights[k], '=');
        const size_t length = equals ? (size_t)(equals - a->lights[k]) : 0;
        if (length == 0 || length >= RETEX_NAME_MAX)
            continue; /* light_lamps says what is wrong */
        snprintf(names[k], RETEX_NAME_MAX, "%.*s", (int)length, a->lights[k]);
        add_lamp(a, names[k]);
    }
    if (a->solo && a->lamps_by_light)
        add_lamp(a, a->solo);
}

/* A set of parameters only, as edits know lamps. */
static int make_parameters(RetexSet **set, const Scene *scene, RetexError *err)
{
    int code = retex_set_create(set, 1, 1, err);
    for (int l = 0; l < scene->nlamps && !code; l++) {
        const RetexParameter parameter = lamp_parameter(&scene->lamps[l]);
        code = retex_set_add_parameter(*set, &parameter, NULL, err);
    }
    return code;
}

int light_lamps(const Arguments *a, Scene *scene, RetexError *err)
{
    RetexEdit *edit = NULL;
    RetexSet *set = NULL;
    float values[LAMPS_MAX + 1][3];
    if (!a->nlights && !a->solo)
        return RETEX_OK;
    int code = retex_edit_create(&edit, err);
    for (int k = 0; k < a->nlights && !code; k++)
        code = retex_edit_light(edit, a->lights[k], err);
    if (!code && a->solo)
        code = retex_edit_solo(edit, a->solo, err);
    if (!code)
        code = make_parameters(&set, scene, err);
    if (!code)
        code = retex_edit_parameters(edit, set, values[0], err);
    if (!code)
        lamp_args_warn(a->cli, set, values[0]);
    for (int l = 0; l < scene->nlamps && !code; l++)
        scene_light_lamp(&scene->lamps[l], rgb(values[l][0], values[l][1], values[l][2]), !a->lamps_by_light);
    retex_set_close(&set);
    retex_edit_close(&edit);
    return code;
}
