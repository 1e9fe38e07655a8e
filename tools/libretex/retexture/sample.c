/* Sampling: new textures are filtered at every footprint of their targets. A footprint is a Gaussian, an ellipse or a
 * parallelogram (retex_footprint_filter) with the stored mean and spread of the surface UV, which the texture's
 * transform maps exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/combine.h>
#include <retex/edit.h>
#include <retex/host/band_store.h>
#include <retex/samples.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exr/band_store_chunks.h"
#include "set/samples.h"
#include "set/transfer.h"
#include "retexture/term_finishes.h"
#include "retexture/textures.h"
#include "retexture/view_images.h"
#include "set/parts.h"
#include "texture/pyramid.h"

typedef struct SampleWork {
    const RetexSet *set;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int nspecs;
    RetexSamples *samples;
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target */
    int borrowed;                              /* the textures are the caller's */
    RetexImageTransfer *edited;                /* footprints of edited targets */
    int nedited;
    RetexView view;                            /* of set and textures alone */
    int *view_images;                          /* by image of the samples, that of the view, if it is edited */
} SampleWork;

/* Computes rows y0 <= y < y1 of a footprint's samples, or of gates. */
static int sample_rows(void *context, RetexRowReader *unused, const RetexImageTransfer *edited, int y0, int y1,
                       float *to, RetexError *err)
{
    const SampleWork *work = context;
    const size_t numbers = 3 * (size_t)edited->image->width;
    RetexViewReader reader;
    int code = retex_view_reader_open(&reader, &work->view, err);
    (void)unused;
    for (int y = y0; y < y1 && !code; y++, to += numbers) {
        const float *row;
        code = retex_view_row(&reader, work->view_images[edited->footprint], y, &row, NULL, err);
        if (!code && row)
            memcpy(to, row, numbers * sizeof *to); /* which is 0 before */
    }
    if (reader.view)
        retex_view_reader_close(&reader);
    return code;
}

static int sample_all(SampleWork *work, int nthreads, RetexError *err)
{
    return retex_compute_images(work->edited, work->nedited, sample_rows, work, work->set, NULL, work->samples->store,
                                nthreads, err);
}

static int create_samples(SampleWork *work, RetexError *err)
{
    const RetexSet *set = work->set;
    const int code = retex_samples_create(&work->samples, set, err);
    if (code)
        return code;
    for (int i = 0; i < work->nspecs; i++)
        retex_edit_image_text(&work->specs[i],
                              work->samples->textures[retex_set_find_target(set, work->specs[i].target)],
                              sizeof work->samples->textures[0]);
    return RETEX_OK;
}

/* The scale of an image of samples. */
static int image_scale(const SampleWork *work, int image)
{
    const int footprint = work->samples->footprints[image].footprint;
    return footprint < 0 ? 1 : retex_set_footprint_scale(work->set, footprint);
}

static int alloc_image(const SampleWork *work, int image, RetexError *err)
{
    const int footprint = work->samples->footprints[image].footprint;
    const RetexImage *shape = &work->set->parts[footprint < 0 ? 0 : work->set->footprints[footprint].uv].image;
    return retex_image_alloc(&work->samples->images[image], shape->width, shape->height, 3, err);
}

static int alloc_images(const SampleWork *work, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < work->nedited && !code; i++)
        code = alloc_image(work, work->edited[i].footprint, err);
    return code;
}

/* Creates a band store for images as large as the picture; smaller images are kept in memory. */
static int store_images(SampleWork *work, const char *near, RetexError *err)
{
    const RetexSet *set = work->set;
    RetexSamples *samples = work->samples;
    int code = retex_band_store_create(&samples->store, set->width, set->height, set->id, near, err);
    if (!code && strcmp(near, "-") == 0)
        retex_band_store_set_fast(samples->store);
    for (int i = 0; i < work->nedited && !code; i++) {
        const int image = work->edited[i].footprint;
        char name[RETEX_NAME_MAX];
        if (image_scale(work, image) != 1) {
            code = alloc_image(work, image, err);
            continue;
        }
        snprintf(name, sizeof name, "sample_%d", image);
        code = retex_band_store_add(samples->store, name, "RGB", RETEX_FLOAT, &work->edited[i].store_image, err);
        samples->footprints[image].store_image = code ? 0 : 1 + work->edited[i].store_image;
        samples->images[image] = (RetexImage){.width = set->width, .height = set->height, .channels = 3};
    }
    return code;
}

static int is_loaded(const RetexSet *set, const RetexFootprint *f)
{
    return set->parts[f->uv].image.pixels && set->parts[f->spread].image.pixels && set->parts[f->albedo].image.pixels;
}

/* Adds the images of footprints with each finish, and the gates, of targets whose textures have a map. */
static int add_finishes(SampleWork *work, int target, RetexError *err)
{
    const RetexSet *set = work->set;
    int code = RETEX_OK;
    for (int i = 0; i < set->nfootprints; i++)
        for (int k = 0; k < work->view.mapped[target] && set->footprints[i].target == target && !code; k++)
            code = retex_samples_add(work->samples, (RetexSampleFootprint){target, set->footprints[i].hit, i, k, 0, 0},
                                     err);
    return code || !work->view.mapped[target]
               ? code
               : retex_samples_add(work->samples, (RetexSampleFootprint){target, 1, -1, -1, 0, 0}, err);
}

/* Adds the image of the view that an image of the samples is. */
static int add_view_image(SampleWork *work, int image)
{
    const RetexSampleFootprint *of = &work->samples->footprints[image];
    if (of->footprint < 0)
        return retex_view_gates(&work->view, of->target);
    return retex_view_footprint(&work->view, of->footprint, of->finish,
                                &work->set->parts[work->set->footprints[of->footprint].uv].image);
}

static int list_edited(SampleWork *work, int nthreads, RetexError *err)
{
    const RetexSet *set = work->set;
    RetexSamples *samples = work->samples;
    work->view = (RetexView){.set = set, .textures = work->textures, .columns = {0, set->width}};
    int code = retex_view_find_maps(&work->view, NULL, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        code = add_finishes(work, t, err);
    work->edited = calloc((size_t)samples->nimages + 1, sizeof *work->edited);
    work->view_images = calloc((size_t)samples->nimages + 1, sizeof *work->view_images);
    if (!code && (!work->edited || !work->view_images))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    for (int i = 0; i < samples->nimages && !code; i++) {
        if (!work->textures[samples->footprints[i].target])
            continue;
        work->edited[work->nedited++] = (RetexImageTransfer){.part = -1, .footprint = i, .image = &samples->images[i]};
        if ((work->view_images[i] = add_view_image(work, i)) < 0)
            code = retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    }
    return code ? code : retex_view_make(&work->view, nthreads, err);
}

static int check_loaded(const SampleWork *work, RetexError *err)
{
    for (int i = 0; i < work->nedited; i++)
        if (work->samples->footprints[work->edited[i].footprint].footprint >= 0 &&
            !is_loaded(work->set,
                       &work->set->footprints[work->samples->footprints[work->edited[i].footprint].footprint]))
            return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
    return RETEX_OK;
}

static int open_work(SampleWork *work, const RetexTextureSpec *specs, int nthreads, RetexError *err)
{
    int code = retex_texture_specs_copy(work->specs, specs, work->nspecs, err);
    if (!code && !work->borrowed)
        code = retex_textures_load(work->textures, work->set, work->specs, work->nspecs, nthreads, err);
    if (!code)
        code = create_samples(work, err);
    return code ? code : list_edited(work, nthreads, err);
}

/* Returns the samples, or closes them if code says that something failed. */
static int close_work(SampleWork *work, RetexSamples **samples, int code)
{
    if (code)
        retex_samples_close(&work->samples);
    *samples = work->samples;
    if (!work->borrowed)
        retex_textures_close(work->textures);
    free(work->edited);
    free(work->view_images);
    retex_view_close(&work->view);
    return code;
}

int retex_sample(RetexSamples **samples, const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads,
                 RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs};
    int code = open_work(&work, specs, nthreads, err);
    if (!code)
        code = check_loaded(&work, err);
    if (!code)
        code = alloc_images(&work, err);
    return close_work(&work, samples, code ? code : sample_all(&work, nthreads, err));
}

int retex_sample_textures(RetexSamples **samples, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                          const RetexTextureSpec *specs, int nspecs, const char *near, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs, .borrowed = 1};
    memcpy(work.textures, textures, sizeof work.textures);
    int code = open_work(&work, specs, nthreads, err);
    if (!code)
        code = store_images(&work, near, err);
    return close_work(&work, samples, code ? code : sample_all(&work, nthreads, err));
}

/* ---- more of them ---- */

static void move_image(RetexSamples *samples, int to, RetexSamples *more, int from)
{
    retex_image_free(&samples->images[to]);
    samples->images[to] = more->images[from];
    samples->footprints[to].store_image = more->footprints[from].store_image;
    samples->footprints[to].source_image = more->footprints[from].source_image;
    more->images[from] = (RetexImage){0};
    more->footprints[from].store_image = more->footprints[from].source_image = 0;
}

/* Makes room for the images with finishes of `more`; those of targets that get new samples go. On failure samples stay
 * as they were. */
static int add_more_finishes(RetexSamples *samples, const RetexSamples *more, RetexError *err)
{
    const int had = samples->nimages;
    int resampled[RETEX_MAX_TARGETS] = {0}, kept = samples->nfootprints;
    for (int i = 0; i < more->nfootprints; i++)
        resampled[more->footprints[i].target] |= retex_samples_have(more, i);
    for (int i = more->nfootprints; i < more->nimages; i++)
        if (retex_samples_add(samples, more->footprints[i], err)) {
            samples->nimages = had;
            return RETEX_ENOMEM;
        }
    for (int i = samples->nfootprints; i < samples->nimages; i++) {
        if (i >= had)
            samples->footprints[i].store_image = samples->footprints[i].source_image = 0;
        if (i < had && resampled[samples->footprints[i].target]) {
            retex_image_free(&samples->images[i]);
            continue;
        }
        samples->footprints[kept] = samples->footprints[i];
        samples->images[kept++] = samples->images[i];
    }
    samples->nimages = kept;
    return RETEX_OK;
}

/* Moves the band store and the source of moved images. */
static void move_stores(RetexSamples *samples, RetexSamples *more)
{
    if (more->store) {
        samples->store = more->store;
        more->store = NULL;
    }
    if (more->source) {
        samples->source = more->source;
        more->source = NULL;
    }
}

int retex_samples_merge(RetexSamples *samples, RetexSamples *more, int nthreads, RetexError *err)
{
    int same = samples->width == more->width && samples->height == more->height &&
               samples->nfootprints == more->nfootprints && samples->ntargets == more->ntargets;
    for (int t = 0; same && t < samples->ntargets; t++)
        same = strcmp(samples->target_names[t], more->target_names[t]) == 0;
    for (int i = 0; same && i < samples->nfootprints; i++)
        same = samples->footprints[i].target == more->footprints[i].target;
    if (!same)
        return retex_fail(err, RETEX_EINVAL, "the samples are of different sets");
    if ((samples->store && more->store) || (samples->source && more->source)) { /* samples have one of each only */
        int code = retex_samples_load(more, nthreads, err);
        if (code)
            return code;
    }
    int code = add_more_finishes(samples, more, err);
    if (code)
        return code;
    for (int i = 0, to = samples->nimages - (more->nimages - more->nfootprints); i < more->nimages; i++) {
        const int at = i < more->nfootprints ? i : to++;
        if (retex_samples_have(more, i))
            move_image(samples, at, more, i);
    }
    move_stores(samples, more);
    for (int t = 0; t < more->ntargets; t++)
        if (more->textures[t][0])
            memcpy(samples->textures[t], more->textures[t], sizeof samples->textures[t]);
    return RETEX_OK;
}
