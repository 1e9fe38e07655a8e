/* See orders.h. Light with h interreflections varies as a^h with a grey texture of albedo a. A term of an order that
 * is left out is divided between the next lower and the next higher order that is kept. The two shares are positive
 * and exact for albedo 1 and RETEX_COMPACT_GREY; between these albedos the error is small. With RETEX_COMPACT_MIXED,
 * terms of three and more interreflections use one mixture of all targets' interreflections. Light of single lamps, of
 * which there are many, does so from two on; it keeps the same orders, or it would be brighter than in the set with
 * dark textures, and darker with bright ones. */
#include "compact/orders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "set/set.h"
#include "set/signals.h"

enum { KEPT_ORDERS = 5, FIRST_MIXED = 3, FIRST_MIXED_OF_LAMP = 2 };
static const int kept_orders[KEPT_ORDERS] = {1, 2, 3, 5, 8}; /* the highest order is kept too */

/* Whether a factor is a mixture of interreflection footprints of several targets. */
static int is_any_target(const RetexSet *set, RetexFactor factor)
{
    if (factor.kind != RETEX_FACTOR_MIXTURE)
        return 0;
    const RetexMixture *mixture = &set->mixtures[factor.index];
    const int first = set->footprints[mixture->shares[0].footprint].target;
    for (int k = 1; k < mixture->nshares; k++)
        if (set->footprints[mixture->shares[k].footprint].target != first)
            return 1;
    return 0;
}

static int is_interreflection(const RetexSet *set, RetexFactor factor)
{
    int target;
    RetexFootprintKind kind = RETEX_FOOTPRINT_HIT;
    if (retex_factor_is_hit(factor))
        retex_factor_target(set, factor, &target, &kind);
    return kind == RETEX_FOOTPRINT_INTERREFLECTION;
}

/* A term's first factor of interreflections. */
static const RetexFactor *first_interreflection(const RetexSet *set, const RetexTerm *term)
{
    int k = 0;
    while (!is_interreflection(set, term->factors[k]))
        k++;
    return &term->factors[k];
}

/* The factor that mixes several targets' interreflection footprints, or NULL if no term has one. */
static const RetexFactor *find_any_target(const RetexCompactKind *kind, const RetexSet *set)
{
    for (int i = 0; i < kind->ninterreflections; i++) {
        const RetexFactor *factor = first_interreflection(set, &set->terms[kind->interreflections[i].term]);
        if (is_any_target(set, *factor))
            return factor;
    }
    return NULL;
}

static int has_further(const RetexTerm *term)
{
    int further = 0;
    for (int k = 0; k < term->nfactors; k++)
        further |= term->factors[k].quantity == RETEX_QUANTITY_FURTHER;
    return further;
}

static int same_factors(const RetexTerm *a, const RetexTerm *b)
{
    return a->nfactors == b->nfactors && memcmp(a->factors, b->factors, (size_t)a->nfactors * sizeof *a->factors) == 0;
}

/* Find or add the gain for `order` interreflections, with the factors of term `number`, or with factor `any` if not
 * NULL. */
static int find_gain(RetexCompactKind *kind, const RetexCompactLight *light, RetexCompactMixed mixed, int number,
                     int order, const RetexFactor *any)
{
    const RetexSet *set = light->set;
    const RetexCompactLamps *lamps = &light->lamps[light->lamps_of[number]];
    const RetexTerm *old = &set->terms[number];
    const int old_order = retex_term_hits(old) - 1;
    RetexTerm term = *old;
    term.nfactors = 0;
    term.factors[term.nfactors++] = kind->first;
    for (int k = 0; k < old->nfactors && !any && order == old_order; k++)
        if (is_interreflection(set, old->factors[k]))
            term.factors[term.nfactors++] = old->factors[k];
    while (term.nfactors < 1 + order)
        term.factors[term.nfactors++] = any ? *any : *first_interreflection(set, old);
    for (int k = 0; k < old->nfactors && order == old_order; k++)
        if (old->factors[k].quantity == RETEX_QUANTITY_FURTHER) {
            term.factors[term.nfactors] = any ? *any : old->factors[k];
            term.factors[term.nfactors++].quantity = RETEX_QUANTITY_FURTHER;
        }
    for (int k = 0; k < lamps->count; k++)
        term.factors[term.nfactors++] = lamps->factors[k];
    int g = 0;
    while (g < kind->ngains[mixed] && !same_factors(&kind->gains[mixed][g].term, &term))
        g++;
    if (g < kind->ngains[mixed])
        return g;
    RetexCompactGain *gain = &kind->gains[mixed][kind->ngains[mixed]++];
    gain->term = term;
    gain->lamps = light->lamps_of[number];
    /* the gain is named after the radiance it replaces, or after its order; with lamps it has a number */
    const char *name = set->parts[old->radiance].name, *tail = strrchr(name, '_');
    if (lamps->count)
        snprintf(gain->name, sizeof gain->name, "%d", g + 1);
    else if (any || order != old_order)
        snprintf(gain->name, sizeof gain->name, "%c%d", any ? 'm' : 'a', order);
    else
        snprintf(gain->name, sizeof gain->name, "%s", tail ? tail + 1 : name);
    return g;
}

/* Find the kept orders that are below and above an order. Returns the share of the lower one. A kept order is both,
 * share 1. */
static double between(int order, int highest, int orders[2])
{
    const int *kept = kept_orders;
    orders[0] = orders[1] = order;
    for (int i = 0; i < KEPT_ORDERS; i++)
        if (kept[i] == order || order >= highest)
            return 1;
    for (int i = 0; i < KEPT_ORDERS && kept[i] < order; i++)
        orders[0] = kept[i];
    orders[1] = highest;
    for (int i = KEPT_ORDERS - 1; i >= 0 && kept[i] > order; i--)
        if (kept[i] < highest)
            orders[1] = kept[i];
    const double grey = (double)RETEX_COMPACT_GREY, low = pow(grey, orders[0]), high = pow(grey, orders[1]);
    return (pow(grey, order) - high) / (low - high);
}

/* Divide a term between the gains of kept orders. */
static void share_term(RetexCompactKind *kind, const RetexCompactLight *light, RetexCompactMixed mixed,
                       RetexCompactInterreflection *part, int highest)
{
    const RetexSet *set = light->set;
    const RetexTerm *term = &set->terms[part->term];
    const int order = retex_term_hits(term) - 1;
    const int alone = light->lamps[light->lamps_of[part->term]].alone;
    const int mixes = alone ? order >= FIRST_MIXED_OF_LAMP : mixed == RETEX_COMPACT_MIXED && order >= FIRST_MIXED;
    const RetexFactor *own = first_interreflection(set, term);
    const RetexFactor *any = mixes ? find_any_target(kind, set) : is_any_target(set, *own) ? own : NULL;
    int orders[2] = {order, order};
    const double share =
        any || set->ntargets == 1 ? between(order, highest, orders) : 1;
    for (int k = 0; k < 2; k++) {
        part->in[mixed][k].share = k ? 1 - share : share;
        part->in[mixed][k].gain =
            part->in[mixed][k].share > 0 ? find_gain(kind, light, mixed, part->term, orders[k], any) : -1;
    }
}

int retex_compact_orders_make(RetexCompactKind *kind, const RetexCompactLight *light, RetexCompactMixed mixed,
                              RetexError *err)
{
    const RetexSet *set = light->set;
    int highest = 0; /* of terms without further hits, which no other term is divided among */
    kind->gains[mixed] = calloc(2 * (size_t)kind->ninterreflections + 1, sizeof **kind->gains);
    if (!kind->gains[mixed])
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", kind->ninterreflections);
    for (int i = 0; i < kind->ninterreflections; i++)
        if (!has_further(&set->terms[kind->interreflections[i].term]) &&
            retex_term_hits(&set->terms[kind->interreflections[i].term]) - 1 > highest)
            highest = retex_term_hits(&set->terms[kind->interreflections[i].term]) - 1;
    for (int i = 0; i < kind->ninterreflections; i++)
        share_term(kind, light, mixed, &kind->interreflections[i], highest);
    return RETEX_OK;
}
