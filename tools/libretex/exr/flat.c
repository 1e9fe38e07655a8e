/* See retex/host/flat_exr.h. Attributes may depend on the rows, so that compressed chunks wait in memory until all are
 * there: then the header is known, and the file is written from front to back. */
#include <retex/host/flat_exr.h>

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "base/half.h"
#include "exr/chunk.h"
#include "exr/zip.h"
#include "io/output.h"

enum { LINES = RETEX_CHUNK_LINES, SHORT_NAME = 31, COMPRESSION_ZIP = 3, LONG_NAMES = 0x400, EXR_VERSION = 2 };

typedef struct FlatFile {
    const RetexFlatChannel *channels;
    const RetexFlatRows *rows;
    const RetexFlatText *texts;
    int width, height, nchannels, ntexts, nchunks;
    size_t row_bytes; /* of all channels */
    unsigned char **chunks;
    size_t *bytes;  /* of each chunk */
    RetexZip *zips; /* by thread */
    float **values; /* by thread: a row of a channel */
    atomic_int failed; /* the code of a chunk that failed, else 0 */
} FlatFile;

static size_t sample_bytes(const RetexFlatChannel *channel)
{
    return channel->type == RETEX_HALF ? 2 : 4;
}

static void pack_row(unsigned char *to, const RetexFlatChannel *channel, const float *values, size_t count)
{
    enum { BLOCK = 256 };
    if (channel->type == RETEX_FLOAT) {
        memcpy(to, values, count * sizeof *values);
        return;
    }
    for (size_t x = 0; x < count; x += BLOCK) {
        const size_t some = count - x < BLOCK ? count - x : BLOCK;
        uint16_t halves[BLOCK];
        retex_half_from_float(halves, values + x, some);
        memcpy(to + x * sizeof *halves, halves, some * sizeof *halves);
    }
}

static void fill_chunk(const FlatFile *file, int first, int lines, int thread, unsigned char *to)
{
    for (int y = first; y < first + lines; y++)
        for (int c = 0; c < file->nchannels; c++) {
            file->rows->row(file->rows->context, c, y, thread, file->values[thread]);
            pack_row(to, &file->channels[c], file->values[thread], (size_t)file->width);
            to += sample_bytes(&file->channels[c]) * (size_t)file->width;
        }
}

static void pack_chunk(void *context, int chunk, int thread)
{
    FlatFile *file = context;
    RetexZip *zip = &file->zips[thread];
    const int first = chunk * LINES, lines = file->height - first < LINES ? file->height - first : LINES;
    const size_t bytes = file->row_bytes * (size_t)lines;
    int code = file->failed;
    if (!code && file->rows->begin)
        code = file->rows->begin(file->rows->context, first, lines, thread);
    if (!code && !file->values[thread] && !(file->values[thread] = malloc((size_t)file->width * sizeof(float))))
        code = RETEX_ENOMEM;
    unsigned char *raw = code ? NULL : malloc(bytes), *packed = code ? NULL : malloc(bytes);
    if (!code && (!raw || !packed || !retex_zip_reserve(zip, bytes)))
        code = RETEX_ENOMEM;
    if (code) {
        file->failed = code;
        free(raw);
        free(packed);
        return;
    }
    fill_chunk(file, first, lines, thread, raw);
    file->bytes[chunk] = retex_zip_pack(zip, packed, raw, bytes);
    if (!file->bytes[chunk]) { /* compression gained nothing: stored uncompressed */
        memcpy(packed, raw, bytes);
        file->bytes[chunk] = bytes;
    }
    free(raw);
    unsigned char *fitting = realloc(packed, file->bytes[chunk]);
    file->chunks[chunk] = fitting ? fitting : packed;
}

/* ---- the header, little-endian, as OpenEXR's file layout says ---- */

static void put(RetexOutput *output, const void *data, size_t bytes, int *code, RetexError *err)
{
    if (!*code)
        *code = retex_output_write(output, data, bytes, err);
}

static void put_number(RetexOutput *output, uint64_t value, int bytes, int *code, RetexError *err)
{
    unsigned char digits[8];
    for (int k = 0; k < bytes; k++)
        digits[k] = (unsigned char)(value >> (8 * k));
    put(output, digits, (size_t)bytes, code, err);
}

static void put_attribute(RetexOutput *output, const char *name, const char *type, size_t bytes, int *code,
                          RetexError *err)
{
    put(output, name, strlen(name) + 1, code, err);
    put(output, type, strlen(type) + 1, code, err);
    put_number(output, bytes, 4, code, err);
}

static void put_channels(RetexOutput *output, const FlatFile *file, int *code, RetexError *err)
{
    size_t bytes = 1;
    for (int c = 0; c < file->nchannels; c++)
        bytes += strlen(file->channels[c].name) + 1 + 16;
    put_attribute(output, "channels", "chlist", bytes, code, err);
    for (int c = 0; c < file->nchannels; c++) {
        put(output, file->channels[c].name, strlen(file->channels[c].name) + 1, code, err);
        put_number(output, file->channels[c].type == RETEX_HALF ? 1 : 2, 4, code, err);
        put_number(output, 0, 4, code, err); /* not perceptually linear */
        put_number(output, 1, 4, code, err); /* all columns and rows are there */
        put_number(output, 1, 4, code, err);
    }
    put_number(output, 0, 1, code, err);
}

static int has_long_names(const FlatFile *file)
{
    int found = 0;
    for (int c = 0; c < file->nchannels; c++)
        found |= strlen(file->channels[c].name) > SHORT_NAME;
    for (int k = 0; k < file->ntexts; k++)
        found |= strlen(file->texts[k].name) > SHORT_NAME;
    return found;
}

static void put_header(RetexOutput *output, const FlatFile *file, int *code, RetexError *err)
{
    static const char *const windows[2] = {"dataWindow", "displayWindow"};
    const float one = 1, zero[2] = {0, 0};
    put(output, "\x76\x2f\x31\x01", 4, code, err);
    put_number(output, EXR_VERSION | (has_long_names(file) ? LONG_NAMES : 0), 4, code, err);
    put_channels(output, file, code, err);
    put_attribute(output, "compression", "compression", 1, code, err);
    put_number(output, COMPRESSION_ZIP, 1, code, err);
    for (int k = 0; k < 2; k++) {
        put_attribute(output, windows[k], "box2i", 16, code, err);
        put_number(output, 0, 8, code, err);
        put_number(output, (uint64_t)file->width - 1, 4, code, err);
        put_number(output, (uint64_t)file->height - 1, 4, code, err);
    }
    put_attribute(output, "lineOrder", "lineOrder", 1, code, err);
    put_number(output, 0, 1, code, err);
    put_attribute(output, "pixelAspectRatio", "float", 4, code, err);
    put(output, &one, 4, code, err);
    put_attribute(output, "screenWindowCenter", "v2f", 8, code, err);
    put(output, zero, 8, code, err);
    put_attribute(output, "screenWindowWidth", "float", 4, code, err);
    put(output, &one, 4, code, err);
    for (int k = 0; k < file->ntexts; k++) {
        put_attribute(output, file->texts[k].name, "string", strlen(file->texts[k].value), code, err);
        put(output, file->texts[k].value, strlen(file->texts[k].value), code, err);
    }
    put_number(output, 0, 1, code, err);
}

/* Bytes of the header, which the offsets of chunks count from. */
static int header_bytes(const FlatFile *file, size_t *bytes, RetexError *err)
{
    RetexOutput *memory = NULL;
    void *header = NULL;
    int code = retex_output_open_memory(&memory, err);
    if (code)
        return code;
    put_header(memory, file, &code, err);
    if (code)
        retex_output_abandon(&memory);
    else
        code = retex_output_take(&memory, &header, bytes, err);
    free(header);
    return code;
}

static int write_file(const FlatFile *file, const char *path, RetexError *err)
{
    RetexOutput *output = NULL;
    size_t header;
    int code = header_bytes(file, &header, err);
    if (!code)
        code = retex_output_open(&output, path, err);
    if (code)
        return code;
    put_header(output, file, &code, err);
    uint64_t offset = header + (uint64_t)file->nchunks * 8;
    for (int k = 0; k < file->nchunks; k++) {
        put_number(output, offset, 8, &code, err);
        offset += 8 + file->bytes[k];
    }
    for (int k = 0; k < file->nchunks; k++) {
        put_number(output, (uint64_t)k * LINES, 4, &code, err);
        put_number(output, file->bytes[k], 4, &code, err);
        put(output, file->chunks[k], file->bytes[k], &code, err);
    }
    if (!code)
        return retex_output_commit(&output, err);
    retex_output_abandon(&output);
    return code;
}

static int open_file(FlatFile *file, int nthreads, RetexError *err)
{
    for (int c = 0; c < file->nchannels; c++)
        file->row_bytes += sample_bytes(&file->channels[c]) * (size_t)file->width;
    if (file->row_bytes * LINES > INT32_MAX)
        return retex_fail(err, RETEX_ELIMIT, "%d channels of %d pixels a row are too many for a flat EXR file",
                          file->nchannels, file->width);
    file->chunks = calloc((size_t)file->nchunks, sizeof *file->chunks);
    file->bytes = calloc((size_t)file->nchunks, sizeof *file->bytes);
    file->zips = calloc((size_t)nthreads, sizeof *file->zips);
    file->values = calloc((size_t)nthreads, sizeof *file->values);
    if (!file->chunks || !file->bytes || !file->zips || !file->values)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write layers");
    return RETEX_OK;
}

static void close_file(FlatFile *file, int nthreads)
{
    for (int k = 0; k < file->nchunks && file->chunks; k++)
        free(file->chunks[k]);
    for (int k = 0; k < nthreads && file->zips; k++)
        retex_zip_free(&file->zips[k]);
    for (int k = 0; k < nthreads && file->values; k++)
        free(file->values[k]);
    free(file->chunks);
    free(file->bytes);
    free(file->zips);
    free(file->values);
}

int retex_flat_exr_write(const char *path, int width, int height, const RetexFlatChannel *channels, int nchannels,
                         const RetexFlatRows *rows, int nthreads, RetexError *err)
{
    FlatFile file = {.channels = channels,
                     .rows = rows,
                     .width = width,
                     .height = height,
                     .nchannels = nchannels,
                     .nchunks = (height + LINES - 1) / LINES};
    nthreads = retex_threads(nthreads);
    int code = open_file(&file, nthreads, err);
    if (!code) {
        retex_parallel(nthreads, file.nchunks, pack_chunk, &file);
        code = file.failed == RETEX_ENOMEM ? retex_fail(err, RETEX_ENOMEM, "no memory to write layers")
               : file.failed               ? retex_fail(err, file.failed, "the rows of %s could not be made", path)
                                           : RETEX_OK;
    }
    if (!code && rows->texts && !(file.texts = rows->texts(rows->context, &file.ntexts)))
        code = retex_fail(err, RETEX_ENOMEM, "no memory to write layers");
    if (!code)
        code = write_file(&file, path, err);
    close_file(&file, nthreads);
    return code;
}
