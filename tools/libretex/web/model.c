/* See model.h. */
#include "web/model.h"
#include "set/parts.h"
#include "set/set.h"

#include <stdlib.h>
#include <string.h>

static int refuse(RetexError *err, const char *what)
{
    return retex_fail(err, RETEX_EUNSUPPORTED, "this set cannot be written for browsers: %s", what);
}

/* ---- classes ---- */

static RetexWebClass *class_of(RetexWebModel *model, const RetexFootprint *f, int has_axes)
{
    for (int i = 0; i < model->nclasses; i++)
        if (model->classes[i].target == f->target && model->classes[i].kind == f->kind &&
            model->classes[i].has_axes == has_axes)
            return &model->classes[i];
    return NULL;
}

static int add_footprint(RetexWebModel *model, const RetexSet *set, int number, RetexError *err)
{
    const RetexFootprint *f = &set->footprints[number];
    const int has_axes = f->spread >= 0 && retex_footprint_has_axes(set, f);
    RetexWebClass *c = class_of(model, f, has_axes);
    if (f->uv < 0 || f->spread < 0 || f->kind == RETEX_FOOTPRINT_HIT)
        return refuse(err, "its layout is not footprints");
    if (f->quadrant) /* compact sets have none */
        return refuse(err, "it has quadrants");
    if (!c && model->nclasses == RETEX_WEB_CLASSES_MAX)
        return refuse(err, "it has too many kinds of footprints");
    if (!c) {
        c = &model->classes[model->nclasses++];
        *c = (RetexWebClass){.target = f->target,
                             .scale = retex_set_footprint_scale(set, number),
                             .albedo = f->albedo,
                             .kind = f->kind,
                             .has_axes = has_axes};
    }
    if (c->nfootprints == RETEX_SHARES_MAX || c->albedo != f->albedo ||
        c->scale != retex_set_footprint_scale(set, number) || c->scale < 1)
        return refuse(err, "footprints of one kind have several sizes or albedos");
    c->footprints[c->nfootprints++] = number;
    return 0;
}

/* The number of these weights, which is added if it is new; -1 if there are too many. */
static int weighting_of(RetexWebClass *c, const int weights[RETEX_SHARES_MAX])
{
    const size_t bytes = (size_t)c->nfootprints * sizeof *weights;
    for (int i = 0; i < c->nweightings; i++)
        if (memcmp(c->weights[i], weights, bytes) == 0)
            return i;
    if (c->nweightings == RETEX_WEB_WEIGHTINGS)
        return -1;
    memcpy(c->weights[c->nweightings], weights, bytes);
    return c->nweightings++;
}

/* ---- mixtures ---- */

/* The weight of a footprint in a factor of the set. */
static int weight_in(const RetexSet *set, RetexFactor factor, int footprint)
{
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return factor.index == footprint ? RETEX_WEB_WEIGHT_ONE : RETEX_WEB_WEIGHT_NONE;
    const RetexMixture *mixture = &set->mixtures[factor.index];
    for (int i = 0; i < mixture->nshares; i++)
        if (mixture->shares[i].footprint == footprint)
            return mixture->shares[i].weight;
    return RETEX_WEB_WEIGHT_NONE;
}

/* The index of the mixture that is a factor of the set, which is added if it is new; or a negative code. */
static int mixture_of(RetexWebModel *model, const RetexSet *set, RetexFactor factor, RetexError *err)
{
    for (int i = 0; i < model->nmixtures; i++)
        if (memcmp(&model->mixtures[i].factor, &factor, sizeof factor) == 0)
            return i;
    if (model->nmixtures == (int)(sizeof model->mixtures / sizeof *model->mixtures))
        return refuse(err, "it has too many mixtures");
    RetexWebMixture *m = &model->mixtures[model->nmixtures];
    *m = (RetexWebMixture){.factor = factor};
    for (int i = 0; i < model->nclasses; i++) {
        RetexWebClass *c = &model->classes[i];
        int weights[RETEX_SHARES_MAX], any = 0;
        for (int k = 0; k < c->nfootprints; k++) {
            weights[k] = weight_in(set, factor, c->footprints[k]);
            any |= weights[k] != RETEX_WEB_WEIGHT_NONE;
            if (weights[k] >= 0 && set->parts[weights[k]].image.channels != 1)
                return refuse(err, "it has weights by colour");
        }
        if (!any)
            continue;
        const int weighting = weighting_of(c, weights);
        if (weighting < 0)
            return refuse(err, "footprints have more than two weights");
        if (m->nclasses && model->classes[m->classes[0].index].scale != c->scale)
            return refuse(err, "a mixture has several sizes");
        m->classes[m->nclasses].index = i;
        m->classes[m->nclasses++].weighting = weighting;
    }
    return m->nclasses ? model->nmixtures++ : refuse(err, "a mixture has no footprints");
}

/* ---- terms ---- */

static int scale_of(const RetexWebModel *model, int mixture)
{
    return model->classes[model->mixtures[mixture].classes[0].index].scale;
}

/* The full size belongs to sharp footprints. A set whose other footprints have the picture's size is possible too: only
 * the first factor may be of that size. */
static int group_of(RetexWebModel *model, const RetexTerm *term, int mixture, RetexError *err)
{
    RetexWebGroup group = {.light = term->radiance, .mixture = mixture, .target = term->target};
    for (int k = 0; k < term->nfactors && retex_term_is_light(term); k++)
        if (term->factors[k].kind == RETEX_FACTOR_PARAMETER)
            group.parameters[group.nparameters++] = term->factors[k].index;
    for (int i = 0; i < model->ngroups; i++) {
        group.target = model->groups[i].target; /* that of its first term */
        if (memcmp(&model->groups[i], &group, sizeof group) == 0)
            return i;
    }
    if (model->ngroups == RETEX_WEB_GROUPS_MAX)
        return refuse(err, "it has too many kinds of light");
    group.target = term->target;
    model->groups[model->ngroups] = group;
    return model->ngroups++;
}

static int add_term(RetexWebModel *model, const RetexSet *set, const RetexTerm *term, RetexError *err)
{
    RetexWebTerm *to = &model->terms[model->nterms];
    const int lamp = retex_term_is_light(term) ? -1 : retex_set_term_lamp(set, term);
    int full = -1, *finest = lamp < 0 ? &model->finest : &model->lamps_finest;
    *to = (RetexWebTerm){.gain = retex_term_image(term), .lamp = lamp};
    if (to->gain >= 0 && retex_set_scale(set, &set->parts[to->gain].image) < *finest)
        *finest = retex_set_scale(set, &set->parts[to->gain].image);
    for (int k = 0; k < term->nfactors; k++) {
        if (!retex_factor_is_texture(term->factors[k]))
            continue;
        const int mixture = mixture_of(model, set, term->factors[k], err);
        if (mixture < 0)
            return mixture;
        if (scale_of(model, mixture) > 1)
            to->factors[to->nfactors++] = mixture;
        else if (full < 0)
            full = mixture;
        else
            return refuse(err, "reflected light has the picture's size, as in fine packs; take the set before packing");
        if (scale_of(model, mixture) > 1 && scale_of(model, mixture) < *finest)
            *finest = scale_of(model, mixture);
    }
    to->group = group_of(model, term, full, err);
    model->nterms += to->group >= 0;
    return to->group < 0 ? to->group : 0;
}

void retex_web_model_close(RetexWebModel *model)
{
    free(model->terms);
    *model = (RetexWebModel){0};
}

int retex_web_model_open(RetexWebModel *model, const RetexSet *set, RetexError *err)
{
    int code = set->nterms > 0 ? 0 : refuse(err, "it has no terms");
    if (!code && set->nterms > RETEX_WEB_TERMS_MAX)
        code = refuse(err, "it has too many terms");
    if (code)
        return code;
    *model = (RetexWebModel){.finest = RETEX_SCALE_MAX, .lamps_finest = RETEX_SCALE_MAX};
    model->terms = calloc((size_t)set->nterms + 1, sizeof *model->terms);
    if (!model->terms)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nfootprints && !code; i++)
        code = add_footprint(model, set, i, err);
    for (int i = 0; i < set->nterms && !code; i++)
        if (retex_term_is_light(&set->terms[i]))
            code = add_term(model, set, &set->terms[i], err);
    for (int i = 0; i < set->nterms && !code; i++)
        if (set->terms[i].role == RETEX_ROLE_LAMP)
            code = add_term(model, set, &set->terms[i], err);
    if (code)
        retex_web_model_close(model);
    return code;
}
