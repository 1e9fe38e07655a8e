/* Writes sets, samples and streams of both. Parts are encoded first, because the manifest, which is in the file's
 * header, holds their checksums. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/samples.h>
#include <retex/set_file.h>

#include "base/params.h"
#include "exr/io.h"
#include "set/manifest.h"
#include "io/output.h"
#include "set/parts.h"
#include "set/references.h"
#include "set/source.h"
#include "set/staging.h"

typedef struct Choice {
    const RetexSet *set;
    const RetexSamples *samples;
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
    const int sampled = of_footprint && retex_samples_have(c->samples, user);
    c->in_view[*part] |= use != RETEX_PART_ORIGINAL &&
                      (!sampled || (use == RETEX_PART_ALBEDO && has_further(c->set, user)));
}

/* Decides which parts are written. With samples only those that recombination needs: the picture, the terms, and
 * footprints that have no sample, so that another target can be sampled further down the pipe. */
static void choose_parts(const RetexSet *set, const RetexSamples *samples, char *in_view)
{
    Choice choice = {set, samples, in_view};
    memset(in_view, !samples, (size_t)set->nparts);
    in_view[0] = 1;
    if (samples)
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
        sound = part_in_range(set, set->targets[i].original, 1);
    for (int i = 0; i < set->nfootprints && sound; i++) {
        const RetexFootprint *footprint = &set->footprints[i];
        sound = part_in_range(set, footprint->uv, 1) && part_in_range(set, footprint->spread, 1) &&
                part_in_range(set, footprint->albedo, 1);
    }
    for (int i = 0; i < set->nmixtures && sound; i++)
        sound = mixture_is_sound(set, &set->mixtures[i]);
    for (int i = 0; i < set->nterms && sound; i++)
        sound = term_is_sound(set, &set->terms[i]);
    return sound;
}

/* Whether a part's pixels are somewhere: in the band store, in memory, or in the open file. */
static int has_pixels(const RetexSet *set, const RetexPart *part)
{
    return part->store_image ? set->store != NULL : part->image.pixels || set->source;
}

/* Checks everything about a set that a caller may have filled in by hand. */
static int check_set(const RetexSet *set, RetexError *err)
{
    const RetexPart *picture = set->parts;
    if (set->nparts < 1 || set->nparts > RETEX_SET_PARTS_MAX || strcmp(picture->letters, "RGB") != 0 ||
        picture->image.width != set->width || picture->image.height != set->height)
        return retex_fail(err, RETEX_EINVAL, "the set's first part is no RGB picture of %d x %d pixels", set->width,
                          set->height);
    for (int i = 0; i < set->nparts; i++)
        if (!has_pixels(set, &set->parts[i]))
            return retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
    return counts_are_sound(set) && references_are_sound(set)
               ? RETEX_OK
               : retex_fail(err, RETEX_EINVAL, "the set refers to parts it does not have");
}

/* State of writing one file. */
typedef struct Writing {
    const RetexSet *whole; /* or NULL */
    RetexSetView view;     /* of it */
    const RetexSamples *samples;
    RetexSamplePart *names;
    RetexBandSums sums;
    RetexImage blank;    /* one pixel, for a file that would have no part */
    RetexExrPart *parts; /* parts of the view, then of the samples */
    int count;
    RetexStaging staging;
    RetexExrStored *stored; /* one for each part that is copied as it is stored */
    int nstored;
    const char *path;
    RetexExrCompression compress;
    int nthreads, width, height;
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

/* A part that is in an open file. For a pipe its chunks are copied as they are stored, if they can be; whoever reads
 * the pipe compares the checksums. Files are written from what was decoded and compared. */
static int add_part_in_source(Writing *w, RetexExrPart *exr, int part, int footprint, RetexError *err)
{
    RetexSetSource *source = part >= 0 ? w->whole->source : w->samples->source;
    const int number = part >= 0 ? part : w->samples->footprints[footprint].source_image - 1;
    RetexExrStored *stored = &w->stored[w->nstored];
    if (w->compress == RETEX_EXR_QUICKLY && source->stored && source->stored(source, number, exr->type, stored)) {
        exr->stored = stored;
        w->nstored++;
        return RETEX_OK;
    }
    return retex_staging_add(&w->staging, exr, part, footprint, w->width, w->height, w->path, w->compress, err);
}

/* Lists all parts with the place of their pixels, after copying those of another open file. */
static int list_parts(Writing *w, RetexError *err)
{
    int code = 0;

    for (int i = 0; i < w->view.set.nparts && !code; i++) {
        const RetexPart *part = &w->view.set.parts[i];
        RetexExrPart *exr = add_exr_part(w, part->name, part->letters, part->type, &part->image);
        exr->color = retex_set_part_is_color(&w->view.set, i) ? &retex_color_tag_rec709 : &retex_color_tag_data;
        if (part->store_image)
            exr->store = w->whole->store, exr->store_image = part->store_image - 1;
        else if (!part->image.pixels)
            code = add_part_in_source(w, exr, w->view.source[i], -1, err);
    }
    for (int i = 0; w->samples && i < w->samples->nimages && !code; i++) {
        const RetexSamples *samples = w->samples;
        if (!w->names[i].name[0])
            continue;
        RetexExrPart *exr = add_exr_part(w, w->names[i].name, "RGB", RETEX_FLOAT, &samples->images[i]);
        exr->color = &retex_color_tag_rec709;
        if (samples->footprints[i].store_image)
            exr->store = samples->store, exr->store_image = samples->footprints[i].store_image - 1;
        else if (!samples->images[i].pixels)
            code = add_part_in_source(w, exr, -1, i, err);
    }
    if (w->count == 0)
        add_exr_part(w, "nothing", "RGB", RETEX_HALF, &w->blank);
    return code ? code : retex_staging_fill(&w->staging, w->whole, w->samples, w->nthreads, err);
}

static int keep_band_sums(Writing *w, const RetexExrEncoding *encoding, int part, RetexError *err)
{
    uint32_t *crcs = retex_exr_band_crcs(encoding, part);

    w->sums.of[w->sums.count++] = crcs;
    return crcs ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", w->path);
}

/* Copies the checksums to where the manifest takes them from. */
static int keep_sums(Writing *w, const RetexExrEncoding *encoding, RetexError *err)
{
    int next = 0, code = 0;

    w->sums.of =
        calloc((size_t)w->view.set.nparts + (size_t)(w->samples ? w->samples->nimages : 0) + 1, sizeof *w->sums.of);
    if (!w->sums.of)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", w->path);
    for (int i = 0; i < w->view.set.nparts && !code; i++, next++) {
        w->view.set.parts[i].crc = w->parts[next].crc;
        code = keep_band_sums(w, encoding, next, err);
    }
    for (int i = 0; w->samples && i < w->samples->nimages && !code; i++) {
        if (!w->names[i].name[0]) {
            w->sums.of[w->sums.count++] = NULL;
            continue;
        }
        w->names[i].crc = w->parts[next].crc;
        code = keep_band_sums(w, encoding, next++, err);
    }
    return code;
}

/* Encodes the parts and writes the file. */
static int write_parts(Writing *w, RetexError *err)
{
    RetexSet *set = w->whole ? &w->view.set : NULL;
    RetexExrEncoding *encoding = NULL;
    char *json = NULL;
    int code = retex_exr_encode(&encoding, w->parts, w->count, w->compress, w->nthreads, err);

    if (!code)
        code = keep_sums(w, encoding, err);
    if (!code)
        code = retex_manifest_write(set, w->samples, w->names, &w->sums, &json, err);
    if (!code)
        code = retex_exr_write(encoding, w->width, w->height, RETEX_MANIFEST_ATTRIBUTE, json, w->path, err);
    retex_exr_encoding_free(&encoding);
    free(json);
    return code;
}

static int check_written(const RetexSet *set, const RetexSamples *samples, RetexError *err)
{
    int code = 0;

    if (!set && !samples)
        return retex_fail(err, RETEX_EINVAL, "there is neither a set nor samples to write");
    if (set)
        code = check_set(set, err);
    if (!code && samples)
        code = retex_samples_are_sound(samples, err);
    if (!code && set && samples)
        code = retex_samples_check(samples, set, err);
    return code;
}

static int open_writing(Writing *w, RetexError *err)
{
    const int nsamples = w->samples ? w->samples->nimages : 0;
    char in_view[RETEX_SET_PARTS_MAX];
    int code = 0;

    if (w->whole) {
        choose_parts(w->whole, w->samples, in_view);
        code = retex_set_view_make(&w->view, w->whole, in_view, err);
    }
    if (code)
        return code;
    const int most = w->view.set.nparts + nsamples + 1;
    w->parts = calloc((size_t)most, sizeof *w->parts);
    w->names = calloc((size_t)nsamples + 1, sizeof *w->names);
    w->stored = calloc((size_t)most, sizeof *w->stored);
    if (!w->parts || !w->names || !w->stored)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", w->path);
    if (w->samples)
        retex_sample_part_names(w->samples, w->whole, w->names);
    code = retex_image_alloc(&w->blank, 1, 1, 3, err);
    return code ? code : retex_staging_open(&w->staging, most, err);
}

static void close_writing(Writing *w)
{
    retex_staging_close(&w->staging);
    retex_image_free(&w->blank);
    retex_band_sums_free(&w->sums);
    free(w->stored);
    free(w->names);
    free(w->parts);
    retex_set_view_free(&w->view);
}

int retex_set_write(RetexSet *set, const RetexSamples *samples, const char *path, const RetexStoreParams *params,
                    int nthreads, RetexError *err)
{
    RetexStoreParams own = RETEX_STORE_INIT;
    int code = RETEX_PARAMS_COPY(&own, params, err);

    if (!code)
        code = check_written(set, samples, err);
    if (code)
        return code;
    Writing w = {.whole = set, .samples = samples, .path = path, .nthreads = nthreads};
    w.compress = !own.compress ? RETEX_EXR_PLAIN : strcmp(path, "-") == 0 ? RETEX_EXR_QUICKLY : RETEX_EXR_SMALL;
    w.width = set ? set->width : samples->width;
    w.height = set ? set->height : samples->height;
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
