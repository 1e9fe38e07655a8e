/* See changes.h. */
#include "changes.h"

#include <errno.h>
#include <string.h>
#include <time.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <retex/clock.h>

int changes_open(Changes *changes, RetexError *err)
{
    *changes = (Changes){.wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
    if (changes->wake < 0)
        return retex_fail(err, RETEX_EIO, "cannot make an eventfd: %s", strerror(errno));
    pthread_mutex_init(&changes->lock, NULL);
    pthread_cond_init(&changes->happened, NULL);
    return RETEX_OK;
}

void changes_close(Changes *changes)
{
    pthread_cond_destroy(&changes->happened);
    pthread_mutex_destroy(&changes->lock);
    close(changes->wake);
}

void changes_lock(Changes *changes)
{
    pthread_mutex_lock(&changes->lock);
}

void changes_unlock(Changes *changes)
{
    pthread_mutex_unlock(&changes->lock);
}

uint64_t changes_note(Changes *changes)
{
    pthread_cond_broadcast(&changes->happened);
    return ++changes->number;
}

int changes_wait(Changes *changes, double until)
{
    const double left = until - retex_clock_seconds();
    if (left <= 0 || changes->is_ending)
        return 0;
    const struct timespec time = retex_clock_time_after(left);
    return pthread_cond_timedwait(&changes->happened, &changes->lock, &time) == 0 && !changes->is_ending;
}

void changes_end(Changes *changes)
{
    changes->is_ending = 1;
    pthread_cond_broadcast(&changes->happened);
    changes_wake(changes);
}

void changes_wake(Changes *changes)
{
    const uint64_t one = 1;
    (void)!write(changes->wake, &one, sizeof one);
}
