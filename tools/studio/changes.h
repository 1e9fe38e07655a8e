/* What happens in the server, as a number that grows: each thing that a window can see (the project, the model, a job,
 * a picture) keeps the number of its last change, and a window asks for what has changed since a number. So nothing is
 * queued for a window that is slow. One lock guards all that changes. */
#ifndef RETEX_STUDIO_CHANGES_H
#define RETEX_STUDIO_CHANGES_H

#include <pthread.h>
#include <stdint.h>

#include <retex/error.h>

typedef struct Changes {
    pthread_mutex_t lock;
    pthread_cond_t happened;
    uint64_t number; /* of the last change; 0: nothing has changed yet */
    int is_ending;   /* 1: nobody waits any more */
    int wake;        /* an eventfd, by which the thread that runs programs is woken */
} Changes;

int changes_open(Changes *changes, RetexError *err);
void changes_close(Changes *changes);

void changes_lock(Changes *changes);
void changes_unlock(Changes *changes);

/* ---- with the lock ---- */

/* The number of a change that happens now; all who wait are woken. */
uint64_t changes_note(Changes *changes);
/* Wait until something changes, at most until a time of retex_clock_seconds. 0: that time has come, or the server
 * ends. */
int changes_wait(Changes *changes, double until);
void changes_end(Changes *changes);

/* ---- with or without it ---- */

/* Wake the thread that runs programs. */
void changes_wake(Changes *changes);

#endif
