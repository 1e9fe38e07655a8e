/* See http.h. */
#include "serve/http/http.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include <retex/clock.h>

#include "serve/http/exchange.h"
#include "http/head.h"
#include "http/headers.h"
#include "serve/request/hints.h"
#include "serve/request/iiif.h"
#include "http/listen.h"
#include "serve/http/log.h"
#include "serve/site/picture.h"
#include "serve/http/status.h"
#include "serve/request/parse.h"

enum { CONNECTION_BYTES = 48 << 10 };

/* Versions beyond 0.9.76 refuse by themselves what refuse_head does not see in them. In earlier ones the option for
 * strictness does nothing that refuse_head does not, but sends the head of its answers twice. */
#if MHD_VERSION > 0x00097600
#define DISCIPLINE MHD_OPTION_CLIENT_DISCIPLINE_LVL, 2
#else
#define DISCIPLINE MHD_OPTION_STRICT_FOR_CLIENT, 0
#endif

static void set_state(const Exchange *exchange, ClientState state)
{
    const Connection *connection = exchange_connection(exchange);
    clients_set(exchange->http->clients, connection ? connection->client : NULL, state);
}

/* ---- answers that need no work ---- */

static Answer *health_answer(void)
{
    char *text = strdup("ok\n");
    return text ? answer_new(200, "text/plain; charset=utf-8", text, 3) : NULL;
}

static Answer *redirect_answer(const Exchange *exchange)
{
    static const char info[] = "/info.json";
    char base[SERVE_BASE_MAX], url[IIIF_URL_MAX];
    iiif_id(url, &exchange->request, exchange_base(exchange, base));
    char *location = malloc(strlen(url) + sizeof info);
    Answer *answer = location ? answer_error(303, "see info.json") : NULL;
    if (!answer) {
        free(location);
        return NULL;
    }
    strcpy(location, url);
    strcat(location, info);
    answer->location = location;
    answer->reason[0] = '\0';
    return answer;
}

/* ---- work ---- */

/* In a thread of the queue. When the connection is resumed, the exchange may end at once. */
static void work_done(Waiter *waiter, Answer *answer)
{
    Exchange *exchange = (Exchange *)(void *)waiter;
    exchange->answer = answer;
    exchange->cache = waiter->has_joined ? CACHE_JOINED : CACHE_MISS;
    MHD_resume_connection(exchange->connection);
}

static Answer *unchanged_answer(const char *etag)
{
    Answer *answer = answer_new(200, "", NULL, 0); /* which choose_part makes a 304 */
    if (answer)
        strcpy(answer->etag, etag);
    return answer;
}

static int is_unchanged(const Exchange *exchange, char etag[ETAG_SIZE])
{
    const char *had = exchange_header(exchange, "If-None-Match");
    return had && site_known_etag(exchange->http->params.site, &exchange->request, etag) && header_has_etag(had, etag);
}

/* Have the answer made: the connection is suspended until it is. 0: the exchange has its answer, or none for lack of
 * memory. */
static int wait_for_work(Exchange *exchange, const char *key, const char *base)
{
    Http *http = exchange->http;
    const SiteWork kind = site_work_of(http->params.site, &exchange->request);
    Work *work = kind == SITE_UPLOAD    ? http->params.uploads
                 : kind == SITE_PICTURE ? http->params.pictures
                                        : http->params.texts;
    WorkItem *item = calloc(1, sizeof *item);
    if (!item)
        return 0;
    item->request = exchange->request;
    snprintf(item->base, sizeof item->base, "%s", base);
    item->deadline = retex_clock_seconds() + http->params.deadline;
    item->key = key;
    item->body = exchange->body.data;
    item->bytes = exchange->body.bytes;
    snprintf(item->hash, sizeof item->hash, "%s", exchange->request.route == SERVE_UPLOAD ? key : "");
    exchange->waiter.done = work_done;
    MHD_suspend_connection(exchange->connection);
    const WorkResult result = work_add(work, item, &exchange->waiter);
    free(item);
    if (result != WORK_ACCEPTED)
        work_done(&exchange->waiter, answer_error(503, "the server is busy"));
    return 1;
}

/* Give the exchange its answer, or let it wait for work: 1. */
static int begin_work(Exchange *exchange)
{
    const Site *site = exchange->http->params.site;
    char key[SITE_KEY_MAX], base_text[SERVE_BASE_MAX], etag[ETAG_SIZE];
    const char *base = exchange_base(exchange, base_text);
    exchange->answer = site_key(site, &exchange->request, base, key);
    if (exchange->answer)
        return 0;
    exchange->answer = cache_find(site->pictures, key);
    if (exchange->answer) {
        exchange->cache = CACHE_HIT;
        return 0;
    }
    if (is_unchanged(exchange, etag)) {
        exchange->answer = unchanged_answer(etag);
        exchange->cache = CACHE_UNCHANGED;
        return 0;
    }
    return wait_for_work(exchange, key, base);
}

/* ---- what is refused by its headers ---- */

/* libmicrohttpd up to 0.9.76 keeps a head as it came, but for NULs at its divisions. Later versions check it
 * themselves, see DISCIPLINE. */
static int keeps_head(void)
{
    const char *version = MHD_get_version();
    return strncmp(version, "0.9.7", 5) == 0 && version[5] <= '6';
}

typedef struct Fields {
    HeadCheck check;
    const char *forwarded; /* the last X-Forwarded-For */
} Fields;

static enum MHD_Result look_at_field(void *context, enum MHD_ValueKind kind, const char *name, const char *value)
{
    Fields *fields = context;
    (void)kind;
    head_field(&fields->check, name, value);
    if (strcasecmp(name, "X-Forwarded-For") == 0)
        fields->forwarded = value;
    return MHD_YES;
}

/* An error where programs may differ about where the request ends, or what it is. */
static Answer *refuse_head(const Exchange *exchange, const char *method, const char *version, Fields *fields)
{
    const union MHD_ConnectionInfo *info =
        keeps_head() ? MHD_get_connection_info(exchange->connection, MHD_CONNECTION_INFO_REQUEST_HEADER_SIZE) : NULL;
    head_begin(&fields->check, method, exchange->url, exchange->url_end, version, info ? info->header_size : 0);
    (void)MHD_get_connection_values(exchange->connection, MHD_HEADER_KIND, look_at_field, fields);
    return head_end(&fields->check) ? answer_error(fields->check.status, "%s", fields->check.fault) : NULL;
}

/* Who has asked, which behind a proxy that is trusted is whom it tells; an error where it has too much already. All
 * whom it does not know are one. A proxy that asks for itself may have any number. */
static Answer *refuse_client(Exchange *exchange, const char *forwarded)
{
    const Connection *connection = exchange_connection(exchange);
    if (!connection || !connection->is_proxy ||
        trusted_client(&exchange->http->params.proxies, forwarded, &exchange->client))
        return NULL;
    exchange->peer = peers_enter(exchange->http->peers, &exchange->client);
    return exchange->peer ? NULL : answer_error(429, "too many requests of one client wait for their answers");
}

/* An error where no image can be received. */
static Answer *refuse_upload(Exchange *exchange)
{
    Uploads *uploads = exchange->http->params.site->uploads;
    const Connection *connection = exchange_connection(exchange);
    Peer *peer = exchange->peer ? exchange->peer : connection ? connection->peer : NULL;
    exchange->request.route = SERVE_UPLOAD;
    if (!uploads)
        return answer_error(403, "this server takes no images");
    if (atomic_load(&exchange->http->is_refusing))
        return answer_error(503, "the server ends");
    if (peer && !peers_begin_upload(exchange->http->peers, peer))
        return answer_error(429, "too many images of one client are on their way");
    exchange->uploader = peer;
    set_state(exchange, CLIENT_UPLOADS);
    return body_begin(&exchange->body, uploads, exchange_header(exchange, "Content-Length"));
}

/* An error where a request is none of those that are answered here, so that no body is read. */
static Answer *refuse_request(Exchange *exchange)
{
    const char *method = exchange->method, *length = exchange_header(exchange, "Content-Length");
    if (exchange_is_of_uploads(exchange) && strcmp(method, "POST") == 0)
        return refuse_upload(exchange);
    if (exchange_is_of_uploads(exchange) && strcmp(method, "OPTIONS") == 0)
        return answer_new(204, "", NULL, 0);
    if (strcmp(method, "GET") != 0 && strcmp(method, "HEAD") != 0)
        return answer_error(405, "expected GET or HEAD, or POST of an image to /v1/uploads");
    if ((length && strcmp(length, "0") != 0) || exchange_header(exchange, "Transfer-Encoding"))
        return answer_error(413, "a request has no body here");
    return NULL;
}

static Answer *refuse_headers(Exchange *exchange, const char *method, const char *version)
{
    Fields fields = {.forwarded = NULL};
    Answer *answer = refuse_head(exchange, method, version, &fields);
    if (!answer)
        answer = refuse_client(exchange, fields.forwarded);
    if (!answer && !exchange->path)
        answer = answer_error(403, "the URL is not signed by a key of this server");
    return answer ? answer : refuse_request(exchange);
}

/* ---- the beginning of an answer ---- */

/* All of an image has come. */
static int begin_upload(Exchange *exchange)
{
    char hash[UPLOAD_HASH_TEXT];
    exchange->answer = body_complete(&exchange->body, hash);
    return exchange->answer ? 0 : wait_for_work(exchange, hash, "");
}

/* JPEG and PNG can be written everywhere. Whether the others can is found out when the first request comes to them. */
static int parse(Exchange *exchange)
{
    ServeRequest *request = &exchange->request;
    const char *accept = exchange_header(exchange, "Accept");
    const int status = serve_request_parse(request, exchange->path, accept, (1u << SERVE_FORMATS) - 1);
    if (status || request->format == SERVE_JPEG || request->format == SERVE_PNG)
        return status;
    return serve_request_parse(request, exchange->path, accept, picture_formats());
}

/* A header by its new name, or by the old one. */
static const char *hint(const Exchange *exchange, const char *name)
{
    static const char prefix[] = "Sec-CH-";
    const char *value = exchange_header(exchange, name);
    return value ? value : exchange_header(exchange, name + sizeof prefix - 1);
}

static int begin(Exchange *exchange)
{
    Http *http = exchange->http;
    ServeRequest *request = &exchange->request;
    if (parse(exchange)) {
        exchange->answer = answer_error(request->status, "%s", request->reason);
        return 0;
    }
    hints_apply(request, &(Hints){.width = hint(exchange, "Sec-CH-Width"),
                                  .viewport_width = hint(exchange, "Sec-CH-Viewport-Width"),
                                  .dpr = hint(exchange, "Sec-CH-DPR")});
    switch (request->route) {
    case SERVE_HEALTH:
        exchange->answer = atomic_load(&http->is_refusing) ? answer_error(503, "the server ends") : health_answer();
        return 0;
    case SERVE_METRICS:
        exchange->answer = status_answer(&(StatusSources){.metrics = &http->metrics,
                                                          .connections = clients_count(http->clients),
                                                          .site = http->params.site,
                                                          .pictures = http->params.pictures,
                                                          .uploads = http->params.uploads});
        return 0;
    case SERVE_IIIF_BASE:
        exchange->answer = redirect_answer(exchange);
        return 0;
    default:
        break;
    }
    if (atomic_load(&http->is_refusing)) {
        exchange->answer = answer_error(503, "the server ends");
        return 0;
    }
    return begin_work(exchange);
}

/* ---- callbacks of libmicrohttpd, all in its thread ---- */

/* The first line of a request has come. */
static void *begin_exchange(void *context, const char *url, struct MHD_Connection *from)
{
    Http *http = context;
    Exchange *exchange = calloc(1, sizeof *exchange);
    /* more is refused, whatever it is */
    if (exchange && !(exchange->url = strndup(url, SERVE_URL_MAX + 1 + 1 + SIGNATURE_LENGTH))) {
        free(exchange);
        exchange = NULL;
    }
    if (!exchange)
        return NULL;
    exchange->http = http;
    exchange->path = strcmp(url, "/health") == 0 ? exchange->url : keys_check(&http->params.keys, exchange->url);
    exchange->connection = from;
    const Connection *connection = exchange_connection(exchange);
    exchange->client = connection ? connection->address : (Address){{0}};
    exchange->url_end = url + strlen(url) + 1;
    exchange->began = retex_clock_seconds();
    exchange->request.route = (ServeRoute)-1;
    atomic_fetch_add(&http->pending, 1);
    return exchange;
}

static enum MHD_Result take_body(Exchange *exchange, const void *data, size_t bytes)
{
    const Connection *connection = exchange_connection(exchange);
    clients_received(exchange->http->clients, connection ? connection->client : NULL, bytes);
    return body_add(&exchange->body, data, bytes) ? MHD_NO : MHD_YES;
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *upload_data, size_t *upload_bytes, void **state)
{
    Exchange *exchange = *state;
    const size_t bytes = *upload_bytes;
    (void)context, (void)connection, (void)url;
    *upload_bytes = 0;
    if (!exchange)
        return MHD_NO;
    if (exchange->status) /* it has its answer; what else the client sends is not read */
        return MHD_NO;
    if (!exchange->method[0]) {
        snprintf(exchange->method, sizeof exchange->method, "%s", method);
        exchange->answer = refuse_headers(exchange, method, version);
        return exchange->answer ? exchange_send(exchange) : MHD_YES; /* an answer now ends the connection */
    }
    if (bytes && exchange->body.uploads)
        return take_body(exchange, upload_data, bytes);
    if (!exchange->is_begun) {
        exchange->is_begun = 1;
        set_state(exchange, CLIENT_WAITS);
        if (exchange->body.uploads ? begin_upload(exchange) : begin(exchange))
            return MHD_YES; /* called again when the answer is there */
    }
    return exchange_send(exchange);
}

static void end_exchange(void *context, struct MHD_Connection *unused, void **state,
                         enum MHD_RequestTerminationCode why)
{
    Http *http = context;
    Exchange *exchange = *state;
    (void)unused;
    if (!exchange)
        return;
    *state = NULL;
    const double seconds = retex_clock_seconds() - exchange->began;
    const int is_complete = why == MHD_REQUEST_TERMINATED_COMPLETED_OK;
    const char *reason = !exchange->answer ? "the request was not complete"
                         : !is_complete    ? "the client left"
                                           : exchange->answer->reason;
    char client[ADDRESS_TEXT];
    const LogLine line = {.method = exchange->method,
                          .path = exchange->path ? exchange->path : keys_hide(exchange->url),
                          .client = address_text(&exchange->client, client),
                          .status = exchange->status,
                          .bytes = is_complete ? exchange->bytes : 0,
                          .seconds = seconds,
                          .cache = exchange->cache,
                          .error = reason};
    const int route = exchange->request.status ? -1 : (int)exchange->request.route;
    metrics_add(&http->metrics, route, exchange->status, seconds, line.bytes, exchange->cache);
    if (!http->params.is_quiet)
        log_request(&line);
    set_state(exchange, CLIENT_SENDS);
    if (exchange->uploader)
        peers_end_upload(exchange->uploader);
    peers_leave(http->peers, exchange->peer);
    answer_release(exchange->answer);
    body_free(&exchange->body);
    free(exchange->url);
    free(exchange);
    atomic_fetch_sub(&http->pending, 1);
}

static const struct sockaddr *address_info(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    return info ? info->client_addr : NULL;
}

static Connection *open_connection(Http *http, struct MHD_Connection *from)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(from, MHD_CONNECTION_INFO_CONNECTION_FD);
    Connection *connection = calloc(1, sizeof *connection);
    if (!connection)
        return NULL;
    if (address_of_socket(&connection->address, address_info(from)) == 0) {
        connection->is_proxy = trusted_has(&http->params.proxies, &connection->address);
        connection->peer = connection->is_proxy ? NULL : peers_enter(http->peers, &connection->address);
    }
    connection->client = info ? clients_add(http->clients, info->connect_fd) : NULL;
    return connection;
}

static void close_connection(Http *http, Connection *connection)
{
    if (!connection)
        return;
    clients_remove(http->clients, connection->client);
    peers_leave(http->peers, connection->peer);
    free(connection);
}

static void note_connection(void *context, struct MHD_Connection *from, void **connection,
                            enum MHD_ConnectionNotificationCode what)
{
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        *connection = open_connection(context, from);
    } else {
        close_connection(context, *connection);
        *connection = NULL;
    }
}

/* Whether a connection is accepted. */
static enum MHD_Result accept_client(void *context, const struct sockaddr *socket, socklen_t size)
{
    Http *http = context;
    Address address;
    (void)size;
    return address_of_socket(&address, socket) || trusted_has(&http->params.proxies, &address) ||
                   peers_has_place(http->peers, &address)
               ? MHD_YES
               : MHD_NO;
}

/* ---- start and end ---- */

static void free_http(Http *http)
{
    clients_close(http->clients);
    peers_close(http->peers);
    free(http);
}

int http_open(Http **result, const HttpParams *params, RetexError *err)
{
    Http *http = *result = calloc(1, sizeof *http);
    if (http)
        http->clients = clients_open();
    if (http)
        http->peers = peers_open(params->per_client);
    if (!http || !http->clients || !http->peers) {
        if (http)
            free_http(http);
        *result = NULL;
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a server");
    }
    http->params = *params;
    const int file = listen_on(params->address, params->port, &http->port, err);
    if (file >= 0)
        http->daemon = MHD_start_daemon(
            MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ITC, 0, accept_client, http, handle,
            http, MHD_OPTION_LISTEN_SOCKET, file, MHD_OPTION_CONNECTION_LIMIT, (unsigned)params->connections,
            MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)(params->timeout + 1), MHD_OPTION_CONNECTION_MEMORY_LIMIT,
            (size_t)CONNECTION_BYTES, MHD_OPTION_URI_LOG_CALLBACK, begin_exchange, http, MHD_OPTION_NOTIFY_COMPLETED,
            end_exchange, http, MHD_OPTION_NOTIFY_CONNECTION, note_connection, http, DISCIPLINE, MHD_OPTION_END);
    if (http->daemon)
        return RETEX_OK;
    if (file >= 0) {
        retex_fail(err, RETEX_EIO, "the server cannot be started: %s", strerror(errno));
        close(file);
    }
    free_http(http);
    *result = NULL;
    return RETEX_EIO;
}

int http_port(const Http *http)
{
    return http->port;
}

void http_sweep(Http *http)
{
    clients_sweep(http->clients, retex_clock_seconds(), http->params.timeout, http->params.min_rate);
    if (http->params.site->uploads)
        uploads_sweep(http->params.site->uploads);
}

void http_refuse(Http *http)
{
    if (atomic_exchange(&http->is_refusing, 1))
        return;
    const MHD_socket file = MHD_quiesce_daemon(http->daemon);
    if (file != MHD_INVALID_SOCKET)
        close(file);
}

int http_pending(Http *http)
{
    return atomic_load(&http->pending);
}

void http_close(Http *http)
{
    if (!http)
        return;
    MHD_stop_daemon(http->daemon);
    free_http(http);
}
