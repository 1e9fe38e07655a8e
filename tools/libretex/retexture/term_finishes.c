/* See term_finishes.h. */
#include "retexture/term_finishes.h"

#include <string.h>

#include <retex/host/assert.h>

#include "set/set.h"
#include "texture/pyramid.h"

/* ---- which targets have maps ---- */

/* The finishes that a target's texture, or the one that is laid on it, tells apart; 0: it has no map. */
static int count_mapped(const RetexView *view, int target)
{
    const RetexTexture *texture = view->textures ? view->textures[target] : NULL;
    if (texture)
        return retex_texture_has_finishes(texture);
    return view->set->targets[target].gates ? view->set->targets[target].nfinishes : 0;
}

int retex_view_find_maps(RetexView *view, const float *parameters, RetexError *err)
{
    const RetexSet *set = view->set;
    for (int t = 0; t < set->ntargets; t++) {
        view->mapped[t] = count_mapped(view, t);
        view->shown[t] = set->targets[t].finish - 1;
        if (view->mapped[t] && view->mapped[t] != set->targets[t].nfinishes)
            return retex_fail(err, RETEX_EINVAL, "a map of %d finishes for %s, which has %d", view->mapped[t],
                              set->targets[t].name, set->targets[t].nfinishes);
        for (int i = 0; i < set->nparameters && parameters; i++) {
            const float *value = parameters + 3 * i;
            if (set->parameters[i].finishes[t] && (value[0] != 0 || value[1] != 0 || value[2] != 0))
                view->shown[t] = set->parameters[i].finishes[t] - 1;
        }
    }
    return RETEX_OK;
}

/* ---- parameters ---- */

/* Whether two parameters are of the same light but for the finishes of targets with maps. */
static int differ_by_maps(const RetexView *view, const RetexParameter *a, const RetexParameter *b)
{
    int same = a->kind == b->kind && strcmp(a->lamp, b->lamp) == 0;
    for (int t = 0; t < view->set->ntargets && same; t++)
        same = view->mapped[t] && a->finishes[t] ? b->finishes[t] != 0 : a->finishes[t] == b->finishes[t];
    return same;
}

/* The value of a parameter whose finishes a map chooses: that which it has with the finish that is shown. */
static void multiply_parameter(const RetexView *view, int number, const float *parameters, float weight[3])
{
    const RetexParameter *parameter = &view->set->parameters[number];
    int is_mapped = 0;
    float sum[3] = {0, 0, 0};
    for (int t = 0; t < view->set->ntargets; t++)
        is_mapped |= view->mapped[t] && parameter->finishes[t];
    for (int i = 0; i < view->set->nparameters; i++)
        for (int c = 0; c < 3 && (is_mapped ? differ_by_maps(view, parameter, &view->set->parameters[i]) : i == number);
             c++)
            sum[c] += parameters[3 * i + c];
    for (int c = 0; c < 3; c++)
        weight[c] *= sum[c];
}

/* ---- where the finish is chosen ---- */

static int is_first_hit(const RetexSet *set, int footprint, int target)
{
    const RetexFootprint *f = &set->footprints[footprint];
    return f->target == target && f->kind != RETEX_FOOTPRINT_INTERREFLECTION && f->kind != RETEX_FOOTPRINT_HIT;
}

/* The factor that is the term's first hit, if that is on the target; else -1. */
static int first_hit(const RetexSet *set, const RetexTerm *term, const RetexTermFinishes *of, int target)
{
    int k = 0;
    while (k < of->nfactors && !retex_factor_is_hit(of->factors[k]))
        k++;
    if (k == of->nfactors || term->target != target || term->role == RETEX_ROLE_CORRECTION)
        return -1;
    const RetexFactor hit = of->factors[k];
    if (hit.kind == RETEX_FACTOR_FOOTPRINT)
        return is_first_hit(set, hit.index, target) ? k : -1;
    const RetexMixture *mixture = &set->mixtures[hit.index];
    for (int i = 0; i < mixture->nshares; i++)
        if (!is_first_hit(set, mixture->shares[i].footprint, target))
            return -1;
    return k;
}

static int is_on_target(const RetexSet *set, RetexFactor factor, int target)
{
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return set->footprints[factor.index].target == target;
    int any = 0;
    for (int i = 0; factor.kind == RETEX_FACTOR_MIXTURE && i < set->mixtures[factor.index].nshares; i++)
        any |= set->footprints[set->mixtures[factor.index].shares[i].footprint].target == target;
    return any;
}

/* Whether light of the term met the colour of the target. If not, no diffuse lobe reflected it there: normals do not
 * matter, and light with all of them is the same but for noise. */
static int has_hit(const RetexSet *set, const RetexTermFinishes *of, int target)
{
    int any = 0;
    for (int k = 0; k < of->nfactors; k++)
        any |= retex_factor_is_hit(of->factors[k]) && is_on_target(set, of->factors[k], target);
    return any;
}

/* Lets the map of a target say how much of a term counts, whose light met the target with this finish. */
static void weigh_by_map(RetexTermFinishes *of, const RetexSet *set, const RetexTerm *term, int target, int finish)
{
    const int hit = first_hit(set, term, of, target);
    if (hit >= 0) {
        of->finish[hit] = finish;
    } else if (set->targets[target].normal_tilt > 0 && !has_hit(set, of, target)) {
        for (int c = 0; c < 3; c++) /* it is the same with all three normals, and counts once */
            of->weight[c] *= finish == 0;
    } else if (of->nfactors + of->ngates < RETEX_MAX_FACTORS) {
        of->gates[of->ngates].target = target;
        of->gates[of->ngates++].finish = finish;
    }
}

void retex_term_find_finishes(RetexTermFinishes *of, const RetexView *view, const RetexTerm *term,
                              const float *parameters)
{
    const RetexSet *set = view->set;
    int finishes[RETEX_MAX_TARGETS] = {0}; /* by target with a map, that which the light met it with, from 1 */
    *of = (RetexTermFinishes){.weight = {1, 1, 1}};
    for (int k = 0; k < term->nfactors; k++) {
        const RetexFactor factor = term->factors[k];
        if (factor.kind != RETEX_FACTOR_PARAMETER) {
            of->finish[of->nfactors] = -1;
            of->factors[of->nfactors++] = factor;
            continue;
        }
        multiply_parameter(view, factor.index, parameters, of->weight);
        of->is_weighted = 1;
        for (int t = 0; t < set->ntargets; t++)
            if (view->mapped[t] && set->parameters[factor.index].finishes[t])
                finishes[t] = set->parameters[factor.index].finishes[t];
    }
    for (int t = 0; t < set->ntargets; t++)
        if (finishes[t])
            weigh_by_map(of, set, term, t, finishes[t] - 1);
}
