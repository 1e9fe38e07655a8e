/* The HTTP side, on libmicrohttpd: connections, headers, and requests that wait for work. One thread accepts, reads and
 * writes; it never waits for a picture. */
#ifndef RETEX_SERVE_HTTP_H
#define RETEX_SERVE_HTTP_H

#include "serve/clients/address.h"
#include "serve/clients/keys.h"
#include "serve/http/metrics.h"
#include "serve/site/site.h"

typedef struct HttpParams {
    const char *address; /* to listen on, "127.0.0.1", "::1" */
    int port;            /* 0: the system chooses */
    int connections;     /* at most */
    int per_client;      /* connections of one client, at most; 0 = any number, of uploads too */
    Trusted proxies;     /* whose clients are counted instead of themselves */
    Keys keys;           /* by one of which URLs must be signed; none: they are not */
    double min_rate;     /* bytes a second of an image, at least */
    double timeout;      /* seconds within which a request must arrive, and after which a silent connection is closed */
    double deadline;     /* seconds within which a picture must be made */
    int max_age;         /* seconds for which others may keep an answer without asking again */
    const char *base;    /* beginning of the server's own URLs, or NULL: by who is in `proxies`, or its address */
    int is_quiet;        /* 1: requests are not logged */
    const Site *site;
    Work *pictures; /* work that makes pictures */
    Work *uploads;  /* work that decodes images of strangers, which so never delays other pictures; NULL: no uploads */
    Work *texts;    /* and work that needs no pixels, which so never waits for a picture */
} HttpParams;

typedef struct Http Http;

int http_open(Http **http, const HttpParams *params, RetexError *err);
/* The port that is listened on. */
int http_port(const Http *http);
/* Close connections that are too slow, delete uploads that are too old. To be called a few times a second. */
void http_sweep(Http *http);
/* Accept no more connections and requests. */
void http_refuse(Http *http);
/* Number of requests that have no complete answer yet. */
int http_pending(Http *http);
/* Close all connections; nothing may wait for work any more. */
void http_close(Http *http);

#endif
