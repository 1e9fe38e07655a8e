/* See rewrite.h. OpenEXRCore copies the attributes. Chunks of parts without a new channel are copied as they are.
 * Others are decoded, get the new samples, and are encoded again, some at a time on all threads. */
#include "exr/rewrite.h"

#include <stdlib.h>
#include <string.h>

#include <retex/output_file.h>
#include <retex/parallel.h>

#include "base/half.h"
#include "exr/decode.h"
#include "io/output.h"

enum { BATCH = 64 }; /* chunks that are encoded before they are written */

/* User data of Core's write context. */
typedef struct Target {
    RetexOutput *output;
    RetexError error;
    uint64_t position;
} Target;

typedef struct Copy {
    RetexExr *exr;
    exr_context_t to;
    const RetexExrReplacement *replacements;
    int count, nthreads;
} Copy;

/* One encoded chunk. */
typedef struct Piece {
    unsigned char *data;
    size_t bytes;
    exr_result_t code;
} Piece;

/* The chunks of one part that are encoded together. */
typedef struct Batch {
    const Copy *copy;
    const RetexExrPlan *plan;
    RetexExrScratch *scratch; /* one a thread */
    exr_compression_t compression;
    int first;
    Piece pieces[BATCH];
} Batch;

/* Core leaves a gap where its table of chunks belongs, and writes the table at the end. */
static int64_t write_target(exr_const_context_t context, void *data, const void *buffer, uint64_t bytes,
                            uint64_t offset, exr_stream_error_func_ptr_t report)
{
    static const unsigned char zeros[4096];
    Target *target = data;

    (void)context;
    (void)report;
    while (target->position < offset && !target->error.code) {
        const uint64_t gap = offset - target->position < sizeof zeros ? offset - target->position : sizeof zeros;
        if (!retex_output_write(target->output, zeros, (size_t)gap, &target->error))
            target->position += gap;
    }
    if (target->error.code)
        return -1;
    if (offset < target->position) {
        if (offset + bytes > target->position ||
            retex_output_patch(target->output, offset, buffer, (size_t)bytes, &target->error))
            return -1;
        return (int64_t)bytes;
    }
    if (retex_output_write(target->output, buffer, (size_t)bytes, &target->error))
        return -1;
    target->position += bytes;
    return (int64_t)bytes;
}

static int has_replacement(const Copy *copy, int part)
{
    for (int k = 0; k < copy->count; k++)
        if (copy->replacements[k].part == part)
            return 1;
    return 0;
}

/* A compression without loss, with as many lines in a chunk. */
static exr_compression_t lossless(exr_compression_t compression)
{
    return compression == EXR_COMPRESSION_PXR24                                        ? EXR_COMPRESSION_ZIP
           : compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A ? EXR_COMPRESSION_PIZ
                                                                                       : compression;
}

static exr_result_t declare_part(const Copy *copy, int part)
{
    const char *name = NULL;
    exr_storage_t storage;
    exr_compression_t compression;
    int number;
    exr_result_t code = exr_get_storage(copy->exr->context, part, &storage);

    (void)exr_get_name(copy->exr->context, part, &name);
    if (!code)
        code = exr_add_part(copy->to, name, storage, &number);
    if (!code)
        code = exr_get_compression(copy->exr->context, part, &compression);
    if (!code && has_replacement(copy, part))
        code = exr_set_compression(copy->to, number, lossless(compression));
    if (!code)
        code = exr_set_lineorder(copy->to, number, EXR_LINEORDER_INCREASING_Y);
    return code ? code : exr_copy_unset_attributes(copy->to, number, copy->exr->context, part);
}

/* 1 if a name of the header is too long for files of the first version. */
static int has_long_names(const RetexExr *exr)
{
    for (int part = 0; part < exr->nparts; part++) {
        int32_t count = 0;
        const exr_attribute_t *attribute;
        if (strlen(retex_exr_part_name(exr, part)) > 31)
            return 1;
        for (int c = 0; c < retex_exr_channel_count(exr, part); c++)
            if (strlen(retex_exr_channel_name(exr, part, c)) > 31)
                return 1;
        (void)exr_get_attribute_count(exr->context, part, &count);
        for (int k = 0; k < count; k++)
            if (!exr_get_attribute_by_index(exr->context, part, EXR_ATTR_LIST_FILE_ORDER, k, &attribute) &&
                (strlen(attribute->name) > 31 || strlen(attribute->type_name) > 31))
                return 1;
    }
    return 0;
}

static exr_result_t declare_parts(const Copy *copy)
{
    exr_result_t code = has_long_names(copy->exr) ? exr_set_longname_support(copy->to, 1) : EXR_ERR_SUCCESS;

    for (int part = 0; part < copy->exr->nparts && !code; part++)
        code = declare_part(copy, part);
    return code ? code : exr_write_header(copy->to);
}

/* ---- one chunk ---- */

/* Puts new pixels into one line of a channel. */
static void replace_line(unsigned char *samples, exr_pixel_type_t type, const RetexExrReplacement *from, size_t first,
                         int width)
{
    for (int x = 0; x < width; x++) {
        const float value = from->pixels[(first + (size_t)x) * from->stride];
        if (type == EXR_PIXEL_HALF)
            retex_half_from_float((uint16_t *)(void *)samples + x, &value, 1);
        else
            memcpy(samples + 4 * (size_t)x, &value, sizeof value);
    }
}

static void replace_samples(const Batch *batch, unsigned char *samples, int x, int y, int width, int height)
{
    const RetexExrPlan *plan = batch->plan;

    for (int line = 0; line < height; line++)
        for (int c = 0; c < plan->nchannels; c++) {
            for (int k = 0; k < batch->copy->count; k++)
                if (batch->copy->replacements[k].part == plan->request->part &&
                    batch->copy->replacements[k].channel == c)
                    replace_line(samples, plan->channels[c].pixel_type, &batch->copy->replacements[k],
                                 (size_t)(y + line) * (size_t)plan->width + (size_t)x, width);
            samples += (size_t)width * retex_exr_channel_bytes(&plan->channels[c]);
        }
}

/* Core compresses a chunk only where it writes it: see write_by_core. */
static int is_core_compression(exr_compression_t compression)
{
    return compression != EXR_COMPRESSION_NONE && compression != EXR_COMPRESSION_ZIP &&
           compression != EXR_COMPRESSION_ZIPS;
}

static exr_result_t compress(Piece *piece, const Batch *batch, const unsigned char *samples, size_t bytes,
                             RetexZip *zip)
{
    if (!(piece->data = malloc(bytes)))
        return EXR_ERR_OUT_OF_MEMORY;
    piece->bytes = 0;
    if (batch->compression == EXR_COMPRESSION_ZIP || batch->compression == EXR_COMPRESSION_ZIPS) {
        if (!retex_zip_reserve(zip, bytes))
            return EXR_ERR_OUT_OF_MEMORY;
        piece->bytes = retex_zip_pack(zip, piece->data, samples, bytes);
    }
    if (!piece->bytes) { /* nothing is gained: chunks are stored as they are */
        memcpy(piece->data, samples, bytes);
        piece->bytes = bytes;
    }
    return EXR_ERR_SUCCESS;
}

static void encode_job(void *context, int index, int thread)
{
    Batch *batch = context;
    const RetexExrPlan *plan = batch->plan;
    Piece *piece = &batch->pieces[index];
    RetexExrScratch *scratch = &batch->scratch[thread];
    const int column = (batch->first + index) % plan->across, row = (batch->first + index) / plan->across;
    const unsigned char *decoded;
    int width, height;

    piece->code = retex_exr_chunk_samples(batch->copy->exr, plan, column, row, scratch, &decoded, &width, &height);
    if (piece->code)
        return;
    unsigned char *samples = decoded == scratch->raw ? scratch->raw : scratch->packed; /* memory of the scratch */
    replace_samples(batch, samples, column * plan->chunk_width, row * plan->chunk_height, width, height);
    piece->code = compress(piece, batch, samples, (size_t)width * (size_t)height * plan->pixel_bytes, &scratch->zip);
}

static exr_result_t write_chunk(const Copy *copy, const RetexExrPlan *plan, int column, int row, const void *data,
                                size_t bytes)
{
    const int part = plan->request->part;

    return plan->storage == EXR_STORAGE_SCANLINE
               ? exr_write_scanline_chunk(copy->to, part, plan->top + row * plan->chunk_height, data, bytes)
               : exr_write_tile_chunk(copy->to, part, column, row, 0, 0, data, bytes);
}

/* In place of Core's packing: the samples are packed already. */
static exr_result_t pack_nothing(exr_encode_pipeline_t *pipeline)
{
    const Piece *piece = pipeline->encoding_user_data;

    if (piece->bytes > pipeline->packed_alloc_size)
        return EXR_ERR_INVALID_ARGUMENT;
    memcpy(pipeline->packed_buffer, piece->data, piece->bytes);
    pipeline->packed_bytes = piece->bytes;
    return EXR_ERR_SUCCESS;
}

/* Has OpenEXRCore compress and write a chunk. */
static exr_result_t write_by_core(const Copy *copy, const RetexExrPlan *plan, int column, int row, Piece *piece)
{
    const int part = plan->request->part;
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    exr_result_t code =
        plan->storage == EXR_STORAGE_SCANLINE
            ? exr_write_scanline_chunk_info(copy->to, part, plan->top + row * plan->chunk_height, &chunk)
            : exr_write_tile_chunk_info(copy->to, part, column, row, 0, 0, &chunk);

    if (!code)
        code = exr_encoding_initialize(copy->to, part, &chunk, &pipeline);
    if (code)
        return code;
    for (int c = 0; c < pipeline.channel_count; c++) { /* only to let Core choose its functions */
        exr_coding_channel_info_t *channel = &pipeline.channels[c];
        channel->encode_from_ptr = piece->data;
        channel->user_pixel_stride = channel->bytes_per_element;
        channel->user_line_stride = channel->bytes_per_element * channel->width;
    }
    code = exr_encoding_choose_default_routines(copy->to, part, &pipeline);
    pipeline.convert_and_pack_fn = pack_nothing;
    pipeline.encoding_user_data = piece;
    if (!code)
        code = exr_encoding_run(copy->to, part, &pipeline);
    exr_encoding_destroy(copy->to, &pipeline);
    return code;
}

/* ---- parts ---- */

static exr_result_t write_piece(Batch *batch, int index)
{
    const RetexExrPlan *plan = batch->plan;
    Piece *piece = &batch->pieces[index];
    const int column = (batch->first + index) % plan->across, row = (batch->first + index) / plan->across;

    return is_core_compression(batch->compression)
               ? write_by_core(batch->copy, plan, column, row, piece)
               : write_chunk(batch->copy, plan, column, row, piece->data, piece->bytes);
}

static exr_result_t encode_part(const Copy *copy, const RetexExrPlan *plan, exr_result_t *reading)
{
    Batch batch = {.copy = copy, .plan = plan, .compression = lossless(plan->compression)};
    const int chunks = plan->across * plan->down;
    exr_result_t code = EXR_ERR_SUCCESS;

    batch.scratch = calloc((size_t)copy->nthreads, sizeof *batch.scratch);
    if (!batch.scratch)
        return EXR_ERR_OUT_OF_MEMORY;
    for (; batch.first < chunks && !code && !*reading; batch.first += BATCH) {
        const int count = chunks - batch.first < BATCH ? chunks - batch.first : BATCH;
        memset(batch.pieces, 0, sizeof batch.pieces);
        retex_parallel(copy->nthreads, count, encode_job, &batch);
        for (int k = 0; k < count; k++) {
            if (!*reading)
                *reading = batch.pieces[k].code;
            if (!code && !*reading)
                code = write_piece(&batch, k);
            free(batch.pieces[k].data);
        }
    }
    for (int k = 0; k < copy->nthreads; k++)
        retex_exr_scratch_free(&batch.scratch[k]);
    free(batch.scratch);
    return code;
}

static exr_result_t copy_chunk(const Copy *copy, const RetexExrPlan *plan, int column, int row, exr_result_t *reading)
{
    exr_chunk_info_t chunk;
    exr_result_t code = EXR_ERR_SUCCESS;

    if (plan->storage == EXR_STORAGE_SCANLINE)
        *reading = exr_read_scanline_chunk_info(copy->exr->context, plan->request->part,
                                                plan->top + row * plan->chunk_height, &chunk);
    else
        *reading = exr_read_tile_chunk_info(copy->exr->context, plan->request->part, column, row, 0, 0, &chunk);
    if (!*reading && (chunk.packed_size == 0 || chunk.packed_size > (uint64_t)1 << 30))
        *reading = EXR_ERR_CORRUPT_CHUNK;
    void *data = *reading ? NULL : malloc((size_t)chunk.packed_size);
    if (!*reading && !data)
        return EXR_ERR_OUT_OF_MEMORY;
    if (!*reading)
        *reading = exr_read_chunk(copy->exr->context, plan->request->part, &chunk, data);
    if (!*reading)
        code = write_chunk(copy, plan, column, row, data, (size_t)chunk.packed_size);
    free(data);
    return code;
}

static int copy_part(const Copy *copy, int part, exr_result_t *writing, RetexError *err)
{
    RetexExrRequest request = {.part = part};
    RetexExrPlan plan = {0};
    exr_result_t reading = EXR_ERR_SUCCESS;
    int code = retex_exr_plan_open(copy->exr, &plan, &request, err);

    if (!code && has_replacement(copy, part))
        *writing = encode_part(copy, &plan, &reading);
    else
        for (int k = 0; !code && k < plan.across * plan.down && !*writing && !reading; k++)
            *writing = copy_chunk(copy, &plan, k % plan.across, k / plan.across, &reading);
    if (!code && reading)
        code = retex_exr_fail(copy->exr, reading, err);
    retex_exr_plan_close(&plan);
    return code;
}

int retex_exr_rewrite_check(RetexExr *exr, RetexError *err)
{
    for (int part = 0; part < exr->nparts; part++) {
        uint32_t width, height;
        exr_tile_level_mode_t levels = EXR_TILE_ONE_LEVEL;
        exr_tile_round_mode_t round;
        exr_compression_t compression;
        exr_storage_t storage;
        const char *reason;
        int readable = retex_exr_part_readable(exr, part, &reason);
        if (readable && !exr_get_storage(exr->context, part, &storage) && storage == EXR_STORAGE_TILED &&
            (exr_get_tile_descriptor(exr->context, part, &width, &height, &levels, &round) ||
             levels != EXR_TILE_ONE_LEVEL)) {
            reason = "its levels of detail would be lost";
            readable = 0;
        }
        if (!readable && !exr_get_compression(exr->context, part, &compression) &&
            (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB))
            reason = "its compression, DWA, is not read; `oiiotool IN --compression zip -o OUT` changes it";
        if (!readable)
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s: part %d cannot be copied: %s", retex_input_name(exr->input),
                              part, reason);
    }
    return RETEX_OK;
}

/* ---- the file ---- */

static int write_copy(Copy *copy, Target *target, const char *path, RetexError *err)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int status = RETEX_OK;

    settings.error_handler_fn = retex_exr_no_message;
    settings.user_data = target;
    settings.write_fn = write_target;
    exr_result_t code = exr_start_write(&copy->to, path, EXR_WRITE_FILE_DIRECTLY, &settings);
    if (!code)
        code = declare_parts(copy);
    for (int part = 0; part < copy->exr->nparts && !code && !status; part++)
        status = copy_part(copy, part, &code, err);
    if (copy->to) {
        const exr_result_t finished = exr_finish(&copy->to);
        code = code || status ? code : finished;
    }
    if (status)
        return status;
    if (target->error.code)
        return retex_fail(err, target->error.code, "%s", target->error.message);
    return code ? retex_exr_fail_write(code, path, err) : RETEX_OK;
}

/* Sends what was written into memory to a pipe. */
static int send(RetexOutput **memory, const char *path, RetexError *err)
{
    void *data = NULL;
    size_t bytes = 0;
    int code = retex_output_take(memory, &data, &bytes, err);

    if (!code)
        code = retex_file_write(path, data, bytes, err);
    free(data);
    return code;
}

int retex_exr_rewrite(RetexExr *exr, const RetexExrReplacement *replacements, int count, const char *path, int nthreads,
                      RetexError *err)
{
    Copy copy = {.exr = exr, .replacements = replacements, .count = count, .nthreads = retex_threads(nthreads)};
    Target target = {.output = NULL};
    const int is_file = retex_output_is_file(path);
    int code = retex_exr_rewrite_check(exr, err);

    if (!code)
        code = is_file ? retex_output_open(&target.output, path, err) : retex_output_open_memory(&target.output, err);
    if (!code)
        code = write_copy(&copy, &target, path, err);
    if (!code)
        code = is_file ? retex_output_commit(&target.output, err) : send(&target.output, path, err);
    retex_output_abandon(&target.output);
    return code;
}
