/* See studio.h. */
#include "request.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>

#include "http/head.h"
#include "http/listen.h"

enum { CONNECTIONS = 200, SILENT_SECONDS = 120, TEXT_BYTES = 4 << 20, REST = 4096 };

/* Of all but the page: what is sent is data, also where a window is led to it. */
#define POLICY "default-src 'none'; sandbox; frame-ancestors 'none'"

struct Http {
    Studio *studio;
    struct MHD_Daemon *daemon;
    atomic_int exchanges; /* requests that have no complete answer yet */
    Strangers strangers;
};

/* A request that is being received. */
typedef struct Exchange {
    Request request;
    const Route *route;
    Reply refusal; /* of one whose body is not read, or not kept; status 0: none */
    size_t space;  /* of the body */
    char rest[REST];
} Exchange;

/* ---- what is refused by its head ---- */

static enum MHD_Result look_at_field(void *context, enum MHD_ValueKind kind, const char *name, const char *value)
{
    (void)kind;
    head_field(context, name, value);
    return MHD_YES;
}

static int refuse_head(Exchange *exchange, const char *version)
{
    HeadCheck check;
    head_begin(&check, exchange->request.method, "/", NULL, version, 0);
    (void)MHD_get_connection_values(exchange->request.connection, MHD_HEADER_KIND, look_at_field, &check);
    if (!head_end(&check))
        return 0;
    exchange->refusal = reply_error(check.status, "%s", check.fault);
    return 1;
}

static int refuse_stranger(Exchange *exchange, const char *url)
{
    Request *request = &exchange->request;
    const char *why = NULL;
    request->path = gate_enter(&request->studio->gate, url, request_header(request, "Host"),
                               request_header(request, "Origin"), &why);
    if (!request->path)
        exchange->refusal = reply_error(MHD_HTTP_FORBIDDEN, "%s", why);
    return !request->path;
}

static int refuse_path(Exchange *exchange)
{
    Request *request = &exchange->request;
    int other_method = 0;
    exchange->route = route_find(request->method, request->path, exchange->rest, REST, &other_method);
    request->rest = exchange->rest;
    if (!exchange->route && other_method)
        exchange->refusal = reply_error(MHD_HTTP_METHOD_NOT_ALLOWED, "this address takes another method");
    else if (!exchange->route)
        exchange->refusal = reply_error(MHD_HTTP_NOT_FOUND, "there is nothing at this address");
    else if (exchange->route->receive)
        return exchange->route->receive(request, &exchange->refusal);
    else if (request_length(request) > TEXT_BYTES)
        exchange->refusal = reply_error(MHD_HTTP_CONTENT_TOO_LARGE, "this is more than %d MB", TEXT_BYTES >> 20);
    return exchange->refusal.status != 0;
}

/* ---- bodies ---- */

/* Memory for a body grows by half, so that a length that is only announced takes none. */
static int keep_text(Exchange *exchange, const char *data, size_t bytes)
{
    Request *request = &exchange->request;
    if (request->bytes + bytes > TEXT_BYTES) {
        exchange->refusal = reply_error(MHD_HTTP_CONTENT_TOO_LARGE, "this is more than %d MB", TEXT_BYTES >> 20);
        return -1;
    }
    if (request->bytes + bytes + 1 > exchange->space) {
        const size_t space = request->bytes + bytes + 1 + exchange->space / 2;
        char *body = realloc(request->body, space);
        if (!body) {
            exchange->refusal = reply_error(MHD_HTTP_INTERNAL_SERVER_ERROR, "not enough memory");
            return -1;
        }
        request->body = body;
        exchange->space = space;
    }
    memcpy(request->body + request->bytes, data, bytes);
    request->bytes += bytes;
    request->body[request->bytes] = 0;
    return 0;
}

static void keep_body(Exchange *exchange, const char *data, size_t bytes)
{
    RetexError err = {0};
    if (exchange->refusal.status) /* the rest of it is not kept */
        return;
    if (!exchange->route->receive) {
        keep_text(exchange, data, bytes);
    } else if (received_bytes(&exchange->request.received, data, bytes, &err)) {
        received_drop(&exchange->request.received);
        exchange->refusal = reply_of_received(&err);
    }
}

/* ---- connections ---- */

static int socket_of(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info ? info->connect_fd : -1;
}

static void look_at_connection(void *context, struct MHD_Connection *connection, void **state,
                               enum MHD_ConnectionNotificationCode what)
{
    Http *http = context;
    (void)state;
    if (what == MHD_CONNECTION_NOTIFY_STARTED)
        strangers_add(&http->strangers, socket_of(connection));
    else
        strangers_remove(&http->strangers, socket_of(connection));
}

/* ---- answers ---- */

static enum MHD_Result send_reply(struct MHD_Connection *connection, Reply reply)
{
    if (!reply.response)
        return MHD_NO;
    reply_header(&reply, "X-Content-Type-Options", "nosniff");
    reply_header(&reply, "Referrer-Policy", "no-referrer");
    reply_header(&reply, "Cross-Origin-Resource-Policy", "same-origin");
    if (!MHD_get_response_header(reply.response, "Content-Security-Policy"))
        reply_header(&reply, "Content-Security-Policy", POLICY);
    if (!MHD_get_response_header(reply.response, "Cache-Control"))
        reply_header(&reply, "Cache-Control", "no-store");
    const enum MHD_Result result = MHD_queue_response(connection, (unsigned)reply.status, reply.response);
    MHD_destroy_response(reply.response);
    return result;
}

static enum MHD_Result send_refusal(Exchange *exchange)
{
    const Reply refusal = exchange->refusal;
    exchange->refusal = (Reply){.status = refusal.status};
    return send_reply(exchange->request.connection, refusal);
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *data, size_t *bytes, void **state)
{
    Http *http = context;
    Exchange *exchange = *state;
    if (!exchange) {
        *state = exchange = calloc(1, sizeof *exchange);
        if (!exchange)
            return MHD_NO;
        atomic_fetch_add(&http->exchanges, 1);
        exchange->request = (Request){.studio = http->studio, .connection = connection, .method = method};
        if (refuse_head(exchange, version) || refuse_stranger(exchange, url) || refuse_path(exchange))
            return send_refusal(exchange);
        strangers_remove(&http->strangers, socket_of(connection));
        return MHD_YES;
    }
    exchange->request.connection = connection;
    if (*bytes) {
        keep_body(exchange, data, *bytes);
        *bytes = 0;
        return MHD_YES;
    }
    return exchange->refusal.status ? send_refusal(exchange)
                                    : send_reply(connection, exchange->route->answer(&exchange->request));
}

static void complete(void *context, struct MHD_Connection *connection, void **state,
                     enum MHD_RequestTerminationCode why)
{
    Http *http = context;
    Exchange *exchange = *state;
    (void)connection;
    (void)why;
    if (!exchange)
        return;
    atomic_fetch_sub(&http->exchanges, 1);
    received_drop(&exchange->request.received);
    if (exchange->refusal.response)
        MHD_destroy_response(exchange->refusal.response);
    free(exchange->request.body);
    free(exchange);
    *state = NULL;
}

int http_open(Http **http, Studio *studio, int port, RetexError *err)
{
    const int file = listen_on("127.0.0.1", port, &studio->gate.port, err);
    if (file < 0)
        return err ? err->code : RETEX_EIO;
    *http = calloc(1, sizeof **http);
    if (*http) {
        (*http)->studio = studio;
        strangers_open(&(*http)->strangers);
        (*http)->daemon = MHD_start_daemon(
            MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL | MHD_USE_ITC, 0, NULL, NULL,
            handle, *http, MHD_OPTION_LISTEN_SOCKET, file, MHD_OPTION_NOTIFY_COMPLETED, complete, *http,
            MHD_OPTION_NOTIFY_CONNECTION, look_at_connection, *http, MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS,
            MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)SILENT_SECONDS, MHD_OPTION_END);
    }
    if (*http && (*http)->daemon)
        return RETEX_OK;
    free(*http);
    *http = NULL;
    close(file);
    return retex_fail(err, RETEX_EIO, "cannot start the server of HTTP");
}

void http_close(Http **http)
{
    enum { LOOKS = 200, LOOK_NANOSECONDS = 10000000 };
    const struct timespec look = {.tv_nsec = LOOK_NANOSECONDS};
    if (!*http)
        return;
    const MHD_socket file = MHD_quiesce_daemon((*http)->daemon);
    for (int k = 0; k < LOOKS && atomic_load(&(*http)->exchanges); k++)
        nanosleep(&look, NULL);
    MHD_stop_daemon((*http)->daemon);
    if (file != MHD_INVALID_SOCKET)
        close(file);
    strangers_close(&(*http)->strangers);
    free(*http);
    *http = NULL;
}
