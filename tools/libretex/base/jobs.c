/* See jobs.h. */
#include "base/jobs.h"

#include <stdatomic.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

typedef struct Jobs {
    RetexJob *job;
    void *context;
    atomic_int code;
    RetexError err; /* error of the job whose code `code` is */
} Jobs;

static void run_job(void *context, int index, int thread)
{
    Jobs *jobs = context;
    RetexError err = {0};
    int none = RETEX_OK;
    if (atomic_load(&jobs->code))
        return;
    const int code = jobs->job(jobs->context, index, thread, &err);
    RETEX_ASSERT(code <= 0 && code == err.code); /* who fails says why */
    if (code && atomic_compare_exchange_strong(&jobs->code, &none, code))
        jobs->err = err;
}

int retex_jobs_run(int nthreads, int count, RetexJob *job, void *context, RetexError *err)
{
    Jobs jobs = {.job = job, .context = context};
    retex_parallel(nthreads, count, run_job, &jobs);
    if (jobs.code && err)
        *err = jobs.err;
    return jobs.code;
}
