/* See deflate.h. */
#include "deflate.h"

#include <stdint.h>
#include <stdlib.h>

#include <isa-l/igzip_lib.h>

enum { LEVEL = 1, ROOM_HEAD = 64, STORED = 65535, STORED_HEAD = 5 };

size_t retex_deflate_room(size_t bytes)
{
    return bytes + (bytes / STORED + 1) * STORED_HEAD + ROOM_HEAD;
}

size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, int is_last)
{
    struct isal_zstream stream = {0}; /* its init leaves out what the result depends on */

    if (count > UINT32_MAX || room > UINT32_MAX)
        return 0;
    isal_deflate_stateless_init(&stream);
    stream.level = LEVEL;
    stream.level_buf_size = ISAL_DEF_LVL1_DEFAULT;
    stream.level_buf = calloc(1, stream.level_buf_size);
    stream.end_of_stream = (uint16_t)is_last;
    stream.flush = is_last ? NO_FLUSH : FULL_FLUSH;
    stream.next_in = (uint8_t *)bytes;
    stream.avail_in = (uint32_t)count;
    stream.next_out = packed;
    stream.avail_out = (uint32_t)room;
    const int ok = stream.level_buf && isal_deflate_stateless(&stream) == COMP_OK && stream.avail_in == 0;
    free(stream.level_buf);
    return ok ? stream.total_out : 0;
}
