/* FNV-1a hashes, of 64 bits, and of 128 for entity tags. They find changes; they are not made for adversaries, so that
 * whoever compares hashes of what strangers chose compares the whole as well. */
#ifndef RETEX_HTTP_HASH_H
#define RETEX_HTTP_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define HASH_BEGIN UINT64_C(14695981039346656037)

static inline uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    for (const unsigned char *c = bytes; count > 0; c++, count--)
        hash = (hash ^ *c) * UINT64_C(1099511628211);
    return hash;
}

static inline uint64_t hash_text(uint64_t hash, const char *text)
{
    return hash_bytes(hash, text, strlen(text));
}

typedef struct Hash128 {
    uint64_t high, low;
} Hash128;

#define HASH128_BEGIN {UINT64_C(0x6c62272e07bb0142), UINT64_C(0x62b821756295c58d)}

static inline Hash128 hash128_text(Hash128 hash, const char *text)
{
    unsigned __int128 value = (unsigned __int128)hash.high << 64 | hash.low;
    const unsigned __int128 prime = (unsigned __int128)0x1000000 << 64 | 0x13b;
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        value = (value ^ *c) * prime;
    return (Hash128){(uint64_t)(value >> 64), (uint64_t)value};
}

#endif
