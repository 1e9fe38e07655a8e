/* Sampling: the new textures, filtered at every footprint of their targets.
 *
 * A footprint is a Gaussian with the stored mean and standard deviations of the surface UV; the texture's own transform
 * then turns and stretches it exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/sample.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "sample_row.h"

#define ROWS_A_JOB 8

typedef struct SampleWork {
    const RetexSet *set;
    const RetexTextureSpec *specs;
    int nspecs;
    RetexSamples *samples, *variances;                                      /* variances: NULL = not wanted */
    RetexTexture *textures[RETEX_MAX_TARGETS], *squares[RETEX_MAX_TARGETS]; /* by target */
    int *edited;                                                            /* footprints of edited targets */
    int nedited, blocks;
} SampleWork;

static FootprintRow footprint_row(const RetexSet *set, const RetexFootprint *f, int y)
{
    const RetexImage *uv = &set->parts[f->uv].image, *spread = &set->parts[f->spread].image;
    return (FootprintRow){uv->pixels + retex_image_index(uv, 0, y), spread->pixels + retex_image_index(spread, 0, y),
                          set->parts[f->albedo].image.pixels + retex_image_index(uv, 0, y), spread->channels,
                          uv->width};
}

static void sample_job(void *context, int index, int thread)
{
    SampleWork *work = context;
    const RetexSet *set = work->set;
    (void)thread;
    int footprint = work->edited[index / work->blocks], block = index % work->blocks;
    const RetexFootprint *f = &set->footprints[footprint];
    RetexTextureFilter filter = footprint_filter(set, f);
    const RetexImage *image = &work->samples->images[footprint];
    int last = (block + 1) * ROWS_A_JOB < image->height ? (block + 1) * ROWS_A_JOB : image->height;
    for (int y = block * ROWS_A_JOB; y < last; y++) {
        FootprintRow from = footprint_row(set, f, y);
        size_t row = retex_image_index(image, 0, y);
        if (retex_texture_is_opaque(work->textures[f->target]))
            from.albedo = NULL;
        sample_row(work->textures[f->target], filter, &from, image->pixels + row);
        if (work->variances)
            variance_row(work->textures[f->target], work->squares[f->target], filter, &from,
                         work->variances->images[footprint].pixels + row);
    }
}

static void describe_texture(char *text, size_t size, const RetexTextureSpec *spec)
{
    if (spec->constant)
        snprintf(text, size, "rgb(%g,%g,%g)", (double)spec->color[0], (double)spec->color[1], (double)spec->color[2]);
    else
        snprintf(text, size, "%.*s", (int)size - 1, spec->image);
}

static int create_samples(const SampleWork *work, RetexSamples **out, RetexError *err)
{
    const RetexSet *set = work->set;
    RetexSamples *samples = *out = calloc(1, sizeof *samples);
    if (samples)
        samples->images = calloc((size_t)set->nfootprints + 1, sizeof *samples->images);
    if (!samples || !samples->images)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    samples->width = set->width;
    samples->height = set->height;
    samples->nimages = set->nfootprints;
    samples->ntargets = set->ntargets;
    samples->set_id = set->id;
    for (int i = 0; i < set->ntargets; i++)
        memcpy(samples->target_names[i], set->targets[i].name, sizeof samples->target_names[i]);
    for (int i = 0; i < work->nspecs; i++)
        describe_texture(samples->textures[retex_set_find_target(set, work->specs[i].target)],
                         sizeof samples->textures[0], &work->specs[i]);
    for (int i = 0; i < set->nfootprints; i++) {
        samples->footprint_target[i] = set->footprints[i].target;
        samples->footprint_hit[i] = set->footprints[i].hit;
    }
    for (int i = 0; i < work->nedited; i++) {
        const RetexImage *uv = &set->parts[set->footprints[work->edited[i]].uv].image;
        int code = retex_image_alloc(&samples->images[work->edited[i]], uv->width, uv->height, 3, err);
        if (code)
            return code;
    }
    return RETEX_OK;
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
    for (int i = 0; i < work->set->nfootprints; i++) {
        if (!work->textures[work->set->footprints[i].target])
            continue;
        if (!is_loaded(work->set, &work->set->footprints[i]))
            return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
        work->edited[work->nedited++] = i;
    }
    return RETEX_OK;
}

int retex_sample_with_variances(RetexSamples **samples, RetexSamples **variances, const RetexSet *set,
                                const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .specs = specs, .nspecs = nspecs};
    int code = retex_textures_load(work.textures, set, specs, nspecs, nthreads, err);
    for (int i = 0; i < set->ntargets && !code && variances; i++)
        if (work.textures[i])
            code = retex_texture_square(&work.squares[i], work.textures[i], err);
    if (!code)
        code = list_edited(&work, err);
    if (!code)
        code = create_samples(&work, &work.samples, err);
    if (!code && variances)
        code = create_samples(&work, &work.variances, err);
    if (!code) {
        work.blocks = (set->height + ROWS_A_JOB - 1) / ROWS_A_JOB;
        retex_parallel(nthreads, work.blocks * work.nedited, sample_job, &work);
    } else {
        retex_samples_close(&work.samples);
        retex_samples_close(&work.variances);
    }
    *samples = work.samples;
    if (variances)
        *variances = work.variances;
    retex_textures_close(work.textures);
    retex_textures_close(work.squares);
    free(work.edited);
    return code;
}

int retex_sample(RetexSamples **samples, const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads,
                 RetexError *err)
{
    return retex_sample_with_variances(samples, NULL, set, specs, nspecs, nthreads, err);
}

/* ---- more of them ---- */

int retex_samples_merge(RetexSamples *samples, RetexSamples *more, RetexError *err)
{
    int same = samples->width == more->width && samples->height == more->height && samples->nimages == more->nimages &&
               samples->ntargets == more->ntargets;
    for (int t = 0; same && t < samples->ntargets; t++)
        same = strcmp(samples->target_names[t], more->target_names[t]) == 0;
    for (int i = 0; same && i < samples->nimages; i++)
        same = samples->footprint_target[i] == more->footprint_target[i];
    if (!same)
        return retex_fail(err, RETEX_EINVAL, "the samples are of different sets");
    for (int i = 0; i < more->nimages; i++) {
        if (!more->images[i].pixels)
            continue;
        retex_image_free(&samples->images[i]);
        samples->images[i] = more->images[i];
        more->images[i] = (RetexImage){0};
    }
    for (int t = 0; t < more->ntargets; t++)
        if (more->textures[t][0])
            memcpy(samples->textures[t], more->textures[t], sizeof samples->textures[t]);
    return RETEX_OK;
}
