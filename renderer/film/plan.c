/* Choosing coefficients; see plan.h. */
#include <stdlib.h>
#include <string.h>
#include "film/plan.h"

/* Coefficients with less than this share of the light, were every target painted white, are left out. */
#define LEAST_SHARE 1e-5
#define UNIT 16777216.0 /* of energies: 2^-24 */
#define LARGEST 1e9f    /* luminance of one connection */

uint32_t plan_key(int first, const unsigned char powers[RETEX_MAX_TARGETS])
{
    uint32_t key = 0;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        key |= (uint32_t)powers[t] << (3 * t);
    return key | (uint32_t)first << 24;
}

static uint64_t fixed(float luminance)
{
    return luminance > 0 ? (uint64_t)((double)(luminance < LARGEST ? luminance : LARGEST) * UNIT) : 0;
}

static void add_energy(PlanSurvey *survey, uint32_t key, uint64_t energy)
{
    uint32_t slot = (key * 0x9e3779b9u) >> 20;
    for (int k = 0; k < PLAN_SURVEY_SLOTS; k++, slot = (slot + 1) % PLAN_SURVEY_SLOTS) {
        if (survey->keys[slot] && survey->keys[slot] != key + 1)
            continue;
        survey->keys[slot] = key + 1;
        survey->energy[slot] += energy;
        return;
    }
}

void plan_survey_add(PlanSurvey *survey, uint32_t key, float luminance)
{
    add_energy(survey, key, fixed(luminance));
}

void plan_survey_total(PlanSurvey *survey, float luminance)
{
    survey->total += fixed(luminance);
}

void plan_survey_merge(PlanSurvey *into, const PlanSurvey *from)
{
    into->total += from->total;
    for (int k = 0; k < PLAN_SURVEY_SLOTS; k++)
        if (from->keys[k])
            add_energy(into, from->keys[k] - 1, from->energy[k]);
}

static int find(const Plan *plan, int first, const unsigned char powers[RETEX_MAX_TARGETS])
{
    for (int k = 0; k < plan->count[first]; k++)
        if (!memcmp(plan->powers[first][k], powers, RETEX_MAX_TARGETS))
            return k;
    return -1;
}

/* No more factors of one target, and of all, than asked for? */
static int is_allowed(int first, const unsigned char powers[RETEX_MAX_TARGETS], const PlanLimits *limits)
{
    int all = 1, good = 1;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
        good &= powers[t] + (t == first) <= limits->orders;
        all += powers[t];
    }
    return good && all <= limits->factors;
}

/* With all that leads to it: one hit less of any target. */
static void keep(Plan *plan, int first, const unsigned char powers[RETEX_MAX_TARGETS])
{
    if (find(plan, first, powers) >= 0)
        return;
    for (int t = 0; t < plan->ntargets; t++)
        if (powers[t]) {
            unsigned char less[RETEX_MAX_TARGETS];
            memcpy(less, powers, sizeof less);
            less[t]--;
            keep(plan, first, less);
            if (find(plan, first, less) < 0)
                return;
        }
    if (plan->count[first] < plan->most)
        memcpy(plan->powers[first][plan->count[first]++], powers, RETEX_MAX_TARGETS);
}

static void connect_steps(Plan *plan)
{
    memset(plan->next, -1, sizeof plan->next);
    for (int first = 0; first < plan->ntargets; first++)
        for (int k = 0; k < plan->count[first]; k++)
            for (int t = 0; t < plan->ntargets; t++) {
                unsigned char more[RETEX_MAX_TARGETS];
                memcpy(more, plan->powers[first][k], sizeof more);
                more[t]++;
                plan->next[first][k][t] = (signed char)find(plan, first, more);
            }
}

typedef struct Entry {
    uint32_t key;
    uint64_t energy;
} Entry;

static int compare_entries(const void *a, const void *b)
{
    const Entry *x = a, *y = b;
    if (x->energy != y->energy)
        return x->energy < y->energy ? 1 : -1;
    return x->key < y->key ? -1 : x->key > y->key;
}

static void keep_surveyed(Plan *plan, const PlanLimits *limits, const PlanSurvey *survey)
{
    Entry entries[PLAN_SURVEY_SLOTS];
    int count = 0;
    for (int k = 0; k < PLAN_SURVEY_SLOTS; k++)
        if (survey->keys[k] && (double)survey->energy[k] > LEAST_SHARE * (double)survey->total)
            entries[count++] = (Entry){survey->keys[k] - 1, survey->energy[k]};
    qsort(entries, (size_t)count, sizeof *entries, compare_entries);
    for (int k = 0; k < count; k++) {
        unsigned char powers[RETEX_MAX_TARGETS];
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            powers[t] = (unsigned char)(entries[k].key >> (3 * t) & 7);
        if (is_allowed((int)(entries[k].key >> 24), powers, limits))
            keep(plan, (int)(entries[k].key >> 24), powers);
    }
}

/* So many further hits are kept in every combination, whatever the survey saw of it, for single bright paths take them:
 * all of one target, 15 combinations of two and of four, 20 of three. */
static int always_kept(int ntargets, int orders)
{
    int most = ntargets == 1 ? RETEX_MAX_ORDERS : ntargets == 2 ? 4 : ntargets == 3 ? 3 : ntargets == 4 ? 2 : 1;
    return most < orders - 1 ? most : orders - 1;
}

int plan_least(int ntargets, int orders)
{
    int combinations = 1, later = always_kept(ntargets, orders);
    for (int k = 1; k <= later; k++) /* (ntargets + later)! / (ntargets! later!) */
        combinations = combinations * (ntargets + k) / k;
    return combinations;
}

static void keep_few(Plan *plan, int first, int target, int left, unsigned char powers[RETEX_MAX_TARGETS])
{
    keep(plan, first, powers);
    for (int t = target; t < plan->ntargets && left > 0; t++) {
        powers[t]++;
        keep_few(plan, first, t, left - 1, powers);
        powers[t]--;
    }
}

void plan_make(Plan *plan, int ntargets, const PlanLimits *limits, const PlanSurvey *survey)
{
    unsigned char powers[RETEX_MAX_TARGETS] = {0};
    int most = limits->coefficients;
    *plan = (Plan){.ntargets = ntargets, .most = most < PLAN_COEFFICIENTS_MAX ? most : PLAN_COEFFICIENTS_MAX};
    for (int t = 0; t < ntargets; t++)
        keep_few(plan, t, 0, always_kept(ntargets, limits->orders), powers);
    if (ntargets > 1)
        keep_surveyed(plan, limits, survey);
    connect_steps(plan);
}
