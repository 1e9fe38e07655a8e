/* See orders.h. Light of h further hits varies as a^h with a grey texture a. Orders that are left out are
 * shared by the next lower and the next higher one that are kept, such that COMPACT_GREY and white stay exact: both
 * shares are positive, and between the two what is wrong is small. Where hits are mixed, from the third further one on
 * each is taken to meet any target as later footprints do on the whole, not one that is told apart. */
#include "compact/orders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int kept_orders[] = {1, 2, 3, 5, 8}; /* and the highest */

enum { KEPT_ORDERS = sizeof kept_orders / sizeof *kept_orders, FIRST_MIXED = 3 };

/* Whether a factor is a mixture of later footprints of several targets. */
static int is_any_target(const RetexSet *set, int factor)
{
    if (factor >= 0)
        return 0;
    const RetexMixture *mixture = &set->mixtures[RETEX_MIXTURE(factor)];
    const int first = set->footprints[mixture->shares[0].footprint].target;
    for (int k = 1; k < mixture->nshares; k++)
        if (set->footprints[mixture->shares[k].footprint].target != first)
            return 1;
    return 0;
}

/* That of hits on any target; 0 where no term has it. */
static int find_any_target(const CompactKind *kind, const RetexSet *set)
{
    for (int i = 0; i < kind->nagain; i++)
        if (is_any_target(set, set->terms[kind->again[i].term].factors[1]))
            return set->terms[kind->again[i].term].factors[1];
    return 0;
}

static int same_factors(const RetexTerm *a, const RetexTerm *b)
{
    return a->nfactors == b->nfactors && memcmp(a->factors, b->factors, (size_t)a->nfactors * sizeof *a->factors) == 0;
}

/* The gain of so many further hits on what another term's are on. */
static int find_gain(CompactKind *kind, const RetexSet *set, CompactMixed mixed, int number, int order, int any)
{
    const RetexTerm *old = &set->terms[number];
    RetexTerm term = *old;
    term.nfactors = 1 + order;
    for (int k = 1; k < term.nfactors; k++)
        term.factors[k] = any ? any : order == old->nfactors - 1 ? old->factors[k] : old->factors[1];
    int g = 0;
    while (g < kind->ngains[mixed] && !same_factors(&kind->gains[mixed][g].term, &term))
        g++;
    if (g < kind->ngains[mixed])
        return g;
    CompactGain *gain = &kind->gains[mixed][kind->ngains[mixed]++];
    gain->term = term;
    /* named after the radiance it replaces, or the order */
    const char *name = set->parts[old->radiance].name, *tail = strrchr(name, '_');
    if (any || order != old->nfactors - 1)
        snprintf(gain->name, sizeof gain->name, "%c%d", any ? 'm' : 'a', order);
    else
        snprintf(gain->name, sizeof gain->name, "%s", tail ? tail + 1 : name);
    return g;
}

/* Kept orders on both sides of one, and the share of the lower; the order itself where it is kept. */
static double between(int order, int highest, int orders[2])
{
    orders[0] = orders[1] = order;
    for (int i = 0; i < KEPT_ORDERS; i++)
        if (kept_orders[i] == order || order >= highest)
            return 1;
    for (int i = 0; i < KEPT_ORDERS && kept_orders[i] < order; i++)
        orders[0] = kept_orders[i];
    orders[1] = highest;
    for (int i = KEPT_ORDERS - 1; i >= 0 && kept_orders[i] > order; i--)
        if (kept_orders[i] < highest)
            orders[1] = kept_orders[i];
    const double grey = (double)COMPACT_GREY, low = pow(grey, orders[0]), high = pow(grey, orders[1]);
    return (pow(grey, order) - high) / (low - high);
}

/* Into which gains a term goes. */
static void share_term(CompactKind *kind, const RetexSet *set, CompactMixed mixed, CompactAgain *again, int highest)
{
    const RetexTerm *term = &set->terms[again->term];
    const int order = term->nfactors - 1;
    const int mixes = mixed == COMPACT_MIXED && order >= FIRST_MIXED;
    const int any = mixes ? find_any_target(kind, set) : is_any_target(set, term->factors[1]) ? term->factors[1] : 0;
    int orders[2] = {order, order};
    const double share = any || set->ntargets == 1 ? between(order, highest, orders) : 1;
    for (int k = 0; k < 2; k++) {
        again->in[mixed][k].share = k ? 1 - share : share;
        again->in[mixed][k].gain =
            again->in[mixed][k].share > 0 ? find_gain(kind, set, mixed, again->term, orders[k], any) : -1;
    }
}

int compact_orders_make(CompactKind *kind, const RetexSet *set, CompactMixed mixed, RetexError *err)
{
    int highest = 0;
    kind->gains[mixed] = calloc(2 * (size_t)kind->nagain + 1, sizeof **kind->gains);
    if (!kind->gains[mixed])
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", kind->nagain);
    for (int i = 0; i < kind->nagain; i++)
        if (set->terms[kind->again[i].term].nfactors - 1 > highest)
            highest = set->terms[kind->again[i].term].nfactors - 1;
    for (int i = 0; i < kind->nagain; i++)
        share_term(kind, set, mixed, &kind->again[i], highest);
    return RETEX_OK;
}
