/* Sets in memory: creation, adding, searching. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/aov.h>
#include <retex/set.h>

#include "base/part_name.h"
#include "io/checksum.h"
#include "set/manifest.h"
#include "set/source.h"

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
    for (int i = 0; i < set->nparts; i++)
        retex_image_free(&set->parts[i].image);
    free(set->parts);
    free(set->footprints);
    free(set->terms);
    retex_band_store_close(&set->store);
    if (set->source)
        set->source->close(set->source);
    free(set);
    *result = NULL;
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

/* Appends a part without pixels. */
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
    const int status =
        grow_array((void **)&set->parts, set->nparts, sizeof *set->parts, RETEX_SET_PARTS_MAX, "parts", err);
    if (status)
        return status;
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
    int status = describe_part(set, name, letters, type, width, height, &part, err);

    if (status)
        return status;
    const RetexImage shape = part->image;
    part->image = (RetexImage){0};
    status = retex_image_alloc(&part->image, shape.width, shape.height, shape.channels, err);
    if (status)
        return status;
    if (index)
        *index = set->nparts;
    set->nparts++;
    return 0;
}

int retex_set_add_stored(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int image,
                         int *index, RetexError *err)
{
    RetexPart *part;
    const int status = describe_part(set, name, letters, type, 0, 0, &part, err);

    if (status)
        return status;
    part->store_image = image + 1;
    if (index)
        *index = set->nparts;
    set->nparts++;
    return 0;
}

static void move_up(int *reference, int part)
{
    if (*reference > part)
        --*reference;
}

void retex_set_remove_part(RetexSet *set, int part)
{
    retex_image_free(&set->parts[part].image);
    memmove(&set->parts[part], &set->parts[part + 1], sizeof *set->parts * (size_t)(--set->nparts - part));
    for (int t = 0; t < set->ntargets; t++)
        move_up(&set->targets[t].original, part);
    for (int f = 0; f < set->nfootprints; f++) {
        move_up(&set->footprints[f].uv, part);
        move_up(&set->footprints[f].spread, part);
        move_up(&set->footprints[f].albedo, part);
    }
    for (int t = 0; t < set->nterms; t++) {
        move_up(&set->terms[t].radiance, part);
        move_up(&set->terms[t].gain, part);
    }
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            move_up(&set->mixtures[m].shares[k].weight, part);
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

const char *retex_footprint_kind_name(int kind)
{
    static const char *const names[RETEX_FOOTPRINT_KINDS] = {"hit", "sharp", "broad", "interreflection"};

    return names[kind];
}

const char *retex_term_kind_name(int kind)
{
    static const char *const names[RETEX_TERM_KINDS] = {"full", "indep", "dep", "cross2", "cross3"};

    return names[kind];
}

int retex_set_add_footprint(RetexSet *set, const RetexFootprint *footprint, int *index, RetexError *err)
{
    int status = 0;

    if (footprint->target < 0 || footprint->target >= set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the footprint lies on target %d of %d", footprint->target, set->ntargets);
    if (footprint->hit < 1)
        return retex_fail(err, RETEX_EINVAL, "hits count from 1, not %d", footprint->hit);
    if (footprint->kind < RETEX_FOOTPRINT_HIT || footprint->kind > RETEX_FOOTPRINT_INTERREFLECTION)
        return retex_fail(err, RETEX_EINVAL, "the footprint is of no known kind (%d)", (int)footprint->kind);
    const int correlated =
        footprint->spread >= 0 && footprint->spread < set->nparts && strlen(set->parts[footprint->spread].letters) == 3;
    status = check_part(set, footprint->uv, 3, 1, "a footprint's UV", err);
    if (!status)
        status = check_part(set, footprint->spread, correlated ? 3 : 2, 1, "a footprint's spread", err);
    if (!status)
        status = check_part(set, footprint->albedo, 3, 1, "a footprint's albedo", err);
    if (!status)
        status = grow_array((void **)&set->footprints, set->nfootprints, sizeof *set->footprints,
                            RETEX_SET_FOOTPRINTS_MAX, "footprints", err);
    if (status)
        return status;
    if (index)
        *index = set->nfootprints;
    set->footprints[set->nfootprints++] = *footprint;
    return 0;
}

int retex_set_add_term(RetexSet *set, const RetexTerm *term, int *index, RetexError *err)
{
    if (term->kind < RETEX_TERM_FULL || term->kind > RETEX_TERM_CROSS3)
        return retex_fail(err, RETEX_EINVAL, "the term is of no known kind (%d)", (int)term->kind);
    if (term->nfactors < 0 || term->nfactors > RETEX_MAX_FACTORS)
        return retex_fail(err, RETEX_EINVAL, "a term has 0 to %d factors, not %d", RETEX_MAX_FACTORS, term->nfactors);
    for (int i = 0; i < term->nfactors; i++) {
        const int factor = term->factors[i];
        if (factor >= set->nfootprints)
            return retex_fail(err, RETEX_EINVAL, "a factor refers to footprint %d of %d", factor, set->nfootprints);
        if (factor < 0 && RETEX_MIXTURE(factor) >= set->nmixtures)
            return retex_fail(err, RETEX_EINVAL, "a factor refers to mixture %d of %d", RETEX_MIXTURE(factor),
                              set->nmixtures);
    }
    int status = check_part(set, term->radiance, 3, 0, "a term's radiance", err);
    const int colored = term->gain > 0 && term->gain < set->nparts && strlen(set->parts[term->gain].letters) == 3;
    if (!status && term->gain)
        status = check_part(set, term->gain, colored ? 3 : 1, 0, "a term's gain", err);
    if (!status)
        status = grow_array((void **)&set->terms, set->nterms, sizeof *set->terms, RETEX_SET_TERMS_MAX, "terms", err);
    if (status)
        return status;
    if (index)
        *index = set->nterms;
    set->terms[set->nterms++] = *term;
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
        const int footprint = mixture->shares[i].footprint, weight = mixture->shares[i].weight;
        if (footprint < 0 || footprint >= set->nfootprints)
            return retex_fail(err, RETEX_EINVAL, "a mixture refers to footprint %d of %d", footprint, set->nfootprints);
        const int colored = weight >= 0 && weight < set->nparts && strlen(set->parts[weight].letters) == 3;
        const int status = check_part(set, weight, colored ? 3 : 1, 0, "a mixture's weight", err);
        if (status)
            return status;
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
    const int parts[] = {f->uv, f->spread, f->albedo};
    int scale = 0;

    for (int k = 0; k < 3; k++) {
        if (parts[k] < 0)
            continue;
        const int own = retex_set_scale(set, &set->parts[parts[k]].image);
        if (!own || (scale && own != scale))
            return 0;
        scale = own;
    }
    return scale ? scale : 1;
}

int retex_set_part_is_color(const RetexSet *set, int part)
{
    const int aov = retex_aov_find(set->parts[part].name);
    int found = part == 0 || (aov >= 0 && retex_aov_is_color((RetexAov)aov));

    for (int i = 0; i < set->nterms && !found; i++)
        found = set->terms[i].radiance == part;
    for (int i = 0; i < set->nfootprints && !found; i++)
        found = set->footprints[i].albedo == part;
    for (int i = 0; i < set->ntargets && !found; i++)
        found = set->targets[i].original == part;
    return found;
}

double retex_correction_weight(int ntargets, int edited)
{
    return edited == 1 ? 1 : edited < 1 ? 0 : (double)(ntargets - edited) / (edited * (ntargets - 1.0));
}

int retex_set_find_target(const RetexSet *set, const char *name)
{
    int found = -1, count = 0, of_ident = 0;

    for (int i = 0; i < set->ntargets; i++) {
        if (strcmp(set->targets[i].name, name) == 0)
            return i;
        if (strcasecmp(set->targets[i].name, name) == 0) {
            found = i;
            count++;
        }
    }
    for (int i = 0; !count && i < set->ntargets; i++)
        if (strcmp(set->targets[i].idents, name) == 0) {
            found = i;
            of_ident++;
        }
    return count + of_ident == 1 ? found : -1;
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
