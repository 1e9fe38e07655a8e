/* Counts of what the server has done, as Prometheus reads them. Any thread may call. */
#ifndef RETEX_SERVE_METRICS_H
#define RETEX_SERVE_METRICS_H

#include <stdatomic.h>
#include <stdio.h>

#include "serve/request/request.h"

enum {
    METRICS_ROUTES = SERVE_UPLOAD + 2, /* the last one: no route */
    METRICS_STATUSES = 22,                 /* the last one: all others */
    METRICS_BUCKETS = 13
};

/* Where an answer came from. */
typedef enum CacheUse { CACHE_NONE, CACHE_HIT, CACHE_MISS, CACHE_JOINED, CACHE_UNCHANGED, CACHE_USES } CacheUse;
/* "hit", "miss", … or "none" */
const char *cache_use_name(CacheUse use);

/* Zero-initialized. */
typedef struct Metrics {
    atomic_ullong requests[METRICS_ROUTES][METRICS_STATUSES];
    atomic_ullong buckets[METRICS_BUCKETS + 1]; /* not cumulative; the last one: longer than all */
    atomic_ullong microseconds, bytes;
    atomic_ullong caches[CACHE_USES];
} Metrics;

/* route: a ServeRoute, or -1 for a request that has none */
void metrics_add(Metrics *metrics, int route, int status, double seconds, unsigned long long bytes, CacheUse cache);

/* One gauge or counter, with its HELP and TYPE. */
void metrics_write_value(FILE *file, const char *name, const char *type, const char *help, double value);
/* All of the above. */
void metrics_write(FILE *file, const Metrics *metrics);

#endif
