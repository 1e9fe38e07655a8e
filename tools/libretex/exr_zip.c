/* OpenEXR's ZIP compression of one chunk.
 *
 * The bytes at even positions go first, those at odd positions after them, so that the high bytes of halves lie side by
 * side; each byte becomes its difference from the one before, plus 128; the result is a zlib stream. Doing it here
 * rather than through OpenEXRCore's pipelines lets chunks be compressed on all threads before the file is even open,
 * and every byte of a damaged chunk be accounted for. */
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "deflate.h"
#include "exr_zip.h"

enum { HEAD = 2, TAIL = 4 }; /* of a zlib stream: what it is, and a checksum */

static int need_scratch(RetexZip *zip, size_t bytes)
{
    if (zip->scratch_bytes >= bytes)
        return 1;
    free(zip->scratch);
    zip->scratch = malloc(bytes);
    zip->scratch_bytes = zip->scratch ? bytes : 0;
    return zip->scratch != NULL;
}

static void regroup(unsigned char *restrict out, const unsigned char *restrict raw, size_t bytes)
{
    unsigned char *restrict odd = out + (bytes + 1) / 2;

    for (size_t i = 0; i < bytes / 2; i++) {
        out[i] = raw[2 * i];
        odd[i] = raw[2 * i + 1];
    }
    if (bytes & 1)
        out[bytes / 2] = raw[bytes - 1];
}

static void difference(unsigned char *restrict out, const unsigned char *restrict in, size_t bytes)
{
    out[0] = in[0];
    for (size_t i = 1; i < bytes; i++)
        out[i] = (unsigned char)(in[i] - in[i - 1] + 128);
}

/* Running sum: out[i] = out[i - 1] + in[i] - 128, in place. */
static void accumulate(unsigned char *data, size_t bytes)
{
    unsigned previous = 128;
    size_t i = 0;

#ifdef __SSE2__
    const __m128i bias = _mm_set1_epi8((char)-128);
    for (; i + 16 <= bytes; i += 16) {
        __m128i sum = _mm_add_epi8(_mm_loadu_si128((const __m128i *)(data + i)), bias);
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
        sum = _mm_add_epi8(sum, _mm_set1_epi8((char)previous));
        _mm_storeu_si128((__m128i *)(data + i), sum);
        previous = data[i + 15];
    }
#endif
    for (; i < bytes; i++) {
        previous = (previous + data[i] - 128) & 255;
        data[i] = (unsigned char)previous;
    }
}

static void interleave(unsigned char *restrict raw, const unsigned char *restrict in, size_t bytes)
{
    const unsigned char *restrict odd = in + (bytes + 1) / 2;
    size_t i = 0;

#ifdef __SSE2__
    for (; i + 16 <= bytes / 2; i += 16) {
        const __m128i low = _mm_loadu_si128((const __m128i *)(in + i));
        const __m128i high = _mm_loadu_si128((const __m128i *)(odd + i));
        _mm_storeu_si128((__m128i *)(raw + 2 * i), _mm_unpacklo_epi8(low, high));
        _mm_storeu_si128((__m128i *)(raw + 2 * i + 16), _mm_unpackhi_epi8(low, high));
    }
#endif
    for (; i < bytes / 2; i++) {
        raw[2 * i] = in[i];
        raw[2 * i + 1] = odd[i];
    }
    if (bytes & 1)
        raw[bytes - 1] = in[bytes / 2];
}

/* An inflater that is ready for a new stream. */
static z_stream *ready(void **slot)
{
    z_stream *stream = *slot;

    if (stream)
        return inflateReset(stream) == Z_OK ? stream : NULL;
    stream = calloc(1, sizeof *stream);
    if (!stream)
        return NULL;
    if (inflateInit(stream) != Z_OK) {
        free(stream);
        return NULL;
    }
    *slot = stream;
    return stream;
}

/* Radiance has noise in its low bits, where looking for repetitions finds few, and writing counts as part of a render:
 * who wants a small file packs it. */
size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes)
{
    if (bytes <= HEAD + TAIL || bytes > INT_MAX || !need_scratch(zip, 2 * bytes))
        return 0;
    regroup(zip->scratch, raw, bytes);
    difference(zip->scratch + bytes, zip->scratch, bytes);
    /* a chunk as long as its data would be taken for uncompressed */
    const size_t coded = retex_deflate(packed + HEAD, bytes - 1 - HEAD - TAIL, zip->scratch + bytes, bytes, 1);
    if (!coded)
        return 0;
    const uint32_t sum = (uint32_t)adler32_z(adler32(0, NULL, 0), zip->scratch + bytes, bytes);
    memcpy(packed, "\x78\x01", HEAD); /* deflate, 32 KB, fastest */
    for (int k = 0; k < TAIL; k++)
        packed[HEAD + coded + (size_t)k] = (unsigned char)(sum >> 8 * (TAIL - 1 - k));
    return HEAD + coded + TAIL;
}

int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes)
{
    z_stream *stream = ready(&zip->inflater);

    if (!stream || bytes > INT_MAX || packed_bytes > INT_MAX || !need_scratch(zip, bytes))
        return 0;
    stream->next_in = (unsigned char *)packed;
    stream->avail_in = (uInt)packed_bytes;
    stream->next_out = zip->scratch;
    stream->avail_out = (uInt)bytes;
    if (inflate(stream, Z_FINISH) != Z_STREAM_END || stream->total_out != bytes)
        return 0;
    accumulate(zip->scratch, bytes);
    interleave(raw, zip->scratch, bytes);
    return 1;
}

void retex_zip_free(RetexZip *zip)
{
    if (zip->inflater)
        inflateEnd(zip->inflater);
    free(zip->inflater);
    free(zip->scratch);
    *zip = (RetexZip){0};
}
