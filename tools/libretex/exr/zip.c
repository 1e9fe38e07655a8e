/* OpenEXR's ZIP compression of one chunk.
 *
 * The bytes at even positions come first, those at odd positions after them, so that the high bytes of halves are
 * together; each byte becomes its difference from the one before, plus 128; the result is a zlib stream. It is
 * implemented here rather than through OpenEXRCore's pipelines so that chunks can be compressed on all threads before
 * the file is open, and every byte of a damaged chunk is checked. */
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "exr/zip.h"
#include "exr/zip_kernel.h"

int retex_zip_reserve(RetexZip *zip, size_t bytes)
{
    if (!retex_zlib_open(&zip->zlib))
        return 0;
    if (zip->scratch_bytes >= 2 * bytes)
        return 1;
    free(zip->scratch);
    zip->scratch = malloc(2 * bytes);
    zip->scratch_bytes = zip->scratch ? 2 * bytes : 0;
    return zip->scratch != NULL;
}

size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes)
{
    if (bytes > INT_MAX)
        return 0;
    retex_exr_zip_regroup(zip->scratch, raw, bytes);
    retex_exr_zip_difference(zip->scratch + bytes, zip->scratch, bytes);
    /* a chunk as long as its data would be read as uncompressed */
    return retex_zlib_compress(&zip->zlib, packed, bytes - 1, zip->scratch + bytes, bytes);
}

int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes)
{
    if (!retex_zlib_decompress(&zip->zlib, zip->scratch, bytes, packed, packed_bytes))
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
    if (bytes > INT_MAX)
        return 0;
    for (size_t line = 0; line < bytes / 4; line += width)
        retex_exr_pxr24_difference(zip->scratch + 3 * line, raw + 4 * line, width);
    return retex_zlib_compress(&zip->zlib, packed, bytes - 1, zip->scratch, count);
}

int retex_pxr24_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed,
                       size_t packed_bytes, size_t width)
{
    if (!retex_zlib_decompress(&zip->zlib, zip->scratch, bytes / 4 * 3, packed, packed_bytes))
        return 0;
    for (size_t line = 0; line < bytes / 4; line += width)
        retex_exr_pxr24_accumulate(raw + 4 * line, zip->scratch + 3 * line, width);
    return 1;
}

void retex_zip_free(RetexZip *zip)
{
    free(zip->scratch);
    retex_zlib_close(&zip->zlib);
    *zip = (RetexZip){0};
}
