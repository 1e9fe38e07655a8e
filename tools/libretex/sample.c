/* Sampling: the new textures, filtered at every footprint of their targets.
 *
 * A footprint is a Gaussian with the stored mean and standard deviations of the surface UV; the texture's own transform
 * then turns and stretches it exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/sample.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#define ROWS_A_JOB 8
#define MAX_FOOTPRINTS ((int)(sizeof((RetexSamples *)0)->footprint_target / sizeof(int)))

typedef struct SampleWork {
    const RetexSet *set;
    RetexSamples *samples, *variances;         /* variances: NULL = not wanted */
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target; NULL = keeps its original */
    RetexTexture *squares[RETEX_MAX_TARGETS];  /* of their colours, for variances */
    const RetexTextureSpec *specs;             /* while loading */
    int spec_target[RETEX_MAX_TARGETS];
    int nspecs, loading_threads, with_variances;
    RetexError errors[RETEX_MAX_TARGETS];
    int *edited; /* footprints of edited targets */
    int nedited, blocks;
} SampleWork;

/* ---- checks ---- */

static int unknown_target(const RetexSet *set, const char *name, RetexError *err)
{
    char names[sizeof err->message] = "";
    size_t used = 0;
    for (int i = 0; i < set->ntargets && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", set->targets[i].name);
    if (!set->ntargets)
        return retex_fail(err, RETEX_ENOTFOUND, "no target is called '%s': the set has no targets", name);
    return retex_fail(err, RETEX_ENOTFOUND, "no target is called '%s'; the set has %.800s", name, names);
}

static int find_targets(SampleWork *work, RetexError *err)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    if (work->nspecs > RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EINVAL, "%d textures are more than a set has targets", work->nspecs);
    for (int i = 0; i < work->nspecs; i++) {
        int target = retex_set_find_target(work->set, work->specs[i].target);
        if (target < 0)
            return unknown_target(work->set, work->specs[i].target, err);
        if (taken[target]++)
            return retex_fail(err, RETEX_EINVAL, "target %s is given two textures", work->set->targets[target].name);
        work->spec_target[i] = target;
    }
    return RETEX_OK;
}

static int check_part(const RetexSet *set, int part, int channels)
{
    if (part < 0 || part >= set->nparts)
        return 0;
    const RetexImage *im = &set->parts[part].image;
    return im->pixels && im->width == set->width && im->height == set->height &&
           (im->channels == channels || (channels == 2 && im->channels == 3));
}

/* Footprints of edited targets need all their parts; of the others nothing is looked at. */
static int check_footprints(const SampleWork *work, RetexError *err)
{
    const RetexSet *set = work->set;
    if (set->nfootprints > MAX_FOOTPRINTS)
        return retex_fail(err, RETEX_ELIMIT, "the set has %d footprints, more than %d", set->nfootprints,
                          MAX_FOOTPRINTS);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        if (f->target < 0 || f->target >= set->ntargets)
            return retex_fail(err, RETEX_EFORMAT, "footprint %d of the set has no target", i);
        int edited = 0;
        for (int k = 0; k < work->nspecs; k++)
            edited |= work->spec_target[k] == f->target;
        if (edited && (!check_part(set, f->uv, 3) || !check_part(set, f->spread, 2) || !check_part(set, f->albedo, 3)))
            return retex_fail(err, RETEX_EFORMAT,
                              "nothing can be put on target %s: the set does not hold its footprints; "
                              "one that was sampled and sent through a pipe has left them behind",
                              set->targets[f->target].name);
    }
    return RETEX_OK;
}

/* ---- loading ---- */

static void load_job(void *context, int index, int thread)
{
    SampleWork *work = context;
    (void)thread;
    int target = work->spec_target[index];
    RetexTextureSpec spec = work->specs[index];
    const RetexTarget *t = &work->set->targets[target];
    memcpy(spec.uv_scale, t->uv_scale, sizeof spec.uv_scale);
    for (int axis = 0; axis < 2; axis++)
        if (!t->periodic[axis]) {
            spec.uv_min[axis] = t->uv_min[axis];
            spec.uv_max[axis] = t->uv_max[axis];
        }
    int code = retex_texture_load(&work->textures[target], &spec, work->loading_threads, &work->errors[index]);
    if (!code && work->with_variances)
        retex_texture_square(&work->squares[target], work->textures[target], &work->errors[index]);
}

/* Side by side: most of the time goes to decoding, which has one thread a file. */
static int load_textures(SampleWork *work, int nthreads, RetexError *err)
{
    int threads = retex_threads(nthreads);
    work->loading_threads = work->nspecs && threads > work->nspecs ? threads / work->nspecs : 1;
    retex_parallel(threads, work->nspecs, load_job, work);
    for (int i = 0; i < work->nspecs; i++)
        if (work->errors[i].code) {
            if (err)
                *err = work->errors[i];
            return work->errors[i].code;
        }
    return RETEX_OK;
}

/* ---- the work itself ---- */

/* Pixels that are filtered in one call. */
#define SPAN_PIXELS 1024

/* One span of a footprint's pixels. */
typedef struct Span {
    const float *uv, *spread, *albedo;
    int spreads, width; /* channels of spread; pixels */
} Span;

static Span footprint_row(const RetexSet *set, const RetexFootprint *f, int y)
{
    size_t row = (size_t)y * (size_t)set->width;
    const RetexImage *spread = &set->parts[f->spread].image;
    return (Span){set->parts[f->uv].image.pixels + 3 * row, spread->pixels + (size_t)spread->channels * row,
                  set->parts[f->albedo].image.pixels + 3 * row, spread->channels, set->width};
}

/* Part of a span's footprints, filtered. */
static void filter_span(const RetexTexture *texture, RetexTextureFilter shape, const Span *span, int from, int count,
                        float *restrict rgba)
{
    retex_texture_filter(texture, shape, span->uv + 3 * (size_t)from,
                         span->spread + (size_t)span->spreads * (size_t)from, span->spreads, (size_t)count, rgba);
}

static void sample_row(const RetexTexture *texture, RetexTextureFilter shape, const Span *span, float *restrict out)
{
    float rgba[4 * SPAN_PIXELS];
    for (int from = 0; from < span->width; from += SPAN_PIXELS) {
        int count = span->width - from < SPAN_PIXELS ? span->width - from : SPAN_PIXELS;
        filter_span(texture, shape, span, from, count, rgba);
        for (int x = 0; x < count; x++, out += 3) {
            size_t at = 3 * (size_t)(from + x);
            const float *color = rgba + 4 * x, *albedo = span->albedo + at;
            int covered = span->uv[at + 2] > 0;
            for (int c = 0; c < 3; c++)
                out[c] = covered ? color[c] * color[3] + (1 - color[3]) * albedo[c] : 0;
        }
    }
}

/* How far the texture's colours scatter within the footprint: E[a^2] - E[a]^2. */
static void variance_row(const RetexTexture *texture, const RetexTexture *square, RetexTextureFilter shape,
                         const Span *span, float *restrict out)
{
    float means[4 * SPAN_PIXELS], squares[4 * SPAN_PIXELS];
    for (int from = 0; from < span->width; from += SPAN_PIXELS) {
        int count = span->width - from < SPAN_PIXELS ? span->width - from : SPAN_PIXELS;
        filter_span(texture, shape, span, from, count, means);
        filter_span(square, shape, span, from, count, squares);
        for (int x = 0; x < count; x++, out += 3) { /* without coverage all is 0 */
            const float *mean = means + 4 * x;
            for (int c = 0; c < 3; c++)
                out[c] = fmaxf(squares[4 * x + c] - mean[c] * mean[c], 0) * mean[3] * mean[3];
        }
    }
}

static void sample_job(void *context, int index, int thread)
{
    SampleWork *work = context;
    const RetexSet *set = work->set;
    (void)thread;
    int footprint = work->edited[index / work->blocks], block = index % work->blocks;
    const RetexFootprint *f = &set->footprints[footprint];
    /* How a footprint's distribution of UV is taken: what is seen sharply through a box pixel filter fills its ellipse
     * evenly, all else is taken as a Gaussian. */
    int even = f->kind == RETEX_FOOTPRINT_SHARP && strcmp(set->filter, "box") == 0;
    RetexTextureFilter shape = even ? RETEX_TEXTURE_DISC : RETEX_TEXTURE_GAUSSIAN;
    int last = (block + 1) * ROWS_A_JOB < set->height ? (block + 1) * ROWS_A_JOB : set->height;
    for (int y = block * ROWS_A_JOB; y < last; y++) {
        Span span = footprint_row(set, f, y);
        size_t row = 3 * (size_t)y * (size_t)set->width;
        sample_row(work->textures[f->target], shape, &span, work->samples->images[footprint].pixels + row);
        if (work->variances)
            variance_row(work->textures[f->target], work->squares[f->target], shape, &span,
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
        describe_texture(samples->textures[work->spec_target[i]], sizeof samples->textures[0], &work->specs[i]);
    for (int i = 0; i < set->nfootprints; i++) {
        samples->footprint_target[i] = set->footprints[i].target;
        samples->footprint_hit[i] = set->footprints[i].hit;
    }
    for (int i = 0; i < work->nedited; i++) {
        int code = retex_image_alloc(&samples->images[work->edited[i]], set->width, set->height, 3, err);
        if (code)
            return code;
    }
    return RETEX_OK;
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

int retex_sample_with_variances(RetexSamples **samples, RetexSamples **variances, const RetexSet *set,
                                const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .specs = specs, .nspecs = nspecs, .with_variances = variances != NULL};
    int code = find_targets(&work, err);
    if (!code)
        code = check_footprints(&work, err);
    if (!code)
        code = load_textures(&work, nthreads, err);
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
    for (int i = 0; i < RETEX_MAX_TARGETS; i++) {
        retex_texture_close(&work.textures[i]);
        retex_texture_close(&work.squares[i]);
    }
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
