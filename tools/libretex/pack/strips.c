/* Decoding packs strip by strip. Every slice must have its checksum, and no memory is taken that its bytes could not
 * fill. */
#include "pack/scratch.h"
#include "pack/strips.h"

#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

int retex_pack_scratch_create(RetexPackScratch **result, const RetexPack *pack, RetexError *err)
{
    RetexPackScratch *s = *result = calloc(1, sizeof *s);
    int code = s ? 0 : RETEX_ENOMEM;
    if (s) {
        s->pack = pack;
        s->nparts = pack->nparts;
        s->cached = calloc((size_t)pack->nparts + 1, sizeof *s->cached);
        code = s->cached ? 0 : RETEX_ENOMEM;
    }
    for (int i = 0; !code && i < s->nparts; i++) {
        s->cached[i].strip = -1;
        retex_pack_plane_strip_init(&s->cached[i].planes);
    }
    if (!code)
        return 0;
    retex_pack_scratch_close(result);
    return retex_fail(err, code, "no memory to read a pack");
}

void retex_pack_scratch_close(RetexPackScratch **result)
{
    RetexPackScratch *s = result ? *result : NULL;
    if (!s)
        return;
    for (int i = 0; s->cached && i < s->nparts; i++) {
        free(s->cached[i].rows);
        free(s->cached[i].mask);
        retex_pack_plane_strip_free(&s->cached[i].planes);
        retex_pack_jpeg_decoder_close(&s->cached[i].jpeg);
    }
    free(s->cached);
    free(s->slice);
    free(s->residuals);
    free(s->shift);
    free(s);
    *result = NULL;
}

const RetexPack *retex_pack_of_scratch(const RetexPackScratch *scratch)
{
    return scratch->pack;
}

/* ---- JPEGs ---- */

/* Have the mask of a strip, bits of bytes, and know whether it leaves any pixel. */
static int decode_mask(int part, int strip, RetexPackCachedStrip *cached, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    const int k = 1 + p->nstrips + strip, rows = retex_pack_strip_rows(p, strip), width = retex_pack_mask_width(p);
    int code = cached->mask || (cached->mask = malloc((size_t)width * RETEX_PACK_STRIP_ROWS))
                   ? retex_pack_read_slice(part, k, 0, s, err)
                   : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    const RetexPackPlane plane = {.width = width, .rows = rows, .bits = 8, .codes = cached->mask};
    if (!code && !retex_pack_plane_decode(&plane, s->slice, p->bytes[k], s->residuals))
        code = retex_pack_damaged(err, "the mask cannot be decoded of part", s->pack->set->parts[part].name);
    const int last = 255 >> (8 * width - p->width);
    int every = 255; /* bits that all pixels have */
    for (int y = 0; !code && y < rows; y++)
        for (int x = 0; x < width; x++)
            every &= cached->mask[y * width + x] | (x == width - 1 ? ~last : 0);
    cached->is_black = every == 255;
    return code;
}

/* Make pixels of a row black whose bit is set. */
static void apply_mask(const RetexPackPart *p, float *out, const unsigned char *mask)
{
    const size_t channels = (size_t)p->channels;
    for (int x = 0; x < p->width; x += 8) {
        const int whole = mask[x / 8] == 255 && x + 8 <= p->width;
        if (whole)
            memset(out + (size_t)x * channels, 0, 8 * channels * sizeof *out);
        for (int k = 0; !whole && mask[x / 8] && k < 8 && x + k < p->width; k++)
            if (mask[x / 8] >> k & 1)
                memset(out + (size_t)(x + k) * channels, 0, channels * sizeof *out);
    }
}

static int jpeg_damaged(RetexError *err, int code, const RetexError *why, const RetexPackScratch *s, int part)
{
    if (code == RETEX_ENOMEM)
        return retex_fail(err, code, "%s", why->message);
    return retex_fail(err, code, "the pack is damaged: part '%s': %s", s->pack->set->parts[part].name, why->message);
}

/* Have the coefficients of a strip. */
static int open_jpeg(int part, int strip, RetexPackCachedStrip *cached, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    RetexError why = {0};
    int code = retex_pack_scratch_reserve(s, p, err);
    cached->blocks = -1;
    cached->lit = 0;
    cached->is_black = 0;
    if (!code && !cached->jpeg)
        code = retex_pack_jpeg_decoder_create(&cached->jpeg, err);
    if (!code && p->masked)
        code = decode_mask(part, strip, cached, s, err);
    if (code || cached->is_black) /* what the JPEG has here means nothing */
        return code;
    code = retex_pack_read_slice(part, 0, 0, s, err);
    if (!code)
        code = retex_pack_read_slice(part, 1 + strip, p->bytes[0], s, err);
    if (code)
        return code;
    code = retex_pack_jpeg_open_strip(cached->jpeg, s->slice, p->bytes[0], (size_t)p->bytes[0] + p->bytes[1 + strip],
                                      p->width, retex_pack_strip_rows(p, strip), p->channels, &p->curve, &why);
    return code ? jpeg_damaged(err, code, &why, s, part) : 0;
}

/* Have the row of blocks that a row of the strip is in. */
static int decode_blocks(int part, int line, RetexPackCachedStrip *cached, const RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    const int blocks = line / RETEX_PACK_BLOCK_ROWS, first = blocks * RETEX_PACK_BLOCK_ROWS;
    const size_t row = (size_t)p->width * (size_t)p->channels;
    RetexError why = {0};
    RETEX_ASSERT(cached->strip >= 0 && cached->jpeg); /* of the strip that is open */
    if (cached->blocks == blocks || cached->is_black)
        return 0;
    cached->blocks = -1;
    int code = retex_pack_jpeg_decode_blocks(cached->jpeg, blocks, cached->rows, &why);
    if (code)
        return jpeg_damaged(err, code, &why, s, part);
    cached->blocks = blocks;
    cached->lit = 0;
    for (int y = 0; y < RETEX_PACK_BLOCK_ROWS && first + y < retex_pack_strip_rows(p, cached->strip); y++) {
        float *values = cached->rows + (size_t)y * row;
        if (p->masked)
            apply_mask(p, values, cached->mask + (size_t)(first + y) * (size_t)retex_pack_mask_width(p));
        cached->lit |= (uint64_t)retex_pack_any_nonzero(values, row * sizeof *values) << (first + y);
    }
    return 0;
}

/* ---- any part ---- */

/* How many rows of a part's strip are kept. */
static int kept_rows(const RetexPackPart *p)
{
    return p->codec == RETEX_PACK_JPEG ? RETEX_PACK_BLOCK_ROWS : 1;
}

/* Have the strip in the cache. */
static int cache_strip(int part, int strip, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    const size_t row = (size_t)p->width * (size_t)p->channels;
    RetexPackCachedStrip *cached = &s->cached[part];
    if (cached->strip == strip)
        return 0;
    cached->strip = -1;
    if (!cached->rows && !(cached->rows = malloc(row * (size_t)kept_rows(p) * sizeof *cached->rows)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    int code = p->codec == RETEX_PACK_JPEG ? open_jpeg(part, strip, cached, s, err)
                                           : retex_pack_plane_strip_decode(part, strip, &cached->lit, s, err);
    cached->strip = code ? -1 : strip;
    return code;
}

int retex_pack_row(RetexPackScratch *s, int part, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    *row = NULL;
    if (part < 0 || part >= s->pack->nparts || y < 0 || y >= s->pack->parts[part].height)
        return retex_fail(err, RETEX_EINVAL, "the pack has no such rows");
    const RetexPackPart *p = &s->pack->parts[part];
    RetexPackCachedStrip *cached = &s->cached[part];
    const int strip = y / RETEX_PACK_STRIP_ROWS, line = y % RETEX_PACK_STRIP_ROWS;
    *span = (RetexRowSpan){0, p->width};
    if (p->codec == RETEX_PACK_ZERO)
        return 0;
    int code = cache_strip(part, strip, s, err);
    if (!code && p->codec == RETEX_PACK_JPEG)
        code = decode_blocks(part, line, cached, s, err);
    if (code || !(cached->lit >> line & 1))
        return code;
    if (p->codec == RETEX_PACK_PLANES)
        code = retex_pack_plane_strip_row(part, strip, line, cached->rows, span, s, err);
    if (!code)
        *row = cached->rows + (size_t)(line % kept_rows(p)) * (size_t)p->width * (size_t)p->channels;
    return code;
}
