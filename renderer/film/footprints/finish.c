/* From the images of layout `footprints` to the parts, footprints, mixtures and terms of a set: all that a pixel may
 * have. What none has, retex_set_prune leaves out. */
#include <retex/host/set_build.h>

#include "film/footprints/lamps.h"
#include "film/noise.h"

/* A footprint of three parts; index: its number in the set. */
static int finish_footprint(FootprintFilm *film, RetexSet *set, const FootprintImages *images, RetexFootprint *f,
                            int *index, RetexError *err)
{
    int code = bands_move_part(film->bands, images->uv, set, &f->uv, err);
    if (!code)
        code = bands_move_part(film->bands, images->spread, set, &f->spread, err);
    if (!code)
        code = bands_move_part(film->bands, images->albedo, set, &f->albedo, err);
    return code ? code : retex_set_add_footprint(set, f, index, err);
}

/* A term of the factors that it has already; its radiance becomes known. */
static int finish_term(FootprintFilm *film, RetexSet *set, RetexTerm *term, int image, RetexError *err)
{
    int code = bands_move_part(film->bands, image, set, &term->radiance, err);
    return code ? code : retex_set_add_term(set, term, NULL, err);
}

/* Factors of the terms: which of the set's mixtures, or footprints, stand for what. */
typedef struct Places {
    RetexFactor kinds[RETEX_MAX_TARGETS][2];         /* all clusters of a kind, by interreflected light */
    RetexFactor lamp_kinds[RETEX_MAX_TARGETS][2];    /* the same by light that meets no other target */
    RetexFactor interreflections[RETEX_MAX_TARGETS]; /* further hits of a target */
    RetexFactor any;                                 /* further hits of all targets */
} Places;

static int finish_mixture(RetexSet *set, const RetexMixture *mixture, RetexFactor *place, RetexError *err)
{
    int index = 0, code = retex_set_add_mixture(set, mixture, &index, err);
    *place = retex_factor(RETEX_FACTOR_MIXTURE, index);
    return code;
}

static void add_share(RetexMixture *mixture, int footprint, int weight)
{
    mixture->shares[mixture->nshares++] = (struct RetexShare){footprint, weight};
}

static void add_factors(RetexTerm *term, RetexFactor factor, int count)
{
    for (int n = 0; n < count; n++)
        term->factors[term->nfactors++] = factor;
}

static RetexRole role_of(int kind)
{
    return kind ? RETEX_ROLE_BROAD : RETEX_ROLE_SHARP;
}

/* All footprints of a kind. */
typedef struct KindMixtures {
    RetexMixture interreflected, light;
} KindMixtures;

/* A footprint of a kind: its own light, and its place in the mixture of all. */
static int finish_member(FootprintFilm *film, RetexSet *set, const RetexFootprint *f, int index, int light, int share,
                         KindMixtures *all, RetexError *err)
{
    RetexTerm term = {.role = role_of(f->kind == RETEX_FOOTPRINT_BROAD), .target = f->target};
    int weight;
    add_factors(&term, retex_factor(RETEX_FACTOR_FOOTPRINT, index), 1);
    int code = finish_term(film, set, &term, light, err);
    add_share(&all->light, index, term.radiance);
    if (code || film->plan.count == 1)
        return code;
    code = bands_move_part(film->bands, share, set, &weight, err);
    add_share(&all->interreflected, index, weight);
    return code;
}

/* The quarters of pixels, which share all but light. */
static int finish_quadrants(FootprintFilm *film, RetexSet *set, int t, KindMixtures *all, RetexError *err)
{
    const QuadrantImages *images = &film->targets[t].quadrants;
    RetexFootprint f = {.target = t, .kind = RETEX_FOOTPRINT_SHARP};
    int index, code = bands_move_part(film->bands, images->uv, set, &f.uv, err);
    if (!code)
        code = bands_move_part(film->bands, images->axes, set, &f.spread, err);
    if (!code)
        code = bands_move_part(film->bands, images->albedo, set, &f.albedo, err);
    for (int k = 0; k < RETEX_QUADRANTS && !code; k++) {
        f.quadrant = k + 1;
        f.hit = 1 + most_of_kind(&film->params, 0) + most_of_kind(&film->params, 1) + most_interreflections(film) + k;
        code = retex_set_add_footprint(set, &f, &index, err);
        if (!code)
            code = finish_member(film, set, &f, index, images->light[k], images->share[k], all, err);
    }
    return code;
}

/* The clusters of one kind, each with the light that meets no other target. */
static int finish_kind(FootprintFilm *film, RetexSet *set, int t, int kind, Places *places, RetexError *err)
{
    KindMixtures all = {0};
    int code = RETEX_OK;
    for (int k = 0; k < most_of_kind(&film->params, kind) && !code; k++) {
        const FootprintImages *images = &film->targets[t].kinds[kind].of[k];
        RetexFootprint f = {.target = t, .hit = 1 + k + kind * most_of_kind(&film->params, 0)};
        int index;
        f.kind = kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP;
        code = finish_footprint(film, set, images, &f, &index, err);
        if (!code)
            code = finish_member(film, set, &f, index, images->light, images->share, &all, err);
    }
    if (!code && kind == 0 && film->quadrants)
        code = finish_quadrants(film, set, t, &all, err);
    if (!code && film->lamps)
        code = finish_mixture(set, &all.light, &places->lamp_kinds[t][kind], err);
    return code || film->plan.count == 1 ? code
                                         : finish_mixture(set, &all.interreflected, &places->kinds[t][kind], err);
}

static int finish_interreflections(FootprintFilm *film, RetexSet *set, int t, RetexMixture *any, Places *places,
                                   RetexError *err)
{
    RetexMixture own = {0};
    int code = RETEX_OK;
    for (int k = 0; k < most_interreflections(film) && !code; k++) {
        const FootprintImages *images = &film->targets[t].interreflections[k];
        RetexFootprint f = {.target = t, .kind = RETEX_FOOTPRINT_INTERREFLECTION};
        int index, weight;
        f.hit = 1 + most_of_kind(&film->params, 0) + most_of_kind(&film->params, 1) + k;
        code = finish_footprint(film, set, images, &f, &index, err);
        if (!code)
            code = bands_move_part(film->bands, images->share, set, &weight, err);
        if (code)
            break;
        add_share(&own, index, weight);
        add_share(any, index, weight);
    }
    return code || !own.nshares ? code : finish_mixture(set, &own, &places->interreflections[t], err);
}

/* Whether light with still more hits is in the coefficient: the last one of a target, or of any. */
static int goes_on(const FootprintFilm *film, const Plan *plan, int coefficient)
{
    return plan->most == film->plan.most && coefficient == plan->count - 1 &&
           (film->scene->ntargets == 1 || plan->coefficients[coefficient].mixed);
}

/* The factors of interreflected light of one kind, and its weight. */
static void add_interreflected_factors(RetexTerm *term, const FootprintFilm *film, const Plan *plan, int t, int kind,
                                       int coefficient, const Places *places)
{
    const PlanCoefficient *c = &plan->coefficients[coefficient];
    term->noise_weight = noise_count(&film->params, film->scene->ntargets) ? (float)c->weight : 0;
    add_factors(term, places->kinds[t][kind], 1);
    add_factors(term, places->any, c->mixed);
    for (int b = 0; b < film->scene->ntargets; b++)
        add_factors(term, places->interreflections[b], c->powers[b]);
    if (goes_on(film, plan, coefficient)) {
        RetexFactor further = term->factors[term->nfactors - 1];
        further.quantity = RETEX_QUANTITY_FURTHER;
        add_factors(term, further, 1);
    }
}

static int finish_interreflected(FootprintFilm *film, RetexSet *set, int t, int kind, const Places *places,
                                 RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 1; i < film->plan.count && !code; i++) {
        RetexTerm term = {.role = role_of(kind), .target = t};
        add_interreflected_factors(&term, film, &film->plan, t, kind, i, places);
        code = finish_term(film, set, &term, film->targets[t].kinds[kind].interreflected[i], err);
    }
    return code;
}

/* ---- lamps ---- */

/* A lamp's light whose first hit is of a kind, in the order of the plan. */
static int finish_lamp_kind(FootprintFilm *film, RetexSet *set, const int *images, int t, int kind, int parameter,
                            const Places *places, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < film->lamp_plan.count && !code; i++) {
        RetexTerm term = {.role = RETEX_ROLE_LAMP, .target = t};
        if (i == 0)
            add_factors(&term, places->lamp_kinds[t][kind], 1);
        else
            add_interreflected_factors(&term, film, &film->lamp_plan, t, kind, i, places);
        add_factors(&term, retex_factor(RETEX_FACTOR_PARAMETER, parameter), 1);
        code = finish_term(film, set, &term, images[i], err);
    }
    return code;
}

static int finish_lamps(FootprintFilm *film, RetexSet *set, const Places *places, RetexError *err)
{
    int code = RETEX_OK, parameter;
    for (int l = 0; l < film->scene->nkept && !code; l++) {
        const LampImages *images = &film->lamps[l];
        RetexTerm picture = {.role = RETEX_ROLE_LAMP_PICTURE, .target = -1},
                  indep = {.role = RETEX_ROLE_LAMP, .target = -1};
        const RetexParameter lamp = kept_parameter(film->scene, l);
        code = retex_set_add_parameter(set, &lamp, &parameter, err);
        add_factors(&picture, retex_factor(RETEX_FACTOR_PARAMETER, parameter), 1);
        add_factors(&indep, retex_factor(RETEX_FACTOR_PARAMETER, parameter), 1);
        if (!code && film->scene->ntargets)
            code = finish_term(film, set, &picture, images->picture, err);
        if (!code)
            code = finish_term(film, set, &indep, images->indep, err);
        for (int t = 0; t < film->scene->ntargets; t++)
            for (int kind = 0; kind < 2 && !code; kind++)
                code = finish_lamp_kind(film, set, images->kinds[t][kind], t, kind, parameter, places, err);
    }
    return code;
}

static int finish_correction(FootprintFilm *film, RetexSet *set, int t, int kind, int n, const Places *places,
                             RetexError *err)
{
    const CorrectionImages *images = &film->targets[t].corrections;
    RetexTerm term = {.role = RETEX_ROLE_CORRECTION, .target = t};
    if (n) {
        add_factors(&term, kind < 2 ? places->kinds[t][kind] : places->interreflections[t], 1);
        add_factors(&term, places->interreflections[t], n - 1);
    }
    int code = bands_move_part(film->bands, n ? images->with[kind][n - 1] : images->without, set, &term.radiance, err);
    return code ? code : retex_set_add_correction(set, &term, NULL, err);
}

/* Corrections come after all other terms. */
static int finish_corrections(FootprintFilm *film, RetexSet *set, const Places *places, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < corrected_targets(film->scene) && !code; t++) {
        code = finish_correction(film, set, t, 0, 0, places, err);
        for (int kind = 0; kind < CORRECTION_KINDS; kind++)
            for (int n = 1; n <= CORRECTION_POWERS && !code; n++)
                code = finish_correction(film, set, t, kind, n, places, err);
    }
    return code;
}

int footprints_finish(void *layout, RetexSet *set, RetexError *err)
{
    FootprintFilm *film = layout;
    Places places = {0};
    RetexMixture any = {0};
    RetexTerm indep_term = {.role = RETEX_ROLE_INDEP, .target = -1};
    int code = finish_term(film, set, &indep_term, film->indep, err);
    for (int t = 0; t < film->scene->ntargets && !code; t++) {
        for (int kind = 0; kind < 2 && !code; kind++)
            code = finish_kind(film, set, t, kind, &places, err);
        if (!code)
            code = finish_interreflections(film, set, t, &any, &places, err);
    }
    if (!code && film->plan.coefficients[film->plan.count - 1].mixed)
        code = finish_mixture(set, &any, &places.any, err);
    for (int t = 0; t < film->scene->ntargets; t++)
        for (int kind = 0; kind < 2 && !code; kind++)
            code = finish_interreflected(film, set, t, kind, &places, err);
    if (!code)
        code = finish_corrections(film, set, &places, err);
    return code ? code : finish_lamps(film, set, &places, err);
}
