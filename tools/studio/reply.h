/* What a request is answered by. */
#ifndef RETEX_STUDIO_REPLY_H
#define RETEX_STUDIO_REPLY_H

#include <jansson.h>
#include <microhttpd.h>
#include <stddef.h>
#include <sys/types.h>

#include <retex/error.h>

#include "common/json.h"

/* response NULL: there was no memory; the connection is closed. */
typedef struct Reply {
    int status;
    struct MHD_Response *response;
} Reply;

/* A value, which is taken over; NULL is an error for want of memory. */
Reply reply_json(int status, json_t *value);
/* `{"error": "one plain line"}` */
Reply reply_error(int status, const char *fmt, ...) RETEX_PRINTF(2, 3);
/* An error of the library; its code says whose fault it is. */
Reply reply_of_error(const RetexError *err);
/* Bytes from malloc, which are taken over. */
Reply reply_bytes(int status, const char *type, void *data, size_t bytes);
/* Bytes that stay where they are as long as the program runs. */
Reply reply_constant(const char *type, const void *data, size_t bytes);
/* An open file, which is closed with the answer: `count` bytes from `first` on. */
Reply reply_file(int status, const char *type, int descriptor, off_t first, off_t count);

void reply_header(Reply *reply, const char *name, const char *value);

#endif
