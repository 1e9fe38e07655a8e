/* Samples in memory: see <retex/samples.h>. What is filtered into them is in retexture/sample.c. */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <jansson.h>
#include <retex/host/assert.h>
#include <retex/host/set_build.h>

#include "base/params.h"
#include "set/samples.h"
#include "set/source.h"

int retex_samples_alloc(RetexSamples **result, int nimages, RetexError *err)
{
    RetexSamples *samples = *result = calloc(1, sizeof *samples);

    if (samples) {
        samples->images = calloc((size_t)nimages + 1, sizeof *samples->images);
        samples->footprints = calloc((size_t)nimages + 1, sizeof *samples->footprints);
    }
    if (!samples || !samples->images || !samples->footprints) {
        retex_samples_close(result);
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    }
    samples->nfootprints = samples->nimages = nimages;
    for (int i = 0; i < nimages; i++)
        samples->footprints[i].footprint = i, samples->footprints[i].finish = -1;
    return RETEX_OK;
}

int retex_samples_add(RetexSamples *samples, RetexSampleFootprint of, RetexError *err)
{
    RETEX_ASSERT(samples->nimages >= samples->nfootprints); /* those of footprints come first, by their numbers */
    RETEX_ASSERT(of.footprint >= -1 && of.footprint < samples->nfootprints);
    RETEX_ASSERT(of.footprint >= 0 || of.finish < 0); /* a gate is one image of all finishes */
    const size_t count = (size_t)samples->nimages + 2;
    RetexImage *images = realloc(samples->images, count * sizeof *images);
    samples->images = images ? images : samples->images;
    RetexSampleFootprint *footprints = realloc(samples->footprints, count * sizeof *footprints);
    samples->footprints = footprints ? footprints : samples->footprints;
    if (!images || !footprints)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    images[samples->nimages] = (RetexImage){0};
    footprints[samples->nimages++] = of;
    return RETEX_OK;
}

int retex_samples_find(const RetexSamples *samples, int target, int footprint, int finish)
{
    for (int i = samples->nfootprints; i < samples->nimages; i++) {
        const RetexSampleFootprint *of = &samples->footprints[i];
        if (of->target == target && of->footprint == footprint && of->finish == finish &&
            retex_samples_have(samples, i))
            return i;
    }
    return -1;
}

int retex_samples_create(RetexSamples **result, const RetexSet *set, RetexError *err)
{
    const int code = retex_samples_alloc(result, set->nfootprints, err);
    RetexSamples *samples = *result;

    if (code)
        return code;
    samples->width = set->width;
    samples->height = set->height;
    samples->ntargets = set->ntargets;
    samples->set_id = set->id;
    for (int t = 0; t < set->ntargets; t++)
        memcpy(samples->target_names[t], set->targets[t].name, sizeof samples->target_names[t]);
    for (int i = 0; i < set->nfootprints; i++) {
        samples->footprints[i].target = set->footprints[i].target;
        samples->footprints[i].hit = set->footprints[i].hit;
    }
    return RETEX_OK;
}

void retex_samples_get_info(const RetexSamples *samples, RetexSamplesInfo *info)
{
    const RetexSamplesInfo own = {.width = samples->width,
                                  .height = samples->height,
                                  .nfootprints = samples->nfootprints,
                                  .ntargets = samples->ntargets};
    (void)RETEX_PARAMS_RETURN(info, &own, NULL);
}

RetexImage *retex_samples_mutable_image(RetexSamples *samples, int footprint)
{
    return &samples->images[footprint];
}

const char *retex_samples_target(const RetexSamples *samples, int target)
{
    return samples->target_names[target];
}

const char *retex_samples_texture(const RetexSamples *samples, int target)
{
    return samples->textures[target];
}

void retex_samples_close(RetexSamples **result)
{
    RetexSamples *samples = result ? *result : NULL;

    if (!samples)
        return;
    for (int i = 0; samples->images && i < samples->nimages; i++)
        retex_image_free(&samples->images[i]);
    free(samples->images);
    free(samples->footprints);
    retex_band_store_close(&samples->store);
    if (samples->source)
        samples->source->close(samples->source);
    free(samples);
    *result = NULL;
}

int retex_samples_have(const RetexSamples *samples, int footprint)
{
    return samples->images[footprint].pixels || samples->footprints[footprint].store_image ||
           samples->footprints[footprint].source_image;
}

int retex_samples_are_sound(const RetexSamples *samples, RetexError *err)
{
    if (samples->ntargets < 0 || samples->ntargets > RETEX_MAX_TARGETS || samples->nimages < 0 ||
        samples->nfootprints > RETEX_SET_FOOTPRINTS_MAX || samples->nimages > RETEX_SAMPLE_IMAGES_MAX)
        return retex_fail(err, RETEX_EINVAL, "the samples have %d targets and %d images", samples->ntargets,
                          samples->nimages);
    for (int i = 0; i < samples->nimages; i++) {
        const RetexImage *image = &samples->images[i];
        if (samples->footprints[i].target < 0 || samples->footprints[i].target >= samples->ntargets)
            return retex_fail(err, RETEX_EINVAL, "sample image %d is for target %d of %d", i,
                              samples->footprints[i].target, samples->ntargets);
        if (retex_samples_have(samples, i) &&
            (image->width > samples->width || image->height > samples->height || image->channels != 3))
            return retex_fail(err, RETEX_EINVAL, "sample image %d has the wrong size", i);
    }
    return 0;
}

int retex_samples_check(const RetexSamples *samples, const RetexSet *set, RetexError *err)
{
    if (samples->width != set->width || samples->height != set->height)
        return retex_fail(err, RETEX_EINVAL, "the samples have %d x %d pixels, the set %d x %d", samples->width,
                          samples->height, set->width, set->height);
    if (samples->ntargets != set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the samples know %d targets, the set %d", samples->ntargets,
                          set->ntargets);
    if (samples->set_id && set->id && samples->set_id != set->id)
        return retex_fail(err, RETEX_EINVAL, "the samples were made for another render of these targets");
    for (int i = 0; i < set->ntargets; i++)
        if (strcmp(samples->target_names[i], set->targets[i].name) != 0)
            return retex_fail(err, RETEX_EINVAL, "the samples are for target %s where the set has %s",
                              samples->target_names[i], set->targets[i].name);
    if (samples->nfootprints != set->nfootprints)
        return retex_fail(err, RETEX_EINVAL, "the samples have %d images for the set's %d footprints",
                          samples->nfootprints, set->nfootprints);
    for (int i = samples->nfootprints; i < samples->nimages; i++) {
        const RetexSampleFootprint *of = &samples->footprints[i];
        const RetexImage *image = &samples->images[i],
                         *colors = of->footprint >= 0 ? &samples->images[of->footprint] : NULL;
        const int width = colors ? colors->width : set->width, height = colors ? colors->height : set->height;
        if (of->finish >= set->targets[of->target].nfinishes ||
            (colors && set->footprints[of->footprint].target != of->target) || image->width != width ||
            image->height != height)
            return retex_fail(err, RETEX_EINVAL,
                              "sample image %d belongs to another footprint or finish than the set's", i);
    }
    for (int i = 0; i < samples->nfootprints; i++) {
        const RetexImage *image = &samples->images[i];
        if (samples->footprints[i].target != set->footprints[i].target ||
            samples->footprints[i].hit != set->footprints[i].hit)
            return retex_fail(err, RETEX_EINVAL, "sample image %d belongs to another footprint than the set's", i);
        const RetexImage *uv = set->footprints[i].uv >= 0 ? &set->parts[set->footprints[i].uv].image : NULL;
        const int fits = uv ? image->width == uv->width && image->height == uv->height : retex_set_scale(set, image);
        if (retex_samples_have(samples, i) && (image->channels != 3 || !fits))
            return retex_fail(err, RETEX_EINVAL, "sample image %d has the wrong size", i);
    }
    return 0;
}

/* ---- the file of their set ---- */

static int fail_refer(const char *path, const char *why, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "%s cannot be referred to: %s", path, why);
}

int retex_samples_refer(RetexSamples *samples, const RetexSet *set, const char *path, RetexError *err)
{
    char resolved[PATH_MAX];
    struct stat info;

    if (!path) {
        samples->refers = (RetexSetReference){.bytes = 0};
        return RETEX_OK;
    }
    if (strcmp(path, "-") == 0)
        return fail_refer("standard input", "it is no file", err);
    if (!realpath(path, resolved) || stat(resolved, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode) || !set->file_bytes || !set->file_sum)
        return fail_refer(path, "it is no regular file", err);
    json_t *name = json_string(resolved);
    const int is_utf8 = name != NULL;
    json_decref(name);
    if (!is_utf8 || strlen(resolved) >= sizeof samples->refers.path)
        return fail_refer(path, "its name is not UTF-8, or too long", err);
    memcpy(samples->refers.path, resolved, strlen(resolved) + 1);
    samples->refers.bytes = set->file_bytes;
    samples->refers.crc = set->file_sum;
    return RETEX_OK;
}

const char *retex_samples_set_path(const RetexSamples *samples)
{
    return samples->refers.path;
}
