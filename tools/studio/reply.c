/* See reply.h. */
#include "reply.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/json_text.h"

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

Reply reply_json(int status, json_t *value)
{
    char *text = value ? json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY) : NULL;
    json_decref(value);
    if (!text)
        return reply_error(MHD_HTTP_INTERNAL_SERVER_ERROR, "not enough memory");
    return reply_bytes(status, "application/json", text, strlen(text));
}

Reply reply_error(int status, const char *fmt, ...)
{
    char line[1024], *text = NULL;
    size_t bytes = 0;
    va_list args;
    va_start(args, fmt);
    vsnprintf(line, sizeof line, fmt, args);
    va_end(args);
    FILE *file = open_memstream(&text, &bytes);
    if (!file)
        return (Reply){status, NULL};
    fputs("{\"error\": ", file);
    json_text(file, line);
    fputs("}\n", file);
    if (fclose(file) != 0) {
        free(text);
        return (Reply){status, NULL};
    }
    return reply_bytes(status, "application/json", text, bytes);
}

Reply reply_of_error(const RetexError *err)
{
    const int status = err->code == RETEX_ENOMEM || err->code == RETEX_EIO ? MHD_HTTP_INTERNAL_SERVER_ERROR
                       : err->code == RETEX_EACCESS                        ? MHD_HTTP_FORBIDDEN
                       : err->code == RETEX_ENOTFOUND                      ? MHD_HTTP_NOT_FOUND
                                                                           : MHD_HTTP_UNPROCESSABLE_CONTENT;
    return reply_error(status, "%s", err->message);
}

json_t *json_of_text(const char *text)
{
    char *clean = malloc(3 * strlen(text) + 1), *out = clean;
    if (!clean)
        return NULL;
    for (int length; *text; text += length ? length : 1) {
        length = utf8_length(text);
        memcpy(out, length ? text : "\xef\xbf\xbd", (size_t)(length ? length : 3));
        out += length ? length : 3;
    }
    json_t *value = json_stringn(clean, (size_t)(out - clean));
    free(clean);
    return value;
}
