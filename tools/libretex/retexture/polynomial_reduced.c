/* See polynomial_reduced.h. All images of one size are made together, row by row, so that a footprint that several
 * mixtures use is filtered once and its parts are read once. */
#include "retexture/polynomial_reduced.h"

#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "base/jobs.h"
#include "retexture/polynomial_factors.h"
#include "set/set.h"

#define ROWS_A_JOB 64 /* a pack's strip */

typedef struct ReducedWork {
    const RetexPolynomial *polynomial;
    const int *slots; /* slots of the images to make */
    int nslots, width, height;
    struct ReducedThread *threads;
} ReducedWork;

/* The state of one thread, and the row that it works on. */
typedef struct ReducedThread {
    const ReducedWork *work;
    RetexRowReader *reader;
    RetexRowBuffer *buffers; /* by slot, for footprints, allocated when needed */
    const float **rows;      /* by slot; NULL: black */
    char *made;              /* by slot: 1 if rows has it */
    float *weights;
    RetexRowBuffer colors; /* of a mixture */
} ReducedThread;

static int footprint_row(void *context, RetexFactor footprint, int y, const float **row, RetexError *err)
{
    ReducedThread *own = context;
    const ReducedWork *work = own->work;
    const int slot = retex_polynomial_slot(work->polynomial->set, footprint);
    int code = RETEX_OK;
    if (!own->made[slot]) {
        RetexRowBuffer *buffer = &own->buffers[slot];
        RetexRowSpan span;
        if (!buffer->values && !(buffer->values = calloc(3 * (size_t)work->width, sizeof *buffer->values)))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
        code = retex_polynomial_footprint_row(work->polynomial, own->reader, footprint, y, buffer, &own->rows[slot],
                                              &span, err);
        own->made[slot] = !code;
    }
    *row = own->rows[slot];
    return code;
}

/* Gives the row of a mixture, made in `sum`, of a footprint's colours, or of an image; NULL where it is black. */
static int factor_row(ReducedThread *own, RetexFactor factor, int y, RetexRowBuffer *sum, const float **row,
                      RetexError *err)
{
    *row = sum->values;
    if (factor.kind == RETEX_FACTOR_MIXTURE)
        return retex_polynomial_mixture_row(own->work->polynomial, own->reader, factor, y, footprint_row, own,
                                            own->weights, sum, err);
    return factor.kind == RETEX_FACTOR_FOOTPRINT ? footprint_row(own, factor, y, row, err)
                                                 : retex_row_reader_get(own->reader, factor.index, y, row, err);
}

static int make_row(ReducedThread *own, int slot, int y, RetexError *err)
{
    const RetexPolynomial *p = own->work->polynomial;
    const RetexFactor factor = retex_polynomial_factor(p->set, slot);
    RetexImage *image = &p->reduced[slot];
    float *out = image->pixels + retex_image_index(image, 0, y);
    RetexRowBuffer made = {.values = out}; /* which is 0 before */
    const float *row;
    if (factor.quantity == RETEX_QUANTITY_FURTHER) {
        int code = factor_row(own, retex_factor(factor.kind, factor.index), y, &own->colors, &row, err);
        return code ? code : retex_polynomial_further_row(p, own->reader, factor, y, row, own->weights, &made, err);
    }
    int code = factor_row(own, factor, y, &made, &row, err);
    if (!code && row && row != out)
        memcpy(out, row, sizeof *out * (size_t)image->width * (size_t)image->channels);
    return code;
}

static int open_thread(const ReducedWork *work, ReducedThread *own, RetexError *err)
{
    const RetexSet *set = work->polynomial->set;
    const size_t count = (size_t)retex_polynomial_slot_count(set) + 1;
    if (own->work)
        return RETEX_OK;
    own->work = work;
    own->buffers = calloc(count, sizeof *own->buffers);
    own->rows = calloc(count, sizeof *own->rows);
    own->made = calloc(count, 1);
    own->weights = malloc(sizeof *own->weights * 3 * (size_t)work->width);
    own->colors.values = calloc(3 * (size_t)work->width, sizeof *own->colors.values);
    if (!own->buffers || !own->rows || !own->made || !own->weights || !own->colors.values)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    return retex_row_reader_open(&own->reader, set, work->polynomial->samples, err);
}

static void close_thread(const ReducedWork *work, ReducedThread *own)
{
    for (int i = 0; own->buffers && i < retex_polynomial_slot_count(work->polynomial->set); i++)
        free(own->buffers[i].values);
    free(own->buffers);
    free(own->rows);
    free(own->made);
    free(own->weights);
    free(own->colors.values);
    retex_row_reader_close(&own->reader);
}

static int make_job(void *context, int index, int thread, RetexError *err)
{
    const ReducedWork *work = context;
    ReducedThread *own = &work->threads[thread];
    int code = open_thread(work, own, err);
    for (int y = index * ROWS_A_JOB; !code && y < (index + 1) * ROWS_A_JOB && y < work->height; y++) {
        memset(own->made, 0, (size_t)retex_polynomial_slot_count(work->polynomial->set));
        for (int i = 0; i < work->nslots && !code; i++)
            code = make_row(own, work->slots[i], y, err);
    }
    return code;
}

static int make_all(ReducedWork *work, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    if (!(work->threads = calloc((size_t)threads, sizeof *work->threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    int code = retex_jobs_run(threads, (work->height + ROWS_A_JOB - 1) / ROWS_A_JOB, make_job, work, err);
    for (int i = 0; i < threads; i++)
        close_thread(work, &work->threads[i]);
    free(work->threads);
    return code;
}

int retex_polynomial_reduced_make(RetexPolynomial *p, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    int *slots = calloc((size_t)retex_polynomial_slot_count(p->set) + 1, sizeof *slots);
    if (!slots)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int scale = RETEX_SCALE_MAX; scale > 1 && !code; scale /= 2) {
        ReducedWork work = {.polynomial = p, .slots = slots};
        for (int slot = 0; slot < retex_polynomial_slot_count(p->set); slot++) {
            const RetexImage *image = &p->reduced[slot];
            if (!image->pixels || retex_set_scale(p->set, image) != scale)
                continue;
            slots[work.nslots++] = slot;
            work.width = image->width;
            work.height = image->height;
        }
        if (work.nslots)
            code = make_all(&work, nthreads, err);
    }
    free(slots);
    return code;
}
