/* See strips.h. */
#include "retexture/strips.h"

#include <stdlib.h>

#include <retex/parallel.h>

#include "base/jobs.h"
#include "set/set.h"

typedef struct StripThread {
    RetexViewReader reader; /* opened when the thread has its first strip */
    float *rgb;
} StripThread;

typedef struct StripWork {
    const RetexView *view;
    int y0, y1; /* of the picture */
    RetexStripMake *make;
    const void *context;
    RetexRowSink *sink;
    void *sink_context;
    StripThread *threads;
} StripWork;

static int strip_job(void *context, int index, int thread, RetexError *err)
{
    const StripWork *work = context;
    StripThread *own = &work->threads[thread];
    /* strips begin at multiples of their height, wherever the region does */
    const int first = (work->y0 / RETEX_PICTURE_STRIP + index) * RETEX_PICTURE_STRIP, end = first + RETEX_PICTURE_STRIP;
    const int y0 = first > work->y0 ? first : work->y0, y1 = end < work->y1 ? end : work->y1;
    const size_t count = 3 * (size_t)work->view->set->width * RETEX_PICTURE_STRIP;
    int code = own->reader.view ? RETEX_OK : retex_view_reader_open(&own->reader, work->view, err);
    if (!code && !own->rgb && !(own->rgb = malloc(sizeof *own->rgb * count)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (!code)
        code = work->make(work->context, &own->reader, y0, y1, own->rgb, err);
    return code ? code : work->sink(work->sink_context, y0, y1, own->rgb, err);
}

int retex_view_strips(const RetexView *view, int y0, int y1, RetexStripMake *make, const void *context,
                      RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    StripWork work = {view, y0, y1, make, context, sink, sink_context, NULL};
    int code = RETEX_OK;
    if (!(work.threads = calloc((size_t)threads, sizeof *work.threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (y1 > y0)
        code = retex_jobs_run(threads, (y1 - 1) / RETEX_PICTURE_STRIP - y0 / RETEX_PICTURE_STRIP + 1, strip_job, &work,
                              err);
    for (int i = 0; i < threads; i++) {
        if (work.threads[i].reader.view)
            retex_view_reader_close(&work.threads[i].reader);
        free(work.threads[i].rgb);
    }
    free(work.threads);
    return code;
}
