/* See reply.h. */
#include "reply.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/json.h"

void reply_header(Reply *reply, const char *name, const char *value)
{
    if (reply->response)
        MHD_add_response_header(reply->response, name, value);
}

static Reply of_response(int status, const char *type, struct MHD_Response *response)
{
    Reply reply = {status, response};
    reply_header(&reply, "Content-Type", type);
    return reply;
}

Reply reply_bytes(int status, const char *type, void *data, size_t bytes)
{
    struct MHD_Response *response = MHD_create_response_from_buffer(bytes, data, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(data);
    return of_response(status, type, response);
}

Reply reply_constant(const char *type, const void *data, size_t bytes)
{
    return of_response(MHD_HTTP_OK, type, MHD_create_response_from_buffer(bytes, (void *)data, MHD_RESPMEM_PERSISTENT));
}

Reply reply_file(int status, const char *type, int descriptor, off_t first, off_t count)
{
    struct MHD_Response *response =
        MHD_create_response_from_fd_at_offset64((uint64_t)count, descriptor, (uint64_t)first);
    if (!response)
        close(descriptor);
    return of_response(status, type, response);
}

/* response NULL where there is no memory. */
static Reply of_json(int status, json_t *value, size_t style)
{
    char *text = value ? json_dumps(value, style | JSON_ENCODE_ANY) : NULL;
    json_decref(value);
    return text ? reply_bytes(status, "application/json", text, strlen(text)) : (Reply){status, NULL};
}

Reply reply_json(int status, json_t *value)
{
    const Reply reply = of_json(status, value, JSON_COMPACT);
    return reply.response ? reply : reply_error(MHD_HTTP_INTERNAL_SERVER_ERROR, "not enough memory");
}

Reply reply_error(int status, const char *fmt, ...)
{
    char line[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(line, sizeof line, fmt, args);
    va_end(args);
    return of_json(status, json_pack("{s:o}", "error", json_of_text(line)), 0);
}

Reply reply_of_error(const RetexError *err)
{
    const int status = err->code == RETEX_ENOMEM || err->code == RETEX_EIO ? MHD_HTTP_INTERNAL_SERVER_ERROR
                       : err->code == RETEX_EACCESS                        ? MHD_HTTP_FORBIDDEN
                       : err->code == RETEX_ENOTFOUND                      ? MHD_HTTP_NOT_FOUND
                                                                           : MHD_HTTP_UNPROCESSABLE_CONTENT;
    return reply_error(status, "%s", err->message);
}
