/* A request, as the calls that answer it see it. */
#ifndef RETEX_STUDIO_REQUEST_H
#define RETEX_STUDIO_REQUEST_H

#include <microhttpd.h>
#include <stdlib.h>

#include "received.h"
#include "reply.h"
#include "studio.h"

typedef struct Request {
    Studio *studio;
    struct MHD_Connection *connection;
    const char *method;
    const char *path; /* after the token, decoded: "api/state" */
    const char *rest; /* what the route leaves open of it, such as the number of a job; or "" */
    char *body;       /* ends with a NUL, which is not counted */
    size_t bytes;
    Received received; /* the body, where it is a file */
} Request;

/* The value of `?name=`, decoded; NULL: it is not there. */
static inline const char *request_query(const Request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

static inline const char *request_header(const Request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_HEADER_KIND, name);
}

/* The bytes of the body that are announced, or 0. */
static inline uint64_t request_length(const Request *request)
{
    const char *length = request_header(request, "Content-Length");
    return length ? strtoull(length, NULL, 10) : 0;
}

/* The reply to a file that could not be kept. */
Reply reply_of_received(const RetexError *err);

/* What is answered: a row for each method and path. */
typedef struct Route {
    const char *method;
    const char *path; /* `*` stands for what it leaves open: "api/jobs/" "*" "/stop" */
    Reply (*answer)(Request *request);
    /* The body is a file, for which this prepares request->received; or NULL. Not 0: it is refused by the reply. */
    int (*receive)(Request *request, Reply *reply);
} Route;

/* NULL: there is none; *other_method: whether there is one of another method. `rest` of `size` bytes gets what the path
 * leaves open. */
const Route *route_find(const char *method, const char *path, char *rest, size_t size, int *other_method);

#endif
