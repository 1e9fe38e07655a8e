/* See pending_files.h. */
#include "io/pending_files.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/image.h>
#include <retex/output_file.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static RetexPendingFile *files; /* under lock */
static _Atomic(void (*)(void)) also;

void retex_pending_files_set_hook(void (*remove)(void))
{
    atomic_store(&also, remove);
}

void retex_pending_files_lock(void)
{
    pthread_mutex_lock(&lock);
}

void retex_pending_files_unlock(void)
{
    pthread_mutex_unlock(&lock);
}

void retex_pending_files_add(RetexPendingFile *file, const char *path)
{
    file->path = path;
    file->next = files;
    files = file;
}

void retex_pending_files_drop(RetexPendingFile *file)
{
    for (RetexPendingFile **at = &files; *at; at = &(*at)->next)
        if (*at == file) {
            *at = file->next;
            return;
        }
}

/* The lock is never released: no file gets a name any more. A thread that holds it for long waits for a disk. */
void retex_pending_files_remove(void)
{
    const struct timespec until = retex_clock_time_after(0.5);
    void (*others)(void) = atomic_load(&also);

    if (others)
        others();
    if (pthread_mutex_timedlock(&lock, &until) != 0)
        return;
    for (const RetexPendingFile *file = files; file; file = file->next)
        unlink(file->path);
}
