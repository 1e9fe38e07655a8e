/* Decoding packs band by band. Every chunk must have its checksum, and no memory is taken that its bytes could not
 * fill. */
#include "pack_open.h"

#include <stdlib.h>
#include <string.h>

#include "checksum.h"
#include "pack_combine.h"
#include "pack_model.h"
#include "pack_restore.h"

/* Of a JPEG its coefficients are kept, which are half as many bytes, and one row of blocks at a time, which is likelier
 * to be in the processor's cache when it is asked for. */
typedef struct CachedBand {
    int band;     /* -1: none */
    uint64_t lit; /* bit y: row y is not all 0; of a JPEG, of those that have been asked for */
    float *rows;  /* of a JPEG, PACK_BLOCK_ROWS of them */
    PackJpegDecoder *jpeg;
    int blocks;          /* which row of them is there; -1: none */
    unsigned char *mask; /* of the band, or NULL */
    int is_black;        /* by its mask */
} CachedBand;

/* A plane of codes, which the next part to be decoded often needs too: coverage and standard deviations. */
typedef struct CachedCodes {
    int part, band, channel; /* part -1: none */
    int present_part;        /* that says what of them is there; -1: all is */
    unsigned char *codes;
} CachedCodes;

enum { CACHED_CODES = 3 }; /* by channel */

struct RetexPackScratch {
    const RetexPack *pack;
    unsigned char *chunk; /* as read */
    size_t chunk_room;
    unsigned char *residuals, *present, *shift;
    PackRuns runs;                  /* of `present` */
    int present_part, present_band; /* that it is of; -1: none */
    int32_t *numbers;
    CachedCodes codes[CACHED_CODES];
    size_t pixels; /* of a band, that there is room for */
    int nparts;
    CachedBand *cached;
};

static int cache_band(int part, int band, RetexPackScratch *s, RetexError *err);

int retex_pack_scratch_create(RetexPackScratch **result, const RetexPack *pack, RetexError *err)
{
    RetexPackScratch *s = *result = calloc(1, sizeof *s);
    int code = s ? 0 : RETEX_ENOMEM;
    if (s) {
        s->pack = pack;
        s->nparts = pack->nparts;
        s->present_part = -1;
        s->cached = calloc((size_t)pack->nparts + 1, sizeof *s->cached);
        code = s->cached ? 0 : RETEX_ENOMEM;
    }
    for (int i = 0; !code && i < s->nparts; i++)
        s->cached[i].band = -1;
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
        pack_jpeg_decoder_close(&s->cached[i].jpeg);
    }
    free(s->cached);
    free(s->chunk);
    free(s->residuals);
    free(s->present);
    free(s->runs.run);
    free(s->shift);
    free(s->numbers);
    for (int i = 0; i < CACHED_CODES; i++)
        free(s->codes[i].codes);
    free(s);
    *result = NULL;
}

const RetexPack *pack_decoded_by(const RetexPackScratch *scratch)
{
    return scratch->pack;
}

/* Room for the planes of a band of this part. */
static int reserve(RetexPackScratch *s, const PackPart *p, RetexError *err)
{
    const size_t pixels = (size_t)p->width * PACK_BAND_ROWS;
    if (pixels <= s->pixels)
        return 0;
    s->present_part = -1;
    free(s->residuals);
    free(s->present);
    free(s->runs.run);
    free(s->shift);
    free(s->numbers);
    const PackPlane plane = {.width = p->width, .rows = PACK_BAND_ROWS};
    int code = 0;
    for (int i = 0; i < CACHED_CODES; i++) {
        free(s->codes[i].codes);
        s->codes[i] = (CachedCodes){.part = -1, .codes = malloc(pixels)};
        code = s->codes[i].codes ? code : RETEX_ENOMEM;
    }
    s->residuals = malloc(pack_plane_room(&plane));
    s->present = malloc(pixels);
    s->runs.run = malloc(pack_runs_room(p->width, PACK_BAND_ROWS) * sizeof *s->runs.run);
    s->shift = malloc(pixels);
    s->numbers = malloc(pixels * sizeof *s->numbers);
    s->pixels = !code && s->residuals && s->present && s->runs.run && s->shift && s->numbers ? pixels : 0;
    return s->pixels ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
}

/* Chunk k of a part, behind `before` bytes that are there, its checksum compared. */
static int read_chunk(int part, int k, size_t before, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const size_t bytes = p->bytes[k];
    if (before + bytes > s->chunk_room) {
        unsigned char *chunk = realloc(s->chunk, before + bytes + 4096);
        if (!chunk)
            return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
        s->chunk = chunk;
        s->chunk_room = before + bytes + 4096;
    }
    if (bytes && (retex_input_read(s->pack->input, s->chunk + before, bytes, p->offsets[k]) != (int64_t)bytes ||
                  retex_crc32(CRC32_OF_NONE, s->chunk + before, bytes) != p->crcs[k]))
        return pack_damaged(err, "the checksum is wrong of part", s->pack->set->parts[part].name);
    return 0;
}

/* A channel of a band, by the plane's bits into its numbers or codes. */
static int decode_plane(int part, int band, int channel, const PackPlane *plane, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const int k = band * p->channels + channel;
    int code = read_chunk(part, k, 0, s, err);
    if (!code && !pack_plane_decode(plane, s->chunk, p->bytes[k], s->residuals))
        code = pack_damaged(err, "planes cannot be decoded of part", s->pack->set->parts[part].name);
    return code;
}

/* Of a channel that is not coded, where s->present says or, if not `partial`, everywhere; shift may be NULL. */
static int decode_numbers(int part, int band, int channel, int partial, const unsigned char *shift, RetexPackScratch *s,
                          RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const int bits = p->maps[channel].kind == PACK_MAP_BITS && p->type == RETEX_HALF ? 16 : 32;
    const PackPlane plane = {.width = p->width,
                             .rows = pack_band_rows(p, band),
                             .bits = bits,
                             .present = partial ? s->present : NULL,
                             .shift = shift,
                             .numbers = s->numbers,
                             .runs = &s->runs};
    return decode_plane(part, band, channel, &plane, s, err);
}

/* Of a channel that is coded. */
static int decode_codes(int part, int band, int channel, int partial, const unsigned char **codes, RetexPackScratch *s,
                        RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    CachedCodes *cached = &s->codes[channel % CACHED_CODES];
    const CachedCodes wanted = {part, band, channel, partial ? s->present_part : -1, cached->codes};
    const PackPlane plane = {.width = p->width,
                             .rows = pack_band_rows(p, band),
                             .bits = 8,
                             .present = partial ? s->present : NULL,
                             .runs = &s->runs,
                             .codes = cached->codes};
    *codes = cached->codes;
    if (cached->part == part && cached->band == band && cached->channel == channel &&
        cached->present_part == wanted.present_part)
        return 0;
    cached->part = -1;
    int code = decode_plane(part, band, channel, &plane, s, err);
    if (!code)
        *cached = wanted;
    return code;
}

/* Where a part's numbers matter, into s->present: the same for means and spread, which come one after the other. */
static int decode_present(int part, int band, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const unsigned char *codes;
    if (s->present_part == part && s->present_band == band)
        return 0;
    int code = decode_codes(part, band, 2, 0, &codes, s, err);
    const int rows = pack_band_rows(p, band);
    if (!code) {
        pack_find_present(s->present, codes, (size_t)p->width * (size_t)rows);
        pack_find_runs(&s->runs, s->present, p->width, rows);
    }
    s->present_part = code ? -1 : part;
    s->present_band = band;
    return code;
}

/* What multiples the means of channel c are, into s->shift. */
static int decode_shift(int part, int band, int c, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const int per_octave = s->pack->parts[p->sigma].maps[c].per_octave;
    unsigned char shift[PACK_CODES];
    const unsigned char *codes;
    for (int i = 0; i < PACK_CODES; i++)
        shift[i] = (unsigned char)pack_lattice_shift(p, i, per_octave);
    int code = decode_codes(p->sigma, band, c, 1, &codes, s, err);
    for (int y = 0; !code && y < pack_band_rows(p, band); y++)
        for (int k = s->runs.first[y]; k < s->runs.first[y + 1]; k++) {
            const size_t row = (size_t)y * (size_t)p->width;
            for (size_t i = row + (size_t)s->runs.run[k].begin; i < row + (size_t)s->runs.run[k].end; i++)
                s->shift[i] = shift[codes[i]];
        }
    return code;
}

/* 1 unless all of so many bytes are 0. */
static int is_any(const void *data, size_t bytes)
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

/* The rows of a band that are not all 0: bit y of row y. */
static uint64_t find_lit(const PackPart *p, int band, const float *rows)
{
    const size_t row = (size_t)p->width * (size_t)p->channels;
    uint64_t lit = 0;
    for (int y = 0; y < pack_band_rows(p, band); y++)
        lit |= (uint64_t)is_any(rows + (size_t)y * row, row * sizeof *rows) << y;
    return lit;
}

/* The rows that something matters in. What does not matter of them becomes 0; other rows are left alone. */
static uint64_t clear_around(const PackPart *p, int band, float *out, const PackRuns *runs)
{
    const size_t channels = (size_t)p->channels, width = (size_t)p->width;
    uint64_t lit = 0;
    for (int y = 0; y < pack_band_rows(p, band); y++, out += width * channels) {
        size_t end = 0;
        if (runs->first[y] == runs->first[y + 1])
            continue;
        lit |= (uint64_t)1 << y;
        for (int k = runs->first[y]; k < runs->first[y + 1]; k++) {
            memset(out + end * channels, 0, ((size_t)runs->run[k].begin - end) * channels * sizeof *out);
            end = (size_t)runs->run[k].end;
        }
        memset(out + end * channels, 0, (width - end) * channels * sizeof *out);
    }
    return lit;
}

/* Some numbers of channel c, or codes if it is coded, from the at-th on, to samples. */
static void map_some(const PackPart *p, int c, float *out, const unsigned char *codes, const int32_t *numbers,
                     size_t at, size_t count)
{
    const size_t channels = (size_t)p->channels;
    if (codes)
        pack_map_codes(out + at * channels + (size_t)c, channels, codes + at, count, &p->maps[c]);
    else
        pack_map_samples(out + at * channels + (size_t)c, channels, numbers + at, count, &p->maps[c], p->type);
}

/* All of them. Rows of which all are 0 so far, in all channels, have no bit in *lit and are left alone. */
static void map_all(const PackPart *p, int band, int c, float *out, uint64_t *lit, const unsigned char *codes,
                    const int32_t *numbers)
{
    const size_t channels = (size_t)p->channels, width = (size_t)p->width;
    const int32_t none = 0;
    float of_none;
    pack_map_samples(&of_none, 1, &none, 1, &p->maps[c], p->type);
    const int none_is_lit = is_any(&of_none, sizeof of_none);
    for (int y = 0; y < pack_band_rows(p, band); y++) {
        const uint64_t row = (uint64_t)1 << y;
        const size_t at = (size_t)y * width;
        if (!none_is_lit && !(codes ? is_any(codes + at, width) : is_any(numbers + at, width * sizeof *numbers)))
            continue;
        if (!(*lit & row) && channels > 1)
            memset(out + at * channels, 0, width * channels * sizeof *out);
        *lit |= row;
        map_some(p, c, out, codes, numbers, at, width);
    }
}

/* Those that matter. */
static void map_present(const PackPart *p, int band, int c, float *out, const PackRuns *runs,
                        const unsigned char *codes, const int32_t *numbers)
{
    for (int y = 0; y < pack_band_rows(p, band); y++)
        for (int k = runs->first[y]; k < runs->first[y + 1]; k++) {
            const PackRun run = runs->run[k];
            map_some(p, c, out, codes, numbers, (size_t)y * (size_t)p->width + (size_t)run.begin,
                     (size_t)(run.end - run.begin));
        }
}

static int decode_planes(int part, int band, float *out, uint64_t *lit, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    int code = reserve(s, p, err);
    if (!code && p->present >= 0)
        code = decode_present(p->present, band, s, err);
    if (!code && p->present >= 0)
        *lit = clear_around(p, band, out, &s->runs);
    for (int c = 0; !code && (*lit || p->present < 0) && c < p->channels; c++) {
        const int lattice = p->maps[c].kind == PACK_MAP_LATTICE;
        const int partial = p->present >= 0 && (p->present != part || c != 2);
        const unsigned char *codes = NULL;
        if (lattice)
            code = decode_shift(part, band, c, s, err);
        if (!code && pack_map_is_coded(&p->maps[c]))
            code = decode_codes(part, band, c, partial, &codes, s, err);
        else if (!code)
            code = decode_numbers(part, band, c, partial, lattice ? s->shift : NULL, s, err);
        if (!code && p->present >= 0)
            map_present(p, band, c, out, &s->runs, codes, s->numbers);
        else if (!code)
            map_all(p, band, c, out, lit, codes, s->numbers);
    }
    return code;
}

/* Shifts of means, from the standard deviations of the band, which are decoded for it. */
static int fill_mean_shifts(int part, int band, PackModelBand *model, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part], *sigma = &s->pack->parts[p->sigma];
    const size_t pixels = (size_t)model->width * (size_t)model->rows;
    int code = cache_band(p->sigma, band, s, err);
    const CachedBand *cached = &s->cached[p->sigma];
    for (int c = 0; !code && c < p->channels; c++)
        for (size_t i = 0; model->shifts[c] && i < pixels; i++) {
            const int is_black = !(cached->lit >> i / (size_t)model->width & 1);
            const float deviation = is_black ? 0 : cached->rows[i * (size_t)sigma->channels + (size_t)c];
            model->shifts[c][i] = (unsigned char)pack_mean_shift(deviation);
        }
    return code;
}

static int decode_model(int part, int band, float *out, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    PackModelBand model;
    int code = pack_model_alloc(&model, p->width, pack_band_rows(p, band), p->channels, p->maps)
                   ? 0
                   : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    if (!code && p->sigma >= 0)
        code = fill_mean_shifts(part, band, &model, s, err);
    if (!code)
        code = read_chunk(part, band, 0, s, err);
    const int decoded = code ? 1 : pack_model_decode(&model, s->chunk, p->bytes[band]);
    if (decoded < 0)
        code = retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    else if (!decoded)
        code = pack_damaged(err, "planes cannot be decoded of part", s->pack->set->parts[part].name);
    if (!code && p->codec == PACK_COMBINED)
        code = pack_combine_add(&model, s->pack->set, band * PACK_BAND_ROWS, err);
    for (int c = 0; !code && c < p->channels; c++)
        pack_map_samples(out + c, (size_t)p->channels, model.numbers[c], (size_t)model.width * (size_t)model.rows,
                         &p->maps[c], p->type);
    pack_model_free(&model);
    return code;
}

/* ---- JPEGs ---- */

/* Have the mask of a band, bits of bytes, and know whether it leaves any pixel. */
static int decode_mask(int part, int band, CachedBand *cached, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const int k = 1 + p->nbands + band, rows = pack_band_rows(p, band), width = pack_mask_width(p);
    int code = cached->mask || (cached->mask = malloc((size_t)width * PACK_BAND_ROWS))
                   ? read_chunk(part, k, 0, s, err)
                   : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    const PackPlane plane = {.width = width, .rows = rows, .bits = 8, .codes = cached->mask};
    if (!code && !pack_plane_decode(&plane, s->chunk, p->bytes[k], s->residuals))
        code = pack_damaged(err, "the mask cannot be decoded of part", s->pack->set->parts[part].name);
    const int last = 255 >> (8 * width - p->width);
    int every = 255; /* bits that all pixels have */
    for (int y = 0; !code && y < rows; y++)
        for (int x = 0; x < width; x++)
            every &= cached->mask[y * width + x] | (x == width - 1 ? ~last : 0);
    cached->is_black = every == 255;
    return code;
}

/* Make pixels of a row black whose bit is set. */
static void apply_mask(const PackPart *p, float *out, const unsigned char *mask)
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
    return retex_fail(err, code, "the pack is damaged: part '%s': %s", s->pack->set->parts[part].name, why->message);
}

/* Have the coefficients of a band. */
static int open_jpeg(int part, int band, CachedBand *cached, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    RetexError why = {0};
    int code = reserve(s, p, err);
    cached->blocks = -1;
    cached->lit = 0;
    cached->is_black = 0;
    if (!code && !cached->jpeg)
        code = pack_jpeg_decoder_create(&cached->jpeg, err);
    if (!code && p->masked)
        code = decode_mask(part, band, cached, s, err);
    if (code || cached->is_black) /* what the JPEG has here means nothing */
        return code;
    code = read_chunk(part, 0, 0, s, err);
    if (!code)
        code = read_chunk(part, 1 + band, p->bytes[0], s, err);
    if (code)
        return code;
    code = pack_jpeg_open_band(cached->jpeg, s->chunk, p->bytes[0], (size_t)p->bytes[0] + p->bytes[1 + band], p->width,
                               pack_band_rows(p, band), p->channels, &p->curve, &why);
    return code ? jpeg_damaged(err, code, &why, s, part) : 0;
}

/* Have the row of blocks that a row of the band is in. */
static int decode_blocks(int part, int line, CachedBand *cached, const RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const int blocks = line / PACK_BLOCK_ROWS, first = blocks * PACK_BLOCK_ROWS;
    const size_t row = (size_t)p->width * (size_t)p->channels;
    RetexError why = {0};
    if (cached->blocks == blocks || cached->is_black)
        return 0;
    cached->blocks = -1;
    int code = pack_jpeg_decode_blocks(cached->jpeg, blocks, cached->rows, &why);
    if (code)
        return jpeg_damaged(err, code, &why, s, part);
    cached->blocks = blocks;
    cached->lit = 0;
    for (int y = 0; y < PACK_BLOCK_ROWS && first + y < pack_band_rows(p, cached->band); y++) {
        float *values = cached->rows + (size_t)y * row;
        if (p->masked)
            apply_mask(p, values, cached->mask + (size_t)(first + y) * (size_t)pack_mask_width(p));
        cached->lit |= (uint64_t)is_any(values, row * sizeof *values) << (first + y);
    }
    return 0;
}

/* ---- any part ---- */

/* Rows without a bit in *lit are 0, and perhaps not written. */
static int decode_band(int part, int band, float *out, uint64_t *lit, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    int code = 0;
    *lit = 0;
    if (p->codec == PACK_PLANES)
        return decode_planes(part, band, out, lit, s, err);
    if (pack_is_modelled(p)) {
        code = decode_model(part, band, out, s, err);
        *lit = code ? 0 : find_lit(p, band, out);
    }
    return code;
}

/* Have the band in the cache. */
static int cache_band(int part, int band, RetexPackScratch *s, RetexError *err)
{
    const PackPart *p = &s->pack->parts[part];
    const size_t row = (size_t)p->width * (size_t)p->channels;
    CachedBand *cached = &s->cached[part];
    const int is_jpeg = p->codec == PACK_JPEG, rows = is_jpeg ? PACK_BLOCK_ROWS : PACK_BAND_ROWS;
    if (cached->band == band)
        return 0;
    cached->band = -1;
    if (!cached->rows && !(cached->rows = malloc(row * (size_t)rows * sizeof *cached->rows)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    int code =
        is_jpeg ? open_jpeg(part, band, cached, s, err) : decode_band(part, band, cached->rows, &cached->lit, s, err);
    cached->band = code ? -1 : band;
    return code;
}

int retex_pack_row(RetexPackScratch *s, int part, int y, const float **row, RetexError *err)
{
    *row = NULL;
    if (part < 0 || part >= s->pack->nparts || y < 0 || y >= s->pack->parts[part].height)
        return retex_fail(err, RETEX_EINVAL, "the pack has no such rows");
    const PackPart *p = &s->pack->parts[part];
    CachedBand *cached = &s->cached[part];
    const int band = y / PACK_BAND_ROWS, line = y % PACK_BAND_ROWS;
    const int kept = p->codec == PACK_JPEG ? line % PACK_BLOCK_ROWS : line;
    if (p->codec == PACK_ZERO)
        return 0;
    int code = cache_band(part, band, s, err);
    if (!code && p->codec == PACK_JPEG)
        code = decode_blocks(part, line, cached, s, err);
    if (!code && cached->lit >> line & 1)
        *row = cached->rows + (size_t)kept * (size_t)p->width * (size_t)p->channels;
    return code;
}
