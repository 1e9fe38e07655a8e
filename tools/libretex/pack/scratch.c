/* See scratch.h. */
#include "pack/scratch.h"

#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"

int retex_pack_scratch_reserve(RetexPackScratch *s, const RetexPackPart *p, RetexError *err)
{
    const size_t pixels = (size_t)p->width * RETEX_PACK_STRIP_ROWS;
    if (pixels <= s->pixels)
        return 0;
    free(s->residuals);
    free(s->shift);
    const RetexPackPlane plane = {.width = p->width, .rows = RETEX_PACK_STRIP_ROWS};
    s->residuals = malloc(retex_pack_plane_bound(&plane));
    s->shift = malloc(pixels);
    s->pixels = s->residuals && s->shift ? pixels : 0;
    return s->pixels ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
}

int retex_pack_read_slice(int part, int k, size_t before, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    const size_t bytes = p->bytes[k];
    if (before + bytes > s->slice_capacity) {
        unsigned char *slice = realloc(s->slice, before + bytes + 4096);
        if (!slice)
            return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
        s->slice = slice;
        s->slice_capacity = before + bytes + 4096;
    }
    if (bytes && (retex_input_read(s->pack->input, s->slice + before, bytes, p->offsets[k]) != (int64_t)bytes ||
                  retex_crc32(CRC32_OF_NONE, s->slice + before, bytes) != p->crcs[k]))
        return retex_input_check(
            s->pack->input, retex_pack_damaged(err, "the checksum is wrong of part", s->pack->set->parts[part].name),
            err);
    return 0;
}

int retex_pack_any_nonzero(const void *data, size_t bytes)
{
    const unsigned char *at = data;
    size_t i = 0;
    for (uint64_t some[8]; i + 64 <= bytes; i += 64) {
        memcpy(some, at + i, sizeof some);
        if (some[0] | some[1] | some[2] | some[3] | some[4] | some[5] | some[6] | some[7])
            return 1;
    }
    for (; i < bytes; i++)
        if (at[i])
            return 1;
    return 0;
}
