/* See polynomial_bands.h. */
#include "retexture/polynomial_bands.h"

#include <stdlib.h>

#include <retex/parallel.h>

#include "base/jobs.h"
#include "set/set.h"

typedef struct BandThread {
    RetexPolynomialRow row; /* opened when the thread has its first band */
    float *rgb;
} BandThread;

typedef struct BandWork {
    const RetexPolynomial *polynomial;
    int y0, y1; /* of the picture */
    RetexPolynomialBand *make;
    const void *context;
    RetexRowSink *sink;
    void *sink_context;
    BandThread *threads;
} BandWork;

static int band_job(void *context, int index, int thread, RetexError *err)
{
    const BandWork *work = context;
    BandThread *own = &work->threads[thread];
    /* bands begin at multiples of their height, wherever the region does */
    const int first = (work->y0 / RETEX_PICTURE_BAND + index) * RETEX_PICTURE_BAND, end = first + RETEX_PICTURE_BAND;
    const int y0 = first > work->y0 ? first : work->y0, y1 = end < work->y1 ? end : work->y1;
    const size_t count = 3 * (size_t)work->polynomial->set->width * RETEX_PICTURE_BAND;
    int code = own->row.polynomial ? RETEX_OK : retex_polynomial_row_open(&own->row, work->polynomial, err);
    if (!code && !own->rgb && !(own->rgb = malloc(sizeof *own->rgb * count)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (!code)
        code = work->make(work->context, &own->row, y0, y1, own->rgb, err);
    return code ? code : work->sink(work->sink_context, y0, y1, own->rgb, err);
}

int retex_polynomial_bands(const RetexPolynomial *polynomial, int y0, int y1, RetexPolynomialBand *make,
                           const void *context, RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    BandWork work = {polynomial, y0, y1, make, context, sink, sink_context, NULL};
    int code = RETEX_OK;
    if (!(work.threads = calloc((size_t)threads, sizeof *work.threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (y1 > y0)
        code =
            retex_jobs_run(threads, (y1 - 1) / RETEX_PICTURE_BAND - y0 / RETEX_PICTURE_BAND + 1, band_job, &work, err);
    for (int i = 0; i < threads; i++) {
        retex_polynomial_row_close(&work.threads[i].row);
        free(work.threads[i].rgb);
    }
    free(work.threads);
    return code;
}
