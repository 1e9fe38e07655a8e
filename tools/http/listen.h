/* The socket on which the server listens. */
#ifndef RETEX_HTTP_LISTEN_H
#define RETEX_HTTP_LISTEN_H

#include <retex/error.h>

/* A socket that listens, and its port, where 0 lets the system choose; or -1. */
int listen_on(const char *address, int port, int *bound_port, RetexError *err);

#endif
