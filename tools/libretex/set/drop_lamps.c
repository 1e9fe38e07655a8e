/* Removes what a set has about lamps: see <retex/host/set_build.h>. */
#include <string.h>

#include <retex/host/set_build.h>

#include "set/manifest.h"
#include "set/parts.h"
#include "set/signals.h"

enum { GONE = -1 };

static void drop_noise(RetexSet *set)
{
    for (int t = 0; t < set->nterms; t++) {
        char name[RETEX_NAME_MAX];
        if (retex_set_term_lamp(set, &set->terms[t]) < 0)
            continue;
        retex_signal_noise_name(set, &set->terms[t], name);
        const int noise = retex_set_find_part(set, name);
        if (noise > 0)
            retex_set_remove_part(set, noise);
    }
}

/* Terms of lamps, and the mixtures that no other term has. parameters: their new numbers. */
static void drop_terms(RetexSet *set, const int *parameters)
{
    int mixtures[RETEX_MIXTURES_MAX] = {0}, count = 0;
    char gone[RETEX_SET_TERMS_MAX];
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        gone[t] = (char)(retex_set_term_lamp(set, term) >= 0);
        for (int k = 0; k < term->nfactors && !gone[t]; k++)
            if (term->factors[k].kind == RETEX_FACTOR_MIXTURE)
                mixtures[term->factors[k].index] = 1;
    }
    for (int m = 0; m < set->nmixtures; m++) {
        if (mixtures[m])
            set->mixtures[count] = set->mixtures[m];
        mixtures[m] = mixtures[m] ? count++ : GONE;
    }
    set->nmixtures = count;
    count = 0;
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        if (gone[t])
            continue;
        for (int k = 0; k < term->nfactors; k++) {
            RetexFactor *factor = &term->factors[k];
            factor->index = factor->kind == RETEX_FACTOR_MIXTURE     ? mixtures[factor->index]
                            : factor->kind == RETEX_FACTOR_PARAMETER ? parameters[factor->index]
                                                                     : factor->index;
        }
        set->terms[count++] = *term;
    }
    set->nterms = count;
}

int retex_set_drop_lamps(RetexSet *set, RetexError *err)
{
    int parameters[RETEX_PARAMETERS_MAX], count = 0;
    char used[RETEX_SET_PARTS_MAX];
    if (!retex_set_has_role(set, RETEX_ROLE_LAMP))
        return RETEX_OK;
    for (int i = 0; i < set->nparameters; i++) {
        const RetexParameter *parameter = &set->parameters[i];
        if (parameter->kind == RETEX_PARAMETER_COLOR &&
            memcmp(parameter->kept, parameter->value, sizeof parameter->kept) != 0)
            return retex_fail(err, RETEX_EINVAL,
                              "the lamp %s is off in the picture, which only a set with lamps can tell",
                              parameter->name);
        parameters[i] = parameter->kind == RETEX_PARAMETER_COLOR ? GONE : count++;
    }
    drop_noise(set);
    for (int i = 0; i < set->nparts; i++)
        used[i] = (char)retex_part_is_used(set, i);
    drop_terms(set, parameters);
    for (int i = 0; i < set->nparameters; i++)
        if (parameters[i] != GONE)
            set->parameters[parameters[i]] = set->parameters[i];
    set->nparameters = count;
    for (int i = set->nparts - 1; i > 0; i--)
        if (used[i] && !retex_part_is_used(set, i))
            retex_set_remove_part(set, i);
    return RETEX_OK;
}
