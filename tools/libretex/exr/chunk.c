/* See chunk.h. */
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "exr/chunk.h"
#include "base/half.h"

/* Bytes of one stored sample. */
static size_t sample_bytes(RetexPixelType type)
{
    return type == RETEX_HALF ? 2 : 4;
}

size_t retex_chunk_plane(const RetexChunkShape *shape)
{
    return (size_t)shape->width * (size_t)shape->lines * sample_bytes(shape->type);
}

size_t retex_chunk_bytes(const RetexChunkShape *shape)
{
    return retex_chunk_plane(shape) * strlen(shape->letters);
}

int retex_chunk_room(void **memory, size_t *have, size_t want, size_t unit)
{
    if (*have >= want)
        return 1;
    free(*memory);
    *memory = malloc(want * unit);
    *have = *memory ? want : 0;
    return *memory != NULL;
}

int retex_chunk_reserve(RetexChunkScratch *scratch, const RetexChunkShape *shape)
{
    const size_t line = (size_t)shape->width * strlen(shape->letters);

    return retex_chunk_room((void **)&scratch->raw, &scratch->raw_bytes, retex_chunk_bytes(shape), 1) &&
           retex_chunk_room((void **)&scratch->halves, &scratch->halves_count, line, 2) &&
           retex_zip_reserve(&scratch->zip, retex_chunk_bytes(shape));
}

void retex_chunk_free(RetexChunkScratch *scratch)
{
    retex_zip_free(&scratch->zip);
    free(scratch->raw);
    free(scratch->halves);
    *scratch = (RetexChunkScratch){.raw = NULL};
}

/* EXR keeps channels in alphabetical order: order[i] is the index of the letter that comes i-th. */
static void channel_order(const char *letters, int count, int *order)
{
    for (int i = 0; i < count; i++) {
        int place = i;
        for (; place > 0 && letters[order[place - 1]] > letters[i]; place--)
            order[place] = order[place - 1];
        order[place] = i;
    }
}

static void take_plane_half(uint16_t *restrict out, const uint16_t *restrict in, int width, int stride)
{
    for (int x = 0; x < width; x++)
        out[x] = in[(size_t)x * (size_t)stride];
}

static void take_plane_float(unsigned char *restrict out, const float *restrict in, int width, int stride)
{
    for (int x = 0; x < width; x++)
        memcpy(out + (size_t)x * 4, &in[(size_t)x * (size_t)stride], 4);
}

void retex_chunk_encode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const float *pixels,
                        unsigned char *raw, uint32_t *crc)
{
    const int channels = (int)strlen(shape->letters);
    const size_t line = (size_t)shape->width * (size_t)channels,
                 plane = (size_t)shape->width * sample_bytes(shape->type);
    int order[RETEX_EXR_LETTERS_MAX];

    channel_order(shape->letters, channels, order);
    for (int c = 0; c < channels && crc; c++)
        crc[c] = CRC32_OF_NONE;
    for (int y = 0; y < shape->lines; y++, pixels += line) {
        if (shape->type == RETEX_HALF)
            retex_half_from_float(scratch->halves, pixels, line);
        for (int i = 0; i < channels; i++, raw += plane) {
            const int c = order[i];
            if (shape->type == RETEX_HALF)
                take_plane_half((uint16_t *)(void *)raw, scratch->halves + c, shape->width, channels);
            else
                take_plane_float(raw, pixels + c, shape->width, channels);
            if (crc)
                crc[c] = retex_crc32(crc[c], raw, plane);
        }
    }
}

void retex_chunk_decode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const unsigned char *raw,
                        float *pixels)
{
    const int channels = (int)strlen(shape->letters);
    const size_t line = (size_t)shape->width * (size_t)channels,
                 plane = (size_t)shape->width * sample_bytes(shape->type);
    int order[RETEX_EXR_LETTERS_MAX];

    channel_order(shape->letters, channels, order);
    for (int y = 0; y < shape->lines; y++, pixels += line) {
        for (int i = 0; i < channels; i++, raw += plane)
            for (size_t x = 0; x < (size_t)shape->width; x++) {
                const size_t at = x * (size_t)channels + (size_t)order[i];
                if (shape->type == RETEX_HALF)
                    memcpy(&scratch->halves[at], raw + 2 * x, 2);
                else
                    memcpy(&pixels[at], raw + 4 * x, 4);
            }
        if (shape->type == RETEX_HALF)
            retex_half_to_float(pixels, scratch->halves, line);
    }
}

int retex_chunk_fits_pxr24(const RetexChunkShape *shape, const unsigned char *raw)
{
    return shape->type == RETEX_FLOAT && retex_pxr24_fits(raw, retex_chunk_bytes(shape));
}

size_t retex_chunk_compress(RetexChunkScratch *scratch, const RetexChunkShape *shape, int pxr24,
                            const unsigned char *raw, unsigned char *packed)
{
    const size_t bytes = retex_chunk_bytes(shape);
    const size_t packed_bytes = pxr24 ? retex_pxr24_pack(&scratch->zip, packed, raw, bytes, (size_t)shape->width)
                                      : retex_zip_pack(&scratch->zip, packed, raw, bytes);

    if (packed_bytes)
        return packed_bytes;
    memcpy(packed, raw, bytes); /* compression gained nothing: stored uncompressed */
    return bytes;
}

int retex_chunk_decompress(RetexChunkScratch *scratch, const RetexChunkShape *shape, int pxr24,
                           const unsigned char *packed, size_t packed_bytes, unsigned char *raw)
{
    const size_t bytes = retex_chunk_bytes(shape);

    if (packed_bytes != bytes)
        return pxr24 ? retex_pxr24_unpack(&scratch->zip, raw, bytes, packed, packed_bytes, (size_t)shape->width)
                     : retex_zip_unpack(&scratch->zip, raw, bytes, packed, packed_bytes);
    memcpy(raw, packed, bytes);
    return 1;
}
