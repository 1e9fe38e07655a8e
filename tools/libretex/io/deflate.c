/* See deflate.h. */
#include "io/deflate.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <isa-l/igzip_lib.h>

/* Levels 1 and 2 are faster still, but their output depends on the address of their memory: the same render would not
 * always make the same file. Blocks are of 16384 codes, so that the Huffman codes follow the planes of the data. */
enum { LEVEL = 3, LEVEL_BYTES = ISAL_DEF_LVL3_SMALL };

typedef struct Deflater {
    struct isal_zstream stream;
    unsigned char level[LEVEL_BYTES];
} Deflater;

size_t retex_deflate_scratch_bytes(void)
{
    return sizeof(Deflater) > sizeof(struct inflate_state) ? sizeof(Deflater) : sizeof(struct inflate_state);
}

size_t retex_deflate_bound(size_t bytes)
{
    return bytes + bytes / 64 + 512; /* stored blocks of 65535 bytes take less */
}

size_t retex_deflate(void *scratch, unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                     int is_last)
{
    Deflater *deflater = scratch ? scratch : malloc(sizeof *deflater);
    size_t packed_bytes = 0;

    if (!deflater || count > UINT32_MAX || capacity > UINT32_MAX)
        goto done;
    struct isal_zstream *stream = &deflater->stream;
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; /* search the whole window of 32 KB; isal_deflate_stateless_init leaves the old value */
    stream->level = LEVEL, stream->level_buf = deflater->level, stream->level_buf_size = LEVEL_BYTES;
    stream->end_of_stream = is_last, stream->flush = is_last ? NO_FLUSH : FULL_FLUSH;
    stream->next_in = (uint8_t *)bytes, stream->avail_in = (uint32_t)count;
    stream->next_out = packed, stream->avail_out = (uint32_t)capacity;
    if (isal_deflate_stateless(stream) == COMP_OK && stream->avail_in == 0)
        packed_bytes = stream->total_out;
done:
    if (!scratch)
        free(deflater);
    return packed_bytes;
}

size_t retex_deflate_stored(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                            int is_last)
{
    enum { BLOCK = 65535, HEAD = 5 };
    const size_t blocks = count ? (count + BLOCK - 1) / BLOCK : 1;

    if (count > capacity || blocks * HEAD > capacity - count)
        return 0;
    for (size_t block = 0; block < blocks; block++) {
        const size_t left = count - block * BLOCK, length = left < BLOCK ? left : BLOCK;
        packed[0] = is_last && block + 1 == blocks;
        packed[1] = (unsigned char)length, packed[2] = (unsigned char)(length >> 8);
        packed[3] = (unsigned char)~length, packed[4] = (unsigned char)(~length >> 8);
        memcpy(packed + HEAD, bytes, length);
        packed += HEAD + length, bytes += length;
    }
    return count + blocks * HEAD;
}

int retex_inflate(void *scratch, unsigned char *bytes, size_t count, const unsigned char *packed, size_t packed_bytes)
{
    struct inflate_state *state = scratch ? scratch : malloc(sizeof *state);
    int ok = 0;

    if (!state || count > UINT32_MAX || packed_bytes > UINT32_MAX)
        goto done;
    isal_inflate_init(state);
    state->crc_flag = ISAL_ZLIB;
    state->next_in = (uint8_t *)packed, state->avail_in = (uint32_t)packed_bytes;
    state->next_out = bytes, state->avail_out = (uint32_t)count;
    ok = isal_inflate_stateless(state) == ISAL_DECOMP_OK && state->total_out == count;
done:
    if (!scratch)
        free(state);
    return ok;
}
