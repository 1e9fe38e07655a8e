/* See exr_source.h. A reader keeps the last row of chunks of each part, decoded. */
#include "exr_source.h"

#include <stdlib.h>
#include <string.h>

#include "exr_decode.h"

typedef struct ExrSource {
    RetexSetSource methods; /* first */
    RetexInput *input;
    RetexExr *exr;
    RetexExrRequest *requests;
    ExrPlan *plans; /* by part */
    int count, holders;
} ExrSource;

/* Some rows of one part. */
typedef struct Strip {
    RetexImage image;
    int row; /* of chunks, from 1; 0: none */
    int black;
} Strip;

typedef struct ExrReader {
    ExrSource *source;
    Strip *strips; /* by part */
    ExrScratch scratch;
} ExrReader;

static void source_close(RetexSetSource *methods)
{
    ExrSource *source = (ExrSource *)(void *)methods;
    if (--source->holders)
        return;
    for (int i = 0; source->plans && i < source->count; i++)
        exr_plan_close(&source->plans[i]);
    free(source->plans);
    free(source->requests);
    retex_exr_close(&source->exr);
    retex_input_close(&source->input);
    free(source);
}

static int reader_open(RetexSetSource *methods, void **result, RetexError *err)
{
    ExrSource *source = (ExrSource *)(void *)methods;
    ExrReader *reader = *result = calloc(1, sizeof *reader);
    if (reader)
        reader->strips = calloc((size_t)source->count + 1, sizeof *reader->strips);
    if (!reader || !reader->strips) {
        free(reader);
        *result = NULL;
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", retex_input_name(source->input));
    }
    reader->source = source;
    return RETEX_OK;
}

static void reader_close(void *data)
{
    ExrReader *reader = data;
    for (int i = 0; i < reader->source->count; i++)
        retex_image_free(&reader->strips[i].image);
    exr_scratch_free(&reader->scratch);
    free(reader->strips);
    free(reader);
}

static int is_black(const RetexImage *image)
{
    const size_t count = retex_image_index(image, 0, image->height);
    for (size_t i = 0; i < count; i++)
        if (image->pixels[i] != 0)
            return 0;
    return 1;
}

static int read_strip(ExrReader *reader, int part, int row, RetexError *err)
{
    ExrSource *source = reader->source;
    const ExrPlan *plan = &source->plans[part];
    Strip *strip = &reader->strips[part];
    const char *name = NULL;
    int code = RETEX_OK;
    if (!strip->image.pixels) {
        int channels = 0;
        while (channels < RETEX_EXR_LETTERS_MAX && plan->request->channels[channels][0])
            channels++;
        code = retex_image_alloc(&strip->image, plan->width, plan->chunk_height, channels, err);
    }
    strip->row = 0;
    for (int column = 0; !code && column < plan->across; column++) {
        const exr_result_t result = exr_chunk_read(source->exr, plan, column, row, &strip->image,
                                                   row * plan->chunk_height, NULL, &reader->scratch);
        if (!result)
            continue;
        exr_get_name(source->exr->context, plan->request->part, &name);
        code = result == EXR_ERR_OUT_OF_MEMORY ? exr_fail(source->exr, result, err)
                                               : retex_fail(err, RETEX_EFORMAT, "%s: part %s is damaged or truncated",
                                                            retex_input_name(source->input), name ? name : "");
    }
    if (code)
        return code;
    strip->row = row + 1;
    strip->black = is_black(&strip->image);
    return RETEX_OK;
}

static int read_row(void *data, int part, int y, const float **row, RowSpan *span, RetexError *err)
{
    ExrReader *reader = data;
    const ExrPlan *plan = &reader->source->plans[part];
    Strip *strip = &reader->strips[part];
    int code =
        strip->row == y / plan->chunk_height + 1 ? RETEX_OK : read_strip(reader, part, y / plan->chunk_height, err);
    if (code)
        return code;
    *row = strip->black ? NULL : strip->image.pixels + retex_image_index(&strip->image, 0, y % plan->chunk_height);
    *span = (RowSpan){0, strip->image.width};
    return RETEX_OK;
}

int exr_source_open(RetexSetSource **result, RetexInput *input, RetexExr *exr, RetexExrRequest *requests, int count,
                    RetexError *err)
{
    static const RetexSetSource methods = {source_close, reader_open, reader_close, read_row};
    ExrSource *source = calloc(1, sizeof *source);
    *result = NULL;
    if (!source) {
        free(requests);
        retex_exr_close(&exr);
        retex_input_close(&input);
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set");
    }
    *source = (ExrSource){methods, input, exr, requests, calloc((size_t)count + 1, sizeof *source->plans), count, 1};
    int code = source->plans ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory to read a set");
    for (int i = 0; !code && i < count; i++) {
        requests[i].image = NULL; /* rows go elsewhere */
        code = exr_plan_open(exr, &source->plans[i], &requests[i], err);
    }
    if (code)
        source_close(&source->methods);
    else
        *result = &source->methods;
    return code;
}

RetexSetSource *exr_source_share(RetexSetSource *methods)
{
    ExrSource *source = (ExrSource *)(void *)methods;
    source->holders++;
    return methods;
}
