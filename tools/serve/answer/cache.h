/* Finished pictures, by key: those that were used last, in a limited number of bytes. Any thread may call. */
#ifndef RETEX_SERVE_CACHE_H
#define RETEX_SERVE_CACHE_H

#include "serve/answer/answer.h"

typedef struct Cache Cache;

Cache *cache_open(size_t most_bytes); /* NULL: no memory */
void cache_close(Cache *cache);

/* The answer of that key, to be released by the caller; or NULL. */
Answer *cache_find(Cache *cache, const char *key);
/* Keep an answer; the caller keeps its use of it. One that is larger than an eighth of the cache is not kept. */
void cache_add(Cache *cache, const char *key, Answer *answer);

void cache_count(Cache *cache, size_t *entries, size_t *bytes);

#endif
