/* Sampling: new textures are filtered at every footprint of their targets. A footprint is a Gaussian with the stored
 * mean and standard deviations of the surface UV, which the texture's transform maps exactly. Where the texture is
 * transparent the original albedo of the footprint shows. */
#include <retex/combine.h>
#include <retex/edit.h>
#include <retex/host/band_store.h>
#include <retex/samples.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "set/samples.h"
#include "set/transfer.h"
#include "retexture/sample_row.h"
#include "retexture/textures.h"
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
} SampleWork;

/* Computes rows y0 <= y < y1 of a footprint's samples. */
static int sample_rows(void *context, RetexRowReader *reader, const RetexImageTransfer *edited, int y0, int y1,
                       float *to, RetexError *err)
{
    const SampleWork *work = context;
    const RetexFootprint *f = &work->set->footprints[edited->footprint];
    const RetexTexture *texture = work->textures[f->target];
    const RetexTextureFilter filter = retex_footprint_filter(work->set, f);
    int code = RETEX_OK;
    for (int y = y0; y < y1 && !code; y++, to += 3 * (size_t)edited->image->width) {
        RetexFootprintRow from;
        code = retex_footprint_row_read(&from, reader, work->set, f, y, !retex_texture_is_opaque(texture), err);
        if (!code && from.uv)
            retex_sample_row(texture, filter, &from, to);
    }
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

static int alloc_image(const SampleWork *work, int footprint, RetexError *err)
{
    const RetexImage *uv = &work->set->parts[work->set->footprints[footprint].uv].image;
    return retex_image_alloc(&work->samples->images[footprint], uv->width, uv->height, 3, err);
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
        retex_band_store_set_plain(samples->store);
    for (int i = 0; i < work->nedited && !code; i++) {
        const int footprint = work->edited[i].footprint;
        char name[RETEX_NAME_MAX];
        if (retex_set_footprint_scale(set, footprint) != 1) {
            code = alloc_image(work, footprint, err);
            continue;
        }
        snprintf(name, sizeof name, "sample_%d", footprint);
        code = retex_band_store_add(samples->store, name, "RGB", RETEX_FLOAT, &work->edited[i].store_image, err);
        samples->footprints[footprint].store_image = code ? 0 : 1 + work->edited[i].store_image;
        samples->images[footprint] = (RetexImage){.width = set->width, .height = set->height, .channels = 3};
    }
    return code;
}

static int is_loaded(const RetexSet *set, const RetexFootprint *f)
{
    return set->parts[f->uv].image.pixels && set->parts[f->spread].image.pixels && set->parts[f->albedo].image.pixels;
}

static int list_edited(SampleWork *work, RetexError *err)
{
    work->edited = calloc((size_t)work->set->nfootprints + 1, sizeof *work->edited);
    if (!work->edited)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    for (int i = 0; i < work->set->nfootprints; i++)
        if (work->textures[work->set->footprints[i].target])
            work->edited[work->nedited++] =
                (RetexImageTransfer){.part = -1, .footprint = i, .image = &work->samples->images[i]};
    return RETEX_OK;
}

static int check_loaded(const SampleWork *work, RetexError *err)
{
    for (int i = 0; i < work->nedited; i++)
        if (!is_loaded(work->set, &work->set->footprints[work->edited[i].footprint]))
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
    return code ? code : list_edited(work, err);
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

static void move_image(RetexSamples *samples, RetexSamples *more, int footprint)
{
    retex_image_free(&samples->images[footprint]);
    samples->images[footprint] = more->images[footprint];
    samples->footprints[footprint].store_image = more->footprints[footprint].store_image;
    samples->footprints[footprint].source_image = more->footprints[footprint].source_image;
    more->images[footprint] = (RetexImage){0};
    more->footprints[footprint].store_image = more->footprints[footprint].source_image = 0;
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
    int same = samples->width == more->width && samples->height == more->height && samples->nimages == more->nimages &&
               samples->ntargets == more->ntargets;
    for (int t = 0; same && t < samples->ntargets; t++)
        same = strcmp(samples->target_names[t], more->target_names[t]) == 0;
    for (int i = 0; same && i < samples->nimages; i++)
        same = samples->footprints[i].target == more->footprints[i].target;
    if (!same)
        return retex_fail(err, RETEX_EINVAL, "the samples are of different sets");
    if ((samples->store && more->store) || (samples->source && more->source)) { /* samples have one of each only */
        int code = retex_samples_load(more, nthreads, err);
        if (code)
            return code;
    }
    for (int i = 0; i < more->nimages; i++)
        if (retex_samples_have(more, i))
            move_image(samples, more, i);
    move_stores(samples, more);
    for (int t = 0; t < more->ntargets; t++)
        if (more->textures[t][0])
            memcpy(samples->textures[t], more->textures[t], sizeof samples->textures[t]);
    return RETEX_OK;
}
