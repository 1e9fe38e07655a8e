/* See keep.h. */
#include "set/keep.h"

#include <stdlib.h>
#include <string.h>

#include "base/jobs.h"
#include "set/rows.h"
#include "set/source.h"

#define ROWS_A_JOB 64 /* rows of a pack's band; several bands of a band store */

/* A part, and where it goes: pixels, which are 0, or an image of the band store. */
typedef struct Kept {
    int part, store_image;
    RetexImage image; /* without pixels: it goes into the band store */
} Kept;

typedef struct Keeping {
    const RetexSet *set;
    Kept *kept;
    int count, blocks; /* blocks of rows in the tallest part */
    RetexBandStore *store;
} Keeping;

static size_t row_length(const Kept *kept)
{
    return (size_t)kept->image.width * (size_t)kept->image.channels;
}

/* Copies rows y0 <= y < y1 of a part to `to`, which is 0. */
static int copy_rows(RetexRowReader *reader, const Kept *kept, int y0, int y1, float *to, RetexError *err)
{
    int code = RETEX_OK;
    for (int y = y0; y < y1 && !code; y++, to += row_length(kept)) {
        const float *row;
        code = retex_row_reader_get(reader, kept->part, y, &row, err);
        if (!code && row)
            memcpy(to, row, row_length(kept) * sizeof *row);
    }
    return code;
}

static int store_rows(const Keeping *work, RetexRowReader *reader, const Kept *kept, int y0, int y1, RetexError *err)
{
    const size_t bytes = row_length(kept) * RETEX_BAND_ROWS * sizeof(float);
    float *band = malloc(bytes);
    int code = band ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    for (int y = y0; y < y1 && !code; y += RETEX_BAND_ROWS) {
        memset(band, 0, bytes);
        code = copy_rows(reader, kept, y, y + RETEX_BAND_ROWS < y1 ? y + RETEX_BAND_ROWS : y1, band, err);
        if (!code)
            code = retex_band_store_put(work->store, kept->store_image, y / RETEX_BAND_ROWS, band, err);
    }
    free(band);
    return code;
}

static int keep_job(void *context, int index, int thread, RetexError *err)
{
    const Keeping *work = context;
    const Kept *kept = &work->kept[index / work->blocks];
    const int y0 = index % work->blocks * ROWS_A_JOB;
    const int y1 = y0 + ROWS_A_JOB < kept->image.height ? y0 + ROWS_A_JOB : kept->image.height;
    RetexRowReader *reader;
    (void)thread;
    if (y0 >= y1)
        return RETEX_OK;
    int code = retex_row_reader_open(&reader, work->set, err);
    if (!code && kept->image.pixels)
        code = copy_rows(reader, kept, y0, y1, kept->image.pixels + retex_image_index(&kept->image, 0, y0), err);
    else if (!code)
        code = store_rows(work, reader, kept, y0, y1, err);
    retex_row_reader_close(&reader);
    return code;
}

static int add(Keeping *work, int number, RetexError *err)
{
    const RetexPart *part = &work->set->parts[number];
    const RetexImage *shape = &part->image;
    Kept *kept = &work->kept[work->count++];
    const int blocks = (shape->height + ROWS_A_JOB - 1) / ROWS_A_JOB;
    work->blocks = blocks > work->blocks ? blocks : work->blocks;
    *kept = (Kept){.part = number};
    if (!work->store || shape->width != work->set->width || shape->height != work->set->height)
        return retex_image_alloc(&kept->image, shape->width, shape->height, shape->channels, err);
    kept->image = *shape;
    return retex_band_store_add(work->store, part->name, part->letters, part->type, &kept->store_image, err);
}

int retex_set_keep(RetexSet *set, const char *wanted, RetexBandStore *store, int nthreads, RetexError *err)
{
    Keeping work = {.set = set, .kept = calloc((size_t)set->nparts + 1, sizeof *work.kept), .store = store};
    RetexSetSource *source = NULL;
    int code = work.kept ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory to load a set");
    for (int i = 0; i < set->nparts && !code; i++)
        if (wanted[i] && !set->parts[i].image.pixels)
            code = add(&work, i, err);
    if (!code)
        code = retex_jobs_run(nthreads, work.count * work.blocks, keep_job, &work, err);
    if (!code && store) {
        code = retex_store_source_open(&source, store, err);
        store = NULL;
    }
    for (int i = 0; i < work.count; i++) {
        Kept *kept = &work.kept[i];
        RetexPart *part = &set->parts[kept->part];
        if (code)
            retex_image_free(&kept->image);
        else if (kept->image.pixels)
            part->image = kept->image;
        else
            retex_part_set_source(part, source, kept->store_image);
    }
    retex_source_release(&source);
    retex_band_store_close(&store);
    free(work.kept);
    return code;
}
