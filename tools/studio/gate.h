/* Who may ask: the user's own browser, in a page of this server. Pages of other sites can make it send requests to any
 * address (CSRF), by names of their own too (DNS rebinding), and others of this machine can reach every port: so a
 * request must name this server, come from a page of it or from none, and know the token. */
#ifndef RETEX_STUDIO_GATE_H
#define RETEX_STUDIO_GATE_H

#include <pthread.h>

#include <retex/error.h>

enum { GATE_TOKEN = 32 }; /* hexadecimal digits: 128 bits */

typedef struct Gate {
    int port;
    char token[GATE_TOKEN + 1];
} Gate;

/* A new token, of the system's random numbers. */
int gate_open(Gate *gate, RetexError *err);

/* What follows `/TOKEN/` in a URL's path, or NULL and why the request is refused. host and origin are the headers, or
 * NULL. */
const char *gate_enter(const Gate *gate, const char *url, const char *host, const char *origin, const char **why);

/* Connections by which nobody has shown the token yet: anybody of this machine can open them. They may not take the
 * places of the user's, so there are few, and the oldest is closed for a new one. */
enum { STRANGERS_MOST = 64 };

typedef struct Strangers {
    pthread_mutex_t lock;
    int sockets[STRANGERS_MOST]; /* the oldest first */
    int count;
} Strangers;

void strangers_open(Strangers *strangers);
void strangers_close(Strangers *strangers);

/* A new connection. */
void strangers_add(Strangers *strangers, int socket);
/* It has shown the token, or is closed, before its socket is. */
void strangers_remove(Strangers *strangers, int socket);

#endif
