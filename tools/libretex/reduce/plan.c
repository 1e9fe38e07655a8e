/* Sorts the parts of a set by what becomes of them, and makes the reduced set. See plan.h. */
#include "reduce/plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/aov.h>
#include <retex/host/set_build.h>

#include "compact/build.h"
#include "set/parts.h"
#include "set/references.h"
#include "set/set.h"

#define SPP_MOST (1 << 30) /* of a set */
/* AOVs that are averages over a pixel; all others are taken at its centre. */
#define AVERAGED_AOVS (RETEX_AOV_BIT(IRRADIANCE) | RETEX_AOV_BIT(ALBEDO_MEAN) | RETEX_AOV_BIT(NORMAL_MEAN))

/* Planning, with what only it needs. */
typedef struct Planning {
    RetexReducePlan *plan;
    const RetexSet *set;
    int scale;
    int *members; /* by part with light or weights: its kind and member, as one number; else RETEX_REDUCE_NONE */
    char *in_columns;    /* by term: its radiance is in a column */
    const char *unknown; /* what cannot be reduced, or NULL */
} Planning;

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory to reduce a set");
}

/* ---- footprints ---- */

static RetexReduceKind *find_kind(RetexReducePlan *plan, int target, RetexFootprintKind kind)
{
    for (int i = 0; i < plan->nkinds; i++)
        if (plan->kinds[i].target == target && plan->kinds[i].kind == kind)
            return &plan->kinds[i];
    RetexReduceKind *made = &plan->kinds[plan->nkinds++];
    *made = (RetexReduceKind){.target = target, .kind = kind};
    for (int q = 0; q < RETEX_QUADRANTS; q++)
        made->map[q] = RETEX_REDUCE_NONE;
    return made;
}

/* The kind and member of a footprint. */
static RetexReduceKind *find_member(RetexReducePlan *plan, const RetexSet *set, int footprint, int *member)
{
    RetexReduceKind *kind = find_kind(plan, set->footprints[footprint].target, set->footprints[footprint].kind);
    for (*member = 0; kind->from[*member] != footprint;)
        ++*member;
    return kind;
}

/* Add a parallelogram to a kind, which may have one, whole or in quarters. */
static int add_map(RetexReduceKind *kind, const RetexSet *set, const RetexFootprint *f)
{
    const int member = kind->count - 1;
    for (int q = 0; q < RETEX_QUADRANTS; q++) {
        const RetexFootprint *other = kind->map[q] < 0 ? NULL : &set->footprints[kind->from[kind->map[q]]];
        if (other && (other->uv != f->uv || other->spread != f->spread))
            return 0;
        if (f->quadrant && f->quadrant != q + 1)
            continue;
        if (other)
            return 0;
        kind->map[q] = member;
    }
    return 1;
}

static int add_member(Planning *p, int footprint)
{
    const RetexFootprint *f = &p->set->footprints[footprint];
    if (f->kind == RETEX_FOOTPRINT_HIT || f->uv < 0 || f->spread < 0 || f->albedo < 0)
        return 0;
    RetexReduceKind *kind = find_kind(p->plan, f->target, f->kind);
    if (kind->count == RETEX_SHARES_MAX)
        return 0;
    kind->from[kind->count] = footprint;
    kind->albedo_of[kind->count] = kind->count;
    for (int k = kind->count - 1; k >= 0; k--) {
        const RetexFootprint *other = &p->set->footprints[kind->from[k]];
        if (other->albedo == f->albedo)
            kind->albedo_of[kind->count] = k;
        if (other->uv == f->uv && !retex_footprint_has_axes(p->set, f))
            return 0;
    }
    kind->count++;
    if (retex_footprint_has_axes(p->set, f))
        return add_map(kind, p->set, f);
    kind->ellipses[kind->nellipses++] = kind->count - 1;
    return 1;
}

static int sort_footprints(Planning *p)
{
    int sound = 1;
    for (int i = 0; i < p->set->nfootprints && sound; i++)
        sound = add_member(p, i);
    for (int i = 0; i < p->plan->nkinds; i++) {
        int quarters = 0;
        for (int q = 0; q < RETEX_QUADRANTS; q++)
            quarters += p->plan->kinds[i].map[q] >= 0;
        sound = sound && (quarters == 0 || quarters == RETEX_QUADRANTS);
    }
    return sound;
}

/* ---- light ---- */

static RetexReduceColumn *add_column(RetexReduceKind *kind, int term, int mixture, int channels, RetexError *err)
{
    RetexReduceColumn *columns = realloc(kind->columns, ((size_t)kind->ncolumns + 1) * sizeof *columns);
    if (!columns) {
        no_memory(err);
        return NULL;
    }
    kind->columns = columns;
    columns += kind->ncolumns++;
    *columns =
        (RetexReduceColumn){.term = term, .mixture = mixture, .weights = RETEX_REDUCE_NONE, .channels = channels};
    for (int k = 0; k < RETEX_SHARES_MAX; k++)
        columns->from[k] = columns->to[k] = RETEX_REDUCE_NONE;
    return columns;
}

/* Put a part into a column. It may be in several, but of one member. */
static void place_part(Planning *p, const RetexReduceKind *kind, RetexReduceColumn *column, int member, int part)
{
    const int number = (int)(kind - p->plan->kinds) * RETEX_SHARES_MAX + member;
    column->from[member] = part;
    if ((p->members[part] != RETEX_REDUCE_NONE && p->members[part] != number) || part == 0 ||
        (p->plan->rules[part] != RETEX_REDUCE_MEAN && p->plan->rules[part] != RETEX_REDUCE_MEMBERS))
        p->unknown = "its parts are used for several things";
    p->members[part] = number;
    p->plan->rules[part] = RETEX_REDUCE_MEMBERS;
}

/* What the light of a term counts, those of further hits on surfaces of RETEX_COMPACT_GREY; 0 of what is in others. */
static void find_value(const RetexSet *set, const RetexTerm *term, double value[3])
{
    retex_compact_rendered(set, term, value);
    for (int c = 0; c < 3; c++) {
        value[c] *= retex_term_is_light(term);
        for (int k = retex_term_hits(term); k > 1; k--)
            value[c] *= (double)RETEX_COMPACT_GREY;
    }
}

static int add_light(RetexReduceLight **light, int *count, const RetexSet *set, const RetexTerm *term, RetexError *err)
{
    RetexReduceLight *more = realloc(*light, ((size_t)*count + 1) * sizeof *more);
    if (!more)
        return no_memory(err);
    *light = more;
    more += (*count)++;
    more->part = term->radiance;
    find_value(set, term, more->value);
    return RETEX_OK;
}

/* Whether terms are the same but for the footprint that is factor number `place` of both. */
static int are_alike(const RetexTerm *a, const RetexTerm *b, int place)
{
    int alike = a->role == b->role && a->target == b->target && a->nfactors == b->nfactors;
    for (int k = 0; k < a->nfactors && alike; k++)
        alike = a->factors[k].kind == b->factors[k].kind && a->factors[k].quantity == b->factors[k].quantity &&
                (k == place || a->factors[k].index == b->factors[k].index);
    return alike;
}

/* The column of a term whose factor number `place` is in this member. */
static int sort_into_column(Planning *p, RetexReduceKind *kind, int member, int term, int place, RetexError *err)
{
    const RetexTerm *terms = p->set->terms;
    RetexReduceColumn *column = NULL;
    for (int i = 0; i < kind->ncolumns && !column; i++) {
        RetexReduceColumn *other = &kind->columns[i];
        if (other->term >= 0 && other->from[member] < 0 && are_alike(&terms[other->term], &terms[term], place))
            column = other;
    }
    if (!column && !(column = add_column(kind, term, RETEX_REDUCE_NONE, 3, err)))
        return RETEX_ENOMEM;
    find_value(p->set, &terms[term], column->value);
    place_part(p, kind, column, member, terms[term].radiance);
    p->in_columns[term] = 1;
    return RETEX_OK;
}

/* Sort a term: if one of its factors is one of several footprints of a kind, its radiance follows what becomes of
 * them. */
static int sort_term(Planning *p, int number, RetexError *err)
{
    const RetexTerm *term = &p->set->terms[number];
    int place = RETEX_REDUCE_NONE, code = RETEX_OK;
    for (int k = 0; k < term->nfactors && !code; k++) {
        int member, seen = 0;
        if (term->factors[k].kind == RETEX_FACTOR_IMAGE)
            p->unknown = "its terms have images as factors";
        if (term->factors[k].kind != RETEX_FACTOR_FOOTPRINT)
            continue;
        for (int i = 0; i < k; i++)
            seen |= memcmp(&term->factors[i], &term->factors[k], sizeof *term->factors) == 0;
        RetexReduceKind *kind = find_member(p->plan, p->set, term->factors[k].index, &member);
        if (kind->count == 1 && !seen && retex_term_is_light(term))
            code = add_light(&kind->light, &kind->nlight, p->set, term, err);
        if (kind->count > 1 && place >= 0)
            p->unknown = "its terms have several of a kind's footprints";
        if (kind->count > 1)
            place = k;
    }
    if (place < 0 || p->unknown || code)
        return code;
    int member;
    RetexReduceKind *kind = find_member(p->plan, p->set, term->factors[place].index, &member);
    return sort_into_column(p, kind, member, number, place, err);
}

/* ---- weights ---- */

static int has_part(const RetexReduceWeights *weights, int part)
{
    for (int i = 0; i < weights->nparts; i++)
        if (weights->parts[i] == part)
            return 1;
    return 0;
}

static int add_weight(RetexReduceWeights *weights, int part, RetexError *err)
{
    int *parts = has_part(weights, part) ? weights->parts
                                         : realloc(weights->parts, ((size_t)weights->nparts + 1) * sizeof *parts);
    if (!parts)
        return no_memory(err);
    weights->parts = parts;
    if (!has_part(weights, part))
        parts[weights->nparts++] = part;
    return RETEX_OK;
}

/* Merge weights number j into number i, and number all columns anew. */
static int join_weights(RetexReducePlan *plan, int *of, int nmixtures, int i, int j, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < plan->weights[j].nparts && !code; k++)
        code = add_weight(&plan->weights[i], plan->weights[j].parts[k], err);
    for (int m = 0; m < nmixtures; m++)
        of[m] = of[m] == j ? i : of[m];
    plan->weights[j].nparts = 0;
    return code;
}

/* Find weights that are relative to the same sum: those of mixtures that share parts. of: by mixture, which. */
static int find_weights(Planning *p, int of[RETEX_MIXTURES_MAX], RetexError *err)
{
    const RetexSet *set = p->set;
    RetexReducePlan *plan = p->plan;
    int code = RETEX_OK;
    plan->nweights = set->nmixtures;
    for (int m = 0; m < set->nmixtures && !code; m++) {
        of[m] = m;
        for (int k = 0; k < set->mixtures[m].nshares && !code; k++)
            code = add_weight(&plan->weights[m], set->mixtures[m].shares[k].weight, err);
        for (int i = 0; i < m && !code; i++)
            for (int k = 0; k < plan->weights[i].nparts && !code; k++)
                if (has_part(&plan->weights[of[m]], plan->weights[i].parts[k]))
                    code = join_weights(plan, of, m + 1, of[m], i, err);
    }
    for (int t = 0; t < set->nterms && !code; t++)
        for (int k = 0; k < set->terms[t].nfactors && !code; k++) {
            const RetexFactor factor = set->terms[t].factors[k];
            int seen = 0;
            if (factor.kind != RETEX_FACTOR_MIXTURE || !retex_term_is_light(&set->terms[t]))
                continue;
            for (int i = 0; i < k; i++)
                seen |= set->terms[t].factors[i].kind == RETEX_FACTOR_MIXTURE &&
                        of[set->terms[t].factors[i].index] == of[factor.index];
            RetexReduceWeights *weights = &plan->weights[of[factor.index]];
            if (!seen)
                code = add_light(&weights->light, &weights->nlight, set, &set->terms[t], err);
        }
    return code;
}

/* Whether weights are the radiance of terms, which merged footprints have the sum of. */
static int are_radiance(const Planning *p, const RetexReduceWeights *weights)
{
    for (int t = 0; t < p->set->nterms; t++)
        if (has_part(weights, p->set->terms[t].radiance))
            return 1;
    return 0;
}

/* Put the weights of a mixture into columns of their kinds. */
static int sort_mixture(Planning *p, int number, int weights, RetexError *err)
{
    const RetexMixture *mixture = &p->set->mixtures[number];
    const int radiance = are_radiance(p, &p->plan->weights[weights]);
    for (int k = 0; k < mixture->nshares; k++) {
        int member;
        const int part = mixture->shares[k].weight;
        RetexReduceKind *kind = find_member(p->plan, p->set, mixture->shares[k].footprint, &member);
        RetexReduceColumn *column = kind->ncolumns ? &kind->columns[kind->ncolumns - 1] : NULL;
        if ((!column || column->mixture != number) &&
            !(column = add_column(kind, RETEX_REDUCE_NONE, number, p->set->parts[part].image.channels, err)))
            return RETEX_ENOMEM;
        if (column->channels != p->set->parts[part].image.channels || column->from[member] >= 0)
            p->unknown = "its mixtures are of another form than those of layout footprints";
        column->weights = radiance ? RETEX_REDUCE_NONE : weights;
        place_part(p, kind, column, member, part);
    }
    return RETEX_OK;
}

static int sort_light(Planning *p, RetexError *err)
{
    int of[RETEX_MIXTURES_MAX], code = RETEX_OK;
    for (int t = 0; t < p->set->nterms && !code && !p->unknown; t++)
        code = sort_term(p, t, err);
    if (!code && !p->unknown)
        code = find_weights(p, of, err);
    for (int m = 0; m < p->set->nmixtures && !code && !p->unknown; m++)
        code = sort_mixture(p, m, of[m], err);
    for (int t = 0; t < p->set->nterms && !p->unknown; t++)
        if (!p->in_columns[t] && p->plan->rules[p->set->terms[t].radiance] != RETEX_REDUCE_MEAN)
            p->unknown = "its parts are used for several things";
    return code;
}

/* ---- rules ---- */

static void find_rule(void *context, RetexPartUse use, int user, int *part)
{
    Planning *p = context;
    const RetexImage *image = &p->set->parts[*part].image;
    RetexReduceRule *rule = &p->plan->rules[*part];
    (void)user;
    if (use == RETEX_PART_ORIGINAL)
        *rule = RETEX_REDUCE_ORIGINAL;
    else if (image->width != p->set->width || image->height != p->set->height)
        p->unknown = "its images have several sizes, as those of packs have";
    else if (use == RETEX_PART_UV || use == RETEX_PART_SPREAD || use == RETEX_PART_ALBEDO)
        *rule = RETEX_REDUCE_FOOTPRINT;
}

static void find_rules(Planning *p)
{
    for (int i = 0; i < p->set->nparts; i++) {
        const int aov = retex_aov_find(p->set->parts[i].name);
        p->plan->rules[i] = retex_part_is_denoise_data(p->set, i) ? RETEX_REDUCE_DROPPED : RETEX_REDUCE_MEAN;
        if (aov >= 0 && !(AVERAGED_AOVS >> aov & 1) && !retex_part_is_used(p->set, i))
            p->plan->rules[i] = RETEX_REDUCE_CENTRE;
    }
    retex_set_visit_const_parts(p->set, find_rule, p);
}

/* ---- the reduced set ---- */

static int reduced_size(int size, int scale)
{
    return (size + scale - 1) / scale;
}

static int add_part(Planning *p, int part, RetexError *err)
{
    const RetexPart *old = &p->set->parts[part];
    const int original = p->plan->rules[part] == RETEX_REDUCE_ORIGINAL;
    const int ellipse = p->plan->rules[part] == RETEX_REDUCE_FOOTPRINT && old->image.channels == 2;
    return retex_set_add_part(p->plan->reduced, old->name, ellipse ? "RGB" : old->letters, old->type,
                              original ? reduced_size(old->image.width, p->scale) : 0,
                              original ? reduced_size(old->image.height, p->scale) : 0, &p->plan->to[part], err);
}

/* Give a column a part for a member where it had none. */
static int add_member_part(Planning *p, RetexReduceColumn *column, int member, RetexError *err)
{
    RetexSet *reduced = p->plan->reduced;
    int like = 0;
    while (column->from[like] < 0)
        like++;
    const RetexPart *part = &p->set->parts[column->from[like]];
    char name[2 * RETEX_NAME_MAX];
    snprintf(name, sizeof name, "%.*s_slot%d", RETEX_NAME_MAX - 16, part->name, member + 1);
    for (int i = 2; retex_set_find_part(reduced, name) >= 0; i++)
        snprintf(name, sizeof name, "%.*s_slot%d-%d", RETEX_NAME_MAX - 16, part->name, member + 1, i);
    return retex_set_add_part(reduced, name, part->letters, part->type, 0, 0, &column->to[member], err);
}

static int add_member_parts(Planning *p, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < p->plan->nkinds; i++) {
        RetexReduceKind *kind = &p->plan->kinds[i];
        for (int j = 0; j < kind->ncolumns; j++)
            for (int k = 0; k < kind->count && !code; k++) {
                RetexReduceColumn *column = &kind->columns[j];
                if (column->from[k] >= 0)
                    column->to[k] = p->plan->to[column->from[k]];
                else
                    code = add_member_part(p, column, k, err);
            }
    }
    return code;
}

static int add_footprints(Planning *p, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < p->set->nfootprints && !code; i++) {
        RetexFootprint f = p->set->footprints[i];
        int member;
        RetexReduceKind *kind = find_member(p->plan, p->set, i, &member);
        f.uv = p->plan->to[f.uv], f.spread = p->plan->to[f.spread], f.albedo = p->plan->to[f.albedo];
        code = retex_set_add_footprint(p->plan->reduced, &f, &kind->to[member], err);
    }
    return code;
}

/* Mixtures have weights of all members of the kinds that they mix. */
static int add_mixture(Planning *p, int number, RetexError *err)
{
    RetexMixture mixture = {0};
    for (int i = 0; i < p->plan->nkinds; i++) {
        const RetexReduceKind *kind = &p->plan->kinds[i];
        for (int j = 0; j < kind->ncolumns; j++)
            for (int k = 0; k < kind->count && kind->columns[j].mixture == number; k++) {
                if (mixture.nshares == RETEX_SHARES_MAX)
                    return retex_fail(err, RETEX_EUNSUPPORTED,
                                      "the set cannot be reduced: a mixture would have more "
                                      "than %d shares",
                                      RETEX_SHARES_MAX);
                mixture.shares[mixture.nshares++] = (struct RetexShare){kind->to[k], kind->columns[j].to[k]};
            }
    }
    return retex_set_add_mixture(p->plan->reduced, &mixture, NULL, err);
}

/* Add the terms of a column's members that had no light. */
static int add_member_terms(Planning *p, const RetexReduceKind *kind, const RetexReduceColumn *column, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < kind->count && column->term >= 0 && !code; k++) {
        RetexTerm term = p->set->terms[column->term];
        if (column->from[k] >= 0)
            continue;
        term.noise_weight = 0;
        term.radiance = column->to[k];
        for (int i = 0; i < term.nfactors; i++)
            for (int j = 0; j < kind->count && term.factors[i].kind == RETEX_FACTOR_FOOTPRINT; j++)
                if (term.factors[i].index == kind->from[j]) {
                    term.factors[i].index = kind->to[k];
                    break;
                }
        code = retex_set_add_term(p->plan->reduced, &term, NULL, err);
    }
    return code;
}

static int add_terms(Planning *p, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < p->set->nterms && !code; t++) {
        RetexTerm term = p->set->terms[t];
        term.noise_weight = 0; /* noise is left out */
        term.radiance = p->plan->to[term.radiance];
        code = retex_set_add_term(p->plan->reduced, &term, NULL, err);
    }
    for (int i = 0; i < p->plan->nkinds; i++)
        for (int j = 0; j < p->plan->kinds[i].ncolumns && !code; j++)
            code = add_member_terms(p, &p->plan->kinds[i], &p->plan->kinds[i].columns[j], err);
    return code;
}

static int make_reduced(Planning *p, RetexError *err)
{
    RetexReducePlan *plan = p->plan;
    const RetexSet *set = p->set;
    const long spp = (long)set->spp * p->scale * p->scale;
    int code = retex_compact_copy_head(&plan->reduced, set, err);
    if (code)
        return code;
    plan->reduced->width = reduced_size(set->width, p->scale);
    plan->reduced->height = reduced_size(set->height, p->scale);
    plan->reduced->spp = spp < SPP_MOST ? (int)spp : SPP_MOST;
    for (int i = 0; i < set->nparts && !code; i++)
        if (plan->rules[i] != RETEX_REDUCE_DROPPED)
            code = add_part(p, i, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        if (set->targets[t].original >= 0)
            plan->reduced->targets[t].original = plan->to[set->targets[t].original];
    if (!code)
        code = add_member_parts(p, err);
    if (!code)
        code = add_footprints(p, err);
    for (int m = 0; m < set->nmixtures && !code; m++)
        code = add_mixture(p, m, err);
    return code ? code : add_terms(p, err);
}

/* ---- all of it ---- */

static int alloc_planning(Planning *p, RetexError *err)
{
    const size_t parts = (size_t)p->set->nparts;
    p->plan->rules = calloc(parts + 1, sizeof *p->plan->rules);
    p->plan->to = malloc((parts + 1) * sizeof *p->plan->to);
    p->members = malloc((parts + 1) * sizeof *p->members);
    p->in_columns = calloc((size_t)p->set->nterms + 1, 1);
    if (!p->plan->rules || !p->plan->to || !p->members || !p->in_columns)
        return no_memory(err);
    for (size_t i = 0; i < parts; i++)
        p->plan->to[i] = p->members[i] = RETEX_REDUCE_NONE;
    return RETEX_OK;
}

int retex_reduce_plan_open(RetexReducePlan *plan, const RetexSet *set, int scale, RetexError *err)
{
    Planning p = {.plan = plan, .set = set, .scale = scale};
    *plan = (RetexReducePlan){0};
    int code = alloc_planning(&p, err);
    if (!code && strcmp(set->layout, "footprints") != 0 && set->nterms)
        p.unknown = "it is not of layout footprints";
    if (!code && !p.unknown)
        find_rules(&p);
    if (!code && !p.unknown && !sort_footprints(&p))
        p.unknown = "its footprints are of another form than those of layout footprints";
    if (!code && !p.unknown)
        code = sort_light(&p, err);
    if (!code && p.unknown)
        code = retex_fail(err, RETEX_EUNSUPPORTED, "the set cannot be reduced: %s", p.unknown);
    if (!code)
        code = make_reduced(&p, err);
    free(p.members);
    free(p.in_columns);
    if (code) {
        retex_set_close(&plan->reduced);
        retex_reduce_plan_close(plan);
    }
    return code;
}

void retex_reduce_plan_close(RetexReducePlan *plan)
{
    for (int i = 0; i < plan->nkinds; i++) {
        free(plan->kinds[i].columns);
        free(plan->kinds[i].light);
    }
    for (int i = 0; i < plan->nweights; i++) {
        free(plan->weights[i].parts);
        free(plan->weights[i].light);
    }
    free(plan->rules);
    free(plan->to);
    *plan = (RetexReducePlan){0};
}
