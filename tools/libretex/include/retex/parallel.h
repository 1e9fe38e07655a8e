/* Threads: how the library spreads work, for callers that would do the same. */
#ifndef RETEX_PARALLEL_H
#define RETEX_PARALLEL_H

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Number of threads meant by nthreads: itself, or all cores this process may use when it is 0 or negative; 1..256. */
int retex_threads(int nthreads);

/* Run job(context, index, thread) once for every index 0..count-1, on up to nthreads threads (0 = all cores; the
 * caller is one of them); thread is 0..retex_threads(nthreads)-1 and no two jobs run at once with the same one. Jobs
 * are handed out in order of index. Falls back to fewer threads where the system gives no more; never fails. */
void retex_parallel(int nthreads, int count, void (*job)(void *context, int index, int thread), void *context);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
