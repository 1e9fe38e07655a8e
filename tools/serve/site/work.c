/* See work.h. */
#include "serve/site/work.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <retex/clock.h>
#include <retex/parallel.h>

/* A piece of work: in the list of its state until its waiters have the answer. */
typedef struct Piece {
    struct Piece *next;
    WorkItem item;
    Waiter *waiters;
} Piece;

struct Work {
    WorkParams params;
    pthread_mutex_t lock; /* protects all below */
    pthread_cond_t arrived;
    Piece *waiting, **waiting_end;
    Piece *running;
    int nwaiting, nrunning, is_closed, is_refusing;
    int nthreads;
    pthread_t threads[256];
};

static Piece *find(Work *work, const char *key)
{
    for (Piece *piece = work->waiting; piece; piece = piece->next)
        if (strcmp(piece->item.key, key) == 0)
            return piece;
    for (Piece *piece = work->running; piece; piece = piece->next)
        if (strcmp(piece->item.key, key) == 0)
            return piece;
    return NULL;
}

static Piece *new_piece(const WorkItem *item)
{
    Piece *piece = malloc(sizeof *piece);
    char *key = piece ? strdup(item->key) : NULL;
    if (!key) {
        free(piece);
        return NULL;
    }
    *piece = (Piece){.item = *item};
    piece->item.key = key;
    return piece;
}

static void append(Work *work, Piece *piece)
{
    *work->waiting_end = piece;
    work->waiting_end = &piece->next;
    work->nwaiting++;
    pthread_cond_signal(&work->arrived);
}

WorkResult work_add(Work *work, const WorkItem *item, Waiter *waiter)
{
    WorkResult result = WORK_ACCEPTED;
    pthread_mutex_lock(&work->lock);
    Piece *piece = find(work, item->key);
    waiter->has_joined = piece != NULL;
    if (!piece && (work->nwaiting + work->nrunning >= work->nthreads + work->params.queue || work->is_refusing)) {
        result = WORK_REFUSED;
    } else if (!piece) {
        piece = new_piece(item);
        result = piece ? WORK_ACCEPTED : WORK_NO_MEMORY;
        if (piece)
            append(work, piece);
    }
    if (piece) {
        waiter->next = piece->waiters;
        piece->waiters = waiter;
    }
    pthread_mutex_unlock(&work->lock);
    return result;
}

void work_refuse(Work *work)
{
    pthread_mutex_lock(&work->lock);
    work->is_refusing = 1;
    pthread_mutex_unlock(&work->lock);
}

/* ---- threads ---- */

/* Take the first piece that waits; NULL: there will be none. */
static Piece *take(Work *work, int *nthreads)
{
    pthread_mutex_lock(&work->lock);
    while (!work->waiting && !work->is_closed)
        pthread_cond_wait(&work->arrived, &work->lock);
    Piece *piece = work->waiting;
    if (piece) {
        work->waiting = piece->next;
        if (!work->waiting)
            work->waiting_end = &work->waiting;
        work->nwaiting--;
        piece->next = work->running;
        work->running = piece;
        work->nrunning++;
    }
    /* what nobody else asks for is done by all */
    const int busy = work->nrunning + work->nwaiting;
    *nthreads = busy < work->params.threads && busy > 0 ? work->params.threads / busy : 1;
    pthread_mutex_unlock(&work->lock);
    return piece;
}

static void finish(Work *work, Piece *piece, Answer *answer)
{
    pthread_mutex_lock(&work->lock);
    Piece **place = &work->running;
    while (*place != piece)
        place = &(*place)->next;
    *place = piece->next;
    work->nrunning--;
    pthread_mutex_unlock(&work->lock);
    for (Waiter *waiter = piece->waiters, *next; waiter; waiter = next) { /* nobody else can reach them now */
        next = waiter->next;
        waiter->done(waiter, answer ? answer_hold(answer) : NULL);
    }
    answer_release(answer);
    free((char *)piece->item.key);
    free(piece);
}

static void *run(void *context)
{
    Work *work = context;
    int nthreads;
    for (Piece *piece; (piece = take(work, &nthreads));) {
        Answer *answer;
        if (retex_clock_seconds() > piece->item.deadline)
            answer = answer_error(503, "the server is busy");
        else
            answer = work->params.make(work->params.context, &piece->item, nthreads);
        finish(work, piece, answer);
    }
    return NULL;
}

int work_open(Work **result, const WorkParams *params, RetexError *err)
{
    Work *work = *result = calloc(1, sizeof *work);
    if (!work)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for the queue");
    work->params = *params;
    work->params.threads = retex_threads(params->threads);
    work->waiting_end = &work->waiting;
    pthread_mutex_init(&work->lock, NULL);
    pthread_cond_init(&work->arrived, NULL);
    while (work->nthreads < work->params.threads &&
           pthread_create(&work->threads[work->nthreads], NULL, run, work) == 0)
        work->nthreads++;
    if (work->nthreads)
        return RETEX_OK;
    work_close(work);
    *result = NULL;
    return retex_fail(err, RETEX_EIO, "no thread can be started");
}

void work_close(Work *work)
{
    if (!work)
        return;
    pthread_mutex_lock(&work->lock);
    work->is_closed = work->is_refusing = 1;
    pthread_cond_broadcast(&work->arrived);
    pthread_mutex_unlock(&work->lock);
    for (int i = 0; i < work->nthreads; i++)
        pthread_join(work->threads[i], NULL);
    pthread_cond_destroy(&work->arrived);
    pthread_mutex_destroy(&work->lock);
    free(work);
}

WorkCount work_count(Work *work)
{
    pthread_mutex_lock(&work->lock);
    const WorkCount count = {work->nwaiting, work->nrunning, work->params.queue};
    pthread_mutex_unlock(&work->lock);
    return count;
}
