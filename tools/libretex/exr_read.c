/* Reading flat EXR parts, by channel name, on all threads.
 *
 * OpenEXRCore parses headers and finds chunks; uncompressed and ZIP chunks, all that sets are made of, are decoded
 * here, the other compressions by Core. Nothing in a file is believed: sizes are checked against what the header
 * promises, a chunk must fill its place exactly, and the first thing that is wrong ends the reading. */
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <retex/parallel.h>

#include "exr_error.h"
#include "exr_io.h"
#include "exr_zip.h"
#include "half.h"

enum { JOB_LINES = 16 }; /* one line chunks are read that many at a time */

struct RetexExr {
    RetexExrMessage message; /* first: see exr_error.h */
    RetexInput *input;
    exr_context_t context;
    int nparts;
};

static int fail_damaged(RetexExr *exr, exr_result_t code, RetexError *err)
{
    const char *name = retex_input_name(exr->input);

    if (code == EXR_ERR_OUT_OF_MEMORY)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    return retex_fail(err, RETEX_EFORMAT, "%s is damaged or truncated: %s", name,
                      exr->message.text[0] ? exr->message.text : exr_get_default_error_message(code));
}

static int64_t core_read(exr_const_context_t context, void *data, void *buffer, uint64_t bytes, uint64_t offset,
                         exr_stream_error_func_ptr_t report)
{
    const RetexExr *exr = data;

    (void)context;
    (void)report;
    return retex_input_read(exr->input, buffer, (size_t)bytes, offset);
}

static int64_t core_size(exr_const_context_t context, void *data)
{
    const RetexExr *exr = data;

    (void)context;
    return (int64_t)retex_input_size(exr->input);
}

int retex_exr_probe(const RetexInput *input)
{
    static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    unsigned char begin[4];

    return retex_input_read(input, begin, sizeof begin, 0) == sizeof begin && memcmp(begin, magic, sizeof magic) == 0;
}

int retex_exr_open(RetexExr **result, RetexInput *input, RetexError *err)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    RetexExr *exr;
    int status = 0;

    *result = NULL;
    if (!retex_exr_probe(input))
        return retex_fail(err, RETEX_EFORMAT, "%s is not an OpenEXR file", retex_input_name(input));
    exr = calloc(1, sizeof *exr);
    if (!exr)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", retex_input_name(input));
    pthread_mutex_init(&exr->message.lock, NULL);
    exr->input = input;
    settings.error_handler_fn = retex_exr_message;
    settings.alloc_fn = retex_exr_alloc;
    settings.free_fn = free;
    settings.user_data = exr;
    settings.read_fn = core_read;
    settings.size_fn = core_size;
    settings.max_image_width = settings.max_image_height = RETEX_MAX_SIZE;
    settings.max_tile_width = settings.max_tile_height = RETEX_MAX_SIZE;
    /* a set with chunks missing is no set; guessing where they might be helps nobody */
    settings.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t code = exr_start_read(&exr->context, retex_input_name(input), &settings);
    if (!code)
        code = exr_get_count(exr->context, &exr->nparts);
    if (code)
        status = fail_damaged(exr, code, err);
    else if (exr->nparts < 1 || exr->nparts > RETEX_EXR_PARTS_MAX)
        status = retex_fail(err, RETEX_EFORMAT, "%s has %d parts, more than %d", retex_input_name(input), exr->nparts,
                            RETEX_EXR_PARTS_MAX);
    if (status)
        retex_exr_close(&exr);
    *result = exr;
    return status;
}

void retex_exr_close(RetexExr **result)
{
    RetexExr *exr = result ? *result : NULL;

    if (!exr)
        return;
    if (exr->context)
        exr_finish(&exr->context);
    pthread_mutex_destroy(&exr->message.lock);
    free(exr);
    *result = NULL;
}

int retex_exr_part_count(const RetexExr *exr)
{
    return exr->nparts;
}

int retex_exr_find_part(const RetexExr *exr, const char *name)
{
    for (int i = 0; i < exr->nparts; i++) {
        const char *found = NULL;
        if (exr_get_name(exr->context, i, &found) == EXR_ERR_SUCCESS && found && strcmp(found, name) == 0)
            return i;
    }
    return -1;
}

const char *retex_exr_part_name(const RetexExr *exr, int part)
{
    const char *name = NULL;

    return exr_get_name(exr->context, part, &name) == EXR_ERR_SUCCESS && name ? name : "";
}

int retex_exr_channel_count(const RetexExr *exr, int part)
{
    const exr_attr_chlist_t *channels;

    return exr_get_channels(exr->context, part, &channels) ? 0 : channels->num_channels;
}

const char *retex_exr_channel_name(const RetexExr *exr, int part, int channel)
{
    const exr_attr_chlist_t *channels;

    if (exr_get_channels(exr->context, part, &channels) || channel < 0 || channel >= channels->num_channels)
        return "";
    return channels->entries[channel].name.str;
}

static void data_window(const RetexExr *exr, int part, exr_attr_box2i_t *window)
{
    if (exr_get_data_window(exr->context, part, window) != EXR_ERR_SUCCESS)
        *window = (exr_attr_box2i_t){.min = {.x = 0, .y = 0}, .max = {.x = -1, .y = -1}};
}

void retex_exr_part_size(const RetexExr *exr, int part, int *width, int *height)
{
    exr_attr_box2i_t window;

    data_window(exr, part, &window);
    const int64_t w = (int64_t)window.max.x - window.min.x + 1, h = (int64_t)window.max.y - window.min.y + 1;
    *width = w > 0 && w <= RETEX_MAX_SIZE ? (int)w : 0;
    *height = h > 0 && h <= RETEX_MAX_SIZE ? (int)h : 0;
}

int retex_exr_part_readable(const RetexExr *exr, int part, const char **reason)
{
    exr_storage_t storage;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    int width, height;

    *reason = "its header is incomplete";
    if (exr_get_storage(exr->context, part, &storage) || exr_get_compression(exr->context, part, &compression) ||
        exr_get_channels(exr->context, part, &channels))
        return 0;
    *reason = "deep parts are not read";
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return 0;
    *reason = "its compression is not known";
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB ||
        compression >= EXR_COMPRESSION_LAST_TYPE)
        return 0;
    *reason = "its size is out of bounds";
    retex_exr_part_size(exr, part, &width, &height);
    if (!width || !height)
        return 0;
    *reason = "subsampled channels are not read";
    for (int i = 0; i < channels->num_channels; i++)
        if (channels->entries[i].x_sampling != 1 || channels->entries[i].y_sampling != 1)
            return 0;
    *reason = NULL;
    return 1;
}

static const exr_attr_chlist_entry_t *find_channel(const RetexExr *exr, int part, const char *name)
{
    const exr_attr_chlist_t *channels;

    if (exr_get_channels(exr->context, part, &channels))
        return NULL;
    for (int i = 0; i < channels->num_channels; i++)
        if (strcmp(channels->entries[i].name.str, name) == 0)
            return &channels->entries[i];
    return NULL;
}

int retex_exr_has_channel(const RetexExr *exr, int part, const char *channel)
{
    return find_channel(exr, part, channel) != NULL;
}

int retex_exr_channel_type(const RetexExr *exr, int part, const char *channel, RetexPixelType *type)
{
    const exr_attr_chlist_entry_t *entry = find_channel(exr, part, channel);

    if (!entry || (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT))
        return 0;
    *type = entry->pixel_type == EXR_PIXEL_HALF ? RETEX_HALF : RETEX_FLOAT;
    return 1;
}

const char *retex_exr_attribute(const RetexExr *exr, int part, const char *name)
{
    const exr_attribute_t *attribute;
    const char *text = NULL;
    int32_t length;

    if (exr_get_attribute_by_name(exr->context, part, name, &attribute) || attribute->type != EXR_ATTR_STRING ||
        exr_attr_get_string(exr->context, part, name, &length, &text))
        return NULL;
    return text;
}

/* How one request is met. */
typedef struct Plan {
    RetexExrRequest *request;
    exr_storage_t storage;
    exr_compression_t compression;
    int left, top, width, height; /* data window */
    int chunk_width, chunk_height;
    int across, down; /* chunks */
    int nchannels;    /* of the part; all lie in every chunk */
    const exr_attr_chlist_entry_t *channels;
    int *slot; /* channel of the image that a channel of the part fills, or -1 */
    size_t pixel_bytes;
} Plan;

/* Some rows of chunks of one request. */
typedef struct Job {
    Plan *plan;
    int first, count;
    uint32_t crc[RETEX_EXR_LETTERS_MAX];
} Job;

typedef struct DecodeScratch {
    RetexZip zip;
    unsigned char *packed, *raw;
    float *row;
    size_t packed_bytes, raw_bytes, row_count;
} DecodeScratch;

typedef struct DecodeWork {
    RetexExr *exr;
    Job *jobs;
    DecodeScratch *scratch; /* one a thread */
    atomic_int code;        /* the first failure, exr_result_t */
} DecodeWork;

static size_t channel_bytes(const exr_attr_chlist_entry_t *channel)
{
    return channel->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

static int need(void **memory, size_t *have, size_t want, size_t unit)
{
    if (*have >= want)
        return 1;
    free(*memory);
    *memory = malloc(want * unit);
    *have = *memory ? want : 0;
    return *memory != NULL;
}

/* Let Core decode a chunk whose compression is not one of ours. */
static exr_result_t decode_with_core(RetexExr *exr, int part, const exr_chunk_info_t *chunk, unsigned char *raw,
                                     size_t bytes)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_decoding_initialize(exr->context, part, chunk, &pipeline);

    if (code)
        return code;
    /* Core chooses its routines by where channels are to go; they go nowhere, the bytes before that are wanted */
    for (int c = 0; c < pipeline.channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline.channels[c];
        channel->decode_to_ptr = raw;
        channel->user_pixel_stride = channel->user_bytes_per_element;
        channel->user_line_stride = channel->user_bytes_per_element * channel->width;
    }
    code = exr_decoding_choose_default_routines(exr->context, part, &pipeline);
    pipeline.unpack_and_convert_fn = NULL;
    if (!code)
        code = exr_decoding_run(exr->context, part, &pipeline);
    if (!code && !pipeline.unpacked_buffer)
        code = EXR_ERR_CORRUPT_CHUNK;
    if (!code)
        memcpy(raw, pipeline.unpacked_buffer, bytes);
    exr_decoding_destroy(exr->context, &pipeline);
    return code;
}

/* Read one chunk and undo its compression: *bytes_of are its samples, lines of planes. */
static exr_result_t chunk_samples(RetexExr *exr, const Plan *plan, const exr_chunk_info_t *chunk,
                                  DecodeScratch *scratch, const unsigned char **samples)
{
    const int part = plan->request->part;
    const size_t bytes = (size_t)chunk->width * (size_t)chunk->height * plan->pixel_bytes;
    const int zipped = plan->compression == EXR_COMPRESSION_ZIP || plan->compression == EXR_COMPRESSION_ZIPS;

    if (chunk->packed_size == 0 || chunk->packed_size > bytes || chunk->unpacked_size != bytes)
        return EXR_ERR_CORRUPT_CHUNK;
    if (plan->compression != EXR_COMPRESSION_NONE && !zipped) {
        if (!need((void **)&scratch->raw, &scratch->raw_bytes, bytes, 1))
            return EXR_ERR_OUT_OF_MEMORY;
        *samples = scratch->raw;
        return decode_with_core(exr, part, chunk, scratch->raw, bytes);
    }
    if (!need((void **)&scratch->packed, &scratch->packed_bytes, (size_t)chunk->packed_size, 1))
        return EXR_ERR_OUT_OF_MEMORY;
    const exr_result_t code = exr_read_chunk(exr->context, part, chunk, scratch->packed);
    if (code)
        return code;
    *samples = scratch->packed;
    if (chunk->packed_size == bytes)
        return EXR_ERR_SUCCESS;
    if (!zipped)
        return EXR_ERR_CORRUPT_CHUNK;
    if (!need((void **)&scratch->raw, &scratch->raw_bytes, bytes, 1))
        return EXR_ERR_OUT_OF_MEMORY;
    *samples = scratch->raw;
    return retex_zip_unpack(&scratch->zip, scratch->raw, bytes, scratch->packed, (size_t)chunk->packed_size)
               ? EXR_ERR_SUCCESS
               : EXR_ERR_CORRUPT_CHUNK;
}

static void plane_to_float(float *row, const unsigned char *plane, uint16_t type, int width)
{
    if (type == EXR_PIXEL_HALF) {
        retex_half_to_float(row, (const uint16_t *)(const void *)plane, (size_t)width);
    } else if (type == EXR_PIXEL_FLOAT) {
        memcpy(row, plane, (size_t)width * 4);
    } else {
        for (int x = 0; x < width; x++) {
            uint32_t value;
            memcpy(&value, plane + (size_t)x * 4, 4);
            row[x] = (float)value;
        }
    }
}

/* Give a chunk's samples to the image, at x, y of it, and to the checksums. */
static void deliver(const Plan *plan, const unsigned char *samples, int x, int y, int width, int height, float *row,
                    uint32_t *crc)
{
    RetexImage *image = plan->request->image;

    for (int line = 0; line < height; line++) {
        for (int c = 0; c < plan->nchannels; c++) {
            const size_t plane = (size_t)width * channel_bytes(&plan->channels[c]);
            const int slot = plan->slot[c];
            if (slot >= 0 && plan->request->with_crc)
                crc[slot] = (uint32_t)crc32(crc[slot], samples, (uInt)plane);
            if (slot >= 0 && image) {
                float *restrict out = image->pixels + retex_image_index(image, x, y + line) + slot;
                const size_t stride = (size_t)image->channels;
                plane_to_float(row, samples, (uint16_t)plan->channels[c].pixel_type, width);
                for (int i = 0; i < width; i++)
                    out[(size_t)i * stride] = row[i];
            }
            samples += plane;
        }
    }
}

static exr_result_t read_chunk(RetexExr *exr, Job *job, int column, int row, DecodeScratch *scratch)
{
    const Plan *plan = job->plan;
    const int x = column * plan->chunk_width, y = row * plan->chunk_height;
    const int width = plan->width - x < plan->chunk_width ? plan->width - x : plan->chunk_width;
    const int height = plan->height - y < plan->chunk_height ? plan->height - y : plan->chunk_height;
    const unsigned char *samples;
    exr_chunk_info_t chunk;
    exr_result_t code;

    if (plan->storage == EXR_STORAGE_SCANLINE)
        code = exr_read_scanline_chunk_info(exr->context, plan->request->part, plan->top + y, &chunk);
    else
        code = exr_read_tile_chunk_info(exr->context, plan->request->part, column, row, 0, 0, &chunk);
    if (!code && (chunk.width != width || chunk.height != height))
        code = EXR_ERR_BAD_CHUNK_LEADER;
    if (!code)
        code = chunk_samples(exr, plan, &chunk, scratch, &samples);
    if (!code && !need((void **)&scratch->row, &scratch->row_count, (size_t)width, sizeof(float)))
        code = EXR_ERR_OUT_OF_MEMORY;
    if (!code)
        deliver(plan, samples, x, y, width, height, scratch->row, job->crc);
    return code;
}

static void run_job(void *context, int index, int thread)
{
    DecodeWork *work = context;
    Job *job = &work->jobs[index];

    for (int c = 0; c < RETEX_EXR_LETTERS_MAX; c++)
        job->crc[c] = (uint32_t)crc32(0, NULL, 0);
    for (int row = job->first; row < job->first + job->count; row++)
        for (int column = 0; column < job->plan->across; column++) {
            if (atomic_load_explicit(&work->code, memory_order_relaxed))
                return; /* some other job has failed: the result is lost anyway */
            const exr_result_t code = read_chunk(work->exr, job, column, row, &work->scratch[thread]);
            if (code) {
                int none = 0;
                if (atomic_compare_exchange_strong(&work->code, &none, code))
                    job->plan->request->damaged = 1;
                return;
            }
        }
}

static int plan_channels(RetexExr *exr, Plan *plan, RetexError *err)
{
    const RetexExrRequest *request = plan->request;
    const exr_attr_chlist_t *channels;
    int wanted = 0, found = 0;

    exr_get_channels(exr->context, request->part, &channels);
    plan->nchannels = channels->num_channels;
    plan->channels = channels->entries;
    plan->slot = calloc((size_t)(plan->nchannels ? plan->nchannels : 1), sizeof *plan->slot);
    if (!plan->slot)
        return fail_damaged(exr, EXR_ERR_OUT_OF_MEMORY, err);
    for (int slot = 0; slot < RETEX_EXR_LETTERS_MAX; slot++)
        wanted += request->channels[slot][0] != 0;
    for (int c = 0; c < plan->nchannels; c++) {
        plan->slot[c] = -1;
        plan->pixel_bytes += channel_bytes(&channels->entries[c]);
        for (int slot = 0; slot < RETEX_EXR_LETTERS_MAX; slot++)
            if (request->channels[slot][0] && strcmp(channels->entries[c].name.str, request->channels[slot]) == 0) {
                plan->slot[c] = slot;
                found++;
            }
    }
    if (found != wanted)
        return retex_fail(err, RETEX_EFORMAT, "%s: part %d lacks a channel it should have",
                          retex_input_name(exr->input), request->part);
    return 0;
}

static int plan_request(RetexExr *exr, Plan *plan, RetexExrRequest *request, RetexError *err)
{
    const char *reason;
    exr_attr_box2i_t window;
    int32_t lines = 0, tile_width = 0, tile_height = 0;

    plan->request = request;
    if (!retex_exr_part_readable(exr, request->part, &reason))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: part %d cannot be read: %s", retex_input_name(exr->input),
                          request->part, reason);
    exr_get_storage(exr->context, request->part, &plan->storage);
    exr_get_compression(exr->context, request->part, &plan->compression);
    data_window(exr, request->part, &window);
    plan->left = window.min.x;
    plan->top = window.min.y;
    retex_exr_part_size(exr, request->part, &plan->width, &plan->height);
    if (request->image && (request->image->width != plan->width || request->image->height != plan->height))
        return retex_fail(err, RETEX_EINTERNAL, "the image for part %d has the wrong size", request->part);
    if (plan->storage == EXR_STORAGE_SCANLINE) {
        if (exr_get_scanlines_per_chunk(exr->context, request->part, &lines) || lines < 1)
            return fail_damaged(exr, EXR_ERR_FILE_BAD_HEADER, err);
        plan->chunk_width = plan->width;
        plan->chunk_height = lines;
    } else {
        if (request->with_crc || exr_get_tile_sizes(exr->context, request->part, 0, 0, &tile_width, &tile_height) ||
            tile_width < 1 || tile_height < 1)
            return fail_damaged(exr, EXR_ERR_FILE_BAD_HEADER, err);
        plan->chunk_width = tile_width;
        plan->chunk_height = tile_height;
    }
    plan->across = (plan->width + plan->chunk_width - 1) / plan->chunk_width;
    plan->down = (plan->height + plan->chunk_height - 1) / plan->chunk_height;
    return plan_channels(exr, plan, err);
}

/* Rows of chunks that make one job. */
static int job_rows(const Plan *plan)
{
    return plan->chunk_height >= JOB_LINES ? 1 : JOB_LINES / plan->chunk_height;
}

static Job *make_jobs(Plan *plans, int nplans, int *count)
{
    size_t total = 0, next = 0;

    for (int i = 0; i < nplans; i++)
        total += (size_t)((plans[i].down + job_rows(&plans[i]) - 1) / job_rows(&plans[i]));
    Job *jobs = calloc(total, sizeof *jobs);
    for (int i = 0; jobs && i < nplans; i++)
        for (int row = 0; row < plans[i].down; row += job_rows(&plans[i])) {
            Job *job = &jobs[next++];
            job->plan = &plans[i];
            job->first = row;
            job->count = plans[i].down - row < job_rows(&plans[i]) ? plans[i].down - row : job_rows(&plans[i]);
        }
    *count = (int)total;
    return jobs;
}

/* Put the jobs' checksums together: planes one after another, each from the top. */
static void combine_crcs(const Job *jobs, int njobs)
{
    for (int first = 0, end; first < njobs; first = end) {
        const Plan *plan = jobs[first].plan;
        uint32_t crc = (uint32_t)crc32(0, NULL, 0);
        for (end = first; end < njobs && jobs[end].plan == plan; end++)
            continue;
        for (int slot = 0; slot < RETEX_EXR_LETTERS_MAX && plan->request->with_crc; slot++)
            for (int c = 0; c < plan->nchannels; c++) {
                if (plan->slot[c] != slot)
                    continue;
                for (int j = first; j < end; j++) {
                    const int y = jobs[j].first * plan->chunk_height, rest = plan->height - y;
                    const int lines = jobs[j].count * plan->chunk_height;
                    const size_t bytes = (size_t)plan->width * channel_bytes(&plan->channels[c]);
                    crc = (uint32_t)crc32_combine(crc, jobs[j].crc[slot],
                                                  (z_off_t)(bytes * (size_t)(lines < rest ? lines : rest)));
                }
            }
        plan->request->crc = crc;
    }
}

/* The failure of a chunk, with the name of its part. */
static int fail_chunk(RetexExr *exr, const Plan *plans, int nplans, exr_result_t code, RetexError *err)
{
    const char *name = NULL;

    for (int i = 0; i < nplans; i++)
        if (plans[i].request->damaged)
            exr_get_name(exr->context, plans[i].request->part, &name);
    if (code != EXR_ERR_OUT_OF_MEMORY && name)
        return retex_fail(err, RETEX_EFORMAT, "%s: part %s is damaged or truncated: %s", retex_input_name(exr->input),
                          name, exr->message.text[0] ? exr->message.text : exr_get_default_error_message(code));
    return fail_damaged(exr, code, err);
}

static int run_jobs(RetexExr *exr, Plan *plans, int nplans, int nthreads, RetexError *err)
{
    DecodeWork work = {exr, NULL, NULL, 0};
    int njobs = 0;

    nthreads = retex_threads(nthreads);
    work.jobs = make_jobs(plans, nplans, &njobs);
    work.scratch = calloc((size_t)nthreads, sizeof *work.scratch);
    if (!work.jobs || !work.scratch)
        atomic_store(&work.code, EXR_ERR_OUT_OF_MEMORY);
    else
        retex_parallel(nthreads, njobs, run_job, &work);
    const exr_result_t code = atomic_load(&work.code);
    if (!code)
        combine_crcs(work.jobs, njobs);
    for (int i = 0; work.scratch && i < nthreads; i++) {
        retex_zip_free(&work.scratch[i].zip);
        free(work.scratch[i].packed);
        free(work.scratch[i].raw);
        free(work.scratch[i].row);
    }
    free(work.scratch);
    free(work.jobs);
    return code ? fail_chunk(exr, plans, nplans, code, err) : 0;
}

int retex_exr_read(RetexExr *exr, RetexExrRequest *requests, int nrequests, int nthreads, RetexError *err)
{
    Plan *plans;
    int status = 0;

    if (nrequests == 0)
        return 0;
    plans = calloc((size_t)nrequests, sizeof *plans);
    if (!plans)
        return fail_damaged(exr, EXR_ERR_OUT_OF_MEMORY, err);
    for (int i = 0; i < nrequests && !status; i++)
        status = plan_request(exr, &plans[i], &requests[i], err);
    if (!status)
        status = run_jobs(exr, plans, nrequests, nthreads, err);
    for (int i = 0; i < nrequests; i++)
        free(plans[i].slot);
    free(plans);
    return status;
}
