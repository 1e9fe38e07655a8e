/* See deflate.h. */
#include "deflate.h"

#include <limits.h>
#include <zlib.h>

enum { LEVEL = 1 };

size_t retex_deflate_room(size_t bytes)
{
    return bytes + bytes / 8 + bytes / 64 + 64; /* as deflateBound of any parameters */
}

size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, int is_last)
{
    z_stream stream = {0};

    if (count > UINT_MAX || room > UINT_MAX ||
        deflateInit2(&stream, LEVEL, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL, Z_RLE) != Z_OK)
        return 0;
    stream.next_in = (unsigned char *)bytes;
    stream.avail_in = (uInt)count;
    stream.next_out = packed;
    stream.avail_out = (uInt)room;
    const int code = deflate(&stream, is_last ? Z_FINISH : Z_SYNC_FLUSH);
    const int ok = is_last ? code == Z_STREAM_END : code == Z_OK && stream.avail_out > 0;
    const size_t packed_bytes = stream.total_out;
    deflateEnd(&stream);
    return ok ? packed_bytes : 0;
}
