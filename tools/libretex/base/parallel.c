/* Threads: one atomic counter hands out jobs to threads that live for one call. Starting a thread takes some 20
 * microseconds, little beside jobs on images, and without a thread pool there is no question of its life time, of
 * nesting and of forking. The result does not depend on which thread runs a job. */
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

#include <retex/parallel.h>

enum { MAX_THREADS = 256 };

typedef struct Work {
    atomic_int next; /* the first index not handed out yet */
    int count;
    void (*job)(void *context, int index, int thread);
    void *context;
} Work;

typedef struct Worker {
    pthread_t thread;
    Work *work;
    int number;
} Worker;

int retex_threads(int nthreads)
{
    if (nthreads <= 0) {
        /* The affinity mask, not the number of cores in the machine: taskset and containers narrow it. */
        cpu_set_t allowed;
        if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
            nthreads = CPU_COUNT(&allowed);
        else
            nthreads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    }
    return nthreads < 1 ? 1 : nthreads > MAX_THREADS ? MAX_THREADS : nthreads;
}

/* Runs jobs until no index is left. The counter cannot overflow: each thread goes beyond count at most once. */
static void run_jobs(Work *work, int thread)
{
    for (;;) {
        const int index = atomic_fetch_add_explicit(&work->next, 1, memory_order_relaxed);
        if (index >= work->count || index < 0)
            return;
        work->job(work->context, index, thread);
    }
}

static void *worker_main(void *argument)
{
    const Worker *worker = argument;

    run_jobs(worker->work, worker->number);
    return NULL;
}

void retex_parallel(int nthreads, int count, void (*job)(void *context, int index, int thread), void *context)
{
    Work work = {0, count, job, context};
    Worker workers[MAX_THREADS];
    int started = 0;

    nthreads = retex_threads(nthreads);
    if (nthreads > count)
        nthreads = count;
    for (int number = 1; number < nthreads; number++) {
        Worker *worker = &workers[started];
        worker->work = &work;
        worker->number = number;
        if (pthread_create(&worker->thread, NULL, worker_main, worker) != 0)
            break; /* the threads that run already, and this one, do all jobs */
        started++;
    }
    run_jobs(&work, 0);
    for (int i = 0; i < started; i++)
        pthread_join(workers[i].thread, NULL);
}
