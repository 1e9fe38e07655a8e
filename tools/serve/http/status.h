/* What the server has, waits for and uses, as Prometheus reads it: the answer to /metrics. */
#ifndef RETEX_SERVE_STATUS_H
#define RETEX_SERVE_STATUS_H

#include "serve/http/metrics.h"
#include "serve/site/site.h"

typedef struct StatusSources {
    Metrics *metrics;
    int connections; /* that are open */
    const Site *site;
    Work *pictures, *uploads; /* the second may be NULL */
} StatusSources;

Answer *status_answer(const StatusSources *sources); /* NULL: no memory */

#endif
