/* See exr_source.h. A reader keeps the last decoded strip of each part: so many rows that they are whole rows of chunks
 * and whole bands that have a checksum. */
#include "set/exr_source.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/value_check.h"
#include "io/checksum.h"
#include "exr/decode.h"

enum { NOT_CHECKED, RIGHT, WRONG };

typedef struct ExrSource {
    RetexSetSource methods; /* first */
    RetexExrSourceParts parts;
    RetexExrPlan *plans;  /* by part, as are: */
    atomic_char *checked; /* 1: the whole part has been compared with its checksum, where bands have none */
    pthread_mutex_t checking;
} ExrSource;

/* Some rows of one part. */
typedef struct Strip {
    RetexImage image;
    RetexExrSums sums;
    int number;    /* from 1; 0: none */
    char *nonzero; /* by row: 1 if some value is not 0 */
} Strip;

typedef struct ExrReader {
    ExrSource *source;
    Strip *strips; /* by part */
    RetexExrScratch scratch;
} ExrReader;

static int no_memory(const ExrSource *source, RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", retex_input_name(source->parts.input));
}

static void source_close(RetexSetSource *methods)
{
    ExrSource *source = (ExrSource *)(void *)methods;
    for (int i = 0; source->plans && i < source->parts.count; i++)
        retex_exr_plan_close(&source->plans[i]);
    free(source->plans);
    free(source->checked);
    free(source->parts.requests);
    retex_band_sums_free(&source->parts.sums);
    retex_exr_close(&source->parts.exr);
    retex_input_close(&source->parts.input);
    pthread_mutex_destroy(&source->checking);
    free(source);
}

static int reader_open(RetexSetSource *methods, void **result, RetexError *err)
{
    ExrSource *source = (ExrSource *)(void *)methods;
    ExrReader *reader = *result = calloc(1, sizeof *reader);
    if (reader)
        reader->strips = calloc((size_t)source->parts.count + 1, sizeof *reader->strips);
    if (!reader || !reader->strips) {
        free(reader);
        *result = NULL;
        return no_memory(source, err);
    }
    reader->source = source;
    return RETEX_OK;
}

static void reader_close(void *data)
{
    ExrReader *reader = data;
    for (int i = 0; i < reader->source->parts.count; i++) {
        retex_image_free(&reader->strips[i].image);
        free(reader->strips[i].sums.crc);
        free(reader->strips[i].nonzero);
    }
    retex_exr_scratch_free(&reader->scratch);
    free(reader->strips);
    free(reader);
}

/* ---- checksums ---- */

static int fail_sum(const ExrSource *source, const RetexExrRequest *request, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "%s: the checksum of part %s is wrong", retex_input_name(source->parts.input),
                      retex_exr_part_name(source->parts.exr, request->part));
}

static int check_whole(ExrSource *source, int part, RetexError *err)
{
    RetexExrRequest whole = source->parts.requests[part];
    atomic_char *checked = &source->checked[part];
    int code = RETEX_OK;
    if (atomic_load(checked) == RIGHT)
        return RETEX_OK;
    pthread_mutex_lock(&source->checking);
    if (atomic_load(checked) == NOT_CHECKED) {
        whole.image = NULL;
        code = retex_exr_read(source->parts.exr, &whole, 1, source->parts.nthreads, err);
        if (!code)
            atomic_store(checked, whole.crc == whole.expected ? RIGHT : WRONG);
    }
    if (!code && atomic_load(checked) == WRONG)
        code = fail_sum(source, &whole, err);
    pthread_mutex_unlock(&source->checking);
    return code;
}

/* Compares the checksums of the bands from row y0 to the end of the strip, which was just read. */
static int check_bands(const ExrSource *source, int part, const RetexExrSums *sums, int y0, int y1, RetexError *err)
{
    const RetexExrPlan *plan = &source->plans[part];
    for (int y = y0; y < y1; y += RETEX_CHUNK_LINES) {
        const int end = y + RETEX_CHUNK_LINES < y1 ? y + RETEX_CHUNK_LINES : y1;
        uint32_t crc = CRC32_OF_NONE;
        for (int to = 0; to < RETEX_EXR_LETTERS_MAX && plan->request->channels[to][0]; to++) {
            size_t bytes;
            const uint32_t plane = retex_exr_sums_plane(plan, sums, to, y, end, &bytes);
            crc = retex_crc32_join(crc, plane, bytes);
        }
        if (crc != plan->request->bands[y / RETEX_CHUNK_LINES])
            return fail_sum(source, plan->request, err);
    }
    return RETEX_OK;
}

/* ---- rows ---- */

static int least_common_multiple(int a, int b)
{
    int x = a, y = b;
    while (y) {
        const int rest = x % y;
        x = y;
        y = rest;
    }
    return a / x * b;
}

/* The number of rows of a strip: whole chunks, and whole bands where these have checksums, but no more than the part
 * has. */
static int strip_lines(const RetexExrPlan *plan)
{
    int lines = plan->chunk_height;
    if (plan->request->bands && lines < plan->height)
        lines = least_common_multiple(lines, RETEX_CHUNK_LINES);
    return lines < plan->height ? lines : plan->height;
}

static int alloc_strip(Strip *strip, const RetexExrPlan *plan, RetexError *err)
{
    const int lines = strip_lines(plan);
    int channels = 0;
    while (channels < RETEX_EXR_LETTERS_MAX && plan->request->channels[channels][0])
        channels++;
    free(strip->sums.crc);
    free(strip->nonzero);
    strip->sums.lines = plan->across > 1 ? 1 : RETEX_CHUNK_LINES;
    strip->sums.crc = calloc((size_t)(lines / strip->sums.lines) + 1, sizeof *strip->sums.crc);
    strip->nonzero = malloc((size_t)lines);
    if (!strip->sums.crc || !strip->nonzero)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    return retex_image_alloc(&strip->image, plan->width, lines, channels, err);
}

static int fail_chunk(const ExrReader *reader, const RetexExrPlan *plan, exr_result_t result, RetexError *err)
{
    const ExrSource *source = reader->source;
    if (result == RETEX_EXR_NON_FINITE)
        return retex_exr_fail_nonfinite(source->parts.exr, plan->request->part, &reader->scratch.bad, err);
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return retex_exr_fail(source->parts.exr, result, err);
    const int code =
        retex_fail(err, RETEX_EFORMAT, "%s: part %s is damaged or truncated", retex_input_name(source->parts.input),
                   retex_exr_part_name(source->parts.exr, plan->request->part));
    return retex_input_check(source->parts.input, code, err);
}

static int read_strip(ExrReader *reader, int part, int number, RetexError *err)
{
    ExrSource *source = reader->source;
    const RetexExrPlan *plan = &source->plans[part];
    Strip *strip = &reader->strips[part];
    const uint32_t *bands = plan->request->bands;
    int code = bands ? RETEX_OK : check_whole(source, part, err);
    if (!code && !strip->image.pixels)
        code = alloc_strip(strip, plan, err);
    strip->number = 0;
    if (code)
        return code;
    const int lines = strip->image.height, y0 = number * lines,
              y1 = y0 + lines < plan->height ? y0 + lines : plan->height;
    strip->sums.top = y0;
    memset(strip->sums.crc, 0, ((size_t)(lines / strip->sums.lines) + 1) * sizeof *strip->sums.crc);
    for (int y = y0; y < y1; y += plan->chunk_height)
        for (int column = 0; column < plan->across; column++) {
            const exr_result_t result =
                retex_exr_chunk_read(source->parts.exr, plan, column, y / plan->chunk_height, &strip->image, y0,
                                     bands ? &strip->sums : NULL, &reader->scratch);
            if (result)
                return fail_chunk(reader, plan, result, err);
        }
    if (bands)
        code = check_bands(source, part, &strip->sums, y0, y1, err);
    if (code)
        return code;
    const size_t length = retex_image_index(&strip->image, 0, 1);
    strip->number = number + 1;
    for (int y = y0; y < y1; y++)
        strip->nonzero[y - y0] =
            (char)retex_floats_have_nonzero(strip->image.pixels + retex_image_index(&strip->image, 0, y - y0), length);
    return RETEX_OK;
}

static int read_row(void *data, int part, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    ExrReader *reader = data;
    const int lines = strip_lines(&reader->source->plans[part]);
    Strip *strip = &reader->strips[part];
    const int code = strip->number == y / lines + 1 ? RETEX_OK : read_strip(reader, part, y / lines, err);
    if (code)
        return code;
    *row = strip->nonzero[y % lines] ? strip->image.pixels + retex_image_index(&strip->image, 0, y % lines) : NULL;
    *span = (RetexRowSpan){0, strip->image.width};
    return RETEX_OK;
}

static int stored(RetexSetSource *methods, int part, RetexPixelType type, RetexExrStored *result)
{
    const ExrSource *source = (ExrSource *)(void *)methods;
    return retex_exr_stored_find(result, source->parts.exr, &source->plans[part], type);
}

static int open_plans(ExrSource *source, RetexError *err)
{
    const int count = source->parts.count;
    int code = RETEX_OK;
    source->plans = calloc((size_t)count + 1, sizeof *source->plans);
    source->checked = calloc((size_t)count + 1, sizeof *source->checked);
    if (!source->plans || !source->checked)
        return no_memory(source, err);
    for (int i = 0; !code && i < count; i++) {
        source->parts.requests[i].image = NULL; /* rows are read into strips instead */
        code = retex_exr_plan_open(source->parts.exr, &source->plans[i], &source->parts.requests[i], err);
    }
    return code;
}

int retex_exr_source_open(RetexSetSource **result, const RetexExrSourceParts *parts, RetexError *err)
{
    static const RetexSetSource methods = {source_close, reader_open, reader_close, read_row, stored, 1};
    ExrSource *source = calloc(1, sizeof *source);
    *result = NULL;
    if (!source) {
        RetexExrSourceParts left = *parts;
        free(left.requests);
        retex_band_sums_free(&left.sums);
        retex_exr_close(&left.exr);
        retex_input_close(&left.input);
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set");
    }
    source->methods = methods;
    source->parts = *parts;
    pthread_mutex_init(&source->checking, NULL);
    const int code = open_plans(source, err);
    if (code)
        source_close(&source->methods); /* no part has it yet */
    else
        *result = &source->methods;
    return code;
}
