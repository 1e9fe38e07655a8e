/* Files that are opened once and stay open as long as all together keep within a limit, those that were used last
 * first. A file that is replaced is opened again when it is asked for the next time. Rooms and images of textures are
 * such; each has Kept as its first member. */
#ifndef RETEX_SERVE_KEPT_H
#define RETEX_SERVE_KEPT_H

#include <pthread.h>

#include "serve/files/content.h"

typedef struct Kept {
    struct Kept *next;
    FileId id;
    unsigned long long bytes; /* in memory, or reserved */
    unsigned long long used;  /* number of the last use */
    int users;
    int is_ready; /* 0 while it is being opened */
    int is_stale; /* its file was replaced, or could not be opened: closed when nobody uses it */
} Kept;

typedef struct KeptList {
    /* what is kept: set before kept_begin */
    unsigned long long most_bytes;
    int most;                                             /* number */
    int (*is_of)(const Kept *kept, const void *key);      /* whether it is that of the key */
    Kept *(*create)(const void *key, const void *params); /* not opened yet, from malloc; NULL: no memory */
    void (*close)(Kept *kept);                            /* all but Kept itself, which is then freed */
    const void *params;

    pthread_mutex_t lock;   /* protects all below, and all of Kept but what is_ready says is complete */
    pthread_cond_t changed; /* something was opened, or could not be */
    Kept *first;
    unsigned long long bytes, uses, opened, failed; /* opened and failed: since the start */
    int count;
} KeptList;

void kept_begin(KeptList *list);
void kept_end(KeptList *list); /* when nothing is in use */

/* Use what the key names, whose file is now `id`, once no other thread is opening it. *is_new: the caller has to open
 * it, and then to call kept_opened. NULL: no memory. */
Kept *kept_take(KeptList *list, const void *key, const FileId *id, int *is_new);
/* The same, if it is there and ready; or NULL. Never waits. */
Kept *kept_peek(KeptList *list, const void *key, const FileId *id);
/* It takes so many bytes, or could not be opened: then it is no longer in use, and gone. `content`: what was read;
 * where that is another file than the one asked for, or one that changes just now, nobody else gets it. */
void kept_opened(KeptList *list, Kept *kept, int failed, const Content *content, unsigned long long bytes);
void kept_return(KeptList *list, Kept *kept); /* NULL is fine */

/* Close what nobody uses, what was used least recently first, until so many more bytes are within the limit. The caller
 * holds the lock. */
void kept_make_space(KeptList *list, unsigned long long bytes);

#endif
