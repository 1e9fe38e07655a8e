/* OpenEXR's ZIP compression of one chunk.
 *
 * The bytes at even positions go first, those at odd positions after them, so that the high bytes of halves lie side by
 * side; each byte becomes its difference from the one before, plus 128; the result is a zlib stream. Doing it here
 * rather than through OpenEXRCore's pipelines lets chunks be compressed on all threads before the file is even open,
 * and every byte of a damaged chunk be accounted for. */
#include <limits.h>
#include <stdlib.h>
#include <zlib.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "exr_zip.h"

/* Radiance has noise in its low bits, where looking for repetitions finds few: coding runs and frequencies only (Z_RLE)
 * packs a rendered set 8% less tightly than level 4 does, at twice its speed, three times on pure noise. Writing counts
 * as part of a render; who wants a small file packs it. */
static int start_deflating(z_stream *stream)
{
    return deflateInit2(stream, 1, Z_DEFLATED, 15, 9, Z_RLE);
}

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

/* A deflater, or where inflating, an inflater, ready for a new stream. */
static z_stream *ready(void **slot, int inflating)
{
    z_stream *stream = *slot;

    if (stream)
        return (inflating ? inflateReset(stream) : deflateReset(stream)) == Z_OK ? stream : NULL;
    stream = calloc(1, sizeof *stream);
    if (!stream)
        return NULL;
    if ((inflating ? inflateInit(stream) : start_deflating(stream)) != Z_OK) {
        free(stream);
        return NULL;
    }
    *slot = stream;
    return stream;
}

size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes)
{
    z_stream *stream = ready(&zip->deflater, 0);

    if (!stream || bytes < 2 || bytes > INT_MAX || !need_scratch(zip, 2 * bytes))
        return 0;
    regroup(zip->scratch, raw, bytes);
    difference(zip->scratch + bytes, zip->scratch, bytes);
    stream->next_in = zip->scratch + bytes;
    stream->avail_in = (uInt)bytes;
    stream->next_out = packed;
    stream->avail_out = (uInt)bytes - 1; /* a chunk as long as its data would be taken for uncompressed */
    return deflate(stream, Z_FINISH) == Z_STREAM_END ? stream->total_out : 0;
}

int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes)
{
    z_stream *stream = ready(&zip->inflater, 1);

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
    if (zip->deflater)
        deflateEnd(zip->deflater);
    if (zip->inflater)
        inflateEnd(zip->inflater);
    free(zip->deflater);
    free(zip->inflater);
    free(zip->scratch);
    *zip = (RetexZip){0};
}
