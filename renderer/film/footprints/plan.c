/* Choosing coefficients; see plan.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <retex/host/assert.h>
#include "film/footprints/plan.h"

/* So many further hits are kept in every combination: all of one target, 15 combinations of two, 10 of three, 15 of
 * four. */
static int combined(int ntargets)
{
    return ntargets == 1 ? RETEX_MAX_ORDERS : ntargets == 2 ? 4 : ntargets <= 4 ? 2 : 1;
}

static int find(const Plan *plan, const unsigned char powers[RETEX_MAX_TARGETS])
{
    for (int k = 0; k < plan->count; k++)
        if (!plan->coefficients[k].mixed && !memcmp(plan->coefficients[k].powers, powers, RETEX_MAX_TARGETS))
            return k;
    return -1;
}

/* All combinations of so many hits of the targets from one on. */
static void add_combinations(Plan *plan, int ntargets, int from, int hits, unsigned char powers[RETEX_MAX_TARGETS])
{
    if (hits == 0)
        memcpy(plan->coefficients[plan->count++].powers, powers, RETEX_MAX_TARGETS);
    for (int t = from; t < ntargets && hits > 0; t++) {
        powers[t]++;
        add_combinations(plan, ntargets, t, hits - 1, powers);
        powers[t]--;
    }
}

/* Further hits that a coefficient stands for. */
static int further_hits(const PlanCoefficient *c)
{
    int sum = c->mixed;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        sum += c->powers[t];
    return sum;
}

/* Where one more hit leads: its combination, else the mixture of as many hits. */
static void complete(Plan *plan, int ntargets, int first_mixed)
{
    for (int k = 0; k < plan->count; k++) {
        PlanCoefficient *c = &plan->coefficients[k];
        memset(c->next, -1, sizeof c->next);
        for (int t = 0; t < ntargets; t++) {
            unsigned char more[RETEX_MAX_TARGETS];
            memcpy(more, c->powers, sizeof more);
            more[t]++;
            int next = c->mixed ? -1 : find(plan, more);
            for (int m = first_mixed; next < 0 && m < plan->count; m++)
                if (plan->coefficients[m].mixed == further_hits(c) + 1)
                    next = m;
            RETEX_ASSERT(next < 0 || (next > k && further_hits(&plan->coefficients[next]) == further_hits(c) + 1));
            c->next[t] = (signed char)next;
        }
    }
}

static void make_within(Plan *plan, int ntargets, int together, int most)
{
    unsigned char powers[RETEX_MAX_TARGETS] = {0};
    *plan = (Plan){.together = together, .most = most};
    for (int hits = 0; hits <= most && hits <= together; hits++)
        add_combinations(plan, ntargets, 0, hits, powers);
    int first_mixed = plan->count;
    for (int hits = together + 1; hits <= most; hits++)
        plan->coefficients[plan->count++].mixed = (unsigned char)hits;
    RETEX_ASSERT(plan->count <= PLAN_COEFFICIENTS_MAX && further_hits(&plan->coefficients[0]) == 0);
    complete(plan, ntargets, first_mixed);
}

void plan_make(Plan *plan, int ntargets, int orders, int factors)
{
    make_within(plan, ntargets, combined(ntargets),
                ntargets == 0 ? 0 : ntargets == 1 ? orders - 1 : factors - 1);
}

void plan_weigh(Plan *plan, int ntargets, const float *brightness)
{
    double most = 0;
    for (int t = 0; t < ntargets; t++)
        most = fmax(most, (double)brightness[t]);
    for (int k = 0; k < plan->count; k++) {
        PlanCoefficient *c = &plan->coefficients[k];
        c->weight = pow(most, c->mixed);
        for (int t = 0; t < ntargets; t++)
            c->weight *= pow((double)brightness[t], c->powers[t]);
    }
}

int plan_shorten(Plan *plan, int ntargets, int together)
{
    if (plan->most > (ntargets > 1 ? plan->together + 1 : together))
        make_within(plan, ntargets, plan->together, plan->most - 1);
    else if (ntargets > 1 && plan->together > together)
        make_within(plan, ntargets, plan->together - 1, plan->together + 1);
    else
        return 0;
    return 1;
}

void plan_light_name(char name[RETEX_NAME_MAX], const Plan *plan, const char *word, int kind, int coefficient)
{
    const PlanCoefficient *c = &plan->coefficients[coefficient];
    int used = snprintf(name, RETEX_NAME_MAX, "%.90s_%s%s", word,
                        retex_footprint_kind_name(kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP),
                        coefficient ? "_" : "");
    if (c->mixed)
        snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "m%d", c->mixed);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        if (c->powers[t])
            used += snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "%c%d", 'a' + t, c->powers[t]);
}
