/* Threads: jobs are handed out by one atomic counter to threads that live for one call.
 *
 * Starting a thread costs some 20 microseconds, nothing beside the images the jobs work on, and there is no pool whose
 * life time, nesting and forking would have to be thought about. Which thread does a job never shows in its result. */
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

/* Take indices until none is left. The counter cannot overflow: each thread goes past count once at most. */
static void work_through(Work *work, int thread)
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

    work_through(worker->work, worker->number);
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
            break; /* those already running, and this one, do it all */
        started++;
    }
    work_through(&work, 0);
    for (int i = 0; i < started; i++)
        pthread_join(workers[i].thread, NULL);
}
