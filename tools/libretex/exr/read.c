/* Reading flat EXR parts, by channel name, on all threads.
 *
 * OpenEXRCore parses headers and finds chunks; decode.c decodes them. The first thing that is wrong ends the
 * reading. */
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "io/checksum.h"
#include "exr/decode.h"

enum { JOB_LINES = 16 }; /* chunks of one line that are read as one job */

static int64_t core_read(exr_const_context_t context, void *data, void *buffer, uint64_t bytes, uint64_t offset,
                         exr_stream_error_func_ptr_t report)
{
    const RetexExr *exr = data;

    (void)context;
    (void)report;
    return retex_input_read(exr->input, buffer, (size_t)bytes, offset);
}

static int64_t core_size(exr_const_context_t context, void *data)
{
    const RetexExr *exr = data;

    (void)context;
    return (int64_t)retex_input_size(exr->input);
}

int retex_exr_probe(const RetexInput *input)
{
    static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    unsigned char begin[4];

    return retex_input_read(input, begin, sizeof begin, 0) == sizeof begin && memcmp(begin, magic, sizeof magic) == 0;
}

int retex_exr_open(RetexExr **result, RetexInput *input, RetexError *err)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    RetexExr *exr;
    int status = 0;

    *result = NULL;
    if (!retex_exr_probe(input))
        return retex_input_check(
            input, retex_fail(err, RETEX_EFORMAT, "%s is not an OpenEXR file", retex_input_name(input)), err);
    exr = calloc(1, sizeof *exr);
    if (!exr)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", retex_input_name(input));
    pthread_mutex_init(&exr->message.lock, NULL);
    exr->input = input;
    settings.error_handler_fn = retex_exr_message;
    settings.alloc_fn = retex_exr_alloc;
    settings.free_fn = free;
    settings.user_data = exr;
    settings.read_fn = core_read;
    settings.size_fn = core_size;
    settings.max_image_width = settings.max_image_height = RETEX_MAX_SIZE;
    settings.max_tile_width = settings.max_tile_height = RETEX_MAX_SIZE;
    /* a set with missing chunks is useless, so Core must not search for them */
    settings.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    (void)retex_exr_alloc_failed();
    exr_result_t code = exr_start_read(&exr->context, retex_input_name(input), &settings);
    if (!code)
        code = exr_get_count(exr->context, &exr->nparts);
    if (retex_exr_alloc_failed())
        code = EXR_ERR_OUT_OF_MEMORY;
    if (code)
        status = retex_exr_fail(exr, code, err);
    else if (exr->nparts < 1 || exr->nparts > RETEX_EXR_PARTS_MAX)
        status = retex_fail(err, RETEX_EFORMAT, "%s has %d parts, more than %d", retex_input_name(input), exr->nparts,
                            RETEX_EXR_PARTS_MAX);
    if (status)
        retex_exr_close(&exr);
    *result = exr;
    return status;
}

void retex_exr_close(RetexExr **result)
{
    RetexExr *exr = result ? *result : NULL;

    if (!exr)
        return;
    if (exr->context)
        exr_finish(&exr->context);
    pthread_mutex_destroy(&exr->message.lock);
    free(exr);
    *result = NULL;
}

/* Some rows of chunks of one request. */
typedef struct RetexJob {
    RetexExrPlan *plan;
    int first, count;
    uint32_t crc[RETEX_EXR_LETTERS_MAX];
} RetexJob;

typedef struct DecodeWork {
    RetexExr *exr;
    RetexJob *jobs;
    RetexExrScratch *scratch; /* one a thread */
    atomic_int code;          /* the first failure, an exr_result_t */
    RetexExrNonFinite bad;    /* the value, where the failure is RETEX_EXR_NON_FINITE */
} DecodeWork;

static void read_chunks(DecodeWork *work, RetexJob *job, const RetexExrSums *sums, int thread)
{
    for (int row = job->first; row < job->first + job->count; row++)
        for (int column = 0; column < job->plan->across; column++) {
            if (atomic_load_explicit(&work->code, memory_order_relaxed))
                return; /* another job has failed: the result is not needed any more */
            const exr_result_t code = retex_exr_chunk_read(work->exr, job->plan, column, row, job->plan->request->image,
                                                           0, sums, &work->scratch[thread]);
            if (code) {
                int none = 0;
                if (atomic_compare_exchange_strong(&work->code, &none, code)) {
                    job->plan->request->damaged = 1;
                    work->bad = work->scratch[thread].bad;
                }
                return;
            }
        }
}

static void run_job(void *context, int index, int thread)
{
    DecodeWork *work = context;
    RetexJob *job = &work->jobs[index];
    const RetexExrPlan *plan = job->plan;
    const int top = job->first * plan->chunk_height, most = job->count * plan->chunk_height;
    const int lines = plan->height - top < most ? plan->height - top : most;
    RetexExrSums sums = {NULL, top, plan->across > 1 ? 1 : lines};

    if (!plan->request->with_crc) {
        read_chunks(work, job, NULL, thread);
        return;
    }
    sums.crc = calloc((size_t)(lines / sums.lines), sizeof *sums.crc);
    if (sums.crc)
        read_chunks(work, job, &sums, thread);
    else
        atomic_store(&work->code, EXR_ERR_OUT_OF_MEMORY);
    for (int to = 0; sums.crc && to < RETEX_EXR_LETTERS_MAX; to++)
        job->crc[to] = retex_exr_sums_plane(plan, &sums, to, top, top + lines, NULL);
    free(sums.crc);
}

/* The number of rows of chunks in one job. */
static int job_rows(const RetexExrPlan *plan)
{
    return plan->chunk_height >= JOB_LINES ? 1 : JOB_LINES / plan->chunk_height;
}

static RetexJob *make_jobs(RetexExrPlan *plans, int nplans, int *count)
{
    size_t total = 0, next = 0;

    for (int i = 0; i < nplans; i++)
        total += (size_t)((plans[i].down + job_rows(&plans[i]) - 1) / job_rows(&plans[i]));
    RetexJob *jobs = calloc(total, sizeof *jobs);
    for (int i = 0; jobs && i < nplans; i++)
        for (int row = 0; row < plans[i].down; row += job_rows(&plans[i])) {
            RetexJob *job = &jobs[next++];
            job->plan = &plans[i];
            job->first = row;
            job->count = plans[i].down - row < job_rows(&plans[i]) ? plans[i].down - row : job_rows(&plans[i]);
        }
    *count = (int)total;
    return jobs;
}

/* Combines the jobs' checksums: planes one after another, each from the top. */
static void combine_crcs(const RetexJob *jobs, int njobs)
{
    for (int first = 0, end; first < njobs; first = end) {
        const RetexExrPlan *plan = jobs[first].plan;
        uint32_t crc = CRC32_OF_NONE;
        for (end = first; end < njobs && jobs[end].plan == plan; end++)
            continue;
        for (int to = 0; to < RETEX_EXR_LETTERS_MAX && plan->request->with_crc; to++)
            for (int c = 0; c < plan->nchannels; c++) {
                if (plan->image_channel[c] != to)
                    continue;
                for (int j = first; j < end; j++) {
                    const int y = jobs[j].first * plan->chunk_height, rest = plan->height - y;
                    const int lines = jobs[j].count * plan->chunk_height;
                    const size_t bytes = (size_t)plan->width * retex_exr_channel_bytes(&plan->channels[c]);
                    crc = retex_crc32_join(crc, jobs[j].crc[to], bytes * (size_t)(lines < rest ? lines : rest));
                }
            }
        plan->request->crc = crc;
    }
}

/* Fills err with the failure of a chunk and the name of its part. */
static int fail_chunk(RetexExr *exr, const RetexExrPlan *plans, int nplans, exr_result_t code,
                      const RetexExrNonFinite *bad, RetexError *err)
{
    const char *name = NULL;

    for (int i = 0; i < nplans; i++)
        if (plans[i].request->damaged) {
            if (code == RETEX_EXR_NON_FINITE)
                return retex_exr_fail_nonfinite(exr, plans[i].request->part, bad, err);
            exr_get_name(exr->context, plans[i].request->part, &name);
        }
    if (code != EXR_ERR_OUT_OF_MEMORY && name)
        return retex_input_check(
            exr->input,
            retex_fail(err, RETEX_EFORMAT, "%s: part %s is damaged or truncated: %s", retex_input_name(exr->input),
                       name, exr->message.text[0] ? exr->message.text : exr_get_default_error_message(code)),
            err);
    return retex_exr_fail(exr, code, err);
}

static int run_jobs(RetexExr *exr, RetexExrPlan *plans, int nplans, int nthreads, RetexError *err)
{
    DecodeWork work = {.exr = exr};
    int njobs = 0;

    nthreads = retex_threads(nthreads);
    work.jobs = make_jobs(plans, nplans, &njobs);
    work.scratch = calloc((size_t)nthreads, sizeof *work.scratch);
    if (!work.jobs || !work.scratch)
        atomic_store(&work.code, EXR_ERR_OUT_OF_MEMORY);
    else
        retex_parallel(nthreads, njobs, run_job, &work);
    const exr_result_t code = atomic_load(&work.code);
    if (!code)
        combine_crcs(work.jobs, njobs);
    for (int i = 0; work.scratch && i < nthreads; i++)
        retex_exr_scratch_free(&work.scratch[i]);
    free(work.scratch);
    free(work.jobs);
    return code ? fail_chunk(exr, plans, nplans, code, &work.bad, err) : 0;
}

int retex_exr_read(RetexExr *exr, RetexExrRequest *requests, int nrequests, int nthreads, RetexError *err)
{
    RetexExrPlan *plans;
    int code = 0;

    if (nrequests == 0)
        return 0;
    plans = calloc((size_t)nrequests, sizeof *plans);
    if (!plans)
        return retex_exr_fail(exr, EXR_ERR_OUT_OF_MEMORY, err);
    for (int i = 0; i < nrequests && !code; i++)
        code = retex_exr_plan_open(exr, &plans[i], &requests[i], err);
    if (!code)
        code = run_jobs(exr, plans, nrequests, nthreads, err);
    for (int i = 0; i < nrequests; i++)
        retex_exr_plan_close(&plans[i]);
    free(plans);
    return code;
}
