/* Sampling: the new textures, filtered at every footprint of their targets.
 *
 * A footprint is a Gaussian with the stored mean and standard deviations of the surface UV; the texture's own transform
 * then turns and stretches it exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/sample.h>

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "sample_row.h"

#define ROWS_A_JOB 64 /* a pack's band, some of a spool's */

typedef struct SampleWork {
    const RetexSet *set;
    const RetexTextureSpec *specs;
    int nspecs;
    RetexSamples *samples, *variances;                                      /* variances: NULL = not wanted */
    RetexTexture *textures[RETEX_MAX_TARGETS], *squares[RETEX_MAX_TARGETS]; /* by target */
    int *edited;                                                            /* footprints of edited targets */
    int nedited, blocks;
    atomic_int code;
    RetexError *errors; /* by thread */
} SampleWork;

/* Rows y0 <= y < y1 of a footprint; out and variances, or NULL, have them from y0 on. */
static int sample_rows(const SampleWork *work, RowReader *reader, int footprint, int y0, int y1, float *out,
                       float *variances, RetexError *err)
{
    const RetexFootprint *f = &work->set->footprints[footprint];
    const RetexTexture *texture = work->textures[f->target];
    const RetexTextureFilter filter = footprint_filter(work->set, f);
    const size_t length = 3 * (size_t)work->samples->images[footprint].width;
    for (int y = y0; y < y1; y++) {
        const size_t at = length * (size_t)(y - y0);
        FootprintRow from;
        int code = footprint_row_read(&from, reader, work->set, f, y, !retex_texture_is_opaque(texture), err);
        if (code)
            return code;
        if (from.uv)
            sample_row(texture, filter, &from, out + at);
        else
            memset(out + at, 0, length * sizeof *out);
        if (variances && from.uv)
            variance_row(texture, work->squares[f->target], filter, &from, variances + at);
    }
    return RETEX_OK;
}

/* The same into the samples' spool. */
static int spool_rows(const SampleWork *work, RowReader *reader, int footprint, int y0, int y1, RetexError *err)
{
    const RetexSamples *samples = work->samples;
    float *band = malloc(sizeof *band * 3 * (size_t)samples->width * RETEX_SPOOL_LINES);
    int code = band ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    for (int y = y0; y < y1 && !code; y += RETEX_SPOOL_LINES) {
        const int end = y + RETEX_SPOOL_LINES < y1 ? y + RETEX_SPOOL_LINES : y1;
        code = sample_rows(work, reader, footprint, y, end, band, NULL, err);
        if (!code)
            code = retex_spool_put(samples->spool, samples->spooled[footprint] - 1, y / RETEX_SPOOL_LINES, band, err);
    }
    free(band);
    return code;
}

static void sample_job(void *context, int index, int thread)
{
    SampleWork *work = context;
    RetexError *err = &work->errors[thread];
    RowReader *reader;
    const int footprint = work->edited[index / work->blocks], y0 = index % work->blocks * ROWS_A_JOB;
    const RetexImage *image = &work->samples->images[footprint];
    const int y1 = y0 + ROWS_A_JOB < image->height ? y0 + ROWS_A_JOB : image->height;
    const size_t first = retex_image_index(image, 0, y0);
    if (work->code || y0 >= y1)
        return;
    int code = row_reader_open(&reader, work->set, NULL, err);
    if (!code && work->samples->spooled[footprint])
        code = spool_rows(work, reader, footprint, y0, y1, err);
    else if (!code)
        code = sample_rows(work, reader, footprint, y0, y1, image->pixels + first,
                           work->variances ? work->variances->images[footprint].pixels + first : NULL, err);
    row_reader_close(&reader);
    if (code)
        atomic_store(&work->code, code);
}

static int sample_all(SampleWork *work, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    if (!(work->errors = calloc((size_t)threads, sizeof *work->errors)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    work->blocks = (work->set->height + ROWS_A_JOB - 1) / ROWS_A_JOB;
    retex_parallel(threads, work->blocks * work->nedited, sample_job, work);
    for (int i = 0; i < threads && work->code && err; i++)
        if (work->errors[i].code)
            *err = work->errors[i];
    free(work->errors);
    return work->code;
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
    return RETEX_OK;
}

static int alloc_image(const SampleWork *work, RetexSamples *samples, int footprint, RetexError *err)
{
    const RetexImage *uv = &work->set->parts[work->set->footprints[footprint].uv].image;
    return retex_image_alloc(&samples->images[footprint], uv->width, uv->height, 3, err);
}

static int alloc_images(const SampleWork *work, RetexSamples *samples, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < work->nedited && !code; i++)
        code = alloc_image(work, samples, work->edited[i], err);
    return code;
}

/* A spool with what is as large as the picture; what is smaller is kept in memory. */
static int spool_images(const SampleWork *work, const char *near, RetexError *err)
{
    const RetexSet *set = work->set;
    RetexSamples *samples = work->samples;
    int code = retex_spool_create(&samples->spool, set->width, set->height, set->id, near, err);
    if (!code && strcmp(near, "-") == 0)
        retex_spool_set_plain(samples->spool);
    for (int i = 0; i < work->nedited && !code; i++) {
        const int footprint = work->edited[i];
        char name[RETEX_NAME_MAX];
        int number;
        if (retex_set_footprint_scale(set, footprint) != 1) {
            code = alloc_image(work, samples, footprint, err);
            continue;
        }
        snprintf(name, sizeof name, "sample_%d", footprint);
        code = retex_spool_add(samples->spool, name, "RGB", RETEX_FLOAT, &number, err);
        samples->spooled[footprint] = code ? 0 : 1 + number;
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
            work->edited[work->nedited++] = i;
    return RETEX_OK;
}

static int check_loaded(const SampleWork *work, RetexError *err)
{
    for (int i = 0; i < work->nedited; i++)
        if (!is_loaded(work->set, &work->set->footprints[work->edited[i]]))
            return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
    return RETEX_OK;
}

static int open_work(SampleWork *work, int nthreads, RetexError *err)
{
    int code = retex_textures_load(work->textures, work->set, work->specs, work->nspecs, nthreads, err);
    if (!code)
        code = list_edited(work, err);
    return code ? code : create_samples(work, &work->samples, err);
}

static void close_work(SampleWork *work)
{
    retex_textures_close(work->textures);
    retex_textures_close(work->squares);
    free(work->edited);
}

int retex_sample_with_variances(RetexSamples **samples, RetexSamples **variances, const RetexSet *set,
                                const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .specs = specs, .nspecs = nspecs};
    int code = open_work(&work, nthreads, err);
    for (int i = 0; i < set->ntargets && !code && variances; i++)
        if (work.textures[i])
            code = retex_texture_square(&work.squares[i], work.textures[i], err);
    if (!code)
        code = check_loaded(&work, err);
    if (!code)
        code = alloc_images(&work, work.samples, err);
    if (!code && variances)
        code = create_samples(&work, &work.variances, err);
    if (!code && variances)
        code = alloc_images(&work, work.variances, err);
    if (!code)
        code = sample_all(&work, nthreads, err);
    if (code) {
        retex_samples_close(&work.samples);
        retex_samples_close(&work.variances);
    }
    *samples = work.samples;
    if (variances)
        *variances = work.variances;
    close_work(&work);
    return code;
}

int retex_sample(RetexSamples **samples, const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads,
                 RetexError *err)
{
    return retex_sample_with_variances(samples, NULL, set, specs, nspecs, nthreads, err);
}

int retex_sample_spooled(RetexSamples **samples, const RetexSet *set, const RetexTextureSpec *specs, int nspecs,
                         const char *near, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .specs = specs, .nspecs = nspecs};
    int code = open_work(&work, nthreads, err);
    if (!code)
        code = spool_images(&work, near, err);
    if (!code)
        code = sample_all(&work, nthreads, err);
    if (code)
        retex_samples_close(&work.samples);
    *samples = work.samples;
    close_work(&work);
    return code;
}

/* ---- more of them ---- */

static void move_image(RetexSamples *samples, RetexSamples *more, int footprint)
{
    retex_image_free(&samples->images[footprint]);
    samples->images[footprint] = more->images[footprint];
    samples->spooled[footprint] = more->spooled[footprint];
    samples->stored[footprint] = more->stored[footprint];
    more->images[footprint] = (RetexImage){0};
    more->spooled[footprint] = more->stored[footprint] = 0;
}

/* Where the images are that have been moved. */
static void move_stores(RetexSamples *samples, RetexSamples *more)
{
    if (more->spool) {
        samples->spool = more->spool;
        more->spool = NULL;
    }
    if (more->source) {
        samples->source = more->source;
        more->source = NULL;
    }
}

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
    if ((samples->spool && more->spool) || (samples->source && more->source)) { /* one of each is kept */
        int code = retex_samples_load(more, 0, err);
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
