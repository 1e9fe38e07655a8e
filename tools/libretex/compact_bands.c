/* See compact_bands.h. */
#include "compact_bands.h"

#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "rows.h"

int compact_rows(RetexImage *image, const RetexSet *set, int part, int first, RetexError *err)
{
    const size_t length = (size_t)image->width * (size_t)image->channels;
    RowReader *reader;
    int code = row_reader_open(&reader, set, err);
    for (int y = 0; y < image->height && !code; y++) {
        const float *row;
        float *to = image->pixels + (size_t)y * length;
        code = row_reader_get(reader, part, first + y, &row, err);
        if (!code && row)
            memcpy(to, row, length * sizeof *row);
        else if (!code)
            memset(to, 0, length * sizeof *to);
    }
    row_reader_close(&reader);
    return code;
}

typedef struct BandWork {
    const RetexSet *whole;
    RetexSet set;
    RetexImage *rooms; /* by part, for those that are not in memory */
    int *codes;        /* by part */
    RetexError *errors;
    int first;
} BandWork;

static int is_whole(const BandWork *work, int part)
{
    const RetexImage *image = &work->whole->parts[part].image;
    return image->width == work->whole->width && image->height == work->whole->height;
}

static void take_part(void *context, int part, int thread)
{
    BandWork *work = context;
    const RetexImage *whole = &work->whole->parts[part].image;
    RetexImage *image = &work->set.parts[part].image, *room = &work->rooms[part];
    (void)thread;
    *image = (RetexImage){0};
    work->codes[part] = RETEX_OK;
    if (!is_whole(work, part))
        return;
    *image = *whole;
    image->height = work->set.height;
    if (whole->pixels) {
        image->pixels = whole->pixels + retex_image_index(whole, 0, work->first);
        return;
    }
    if (!room->pixels)
        work->codes[part] =
            retex_image_alloc(room, whole->width, work->set.height, whole->channels, &work->errors[part]);
    image->pixels = room->pixels;
    if (!work->codes[part])
        work->codes[part] = compact_rows(image, work->whole, part, work->first, &work->errors[part]);
}

static int take_band(BandWork *work, int nthreads, RetexError *err)
{
    const int count = work->whole->nparts, left = work->whole->height - work->first;
    work->set.height = left < COMPACT_BAND_ROWS ? left : COMPACT_BAND_ROWS;
    retex_parallel(nthreads, count, take_part, work);
    for (int i = 0; i < count; i++)
        if (work->codes[i])
            return retex_fail(err, work->codes[i], "%s", work->errors[i].message);
    return RETEX_OK;
}

int compact_bands(const CompactLight *light, CompactBandJob *job, void *context, int nthreads, RetexError *err)
{
    const size_t count = (size_t)light->set->nparts + 1;
    BandWork work = {.whole = light->set, .set = *light->set};
    CompactLight band = *light;
    work.set.parts = calloc(count, sizeof *work.set.parts);
    work.rooms = calloc(count, sizeof *work.rooms);
    work.codes = calloc(count, sizeof *work.codes);
    work.errors = calloc(count, sizeof *work.errors);
    int code = work.set.parts && work.rooms && work.codes && work.errors
                   ? RETEX_OK
                   : retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    if (!code)
        memcpy(work.set.parts, light->set->parts, (count - 1) * sizeof *work.set.parts);
    band.set = &work.set;
    for (; work.first < light->set->height && !code; work.first += COMPACT_BAND_ROWS) {
        code = take_band(&work, nthreads, err);
        if (!code)
            code = job(context, &band, work.first, err);
    }
    for (size_t i = 0; work.rooms && i + 1 < count; i++)
        retex_image_free(&work.rooms[i]);
    free(work.set.parts);
    free(work.rooms);
    free(work.codes);
    free(work.errors);
    return code;
}
