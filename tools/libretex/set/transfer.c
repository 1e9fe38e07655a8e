/* See transfer.h. */
#include "set/transfer.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/band_store.h>

#include "base/jobs.h"

#define ROWS_A_JOB 64 /* rows of a pack's band; several bands of a band store */

typedef struct TransferWork {
    const RetexImageTransfer *images;
    int blocks; /* blocks of rows in the tallest image */
    RetexComputeRows *make;
    void *context;
    const RetexSet *set;
    RetexBandStore *store;
} TransferWork;

static size_t row_length(const RetexImageTransfer *g)
{
    return (size_t)g->image->width * (size_t)g->image->channels;
}

static int store_rows(const TransferWork *work, RetexRowReader *reader, const RetexImageTransfer *g, int y0, int y1,
                      RetexError *err)
{
    const size_t bytes = row_length(g) * RETEX_BAND_ROWS * sizeof(float);
    float *band = malloc(bytes);
    int code = band ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    for (int y = y0; y < y1 && !code; y += RETEX_BAND_ROWS) {
        const int end = y + RETEX_BAND_ROWS < y1 ? y + RETEX_BAND_ROWS : y1;
        memset(band, 0, bytes);
        code = work->make(work->context, reader, g, y, end, band, err);
        if (!code)
            code = retex_band_store_put(work->store, g->store_image, y / RETEX_BAND_ROWS, band, err);
    }
    free(band);
    return code;
}

static int transfer_job(void *context, int index, int thread, RetexError *err)
{
    const TransferWork *work = context;
    const RetexImageTransfer *g = &work->images[index / work->blocks];
    const int y0 = index % work->blocks * ROWS_A_JOB;
    const int y1 = y0 + ROWS_A_JOB < g->image->height ? y0 + ROWS_A_JOB : g->image->height;
    RetexRowReader *reader;
    (void)thread;
    if (y0 >= y1)
        return RETEX_OK;
    int code = retex_row_reader_open(&reader, work->set, err);
    if (!code && g->image->pixels)
        code = work->make(work->context, reader, g, y0, y1, g->image->pixels + retex_image_index(g->image, 0, y0), err);
    else if (!code)
        code = store_rows(work, reader, g, y0, y1, err);
    retex_row_reader_close(&reader);
    return code;
}

int retex_compute_images(const RetexImageTransfer *images, int count, RetexComputeRows *make, void *context,
                         const RetexSet *set, RetexBandStore *store, int nthreads, RetexError *err)
{
    TransferWork work = {images, 0, make, context, set, store};
    for (int i = 0; i < count; i++) {
        const int blocks = (images[i].image->height + ROWS_A_JOB - 1) / ROWS_A_JOB;
        work.blocks = blocks > work.blocks ? blocks : work.blocks;
    }
    return retex_jobs_run(nthreads, count * work.blocks, transfer_job, &work, err);
}

static int copy_rows(void *context, RetexRowReader *reader, const RetexImageTransfer *g, int y0, int y1, float *to,
                     RetexError *err)
{
    const size_t length = row_length(g);
    int code = RETEX_OK;
    (void)context;
    for (int y = y0; y < y1 && !code; y++, to += length) {
        const float *row;
        code = retex_row_reader_get(reader, g->part, y, &row, err);
        if (!code && row)
            memcpy(to, row, length * sizeof *row);
    }
    return code;
}

int retex_transfer_images(const RetexImageTransfer *images, int count, const RetexSet *set, RetexBandStore *store,
                          int nthreads, RetexError *err)
{
    return retex_compute_images(images, count, copy_rows, NULL, set, store, nthreads, err);
}
