/* The answer of an exchange as libmicrohttpd sends it: its headers, and which of its bytes. */
#include "serve/http/exchange.h"

#include <stdio.h>
#include <string.h>

#include "http/headers.h"
#include "serve/request/hints.h"
#include "serve/request/iiif.h"

enum { LINK_MAX_BYTES = 8 << 10, RETRY_SECONDS = 2 };

Connection *exchange_connection(const Exchange *exchange)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(exchange->connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

const char *exchange_header(const Exchange *exchange, const char *name)
{
    return MHD_lookup_connection_value(exchange->connection, MHD_HEADER_KIND, name);
}

int exchange_is_of_uploads(const Exchange *exchange)
{
    return exchange->path && strcmp(exchange->path, "/v1/uploads") == 0;
}

/* ---- the server's URL ---- */

static int is_iiif(const Exchange *exchange)
{
    const ServeRoute route = exchange->request.route;
    return route == SERVE_IIIF_BASE || route == SERVE_IIIF_INFO || route == SERVE_IIIF_IMAGE;
}

/* "http://127.0.0.1:8080": where the client has reached the server. */
static void own_base(const Exchange *exchange, char text[SERVE_BASE_MAX])
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(exchange->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    struct sockaddr_storage bound;
    socklen_t size = sizeof bound;
    char own[ADDRESS_TEXT];
    Address address;
    text[0] = '\0';
    if (!info || getsockname(info->connect_fd, (struct sockaddr *)&bound, &size) != 0 ||
        address_of_socket(&address, (struct sockaddr *)&bound))
        return;
    address_text(&address, own);
    snprintf(text, SERVE_BASE_MAX, strchr(own, ':') ? "http://[%s]:%d" : "http://%s:%d", own, exchange->http->port);
}

/* The signature of the image that is asked for, which its client has, but perhaps of another spelling. */
static void add_signature(const Exchange *exchange, char text[SERVE_BASE_MAX])
{
    char id[IIIF_URL_MAX], signature[SIGNATURE_LENGTH + 1];
    const size_t used = strlen(text);
    keys_sign(&exchange->http->params.keys, iiif_id(id, &exchange->request, ""), signature);
    snprintf(text + used, SERVE_BASE_MAX - used, "/%s", signature);
}

/* What a client says of the server stands in no answer, which a shared cache might give to another one. */
const char *exchange_base(const Exchange *exchange, char text[SERVE_BASE_MAX])
{
    const Connection *connection = exchange_connection(exchange);
    text[0] = '\0';
    if (!is_iiif(exchange))
        return text;
    if (exchange->http->params.base)
        snprintf(text, SERVE_BASE_MAX, "%s", exchange->http->params.base);
    else if (connection && connection->is_proxy)
        header_base(text, 256, exchange_header(exchange, "Host"), exchange_header(exchange, "X-Forwarded-Proto"));
    if (!text[0])
        own_base(exchange, text);
    if (exchange->http->params.keys.count)
        add_signature(exchange, text);
    return text;
}

/* ---- headers ---- */

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
        /* a shared cache would keep a picture for each width that a browser tells */
        snprintf(text, sizeof text, "%s, max-age=%d", exchange->request.size_by_hints ? "private" : "public",
                 http->params.max_age);
        add_header(response, "Cache-Control",
                   exchange->request.route == SERVE_HEALTH || exchange->request.route == SERVE_METRICS ? "no-store"
                                                                                                       : text);
    } else {
        add_header(response, "Cache-Control", "no-store");
    }
    if (exchange->request.format_by_accept || exchange->request.route == SERVE_IIIF_INFO)
        add_header(response, "Vary", "Accept");
    if (exchange->request.size_by_hints) {
        add_header(response, "Vary", HINTS_ACCEPT);
        add_header(response, "Accept-CH", HINTS_ACCEPT);
    }
    if (exchange->answer->etag[0])
        add_header(response, "ETag", exchange->answer->etag);
}

/* The canonical URL of an image of IIIF, and what it conforms to. */
static void add_iiif_link(struct MHD_Response *response, const Exchange *exchange)
{
    static const char level[] = "<http://iiif.io/api/image/3/level2.json>;rel=\"profile\"";
    const Answer *answer = exchange->answer;
    ServeRequest request = exchange->request;
    RetexCut place;
    char base[SERVE_BASE_MAX], url[IIIF_URL_MAX], text[IIIF_URL_MAX + sizeof level + 32];
    if (request.route != SERVE_IIIF_IMAGE || !answer->width ||
        iiif_place(&request, answer->width, answer->height, &place))
        return;
    iiif_canonical(url, &request, &place, exchange_base(exchange, base), answer->width, answer->height);
    if (strlen(url) < LINK_MAX_BYTES) {
        snprintf(text, sizeof text, "<%s>;rel=\"canonical\", %s", url, level);
        add_header(response, "Link", text);
    }
}

static void add_headers(struct MHD_Response *response, const Exchange *exchange, int status)
{
    const Answer *answer = exchange->answer;
    const int is_info = exchange->request.route == SERVE_IIIF_INFO && status == 200;
    char seconds[16];
    if (answer->bytes && status != 304 && status != 416)
        add_header(response, "Content-Type",
                   is_info ? iiif_info_type(exchange_header(exchange, "Accept")) : answer->type);
    add_cache_headers(response, exchange, status);
    add_header(response, "X-Content-Type-Options", "nosniff");
    add_header(response, "Access-Control-Allow-Origin", "*");
    if (answer->etag[0])
        add_header(response, "Accept-Ranges", "bytes");
    if (answer->location)
        add_header(response, "Location", answer->location);
    if (status == 405)
        add_header(response, "Allow", exchange_is_of_uploads(exchange) ? "POST, OPTIONS" : "GET, HEAD");
    if (status == 204) { /* what a page of another site asks before it sends an image */
        add_header(response, "Access-Control-Allow-Methods", "POST");
        add_header(response, "Access-Control-Allow-Headers", "Content-Type");
    }
    if (status == 503 || status == 429) {
        snprintf(seconds, sizeof seconds, "%d", RETRY_SECONDS);
        add_header(response, "Retry-After", seconds);
    }
    if (status == 200)
        add_iiif_link(response, exchange);
    if (atomic_load(&exchange->http->is_refusing))
        add_header(response, "Connection", "close");
}

/* Which bytes are sent, with what status: all, some of them, or none because the client has them. */
static int choose_part(Exchange *exchange, size_t *first, size_t *count, char content_range[96])
{
    const Answer *answer = exchange->answer;
    const char *only_if = exchange_header(exchange, "If-Range");
    size_t last = 0;
    *first = 0;
    *count = answer->bytes;
    content_range[0] = '\0';
    if (answer->status != 200 || !answer->etag[0])
        return answer->status;
    if (header_has_etag(exchange_header(exchange, "If-None-Match"), answer->etag)) {
        *count = 0;
        return 304;
    }
    if (strcmp(exchange->method, "GET") != 0 || (only_if && strcmp(only_if, answer->etag) != 0))
        return 200;
    switch (header_range(exchange_header(exchange, "Range"), answer->bytes, first, &last)) {
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

enum MHD_Result exchange_send(Exchange *exchange)
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
    const Connection *connection = exchange_connection(exchange);
    clients_set(exchange->http->clients, connection ? connection->client : NULL, CLIENT_TAKES);
    const enum MHD_Result result = MHD_queue_response(exchange->connection, (unsigned)status, response);
    MHD_destroy_response(response);
    return result;
}
