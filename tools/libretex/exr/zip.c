/* OpenEXR's ZIP compression of one chunk.
 *
 * The bytes at even positions come first, those at odd positions after them, so that the high bytes of halves are
 * together; each byte becomes its difference from the one before, plus 128; the result is a zlib stream. It is
 * implemented here rather than through OpenEXRCore's pipelines so that chunks can be compressed on all threads before
 * the file is open, and every byte of a damaged chunk is checked. */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "io/deflate.h"
#include "exr/zip.h"
#include "exr/zip_kernel.h"

enum { HEAD = 2, TAIL = 4 }; /* bytes of a zlib stream's header and of its checksum */

int retex_zip_reserve(RetexZip *zip, size_t bytes)
{
    if (!zip->work && !(zip->work = malloc(retex_deflate_scratch_bytes())))
        return 0;
    if (zip->scratch_bytes >= 2 * bytes)
        return 1;
    free(zip->scratch);
    zip->scratch = malloc(2 * bytes);
    zip->scratch_bytes = zip->scratch ? 2 * bytes : 0;
    return zip->scratch != NULL;
}

/* Bytes with more entropy than this many bits each are stored uncompressed: deflate would save at most a sixteenth. The
 * low bytes of continuous values are like that. */
static const double NOISE_BITS = 7.5;

static int is_noise(const unsigned char *bytes, size_t count)
{
    enum { STEP = 512, RUN = 64, LEAST = 1 << 13 }; /* entropy is estimated from a run of RUN bytes in every STEP */
    unsigned long counts[256] = {0}, all = 0;
    double sum = 0;
    if (count < LEAST)
        return 0;
    for (size_t begin = 0; begin + RUN <= count; begin += STEP, all += RUN)
        for (size_t i = begin; i < begin + RUN; i++)
            counts[bytes[i]]++;
    for (int i = 0; i < 256; i++)
        sum += counts[i] ? (double)counts[i] * log2((double)counts[i]) : 0;
    return log2((double)all) - sum / (double)all > NOISE_BITS;
}

/* Deflates the raw stream of a chunk: its low bytes, then its high ones. */
static size_t deflate_chunk(void *work, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                            size_t count)
{
    const size_t low = (count + 1) / 2;
    if (!is_noise(bytes, low))
        return retex_deflate(work, packed, capacity, bytes, count, 1);
    const size_t stored = retex_deflate_stored(packed, capacity, bytes, low, 0);
    const size_t coded =
        stored ? retex_deflate(work, packed + stored, capacity - stored, bytes + low, count - low, 1) : 0;
    return coded ? stored + coded : 0;
}

/* Puts the header and the checksum of a zlib stream around `coded` bytes, deflated from data. */
static size_t finish_stream(unsigned char *packed, size_t coded, const unsigned char *data, size_t bytes)
{
    if (!coded)
        return 0;
    const uint32_t sum = retex_adler32(ADLER32_OF_NONE, data, bytes);
    memcpy(packed, "\x78\x01", HEAD); /* deflate, 32 KB, fastest */
    for (int k = 0; k < TAIL; k++)
        packed[HEAD + coded + (size_t)k] = (unsigned char)(sum >> 8 * (TAIL - 1 - k));
    return HEAD + coded + TAIL;
}

size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes)
{
    if (bytes <= HEAD + TAIL || bytes > INT_MAX)
        return 0;
    retex_exr_zip_regroup(zip->scratch, raw, bytes);
    retex_exr_zip_difference(zip->scratch + bytes, zip->scratch, bytes);
    /* a chunk as long as its data would be read as uncompressed */
    const size_t coded = deflate_chunk(zip->work, packed + HEAD, bytes - 1 - HEAD - TAIL, zip->scratch + bytes, bytes);
    return finish_stream(packed, coded, zip->scratch + bytes, bytes);
}

int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes)
{
    if (!retex_inflate(zip->work, zip->scratch, bytes, packed, packed_bytes))
        return 0;
    retex_exr_zip_accumulate(zip->scratch, bytes);
    retex_exr_zip_interleave(raw, zip->scratch, bytes);
    return 1;
}

int retex_pxr24_fits(const unsigned char *raw, size_t bytes)
{
    uint32_t all = 0;
    for (size_t i = 0; i < bytes / 4; i++) {
        uint32_t value;
        memcpy(&value, raw + 4 * i, 4);
        all |= value;
    }
    return (all & 255) == 0;
}

size_t retex_pxr24_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes, size_t width)
{
    const size_t count = bytes / 4 * 3;
    if (bytes <= 4 * (HEAD + TAIL) || bytes > INT_MAX)
        return 0;
    for (size_t line = 0; line < bytes / 4; line += width)
        retex_exr_pxr24_difference(zip->scratch + 3 * line, raw + 4 * line, width);
    const size_t coded = retex_deflate(zip->work, packed + HEAD, bytes - 1 - HEAD - TAIL, zip->scratch, count, 1);
    return finish_stream(packed, coded, zip->scratch, count);
}

int retex_pxr24_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed,
                       size_t packed_bytes, size_t width)
{
    if (!retex_inflate(zip->work, zip->scratch, bytes / 4 * 3, packed, packed_bytes))
        return 0;
    for (size_t line = 0; line < bytes / 4; line += width)
        retex_exr_pxr24_accumulate(raw + 4 * line, zip->scratch + 3 * line, width);
    return 1;
}

void retex_zip_free(RetexZip *zip)
{
    free(zip->scratch);
    free(zip->work);
    *zip = (RetexZip){0};
}
