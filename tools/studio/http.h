/* HTTP: a thread for each connection, since one user has few. It reads a request, asks the gate, and calls what answers
 * it. */
#ifndef RETEX_STUDIO_HTTP_H
#define RETEX_STUDIO_HTTP_H

#include "request.h"

typedef struct Http Http;

/* Listen on 127.0.0.1; the port becomes that of studio->gate. */
int http_open(Http **http, Studio *studio, int port, RetexError *err);
/* Answers that are on their way have two seconds to arrive. All that wait must have been woken: changes_end. */
void http_close(Http **http);

#endif
