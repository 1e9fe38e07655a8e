/* See unknowns.h. */
#include "solve/unknowns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>

#include "edit/edit.h"
#include "set/laid.h"
#include "set/set.h"

/* ---- the list ---- */

static const struct {
    const char *prefix;
    RetexUnknownKind kind;
} kinds[] = {{"light:", RETEX_UNKNOWN_LAMP},
             {"color:", RETEX_UNKNOWN_LAMP_COLOR},
             {"finish:", RETEX_UNKNOWN_FINISH},
             {"", RETEX_UNKNOWN_COLOR}};

static int is_lamp(RetexUnknownKind kind)
{
    return kind == RETEX_UNKNOWN_LAMP || kind == RETEX_UNKNOWN_LAMP_COLOR;
}

static int is_given(const RetexSolveModel *m, int target)
{
    return m->textures[target] != NULL || retex_target_has_laid(m->set, target);
}

static int find_name(RetexUnknown *unknown, int *index, const RetexSet *set, const char *name, RetexError *err)
{
    RetexTargetNames names;
    if (is_lamp(unknown->kind)) {
        const int code = retex_lamp_find(index, set, name, err);
        if (!code)
            strcpy(unknown->name, retex_parameter_lamp(set, *index));
        return code;
    }
    retex_set_target_names(&names, set);
    int code = retex_target_find(index, &names, name, err);
    if (code)
        return code;
    strcpy(unknown->name, set->targets[*index].name);
    if (unknown->kind == RETEX_UNKNOWN_FINISH &&
        (!set->targets[*index].nfinishes || set->targets[*index].normal_tilt > 0))
        code = retex_fail(err, RETEX_ENOTFOUND, "the set has no finishes of '%s' to choose from", unknown->name);
    return code;
}

static int add_unknown(RetexSolution *s, const RetexSolveModel *m, RetexUnknownKind kind, const char *name,
                       RetexError *err)
{
    RetexUnknown unknown = {.kind = kind};
    int index, code = find_name(&unknown, &index, m->set, name, err);
    if (code)
        return code;
    if (s->count == RETEX_SOLVE_LIST_MAX)
        return retex_fail(err, RETEX_EINVAL, "more than %d colours, lamps and finishes are sought",
                          RETEX_SOLVE_LIST_MAX);
    for (int i = 0; i < s->count; i++)
        if (s->index[i] == index && (s->unknowns[i].kind == kind || (is_lamp(kind) && is_lamp(s->unknowns[i].kind))))
            return retex_fail(err, RETEX_EINVAL, "'%s' is sought twice", unknown.name);
    if (kind == RETEX_UNKNOWN_COLOR && is_given(m, index))
        return retex_fail(err, RETEX_EINVAL, "target '%s' is sought, but has a texture", unknown.name);
    s->index[s->count] = index;
    s->column[s->count] = -1;
    s->unknowns[s->count++] = unknown;
    return RETEX_OK;
}

static int parse_list(RetexSolution *s, const RetexSolveModel *m, const char *list, RetexError *err)
{
    int code = RETEX_OK;
    for (int more = 1; more && !code;) {
        char word[RETEX_NAME_MAX + 16];
        const size_t length = strcspn(list, ",");
        int k = 0;
        if (!length || length >= sizeof word)
            return retex_fail(
                err, RETEX_EPARSE,
                "what is sought: expected TARGET, light:LAMP, color:LAMP or finish:TARGET, divided by commas");
        memcpy(word, list, length);
        word[length] = '\0';
        while (strncmp(word, kinds[k].prefix, strlen(kinds[k].prefix)) != 0)
            k++;
        code = add_unknown(s, m, kinds[k].kind, word + strlen(kinds[k].prefix), err);
        more = list[length] == ',';
        list += length + 1;
    }
    return code;
}

static int add_all_targets(RetexSolution *s, const RetexSolveModel *m, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < m->set->ntargets && !code; t++)
        if (!is_given(m, t))
            code = add_unknown(s, m, RETEX_UNKNOWN_COLOR, m->set->targets[t].name, err);
    return code || s->count
               ? code
               : retex_fail(err, RETEX_EINVAL, "nothing is sought: the set has no target without a texture");
}

/* Refuses lamps and finishes that are both sought and given. */
static int check_lights(const RetexSolution *s, const RetexSet *set, const RetexEdit *lights, RetexError *err)
{
    RetexEdit *bound = lights ? malloc(sizeof *bound) : NULL;
    if (!lights)
        return RETEX_OK;
    if (!bound)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for an edit");
    *bound = *lights;
    int code = retex_edit_bind_lamps(bound, set, err);
    for (int i = 0; i < s->count && !code; i++) {
        const RetexUnknown *u = &s->unknowns[i];
        const int list = is_lamp(u->kind)                  ? RETEX_EDIT_LIGHTS
                         : u->kind == RETEX_UNKNOWN_FINISH ? RETEX_EDIT_FINISHES
                                                           : -1;
        if (list >= 0 && retex_keyed_find(&bound->keyed[list], u->name))
            code = retex_fail(err, RETEX_EINVAL, "%s of '%s' is both sought and given",
                              is_lamp(u->kind) ? "the light" : "the finish", u->name);
    }
    free(bound);
    return code;
}

/* Gives the unknowns of some kinds, or all lamps, their columns and numbers. */
static void add_columns(RetexSolution *s, RetexSolveModel *m, int lamps, int *numbers)
{
    for (int i = 0; i < s->count && m->ncolumns < RETEX_UNKNOWNS_MAX; i++) {
        const RetexUnknown *u = &s->unknowns[i];
        if (u->kind == RETEX_UNKNOWN_FINISH || is_lamp(u->kind) != lamps)
            continue;
        RetexSolveColumn *column = &m->columns[m->ncolumns];
        s->column[i] = m->ncolumns++;
        *column = (RetexSolveColumn){.target = lamps ? -1 : s->index[i]};
        if (lamps)
            strcpy(column->lamp, u->name);
        for (int c = 0; c < 3; c++)
            column->number[c] = u->kind == RETEX_UNKNOWN_LAMP ? *numbers : *numbers + c;
        *numbers += u->kind == RETEX_UNKNOWN_LAMP ? 1 : 3;
    }
}

int retex_unknowns_open(RetexSolution *s, RetexSolveModel *m, const RetexSolveParams *params, int *numbers,
                        RetexError *err)
{
    int code = params->unknowns ? parse_list(s, m, params->unknowns, err) : add_all_targets(s, m, err), sought = 0;
    if (!code)
        code = check_lights(s, m->set, params->lights, err);
    if (code)
        return code;
    s->combinations = 1;
    for (int i = 0; i < s->count; i++)
        if (s->unknowns[i].kind == RETEX_UNKNOWN_FINISH)
            s->combinations *= m->set->targets[s->index[i]].nfinishes;
        else
            sought++;
    if (s->combinations > RETEX_SOLVE_FINISHES_MAX)
        return retex_fail(err, RETEX_EINVAL, "%d combinations of finishes are more than %d", s->combinations,
                          RETEX_SOLVE_FINISHES_MAX);
    if (sought > RETEX_UNKNOWNS_MAX)
        return retex_fail(err, RETEX_EINVAL, "more than %d colours and lamps are sought", RETEX_UNKNOWNS_MAX);
    *numbers = 0;
    add_columns(s, m, 0, numbers);
    add_columns(s, m, 1, numbers);
    return RETEX_OK;
}

/* ---- finishes and lamps ---- */

int retex_unknowns_finish(const RetexSolution *s, const RetexSet *set, int unknown, int combination)
{
    for (int i = 0; i < unknown; i++)
        if (s->unknowns[i].kind == RETEX_UNKNOWN_FINISH)
            combination /= set->targets[s->index[i]].nfinishes;
    return combination % set->targets[s->index[unknown]].nfinishes;
}

static int add_statement(RetexEdit *edit, const char *kind, const char *name, const char *value, RetexError *err)
{
    char key[RETEX_NAME_MAX + 16];
    snprintf(key, sizeof key, "%s%s", kind, name);
    return retex_edit_set(edit, key, value, err);
}

int retex_unknowns_parameters(const RetexSolution *s, const RetexSet *set, const RetexEdit *lights, int combination,
                              float *parameters, RetexError *err)
{
    RetexEdit *edit = NULL;
    char unit[32];
    int code = retex_edit_create(&edit, err);
    for (int i = 0; i < s->count && !code; i++) {
        const RetexUnknown *u = &s->unknowns[i];
        snprintf(unit, sizeof unit, "%d%s", RETEX_SOLVE_LAMP_UNIT, u->kind == RETEX_UNKNOWN_LAMP ? "" : "*white");
        if (is_lamp(u->kind))
            code = add_statement(edit, "light:", u->name, unit, err);
        else if (u->kind == RETEX_UNKNOWN_FINISH)
            code =
                add_statement(edit, "finish:", u->name,
                              set->targets[s->index[i]].finishes[retex_unknowns_finish(s, set, i, combination)], err);
    }
    if (!code && lights)
        code = retex_edit_complete_lights(edit, lights, err);
    if (!code)
        code = retex_edit_parameters(edit, set, parameters, err);
    retex_edit_close(&edit);
    return code;
}

/* ---- what was found ---- */

const RetexUnknown *retex_solution_unknown(const RetexSolution *s, int index)
{
    return index >= 0 && index < s->count ? &s->unknowns[index] : NULL;
}

void retex_solution_close(RetexSolution **solution)
{
    if (solution) {
        free(*solution);
        *solution = NULL;
    }
}

int retex_solution_edit(const RetexSolution *s, RetexEdit *edit, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < s->count && !code; i++) {
        const RetexUnknown *u = &s->unknowns[i];
        const double *v = u->value, strength = retex_luminance(v[0], v[1], v[2]);
        char value[RETEX_LAMP_TEXT_MAX];
        if (!u->seen)
            continue;
        snprintf(value, sizeof value, "rgb(%.4g,%.4g,%.4g)", v[0], v[1], v[2]);
        if (u->kind == RETEX_UNKNOWN_LAMP)
            snprintf(value, sizeof value, "%.4g", v[0]);
        else if (u->kind == RETEX_UNKNOWN_LAMP_COLOR && strength > 0)
            snprintf(value, sizeof value, "%.4g*rgb(%.4g,%.4g,%.4g)", strength, v[0] / strength, v[1] / strength,
                     v[2] / strength);
        if (u->kind == RETEX_UNKNOWN_COLOR)
            code = retex_edit_cell(edit, u->name, value, err);
        else if (u->kind == RETEX_UNKNOWN_FINISH)
            code = add_statement(edit, "finish:", u->name, u->finish, err);
        else
            code = add_statement(edit, "light:", u->name, value, err);
    }
    return code;
}
