/* From the images of layout `footprints` to the parts, footprints, mixtures and terms of a set. What no pixel has is
 * left out. */
#include <limits.h>
#include <stdio.h>
#include "film/footprint_images.h"

static int is_empty(const RetexImage *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        if (image->pixels[i] != 0)
            return 0;
    return 1;
}

/* Its images become parts: uv_NAME_suffix and so on. The footprint's number in the set, or -1 where no pixel has it. */
static int finish_footprint(RetexSet *set, FootprintImages *images, RetexFootprint *f, const char *suffix, int *index,
                            RetexError *err)
{
    char name[RETEX_NAME_MAX];
    const char *target = set->targets[f->target].name;
    *index = -1;
    if (is_empty(&images->uv))
        return RETEX_OK;
    snprintf(name, sizeof name, "uv_%.90s_%s", target, suffix);
    int code = film_move_part(set, name, "RGA", RETEX_FLOAT, &images->uv, &f->uv, err);
    snprintf(name, sizeof name, "spread_%.90s_%s", target, suffix);
    if (!code)
        code = film_move_part(set, name, "RGB", RETEX_HALF, &images->spread, &f->spread, err);
    snprintf(name, sizeof name, "albedo_%.90s_%s", target, suffix);
    if (!code)
        code = film_move_part(set, name, "RGB", RETEX_HALF, &images->albedo, &f->albedo, err);
    return code ? code : retex_set_add_footprint(set, f, index, err);
}

/* A term of the factors that it has already, if any pixel has light of it. */
static int finish_term(RetexSet *set, const RetexTerm *factors, RetexImage *image, const char *name, RetexError *err)
{
    RetexTerm term = *factors;
    term.kind = RETEX_TERM_DEP;
    if (is_empty(image))
        return RETEX_OK;
    int code = film_move_part(set, name, "RGB", RETEX_HALF, image, &term.radiance, err);
    return code ? code : retex_set_add_term(set, &term, NULL, err);
}

/* Factors of the terms: which of the set's mixtures, or footprints, stand for what. */
typedef struct Places {
    int kinds[RETEX_MAX_TARGETS][2]; /* all clusters of a kind; NONE = no pixel has one */
    int later[RETEX_MAX_TARGETS];
    int any; /* further hits of all targets */
} Places;
#define NONE INT_MIN

/* A mixture of so many shares: none, the footprint itself, or a mixture of the set. */
static int finish_mixture(RetexSet *set, const RetexMixture *mixture, int *place, RetexError *err)
{
    int index = 0, code = RETEX_OK;
    *place = mixture->nshares ? mixture->shares[0].footprint : NONE;
    if (mixture->nshares > 1) {
        code = retex_set_add_mixture(set, mixture, &index, err);
        *place = RETEX_MIXTURE(index);
    }
    return code;
}

static void add_share(RetexMixture *mixture, int footprint, int weight)
{
    if (footprint >= 0)
        mixture->shares[mixture->nshares++] = (struct RetexShare){footprint, weight};
}

/* The clusters of one kind, each with the light that meets no other target. */
static int finish_kind(FootprintFilm *film, RetexSet *set, int t, int kind, Places *places, RetexError *err)
{
    static const char *const kinds[] = {"sharp", "broad"};
    RetexMixture all = {0};
    int code = RETEX_OK,
        several = most_of_kind(&film->params, kind) > 1 && !is_empty(&film->targets[t].kinds[kind].of[1].uv);
    for (int k = 0; k < most_of_kind(&film->params, kind) && !code; k++) {
        FootprintImages *images = &film->targets[t].kinds[kind].of[k];
        RetexFootprint f = {.target = t, .hit = 1 + k + kind * film->params.sharp};
        char suffix[16], name[RETEX_NAME_MAX];
        int index;
        f.kind = kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP;
        snprintf(suffix, sizeof suffix, "%s%d", kinds[kind], k + 1);
        code = finish_footprint(set, images, &f, suffix, &index, err);
        if (code || index < 0)
            continue;
        snprintf(name, sizeof name, "dep_%.90s_%s", set->targets[t].name, suffix);
        code = finish_term(set, &(RetexTerm){.nfactors = 1, .factors = {index}}, &images->light, name, err);
        int weight = -1;
        snprintf(name, sizeof name, "share_%.90s_%s", set->targets[t].name, suffix);
        if (!code && film->plan.count > 1 && several)
            code = film_move_part(set, name, "R", RETEX_HALF, &images->share, &weight, err);
        add_share(&all, index, weight);
    }
    if (code || film->plan.count == 1)
        return code;
    return finish_mixture(set, &all, &places->kinds[t][kind], err);
}

static int finish_later(FootprintFilm *film, RetexSet *set, int t, RetexMixture *any, Places *places, RetexError *err)
{
    RetexMixture own = {0};
    int code = RETEX_OK;
    for (int k = 0; k < LATER_COUNT && film->plan.count > 1 && !code; k++) {
        FootprintImages *images = &film->targets[t].later[k];
        RetexFootprint f = {.target = t, .kind = RETEX_FOOTPRINT_LATER};
        char suffix[16], name[RETEX_NAME_MAX];
        int index, weight = -1;
        f.hit = 1 + film->params.sharp + film->params.broad + k;
        snprintf(suffix, sizeof suffix, "later%d", k + 1);
        code = finish_footprint(set, images, &f, suffix, &index, err);
        snprintf(name, sizeof name, "share_%.90s_%s", set->targets[t].name, suffix);
        if (!code && index >= 0)
            code = film_move_part(set, name, "R", RETEX_HALF, &images->share, &weight, err);
        add_share(&own, index, weight);
        add_share(any, index, weight);
    }
    return code ? code : finish_mixture(set, &own, &places->later[t], err);
}

/* dep_Floor_sharp_a2b1: sharp clusters, then two hits of the first target and one of the second;
 * dep_Floor_sharp_m5: then five of any. */
static void again_name(const RetexSet *set, int t, int kind, const PlanCoefficient *c, char name[RETEX_NAME_MAX])
{
    int used = snprintf(name, RETEX_NAME_MAX, "dep_%.80s_%s_", set->targets[t].name, kind ? "broad" : "sharp");
    if (c->mixed)
        snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "m%d", c->mixed);
    for (int later = 0; later < set->ntargets; later++)
        if (c->powers[later])
            used += snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "%c%d", 'a' + later, c->powers[later]);
}

static void add_factors(RetexTerm *term, int place, int count)
{
    for (int n = 0; n < count; n++)
        term->factors[term->nfactors++] = place;
}

/* The light of one kind that meets targets again, but for what no pixel has. */
static int finish_again(FootprintFilm *film, RetexSet *set, int t, int kind, const Places *places, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 1; i < film->plan.count && !code; i++) {
        RetexImage *image = &film->targets[t].kinds[kind].again[i];
        const PlanCoefficient *c = &film->plan.coefficients[i];
        RetexTerm term = {.nfactors = 0};
        char name[RETEX_NAME_MAX];
        if (is_empty(image)) /* before the factors: they may not be there either */
            continue;
        add_factors(&term, places->kinds[t][kind], 1);
        add_factors(&term, places->any, c->mixed);
        for (int b = 0; b < set->ntargets; b++)
            add_factors(&term, places->later[b], c->powers[b]);
        again_name(set, t, kind, c, name);
        code = finish_term(set, &term, image, name, err);
    }
    return code;
}

int footprints_finish(FootprintFilm *film, RetexSet *set, RetexError *err)
{
    Places places = {.any = NONE};
    RetexMixture any = {0};
    RetexTerm free_term = {.kind = RETEX_TERM_INDEP};
    int code = film_move_part(set, "indep", "RGB", RETEX_HALF, &film->free, &free_term.radiance, err);
    if (!code)
        code = retex_set_add_term(set, &free_term, NULL, err);
    for (int t = 0; t < set->ntargets && !code; t++) {
        for (int kind = 0; kind < 2 && !code; kind++)
            code = finish_kind(film, set, t, kind, &places, err);
        if (!code)
            code = finish_later(film, set, t, &any, &places, err);
    }
    if (!code && film->plan.coefficients[film->plan.count - 1].mixed)
        code = finish_mixture(set, &any, &places.any, err);
    for (int t = 0; t < set->ntargets; t++)
        for (int kind = 0; kind < 2 && !code; kind++)
            code = finish_again(film, set, t, kind, &places, err);
    return code;
}
