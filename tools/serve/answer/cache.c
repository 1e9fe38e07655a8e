/* See cache.h. A hash table with chains, and a list in the order of use. */
#include "serve/answer/cache.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "http/hash.h"

enum { CHAINS = 4096, LARGEST_SHARE = 8 };

typedef struct Entry {
    struct Entry *next_in_chain;
    struct Entry *older, *newer;
    char *key;
    Answer *answer;
    size_t bytes; /* of the answer, the key and the entry */
} Entry;

struct Cache {
    pthread_mutex_t lock;
    size_t most, bytes, count;
    Entry *newest, *oldest;
    Entry *chains[CHAINS];
};

Cache *cache_open(size_t most_bytes)
{
    Cache *cache = calloc(1, sizeof *cache);
    if (!cache)
        return NULL;
    pthread_mutex_init(&cache->lock, NULL);
    cache->most = most_bytes;
    return cache;
}

static Entry **find_place(Cache *cache, const char *key)
{
    Entry **place = &cache->chains[hash_text(HASH_BEGIN, key) % CHAINS];
    while (*place && strcmp((*place)->key, key) != 0)
        place = &(*place)->next_in_chain;
    return place;
}

static void remove_from_order(Cache *cache, Entry *entry)
{
    *(entry->older ? &entry->older->newer : &cache->oldest) = entry->newer;
    *(entry->newer ? &entry->newer->older : &cache->newest) = entry->older;
    entry->older = entry->newer = NULL;
}

static void make_newest(Cache *cache, Entry *entry)
{
    entry->older = cache->newest;
    *(cache->newest ? &cache->newest->newer : &cache->oldest) = entry;
    cache->newest = entry;
}

static void remove_entry(Cache *cache, Entry *entry)
{
    *find_place(cache, entry->key) = entry->next_in_chain;
    remove_from_order(cache, entry);
    cache->bytes -= entry->bytes;
    cache->count--;
    answer_release(entry->answer);
    free(entry->key);
    free(entry);
}

void cache_close(Cache *cache)
{
    if (!cache)
        return;
    while (cache->oldest)
        remove_entry(cache, cache->oldest);
    pthread_mutex_destroy(&cache->lock);
    free(cache);
}

Answer *cache_find(Cache *cache, const char *key)
{
    Answer *answer = NULL;
    pthread_mutex_lock(&cache->lock);
    Entry *entry = *find_place(cache, key);
    if (entry) {
        remove_from_order(cache, entry);
        make_newest(cache, entry);
        answer = answer_hold(entry->answer);
    }
    pthread_mutex_unlock(&cache->lock);
    return answer;
}

static Entry *new_entry(const char *key, Answer *answer, size_t bytes)
{
    Entry *entry = calloc(1, sizeof *entry);
    char *copy = strdup(key);
    if (!entry || !copy) {
        free(entry);
        free(copy);
        return NULL;
    }
    *entry = (Entry){.key = copy, .answer = answer_hold(answer), .bytes = bytes};
    return entry;
}

void cache_add(Cache *cache, const char *key, Answer *answer)
{
    const size_t bytes = answer->bytes + strlen(key) + sizeof(Entry) + sizeof *answer;
    if (bytes > cache->most / LARGEST_SHARE)
        return;
    pthread_mutex_lock(&cache->lock);
    Entry *old = *find_place(cache, key), *entry = new_entry(key, answer, bytes);
    if (old)
        remove_entry(cache, old);
    if (entry) {
        *find_place(cache, key) = entry;
        make_newest(cache, entry);
        cache->bytes += bytes;
        cache->count++;
    }
    while (cache->bytes > cache->most)
        remove_entry(cache, cache->oldest);
    pthread_mutex_unlock(&cache->lock);
}

void cache_count(Cache *cache, size_t *entries, size_t *bytes)
{
    pthread_mutex_lock(&cache->lock);
    *entries = cache->count;
    *bytes = cache->bytes;
    pthread_mutex_unlock(&cache->lock);
}
