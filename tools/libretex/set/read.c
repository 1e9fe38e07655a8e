/* Reads sets, and samples, from EXR files. The meaning of parts comes from the manifest, their layout
 * from the EXR headers, and both must agree before any pixel is read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/set_file.h>

#include "set/read.h"

#include "exr/io.h"
#include "set/exr_source.h"
#include "io/input.h"
#include "set/manifest.h"
#include "exr/band_store_chunks.h"

/* Deflate compresses at most 1032:1. A file that promises more than this is damaged, and no memory is allocated for
 * it. */
enum { LARGEST_GAIN = 1100 };

/* An open file and its manifest. */
typedef struct Source {
    RetexInput *input;
    RetexExr *exr;
    RetexSet *set; /* without pixels */
    RetexBandSums sums;
    RetexExrRequest *requests; /* by part of the set */
    int nrequests;
    uint64_t memory_bytes, stored_bytes; /* sizes of the requested parts in memory and in the file */
} Source;

static void source_close(Source *source)
{
    retex_exr_close(&source->exr);
    retex_input_close(&source->input);
    retex_set_close(&source->set);
    retex_band_sums_free(&source->sums);
    free(source->requests);
}

/* Opens a file that begins like an EXR and reads its manifest. */
static int source_describe(Source *source, RetexError *err)
{
    const char *name = retex_input_name(source->input);
    int code;

    if (retex_input_size(source->input) == 0)
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set: it is empty", name);
    unsigned char begin[16];
    const int64_t got = retex_input_read(source->input, begin, sizeof begin, 0);
    if (got > 0 && retex_band_store_probe(begin, (size_t)got))
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set yet, but rows of one: %s", name,
                          "retex-render goes on from them with --resume");
    if (!retex_exr_probe(source->input)) {
        code = retex_fail(err, RETEX_EFORMAT, "%s is not a set: neither an OpenEXR file nor a pack", name);
        return retex_input_check(source->input, code, err);
    }
    code = retex_exr_open(&source->exr, source->input, err);
    if (code)
        return code;
    const char *json = retex_exr_attribute(source->exr, 0, RETEX_MANIFEST_ATTRIBUTE);
    if (!json)
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set (no `%s` attribute)", name, RETEX_MANIFEST_ATTRIBUTE);
    code = retex_manifest_read(json, name, &source->set, &source->sums, err);
    if (code)
        return code;
    source->requests = calloc((size_t)source->set->nparts + 1, sizeof *source->requests);
    return source->requests ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
}

/* Requests a part of the manifest; the file's part of that name must be as the manifest says. */
static int request_part(Source *source, int index, RetexError *err)
{
    RetexPart *own = &source->set->parts[index];
    RetexImage *image = &own->image;
    const char *file = retex_input_name(source->input), *name = own->name, *letters = own->letters;
    const int part = retex_exr_find_part(source->exr, name);
    RetexExrRequest *request = &source->requests[source->nrequests];
    int width, height;

    if (part < 0)
        return retex_fail(err, RETEX_EFORMAT, "%s lacks part %s, which its manifest lists", file, name);
    retex_exr_part_size(source->exr, part, &width, &height);
    if (width != image->width || height != image->height)
        return retex_fail(err, RETEX_EFORMAT, "%s: part %s has %d x %d pixels where the manifest says %d x %d", file,
                          name, width, height, image->width, image->height);
    for (int c = 0; letters[c]; c++) {
        char *channel = request->channels[c];
        RetexPixelType found;
        if (part == 0)
            snprintf(channel, RETEX_EXR_NAME_MAX, "%c", letters[c]);
        else
            snprintf(channel, RETEX_EXR_NAME_MAX, "%.180s.%c", name, letters[c]);
        if (!retex_exr_channel_type(source->exr, part, channel, &found) || found != own->type)
            return retex_fail(err, RETEX_EFORMAT, "%s: part %s has no %s channel %s", file, name,
                              own->type == RETEX_HALF ? "half" : "float", channel);
    }
    request->part = part;
    request->image = image;
    request->with_crc = 1;
    request->expected = own->crc;
    request->bands = source->sums.of[index];
    request->allowed = retex_allowed_values(name);
    source->nrequests++;
    const uint64_t count = (uint64_t)width * (uint64_t)height * strlen(letters);
    source->memory_bytes += count * sizeof(float);
    source->stored_bytes += count * (own->type == RETEX_HALF ? 2 : 4);
    return 0;
}

static int request_set(Source *source, RetexError *err)
{
    int code = 0;

    for (int i = 0; i < source->set->nparts && !code; i++)
        code = request_part(source, i, err);
    return code;
}

static int check_stored(const Source *source, RetexError *err)
{
    if (source->stored_bytes / LARGEST_GAIN > retex_input_size(source->input))
        return retex_fail(err, RETEX_EFORMAT, "%s is damaged or truncated: it is too small for what it should hold",
                          retex_input_name(source->input));
    return 0;
}

static int check_memory(const Source *source, RetexError *err)
{
    if (source->memory_bytes > RETEX_EXR_MEMORY_MAX)
        return retex_fail(err, RETEX_ELIMIT, "%s needs %.1f GiB of memory, more than the limit of %.0f",
                          retex_input_name(source->input), (double)source->memory_bytes / 0x1p30,
                          (double)RETEX_EXR_MEMORY_MAX / 0x1p30);
    return check_stored(source, err);
}

/* Reads all requested parts and compares their checksums. */
static int read_requests(Source *source, int nthreads, RetexError *err)
{
    const int code = retex_exr_read(source->exr, source->requests, source->nrequests, nthreads, err);

    for (int i = 0; i < source->nrequests && !code; i++) {
        const RetexExrRequest *request = &source->requests[i];
        if (request->crc != request->expected)
            return retex_fail(err, RETEX_EFORMAT, "%s: the checksum of part %s is wrong",
                              retex_input_name(source->input), retex_exr_part_name(source->exr, request->part));
    }
    return code;
}

/* Allocates the requested images and reads their pixels. */
static int read_pixels(Source *source, int nthreads, RetexError *err)
{
    int code = check_memory(source, err);

    for (int i = 0; i < source->nrequests && !code; i++) {
        RetexImage *image = source->requests[i].image;
        const RetexImage shape = *image;
        code = retex_image_alloc(image, shape.width, shape.height, shape.channels, err);
    }
    return code ? code : read_requests(source, nthreads, err);
}

/* Makes the open file the source of the set's parts. */
static int keep_open(Source *source, int nthreads, RetexError *err)
{
    RetexSetSource *opened;
    int code = request_set(source, err);

    if (!code)
        code = check_stored(source, err);
    if (code)
        return code;
    const RetexExrSourceParts parts = {source->exr,       source->input, source->requests,
                                       source->nrequests, source->sums,  nthreads};
    source->requests = NULL;
    source->input = NULL;
    source->exr = NULL;
    source->sums = (RetexBandSums){0};
    code = retex_exr_source_open(&opened, &parts, err);
    if (code)
        return code;
    for (int i = 0; i < source->set->nparts; i++)
        retex_part_set_source(&source->set->parts[i], opened, i);
    retex_source_release(&opened);
    return 0;
}

static int read_described(Source *source, RetexSet **set, int open, int nthreads, RetexError *err)
{
    int code = source_describe(source, err);

    if (!code && open)
        code = keep_open(source, nthreads, err);
    else if (!code)
        code = request_set(source, err);
    if (!code && !open)
        code = read_pixels(source, nthreads, err);
    if (code)
        return code;
    *set = source->set;
    source->set = NULL;
    return 0;
}

int retex_set_read_exr(RetexInput **input, RetexSet **set, int open, int nthreads, RetexError *err)
{
    Source source = {.input = *input};
    const int code = read_described(&source, set, open, nthreads, err);

    *input = source.input; /* NULL where the file stays open as the source */
    source.input = NULL;
    source_close(&source);
    return code;
}

static int check_described(Source *source, int nthreads, RetexError *err)
{
    int code = source_describe(source, err);

    if (!code)
        code = request_set(source, err);
    if (!code)
        code = check_memory(source, err);
    if (code)
        return code;
    for (int i = 0; i < source->nrequests; i++)
        source->requests[i].image = NULL; /* only the checksum is wanted */
    return read_requests(source, nthreads, err);
}

int retex_set_check_exr(RetexInput *input, int nthreads, RetexError *err)
{
    Source source = {.input = input};
    const int code = check_described(&source, nthreads, err);

    source.input = NULL;
    source_close(&source);
    return code;
}
