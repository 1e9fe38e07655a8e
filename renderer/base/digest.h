/* A number that tells whether things are the same: of files, options and pixels, to recognise a render by. Not against
 * those who want to deceive. */
#ifndef RENDERER_BASE_DIGEST_H
#define RENDERER_BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define DIGEST_BEGIN 0xcbf29ce484222325u

static inline uint64_t digest_number(uint64_t digest, uint64_t value)
{
    digest = (digest ^ value) * 0x9e3779b97f4a7c15u;
    return digest ^ digest >> 29;
}

/* With their count, so that two pieces are not one. */
static inline uint64_t digest_bytes(uint64_t digest, const void *bytes, size_t count)
{
    const unsigned char *from = bytes;
    digest = digest_number(digest, count);
    for (; count >= 8; from += 8, count -= 8) {
        uint64_t word;
        memcpy(&word, from, 8);
        digest = digest_number(digest, word);
    }
    for (; count; from++, count--)
        digest = digest_number(digest, *from);
    return digest;
}

static inline uint64_t digest_text(uint64_t digest, const char *text)
{
    return digest_bytes(digest, text, strlen(text));
}

#endif
