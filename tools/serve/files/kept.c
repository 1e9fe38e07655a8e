/* See kept.h. */
#include "serve/files/kept.h"

#include <stdlib.h>

void kept_begin(KeptList *list)
{
    pthread_mutex_init(&list->lock, NULL);
    pthread_cond_init(&list->changed, NULL);
}

static void remove_kept(KeptList *list, Kept *kept)
{
    Kept **place = &list->first;
    while (*place != kept)
        place = &(*place)->next;
    *place = kept->next;
    list->bytes -= kept->bytes;
    list->count--;
    list->close(kept);
    free(kept);
}

void kept_end(KeptList *list)
{
    while (list->first)
        remove_kept(list, list->first);
    pthread_cond_destroy(&list->changed);
    pthread_mutex_destroy(&list->lock);
}

void kept_make_space(KeptList *list, unsigned long long bytes)
{
    while (list->bytes + bytes > list->most_bytes || list->count >= list->most) {
        Kept *oldest = NULL;
        for (Kept *kept = list->first; kept; kept = kept->next)
            if (!kept->users && (!oldest || kept->used < oldest->used))
                oldest = kept;
        if (!oldest)
            return;
        remove_kept(list, oldest);
    }
}

static Kept *find(const KeptList *list, const void *key)
{
    for (Kept *kept = list->first; kept; kept = kept->next)
        if (!kept->is_stale && list->is_of(kept, key))
            return kept;
    return NULL;
}

static Kept *use(KeptList *list, Kept *kept)
{
    kept->users++;
    kept->used = ++list->uses;
    return kept;
}

/* Give up one use; what is stale goes with its last user. */
static void release(KeptList *list, Kept *kept)
{
    if (--kept->users == 0 && kept->is_stale)
        remove_kept(list, kept);
}

static Kept *add(KeptList *list, const void *key, const FileId *id)
{
    kept_make_space(list, 0);
    Kept *kept = list->create(key, list->params);
    if (!kept)
        return NULL;
    kept->id = *id;
    kept->next = list->first;
    list->first = kept;
    list->count++;
    return kept;
}

Kept *kept_take(KeptList *list, const void *key, const FileId *id, int *is_new)
{
    pthread_mutex_lock(&list->lock);
    Kept *kept = find(list, key);
    while (kept && !kept->is_ready) {
        pthread_cond_wait(&list->changed, &list->lock);
        kept = find(list, key);
    }
    if (kept && !file_id_is_same(&kept->id, id)) {
        kept->is_stale = 1;
        if (!kept->users)
            remove_kept(list, kept);
        kept = NULL;
    }
    *is_new = !kept;
    if (!kept)
        kept = add(list, key, id);
    if (kept)
        use(list, kept);
    pthread_mutex_unlock(&list->lock);
    return kept;
}

Kept *kept_peek(KeptList *list, const void *key, const FileId *id)
{
    pthread_mutex_lock(&list->lock);
    Kept *kept = find(list, key);
    kept = kept && kept->is_ready && file_id_is_same(&kept->id, id) ? use(list, kept) : NULL;
    pthread_mutex_unlock(&list->lock);
    return kept;
}

void kept_opened(KeptList *list, Kept *kept, int failed, const Content *content, unsigned long long bytes)
{
    pthread_mutex_lock(&list->lock);
    *(failed ? &list->failed : &list->opened) += 1;
    if (failed) {
        kept->is_stale = 1;
        release(list, kept);
    } else {
        kept->is_ready = 1;
        kept->is_stale = !content->is_settled || !file_id_is_same(&kept->id, &content->id);
        kept->bytes = bytes;
        list->bytes += bytes;
        kept_make_space(list, 0);
    }
    pthread_cond_broadcast(&list->changed);
    pthread_mutex_unlock(&list->lock);
}

void kept_return(KeptList *list, Kept *kept)
{
    if (!kept)
        return;
    pthread_mutex_lock(&list->lock);
    release(list, kept);
    kept_make_space(list, 0);
    pthread_mutex_unlock(&list->lock);
}
