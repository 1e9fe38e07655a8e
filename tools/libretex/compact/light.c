/* Sorts the terms and footprints of a set by target and kind. See light.h. */
#include "compact/light.h"

#include <stdlib.h>
#include <string.h>

#include "compact/orders.h"
#include "set/set.h"
#include "set/signals.h"

static RetexCompactKind *find_kind(RetexCompactLight *light, int target, RetexFootprintKind kind)
{
    for (int i = 0; i < light->nkinds; i++)
        if (light->kinds[i].target == target && light->kinds[i].kind == kind)
            return &light->kinds[i];
    return NULL;
}

static int is_whole(const RetexSet *set, const RetexFootprint *f)
{
    return f->uv >= 0 && f->spread >= 0 && f->albedo >= 0 && retex_set_spread_channels(set, f->spread) > 2 &&
           set->parts[f->uv].image.width == set->width && set->parts[f->uv].image.height == set->height &&
           set->parts[f->spread].image.width == set->width && set->parts[f->spread].image.height == set->height &&
           set->parts[f->albedo].image.width == set->width && set->parts[f->albedo].image.height == set->height;
}

static int sort_footprints(RetexCompactLight *light)
{
    const RetexSet *set = light->set;
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        RetexCompactKind *kind = find_kind(light, f->target, f->kind);
        if (f->kind == RETEX_FOOTPRINT_HIT || !is_whole(set, f))
            return 0;
        if (!kind) {
            kind = &light->kinds[light->nkinds++];
            *kind = (RetexCompactKind){.target = f->target, .kind = f->kind};
        }
        if (kind->count == RETEX_SHARES_MAX)
            return 0;
        kind->footprints[kind->count] = i;
        kind->share[kind->count] = -1;
        kind->count++;
    }
    return 1;
}

/* Whether light other than that of single lamps has a mixture. That of single lamps is spread as all light is. */
static int is_mixture_of_all(const RetexSet *set, int mixture)
{
    for (int i = 0; i < set->nterms; i++)
        for (int k = 0; k < set->terms[i].nfactors; k++)
            if (set->terms[i].factors[k].kind == RETEX_FACTOR_MIXTURE && set->terms[i].factors[k].index == mixture &&
                set->terms[i].role != RETEX_ROLE_LAMP)
                return 1;
    return 0;
}

/* Find the weights of footprints in mixtures. All footprints of a mixture must have one kind; those of interreflections
 * may be of several targets. */
static int sort_shares(RetexCompactLight *light)
{
    const RetexSet *set = light->set;
    for (int m = 0; m < set->nmixtures; m++) {
        if (!is_mixture_of_all(set, m))
            continue;
        const RetexMixture *mixture = &set->mixtures[m];
        const RetexFootprint *first = &set->footprints[mixture->shares[0].footprint];
        for (int k = 0; k < mixture->nshares; k++) {
            const RetexFootprint *f = &set->footprints[mixture->shares[k].footprint];
            const int weight = mixture->shares[k].weight;
            RetexCompactKind *kind = find_kind(light, f->target, f->kind);
            if (f->kind != first->kind || (f->kind != RETEX_FOOTPRINT_INTERREFLECTION && f->target != first->target) ||
                set->parts[weight].image.channels != 1)
                return 0;
            for (int i = 0; i < kind->count; i++) {
                if (kind->footprints[i] != mixture->shares[k].footprint)
                    continue;
                if (kind->share[i] >= 0 && kind->share[i] != weight)
                    return 0;
                kind->share[i] = weight;
            }
        }
    }
    return 1;
}

/* Whether a term is light that meets a target, of all lamps or of one. */
static int is_sorted(const RetexTerm *term)
{
    return (retex_term_is_light(term) || term->role == RETEX_ROLE_LAMP) && retex_term_hits(term);
}

/* Sorts a term of single hits. */
static int sort_single(RetexCompactLight *light, RetexCompactKind *kind, RetexFactor hit, int number)
{
    const int lamps = light->lamps_of[number], alone = light->lamps[lamps].alone;
    int *single = kind->single[lamps], found = 0;
    for (int i = 0; i < kind->count; i++)
        if ((hit.kind == RETEX_FACTOR_FOOTPRINT ? kind->footprints[i] == hit.index : alone) && single[i] < 0)
            single[i] = number, found = 1;
    return found;
}

/* Sorts a term. Its first hit is the factor that is no interreflection. */
static int sort_term(RetexCompactLight *light, int number)
{
    const RetexTerm *term = &light->set->terms[number];
    if (!is_sorted(term))
        return 1;
    RetexCompactKind *kind = NULL;
    RetexFactor first = {0};
    int firsts = 0;
    for (int k = 0; k < term->nfactors; k++) {
        int target;
        RetexFootprintKind what;
        if (!retex_factor_is_hit(term->factors[k]))
            continue;
        retex_factor_target(light->set, term->factors[k], &target, &what);
        if (what == RETEX_FOOTPRINT_INTERREFLECTION)
            continue;
        kind = find_kind(light, target, what);
        first = term->factors[k];
        firsts++;
    }
    if (firsts != 1 || !kind)
        return 0;
    if (retex_term_hits(term) > 1) {
        if (kind->ninterreflections && memcmp(&first, &kind->first, sizeof first) != 0)
            return 0;
        kind->first = first;
        kind->interreflections[kind->ninterreflections++].term = number;
        return 1;
    }
    return sort_single(light, kind, first, number);
}

/* What a term has that is not made compact; NULL: nothing. lamps: 1: there are terms of role LAMP. */
static const char *unknown_factor(const RetexTerm *term, int lamps)
{
    int parameters = 0;
    for (int k = 0; k < term->nfactors && (retex_term_is_light(term) || term->role == RETEX_ROLE_LAMP); k++) {
        if (term->factors[k].kind == RETEX_FACTOR_IMAGE)
            return "its terms have images as factors";
        parameters += term->factors[k].kind == RETEX_FACTOR_PARAMETER;
    }
    if (lamps && parameters && retex_term_is_light(term))
        return "it has lamps of two forms";
    return parameters > RETEX_COMPACT_PARAMETERS ? "its terms have too many parameters" : NULL;
}

void retex_compact_rendered(const RetexSet *set, const RetexTerm *term, double value[3])
{
    double product[3] = {1, 1, 1};
    for (int k = 0; k < term->nfactors; k++)
        for (int c = 0; c < 3 && term->factors[k].kind == RETEX_FACTOR_PARAMETER; c++)
            product[c] *= (double)set->parameters[term->factors[k].index].value[c];
    const int black = !(product[0] > 0 || product[1] > 0 || product[2] > 0);
    for (int c = 0; c < 3; c++)
        value[c] = black ? 1 : product[c];
}

/* The number of a term's parameters in the list, to which they are added where they are new. */
static int find_lamps(RetexCompactLight *light, const RetexTerm *term)
{
    RetexCompactLamps own = {0};
    int i = 0;
    for (int k = 0; k < term->nfactors; k++)
        if (term->factors[k].kind == RETEX_FACTOR_PARAMETER)
            own.factors[own.count++] = term->factors[k];
    retex_compact_rendered(light->set, term, own.value);
    own.alone = term->role == RETEX_ROLE_LAMP;
    while (i < light->nlamps && (light->lamps[i].alone != own.alone ||
                                 memcmp(light->lamps[i].factors, own.factors, sizeof own.factors) != 0))
        i++;
    if (i == light->nlamps)
        light->lamps[light->nlamps++] = own;
    return i;
}

static int sort_lamps(RetexCompactLight *light, RetexError *err)
{
    for (int i = 0; i < light->set->nterms; i++)
        if (is_sorted(&light->set->terms[i]))
            light->lamps_of[i] = find_lamps(light, &light->set->terms[i]);
    light->all = -1;
    for (int i = 0; i < light->nlamps && retex_set_has_role(light->set, RETEX_ROLE_LAMP); i++)
        light->all = light->lamps[i].alone ? light->all : i;
    const size_t lists = (size_t)light->nkinds * (size_t)light->nlamps;
    light->singles = malloc((lists + 1) * sizeof *light->singles);
    if (!light->singles)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", light->set->nterms);
    memset(light->singles, -1, lists * sizeof *light->singles);
    for (int i = 0; i < light->nkinds; i++)
        light->kinds[i].single = light->singles + i * light->nlamps;
    return RETEX_OK;
}

static void find_greys(RetexCompactLight *light)
{
    for (int i = 0; i < light->set->nterms; i++) {
        const RetexTerm *term = &light->set->terms[i];
        light->greys[i] = is_sorted(term) && retex_term_hits(term) > 1 ? 1 : 0;
        for (int k = retex_term_hits(term); k > 1; k--)
            light->greys[i] *= RETEX_COMPACT_GREY;
    }
}

static const char *sort_all(RetexCompactLight *light)
{
    if (!sort_footprints(light))
        return "its footprints are of another form than those of layout footprints";
    if (!sort_shares(light))
        return "its mixtures are of another form than those of layout footprints";
    return light->nkinds ? NULL : "no target is in the picture";
}

int retex_compact_light_open(RetexCompactLight *light, const RetexSet *set, double noise, const char **unknown,
                             RetexError *err)
{
    *light = (RetexCompactLight){.set = set, .noise = noise};
    *unknown = sort_all(light);
    for (int i = 0; i < set->nterms && !*unknown; i++)
        *unknown = unknown_factor(&set->terms[i], retex_set_has_role(set, RETEX_ROLE_LAMP));
    if (*unknown)
        return RETEX_OK;
    light->interreflections = calloc((size_t)light->nkinds * (size_t)set->nterms + 1, sizeof *light->interreflections);
    light->greys = calloc((size_t)set->nterms + 1, sizeof *light->greys);
    light->lamps_of = calloc((size_t)set->nterms + 1, sizeof *light->lamps_of);
    light->lamps = calloc((size_t)set->nterms + 1, sizeof *light->lamps);
    if (!light->interreflections || !light->greys || !light->lamps_of || !light->lamps)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    find_greys(light);
    int code = sort_lamps(light, err);
    for (int i = 0; i < light->nkinds; i++)
        light->kinds[i].interreflections = light->interreflections + (size_t)i * (size_t)set->nterms;
    for (int i = 0; i < set->nterms && !*unknown && !code; i++)
        if (!sort_term(light, i))
            *unknown = "its terms are of another form than those of layout footprints";
    for (int i = 0; i < RETEX_COMPACT_CHOICES * light->nkinds && !*unknown && !code; i++)
        code =
            retex_compact_orders_make(&light->kinds[i / RETEX_COMPACT_CHOICES], light, i % RETEX_COMPACT_CHOICES, err);
    return code;
}

void retex_compact_light_close(RetexCompactLight *light)
{
    for (int i = 0; i < light->nkinds; i++) {
        for (int k = 0; k < RETEX_COMPACT_CHOICES; k++) {
            free(light->kinds[i].gains[k]);
            light->kinds[i].gains[k] = NULL;
        }
    }
    free(light->interreflections);
    free(light->greys);
    free(light->lamps_of);
    free(light->lamps);
    free(light->singles);
    light->interreflections = NULL;
    light->greys = NULL;
    light->lamps_of = NULL;
    light->lamps = NULL;
    light->singles = NULL;
}

static int is_covered(const RetexSet *set, int footprint, size_t pixel)
{
    return set->parts[set->footprints[footprint].uv].image.pixels[3 * pixel + 2] > 0;
}

/* The share of interreflected light whose first hit is on footprint k. */
static double share_of(const RetexCompactLight *light, const RetexCompactKind *kind, int k, size_t pixel)
{
    const int footprint = kind->footprints[k];
    if (!kind->ninterreflections || !is_covered(light->set, footprint, pixel))
        return 0;
    if (kind->first.kind == RETEX_FACTOR_FOOTPRINT)
        return kind->first.index == footprint;
    return kind->share[k] >= 0 ? (double)light->set->parts[kind->share[k]].image.pixels[pixel] : 0;
}

int retex_compact_has_interreflections(const RetexCompactLight *light, const RetexCompactKind *kind, size_t pixel)
{
    for (int k = 0; k < kind->count; k++)
        if (share_of(light, kind, k, pixel) > 0)
            return 1;
    return 0;
}

int retex_compact_has_single(const RetexCompactKind *kind, int lamps)
{
    int single = 0;
    for (int k = 0; k < kind->count; k++)
        single |= kind->single[lamps][k] >= 0;
    return single;
}

int retex_compact_has_further(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps)
{
    int further = 0;
    for (int i = 0; i < kind->ninterreflections; i++)
        further |= light->lamps_of[kind->interreflections[i].term] == lamps;
    return further;
}

int retex_compact_has_light(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps)
{
    return lamps >= 0 && (retex_compact_has_single(kind, lamps) || retex_compact_has_further(light, kind, lamps));
}

/* What the light of some lamps counts. */
static const double *value_of(const RetexCompactLight *light, int lamps, int wanted)
{
    static const double one[3] = {1, 1, 1}, none[3] = {0};
    if (wanted == RETEX_COMPACT_ALL_LAMPS)
        return light->lamps[lamps].alone ? none : light->lamps[lamps].value;
    return lamps == wanted ? one : none;
}

void retex_compact_cluster_light(const RetexCompactLight *light, const RetexCompactKind *kind, int lamps, size_t pixel,
                                 RetexCompactClusterLight of[RETEX_SHARES_MAX])
{
    const RetexSet *set = light->set;
    double interreflected[3] = {0}, shares[RETEX_SHARES_MAX], all = 0;
    for (int k = 0; k < kind->count; k++)
        all += shares[k] = share_of(light, kind, k, pixel);
    for (int i = 0; i < kind->ninterreflections && all > 0; i++) {
        const int number = kind->interreflections[i].term;
        if (light->lamps[light->lamps_of[number]].alone)
            continue;
        const float *radiance = set->parts[set->terms[number].radiance].image.pixels + 3 * pixel;
        const double *value = value_of(light, light->lamps_of[number], lamps);
        const float grey = light->greys[number];
        for (int c = 0; c < 3; c++)
            interreflected[c] += value[c] * (double)(grey * radiance[c]);
    }
    for (int k = 0; k < kind->count; k++) {
        of[k] = (RetexCompactClusterLight){0};
        for (int c = 0; c < 3 && all > 0; c++)
            of[k].interreflected[c] = interreflected[c] * shares[k] / all;
        for (int i = 0; i < light->nlamps && is_covered(set, kind->footprints[k], pixel); i++) {
            const int number = light->lamps[i].alone ? -1 : kind->single[i][k];
            const float *own = number >= 0 ? set->parts[set->terms[number].radiance].image.pixels + 3 * pixel : NULL;
            for (int c = 0; c < 3 && own; c++)
                of[k].single[c] += value_of(light, i, lamps)[c] * (double)own[c];
        }
    }
}

int retex_compact_light_without_hits(const RetexSet *set)
{
    int found = -1, count = 0;
    for (int i = 0; i < set->nterms; i++)
        if (retex_term_is_light(&set->terms[i]) && !set->terms[i].nfactors)
            found = i, count++;
    return count == 1 ? found : -1;
}

int retex_compact_is_lamp_share(const RetexTerm *term)
{
    return term->role == RETEX_ROLE_LAMP && !retex_term_hits(term);
}
