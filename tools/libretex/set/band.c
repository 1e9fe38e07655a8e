/* See band.h. */
#include "set/band.h"

#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "set/rows.h"
#include "set/set.h"

struct RetexSetBand {
    const RetexSet *whole;
    int copies;
    RetexSet set;        /* its parts belong to the band; their pixels may be those of the whole set */
    RetexImage *buffers; /* by part: memory for most_rows rows, for parts whose rows are not in memory; allocated when
                          needed */
    int most_rows;
    int first;
};

int retex_set_part_rows(RetexImage *image, const RetexSet *set, int part, int first, RetexError *err)
{
    const size_t length = (size_t)image->width * (size_t)image->channels;
    RetexRowReader *reader;
    int code = retex_row_reader_open(&reader, set, NULL, err);
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

int retex_set_band_open(RetexSetBand **result, const RetexSet *whole, int most_rows, int copies, RetexError *err)
{
    const size_t count = (size_t)whole->nparts + 1;
    RetexSetBand *band = *result = calloc(1, sizeof *band);
    if (band) {
        *band = (RetexSetBand){.whole = whole, .copies = copies, .set = *whole, .most_rows = most_rows};
        band->set.store = NULL, band->set.source = NULL;
        band->set.parts = calloc(count, sizeof *band->set.parts);
        band->buffers = calloc(count, sizeof *band->buffers);
    }
    if (!band || !band->set.parts || !band->buffers) {
        retex_set_band_close(result);
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    }
    for (int i = 0; i < whole->nparts; i++) {
        band->set.parts[i] = whole->parts[i];
        band->set.parts[i].store_image = 0;
    }
    return RETEX_OK;
}

void retex_set_band_close(RetexSetBand **result)
{
    RetexSetBand *band = *result;
    if (!band)
        return;
    for (int i = 0; band->buffers && i < band->whole->nparts; i++)
        retex_image_free(&band->buffers[i]);
    free(band->set.parts);
    free(band->buffers);
    free(band);
    *result = NULL;
}

static int read_part_rows(void *context, int part, int thread, RetexError *err)
{
    RetexSetBand *band = context;
    const RetexImage *whole = &band->whole->parts[part].image;
    RetexImage *image = &band->set.parts[part].image, *buffer = &band->buffers[part];
    (void)thread;
    *image = (RetexImage){0};
    if (whole->width != band->whole->width || whole->height != band->whole->height)
        return RETEX_OK;
    *image = *whole;
    image->height = band->set.height;
    if (whole->pixels && !band->copies) {
        image->pixels = whole->pixels + retex_image_index(whole, 0, band->first);
        return RETEX_OK;
    }
    int code = RETEX_OK;
    if (!buffer->pixels)
        code = retex_image_alloc(buffer, whole->width, band->most_rows, whole->channels, err);
    image->pixels = buffer->pixels;
    return code ? code : retex_set_part_rows(image, band->whole, part, band->first, err);
}

int retex_set_band_load(RetexSet **rows, RetexSetBand *band, int first, int count, int nthreads, RetexError *err)
{
    *rows = &band->set;
    band->first = first;
    band->set.height = count;
    return retex_jobs_run(nthreads, band->whole->nparts, read_part_rows, band, err);
}
