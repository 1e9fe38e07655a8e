/* The head of a request, field by field as libmicrohttpd tells it: whether two programs may read it differently, which
 * is how one request is hidden in another (RFC 9112, section 11.2). libmicrohttpd is lenient: it takes a second
 * Content-Length, names with spaces, lines that are continued, and ends values at a NUL. Strings of a head that it has
 * understood lie in its buffer one after the other, with nothing between them but what divides them, so that whatever
 * was left out or moved shows as a gap. */
#ifndef RETEX_HTTP_HEAD_H
#define RETEX_HTTP_HEAD_H

#include <stddef.h>

typedef struct HeadCheck {
    const char *at;  /* where the next field must begin; NULL: the layout is not known, and not checked */
    const char *end; /* of the head */
    int hosts, lengths, encodings;
    int is_old;        /* 1: HTTP/1.0, which needs no Host */
    int status;        /* 0, or that of a refusal */
    const char *fault; /* why, for the answer; NULL: nothing is wrong */
} HeadCheck;

/* The first line: its URL, where it came url_end is behind its NUL; `bytes` are those of the whole head, 0 where its
 * layout is not known. */
void head_begin(HeadCheck *check, const char *method, const char *url, const char *url_end, const char *version,
                size_t bytes);
/* Each field, in the order in which they came. */
void head_field(HeadCheck *check, const char *name, const char *value);
/* After the last one. Returns the status of a refusal, or 0. */
int head_end(HeadCheck *check);

#endif
