/* The log: one line of JSON a request on standard error. */
#ifndef RETEX_SERVE_LOG_H
#define RETEX_SERVE_LOG_H

#include "serve/http/metrics.h"

typedef struct LogLine {
    const char *method, *path, *client;
    int status;
    unsigned long long bytes; /* of the answer, without headers */
    double seconds;
    CacheUse cache;
    const char *error; /* why, of a request that failed; or NULL */
} LogLine;

/* Write a line with one system call, so that lines of different threads do not mix. */
void log_request(const LogLine *line);

#endif
