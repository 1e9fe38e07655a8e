/* See strip.h. */
#include "set/strip.h"

#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "set/rows.h"
#include "set/set.h"

struct RetexSetStrip {
    const RetexSet *whole;
    int copies;
    RetexSet set;        /* its parts belong to the strip; their pixels may be those of the whole set */
    RetexImage *buffers; /* by part: memory for most_rows rows, for parts whose rows are not in memory; allocated when
                          needed */
    int most_rows;
    int first;
};

int retex_set_part_rows(RetexImage *image, const RetexSet *set, int part, int first, RetexError *err)
{
    const size_t length = (size_t)image->width * (size_t)image->channels;
    RetexRowReader *reader;
    int code = retex_row_reader_open(&reader, set, err);
    for (int y = 0; y < image->height && !code; y++) {
        const float *row;
        float *to = image->pixels + (size_t)y * length;
        code = retex_row_reader_get(reader, part, first + y, &row, err);
        if (!code && row)
            memcpy(to, row, length * sizeof *row);
        else if (!code)
            memset(to, 0, length * sizeof *to);
    }
    retex_row_reader_close(&reader);
    return code;
}

int retex_set_strip_open(RetexSetStrip **result, const RetexSet *whole, int most_rows, int copies, RetexError *err)
{
    const size_t count = (size_t)whole->nparts + 1;
    RetexSetStrip *strip = *result = calloc(1, sizeof *strip);
    if (strip) {
        *strip = (RetexSetStrip){.whole = whole, .copies = copies, .set = *whole, .most_rows = most_rows};
        strip->set.parts = calloc(count, sizeof *strip->set.parts);
        strip->buffers = calloc(count, sizeof *strip->buffers);
    }
    if (!strip || !strip->set.parts || !strip->buffers) {
        retex_set_strip_close(result);
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    }
    for (int i = 0; i < whole->nparts; i++) {
        strip->set.parts[i] = whole->parts[i];
        strip->set.parts[i].source = NULL; /* it is not this set's to release */
    }
    return RETEX_OK;
}

void retex_set_strip_close(RetexSetStrip **result)
{
    RetexSetStrip *strip = *result;
    if (!strip)
        return;
    for (int i = 0; strip->buffers && i < strip->whole->nparts; i++)
        retex_image_free(&strip->buffers[i]);
    free(strip->set.parts);
    free(strip->buffers);
    free(strip);
    *result = NULL;
}

static int read_part_rows(void *context, int part, int thread, RetexError *err)
{
    RetexSetStrip *strip = context;
    const RetexImage *whole = &strip->whole->parts[part].image;
    RetexImage *image = &strip->set.parts[part].image, *buffer = &strip->buffers[part];
    (void)thread;
    *image = (RetexImage){0};
    if (whole->width != strip->whole->width || whole->height != strip->whole->height)
        return RETEX_OK;
    *image = *whole;
    image->height = strip->set.height;
    if (whole->pixels && !strip->copies) {
        image->pixels = whole->pixels + retex_image_index(whole, 0, strip->first);
        return RETEX_OK;
    }
    int code = RETEX_OK;
    if (!buffer->pixels)
        code = retex_image_alloc(buffer, whole->width, strip->most_rows, whole->channels, err);
    image->pixels = buffer->pixels;
    return code ? code : retex_set_part_rows(image, strip->whole, part, strip->first, err);
}

int retex_set_strip_load(RetexSet **rows, RetexSetStrip *strip, int first, int count, int nthreads, RetexError *err)
{
    *rows = &strip->set;
    strip->first = first;
    strip->set.height = count;
    return retex_jobs_run(nthreads, strip->whole->nparts, read_part_rows, strip, err);
}
