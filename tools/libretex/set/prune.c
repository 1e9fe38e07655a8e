/* Removes terms, footprints and parts of a set that are empty, or lamps. */
#include <limits.h>
#include <string.h>

#include <retex/host/denoise_data.h>
#include <retex/host/set_build.h>
#include <retex/set.h>

#include "set/manifest.h"
#include "set/parts.h"
#include "set/signals.h"

#define GONE INT_MIN /* marks a footprint or mixture that is removed */

typedef struct Pruning {
    RetexSet *set;
    const char *empty;
    char stays[RETEX_SET_PARTS_MAX];
    int footprints[RETEX_SET_FOOTPRINTS_MAX]; /* the new number of each, or GONE */
    RetexFactor mixtures[RETEX_MIXTURES_MAX]; /* what each becomes; index GONE: nothing */
} Pruning;

static void drop(Pruning *p, int part)
{
    if (part >= 0)
        p->stays[part] = 0;
}

static void prune_footprints(Pruning *p)
{
    RetexSet *set = p->set;
    int count = 0;

    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *footprint = &set->footprints[i];
        p->footprints[i] = count;
        if (footprint->uv >= 0 && p->empty[footprint->uv]) {
            p->footprints[i] = GONE;
            drop(p, footprint->uv);
            drop(p, footprint->spread);
            drop(p, footprint->albedo);
        } else {
            set->footprints[count++] = *footprint;
        }
    }
    set->nfootprints = count;
}

static void prune_shares(Pruning *p, RetexMixture *mixture)
{
    int count = 0;

    for (int k = 0; k < mixture->nshares; k++) {
        const int footprint = p->footprints[mixture->shares[k].footprint];
        if (footprint != GONE)
            mixture->shares[count++] = (struct RetexShare){footprint, mixture->shares[k].weight};
    }
    mixture->nshares = count;
}

/* Keeps weights where a mixture remains that needs them; weights of interreflections are always kept. */
static void prune_mixtures(Pruning *p)
{
    RetexSet *set = p->set;
    int count = 0;

    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            drop(p, set->mixtures[m].shares[k].weight);
    for (int m = 0; m < set->nmixtures; m++) {
        RetexMixture *mixture = &set->mixtures[m];
        prune_shares(p, mixture);
        for (int k = 0; k < mixture->nshares; k++)
            p->stays[mixture->shares[k].weight] |=
                mixture->nshares > 1 ||
                set->footprints[mixture->shares[k].footprint].kind == RETEX_FOOTPRINT_INTERREFLECTION;
        p->mixtures[m] = mixture->nshares == 1 ? retex_factor(RETEX_FACTOR_FOOTPRINT, mixture->shares[0].footprint)
                                               : retex_factor(RETEX_FACTOR_MIXTURE, mixture->nshares ? count : GONE);
        if (mixture->nshares > 1)
            set->mixtures[count++] = *mixture;
    }
    set->nmixtures = count;
}

/* Renumbers the factors of a term; 0 where one is removed. */
static int prune_factors(const Pruning *p, RetexTerm *term)
{
    for (int k = 0; k < term->nfactors; k++) {
        RetexFactor *factor = &term->factors[k];
        const RetexFactorKind kind = factor->kind;
        const RetexQuantity quantity = factor->quantity;
        if (kind == RETEX_FACTOR_FOOTPRINT)
            factor->index = p->footprints[factor->index];
        else if (kind == RETEX_FACTOR_MIXTURE)
            *factor = p->mixtures[factor->index], factor->quantity = quantity;
        if (retex_factor_is_texture(*factor) && factor->index == GONE)
            return 0;
    }
    return 1;
}

/* Whether a term is 0: of its radiance or an image. Terms without textures stay, as the set needs one. */
static int is_empty(const Pruning *p, const RetexTerm *term)
{
    const int image = retex_term_image(term);
    return (retex_term_hits(term) || term->role == RETEX_ROLE_CORRECTION) &&
           (p->empty[term->radiance] || (image >= 0 && p->empty[image]));
}

static void prune_terms(Pruning *p)
{
    RetexSet *set = p->set;
    int count = 0;

    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        if (is_empty(p, term) || !prune_factors(p, term)) {
            drop(p, term->radiance);
            drop(p, retex_term_image(term));
        } else {
            set->terms[count++] = *term;
        }
    }
    set->nterms = count;
}

/* Removes noise parts of signals without terms; the beauty's stays where there are no terms. */
static void prune_noise(Pruning *p)
{
    RetexSet *set = p->set;
    char name[RETEX_NAME_MAX];

    for (int i = 1; i < set->nparts; i++)
        if (retex_name_is_noise(set->parts[i].name))
            p->stays[i] = 0;
    for (int t = 0; t < set->nterms || (t == 0 && !set->nterms); t++) {
        if (set->nterms && set->terms[t].role == RETEX_ROLE_PICTURE)
            continue;
        retex_signal_noise_name(set, set->nterms ? &set->terms[t] : NULL, name);
        const int part = retex_set_find_part(set, name);
        if (part > 0)
            p->stays[part] = 1;
    }
}

void retex_set_prune(RetexSet *set, const char *empty)
{
    Pruning p = {.set = set, .empty = empty};

    memset(p.stays, 1, sizeof p.stays);
    prune_footprints(&p);
    prune_mixtures(&p);
    prune_terms(&p);
    prune_noise(&p);
    for (int i = set->nparts - 1; i > 0; i--)
        if (!p.stays[i] && !retex_part_is_used(set, i)) /* a part may have been shared */
            retex_set_remove_part(set, i);
}

/* ---- lamps ---- */

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
    if (retex_set_has_finishes(set))
        return retex_fail(err, RETEX_EINVAL, "a set with finishes keeps them as lamps, which cannot be left out");
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
