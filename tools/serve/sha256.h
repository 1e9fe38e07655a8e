/* SHA-256 (FIPS 180-4): names for what strangers send, so that nobody can make two files with one name. */
#ifndef RETEX_SERVE_SHA256_H
#define RETEX_SERVE_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { SHA256_TEXT = 65 }; /* hexadecimal digits and the end */

typedef struct Sha256 {
    uint32_t state[8];
    uint64_t bytes;
    unsigned char block[64]; /* the last bytes, fewer than 64 */
} Sha256;

void sha256_begin(Sha256 *hash);
void sha256_add(Sha256 *hash, const void *data, size_t bytes);
/* The hash as text; *hash is not to be used any more. */
const char *sha256_end(Sha256 *hash, char text[SHA256_TEXT]);

#endif
