/* See edited.h. */
#include "precision/edited.h"

#include <stdlib.h>
#include <string.h>

#include "set/strip.h"
#include "set/set.h"

typedef struct Corrections {
    int powers;                         /* the most factors, or -1 */
    int first[RETEX_EDITED_POWERS + 1]; /* in terms, by the number of factors */
    int *terms;
} Corrections;

struct RetexEdited {
    int ntargets;
    int nlight, *light; /* terms */
    Corrections of[RETEX_MAX_TARGETS];
};

/* ---- the set ---- */

static int is_whole(const RetexSet *set, int part, int channels)
{
    const RetexImage *im = part < 0 ? NULL : &set->parts[part].image;
    return im && im->channels == channels && im->width == set->width && im->height == set->height;
}

/* Whether a term has factors beside textures, and the weight of a correction. */
static int has_values(const RetexSet *set, const RetexTerm *term)
{
    int values = 0;
    for (int k = 0; k < term->nfactors; k++) {
        const RetexFactor factor = term->factors[k];
        values |=
            factor.kind == RETEX_FACTOR_IMAGE ||
            (factor.kind == RETEX_FACTOR_PARAMETER && set->parameters[factor.index].kind != RETEX_PARAMETER_CORRECTION);
    }
    return values;
}

/* Whether a term is part of what corrections are computed from: of all light, not of lamps. */
static int counts(const RetexSet *set, const RetexTerm *term)
{
    return (retex_term_is_light(term) || term->role == RETEX_ROLE_CORRECTION) && retex_set_term_lamp(set, term) < 0;
}

static int mixture_counts(const RetexSet *set, int mixture)
{
    for (int t = 0; t < set->nterms; t++)
        for (int k = 0; k < set->terms[t].nfactors && counts(set, &set->terms[t]); k++)
            if (set->terms[t].factors[k].kind == RETEX_FACTOR_MIXTURE && set->terms[t].factors[k].index == mixture)
                return 1;
    return 0;
}

static int is_plain(const RetexSet *set)
{
    int plain = 1;
    for (int t = 0; t < set->nterms; t++)
        plain = plain && (!counts(set, &set->terms[t]) || !has_values(set, &set->terms[t])) &&
                is_whole(set, set->terms[t].radiance, 3);
    for (int f = 0; f < set->nfootprints; f++)
        plain = plain && is_whole(set, set->footprints[f].uv, 3) && is_whole(set, set->footprints[f].albedo, 3);
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            plain = plain && (!mixture_counts(set, m) || is_whole(set, set->mixtures[m].shares[k].weight, 1));
    return plain;
}

static int list_terms(Corrections *list, const RetexSet *set, int target)
{
    int count = 0;
    list->powers = -1;
    list->terms = malloc(sizeof *list->terms * (size_t)(set->nterms + 1));
    for (int n = 0; n < RETEX_EDITED_POWERS && list->terms; n++) {
        list->first[n] = count;
        for (int t = 0; t < set->nterms; t++)
            if (set->terms[t].role == RETEX_ROLE_CORRECTION && set->terms[t].target == target &&
                retex_term_hits(&set->terms[t]) == n && retex_set_term_lamp(set, &set->terms[t]) < 0)
                list->terms[count++] = t, list->powers = n;
        list->first[n + 1] = count;
    }
    return list->terms != NULL;
}

int retex_edited_open(RetexEdited **result, const RetexSet *set, RetexError *err)
{
    RetexEdited *edited = *result = calloc(1, sizeof *edited);
    int plain = is_plain(set);
    if (!edited)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the corrections of a set");
    edited->ntargets = set->ntargets;
    edited->light = malloc(sizeof *edited->light * (size_t)(set->nterms + 1));
    for (int t = 0; t < set->nterms && edited->light; t++)
        if (retex_term_is_light(&set->terms[t]))
            edited->light[edited->nlight++] = t;
    for (int t = 0; t < set->ntargets; t++) {
        if (!list_terms(&edited->of[t], set, t) || !edited->light) {
            retex_edited_close(result);
            return retex_fail(err, RETEX_ENOMEM, "no memory for the corrections of a set");
        }
        if (!plain)
            edited->of[t].powers = -1;
    }
    return RETEX_OK;
}

void retex_edited_close(RetexEdited **edited)
{
    for (int t = 0; *edited && t < (*edited)->ntargets; t++)
        free((*edited)->of[t].terms);
    if (*edited)
        free((*edited)->light);
    free(*edited);
    *edited = NULL;
}

int retex_edited_powers(const RetexEdited *edited, int target)
{
    return edited->of[target].powers;
}

int retex_edited_terms(const RetexEdited *edited, int target, int power, const int **terms)
{
    const Corrections *list = &edited->of[target];
    *terms = list->terms + list->first[power];
    return list->first[power + 1] - list->first[power];
}

int retex_edited_light_count(const RetexEdited *edited)
{
    return edited->nlight;
}

static int is_black(const float *radiance)
{
    return radiance[0] == 0 && radiance[1] == 0 && radiance[2] == 0;
}

int retex_edited_find_lit(const RetexEdited *edited, const RetexSet *rows, size_t at, int *lit)
{
    int count = 0;
    for (int t = 0; t < edited->nlight; t++)
        if (!is_black(retex_pixel_at(rows, rows->terms[edited->light[t]].radiance, at)))
            lit[count++] = edited->light[t];
    return count;
}

/* ---- one pixel ---- */

/* A factor: so much of the edited target's colour, and a colour of the others. */
typedef struct Factor {
    double share, color[3];
} Factor;

static void add_footprint(Factor *factor, const RetexSet *rows, int footprint, double weight, int target, size_t at)
{
    const RetexFootprint *f = &rows->footprints[footprint];
    if (f->target == target) {
        factor->share += weight;
        return;
    }
    const float *albedo = retex_pixel_at(rows, f->albedo, at);
    for (int c = 0; c < 3; c++)
        factor->color[c] += weight * (double)albedo[c];
}

static Factor mixture_factor(const RetexSet *rows, const RetexMixture *mixture, int target, size_t at)
{
    Factor factor = {0, {0, 0, 0}};
    double sum = 0;
    for (int k = 0; k < mixture->nshares; k++) {
        const double weight = (double)*retex_pixel_at(rows, mixture->shares[k].weight, at);
        if (weight > 0)
            add_footprint(&factor, rows, mixture->shares[k].footprint, weight, target, at);
        sum += weight;
    }
    for (int c = 0; c < 3 && sum > 0; c++)
        factor.color[c] /= sum;
    factor.share /= sum > 0 ? sum : 1;
    return factor;
}

/* Multiply a polynomial of so many powers by a factor. Returns how many it has then. */
static int multiply(RetexEditedLight polynomial, int powers, const Factor *factor, int most)
{
    const int more = factor->share > 0 && powers < most;
    for (int c = 0; c < 3; c++) {
        const double last = polynomial[powers][c] * factor->share;
        for (int n = powers; n >= 0; n--)
            polynomial[n][c] = polynomial[n][c] * factor->color[c] + (n > 0 ? polynomial[n - 1][c] * factor->share : 0);
        if (more)
            polynomial[powers + 1][c] = last;
        else
            polynomial[powers][c] += last;
    }
    return powers + more;
}

/* The mixtures of a pixel that were asked for. */
typedef struct KnownMixtures {
    char known[RETEX_MIXTURES_MAX];
    Factor of[RETEX_MIXTURES_MAX];
} KnownMixtures;

static const Factor *find_mixture(KnownMixtures *all, const RetexSet *rows, int mixture, int target, size_t at)
{
    if (!all->known[mixture])
        all->of[mixture] = mixture_factor(rows, &rows->mixtures[mixture], target, at);
    all->known[mixture] = 1;
    return &all->of[mixture];
}

void retex_edited_light(const RetexEdited *edited, const RetexSet *rows, int target, size_t at, const int *lit,
                        int nlit, RetexEditedLight light)
{
    const int most = edited->of[target].powers;
    KnownMixtures mixtures;
    memset(light, 0, sizeof(RetexEditedLight));
    if (most < 0)
        return;
    memset(mixtures.known, 0, (size_t)rows->nmixtures);
    for (int t = 0; t < nlit; t++) {
        const RetexTerm *term = &rows->terms[lit[t]];
        const float *radiance = retex_pixel_at(rows, term->radiance, at);
        RetexEditedLight product;
        int powers = 0;
        if (is_black(radiance))
            continue;
        for (int c = 0; c < 3; c++)
            product[0][c] = (double)radiance[c];
        for (int k = 0; k < term->nfactors; k++) {
            const RetexFactor factor = term->factors[k];
            Factor own = {0, {0, 0, 0}};
            if (factor.kind == RETEX_FACTOR_FOOTPRINT)
                add_footprint(&own, rows, factor.index, 1, target, at);
            powers = multiply(product, powers,
                              factor.kind == RETEX_FACTOR_MIXTURE
                                  ? find_mixture(&mixtures, rows, factor.index, target, at)
                                  : &own,
                              most);
        }
        for (int n = 0; n <= powers; n++)
            for (int c = 0; c < 3; c++)
                light[n][c] += product[n][c];
    }
}

int retex_edited_is_seen(const RetexSet *rows, const RetexTerm *term, size_t at)
{
    int seen = 1;
    for (int k = 0; k < term->nfactors && seen; k++) {
        const RetexFactor factor = term->factors[k];
        if (factor.kind == RETEX_FACTOR_FOOTPRINT)
            seen = retex_pixel_at(rows, rows->footprints[factor.index].uv, at)[2] > 0;
        if (factor.kind != RETEX_FACTOR_MIXTURE)
            continue;
        const RetexMixture *mixture = &rows->mixtures[factor.index];
        seen = 0;
        for (int j = 0; j < mixture->nshares; j++)
            seen = seen || *retex_pixel_at(rows, mixture->shares[j].weight, at) > 0;
    }
    return seen;
}
