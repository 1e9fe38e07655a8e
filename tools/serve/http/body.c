/* See body.h. */
#include "serve/http/body.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <nettle/base16.h>

static Answer *too_large(const Uploads *uploads)
{
    return answer_error(413, "an image may have %zu bytes", uploads_most_bytes(uploads));
}

Answer *body_begin(Body *body, Uploads *uploads, const char *content_length)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long length = content_length ? strtoull(content_length, &end, 10) : 0;
    if (content_length && (errno || *end || end == content_length || length > uploads_most_bytes(uploads)))
        return too_large(uploads);
    if (!uploads_enter(uploads))
        return answer_error(503, "too many images are being received");
    body->uploads = uploads;
    sha256_init(&body->hash);
    return NULL;
}

/* The allocation grows with what has come, whatever the header promised. */
static int grow(Body *body, size_t bytes)
{
    size_t size = body->size ? body->size : 64 << 10;
    while (size < bytes)
        size *= 2;
    if (size == body->size)
        return 0;
    if (!uploads_take_memory(body->uploads, size - body->taken))
        return -1;
    body->taken = size;
    char *data = realloc(body->data, size);
    if (!data)
        return -1;
    body->data = data;
    body->size = size;
    return 0;
}

int body_add(Body *body, const void *data, size_t bytes)
{
    const size_t most = uploads_most_bytes(body->uploads);
    if (body->beyond || bytes > most - body->bytes) {
        body->beyond += bytes;
        return body->beyond > most ? -1 : 0;
    }
    if (body->is_lost || grow(body, body->bytes + bytes)) {
        body->is_lost = 1;
        return 0;
    }
    memcpy(body->data + body->bytes, data, bytes);
    sha256_update(&body->hash, bytes, data);
    body->bytes += bytes;
    return 0;
}

Answer *body_complete(Body *body, char hash[UPLOAD_HASH_TEXT])
{
    uint8_t digest[SHA256_DIGEST_SIZE];
    if (body->beyond)
        return too_large(body->uploads);
    if (body->is_lost)
        return answer_error(503, "the server is busy");
    sha256_digest(&body->hash, sizeof digest, digest);
    base16_encode_update(hash, sizeof digest, digest);
    hash[2 * sizeof digest] = 0;
    return NULL;
}

void body_free(Body *body)
{
    if (!body->uploads)
        return;
    uploads_leave(body->uploads, body->taken);
    free(body->data);
    *body = (Body){0};
}
