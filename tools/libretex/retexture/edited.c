/* See edited.h.
 *
 * Terms become products. With the floor edited, a lamp at twice its light, and a gain that is smaller than the picture:
 *     radiance * lamp * sharp1 * gain   becomes   radiance * FOOTPRINT sharp1 * ENLARGED(SUM of 2 * gain)
 * Terms with the same radiance and the same factors of the picture's size share one product, whose smaller factors are
 * multiplied at the finest of their sizes and summed, so that one image is enlarged for all of them. Terms without
 * smaller factors share one sum of radiance where parameters weight it, so that a lamp costs one addition. */
#include "retexture/edited.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>

#include "retexture/kept_samples.h"
#include "retexture/term_finishes.h"
#include "retexture/view_images.h"
#include "set/set.h"

#define ALL_CROSS_TERMS 3

/* ---- lamps ---- */

int retex_edited_common(const RetexEdited *e, const float *parameters, float common[3], int least[3])
{
    const RetexSet *set = e->view.set;
    int is_by_lamp = e->lamp_pictures;
    for (int t = 0; t < set->ntargets; t++)
        is_by_lamp |= e->view.mapped[t];
    for (int c = 0; c < 3; c++) {
        common[c] = is_by_lamp ? 0 : FLT_MAX;
        least[c] = -1;
        for (int i = 0; i < set->nparameters && !is_by_lamp; i++) {
            const float kept = set->parameters[i].kept[c], value = parameters[3 * i + c];
            if (set->parameters[i].kind == RETEX_PARAMETER_COLOR && kept > 0 && value / kept < common[c])
                common[c] = value / kept, least[c] = i;
        }
        common[c] = !is_by_lamp && least[c] < 0 ? 1 : common[c];
    }
    return is_by_lamp;
}

float retex_edited_beyond(float value, float kept, float common)
{
    return kept > 0 && value / kept <= common ? 0 : fmaxf(value - common * kept, 0);
}

/* Takes from the lamps what all have in common, which comes with all light. */
static void share_light(RetexEdited *e)
{
    const RetexSet *set = e->view.set;
    int least[3];
    if (!e->lamps || e->of == EDITED_LAMPS)
        return;
    retex_edited_common(e, e->parameters[0], e->common, least);
    for (int i = 0; i < set->nparameters; i++)
        for (int c = 0; c < 3 && set->parameters[i].kind == RETEX_PARAMETER_COLOR; c++)
            e->parameters[i][c] = retex_edited_beyond(e->parameters[i][c], set->parameters[i].kept[c], e->common[c]);
}

/* ---- what is edited ---- */

/* Finds the targets that have a texture, or on which one is laid. Returns their number. */
static int find_edited_targets(RetexEdited *e)
{
    const RetexView *view = &e->view;
    int count = 0;
    for (int f = 0; f < view->set->nfootprints; f++) {
        const int t = view->set->footprints[f].target;
        e->edited[t] |= (view->textures && view->textures[t]) || view->set->footprints[f].sampled;
    }
    for (int t = 0; t < view->set->ntargets; t++)
        count += e->edited[t];
    return count;
}

/* Sets the values of parameters: those that are given, and the weight of corrections of edited targets, of which there
 * are so many. Returns 1 if any is not as rendered, corrections left out. */
static int set_parameters(RetexEdited *e, const float *given, int is_corrected, int nedited)
{
    const RetexSet *set = e->view.set;
    int is_changed = 0;
    for (int i = 0; i < set->nparameters; i++) {
        const RetexParameter *parameter = &set->parameters[i];
        const float *value = given ? given + 3 * i : parameter->value;
        if (parameter->kind == RETEX_PARAMETER_CORRECTION) {
            const int counts = is_corrected && e->edited[parameter->target];
            const float weight = counts ? (float)retex_correction_weight(set->ntargets, nedited) : 0;
            e->parameters[i][0] = e->parameters[i][1] = e->parameters[i][2] = weight;
            continue;
        }
        for (int c = 0; c < 3; c++) {
            e->parameters[i][c] = value[c];
            is_changed |= value[c] != parameter->value[c];
        }
    }
    return is_changed;
}

/* Finds what is edited, and what stands for the sum of terms then. Corrections, and the picture of part 0, are those of
 * all cross terms. */
static void find_edited(RetexEdited *e, const RetexCombineParams *params)
{
    const RetexSet *set = e->view.set;
    const int nedited = find_edited_targets(e);
    const int is_corrected = e->of != EDITED_TERMS && e->cross == ALL_CROSS_TERMS;
    const int is_changed = set_parameters(e, params->parameters, is_corrected, nedited);
    const int is_original = !params->terms_only && is_corrected && nedited == 0;
    const int is_plain_picture = set->nterms == 0 && set->nparts > 0 && set->parts[0].image.channels == 3;
    e->lamps = retex_set_has_role(set, RETEX_ROLE_LAMP);
    e->picture = is_plain_picture || (set->nterms && is_original && !is_changed &&
                                      retex_set_has_role(set, RETEX_ROLE_PICTURE));
    e->lamp_pictures = is_original && is_changed && retex_set_has_role(set, RETEX_ROLE_LAMP_PICTURE);
}

/* Whether a term of the set counts. weight: the product of its parameters as they are. */
static int has_term(const RetexEdited *e, const RetexTerm *term, const float weight[3])
{
    if (e->picture || term->role == RETEX_ROLE_PICTURE || (term->role == RETEX_ROLE_CROSS2 && e->cross < 2) ||
        (term->role == RETEX_ROLE_CROSS3 && e->cross < 3) ||
        (term->role == RETEX_ROLE_LAMP_PICTURE) != e->lamp_pictures)
        return 0;
    return weight[0] != 0 || weight[1] != 0 || weight[2] != 0;
}

/* ---- the image of a factor ---- */

enum {
    IS_ONE = -1000, /* in place of an image: the factor is 1 everywhere */
    IS_MISSING      /* the set lacks a part that the factor needs */
};

/* The image of a part if it has `least` to `most` channels, else NULL. */
static const RetexImage *part_image(const RetexSet *set, int part, int least, int most)
{
    if (part < 0 || part >= set->nparts)
        return NULL;
    const RetexImage *im = &set->parts[part].image;
    return im->channels >= least && im->channels <= most ? im : NULL;
}

/* The image that has the size of a footprint's samples: UV, the samples themselves, or the original albedo. NULL where
 * the footprint is absent. */
static const RetexImage *footprint_shape(const RetexView *view, int footprint)
{
    const RetexSet *set = view->set;
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    const RetexFootprint *f = &set->footprints[footprint];
    if (view->textures && view->textures[f->target])
        return part_image(set, f->uv, 3, 3);
    return part_image(set, f->sampled ? f->sampled - 1 : f->albedo, 3, 3);
}

static const RetexImage *mixture_shape(const RetexView *view, int mixture)
{
    const RetexImage *shape = NULL;
    if (mixture >= view->set->nmixtures)
        return NULL;
    const RetexMixture *m = &view->set->mixtures[mixture];
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *image = footprint_shape(view, m->shares[k].footprint);
        const RetexImage *weight = part_image(view->set, m->shares[k].weight, 1, 3);
        if (!image || !weight || weight->channels == 2 || weight->width != image->width ||
            weight->height != image->height ||
            (shape && (shape->width != image->width || shape->height != image->height)))
            return NULL;
        shape = image;
    }
    return shape;
}

/* An image that has the size of the factor; NULL where the factor is absent. */
static const RetexImage *factor_shape(const RetexView *view, RetexFactor factor)
{
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return footprint_shape(view, factor.index);
    if (factor.kind == RETEX_FACTOR_MIXTURE)
        return mixture_shape(view, factor.index);
    const RetexImage *image = part_image(view->set, factor.index, 1, 3);
    return image && image->channels != 2 ? image : NULL;
}

/* Whether a factor of quantity FURTHER is 1, as no texture of it is edited. */
static int is_one(const RetexEdited *e, RetexFactor factor)
{
    const RetexSet *set = e->view.set;
    int is_edited = 0;
    if (factor.quantity != RETEX_QUANTITY_FURTHER)
        return 0;
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return !e->edited[set->footprints[factor.index].target];
    const RetexMixture *mixture = &set->mixtures[factor.index];
    for (int k = 0; k < mixture->nshares; k++)
        is_edited |= e->edited[set->footprints[mixture->shares[k].footprint].target];
    return !is_edited;
}

/* Adds the image of a factor, times the weight of a finish, at its own size. Returns its number, IS_ONE, IS_MISSING, or
 * a RetexCode. */
static int add_factor(RetexEdited *e, RetexFactor factor, int finish, RetexError *err)
{
    RetexView *view = &e->view;
    if (is_one(e, factor))
        return IS_ONE;
    const RetexImage *shape = factor_shape(view, factor);
    if (!shape || !retex_set_scale(view->set, shape)) {
        if (factor.kind == RETEX_FACTOR_MIXTURE && factor.index < view->set->nmixtures)
            return retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
        return IS_MISSING;
    }
    if (factor.kind == RETEX_FACTOR_IMAGE) /* one that is enlarged is made three channels then */
        return retex_view_part(view, factor.index, shape->channels);
    const int colors = factor.kind == RETEX_FACTOR_MIXTURE ? retex_view_mixture(view, factor.index, finish, shape)
                                                           : retex_view_footprint(view, factor.index, finish, shape);
    return factor.quantity == RETEX_QUANTITY_FURTHER && colors >= 0 ? retex_view_further(view, colors, shape, err)
                                                                    : colors;
}

/* ---- products ---- */

/* A term whose factors are images at their own sizes. */
typedef struct Counted {
    int number, radiance; /* of the term; its part */
    float weight[3];
    int is_weighted; /* 1: it has parameters, though their product may be 1 */
    int nfactors, factors[RETEX_MAX_FACTORS];
    int scale; /* the finest scale above 1 among the factors; 0 where all have the picture's size */
} Counted;

static int lacks_parts(int number, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", number);
}

static int count_factors(RetexEdited *e, const RetexTermFinishes *term, Counted *counted, RetexError *err)
{
    for (int k = 0; k < term->nfactors; k++) {
        const int image = add_factor(e, term->factors[k], term->finish[k], err);
        if (image == IS_MISSING)
            return lacks_parts(counted->number, err);
        if (image < 0 && image != IS_ONE)
            return image;
        if (image >= 0)
            counted->factors[counted->nfactors++] = image;
    }
    for (int k = 0; k < term->ngates; k++)
        if ((counted->factors[counted->nfactors++] =
                 retex_view_gate(&e->view, term->gates[k].target, term->gates[k].finish)) < 0)
            return RETEX_ENOMEM;
    for (int k = 0; k < counted->nfactors; k++) {
        const int scale = e->view.images[counted->factors[k]].scale;
        if (scale > 1 && (!counted->scale || scale < counted->scale))
            counted->scale = scale;
    }
    return RETEX_OK;
}

/* Finds how a term counts; counted->radiance is -1 where it does not. */
static int count_term(RetexEdited *e, int number, Counted *counted, RetexError *err)
{
    const RetexSet *set = e->view.set;
    const RetexTerm *term = &set->terms[number];
    RetexTermFinishes of;
    *counted = (Counted){.number = number, .radiance = -1};
    if (term->nfactors < 0 || term->nfactors > RETEX_MAX_FACTORS)
        return lacks_parts(number, err);
    retex_term_find_finishes(&of, &e->view, term, e->parameters[0]);
    const int is_all_light = e->lamps && retex_set_term_lamp(set, term) < 0;
    for (int c = 0; c < 3; c++)
        counted->weight[c] = of.weight[c] * (is_all_light ? e->common[c] : 1);
    counted->is_weighted = of.is_weighted || (is_all_light && retex_view_has_weight(e->common));
    if (!has_term(e, term, counted->weight))
        return RETEX_OK;
    const RetexImage *radiance = part_image(set, term->radiance, 3, 3);
    if (!radiance || retex_set_scale(set, radiance) != 1)
        return lacks_parts(number, err);
    counted->radiance = term->radiance;
    return count_factors(e, &of, counted, err);
}

/* Adds an image whose products may be many. `room`: for so many. Returns its number, or RETEX_ENOMEM. */
static int add_sum(RetexView *view, int scale, int room)
{
    RetexViewProduct *products = calloc((size_t)room + 1, sizeof *products);
    if (!products)
        return RETEX_ENOMEM;
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_SUM, .finish = -1, .scale = scale, .channels = 3,
                                                 .products = products});
}

static void append_product(RetexView *view, int sum, const RetexViewProduct *product)
{
    RetexViewImage *image = &view->images[sum];
    image->products[image->nproducts++] = *product;
}

/* Appends an image to a product, enlarged to that scale. */
static int append_input(RetexView *view, RetexViewProduct *product, int image, int scale)
{
    const RetexViewImage *of = image < 0 ? NULL : &view->images[image];
    const int is_gray = of && of->channels == 1 && of->scale == scale;
    const int input = is_gray ? retex_view_part(view, of->index, 3) : retex_view_enlarge(view, image, scale);
    RETEX_ASSERT(product->ninputs < VIEW_INPUTS_MAX);
    product->inputs[product->ninputs++] = input;
    return input < 0 ? RETEX_ENOMEM : RETEX_OK;
}

/* Adds a term by itself: its radiance, times its weight, and all its factors. */
static int add_single(RetexEdited *e, const Counted *counted)
{
    RetexView *view = &e->view;
    RetexViewProduct product = {.weight = {1, 1, 1}, .term = counted->number};
    int radiance = retex_view_part(view, counted->radiance, 3), code = radiance < 0 ? RETEX_ENOMEM : RETEX_OK;
    if (!code && retex_view_has_weight(counted->weight)) {
        RetexViewProduct weighted = {.ninputs = 1, .inputs = {radiance}, .term = counted->number};
        memcpy(weighted.weight, counted->weight, sizeof weighted.weight);
        if ((radiance = add_sum(view, 1, 1)) < 0)
            return RETEX_ENOMEM;
        append_product(view, radiance, &weighted);
    }
    if (!code)
        code = append_input(view, &product, radiance, 1);
    for (int k = 0; k < counted->nfactors && !code; k++)
        code = append_input(view, &product, counted->factors[k], 1);
    if (!code)
        append_product(view, e->sum, &product);
    return code;
}

/* Terms that share a product. */
typedef struct Group {
    int radiance;                            /* the part of those with a scale; else of the first */
    int scale, is_weighted;                  /* is_weighted: without a scale, by parameters */
    int nfactors, factors[RETEX_MAX_FACTORS]; /* of the picture's size */
    int nterms, *terms;                      /* of those that count */
} Group;

static int are_together(const Group *a, const Group *b)
{
    const int same = a->scale ? a->radiance == b->radiance : a->is_weighted;
    return same && a->scale == b->scale && a->is_weighted == b->is_weighted && a->nfactors == b->nfactors &&
           memcmp(a->factors, b->factors, sizeof *a->factors * (size_t)a->nfactors) == 0;
}

/* The sum that a group's smaller factors, or its radiances, are. */
static int add_group_sum(RetexView *view, const Group *group, const Counted *counted)
{
    const int scale = group->scale ? group->scale : 1, sum = add_sum(view, scale, group->nterms);
    int code = sum < 0 ? RETEX_ENOMEM : RETEX_OK;
    for (int i = 0; i < group->nterms && !code; i++) {
        const Counted *of = &counted[group->terms[i]];
        RetexViewProduct product = {.term = of->number};
        memcpy(product.weight, of->weight, sizeof product.weight);
        if (!group->scale)
            code = append_input(view, &product, retex_view_part(view, of->radiance, 3), 1);
        for (int k = 0; k < of->nfactors && group->scale && !code; k++)
            if (view->images[of->factors[k]].scale > 1)
                code = append_input(view, &product, of->factors[k], scale);
        if (!code)
            append_product(view, sum, &product);
    }
    return code ? code : sum;
}

static int add_group(RetexEdited *e, const Group *group, const Counted *counted)
{
    RetexView *view = &e->view;
    const Counted *first = &counted[group->terms[0]];
    RetexViewProduct product = {.weight = {1, 1, 1}, .term = first->number};
    const int is_sum = group->is_weighted && (group->nterms > 1 || retex_view_has_weight(first->weight));
    const int radiance = is_sum ? add_group_sum(view, group, counted) : retex_view_part(view, first->radiance, 3);
    int code = append_input(view, &product, radiance, 1);
    for (int k = 0; k < group->nfactors && !code; k++)
        code = append_input(view, &product, group->factors[k], 1);
    if (!code && group->scale)
        code = append_input(view, &product, add_group_sum(view, group, counted), 1);
    if (!code)
        append_product(view, e->sum, &product);
    return code;
}

/* Sorts terms that count into groups. Returns their number, or RETEX_ENOMEM. */
static int find_groups(const RetexView *view, const Counted *counted, int ncounted, Group *groups)
{
    int ngroups = 0;
    for (int i = 0; i < ncounted; i++) {
        const Counted *of = &counted[i];
        Group wanted = {.radiance = of->radiance, .scale = of->scale};
        wanted.is_weighted = of->is_weighted && !of->scale; /* else the sum of smaller factors is weighted */
        for (int k = 0; k < of->nfactors; k++)
            if (view->images[of->factors[k]].scale == 1)
                wanted.factors[wanted.nfactors++] = of->factors[k];
        int g = 0;
        while (g < ngroups && !are_together(&groups[g], &wanted))
            g++;
        if (g == ngroups) {
            groups[ngroups++] = wanted;
            if (!(groups[g].terms = malloc(sizeof *groups[g].terms * (size_t)ncounted)))
                return RETEX_ENOMEM;
        }
        groups[g].terms[groups[g].nterms++] = i;
    }
    return ngroups;
}

static int add_groups(RetexEdited *e, const Counted *counted, int ncounted)
{
    Group *groups = calloc((size_t)ncounted + 1, sizeof *groups);
    int code = groups ? RETEX_OK : RETEX_ENOMEM;
    const int ngroups = code ? 0 : find_groups(&e->view, counted, ncounted, groups);
    code = ngroups < 0 ? ngroups : code;
    for (int g = 0; g < ngroups && !code; g++)
        code = add_group(e, &groups[g], counted);
    for (int g = 0; groups && g < ncounted; g++)
        free(groups[g].terms);
    free(groups);
    return code;
}

static int add_products(RetexEdited *e, RetexError *err)
{
    const int nterms = e->view.set->nterms;
    Counted *counted = calloc((size_t)nterms + 1, sizeof *counted);
    int ncounted = 0;
    int code = counted && (e->sum = add_sum(&e->view, 1, nterms)) >= 0 ? RETEX_OK : RETEX_ENOMEM;
    for (int i = 0; i < nterms && !code; i++) {
        code = count_term(e, i, &counted[ncounted], err);
        ncounted += counted[ncounted].radiance >= 0;
    }
    for (int i = 0; i < ncounted && !code && e->of != EDITED_PICTURE; i++)
        code = add_single(e, &counted[i]);
    if (!code && e->of == EDITED_PICTURE)
        code = add_groups(e, counted, ncounted);
    free(counted);
    for (int t = 0; t < e->view.set->ntargets && e->of == EDITED_TERMS; t++) /* for the error that a map causes */
        for (int k = 0; k < e->view.mapped[t] && !code; k++)
            code = retex_view_gate(&e->view, t, k) < 0 ? RETEX_ENOMEM : RETEX_OK;
    return code == RETEX_ENOMEM ? retex_fail(err, code, "not enough memory for %d terms", nterms) : code;
}

/* ---- opening ---- */

static int has_cross_terms(const RetexSet *set)
{
    return retex_set_has_role(set, RETEX_ROLE_CROSS2) || retex_set_has_role(set, RETEX_ROLE_CROSS3);
}

static int check_params(const RetexEdited *e, const float *parameters, RetexError *err)
{
    const RetexView *view = &e->view;
    const RetexSet *set = view->set;
    if (e->cross != 0 && e->cross != 2 && e->cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", e->cross);
    for (int i = 0; parameters && i < 3 * set->nparameters; i++)
        if (!(parameters[i] >= 0 && parameters[i] <= FLT_MAX))
            return retex_fail(err, RETEX_EINVAL, "parameter %s is %g", set->parameters[i / 3].name,
                              (double)parameters[i]);
    int code = set->is_samples ? retex_fail(err, RETEX_EINVAL, "samples are no set: they have no picture") : RETEX_OK;
    for (int t = 0; view->kept && t < set->ntargets && !code; t++)
        code = view->kept[t] ? retex_kept_samples_check(view->kept[t], set, t, err) : RETEX_OK;
    return code;
}

void retex_edited_close(RetexEdited *e)
{
    retex_view_close(&e->view);
    *e = (RetexEdited){0};
}

int retex_edited_open(RetexEdited *e, const RetexSet *set, RetexTexture *const *textures,
                      const RetexCombineParams *params, RetexEditedSum of, int nthreads, RetexError *err)
{
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    const RetexCombineParams given = params ? *params : defaults;
    *e = (RetexEdited){.of = of, .cross = given.cross, .common = {1, 1, 1}};
    e->view = (RetexView){.set = set, .textures = textures, .kept = given.kept, .columns = {0, set->width}};
    int code = check_params(e, given.parameters, err);
    if (code)
        return code;
    if (!has_cross_terms(set))
        e->cross = ALL_CROSS_TERMS;
    find_edited(e, &given);
    code = retex_view_find_maps(&e->view, e->parameters[0], err);
    for (int t = 0; t < set->ntargets; t++)
        e->has_normals |= e->view.mapped[t] && set->targets[t].normal_tilt > 0;
    share_light(e);
    if (!code)
        code = add_products(e, err);
    if (!code)
        code = retex_view_make(&e->view, nthreads, err);
    if (code)
        retex_edited_close(e);
    return code;
}
