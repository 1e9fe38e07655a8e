/* Terms, factors and parameters: their names in the manifest, and small questions about them. */
#include <string.h>

#include <retex/host/set_build.h>

#include "set/set.h"

const char *retex_footprint_kind_name(int kind)
{
    static const char *const names[RETEX_FOOTPRINT_KINDS] = {"hit", "sharp", "broad", "interreflection"};

    return names[kind];
}

const char *retex_role_name(int role)
{
    static const char *const names[RETEX_ROLES] = {"full",       "indep",   "dep",   "cross2",
                                                   "cross3",     "sharp",   "broad", "interreflection",
                                                   "correction", "picture", "lamp",  "lamp_picture"};

    return names[role];
}

const char *retex_factor_kind_name(int kind)
{
    static const char *const names[RETEX_FACTOR_KINDS] = {"footprint", "mixture", "image", "parameter"};

    return names[kind];
}

const char *retex_quantity_name(int quantity)
{
    static const char *const names[RETEX_QUANTITIES] = {"color", "further"};

    return names[quantity];
}

const char *retex_parameter_kind_name(int kind)
{
    static const char *const names[RETEX_PARAMETER_KINDS] = {"color", "correction"};

    return names[kind];
}

int retex_term_hits(const RetexTerm *term)
{
    int count = 0;

    for (int k = 0; k < term->nfactors; k++)
        count += retex_factor_is_hit(term->factors[k]);
    return count;
}

int retex_term_image(const RetexTerm *term)
{
    for (int k = 0; k < term->nfactors; k++)
        if (term->factors[k].kind == RETEX_FACTOR_IMAGE)
            return term->factors[k].index;
    return -1;
}

int retex_term_add_factor(RetexTerm *term, RetexFactor factor, RetexError *err)
{
    if (term->nfactors == RETEX_MAX_FACTORS)
        return retex_fail(err, RETEX_ELIMIT, "a term has at most %d factors", RETEX_MAX_FACTORS);
    term->factors[term->nfactors++] = factor;
    return RETEX_OK;
}

int retex_set_find_parameter(const RetexSet *set, const char *name)
{
    for (int i = 0; i < set->nparameters; i++)
        if (strcmp(set->parameters[i].name, name) == 0)
            return i;
    return -1;
}

int retex_set_term_lamp(const RetexSet *set, const RetexTerm *term)
{
    int lamp = -1;

    if (term->role != RETEX_ROLE_LAMP && term->role != RETEX_ROLE_LAMP_PICTURE && term->role != RETEX_ROLE_CORRECTION)
        return -1;
    for (int k = 0; k < term->nfactors && lamp < 0; k++)
        if (term->factors[k].kind == RETEX_FACTOR_PARAMETER &&
            set->parameters[term->factors[k].index].kind == RETEX_PARAMETER_COLOR)
            lamp = term->factors[k].index;
    return term->role != RETEX_ROLE_CORRECTION || retex_set_has_role(set, RETEX_ROLE_LAMP) ? lamp : -1;
}

int retex_set_has_finishes(const RetexSet *set)
{
    int finishes = 0;

    for (int t = 0; t < set->ntargets; t++)
        finishes |= set->targets[t].nfinishes > 0;
    return finishes;
}

const char *retex_parameter_lamp(const RetexSet *set, int parameter)
{
    const RetexParameter *p = &set->parameters[parameter];

    if (p->kind != RETEX_PARAMETER_COLOR)
        return NULL;
    if (!retex_set_has_finishes(set))
        return p->name;
    for (int t = 0; t < set->ntargets; t++)
        if (p->finishes[t])
            return NULL;
    return p->lamp[0] ? p->lamp : NULL;
}

int retex_set_has_lamps(const RetexSet *set)
{
    int lamps = 0;

    for (int i = 0; i < set->nparameters; i++)
        lamps |= retex_parameter_lamp(set, i) != NULL;
    return lamps;
}

int retex_set_has_role(const RetexSet *set, RetexRole role)
{
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].role == role)
            return 1;
    return 0;
}
