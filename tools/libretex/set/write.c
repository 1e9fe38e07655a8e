/* Writes sets, and samples. Parts are encoded first, because the manifest, which is in the file's
 * header, holds their checksums. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/band_store.h>
#include <retex/set_file.h>

#include "base/params.h"
#include "exr/io.h"
#include "set/keep.h"
#include "set/laid.h"
#include "set/manifest.h"
#include "io/output.h"
#include "set/parts.h"
#include "set/references.h"
#include "set/source.h"

typedef struct Choice {
    const RetexSet *set;
    char *in_view;
} Choice;

/* Whether a factor of quantity FURTHER, which is relative to the original albedo, is of the footprint. */
static int has_further(const RetexSet *set, int footprint)
{
    int found = 0;
    for (int t = 0; t < set->nterms; t++)
        for (int k = 0; k < set->terms[t].nfactors; k++) {
            const RetexFactor factor = set->terms[t].factors[k];
            if (factor.quantity != RETEX_QUANTITY_FURTHER)
                continue;
            found |= factor.kind == RETEX_FACTOR_FOOTPRINT && factor.index == footprint;
            for (int s = 0; factor.kind == RETEX_FACTOR_MIXTURE && s < set->mixtures[factor.index].nshares; s++)
                found |= set->mixtures[factor.index].shares[s].footprint == footprint;
        }
    return found;
}

static void keep_part(void *context, RetexPartUse use, int user, int *part)
{
    const Choice *c = context;
    const int of_footprint = use == RETEX_PART_UV || use == RETEX_PART_SPREAD || use == RETEX_PART_ALBEDO;
    const int is_laid = use == RETEX_PART_LAID || use == RETEX_PART_GATES;
    const int sampled = of_footprint && c->set->footprints[user].sampled;
    const int is_read =
        use != RETEX_PART_ORIGINAL && (!sampled || (use == RETEX_PART_ALBEDO && has_further(c->set, user)));
    c->in_view[*part] |= c->set->is_samples ? is_laid : is_read;
}

/* Decides which parts are written. Of a set with textures laid on it only those that recombination needs: the picture,
 * the terms, what the textures show, and footprints that have none, so that another target can be given one further
 * down the pipe. Of samples only what the textures show. */
static void choose_parts(const RetexSet *set, char *in_view)
{
    Choice choice = {set, in_view};
    const int all = !set->is_samples && !retex_set_has_laid(set);
    memset(in_view, all, (size_t)set->nparts);
    in_view[0] |= !set->is_samples;
    if (!all)
        retex_set_visit_const_parts(set, keep_part, &choice);
}

static int part_in_range(const RetexSet *set, int part, int optional)
{
    return (part >= 0 && part < set->nparts) || (optional && part == -1);
}

static int mixture_is_sound(const RetexSet *set, const RetexMixture *mixture)
{
    int sound = mixture->nshares >= 1 && mixture->nshares <= RETEX_SHARES_MAX;
    for (int k = 0; k < mixture->nshares && sound; k++)
        sound = part_in_range(set, mixture->shares[k].weight, 0) && mixture->shares[k].footprint >= 0 &&
                mixture->shares[k].footprint < set->nfootprints;
    return sound;
}

static int term_is_sound(const RetexSet *set, const RetexTerm *term)
{
    const int counts[RETEX_FACTOR_KINDS] = {set->nfootprints, set->nmixtures, set->nparts, set->nparameters};
    int sound = (unsigned)term->role < RETEX_ROLES && term->target >= -1 && term->target < set->ntargets &&
                part_in_range(set, term->radiance, 0) && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS;
    for (int k = 0; sound && k < term->nfactors; k++) {
        const RetexFactor factor = term->factors[k];
        sound = (unsigned)factor.kind < RETEX_FACTOR_KINDS && (unsigned)factor.quantity < RETEX_QUANTITIES &&
                factor.index >= 0 && factor.index < counts[factor.kind];
    }
    return sound;
}

/* Whether the set has no more of each than files can have. */
static int counts_are_sound(const RetexSet *set)
{
    const struct {
        int count, most;
    } lists[] = {{set->ntargets, RETEX_MAX_TARGETS},       {set->nfootprints, RETEX_SET_FOOTPRINTS_MAX},
                 {set->nmixtures, RETEX_MIXTURES_MAX},     {set->nterms, RETEX_SET_TERMS_MAX},
                 {set->nparameters, RETEX_PARAMETERS_MAX}, {set->nparts, RETEX_SET_PARTS_MAX}};
    int sound = 1;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        sound = sound && lists[i].count >= 0 && lists[i].count <= lists[i].most;
    return sound;
}

/* Whether all parts, footprints and so on that the set refers to are there. */
static int references_are_sound(const RetexSet *set)
{
    int sound = 1;
    for (int i = 0; i < set->ntargets && sound; i++)
        sound = part_in_range(set, set->targets[i].original, 1) && part_in_range(set, set->targets[i].gates - 1, 1);
    for (int i = 0; i < set->nfootprints && sound; i++) {
        const RetexFootprint *footprint = &set->footprints[i];
        sound = part_in_range(set, footprint->uv, 1) && part_in_range(set, footprint->spread, 1) &&
                part_in_range(set, footprint->albedo, 1) && part_in_range(set, footprint->sampled - 1, 1);
        for (int k = 0; k < RETEX_FINISHES_MAX && sound; k++)
            sound = part_in_range(set, footprint->finished[k] - 1, 1);
    }
    for (int i = 0; i < set->nmixtures && sound; i++)
        sound = mixture_is_sound(set, &set->mixtures[i]);
    for (int i = 0; i < set->nterms && sound; i++)
        sound = term_is_sound(set, &set->terms[i]);
    return sound;
}

/* Checks everything about a set that a caller may have filled in by hand. */
static int check_set(const RetexSet *set, RetexError *err)
{
    const RetexPart *picture = set->parts;
    if (!set->is_samples &&
        (set->nparts < 1 || set->nparts > RETEX_SET_PARTS_MAX || strcmp(picture->letters, "RGB") != 0 ||
         picture->image.width != set->width || picture->image.height != set->height))
        return retex_fail(err, RETEX_EINVAL, "the set's first part is no RGB picture of %d x %d pixels", set->width,
                          set->height);
    for (int i = 0; i < set->nparts; i++)
        if (!set->parts[i].image.pixels && !set->parts[i].source)
            return retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
    return counts_are_sound(set) && references_are_sound(set)
               ? RETEX_OK
               : retex_fail(err, RETEX_EINVAL, "the set refers to parts it does not have");
}

/* State of writing one file. */
typedef struct Writing {
    const RetexSet *whole;
    RetexSetView view; /* of it */
    RetexBandSums sums;
    RetexImage blank;    /* one pixel, for a file that would have no part */
    RetexExrPart *parts; /* of the view */
    int count;
    RetexExrStored *stored; /* one for each part that is copied as it is stored */
    int nstored;
    char kept[RETEX_SET_PARTS_MAX]; /* of the view's parts: 1: brought out of an open file; it has their pixels */
    const char *path;
    RetexExrCompression compress;
    int nthreads;
} Writing;

static RetexExrPart *add_exr_part(Writing *w, const char *name, const char *letters, RetexPixelType type,
                                  const RetexImage *image)
{
    RetexExrPart *part = &w->parts[w->count++];

    snprintf(part->name, sizeof part->name, "%s", name);
    snprintf(part->letters, sizeof part->letters, "%s", letters);
    part->type = type;
    part->image = image;
    return part;
}

/* Whether the chunks of a part are copied as they are stored: those of an open file to a pipe. Whoever reads the pipe
 * compares the checksums; files are written from what was decoded and compared. */
static int is_copied(Writing *w, const RetexPart *part)
{
    RetexSetSource *source = part->image.pixels ? NULL : part->source;
    return source && source->stored && w->compress == RETEX_EXR_QUICKLY &&
           source->stored(source, part->source_part, part->type, &w->stored[w->nstored]);
}

/* Brings all other parts that are in an open file out of it, those of the picture's size into a band store: the
 * manifest, which stands first in the file to be written, has the checksums of all. */
static int keep_others(Writing *w, RetexError *err)
{
    RetexSet *set = &w->view.set;
    RetexBandStore *store = NULL;
    int any = 0, code = RETEX_OK;
    for (int i = 0; i < set->nparts; i++) {
        const RetexPart *part = &set->parts[i];
        w->kept[i] = !part->image.pixels && !retex_part_store(part) && !is_copied(w, part);
        any |= w->kept[i];
    }
    if (any)
        code = retex_band_store_create(&store, set->width, set->height, 0, w->path, err);
    if (store && !w->compress)
        retex_band_store_set_plain(store);
    if (store && w->compress == RETEX_EXR_QUICKLY)
        retex_band_store_set_fast(store);
    return code || !any ? code : retex_set_keep(set, w->kept, store, w->nthreads, err);
}

/* Lists all parts with the place of their pixels. */
static int list_parts(Writing *w, RetexError *err)
{
    const int code = keep_others(w, err);
    for (int i = 0; i < w->view.set.nparts && !code; i++) {
        const RetexPart *part = &w->view.set.parts[i];
        RetexExrPart *exr = add_exr_part(w, part->name, part->letters, part->type, &part->image);
        exr->color = retex_set_part_is_color(&w->view.set, i) ? &retex_color_tag_rec709 : &retex_color_tag_data;
        if (!part->image.pixels && (exr->store = retex_part_store(part)))
            exr->store_image = part->source_part;
        else if (is_copied(w, part))
            exr->stored = &w->stored[w->nstored++];
    }
    if (w->count == 0)
        add_exr_part(w, "nothing", "RGB", RETEX_HALF, &w->blank);
    return code;
}

/* Copies the checksums to where the manifest takes them from. */
static int keep_sums(Writing *w, const RetexExrEncoding *encoding, RetexError *err)
{
    const int count = w->view.set.nparts;

    w->sums.of = calloc((size_t)count + 1, sizeof *w->sums.of);
    for (int i = 0; w->sums.of && i < count; i++) {
        w->view.set.parts[i].crc = w->parts[i].crc;
        if (!(w->sums.of[i] = retex_exr_band_crcs(encoding, i)))
            break;
        w->sums.count++;
    }
    return w->sums.of && w->sums.count == count ? RETEX_OK
                                                : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", w->path);
}

/* Encodes the parts and writes the file. */
static int write_parts(Writing *w, RetexError *err)
{
    RetexExrEncoding *encoding = NULL;
    char *json = NULL;
    int code = retex_exr_encode(&encoding, w->parts, w->count, w->compress, w->nthreads, err);

    if (!code)
        code = keep_sums(w, encoding, err);
    if (!code)
        code = retex_manifest_write(&w->view.set, &w->sums, &json, err);
    if (!code)
        code =
            retex_exr_write(encoding, w->whole->width, w->whole->height, RETEX_MANIFEST_ATTRIBUTE, json, w->path, err);
    retex_exr_encoding_free(&encoding);
    free(json);
    return code;
}

static int open_writing(Writing *w, RetexError *err)
{
    char in_view[RETEX_SET_PARTS_MAX];

    choose_parts(w->whole, in_view);
    int code = retex_set_view_make(&w->view, w->whole, in_view, err);
    if (code)
        return code;
    const int most = w->view.set.nparts + 1;
    w->parts = calloc((size_t)most, sizeof *w->parts);
    w->stored = calloc((size_t)most, sizeof *w->stored);
    if (!w->parts || !w->stored)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", w->path);
    return retex_image_alloc(&w->blank, 1, 1, 3, err);
}

static void close_writing(Writing *w)
{
    for (int i = 0; i < w->view.set.nparts; i++)
        if (w->kept[i])
            retex_image_free(&w->view.set.parts[i].image);
    retex_image_free(&w->blank);
    retex_band_sums_free(&w->sums);
    free(w->stored);
    free(w->parts);
    retex_set_view_free(&w->view);
}

int retex_set_write(RetexSet *set, const char *path, const RetexStoreParams *params, int nthreads, RetexError *err)
{
    RetexStoreParams own = RETEX_STORE_INIT;
    int code = RETEX_PARAMS_COPY(&own, params, err);

    if (!code)
        code = check_set(set, err);
    if (code)
        return code;
    Writing w = {.whole = set, .path = path, .nthreads = nthreads};
    w.compress = !own.compress ? RETEX_EXR_PLAIN : strcmp(path, "-") == 0 ? RETEX_EXR_QUICKLY : RETEX_EXR_SMALL;
    code = open_writing(&w, err);
    if (!code)
        code = list_parts(&w, err);
    if (!code)
        code = write_parts(&w, err);
    for (int i = 0; i < w.view.set.nparts && !code; i++)
        set->parts[w.view.source[i]].crc = w.view.set.parts[i].crc;
    close_writing(&w);
    return code;
}

int retex_set_write_samples(const RetexSet *set, const char *path, const RetexStoreParams *params, int nthreads,
                            RetexError *err)
{
    RetexSet samples = *set; /* with its parts, but of what refers to them only the textures that are laid on it */
    samples.is_samples = 1;
    samples.nterms = samples.nmixtures = samples.nparameters = 0;
    return retex_set_write(&samples, path, params, nthreads, err);
}
