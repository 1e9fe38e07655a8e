/* See gather.h. */
#include "gather.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "rows.h"

#define ROWS_A_JOB 64 /* a pack's band, some of a spool's */

typedef struct GatherWork {
    const Gathered *images;
    int blocks; /* an image, at most */
    const RetexSet *set;
    const RetexSamples *samples;
    RetexSpool *spool;
    atomic_int code;
    RetexError *errors; /* by thread */
} GatherWork;

static size_t row_length(const Gathered *g)
{
    return (size_t)g->image->width * (size_t)g->image->channels;
}

/* Rows y0 <= y < y1 into `to`, which is black. */
static int read_rows(RowReader *reader, const Gathered *g, int y0, int y1, float *to, RetexError *err)
{
    const size_t length = row_length(g);
    int code = RETEX_OK;
    for (int y = y0; y < y1 && !code; y++, to += length) {
        const float *row;
        code = g->part >= 0 ? row_reader_get(reader, g->part, y, &row, err)
                            : row_reader_sample(reader, g->footprint, y, &row, err);
        if (!code && row)
            memcpy(to, row, length * sizeof *row);
    }
    return code;
}

static int spool_rows(RowReader *reader, const Gathered *g, RetexSpool *spool, int y0, int y1, RetexError *err)
{
    const size_t bytes = row_length(g) * RETEX_SPOOL_LINES * sizeof(float);
    float *band = malloc(bytes);
    int code = band ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    for (int y = y0; y < y1 && !code; y += RETEX_SPOOL_LINES) {
        memset(band, 0, bytes);
        code = read_rows(reader, g, y, y + RETEX_SPOOL_LINES < y1 ? y + RETEX_SPOOL_LINES : y1, band, err);
        if (!code)
            code = retex_spool_put(spool, g->spooled, y / RETEX_SPOOL_LINES, band, err);
    }
    free(band);
    return code;
}

static void gather_job(void *context, int index, int thread)
{
    GatherWork *work = context;
    RetexError *err = &work->errors[thread];
    RowReader *reader;
    const Gathered *g = &work->images[index / work->blocks];
    const int y0 = index % work->blocks * ROWS_A_JOB;
    const int y1 = y0 + ROWS_A_JOB < g->image->height ? y0 + ROWS_A_JOB : g->image->height;
    if (work->code || y0 >= y1)
        return;
    int code = row_reader_open(&reader, work->set, work->samples, err);
    if (!code && g->image->pixels)
        code = read_rows(reader, g, y0, y1, g->image->pixels + retex_image_index(g->image, 0, y0), err);
    else if (!code)
        code = spool_rows(reader, g, work->spool, y0, y1, err);
    row_reader_close(&reader);
    if (code)
        atomic_store(&work->code, code);
}

int gather(const Gathered *images, int count, const RetexSet *set, const RetexSamples *samples, RetexSpool *spool,
           int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    GatherWork work = {.images = images, .set = set, .samples = samples, .spool = spool};
    if (!(work.errors = calloc((size_t)threads, sizeof *work.errors)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    for (int i = 0; i < count; i++) {
        const int blocks = (images[i].image->height + ROWS_A_JOB - 1) / ROWS_A_JOB;
        work.blocks = blocks > work.blocks ? blocks : work.blocks;
    }
    retex_parallel(threads, count * work.blocks, gather_job, &work);
    for (int i = 0; i < threads && work.code && err; i++)
        if (work.errors[i].code)
            *err = work.errors[i];
    free(work.errors);
    return work.code;
}
