/* Work that takes long: a queue of limited length, and the threads that do it. Requests for the same thing at the same
 * time are one piece of work. */
#ifndef RETEX_SERVE_WORK_H
#define RETEX_SERVE_WORK_H

#include "serve/answer/answer.h"
#include "serve/request/request.h"
#include "serve/files/uploads.h"

typedef struct Work Work;

/* A request that waits. done is called once, from another thread, with the answer, or NULL if there was no memory for
 * one; the answer is to be released. */
typedef struct Waiter {
    struct Waiter *next;
    void (*done)(struct Waiter *waiter, Answer *answer);
    int has_joined; /* 1: the work was that of an earlier request; known when done is called */
} Waiter;

/* What is to be made: the request, with the key that two requests for the same thing have in common. */
typedef struct WorkItem {
    ServeRequest request;
    char base[SERVE_BASE_MAX]; /* beginning of the server's own URLs */
    double deadline; /* of retex_clock_seconds */
    const char *key;
    const void *body; /* of an upload: the waiter's, until done is called */
    size_t bytes;
    char hash[UPLOAD_HASH_TEXT]; /* of the body */
} WorkItem;

/* Make the answer, on so many threads. NULL: no memory. */
typedef Answer *WorkMake(void *context, const WorkItem *item, int nthreads);

typedef struct WorkParams {
    WorkMake *make;
    void *context;
    int threads; /* of all work together, which is also the number of pieces of work at a time */
    int queue;   /* pieces of work that wait, at most, while all threads are busy */
} WorkParams;

typedef enum WorkResult { WORK_ACCEPTED, WORK_REFUSED, WORK_NO_MEMORY } WorkResult;

int work_open(Work **work, const WorkParams *params, RetexError *err);
/* Finish what was accepted, then end the threads. */
void work_close(Work *work);

/* Copies the item and its key. WORK_REFUSED: the queue is full, or work_refuse was called; `waiter` is then not
 * called. */
WorkResult work_add(Work *work, const WorkItem *item, Waiter *waiter);
/* Accept no more work. */
void work_refuse(Work *work);

typedef struct WorkCount {
    int waiting, running, limit;
} WorkCount;
WorkCount work_count(Work *work);

#endif
