/* See http.h. */
#include "http.h"

#include <errno.h>
#include <netdb.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <microhttpd.h>

#include <retex/clock.h>

#include "body.h"
#include "clients.h"
#include "headers.h"
#include "iiif.h"
#include "log.h"
#include "picture.h"
#include "status.h"

enum { CONNECTION_BYTES = 48 << 10, LINK_MAX_BYTES = 8 << 10, RETRY_SECONDS = 2 };

struct Http {
    HttpParams params;
    Metrics metrics;
    Clients *clients;
    struct MHD_Daemon *daemon;
    int port;
    atomic_int pending, is_refusing;
};

/* One request, from its first line to the end of its answer. */
typedef struct Exchange {
    Waiter waiter; /* first member */
    Http *http;
    struct MHD_Connection *connection;
    char *url; /* as it came */
    char method[16];
    double began;
    ServeRequest request;
    Body body; /* of an upload */
    Answer *answer;
    CacheUse cache;
    int is_begun; /* 1: all headers have come */
    int status;   /* of what was sent; 0 = nothing */
    unsigned long long bytes;
} Exchange;

static Client *client_of(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

static const char *header_of(const Exchange *exchange, const char *name)
{
    return MHD_lookup_connection_value(exchange->connection, MHD_HEADER_KIND, name);
}

/* ---- sending ---- */

static void release_answer(void *answer)
{
    answer_release(answer);
}

static void add_header(struct MHD_Response *response, const char *name, const char *value)
{
    (void)MHD_add_response_header(response, name, value);
}

static void add_cache_headers(struct MHD_Response *response, const Exchange *exchange, int status)
{
    const Http *http = exchange->http;
    char text[64];
    if (status == 200 || status == 206 || status == 304) {
        snprintf(text, sizeof text, "public, max-age=%d", http->params.max_age);
        add_header(response, "Cache-Control",
                   exchange->request.route == SERVE_HEALTH || exchange->request.route == SERVE_METRICS ? "no-store"
                                                                                                       : text);
    } else {
        add_header(response, "Cache-Control", "no-store");
    }
    if (exchange->request.format_by_accept || exchange->request.route == SERVE_IIIF_INFO)
        add_header(response, "Vary", "Accept");
    if (exchange->answer->etag[0])
        add_header(response, "ETag", exchange->answer->etag);
}

/* The canonical URL of an image of IIIF, and what it conforms to. */
static void add_iiif_link(struct MHD_Response *response, const Exchange *exchange, const char *base)
{
    static const char level[] = "<http://iiif.io/api/image/3/level2.json>;rel=\"profile\"";
    const Answer *answer = exchange->answer;
    ServeRequest request = exchange->request;
    ServePlace place;
    char url[IIIF_URL_MAX], text[IIIF_URL_MAX + sizeof level + 32];
    if (request.route != SERVE_IIIF_IMAGE || !answer->width ||
        iiif_place(&request, answer->width, answer->height, &place))
        return;
    iiif_canonical(url, &request, &place, base, answer->width, answer->height);
    if (strlen(url) < LINK_MAX_BYTES) {
        snprintf(text, sizeof text, "<%s>;rel=\"canonical\", %s", url, level);
        add_header(response, "Link", text);
    }
}

static const char *base_of(const Exchange *exchange, char text[256])
{
    const char *base = exchange->http->params.base;
    if (base)
        return base;
    return header_base(text, 256, header_of(exchange, "Host"), header_of(exchange, "X-Forwarded-Proto"));
}

/* Whether it is the URL to which images are sent. */
static int is_of_uploads(const Exchange *exchange)
{
    return strcmp(exchange->url, "/v1/uploads") == 0;
}

static void add_headers(struct MHD_Response *response, const Exchange *exchange, int status)
{
    const Answer *answer = exchange->answer;
    const int is_info = exchange->request.route == SERVE_IIIF_INFO && status == 200;
    char base[256], seconds[16];
    if (answer->bytes && status != 304 && status != 416)
        add_header(response, "Content-Type", is_info ? iiif_info_type(header_of(exchange, "Accept")) : answer->type);
    add_cache_headers(response, exchange, status);
    add_header(response, "X-Content-Type-Options", "nosniff");
    add_header(response, "Access-Control-Allow-Origin", "*");
    if (answer->etag[0])
        add_header(response, "Accept-Ranges", "bytes");
    if (answer->location)
        add_header(response, "Location", answer->location);
    if (status == 405)
        add_header(response, "Allow", is_of_uploads(exchange) ? "POST, OPTIONS" : "GET, HEAD");
    if (status == 204) { /* what a page of another site asks before it sends an image */
        add_header(response, "Access-Control-Allow-Methods", "POST");
        add_header(response, "Access-Control-Allow-Headers", "Content-Type");
    }
    if (status == 503) {
        snprintf(seconds, sizeof seconds, "%d", RETRY_SECONDS);
        add_header(response, "Retry-After", seconds);
    }
    if (status == 200)
        add_iiif_link(response, exchange, base_of(exchange, base));
    if (atomic_load(&exchange->http->is_refusing))
        add_header(response, "Connection", "close");
}

/* Which bytes are sent, with what status: all, some of them, or none because the client has them. */
static int choose_part(Exchange *exchange, size_t *first, size_t *count, char content_range[96])
{
    const Answer *answer = exchange->answer;
    const char *only_if = header_of(exchange, "If-Range");
    size_t last = 0;
    *first = 0;
    *count = answer->bytes;
    content_range[0] = '\0';
    if (answer->status != 200 || !answer->etag[0])
        return answer->status;
    if (header_has_etag(header_of(exchange, "If-None-Match"), answer->etag)) {
        *count = 0;
        return 304;
    }
    if (strcmp(exchange->method, "GET") != 0 || (only_if && strcmp(only_if, answer->etag) != 0))
        return 200;
    switch (header_range(header_of(exchange, "Range"), answer->bytes, first, &last)) {
    case RANGE_SOME:
        *count = last - *first + 1;
        snprintf(content_range, 96, "bytes %zu-%zu/%zu", *first, last, answer->bytes);
        return 206;
    case RANGE_OUTSIDE:
        *first = *count = 0;
        snprintf(content_range, 96, "bytes */%zu", answer->bytes);
        return 416;
    default:
        *first = 0;
        return 200;
    }
}

static enum MHD_Result send_answer(Exchange *exchange)
{
    size_t first, count;
    char content_range[96];
    if (!exchange->answer && !(exchange->answer = answer_error(503, "the server has no memory left")))
        return MHD_NO;
    const int status = choose_part(exchange, &first, &count, content_range);
    Answer *answer = answer_hold(exchange->answer);
    static char none[1];
    char *data = answer->data ? answer->data : none;
    struct MHD_Response *response =
        MHD_create_response_from_buffer_with_free_callback_cls(count, data + first, release_answer, answer);
    if (!response) {
        answer_release(answer);
        return MHD_NO;
    }
    add_headers(response, exchange, status);
    if (content_range[0])
        add_header(response, "Content-Range", content_range);
    exchange->status = status;
    exchange->bytes = strcmp(exchange->method, "HEAD") == 0 ? 0 : count;
    clients_set(exchange->http->clients, client_of(exchange->connection), CLIENT_TAKES);
    const enum MHD_Result result = MHD_queue_response(exchange->connection, (unsigned)status, response);
    MHD_destroy_response(response);
    return result;
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
    char base[256], url[IIIF_URL_MAX];
    iiif_id(url, &exchange->request, base_of(exchange, base));
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
    const char *had = header_of(exchange, "If-None-Match");
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
    char key[SITE_KEY_MAX], base_text[256], etag[ETAG_SIZE];
    const char *base = base_of(exchange, base_text);
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

/* An error where no image can be received. */
static Answer *refuse_upload(Exchange *exchange)
{
    Uploads *uploads = exchange->http->params.site->uploads;
    exchange->request.route = SERVE_UPLOAD;
    if (!uploads)
        return answer_error(403, "this server takes no images");
    if (atomic_load(&exchange->http->is_refusing))
        return answer_error(503, "the server ends");
    clients_set(exchange->http->clients, client_of(exchange->connection), CLIENT_UPLOADS);
    return body_begin(&exchange->body, uploads, header_of(exchange, "Content-Length"));
}

/* An error where a request is none of those that are answered here, so that no body is read. */
static Answer *refuse_headers(Exchange *exchange)
{
    const char *method = exchange->method, *length = header_of(exchange, "Content-Length");
    if (is_of_uploads(exchange) && strcmp(method, "POST") == 0)
        return refuse_upload(exchange);
    if (is_of_uploads(exchange) && strcmp(method, "OPTIONS") == 0)
        return answer_new(204, "", NULL, 0);
    if (strcmp(method, "GET") != 0 && strcmp(method, "HEAD") != 0)
        return answer_error(405, "expected GET or HEAD, or POST of an image to /v1/uploads");
    if ((length && strcmp(length, "0") != 0) || header_of(exchange, "Transfer-Encoding"))
        return answer_error(413, "a request has no body here");
    return NULL;
}

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
    const char *accept = header_of(exchange, "Accept");
    const int status = serve_request_parse(request, exchange->url, accept, (1u << SERVE_FORMATS) - 1);
    if (status || request->format == SERVE_JPEG || request->format == SERVE_PNG)
        return status;
    return serve_request_parse(request, exchange->url, accept, picture_formats());
}

static int begin(Exchange *exchange)
{
    Http *http = exchange->http;
    ServeRequest *request = &exchange->request;
    if (parse(exchange)) {
        exchange->answer = answer_error(request->status, "%s", request->reason);
        return 0;
    }
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
static void *begin_exchange(void *context, const char *url, struct MHD_Connection *connection)
{
    Http *http = context;
    Exchange *exchange = calloc(1, sizeof *exchange);
    if (exchange && !(exchange->url = strndup(url, SERVE_URL_MAX + 1))) { /* more is refused, whatever it is */
        free(exchange);
        exchange = NULL;
    }
    if (!exchange)
        return NULL;
    exchange->http = http;
    exchange->connection = connection;
    exchange->began = retex_clock_seconds();
    exchange->request.route = (ServeRoute)-1;
    atomic_fetch_add(&http->pending, 1);
    return exchange;
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *upload_data, size_t *upload_bytes, void **state)
{
    Exchange *exchange = *state;
    const size_t bytes = *upload_bytes;
    (void)context, (void)url, (void)version;
    *upload_bytes = 0;
    if (!exchange)
        return MHD_NO;
    if (exchange->status) /* it has its answer; what else the client sends is not read */
        return MHD_NO;
    if (!exchange->method[0]) {
        snprintf(exchange->method, sizeof exchange->method, "%s", method);
        exchange->answer = refuse_headers(exchange);
        return exchange->answer ? send_answer(exchange) : MHD_YES; /* an answer now ends the connection */
    }
    if (bytes && exchange->body.uploads)
        return body_add(&exchange->body, upload_data, bytes) ? MHD_NO : MHD_YES;
    if (!exchange->is_begun) {
        exchange->is_begun = 1;
        clients_set(exchange->http->clients, client_of(connection), CLIENT_WAITS);
        if (exchange->body.uploads ? begin_upload(exchange) : begin(exchange))
            return MHD_YES; /* called again when the answer is there */
    }
    return send_answer(exchange);
}

/* "127.0.0.1" */
static const char *client_text(struct MHD_Connection *connection, char text[64])
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    const struct sockaddr *address = info ? info->client_addr : NULL;
    const socklen_t size =
        address && address->sa_family == AF_INET6 ? sizeof(struct sockaddr_in6) : sizeof(struct sockaddr_in);
    text[0] = '\0';
    if (address)
        (void)getnameinfo(address, size, text, 64, NULL, 0, NI_NUMERICHOST);
    return text;
}

static void end_exchange(void *context, struct MHD_Connection *connection, void **state,
                         enum MHD_RequestTerminationCode why)
{
    Http *http = context;
    Exchange *exchange = *state;
    if (!exchange)
        return;
    *state = NULL;
    const double seconds = retex_clock_seconds() - exchange->began;
    const int is_complete = why == MHD_REQUEST_TERMINATED_COMPLETED_OK;
    const char *reason = !exchange->answer ? "the request was not complete"
                         : !is_complete    ? "the client left"
                                           : exchange->answer->reason;
    char client[64];
    const LogLine line = {.method = exchange->method,
                          .path = exchange->url,
                          .client = client_text(connection, client),
                          .status = exchange->status,
                          .bytes = is_complete ? exchange->bytes : 0,
                          .seconds = seconds,
                          .cache = exchange->cache,
                          .error = reason};
    const int route = exchange->request.status ? -1 : (int)exchange->request.route;
    metrics_add(&http->metrics, route, exchange->status, seconds, line.bytes, exchange->cache);
    if (!http->params.is_quiet)
        log_request(&line);
    clients_set(http->clients, client_of(connection), CLIENT_SENDS);
    answer_release(exchange->answer);
    body_free(&exchange->body);
    free(exchange->url);
    free(exchange);
    atomic_fetch_sub(&http->pending, 1);
}

static void note_connection(void *context, struct MHD_Connection *connection, void **client,
                            enum MHD_ConnectionNotificationCode what)
{
    Http *http = context;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        *client = info ? clients_add(http->clients, info->connect_fd) : NULL;
    } else {
        clients_remove(http->clients, *client);
        *client = NULL;
    }
}

/* ---- start and end ---- */

/* A socket that listens, or -1. */
static int listen_on(Http *http, RetexError *err)
{
    const HttpParams *params = &http->params;
    struct addrinfo hints = {.ai_flags = AI_PASSIVE | AI_NUMERICSERV, .ai_socktype = SOCK_STREAM}, *found = NULL;
    char port[16];
    snprintf(port, sizeof port, "%d", params->port);
    const int unknown = getaddrinfo(params->address, port, &hints, &found);
    if (unknown) {
        retex_fail(err, RETEX_EINVAL, "--listen %s: %s", params->address, gai_strerror(unknown));
        return -1;
    }
    const int one = 1;
    int file = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    struct sockaddr_storage bound;
    socklen_t size = sizeof bound;
    if (file < 0 || setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) != 0 ||
        bind(file, found->ai_addr, found->ai_addrlen) != 0 || listen(file, SOMAXCONN) != 0 ||
        getsockname(file, (struct sockaddr *)&bound, &size) != 0) {
        retex_fail(err, RETEX_EIO, "cannot listen on %s, port %d: %s", params->address, params->port, strerror(errno));
        if (file >= 0)
            close(file);
        file = -1;
    } else if (getnameinfo((struct sockaddr *)&bound, size, NULL, 0, port, sizeof port, NI_NUMERICSERV) == 0) {
        http->port = atoi(port);
    }
    freeaddrinfo(found);
    return file;
}

int http_open(Http **result, const HttpParams *params, RetexError *err)
{
    Http *http = *result = calloc(1, sizeof *http);
    if (!http || !(http->clients = clients_open())) {
        free(http);
        *result = NULL;
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a server");
    }
    http->params = *params;
    const int file = listen_on(http, err);
    if (file >= 0)
        http->daemon = MHD_start_daemon(
            MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ITC, 0, NULL, NULL, handle, http,
            MHD_OPTION_LISTEN_SOCKET, file, MHD_OPTION_CONNECTION_LIMIT, (unsigned)params->connections,
            MHD_OPTION_PER_IP_CONNECTION_LIMIT, (unsigned)params->per_client, MHD_OPTION_CONNECTION_TIMEOUT,
            (unsigned)(params->timeout + 1), MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_BYTES,
            MHD_OPTION_URI_LOG_CALLBACK, begin_exchange, http, MHD_OPTION_NOTIFY_COMPLETED, end_exchange, http,
            MHD_OPTION_NOTIFY_CONNECTION, note_connection, http, MHD_OPTION_END);
    if (http->daemon)
        return RETEX_OK;
    if (file >= 0) {
        retex_fail(err, RETEX_EIO, "the server cannot be started: %s", strerror(errno));
        close(file);
    }
    clients_close(http->clients);
    free(http);
    *result = NULL;
    return RETEX_EIO;
}

int http_port(const Http *http)
{
    return http->port;
}

void http_sweep(Http *http)
{
    clients_sweep(http->clients, http->params.timeout);
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
    clients_close(http->clients);
    free(http);
}
