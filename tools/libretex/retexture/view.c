/* See view.h. */
#include "retexture/view.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

#include "base/jobs.h"
#include "set/set.h"

#define ROWS_A_JOB 64 /* a pack's strip */

int retex_view_find(const RetexView *view, RetexViewKind kind, int index, int finish)
{
    for (int i = 0; i < view->nimages; i++)
        if (view->images[i].kind == kind && view->images[i].index == index && view->images[i].finish == finish)
            return i;
    return -1;
}

void retex_view_close(RetexView *view)
{
    for (int i = 0; i < view->nimages; i++) {
        free(view->images[i].products);
        retex_image_free(&view->images[i].kept);
    }
    free(view->images);
    *view = (RetexView){0};
}

/* ---- rows ---- */

void retex_view_reader_close(RetexViewReader *reader)
{
    for (int i = 0; reader->rows && i < reader->view->nimages; i++) {
        free(reader->rows[i].buffer.values);
        free(reader->rows[i].terms);
    }
    free(reader->rows);
    free(reader->weights);
    retex_row_reader_close(&reader->set);
    *reader = (RetexViewReader){0};
}

int retex_view_reader_open(RetexViewReader *reader, const RetexView *view, RetexError *err)
{
    *reader = (RetexViewReader){.view = view};
    int code = retex_row_reader_open(&reader->set, view->set, err);
    reader->rows = calloc((size_t)view->nimages + 1, sizeof *reader->rows);
    reader->weights = malloc(sizeof *reader->weights * 3 * (size_t)view->set->width);
    if (!code && (!reader->rows || !reader->weights))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int i = 0; i < view->nimages && !code; i++)
        reader->rows[i].y = -1;
    if (code)
        retex_view_reader_close(reader);
    return code;
}

static int make_row(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y, RetexError *err)
{
    const size_t numbers = (size_t)image->width * (size_t)image->channels;
    if (!own->buffer.values && !(own->buffer.values = calloc(numbers, sizeof *own->buffer.values)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    own->y = -1;
    own->row = NULL;
    own->span = (RetexRowSpan){0, image->width};
    const int code = image->make(reader, image, own, y, err);
    if (code)
        return code;
    own->y = y;
    if (!own->row || retex_span_is_empty(own->span))
        own->row = NULL, own->span = (RetexRowSpan){0, 0};
    RETEX_ASSERT(!own->row || retex_span_holds(own->span, own->row, image->width, image->channels));
    return RETEX_OK;
}

int retex_view_row(RetexViewReader *reader, int number, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    RETEX_ASSERT(number >= 0 && number < reader->view->nimages);
    const RetexViewImage *image = &reader->view->images[number];
    RetexViewRow *own = &reader->rows[number];
    RETEX_ASSERT(y >= 0 && y < image->height); /* of the image, which may be smaller than the picture */
    if (image->is_made) {
        *row = image->kept.pixels + retex_image_index(&image->kept, 0, y);
        if (span)
            *span = (RetexRowSpan){0, image->width};
        return RETEX_OK;
    }
    const int code = own->y == y ? RETEX_OK : make_row(reader, image, own, y, err);
    *row = own->row;
    if (span)
        *span = own->span;
    return code;
}

/* ---- images that are enlarged ----
 *
 * Those of one scale are made together, row by row, so that what several of them need is made and read once; coarser
 * ones come first, as the products at a finer scale need them. */

typedef struct MakeWork {
    RetexView *view;
    int scale;
    RetexViewReader *readers; /* by thread */
} MakeWork;

static int is_of_pass(const RetexViewImage *image, int scale)
{
    return image->is_enlarged && image->scale == scale;
}

static int make_job(void *context, int index, int thread, RetexError *err)
{
    const MakeWork *work = context;
    RetexView *view = work->view;
    RetexViewReader *reader = &work->readers[thread];
    const int height = (view->set->height + work->scale - 1) / work->scale;
    int code = reader->view ? RETEX_OK : retex_view_reader_open(reader, view, err);
    for (int y = index * ROWS_A_JOB; !code && y < (index + 1) * ROWS_A_JOB && y < height; y++)
        for (int i = 0; i < view->nimages && !code; i++) {
            RetexImage *kept = &view->images[i].kept;
            const float *row;
            if (!is_of_pass(&view->images[i], work->scale))
                continue;
            code = retex_view_row(reader, i, y, &row, NULL, err);
            float *to = kept->pixels + retex_image_index(kept, 0, y);
            const size_t bytes = sizeof *to * (size_t)kept->width * (size_t)kept->channels;
            if (!code && row)
                memcpy(to, row, bytes);
            else if (!code) /* it is 0, but a first write after a read causes a second page fault */
                memset(to, 0, bytes);
        }
    return code;
}

static int make_pass(RetexView *view, int scale, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads), height = (view->set->height + scale - 1) / scale;
    MakeWork work = {view, scale, NULL};
    int code = RETEX_OK, count = 0;
    for (int i = 0; i < view->nimages && !code; i++) {
        RetexViewImage *image = &view->images[i];
        if (!is_of_pass(image, scale))
            continue;
        code = retex_image_alloc(&image->kept, image->width, image->height, image->channels, err);
        count++;
    }
    if (code || !count)
        return code;
    if (!(work.readers = calloc((size_t)threads, sizeof *work.readers)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    code = retex_jobs_run(threads, (height + ROWS_A_JOB - 1) / ROWS_A_JOB, make_job, &work, err);
    for (int i = 0; i < threads; i++)
        if (work.readers[i].view)
            retex_view_reader_close(&work.readers[i]);
    free(work.readers);
    for (int i = 0; i < view->nimages && !code; i++)
        view->images[i].is_made |= is_of_pass(&view->images[i], scale);
    return code;
}

int retex_view_make(RetexView *view, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    for (int scale = RETEX_SCALE_MAX; scale > 1 && !code; scale /= 2)
        code = make_pass(view, scale, nthreads, err);
    return code;
}
