/* Sets, samples and streams of both: to and from files.
 *
 * Writing encodes first, because the manifest holds the checksums and stands in the file's header. Reading believes the
 * manifest about meaning and the EXR headers about layout, and insists that the two agree before any pixel is read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/pack.h>

#include "exr_io.h"
#include "exr_source.h"
#include "input.h"
#include "manifest.h"
#include "output.h"
#include "pack_bands.h"
#include "set_parts.h"
#include "spool_chunks.h"

static const char MANIFEST_ATTRIBUTE[] = "retex";

/* Deflate gains at most 1032:1; a file that promises more than this is damaged and gets no memory. */
enum { LARGEST_GAIN = 1100 };

/* --- writing ---------------------------------------------------------------------------------------------------- */

/* Decide which parts are kept. With samples only what recombination needs: the picture, the terms, and whole
 * footprints where no sample takes their place, so that another target can be sampled further down the pipe. */
static void choose_parts(const RetexSet *set, const RetexSamples *samples, char *kept)
{
    memset(kept, !samples, (size_t)set->nparts);
    if (!samples)
        return;
    kept[0] = 1;
    for (int i = 0; i < set->nterms; i++)
        kept[set->terms[i].radiance] = kept[set->terms[i].gain] = 1; /* no gain: the picture, which is kept */
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            kept[set->mixtures[i].shares[k].weight] = 1;
    for (int i = 0; i < set->nfootprints; i++) {
        const int parts[3] = {set->footprints[i].albedo, set->footprints[i].uv, set->footprints[i].spread};
        for (int k = 0; k < 3 && !samples->images[i].pixels; k++)
            if (parts[k] >= 0)
                kept[parts[k]] = 1;
    }
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

/* Everything about a set that others may have filled in by hand. */
static int check_set(const RetexSet *set, RetexError *err)
{
    if (set->nparts < 1 || set->nparts > RETEX_SET_PARTS_MAX || strcmp(set->parts[0].letters, "RGB") != 0 ||
        set->parts[0].image.width != set->width || set->parts[0].image.height != set->height)
        return retex_fail(err, RETEX_EINVAL, "the set's first part is no RGB picture of %d x %d pixels", set->width,
                          set->height);
    for (int i = 0; i < set->nparts; i++)
        if (set->parts[i].spooled ? !set->spool : !set->parts[i].image.pixels)
            return retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
    int sound = set->ntargets >= 0 && set->ntargets <= RETEX_MAX_TARGETS && set->nfootprints >= 0 &&
                set->nfootprints <= RETEX_SET_FOOTPRINTS_MAX && set->nterms >= 0 && set->nterms <= RETEX_SET_TERMS_MAX;
    for (int i = 0; i < set->ntargets && sound; i++)
        sound = part_in_range(set, set->targets[i].original, 1);
    for (int i = 0; i < set->nfootprints && sound; i++)
        sound = part_in_range(set, set->footprints[i].uv, 1) && part_in_range(set, set->footprints[i].spread, 1) &&
                part_in_range(set, set->footprints[i].albedo, 1);
    for (int i = 0; i < set->nterms && sound; i++)
        sound = part_in_range(set, set->terms[i].radiance, 0) && set->terms[i].kind >= RETEX_TERM_FULL &&
                set->terms[i].kind <= RETEX_TERM_CROSS3 && set->terms[i].nfactors >= 0 &&
                set->terms[i].nfactors <= RETEX_MAX_FACTORS;
    sound = sound && set->nmixtures >= 0 && set->nmixtures <= RETEX_MIXTURES_MAX;
    for (int i = 0; i < set->nmixtures && sound; i++)
        sound = mixture_is_sound(set, &set->mixtures[i]);
    return sound ? 0 : retex_fail(err, RETEX_EINVAL, "the set refers to parts it does not have");
}

static void add_exr_part(RetexExrPart *part, const char *name, const char *letters, RetexPixelType type,
                         const RetexImage *image)
{
    snprintf(part->name, sizeof part->name, "%s", name);
    snprintf(part->letters, sizeof part->letters, "%s", letters);
    part->type = type;
    part->image = image;
}

/* Encode the parts, keep the checksums where the manifest finds them, write all. blank: a pixel for a file that would
 * otherwise be empty. */
static int write_parts(RetexSet *set, const RetexSamples *samples, RetexSamplePart *names, const RetexImage *blank,
                       const char *path, const RetexStoreParams *params, RetexError *err)
{
    const int most = (set ? set->nparts : 0) + (samples ? samples->nimages : 0) + 1;
    const int compress = params->compress && strcmp(path, "-") != 0;
    RetexExrPart *parts = calloc((size_t)most, sizeof *parts);
    RetexExrEncoding *encoding = NULL;
    char *json = NULL;
    int count = 0;

    if (!parts)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", path);
    for (int i = 0; set && i < set->nparts; i++) {
        const RetexPart *part = &set->parts[i];
        if (part->spooled)
            parts[count].spool = set->spool, parts[count].spooled = part->spooled - 1;
        add_exr_part(&parts[count++], part->name, part->letters, part->type, &part->image);
    }
    for (int i = 0; samples && i < samples->nimages; i++)
        if (names[i].name[0])
            add_exr_part(&parts[count++], names[i].name, "RGB", RETEX_FLOAT, &samples->images[i]);
    if (count == 0)
        add_exr_part(&parts[count++], "nothing", "RGB", RETEX_HALF, blank);

    int status = retex_exr_encode(&encoding, parts, count, compress, params->nthreads, err);
    if (!status) {
        int next = 0;
        for (int i = 0; set && i < set->nparts; i++)
            set->parts[i].crc = parts[next++].crc;
        for (int i = 0; samples && i < samples->nimages; i++)
            if (names[i].name[0])
                names[i].crc = parts[next++].crc;
        status = retex_manifest_write(set, samples, names, &json, err);
    }
    if (!status)
        status = retex_exr_write(encoding, set ? set->width : samples->width, set ? set->height : samples->height,
                                 MANIFEST_ATTRIBUTE, json, path, err);
    retex_exr_encoding_free(&encoding);
    free(json);
    free(parts);
    return status;
}

static int check_written(const RetexSet *set, const RetexSamples *samples, RetexError *err)
{
    int status = 0;

    if (!set && !samples)
        return retex_fail(err, RETEX_EINVAL, "there is neither a set nor samples to write");
    if (set)
        status = check_set(set, err);
    if (!status && samples)
        status = retex_samples_are_sound(samples, err);
    if (!status && set && samples)
        status = retex_samples_check(samples, set, err);
    return status;
}

int retex_set_write(RetexSet *set, const RetexSamples *samples, const char *path, const RetexStoreParams *params,
                    RetexError *err)
{
    static const RetexStoreParams defaults = RETEX_STORE_INIT;
    RetexSamplePart *names = NULL;
    RetexImage blank = {0};
    SetView view;
    char kept[RETEX_SET_PARTS_MAX];

    int status = check_written(set, samples, err);
    if (status)
        return status;
    if (set) {
        choose_parts(set, samples, kept);
        status = set_view_make(&view, set, kept, err);
        if (status)
            return status;
    }
    if (samples) {
        names = calloc((size_t)samples->nimages + 1, sizeof *names);
        if (!names)
            status = retex_fail(err, RETEX_ENOMEM, "no memory to write %s", path);
        else
            retex_sample_part_names(samples, set, names);
    }
    if (!status)
        status = retex_image_alloc(&blank, 1, 1, 3, err);
    if (!status)
        status = write_parts(set ? &view.set : NULL, samples, names, &blank, path, params ? params : &defaults, err);
    for (int i = 0; set && i < view.set.nparts && !status; i++)
        set->parts[view.source[i]].crc = view.set.parts[i].crc;
    retex_image_free(&blank);
    free(names);
    if (set)
        set_view_free(&view);
    return status;
}

int retex_set_write_check(const char *path, RetexError *err)
{
    return retex_output_check(path, err);
}

/* --- reading ---------------------------------------------------------------------------------------------------- */

/* An open file with its description. */
typedef struct Source {
    RetexInput *input;
    RetexExr *exr;
    RetexSet *set; /* described, without pixels; NULL where the file has none */
    RetexSamples *samples;
    RetexSamplePart *names; /* of samples */
    RetexExrRequest *requests;
    int nrequests;
    uint64_t memory_bytes, stored_bytes; /* of what is requested */
} Source;

static void source_close(Source *source)
{
    retex_exr_close(&source->exr);
    retex_input_close(&source->input);
    retex_set_close(&source->set);
    retex_samples_close(&source->samples);
    free(source->names);
    free(source->requests);
}

/* Open what is known to be an EXR and read its manifest. */
static int source_describe(Source *source, RetexError *err)
{
    const char *name = retex_input_name(source->input);
    int status;

    if (retex_input_size(source->input) == 0)
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set: it is empty", name);
    unsigned char begin[16];
    const int64_t got = retex_input_read(source->input, begin, sizeof begin, 0);
    if (got > 0 && retex_spool_probe(begin, (size_t)got))
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set yet, but rows of one: %s", name,
                          "retex-render goes on from them with --resume or --merge");
    if (!retex_exr_probe(source->input))
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set: neither an OpenEXR file nor a pack", name);
    status = retex_exr_open(&source->exr, source->input, err);
    if (status)
        return status;
    const char *json = retex_exr_attribute(source->exr, 0, MANIFEST_ATTRIBUTE);
    if (!json)
        return retex_fail(err, RETEX_EFORMAT, "%s is not a set (no `%s` attribute)", name, MANIFEST_ATTRIBUTE);
    status = retex_manifest_read(json, name, &source->set, &source->samples, &source->names, err);
    if (status)
        return status;
    const size_t most =
        (size_t)(source->set ? source->set->nparts : 0) + (size_t)(source->samples ? source->samples->nimages : 0);
    source->requests = calloc(most + 1, sizeof *source->requests);
    return source->requests ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
}

/* Ask for a part of the manifest: what the file has under that name must be what the manifest says. */
static int request_part(Source *source, const char *name, const char *letters, RetexPixelType type, RetexImage *image,
                        RetexError *err)
{
    const char *file = retex_input_name(source->input);
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
        if (!retex_exr_channel_type(source->exr, part, channel, &found) || found != type)
            return retex_fail(err, RETEX_EFORMAT, "%s: part %s has no %s channel %s", file, name,
                              type == RETEX_HALF ? "half" : "float", channel);
    }
    request->part = part;
    request->image = image;
    source->nrequests++;
    const uint64_t count = (uint64_t)width * (uint64_t)height * strlen(letters);
    source->memory_bytes += count * sizeof(float);
    source->stored_bytes += count * (type == RETEX_HALF ? 2 : 4);
    return 0;
}

static int request_set(Source *source, RetexError *err)
{
    int status = 0;

    for (int i = 0; i < source->set->nparts && !status; i++) {
        RetexPart *part = &source->set->parts[i];
        status = request_part(source, part->name, part->letters, part->type, &part->image, err);
    }
    return status;
}

static int request_samples(Source *source, RetexError *err)
{
    int status = 0;

    for (int i = 0; i < source->samples->nimages && !status; i++)
        if (source->names[i].name[0])
            status = request_part(source, source->names[i].name, "RGB", RETEX_FLOAT, &source->samples->images[i], err);
    return status;
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

/* Give the requested images their pixels. */
static int read_pixels(Source *source, int nthreads, RetexError *err)
{
    int status = check_memory(source, err);

    for (int i = 0; i < source->nrequests && !status; i++) {
        RetexImage *image = source->requests[i].image;
        const RetexImage shape = *image;
        status = retex_image_alloc(image, shape.width, shape.height, shape.channels, err);
    }
    return status ? status : retex_exr_read(source->exr, source->requests, source->nrequests, nthreads, err);
}

/* The set's parts stay where they are. */
static int keep_open(Source *source, RetexError *err)
{
    memset(source->requests, 0, sizeof *source->requests * (size_t)source->nrequests); /* those of samples */
    source->nrequests = 0;
    source->stored_bytes = 0;
    int status = request_set(source, err);
    if (!status)
        status = check_stored(source, err);
    if (status)
        return status;
    RetexExrRequest *requests = source->requests;
    RetexInput *input = source->input;
    RetexExr *exr = source->exr;
    source->requests = NULL;
    source->input = NULL;
    source->exr = NULL;
    return exr_source_open(&source->set->source, input, exr, requests, source->nrequests, err);
}

static int read_exr(Source *source, RetexSet **set, RetexSamples **samples, int open, int nthreads, RetexError *err)
{
    int status = source_describe(source, err);

    if (status)
        return status;
    if (!(set && source->set) && !(samples && source->samples))
        return retex_fail(err, RETEX_EFORMAT, "%s holds %s, no %s", retex_input_name(source->input),
                          source->set ? "a set" : "samples", source->set ? "samples" : "set");
    if (samples && source->samples)
        status = request_samples(source, err);
    if (!status && !open && set && source->set)
        status = request_set(source, err);
    if (!status)
        status = read_pixels(source, nthreads, err);
    if (!status && open && source->set)
        status = keep_open(source, err);
    if (status)
        return status;
    if (set) {
        *set = source->set;
        source->set = NULL;
    }
    if (samples) {
        *samples = source->samples;
        source->samples = NULL;
    }
    return 0;
}

static int is_pack(const RetexInput *input)
{
    unsigned char begin[64];
    const int64_t got = retex_input_read(input, begin, sizeof begin, 0);

    return got > 0 && retex_pack_probe(begin, (size_t)got);
}

/* Read what is wanted, or with open all but the set's parts. */
static int read_file(const char *path, RetexSet **set, RetexSamples **samples, int open, int nthreads, RetexError *err)
{
    Source source = {0};

    if (set)
        *set = NULL;
    if (samples)
        *samples = NULL;
    if (!set && !samples)
        return retex_fail(err, RETEX_EINVAL, "nothing is wanted from %s", path);
    int status = retex_input_open(&source.input, path, err);
    if (!status && !is_pack(source.input))
        status = read_exr(&source, set, samples, open, nthreads, err);
    else if (!status && !set)
        status = retex_fail(err, RETEX_EFORMAT, "%s holds a set, no samples", retex_input_name(source.input));
    else if (!status)
        status = retex_pack_open(set, &source.input, nthreads, err);
    if (!status && !open && set && *set && (*set)->source)
        status = retex_set_load(*set, nthreads, err);
    if (status && set)
        retex_set_close(set);
    source_close(&source);
    return status;
}

int retex_set_read(const char *path, RetexSet **set, RetexSamples **samples, int nthreads, RetexError *err)
{
    return read_file(path, set, samples, 0, nthreads, err);
}

int retex_set_open(const char *path, RetexSet **set, RetexSamples **samples, int nthreads, RetexError *err)
{
    return read_file(path, set, samples, 1, nthreads, err);
}

static int compare_crcs(const Source *source, RetexError *err)
{
    const char *file = retex_input_name(source->input);
    int next = 0;

    for (int i = 0; source->set && i < source->set->nparts; i++)
        if (source->requests[next++].crc != source->set->parts[i].crc)
            return retex_fail(err, RETEX_EFORMAT, "%s: the checksum of part %s is wrong", file,
                              source->set->parts[i].name);
    for (int i = 0; source->samples && i < source->samples->nimages; i++)
        if (source->names[i].name[0] && source->requests[next++].crc != source->names[i].crc)
            return retex_fail(err, RETEX_EFORMAT, "%s: the checksum of part %s is wrong", file, source->names[i].name);
    return 0;
}

static int check_exr(Source *source, int nthreads, RetexError *err)
{
    int status = source_describe(source, err);

    if (!status && source->set)
        status = request_set(source, err);
    if (!status && source->samples)
        status = request_samples(source, err);
    if (!status)
        status = check_memory(source, err);
    if (status)
        return status;
    for (int i = 0; i < source->nrequests; i++) {
        source->requests[i].image = NULL; /* the checksum is all that is wanted */
        source->requests[i].with_crc = 1;
    }
    status = retex_exr_read(source->exr, source->requests, source->nrequests, nthreads, err);
    return status ? status : compare_crcs(source, err);
}

int retex_set_check(const char *path, int nthreads, RetexError *err)
{
    Source source = {0};
    RetexSet *set = NULL;
    int status = retex_input_open(&source.input, path, err);

    if (!status && !is_pack(source.input)) {
        status = check_exr(&source, nthreads, err);
    } else if (!status) {
        status = retex_pack_open(&set, &source.input, nthreads, err);
        if (!status)
            status = retex_pack_verify(set, nthreads, err);
    }
    retex_set_close(&set);
    source_close(&source);
    return status;
}
