/* What the files of the HTTP side share: the server, connections, and one request with its answer. */
#ifndef RETEX_SERVE_EXCHANGE_H
#define RETEX_SERVE_EXCHANGE_H

#include <stdatomic.h>
#include <stdint.h>
#include <sys/socket.h>

#include <microhttpd.h>

#include "serve/http/body.h"
#include "serve/clients/clients.h"
#include "serve/http/http.h"
#include "serve/clients/peers.h"

struct Http {
    HttpParams params;
    Metrics metrics;
    Clients *clients;
    Peers *peers;
    struct MHD_Daemon *daemon;
    int port;
    atomic_int pending, is_refusing;
};

typedef struct Connection {
    Client *client;
    Address address;
    int is_proxy; /* 1: of a proxy that is trusted, which asks for others */
    Peer *peer;   /* which has this connection; NULL: a proxy */
} Connection;

/* One request, from its first line to the end of its answer. */
typedef struct Exchange {
    Waiter waiter; /* first member */
    Http *http;
    struct MHD_Connection *connection;
    char *url;           /* as it came */
    const char *path;    /* the same without its signature; NULL: it is not signed, but has to be */
    const char *url_end; /* behind it, where it came */
    char method[16];
    Address client;
    Peer *peer;     /* which has asked for it through a proxy, or NULL */
    Peer *uploader; /* which sends an image, or NULL */
    double began;
    ServeRequest request;
    Body body; /* of an upload */
    Answer *answer;
    CacheUse cache;
    int is_begun; /* 1: all headers have come */
    int status;   /* of what was sent; 0 = nothing */
    unsigned long long bytes;
} Exchange;

/* NULL: there was no memory for one. */
Connection *exchange_connection(const Exchange *exchange);
/* Of several of that name the first; NULL: there is none. */
const char *exchange_header(const Exchange *exchange, const char *name);
/* Whether it is the URL to which images are sent. */
int exchange_is_of_uploads(const Exchange *exchange);
/* Beginning of the server's own URLs in answers of IIIF; "" elsewhere. */
const char *exchange_base(const Exchange *exchange, char text[SERVE_BASE_MAX]);

/* Send the exchange's answer, or of a picture the part that is asked for. */
enum MHD_Result exchange_send(Exchange *exchange);

#endif
