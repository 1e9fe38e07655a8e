/* See metrics.h. */
#include "serve/http/metrics.h"

static const int statuses[METRICS_STATUSES - 1] = {200, 201, 204, 206, 303, 304, 400, 403, 404, 405, 406,
                                                   412, 413, 414, 415, 416, 431, 500, 501, 503, 507};
static const double limits[METRICS_BUCKETS] = {.001, .0025, .005, .01, .025, .05, .1, .25, .5, 1, 2.5, 5, 10};
static const char *const routes[METRICS_ROUTES] = {"health",     "metrics",   "rooms",     "room",
                                                   "picture",    "thumbnail", "texture",   "iiif_base",
                                                   "iiif_info",  "iiif_image", "upload",   "none"};

const char *cache_use_name(CacheUse use)
{
    static const char *const names[CACHE_USES] = {"none", "hit", "miss", "joined", "unchanged"};
    return names[use];
}

void metrics_add(Metrics *metrics, int route, int status, double seconds, unsigned long long bytes, CacheUse cache)
{
    int s = 0, b = 0;
    while (s < METRICS_STATUSES - 1 && statuses[s] != status)
        s++;
    while (b < METRICS_BUCKETS && seconds > limits[b])
        b++;
    atomic_fetch_add(&metrics->requests[route >= 0 && route < METRICS_ROUTES ? route : METRICS_ROUTES - 1][s], 1);
    atomic_fetch_add(&metrics->buckets[b], 1);
    atomic_fetch_add(&metrics->microseconds, (unsigned long long)(1e6 * seconds));
    atomic_fetch_add(&metrics->bytes, bytes);
    atomic_fetch_add(&metrics->caches[cache], 1);
}

static void write_head(FILE *file, const char *name, const char *type, const char *help)
{
    fprintf(file, "# HELP retex_serve_%s %s\n# TYPE retex_serve_%s %s\n", name, help, name, type);
}

void metrics_write_value(FILE *file, const char *name, const char *type, const char *help, double value)
{
    write_head(file, name, type, help);
    fprintf(file, "retex_serve_%s %.17g\n", name, value);
}

static void write_requests(FILE *file, const Metrics *metrics)
{
    write_head(file, "requests_total", "counter", "Requests that were answered, by route and status.");
    for (int r = 0; r < METRICS_ROUTES; r++)
        for (int s = 0; s < METRICS_STATUSES; s++) {
            const unsigned long long count = atomic_load(&metrics->requests[r][s]);
            char status[16] = "other";
            if (s < METRICS_STATUSES - 1)
                snprintf(status, sizeof status, "%d", statuses[s]);
            if (count)
                fprintf(file, "retex_serve_requests_total{route=\"%s\",status=\"%s\"} %llu\n", routes[r], status,
                        count);
        }
}

static void write_histogram(FILE *file, const Metrics *metrics)
{
    unsigned long long sum = 0;
    write_head(file, "request_seconds", "histogram", "Time from the request to the end of its answer.");
    for (int b = 0; b <= METRICS_BUCKETS; b++) {
        sum += atomic_load(&metrics->buckets[b]);
        if (b < METRICS_BUCKETS)
            fprintf(file, "retex_serve_request_seconds_bucket{le=\"%g\"} %llu\n", limits[b], sum);
        else
            fprintf(file, "retex_serve_request_seconds_bucket{le=\"+Inf\"} %llu\n", sum);
    }
    fprintf(file, "retex_serve_request_seconds_sum %.6f\nretex_serve_request_seconds_count %llu\n",
            1e-6 * (double)atomic_load(&metrics->microseconds), sum);
}

void metrics_write(FILE *file, const Metrics *metrics)
{
    write_requests(file, metrics);
    write_histogram(file, metrics);
    metrics_write_value(file, "sent_bytes_total", "counter", "Bytes of answers, without headers.",
                        (double)atomic_load(&metrics->bytes));
    write_head(file, "cache_total", "counter",
               "Requests by where their answer came from: kept, made, made for another request, not sent again.");
    for (int use = CACHE_HIT; use < CACHE_USES; use++)
        fprintf(file, "retex_serve_cache_total{cache=\"%s\"} %llu\n", cache_use_name((CacheUse)use),
                atomic_load(&metrics->caches[use]));
}
