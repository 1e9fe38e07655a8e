/* Headers of requests: what is compared with an answer. */
#ifndef RETEX_HTTP_HEADERS_H
#define RETEX_HTTP_HEADERS_H

#include <stddef.h>

/* Whether a list of entity tags, as of If-None-Match, has this one, or is `*`. Weak tags count. */
int header_has_etag(const char *list, const char *etag);

typedef enum RangeKind { RANGE_NONE, RANGE_SOME, RANGE_OUTSIDE } RangeKind;
/* One range of bytes, of `bytes` that there are: RANGE_SOME with *first <= *last; RANGE_NONE where the header is
 * absent, not understood, or has several ranges, which are answered by the whole. */
RangeKind header_range(const char *range, size_t bytes, size_t *first, size_t *last);

/* "https://host:port" by the headers Host and X-Forwarded-Proto; "" where they are absent or odd. Returns text. */
const char *header_base(char *text, size_t size, const char *host, const char *protocol);

#endif
