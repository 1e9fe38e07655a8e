/* Names, order and storage of the terms of layout `paper`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "film/paper/terms.h"

#include <retex/host/set_build.h>

#define KEY(kind, rest) ((TermKey)(kind) << 56 | (rest))
#define REST(key) ((key) & (((TermKey)1 << 56) - 1))

/* They are few, and not every processor of a kind can count them. */
static int count_bits(HitMask m)
{
    int count = 0;
    for (; m; m &= m - 1)
        count++;
    return count;
}
static HitMask target_bits(HitMask m, int target)
{
    return m >> (target * RETEX_MAX_ORDERS) & (((HitMask)1 << RETEX_MAX_ORDERS) - 1);
}

/* The first n hits of each target in place of any n of them. */
static HitMask as_prefix(HitMask hits)
{
    HitMask prefix = 0;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = count_bits(target_bits(hits, t)) - 1; k >= 0; k--)
            prefix |= hit_bit(t, k);
    return prefix;
}

TermKey term_key(int nhits, HitMask hits, int strict)
{
    int n = count_bits(hits);
    if (nhits == 0)
        return KEY(RETEX_ROLE_FULL, 0);
    if (n == 0)
        return KEY(RETEX_ROLE_INDEP, (TermKey)nhits);
    if (n == nhits)
        return KEY(RETEX_ROLE_DEP, hits);
    if (nhits == 2)
        return KEY(RETEX_ROLE_CROSS2, hits);
    if (nhits == 3)
        return KEY(RETEX_ROLE_CROSS3, hits);
    return strict ? TERM_DROPPED : KEY(RETEX_ROLE_DEP, as_prefix(hits));
}

/* Number of the cross term of one target in the supplement's order (4.3): sorted by its first factor, longer ones
 * first. */
static int supplement_number(int nhits, HitMask m)
{
    static const int three[8] = {0, 3, 5, 1, 6, 2, 4, 0};
    return nhits == 2 ? (int)m : three[m];
}

/* a2b1: two factors of the first target and the first of the second, as counts or as a list of indices. */
static void letters_name(char *out, size_t size, HitMask hits, int ntargets, int counts)
{
    size_t used = 0;
    out[0] = 0;
    for (int t = 0; t < ntargets; t++) {
        HitMask m = target_bits(hits, t);
        if (!m)
            continue;
        used += (size_t)snprintf(out + used, size - used, "%c", 'a' + t);
        if (counts)
            used += (size_t)snprintf(out + used, size - used, "%d", count_bits(m));
        for (int k = 0; k < RETEX_MAX_ORDERS && !counts; k++)
            if (m >> k & 1)
                used += (size_t)snprintf(out + used, size - used, "%d", k + 1);
    }
}

static void term_name(char *out, size_t size, TermKey key, int ntargets)
{
    RetexRole kind = (RetexRole)(key >> 56);
    HitMask hits = REST(key);
    char letters[64];
    letters_name(letters, sizeof letters, hits, ntargets, kind == RETEX_ROLE_DEP);
    int one = ntargets == 1;
    if (kind == RETEX_ROLE_FULL)
        snprintf(out, size, "full_0");
    else if (kind == RETEX_ROLE_INDEP)
        snprintf(out, size, "indep_%d", (int)hits);
    else if (kind == RETEX_ROLE_DEP && one)
        snprintf(out, size, "dep_%d", count_bits(hits));
    else if (kind == RETEX_ROLE_DEP)
        snprintf(out, size, "dep_%s", letters);
    else {
        int n = kind == RETEX_ROLE_CROSS2 ? 2 : 3;
        if (one)
            snprintf(out, size, "cross%d_%d", n, supplement_number(n, hits));
        else
            snprintf(out, size, "cross%d_%s", n, letters);
    }
}

/* The term of several targets that term_name calls so; TERM_DROPPED if there is none. */
static TermKey key_of_name(const char *name, int ntargets, int orders)
{
    static const struct {
        const char *start;
        RetexRole kind;
    } kinds[] = {{"indep_", RETEX_ROLE_INDEP},
                 {"dep_", RETEX_ROLE_DEP},
                 {"cross2_", RETEX_ROLE_CROSS2},
                 {"cross3_", RETEX_ROLE_CROSS3}};
    char back[RETEX_NAME_MAX];
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const RetexRole kind = kinds[k].kind;
        const size_t length = strlen(kinds[k].start);
        HitMask hits = 0;
        int target = 0;
        if (strncmp(name, kinds[k].start, length) != 0)
            continue;
        for (const char *at = name + length; *at; at++) {
            const int digit = *at - '0';
            if (*at >= 'a' && *at < 'a' + ntargets)
                target = *at - 'a';
            else if (kind == RETEX_ROLE_INDEP && digit >= 0 && digit <= 9)
                hits = (10 * hits + (HitMask)digit) % 1000;
            else if (digit >= 1 && digit <= orders)
                hits |=
                    kind == RETEX_ROLE_DEP ? hit_bit(target, digit) - hit_bit(target, 0) : hit_bit(target, digit - 1);
        }
        term_name(back, sizeof back, KEY(kind, hits), ntargets);
        if (hits && strcmp(back, name) == 0)
            return KEY(kind, hits);
    }
    return TERM_DROPPED;
}

static int add_term(TermTable *table, TermKey key, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    if (table->count == TERMS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "more than %d terms", TERMS_MAX);
    term_name(name, sizeof name, key, table->ntargets);
    int code = bands_add(table->bands, name, "RGB", RETEX_HALF, &table->images[table->count], err);
    if (!code)
        table->keys[table->count++] = key;
    return code;
}

/* The paper's 21 radiance images of one target. */
static int add_paper_terms(TermTable *table, int orders, RetexError *err)
{
    int code = add_term(table, KEY(RETEX_ROLE_FULL, 0), err);
    for (int h = 1; h <= orders && !code; h++) {
        code = add_term(table, KEY(RETEX_ROLE_INDEP, (TermKey)h), err);
        if (!code)
            code = add_term(table, KEY(RETEX_ROLE_DEP, ((HitMask)1 << h) - 1), err);
    }
    for (int h = 2; h <= 3 && h <= orders; h++)
        for (HitMask m = 1; m < ((HitMask)1 << h) - 1 && !code; m++)
            code = add_term(table, term_key(h, m, 0), err);
    return code;
}

int terms_create(TermTable *table, Bands *bands, int ntargets, int orders, RetexError *err)
{
    table->bands = bands, table->ntargets = ntargets, table->orders = orders;
    pthread_mutex_init(&table->lock, NULL);
    table->ready = 1;
    return ntargets == 1 ? add_paper_terms(table, orders, err) : add_term(table, KEY(RETEX_ROLE_FULL, 0), err);
}

void terms_close(TermTable *table)
{
    if (!table->ready)
        return;
    pthread_mutex_destroy(&table->lock);
    *table = (TermTable){0};
}

static int find_shared(TermTable *table, TermKey key)
{
    pthread_mutex_lock(&table->lock);
    int k = 0;
    while (k < table->count && table->keys[k] != key)
        k++;
    if (k == table->count && add_term(table, key, NULL))
        k = -1;
    pthread_mutex_unlock(&table->lock);
    return k;
}

int terms_find(TermTable *table, TermCache *cache, TermKey key)
{
    unsigned bucket = (unsigned)((key * 0x9e3779b97f4a7c15u) >> 56);
    if (cache->terms[bucket] && cache->keys[bucket] == key)
        return cache->terms[bucket] - 1;
    int term = find_shared(table, key);
    if (term >= 0)
        cache->keys[bucket] = key, cache->terms[bucket] = term + 1;
    return term;
}

int terms_resume(TermTable *table, const char *name, RetexError *err)
{
    const TermKey key = table->ntargets > 1 ? key_of_name(name, table->ntargets, table->orders) : TERM_DROPPED;
    return key == TERM_DROPPED ? RETEX_OK : add_term(table, key, err);
}

HitMask terms_hits(const TermTable *table, int term)
{
    const RetexRole kind = (RetexRole)(table->keys[term] >> 56);
    return kind == RETEX_ROLE_FULL || kind == RETEX_ROLE_INDEP ? 0 : REST(table->keys[term]);
}

int hits_on_target(HitMask hits, int target)
{
    return count_bits(target_bits(hits, target));
}

int terms_first_target(const TermTable *table, int term)
{
    const HitMask hits = terms_hits(table, term);
    for (int t = 0; t < table->ntargets; t++)
        if (target_bits(hits, t))
            return t;
    return -1;
}

double terms_weight(const TermTable *table, int term, const float *brightness)
{
    const HitMask hits = terms_hits(table, term);
    double weight = 1;
    int is_further = 0;
    for (int t = 0; t < table->ntargets; t++)
        for (int n = hits_on_target(hits, t); n > 0; n--, is_further = 1)
            weight *= is_further ? (double)brightness[t] : 1;
    return weight;
}

static void term_factors(RetexTerm *term, TermKey key, int ntargets, int orders)
{
    if (term->role == RETEX_ROLE_FULL || term->role == RETEX_ROLE_INDEP)
        return;
    for (int t = ntargets - 1; t >= 0; t--)
        term->target = target_bits(key, t) ? t : term->target;
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < RETEX_MAX_ORDERS; k++)
            if (target_bits(key, t) >> k & 1)
                term->factors[term->nfactors++] = retex_factor(RETEX_FACTOR_FOOTPRINT, t * orders + k);
}

/* The light of a single target's last order is that of further hits too. Of several targets' light the hits beyond the
 * last order may be on any of them. */
static void add_further(RetexTerm *term, int ntargets, int orders)
{
    if (ntargets > 1 || orders < 2 || term->nfactors < orders)
        return;
    term->factors[term->nfactors] = term->factors[term->nfactors - 1];
    term->factors[term->nfactors++].quantity = RETEX_QUANTITY_FURTHER;
}

static int compare_keys(const void *a, const void *b)
{
    TermKey x = ((const TermKey *)a)[0], y = ((const TermKey *)b)[0];
    return x < y ? -1 : x > y;
}

int terms_finish(TermTable *table, RetexSet *set, const float *brightness, RetexError *err)
{
    TermKey(*order)[2] = calloc((size_t)table->count + 1, sizeof *order);
    if (!order)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the terms");
    for (int k = 0; k < table->count; k++)
        order[k][0] = table->keys[k], order[k][1] = (TermKey)k;
    qsort(order, (size_t)table->count, sizeof *order, compare_keys);
    const RetexSetInfo info = retex_set_info(set);
    int code = RETEX_OK;
    for (int k = 0; k < table->count && !code; k++) {
        RetexTerm term = {.role = (RetexRole)(order[k][0] >> 56), .target = -1};
        term_factors(&term, order[k][0], table->ntargets, info.orders);
        if (brightness && term.nfactors > 1)
            term.noise_weight = (float)terms_weight(table, (int)order[k][1], brightness);
        if (!info.strict_paper)
            add_further(&term, table->ntargets, info.orders);
        code = bands_move_part(table->bands, table->images[order[k][1]], set, &term.radiance, err);
        if (!code)
            code = retex_set_add_term(set, &term, NULL, err);
    }
    free(order);
    return code;
}
