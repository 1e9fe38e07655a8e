/* Work spread over threads that may fail. Private to libretex. */
#ifndef RETEX_BASE_JOBS_H
#define RETEX_BASE_JOBS_H

#include <retex/error.h>

/* Returns 0 or a negative RetexCode. */
typedef int RetexJob(void *context, int index, int thread, RetexError *err);

/* As retex_parallel; once a job has failed no other begins, and code and error are those of the first that did. */
int retex_jobs_run(int nthreads, int count, RetexJob *job, void *context, RetexError *err);

#endif
