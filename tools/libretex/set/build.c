/* Sets in memory: creation, adding, searching. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/aov.h>
#include <retex/host/set_build.h>
#include <retex/target_name.h>

#include "base/params.h"
#include "base/part_name.h"
#include "io/checksum.h"
#include "set/manifest.h"
#include "set/parts.h"
#include "set/references.h"
#include "set/set.h"
#include "set/source.h"
#include "texture/filter.h"

int retex_set_create(RetexSet **result, int width, int height, RetexError *err)
{
    *result = NULL;
    if (width < 1 || height < 1 || width > RETEX_MAX_SIZE || height > RETEX_MAX_SIZE)
        return retex_fail(err, RETEX_EINVAL, "a set of %d x %d pixels is out of bounds", width, height);
    RetexSet *set = calloc(1, sizeof *set);
    if (!set)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a set");
    set->width = width;
    set->height = height;
    set->unit = 1;
    strcpy(set->layout, "paper");
    strcpy(set->filter, "box");
    *result = set;
    return 0;
}

void retex_set_close(RetexSet **result)
{
    RetexSet *set = result ? *result : NULL;

    if (!set)
        return;
    for (int i = 0; i < set->nparts; i++) {
        retex_image_free(&set->parts[i].image);
        retex_part_set_source(&set->parts[i], NULL, 0);
    }
    free(set->parts);
    free(set->footprints);
    free(set->terms);
    free(set);
    *result = NULL;
}

void retex_set_get_info(const RetexSet *set, RetexSetInfo *info)
{
    RetexSetInfo own = {.width = set->width,
                        .height = set->height,
                        .layout = set->layout,
                        .filter = set->filter,
                        .scene = set->scene,
                        .generator = set->generator,
                        .orders = set->orders,
                        .spp = set->spp,
                        .max_depth = set->max_depth,
                        .seed = set->seed,
                        .id = set->id,
                        .denoised = set->denoised,
                        .strict_paper = set->strict_paper,
                        .folded = set->folded,
                        .folded_white = set->folded_white,
                        .ntargets = set->ntargets,
                        .nfootprints = set->nfootprints,
                        .nmixtures = set->nmixtures,
                        .nterms = set->nterms,
                        .nparameters = set->nparameters,
                        .nparts = set->nparts,
                        .further_hits = set->further_hits,
                        .unit = set->unit,
                        .depth_cut = set->depth_cut,
                        .exposure = set->exposure,
                        .is_samples = set->is_samples};
    memcpy(own.further_ratio, set->further_ratio, sizeof own.further_ratio);
    (void)RETEX_PARAMS_RETURN(info, &own, NULL);
}

static void copy_text(char *own, size_t size, const char *text)
{
    if (text != own)
        snprintf(own, size, "%s", text);
}

int retex_set_describe(RetexSet *set, const RetexSetInfo *given, RetexError *err)
{
    RetexSetInfo info = retex_set_info(set);
    const int code = RETEX_PARAMS_COPY(&info, given, err);
    if (code)
        return code;
    if (info.further_hits < 0 || info.further_hits > RETEX_FURTHER_HITS_MAX)
        return retex_fail(err, RETEX_EINVAL, "further hits are 0 to %d, not %d", RETEX_FURTHER_HITS_MAX,
                          info.further_hits);
    for (int c = 0; c < 3; c++)
        if (!(info.further_ratio[c] >= 0 && info.further_ratio[c] <= RETEX_FURTHER_RATIO_MAX))
            return retex_fail(err, RETEX_EINVAL, "the ratio of further hits is 0 to %d, not %g",
                              RETEX_FURTHER_RATIO_MAX, (double)info.further_ratio[c]);
    if (!isfinite(info.unit) || !(info.unit > 0))
        return retex_fail(err, RETEX_EINVAL, "a scene unit is above 0 metres, not %g", info.unit);
    copy_text(set->layout, sizeof set->layout, info.layout);
    copy_text(set->filter, sizeof set->filter, info.filter);
    copy_text(set->scene, sizeof set->scene, info.scene);
    copy_text(set->generator, sizeof set->generator, info.generator);
    set->orders = info.orders, set->spp = info.spp, set->max_depth = info.max_depth;
    set->seed = info.seed;
    set->denoised = info.denoised, set->strict_paper = info.strict_paper;
    set->folded = info.folded, set->folded_white = info.folded_white;
    set->further_hits = info.further_hits;
    set->unit = info.unit, set->depth_cut = info.depth_cut, set->exposure = info.exposure;
    memcpy(set->further_ratio, info.further_ratio, sizeof set->further_ratio);
    return 0;
}

/* The element, or NULL. */
#define ELEMENT(set, array, index) ((index) >= 0 && (index) < (set)->n##array ? &(set)->array[index] : NULL)

const RetexTarget *retex_set_target(const RetexSet *set, int index)
{
    return ELEMENT(set, targets, index);
}

const RetexFootprint *retex_set_footprint(const RetexSet *set, int index)
{
    return ELEMENT(set, footprints, index);
}

const RetexMixture *retex_set_mixture(const RetexSet *set, int index)
{
    return ELEMENT(set, mixtures, index);
}

const RetexTerm *retex_set_term(const RetexSet *set, int index)
{
    return ELEMENT(set, terms, index);
}

const RetexParameter *retex_set_parameter(const RetexSet *set, int index)
{
    return ELEMENT(set, parameters, index);
}

const RetexPart *retex_set_part(const RetexSet *set, int index)
{
    return ELEMENT(set, parts, index);
}

RetexTarget *retex_set_mutable_target(RetexSet *set, int index)
{
    return ELEMENT(set, targets, index);
}

RetexImage *retex_set_mutable_image(RetexSet *set, int part)
{
    return &set->parts[part].image;
}

/* Grows an array by one element. It grows to the next power of two, so that most calls move nothing, whoever allocated
 * the array. */
static int grow_array(void **array, int count, size_t element, int most, const char *what, RetexError *err)
{
    size_t capacity = 1;

    if (count >= most)
        return retex_fail(err, RETEX_ELIMIT, "a set has at most %d %s", most, what);
    while (capacity <= (size_t)count)
        capacity *= 2;
    void *larger = realloc(*array, capacity * element);
    if (!larger)
        return retex_fail(err, RETEX_ENOMEM, "no memory for %d %s", count + 1, what);
    *array = larger;
    return 0;
}

/* Appends a part without pixels, which is not counted yet. */
static int describe_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int width,
                         int height, RetexPart **result, RetexError *err)
{
    RetexPart part = {.type = type};

    if (!retex_name_is_valid(name))
        return retex_fail(err, RETEX_EINVAL, "\"%s\" is no name for a part: letters, digits, '_' and '-'", name);
    if (!retex_letters_are_valid(letters))
        return retex_fail(err, RETEX_EINVAL, "\"%s\" are no channels of a part", letters);
    if (retex_set_find_part(set, name) >= 0)
        return retex_fail(err, RETEX_EINVAL, "the set has a part %s already", name);
    if ((width == 0) != (height == 0))
        return retex_fail(err, RETEX_EINVAL, "part %s: %d x %d pixels are out of bounds", name, width, height);
    const int code =
        grow_array((void **)&set->parts, set->nparts, sizeof *set->parts, RETEX_SET_PARTS_MAX, "parts", err);
    if (code)
        return code;
    strcpy(part.name, name);
    strcpy(part.letters, letters);
    part.image.width = width ? width : set->width;
    part.image.height = height ? height : set->height;
    part.image.channels = (int)strlen(letters);
    *result = &set->parts[set->nparts];
    **result = part;
    return 0;
}

int retex_set_add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int width, int height,
                       int *index, RetexError *err)
{
    RetexPart *part;
    int code = describe_part(set, name, letters, type, width, height, &part, err);

    if (code)
        return code;
    const RetexImage shape = part->image;
    part->image = (RetexImage){0};
    code = retex_image_alloc(&part->image, shape.width, shape.height, shape.channels, err);
    if (code)
        return code;
    if (index)
        *index = set->nparts;
    set->nparts++;
    return 0;
}

int retex_set_add_absent(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int width,
                         int height, int *index, RetexError *err)
{
    RetexPart *part;
    const int code = describe_part(set, name, letters, type, width, height, &part, err);
    if (!code)
        *index = set->nparts++;
    return code;
}

int retex_set_add_stored(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int image,
                         int *index, RetexError *err)
{
    int part;
    const int code = retex_set_add_absent(set, name, letters, type, 0, 0, &part, err);
    if (code)
        return code;
    set->parts[part].source_part = image;
    if (index)
        *index = part;
    return RETEX_OK;
}

int retex_set_take_store(RetexSet *set, RetexBandStore *store, RetexError *err)
{
    RetexSetSource *source;
    const int code = store ? retex_store_source_open(&source, store, err) : RETEX_OK;
    if (code || !store)
        return code;
    for (int i = 0; i < set->nparts; i++)
        if (!set->parts[i].image.pixels && !set->parts[i].source)
            retex_part_set_source(&set->parts[i], source, set->parts[i].source_part);
    retex_source_release(&source);
    return RETEX_OK;
}

static void move_up(void *context, RetexPartUse use, int user, int *part)
{
    (void)use, (void)user;
    *part -= *part > *(const int *)context;
}

void retex_set_remove_part(RetexSet *set, int part)
{
    retex_image_free(&set->parts[part].image);
    retex_part_set_source(&set->parts[part], NULL, 0);
    memmove(&set->parts[part], &set->parts[part + 1], sizeof *set->parts * (size_t)(--set->nparts - part));
    retex_set_visit_parts(set, move_up, &part);
}

/* Checks a part that a footprint or term refers to: it must exist, or be absent (-1) where that is allowed. */
static int check_part(const RetexSet *set, int part, size_t channels, int optional, const char *what, RetexError *err)
{
    if (part == -1 && optional)
        return 0;
    if (part < 0 || part >= set->nparts)
        return retex_fail(err, RETEX_EINVAL, "%s refers to part %d of %d", what, part, set->nparts);
    if (strlen(set->parts[part].letters) != channels)
        return retex_fail(err, RETEX_EINVAL, "%s needs a part of %zu channels; %s has %s", what, channels,
                          set->parts[part].name, set->parts[part].letters);
    return 0;
}

/* Checks a part that has one channel for all colours, or three. */
static int check_weight(const RetexSet *set, int part, const char *what, RetexError *err)
{
    const int colored = part >= 0 && part < set->nparts && strlen(set->parts[part].letters) == 3;
    return check_part(set, part, colored ? 3 : 1, 0, what, err);
}

int retex_set_add_target(RetexSet *set, const RetexTarget *target, int *index, RetexError *err)
{
    if (set->ntargets >= RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_ELIMIT, "a set has at most %d targets", RETEX_MAX_TARGETS);
    if (target->nfinishes < 0 || target->nfinishes > RETEX_FINISHES_MAX || target->finish > target->nfinishes ||
        target->finish < (target->nfinishes > 0))
        return retex_fail(err, RETEX_EINVAL, "the target %s has finish %d of %d", target->name, target->finish,
                          target->nfinishes);
    if (!(target->normal_tilt >= 0) || !(target->normal_tilt < 90) ||
        (target->normal_tilt > 0 && (target->nfinishes != 3 || target->finish != 1)))
        return retex_fail(err, RETEX_EINVAL, "the target %s has normals that are tilted by %g degrees, of %d finishes",
                          target->name, target->normal_tilt, target->nfinishes);
    if (index)
        *index = set->ntargets;
    set->targets[set->ntargets++] = *target;
    return 0;
}

int retex_set_spread_channels(const RetexSet *set, int part)
{
    const size_t channels = part >= 0 && part < set->nparts ? strlen(set->parts[part].letters) : 0;
    return channels == 3 || channels == RETEX_AXES ? (int)channels : 2;
}

void retex_footprint_ellipse(const RetexSet *set, const RetexFootprint *f, size_t pixel, float uv[3], float spread[3])
{
    const int channels = set->parts[f->spread].image.channels;
    const float *mean = set->parts[f->uv].image.pixels + 3 * pixel;
    const float *from = set->parts[f->spread].image.pixels + (size_t)channels * pixel;
    memcpy(uv, mean, 3 * sizeof *uv);
    if (channels < RETEX_AXES) {
        memcpy(spread, from, 2 * sizeof *spread);
        spread[2] = channels == 3 ? from[2] : 0;
        return;
    }
    const RetexParallelogram p =
        retex_parallelogram((RetexTextureFilter)(RETEX_TEXTURE_PARALLELOGRAM + f->quadrant), mean, from);
    const float even = 0.28867513f, *side = p.sides; /* the deviation of an even spread over 1 */
    const float both = hypotf(side[0], side[2]) * hypotf(side[1], side[3]);
    memcpy(uv, p.uv, sizeof p.uv);
    spread[0] = even * hypotf(side[0], side[2]);
    spread[1] = even * hypotf(side[1], side[3]);
    spread[2] = both > 0 ? (side[0] * side[1] + side[2] * side[3]) / both : 0;
}

int retex_set_add_footprint(RetexSet *set, const RetexFootprint *footprint, int *index, RetexError *err)
{
    int code = 0;

    if (footprint->target < 0 || footprint->target >= set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the footprint lies on target %d of %d", footprint->target, set->ntargets);
    if (footprint->hit < 1)
        return retex_fail(err, RETEX_EINVAL, "hits count from 1, not %d", footprint->hit);
    if (footprint->kind < RETEX_FOOTPRINT_HIT || footprint->kind > RETEX_FOOTPRINT_INTERREFLECTION)
        return retex_fail(err, RETEX_EINVAL, "the footprint is of no known kind (%d)", (int)footprint->kind);
    const int channels = retex_set_spread_channels(set, footprint->spread);
    if (footprint->quadrant < 0 || footprint->quadrant > (channels == RETEX_AXES ? RETEX_QUADRANTS : 0))
        return retex_fail(err, RETEX_EINVAL, "the footprint is quadrant %d of a %s", footprint->quadrant,
                          channels == RETEX_AXES ? "parallelogram, which has 4" : "pixel without axes");
    code = check_part(set, footprint->uv, 3, 1, "a footprint's UV", err);
    if (!code)
        code = check_part(set, footprint->spread, (size_t)channels, 1, "a footprint's spread", err);
    if (!code)
        code = check_part(set, footprint->albedo, 3, 1, "a footprint's albedo", err);
    if (!code)
        code = grow_array((void **)&set->footprints, set->nfootprints, sizeof *set->footprints,
                            RETEX_SET_FOOTPRINTS_MAX, "footprints", err);
    if (code)
        return code;
    if (index)
        *index = set->nfootprints;
    set->footprints[set->nfootprints++] = *footprint;
    return 0;
}

static int check_factor(const RetexSet *set, RetexFactor factor, RetexError *err)
{
    const int counts[RETEX_FACTOR_KINDS] = {set->nfootprints, set->nmixtures, set->nparts, set->nparameters};
    if ((unsigned)factor.kind >= RETEX_FACTOR_KINDS || (unsigned)factor.quantity >= RETEX_QUANTITIES)
        return retex_fail(err, RETEX_EINVAL, "a factor is of no known kind (%d) or quantity (%d)", (int)factor.kind,
                          (int)factor.quantity);
    if (factor.index < 0 || factor.index >= counts[factor.kind])
        return retex_fail(err, RETEX_EINVAL, "a factor refers to %s %d of %d", retex_factor_kind_name(factor.kind),
                          factor.index, counts[factor.kind]);
    if (factor.kind == RETEX_FACTOR_IMAGE && factor.index == 0)
        return retex_fail(err, RETEX_EINVAL, "a factor is the set's picture");
    return factor.kind == RETEX_FACTOR_IMAGE ? check_weight(set, factor.index, "a term's factor", err) : RETEX_OK;
}

static int check_role(const RetexSet *set, const RetexTerm *term, RetexError *err)
{
    const int corrects = term->role == RETEX_ROLE_CORRECTION, least = corrects ? 0 : -1;
    if ((unsigned)term->role >= RETEX_ROLES)
        return retex_fail(err, RETEX_EINVAL, "the term is of no known role (%d)", (int)term->role);
    if (term->target < least || term->target >= set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the term is of target %d of %d", term->target, set->ntargets);
    if (term->role == RETEX_ROLE_PICTURE &&
        (term->radiance || term->nfactors || retex_set_has_role(set, RETEX_ROLE_PICTURE)))
        return retex_fail(err, RETEX_EINVAL, "one term may be the picture: part 0, without factors");
    int weights = 0, colors = 0;
    for (int k = 0; k < term->nfactors; k++) {
        const RetexParameter *parameter =
            term->factors[k].kind == RETEX_FACTOR_PARAMETER ? &set->parameters[term->factors[k].index] : NULL;
        if (parameter && parameter->kind == RETEX_PARAMETER_CORRECTION)
            weights += corrects && parameter->target == term->target ? 1 : 2;
        colors += parameter && parameter->kind == RETEX_PARAMETER_COLOR;
    }
    if ((term->role == RETEX_ROLE_LAMP || term->role == RETEX_ROLE_LAMP_PICTURE) && colors != 1)
        return retex_fail(err, RETEX_EINVAL, "a lamp's light has one parameter of kind color, not %d", colors);
    if (term->role == RETEX_ROLE_LAMP_PICTURE && term->nfactors != 1)
        return retex_fail(err, RETEX_EINVAL, "a lamp's picture has no factor but its parameter");
    return weights == corrects
               ? RETEX_OK
               : retex_fail(err, RETEX_EINVAL, "corrections, and only they, have their target's weight");
}

int retex_set_add_term(RetexSet *set, const RetexTerm *term, int *index, RetexError *err)
{
    int code = RETEX_OK;
    if (term->nfactors < 0 || term->nfactors > RETEX_MAX_FACTORS || retex_term_hits(term) > RETEX_MAX_HITS)
        return retex_fail(err, RETEX_EINVAL, "a term has 0 to %d factors, %d of them hits, not %d", RETEX_MAX_FACTORS,
                          RETEX_MAX_HITS, term->nfactors);
    if (term->noise_weight != 0 && !(term->noise_weight >= ldexpf(1, -RETEX_MAX_HITS) && term->noise_weight <= 1))
        return retex_fail(err, RETEX_EINVAL, "a term's weight in noise is %g, not 2^-%d to 1",
                          (double)term->noise_weight, RETEX_MAX_HITS);
    for (int i = 0; i < term->nfactors && !code; i++)
        code = check_factor(set, term->factors[i], err);
    if (!code)
        code = check_role(set, term, err);
    if (!code)
        code = check_part(set, term->radiance, 3, 0, "a term's radiance", err);
    if (!code)
        code = grow_array((void **)&set->terms, set->nterms, sizeof *set->terms, RETEX_SET_TERMS_MAX, "terms", err);
    if (code)
        return code;
    if (index)
        *index = set->nterms;
    set->terms[set->nterms++] = *term;
    return 0;
}

int retex_set_add_correction(RetexSet *set, const RetexTerm *term, int *index, RetexError *err)
{
    RetexTerm own = *term;
    own.role = RETEX_ROLE_CORRECTION;
    if (own.target < 0 || own.target >= set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the term corrects target %d of %d", own.target, set->ntargets);
    RetexParameter parameter = {.kind = RETEX_PARAMETER_CORRECTION, .target = own.target};
    int number = 0, code = RETEX_OK;
    while (number < set->nparameters &&
           (set->parameters[number].kind != RETEX_PARAMETER_CORRECTION || set->parameters[number].target != own.target))
        number++;
    snprintf(parameter.name, sizeof parameter.name, "correction_%d", 1 + own.target);
    if (number == set->nparameters)
        code = retex_set_add_parameter(set, &parameter, NULL, err);
    if (!code)
        code = retex_term_add_factor(&own, retex_factor(RETEX_FACTOR_PARAMETER, number), err);
    return code ? code : retex_set_add_term(set, &own, index, err);
}

int retex_set_add_parameter(RetexSet *set, const RetexParameter *parameter, int *index, RetexError *err)
{
    const int corrects = parameter->kind == RETEX_PARAMETER_CORRECTION;
    if (set->nparameters == RETEX_PARAMETERS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "a set has at most %d parameters", RETEX_PARAMETERS_MAX);
    if ((unsigned)parameter->kind >= RETEX_PARAMETER_KINDS)
        return retex_fail(err, RETEX_EINVAL, "the parameter is of no known kind (%d)", (int)parameter->kind);
    if (!parameter->name[0] || retex_set_find_parameter(set, parameter->name) >= 0)
        return retex_fail(err, RETEX_EINVAL, "the parameter has no name, or that of another one: \"%s\"",
                          parameter->name);
    if (corrects ? parameter->target < 0 || parameter->target >= set->ntargets : parameter->target != -1)
        return retex_fail(err, RETEX_EINVAL, "the parameter %s is of target %d of %d", parameter->name,
                          parameter->target, set->ntargets);
    for (int c = 0; c < 3; c++)
        if (!(parameter->value[c] >= 0 && parameter->value[c] <= (corrects ? 0 : FLT_MAX)))
            return retex_fail(err, RETEX_EINVAL, "the parameter %s has the value %g", parameter->name,
                              (double)parameter->value[c]);
    const int kept = parameter->kept[0] != 0 || parameter->kept[1] != 0 || parameter->kept[2] != 0;
    for (int c = 0; c < 3 && kept; c++)
        if (corrects || !(parameter->kept[c] >= 0 && parameter->kept[c] <= FLT_MAX))
            return retex_fail(err, RETEX_EINVAL, "the parameter %s is kept with the value %g", parameter->name,
                              (double)parameter->kept[c]);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        if (parameter->finishes[t] < 0 ||
            parameter->finishes[t] > (!corrects && t < set->ntargets ? set->targets[t].nfinishes : 0))
            return retex_fail(err, RETEX_EINVAL, "the parameter %s is of finish %d of target %d", parameter->name,
                              parameter->finishes[t], t);
    if (index)
        *index = set->nparameters;
    RetexParameter *own = &set->parameters[set->nparameters++];
    *own = *parameter;
    if (!kept)
        memcpy(own->kept, own->value, sizeof own->kept);
    return 0;
}

int retex_set_add_mixture(RetexSet *set, const RetexMixture *mixture, int *index, RetexError *err)
{
    if (set->nmixtures == RETEX_MIXTURES_MAX)
        return retex_fail(err, RETEX_ELIMIT, "a set has at most %d mixtures", RETEX_MIXTURES_MAX);
    if (mixture->nshares < 1 || mixture->nshares > RETEX_SHARES_MAX)
        return retex_fail(err, RETEX_EINVAL, "a mixture has 1 to %d shares, not %d", RETEX_SHARES_MAX,
                          mixture->nshares);
    for (int i = 0; i < mixture->nshares; i++) {
        const int footprint = mixture->shares[i].footprint;
        if (footprint < 0 || footprint >= set->nfootprints)
            return retex_fail(err, RETEX_EINVAL, "a mixture refers to footprint %d of %d", footprint, set->nfootprints);
        const int code = check_weight(set, mixture->shares[i].weight, "a mixture's weight", err);
        if (code)
            return code;
    }
    if (index)
        *index = set->nmixtures;
    set->mixtures[set->nmixtures++] = *mixture;
    return 0;
}

int retex_set_find_part(const RetexSet *set, const char *name)
{
    for (int i = 0; i < set->nparts; i++)
        if (strcmp(set->parts[i].name, name) == 0)
            return i;
    return -1;
}

int retex_set_scale(const RetexSet *set, const RetexImage *image)
{
    for (int scale = 1; scale <= RETEX_SCALE_MAX; scale *= 2)
        if (image->width == (set->width + scale - 1) / scale && image->height == (set->height + scale - 1) / scale)
            return scale;
    return 0;
}

int retex_set_footprint_scale(const RetexSet *set, int footprint)
{
    const RetexFootprint *f = &set->footprints[footprint];
    const int parts[] = {f->uv, f->spread, f->albedo, f->sampled - 1};
    int scale = 0;

    for (int k = 0; k < 4; k++) {
        if (parts[k] < 0)
            continue;
        const int own = retex_set_scale(set, &set->parts[parts[k]].image);
        if (!own || (scale && own != scale))
            return 0;
        scale = own;
    }
    return scale ? scale : 1;
}

static void find_color(void *context, RetexPartUse use, int user, int *part)
{
    int *wanted = context; /* the part, and whether it is one of colours */
    (void)user;
    if (*part == wanted[0])
        wanted[1] |= use == RETEX_PART_RADIANCE || use == RETEX_PART_ALBEDO || use == RETEX_PART_ORIGINAL ||
                     use == RETEX_PART_LAID;
}

int retex_set_part_is_color(const RetexSet *set, int part)
{
    const int aov = retex_aov_find(set->parts[part].name);
    int wanted[2] = {part, part == 0 || (aov >= 0 && retex_aov_is_color((RetexAov)aov))};
    retex_set_visit_const_parts(set, find_color, wanted);
    return wanted[1];
}

double retex_correction_weight(int ntargets, int edited)
{
    return edited == 1 ? 1 : edited < 1 ? 0 : (double)(ntargets - edited) / (edited * (ntargets - 1.0));
}

void retex_set_target_names(RetexTargetNames *names, const RetexSet *set)
{
    *names = (RetexTargetNames){.count = set->ntargets, .of = "the set", .advice = ""};
    for (int i = 0; i < set->ntargets; i++) {
        names->names[i] = set->targets[i].name;
        names->idents[i] = set->targets[i].idents;
    }
}

int retex_set_find_target(const RetexSet *set, const char *name)
{
    RetexTargetNames names;

    retex_set_target_names(&names, set);
    return retex_target_index(&names, name);
}

void retex_set_identify(RetexSet *set)
{
    const RetexImage *beauty = &set->parts[0].image;
    const size_t rows = (size_t)beauty->height;
    const size_t bytes = (size_t)beauty->width * (size_t)beauty->channels * sizeof(float);
    uint32_t id = CRC32_OF_NONE;
    for (size_t y = 0; y < rows; y++)
        id = retex_crc32(id, (const unsigned char *)beauty->pixels + y * bytes, bytes);
    set->id = id ? id : 1;
}
