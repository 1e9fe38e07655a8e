/* Work spread over threads that may fail. Private to libretex. */
#ifndef RETEX_BASE_JOBS_H
#define RETEX_BASE_JOBS_H

#include <retex/error.h>

/* A job returns 0 or a negative RetexCode. */
typedef int RetexJob(void *context, int index, int thread, RetexError *err);

/* Like retex_parallel. Once a job has failed no other job begins; the result is the code and error of the first job
 * that failed. */
int retex_jobs_run(int nthreads, int count, RetexJob *job, void *context, RetexError *err);

#endif
