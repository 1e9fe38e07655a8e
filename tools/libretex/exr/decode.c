/* See decode.h. Uncompressed and ZIP chunks, and PXR24 chunks of floats, of which sets consist, are decoded here, other
 * compressions by OpenEXRCore. Nothing in a file is trusted: sizes are checked against the header, and a chunk must
 * fill its place exactly. */
#include "exr/decode.h"

#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "base/half.h"
#include "exr/chunk.h"
#include "exr/planes_kernel.h"

int retex_exr_fail(RetexExr *exr, exr_result_t code, RetexError *err)
{
    const char *name = retex_input_name(exr->input);

    if (code == EXR_ERR_OUT_OF_MEMORY)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    const int status = retex_fail(err, RETEX_EFORMAT, "%s is damaged or truncated: %s", name,
                                  exr->message.text[0] ? exr->message.text : exr_get_default_error_message(code));
    return retex_input_check(exr->input, status, err);
}

int retex_exr_fail_nonfinite(const RetexExr *exr, int part, const RetexExrNonFinite *bad, RetexError *err)
{
    const char *channel = retex_exr_channel_name(exr, part, bad->channel), *dot = strrchr(channel, '.');

    return retex_fail_disallowed(err, retex_input_name(exr->input), retex_exr_part_name(exr, part),
                                 dot ? dot + 1 : channel, bad->x, bad->y, bad->value);
}

size_t retex_exr_channel_bytes(const exr_attr_chlist_entry_t *channel)
{
    return channel->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

/* Decodes a chunk of another compression by OpenEXRCore. */
static exr_result_t decode_with_core(RetexExr *exr, int part, const exr_chunk_info_t *chunk, unsigned char *raw,
                                     size_t bytes)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_decoding_initialize(exr->context, part, chunk, &pipeline);

    if (code)
        return code;
    /* Core chooses its routines by the destination of channels; here they have none, because only the uncompressed
     * bytes are needed */
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

/* 1 if all channels are floats, which is what PXR24 is decoded for here. */
static int has_floats_only(const RetexExrPlan *plan)
{
    for (int c = 0; c < plan->nchannels; c++)
        if (plan->channels[c].pixel_type != EXR_PIXEL_FLOAT || plan->channels[c].x_sampling != 1)
            return 0;
    return 1;
}

/* Reads and decompresses one chunk: *bytes_of are its samples, lines of planes. */
static exr_result_t chunk_samples(RetexExr *exr, const RetexExrPlan *plan, const exr_chunk_info_t *chunk,
                                  RetexExrScratch *scratch, const unsigned char **samples)
{
    const int part = plan->request->part;
    const size_t bytes = (size_t)chunk->width * (size_t)chunk->height * plan->pixel_bytes;
    const int pxr24 = plan->compression == EXR_COMPRESSION_PXR24 && has_floats_only(plan);
    const int zipped = plan->compression == EXR_COMPRESSION_ZIP || plan->compression == EXR_COMPRESSION_ZIPS || pxr24;

    if (chunk->packed_size == 0 || chunk->packed_size > bytes || chunk->unpacked_size != bytes)
        return EXR_ERR_CORRUPT_CHUNK;
    if (plan->compression != EXR_COMPRESSION_NONE && !zipped) {
        if (!retex_chunk_room((void **)&scratch->raw, &scratch->raw_bytes, bytes, 1))
            return EXR_ERR_OUT_OF_MEMORY;
        *samples = scratch->raw;
        return decode_with_core(exr, part, chunk, scratch->raw, bytes);
    }
    if (!retex_chunk_room((void **)&scratch->packed, &scratch->packed_bytes, (size_t)chunk->packed_size, 1))
        return EXR_ERR_OUT_OF_MEMORY;
    const exr_result_t code = exr_read_chunk(exr->context, part, chunk, scratch->packed);
    if (code)
        return code;
    *samples = scratch->packed;
    if (chunk->packed_size == bytes)
        return EXR_ERR_SUCCESS;
    if (!zipped)
        return EXR_ERR_CORRUPT_CHUNK;
    if (!retex_chunk_room((void **)&scratch->raw, &scratch->raw_bytes, bytes, 1) ||
        !retex_zip_reserve(&scratch->zip, bytes))
        return EXR_ERR_OUT_OF_MEMORY;
    *samples = scratch->raw;
    const size_t packed = (size_t)chunk->packed_size;
    const int right =
        pxr24 ? retex_pxr24_unpack(&scratch->zip, scratch->raw, bytes, scratch->packed, packed, (size_t)chunk->width)
              : retex_zip_unpack(&scratch->zip, scratch->raw, bytes, scratch->packed, packed);
    return right ? EXR_ERR_SUCCESS : EXR_ERR_CORRUPT_CHUNK;
}

/* The floats of a plane: itself, or row, which receives them. */
static const void *plane_floats(float *row, const unsigned char *plane, uint16_t type, int width)
{
    if (type == EXR_PIXEL_FLOAT)
        return plane;
    if (type == EXR_PIXEL_HALF) {
        retex_half_to_float(row, (const uint16_t *)(const void *)plane, (size_t)width);
        return row;
    }
    for (int x = 0; x < width; x++) {
        uint32_t value;
        memcpy(&value, plane + (size_t)x * 4, 4);
        row[x] = (float)value;
    }
    return row;
}

/* Checks the values of one channel of a line; *bad receives the first that is not allowed, without its line. */
static int are_allowed(const RetexExrPlan *plan, int channel, const unsigned char *samples, int width,
                       RetexExrNonFinite *bad)
{
    const exr_pixel_type_t stored = plan->channels[channel].pixel_type;
    const RetexPixelType type = stored == EXR_PIXEL_HALF ? RETEX_HALF : RETEX_FLOAT;

    if (plan->request->allowed == RETEX_ALLOW_ANY || stored == EXR_PIXEL_UINT)
        return 1;
    const size_t first = retex_find_disallowed(samples, type, (size_t)width, plan->request->allowed);
    if (first == (size_t)width)
        return 1;
    *bad = (RetexExrNonFinite){.x = (int)first, .channel = channel};
    float value;
    samples += first * retex_exr_channel_bytes(&plan->channels[channel]);
    memcpy(&bad->value, plane_floats(&value, samples, (uint16_t)stored, 1), sizeof bad->value);
    return 0;
}

/* Copies a chunk's samples to the image, whose first row is row top of the part, and updates the checksums. 0: a value
 * is not allowed. */
static int store_samples(const RetexExrPlan *plan, RetexImage *image, int top, const unsigned char *samples, int x,
                         int y, int width, int height, RetexExrScratch *scratch, const RetexExrSums *sums)
{
    for (int line = 0; line < height; line++) {
        uint32_t *crc = sums ? sums->crc[(y + line - sums->top) / sums->lines] : NULL;
        const void *planes[RETEX_EXR_LETTERS_MAX] = {NULL};
        for (int c = 0; c < plan->nchannels; c++) {
            const size_t plane = (size_t)width * retex_exr_channel_bytes(&plan->channels[c]);
            const int to = plan->image_channel[c];
            if (to >= 0 && !are_allowed(plan, c, samples, width, &scratch->bad)) {
                scratch->bad.x += x;
                scratch->bad.y = y + line;
                return 0;
            }
            if (to >= 0 && crc)
                crc[to] = retex_crc32(crc[to], samples, plane);
            if (to >= 0 && image)
                planes[to] = plane_floats(scratch->rows + (size_t)width * (size_t)to, samples,
                                            (uint16_t)plan->channels[c].pixel_type, width);
            samples += plane;
        }
        if (image)
            retex_planes_interleave(image->pixels + retex_image_index(image, x, y + line - top), planes,
                                    image->channels, (size_t)width);
    }
    return 1;
}

exr_result_t retex_exr_chunk_samples(RetexExr *exr, const RetexExrPlan *plan, int column, int row,
                                     RetexExrScratch *scratch, const unsigned char **samples, int *width, int *height)
{
    const int x = column * plan->chunk_width, y = row * plan->chunk_height;
    exr_chunk_info_t chunk;
    exr_result_t code;

    *width = plan->width - x < plan->chunk_width ? plan->width - x : plan->chunk_width;
    *height = plan->height - y < plan->chunk_height ? plan->height - y : plan->chunk_height;
    if (plan->storage == EXR_STORAGE_SCANLINE)
        code = exr_read_scanline_chunk_info(exr->context, plan->request->part, plan->top + y, &chunk);
    else
        code = exr_read_tile_chunk_info(exr->context, plan->request->part, column, row, 0, 0, &chunk);
    if (!code && (chunk.width != *width || chunk.height != *height))
        code = EXR_ERR_BAD_CHUNK_LEADER;
    return code ? code : chunk_samples(exr, plan, &chunk, scratch, samples);
}

exr_result_t retex_exr_chunk_read(RetexExr *exr, const RetexExrPlan *plan, int column, int row, RetexImage *image,
                                  int top, const RetexExrSums *sums, RetexExrScratch *scratch)
{
    const int x = column * plan->chunk_width, y = row * plan->chunk_height;
    const unsigned char *samples;
    int width, height;
    exr_result_t code = retex_exr_chunk_samples(exr, plan, column, row, scratch, &samples, &width, &height);

    if (!code &&
        !retex_chunk_room((void **)&scratch->rows, &scratch->rows_count, (size_t)width * RETEX_EXR_LETTERS_MAX,
                          sizeof(float)))
        code = EXR_ERR_OUT_OF_MEMORY;
    if (!code && !store_samples(plan, image, top, samples, x, y, width, height, scratch, sums))
        code = RETEX_EXR_NON_FINITE;
    return retex_exr_alloc_failed() ? EXR_ERR_OUT_OF_MEMORY : code;
}

uint32_t retex_exr_sums_plane(const RetexExrPlan *plan, const RetexExrSums *sums, int to, int y0, int y1,
                              size_t *bytes)
{
    size_t line = 0, total = 0;
    uint32_t crc = CRC32_OF_NONE;

    for (int c = 0; c < plan->nchannels; c++)
        if (plan->image_channel[c] == to)
            line = (size_t)plan->width * retex_exr_channel_bytes(&plan->channels[c]);
    for (int y = y0; y < y1; y += sums->lines) {
        const size_t count = line * (size_t)(y1 - y < sums->lines ? y1 - y : sums->lines);
        crc = retex_crc32_join(crc, sums->crc[(y - sums->top) / sums->lines][to], count);
        total += count;
    }
    if (bytes)
        *bytes = total;
    return crc;
}

void retex_exr_scratch_free(RetexExrScratch *scratch)
{
    retex_zip_free(&scratch->zip);
    free(scratch->packed);
    free(scratch->raw);
    free(scratch->rows);
    *scratch = (RetexExrScratch){0};
}

static int plan_channels(RetexExr *exr, RetexExrPlan *plan, RetexError *err)
{
    const RetexExrRequest *request = plan->request;
    const exr_attr_chlist_t *channels;
    int wanted = 0, found = 0;

    exr_get_channels(exr->context, request->part, &channels);
    plan->nchannels = channels->num_channels;
    plan->channels = channels->entries;
    plan->image_channel = calloc((size_t)(plan->nchannels ? plan->nchannels : 1), sizeof *plan->image_channel);
    if (!plan->image_channel)
        return retex_exr_fail(exr, EXR_ERR_OUT_OF_MEMORY, err);
    for (int to = 0; to < RETEX_EXR_LETTERS_MAX; to++)
        wanted += request->channels[to][0] != 0;
    for (int c = 0; c < plan->nchannels; c++) {
        plan->image_channel[c] = -1;
        plan->pixel_bytes += retex_exr_channel_bytes(&channels->entries[c]);
        for (int to = 0; to < RETEX_EXR_LETTERS_MAX; to++)
            if (request->channels[to][0] && strcmp(channels->entries[c].name.str, request->channels[to]) == 0) {
                plan->image_channel[c] = to;
                found++;
            }
    }
    if (found != wanted)
        return retex_fail(err, RETEX_EFORMAT, "%s: part %d lacks a channel it should have",
                          retex_input_name(exr->input), request->part);
    return 0;
}

int retex_exr_plan_open(RetexExr *exr, RetexExrPlan *plan, RetexExrRequest *request, RetexError *err)
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
    retex_exr_data_window(exr, request->part, &window);
    plan->left = window.min.x;
    plan->top = window.min.y;
    retex_exr_part_size(exr, request->part, &plan->width, &plan->height);
    if (request->image && (request->image->width != plan->width || request->image->height != plan->height))
        return retex_fail(err, RETEX_EINTERNAL, "the image for part %d has the wrong size", request->part);
    if (plan->storage == EXR_STORAGE_SCANLINE) {
        if (exr_get_scanlines_per_chunk(exr->context, request->part, &lines) || lines < 1)
            return retex_exr_fail(exr, EXR_ERR_FILE_BAD_HEADER, err);
        plan->chunk_width = plan->width;
        plan->chunk_height = lines;
    } else {
        if (exr_get_tile_sizes(exr->context, request->part, 0, 0, &tile_width, &tile_height) || tile_width < 1 ||
            tile_height < 1)
            return retex_exr_fail(exr, EXR_ERR_FILE_BAD_HEADER, err);
        plan->chunk_width = tile_width;
        plan->chunk_height = tile_height;
    }
    plan->across = (plan->width + plan->chunk_width - 1) / plan->chunk_width;
    plan->down = (plan->height + plan->chunk_height - 1) / plan->chunk_height;
    return plan_channels(exr, plan, err);
}

void retex_exr_plan_close(RetexExrPlan *plan)
{
    free(plan->image_channel);
    *plan = (RetexExrPlan){0};
}
