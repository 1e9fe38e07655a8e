/* From the spool or the source of a set, or of samples, into memory. */
#include <stdlib.h>
#include <string.h>

#include "gather.h"
#include "manifest.h"
#include "set_source.h"

/* Give the images of a list their pixels; on failure none. */
static int fill(const Gathered *images, int count, const RetexSet *set, const RetexSamples *samples, int nthreads,
                RetexError *err)
{
    int code = RETEX_OK;

    for (int i = 0; !code && i < count; i++) {
        const RetexImage shape = *images[i].image;
        code = retex_image_alloc(images[i].image, shape.width, shape.height, shape.channels, err);
    }
    if (!code)
        code = gather(images, count, set, samples, NULL, nthreads, err);
    for (int i = 0; code && i < count; i++)
        retex_image_free(images[i].image);
    return code;
}

static int load(RetexSet *set, const char *wanted, int nthreads, RetexError *err)
{
    RetexImage *loaded = calloc((size_t)set->nparts + 1, sizeof *loaded);
    Gathered *images = calloc((size_t)set->nparts + 1, sizeof *images);
    int count = 0, code = loaded && images ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to load a set");

    for (int i = 0; !code && i < set->nparts; i++)
        if (wanted[i] && !set->parts[i].image.pixels) {
            loaded[i] = set->parts[i].image;
            images[count++] = (Gathered){.part = i, .footprint = -1, .image = &loaded[i]};
        }
    if (!code)
        code = fill(images, count, set, NULL, nthreads, err);
    for (int i = 0; !code && i < count; i++) {
        RetexPart *part = &set->parts[images[i].part];
        part->image = *images[i].image;
        part->spooled = 0;
    }
    free(loaded);
    free(images);
    return code;
}

int retex_set_load(RetexSet *set, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX];

    /* the picture last: a pack may make it from the other parts, which then need not be decoded twice */
    memset(wanted, 1, sizeof wanted);
    wanted[0] = 0;
    int code = load(set, wanted, nthreads, err);
    wanted[0] = 1;
    if (!code)
        code = load(set, wanted, nthreads, err);
    if (code)
        return code;
    retex_spool_close(&set->spool);
    if (set->source)
        set->source->close(set->source);
    set->source = NULL;
    return 0;
}

int retex_samples_load(RetexSamples *samples, int nthreads, RetexError *err)
{
    RetexImage *loaded = calloc((size_t)samples->nimages + 1, sizeof *loaded);
    Gathered *images = calloc((size_t)samples->nimages + 1, sizeof *images);
    int count = 0, code = loaded && images ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to load samples");

    for (int i = 0; !code && i < samples->nimages; i++)
        if (retex_samples_have(samples, i) && !samples->images[i].pixels) {
            loaded[i] = samples->images[i];
            images[count++] = (Gathered){.part = -1, .footprint = i, .image = &loaded[i]};
        }
    if (!code)
        code = fill(images, count, NULL, samples, nthreads, err);
    for (int i = 0; !code && i < count; i++)
        samples->images[images[i].footprint] = *images[i].image;
    free(loaded);
    free(images);
    if (code)
        return code;
    memset(samples->spooled, 0, sizeof samples->spooled);
    memset(samples->stored, 0, sizeof samples->stored);
    retex_spool_close(&samples->spool);
    if (samples->source)
        samples->source->close(samples->source);
    samples->source = NULL;
    return 0;
}

static uint64_t part_bytes(const RetexSet *set, int part)
{
    return sizeof(float) * retex_image_index(&set->parts[part].image, 0, set->parts[part].image.height);
}

uint64_t retex_set_bytes(const RetexSet *set)
{
    uint64_t bytes = 0;

    for (int i = 0; i < set->nparts; i++)
        bytes += part_bytes(set, i);
    return bytes;
}

static void want(char *wanted, int part)
{
    if (part >= 0)
        wanted[part] = 1;
}

int retex_set_keep(RetexSet *set, uint64_t most_bytes, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX] = {0};
    uint64_t bytes = 0;

    for (int i = 0; i < set->nterms; i++) {
        want(wanted, set->terms[i].radiance);
        want(wanted, set->terms[i].gain ? set->terms[i].gain : -1);
    }
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            want(wanted, set->mixtures[i].shares[k].weight);
    for (int i = 0; i < set->nfootprints; i++) {
        want(wanted, set->footprints[i].uv);
        want(wanted, set->footprints[i].spread);
        want(wanted, set->footprints[i].albedo);
    }
    for (int i = 0; i < set->nparts; i++)
        if (wanted[i])
            bytes += part_bytes(set, i);
    return bytes > most_bytes ? 0 : load(set, wanted, nthreads, err);
}
