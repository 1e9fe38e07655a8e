/* See encode.h. plan.c chooses the codecs; then all threads encode strips in parallel. */
#include "pack/encode.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "io/checksum.h"
#include "pack/balance.h"
#include "set/set.h"

/* Times a mean is changed at most; where that is not enough, steps become finer. */
static const double CHANGE_MOST = 1.1;
static const int EFFORT = 8;          /* of blosc's zstd; */
static const int LOSSLESS_EFFORT = 6; /* without loss, where 8 would take twice the time for 3 % less */

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
}

/* --- JPEGs --- */

static int is_black(const float *pixel, size_t channels)
{
    int black = 1;
    for (size_t c = 0; c < channels; c++)
        black = black && pixel[c] == 0;
    return black;
}

void retex_pack_fill_black(float *levels, const RetexImage *im)
{
    const size_t channels = (size_t)im->channels;
    for (int by = 0; by < im->height; by += 8)
        for (int bx = 0; bx < im->width; bx += 8) {
            float sum[RETEX_PACK_CHANNELS_MAX] = {0};
            int lit = 0;
            for (int pass = 0; pass < 2; pass++)
                for (int y = by; y < by + 8 && y < im->height; y++)
                    for (int x = bx; x < bx + 8 && x < im->width; x++) {
                        const size_t i = retex_image_index(im, x, y);
                        const int black = is_black(im->pixels + i, channels);
                        for (size_t c = 0; c < channels; c++)
                            if (pass == 0 && !black)
                                sum[c] += levels[i + c];
                            else if (pass == 1 && black && lit)
                                levels[i + c] = sum[c] / (float)lit;
                        lit += pass == 0 && !black;
                    }
        }
}

void retex_pack_keep_black(RetexImage *decoded, const RetexImage *im)
{
    const size_t channels = (size_t)im->channels;
    for (size_t i = 0; i < retex_image_index(im, 0, im->height); i += channels)
        if (is_black(im->pixels + i, channels))
            memset(decoded->pixels + i, 0, sizeof *decoded->pixels * channels);
}

/* Levels of an image, clipped to at most `most`. NULL if memory runs out. */
static float *levels_of(const RetexImage *im, const RetexPackCurve *curve, double most)
{
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    float *levels = malloc(count * sizeof *levels);
    for (size_t i = 0; levels && i < count; i++)
        levels[i] =
            (float)fmin(retex_pack_curve_level(curve, (int)(i % (size_t)im->channels), (double)im->pixels[i]), most);
    return levels;
}

/* Encode a strip of the mask as a slice: a plane of bytes, each with 8 pixels. */
static int encode_mask_strip(RetexPackItem *item, int strip, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    RetexPackPart *p = item->packed;
    const int rows = retex_pack_strip_rows(p, strip), width = retex_pack_mask_width(p), k = 1 + p->nstrips + strip;
    RetexPackPlane plane = {
        .width = width, .rows = rows, .bits = 8, .numbers = calloc((size_t)(width * rows), sizeof(int32_t))};
    const size_t bound = retex_pack_plane_bound(&plane);
    unsigned char *scratch = malloc(2 * bound);
    item->slices[k] = malloc(bound);
    long bytes = -1;
    if (plane.numbers && scratch && item->slices[k]) {
        for (int y = 0; y < rows; y++)
            for (int x = 0; x < im->width; x++)
                if (is_black(im->pixels + retex_image_index(im, x, strip * RETEX_PACK_STRIP_ROWS + y),
                             (size_t)im->channels))
                    plane.numbers[y * width + x / 8] |= 1 << (x % 8);
        bytes = retex_pack_plane_encode(item->slices[k], &plane, scratch, EFFORT);
    }
    free(plane.numbers);
    free(scratch);
    p->bytes[k] = bytes < 0 ? 0 : (uint32_t)bytes;
    return bytes < 0 ? no_memory(err) : 0;
}

static int decode_strip(RetexImage *image, RetexPackJpegDecoder *decoder, const RetexPackItem *item, int strip,
                        RetexError *err)
{
    const RetexPackPart *p = item->packed;
    const size_t header = item->jpeg.slice_bytes[0], bytes = item->jpeg.slice_bytes[1 + strip];
    const int rows = retex_pack_strip_rows(p, strip), first = strip * RETEX_PACK_STRIP_ROWS;
    unsigned char *file = malloc(header + bytes);
    if (!file)
        return no_memory(err);
    memcpy(file, item->jpeg.data, header);
    memcpy(file + header, item->slices[1 + strip], bytes);
    int code =
        retex_pack_jpeg_open_strip(decoder, file, header, header + bytes, p->width, rows, p->channels, &p->curve, err);
    free(file);
    for (int row = 0; row * RETEX_PACK_BLOCK_ROWS < rows && !code; row++)
        code = retex_pack_jpeg_decode_blocks(
            decoder, row, image->pixels + retex_image_index(image, 0, first + row * RETEX_PACK_BLOCK_ROWS), err);
    return code;
}

static int decode(RetexImage *image, const RetexPackItem *item, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    RetexPackJpegDecoder *decoder = NULL;
    int code = retex_image_alloc(image, im->width, im->height, im->channels, err);
    if (!code)
        code = retex_pack_jpeg_decoder_create(&decoder, err);
    for (int strip = 0; strip < item->packed->nstrips && !code; strip++)
        code = decode_strip(image, decoder, item, strip, err);
    retex_pack_jpeg_decoder_close(&decoder);
    if (!code)
        retex_pack_keep_black(image, im);
    return code;
}

/* light: of a gain the item of its light; of light the item itself. *finer: 1 if steps are too coarse. */
static int restore_mean(RetexPackItem *item, const RetexPackItem *light, int *finer, RetexError *err)
{
    const RetexImage *own = NULL, *kept = NULL;
    RetexImage made = {0};
    double change = 1;
    if (light != item) {
        own = &light->part->image;
        kept = light->decoded.pixels ? &light->decoded : own;
    }
    int code = decode(&made, item, err);
    if (!code)
        code = retex_pack_restore_mean(&item->packed->curve, &made, &item->part->image, own, kept, &change, err);
    *finer = change > CHANGE_MOST && item->packed->jpeg_step >= 2;
    retex_image_free(&item->decoded);
    if (!code && !own)
        item->decoded = made;
    else
        retex_image_free(&made);
    return code;
}

static int has_black(const RetexImage *im)
{
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++)
        if (is_black(im->pixels + i * (size_t)im->channels, (size_t)im->channels))
            return 1;
    return 0;
}

/* Encode levels, and find the slices. */
static int encode_levels(RetexPackItem *item, int is_picture, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    RetexPackPart *p = item->packed;
    float *levels = levels_of(im, &p->curve, is_picture ? 255 : INFINITY);
    int code = levels ? RETEX_OK : no_memory(err);
    if (!code && p->masked)
        retex_pack_fill_black(levels, im);
    retex_pack_jpeg_free(&item->jpeg);
    if (!code)
        code = retex_pack_jpeg_encode(&item->jpeg, levels, im->width, im->height, im->channels, p->jpeg_step, err);
    free(levels);
    unsigned char *at = item->jpeg.data;
    for (int k = 0; !code && k < 1 + p->nstrips; k++) {
        item->slices[k] = at;
        p->bytes[k] = (uint32_t)item->jpeg.slice_bytes[k];
        at += item->jpeg.slice_bytes[k];
    }
    return code;
}

/* Encode a part as JPEG. The picture (part 0) is for viewers only: it is clipped at white and has no mask. light: see
 * restore_mean, or NULL. */
static int encode_jpeg(RetexPackItem *item, int is_picture, const RetexPackItem *light, RetexError *err)
{
    const RetexImage *im = &item->part->image;
    RetexPackPart *p = item->packed;
    p->masked = !is_picture && has_black(im);
    int code = retex_pack_part_slices(p, err);
    item->slices = calloc((size_t)p->nslices + 1, sizeof *item->slices);
    if (!code && !item->slices)
        code = no_memory(err);
    const RetexPackCurve planned = p->curve;
    for (int finer = 1; finer && !code;) {
        finer = 0;
        p->curve = planned;
        code = encode_levels(item, is_picture, err);
        if (!code && light && im->channels == 3)
            code = restore_mean(item, light, &finer, err);
        p->jpeg_step /= finer ? 2 : 1;
    }
    for (int strip = 0; !code && p->masked && strip < p->nstrips; strip++)
        code = encode_mask_strip(item, strip, err);
    return code;
}

/* --- planes --- */

/* Scratch memory for encoding a strip's planes. */
typedef struct Strip {
    size_t pixels;
    unsigned char *present, *shift, *scratch;
    int32_t *numbers, *codes;
} Strip;

static void strip_free(Strip *strip)
{
    free(strip->present);
    free(strip->shift);
    free(strip->scratch);
    free(strip->numbers);
    free(strip->codes);
}

static int strip_alloc(Strip *strip, const RetexPackPart *p, int index)
{
    const RetexPackPlane plane = {.width = p->width, .rows = retex_pack_strip_rows(p, index)};
    strip->pixels = (size_t)plane.width * (size_t)plane.rows;
    strip->present = malloc(strip->pixels);
    strip->shift = malloc(strip->pixels);
    strip->scratch = malloc(2 * retex_pack_plane_bound(&plane));
    strip->numbers = malloc(strip->pixels * sizeof *strip->numbers);
    strip->codes = malloc(strip->pixels * sizeof *strip->codes);
    return strip->present && strip->shift && strip->scratch && strip->numbers && strip->codes;
}

/* The numbers of a part's channel in strip `index`. */
static void numbers_of(int32_t *numbers, const RetexPackEncoded *w, int part, int channel, int index, size_t pixels)
{
    const RetexImage *im = &w->items[part].part->image;
    if (w->packed[part].maps[channel].kind == RETEX_PACK_MAP_STEP &&
        channel > 1) { /* their sizes are in the first two */
        memset(numbers, 0, pixels * sizeof *numbers);
        return;
    }
    retex_pack_map_numbers(numbers, im->pixels + retex_image_index(im, 0, index * RETEX_PACK_STRIP_ROWS) + channel,
                           (size_t)im->channels, pixels, &w->packed[part].maps[channel], w->items[part].part->type);
}

static void fill_shift(Strip *strip, const RetexPackEncoded *w, const RetexPackPart *p, int channel, int index)
{
    const int per_octave = w->packed[p->sigma].maps[channel].per_octave;
    numbers_of(strip->codes, w, p->sigma, channel, index, strip->pixels);
    for (size_t i = 0; i < strip->pixels; i++)
        strip->shift[i] = (unsigned char)retex_pack_lattice_shift(p, strip->codes[i], per_octave);
}

static int encode_strip(const RetexPackEncoded *w, int part, int index)
{
    RetexPackItem *item = &w->items[part];
    RetexPackPart *p = item->packed;
    Strip strip = {0};
    int ok = strip_alloc(&strip, p, index);
    if (ok && p->present >= 0) {
        numbers_of(strip.codes, w, p->present, 2, index, strip.pixels);
        for (size_t i = 0; i < strip.pixels; i++)
            strip.present[i] = strip.codes[i] != 0;
    }
    for (int c = 0; ok && c < p->channels; c++) {
        const RetexPackMap *map = &p->maps[c];
        const int lattice = map->kind == RETEX_PACK_MAP_LATTICE,
                  partial = p->present >= 0 && (p->present != part || c != 2);
        const int bits = retex_pack_map_is_coded(map)                                ? 8
                         : map->kind == RETEX_PACK_MAP_BITS && p->type == RETEX_HALF ? 16
                                                                                     : 32;
        const int k = index * p->channels + c;
        if (lattice)
            fill_shift(&strip, w, p, c, index);
        numbers_of(strip.numbers, w, part, c, index, strip.pixels);
        const RetexPackPlane plane = {.width = p->width,
                                      .rows = retex_pack_strip_rows(p, index),
                                      .bits = bits,
                                      .present = partial ? strip.present : NULL,
                                      .shift = lattice ? strip.shift : NULL,
                                      .numbers = strip.numbers};
        unsigned char *data = malloc(retex_pack_plane_bound(&plane));
        const long bytes = data ? retex_pack_plane_encode(data, &plane, strip.scratch, w->effort) : -1;
        unsigned char *fitted = bytes > 0 ? realloc(data, (size_t)bytes) : NULL;
        item->slices[k] = fitted ? fitted : data;
        p->bytes[k] = bytes > 0 ? (uint32_t)bytes : 0;
        ok = bytes >= 0;
    }
    strip_free(&strip);
    return ok;
}

/* --- all parts --- */

/* Number of strips that are jobs of their own: 0 for JPEGs, which are encoded whole. */
static int strips_to_encode(const RetexPackPart *packed)
{
    return packed->codec == RETEX_PACK_PLANES ? packed->nstrips : 0;
}

static void encode_whole(void *context, int index, int thread)
{
    RetexPackEncoded *w = context;
    RetexPackItem *item = &w->items[index];
    const int light = retex_pack_light_of(w->set, index);
    (void)thread;
    if ((light >= 0 && light != index) != w->gains)
        return;
    item->code = retex_pack_samples_crc(&item->crc, item->part, &item->err);
    if (!item->code && item->packed->codec == RETEX_PACK_JPEG)
        item->code = encode_jpeg(item, index == 0, light < 0 ? NULL : &w->items[light], &item->err);
    if (item->code || !strips_to_encode(item->packed))
        return;
    item->code = retex_pack_part_slices(item->packed, &item->err);
    item->slices = calloc((size_t)item->packed->nslices + 1, sizeof *item->slices);
    if (!item->code && !item->slices)
        item->code = no_memory(&item->err);
}

static void encode_job(void *context, int index, int thread)
{
    RetexPackEncoded *w = context;
    (void)thread;
    const int part = w->jobs[2 * index], strip = w->jobs[2 * index + 1];
    w->codes[index] = encode_strip(w, part, strip) ? 0 : RETEX_ENOMEM;
}

static int encode_all(RetexPackEncoded *w, int nthreads, RetexError *err)
{
    const int count = w->set->nparts;
    int code = 0, strips = 0;
    for (w->gains = 0; w->gains < 2; w->gains++) /* gains after the light that they are of */
        retex_parallel(nthreads, count, encode_whole, w);
    for (int i = 0; i < count; i++)
        retex_image_free(&w->items[i].decoded);
    for (int i = 0; i < count; i++) {
        if (!code && w->items[i].code)
            code = retex_fail(err, w->items[i].code, "%s", w->items[i].err.message);
        strips += w->packed[i].nstrips;
    }
    w->jobs = malloc(((size_t)strips + 1) * 2 * sizeof *w->jobs);
    w->codes = calloc((size_t)strips + 1, sizeof *w->codes);
    if (!code && (!w->jobs || !w->codes))
        code = no_memory(err);
    if (code)
        return code;
    for (int i = 0; i < count; i++)
        for (int strip = 0; strip < strips_to_encode(&w->packed[i]); strip++) {
            w->jobs[2 * w->njobs] = i;
            w->jobs[2 * w->njobs++ + 1] = strip;
        }
    retex_parallel(nthreads, w->njobs, encode_job, w);
    for (int i = 0; i < w->njobs; i++)
        if (w->codes[i])
            return no_memory(err);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < w->packed[i].nslices; k++)
            w->packed[i].crcs[k] = retex_crc32(CRC32_OF_NONE, w->items[i].slices[k], w->packed[i].bytes[k]);
    return 0;
}

/* Encode the picture for viewers of a lossless pack. */
static int encode_picture(RetexPackEncoded *w, RetexError *err)
{
    const RetexImage *im = &w->set->parts[0].image;
    const RetexPackCurve curve = retex_pack_curve(1, 255);
    if (w->packed[0].codec == RETEX_PACK_JPEG || im->width > RETEX_PACK_JPEG_SIDE_MAX ||
        im->height > RETEX_PACK_JPEG_SIDE_MAX)
        return 0;
    const RetexPackQuantizer quantizer = retex_pack_quantizer(40);
    float *levels = levels_of(im, &curve, 255);
    if (!levels)
        return no_memory(err);
    for (size_t i = 0; i < 3 * (size_t)im->width * (size_t)im->height; i++)
        levels[i] = levels[i] >= 0 ? levels[i] : 0; /* NaN too */
    int code = retex_pack_jpeg_encode(&w->picture, levels, im->width, im->height, 3, quantizer.picture_step, err);
    free(levels);
    return code;
}

void retex_pack_encoded_free(RetexPackEncoded *w)
{
    for (int i = 0; w->items && w->packed && i < w->set->nparts; i++) {
        const RetexPackPart *p = &w->packed[i];
        for (int k = p->codec == RETEX_PACK_JPEG ? 1 + p->nstrips : 0; w->items[i].slices && k < p->nslices; k++)
            free(w->items[i].slices[k]);
        free(w->items[i].slices);
        retex_pack_jpeg_free(&w->items[i].jpeg);
        retex_image_free(&w->items[i].decoded);
        retex_pack_part_free(&w->packed[i]);
    }
    retex_pack_jpeg_free(&w->picture);
    free(w->items);
    free(w->packed);
    free(w->jobs);
    free(w->codes);
}

int retex_pack_encode(RetexPackEncoded *w, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                      RetexError *err)
{
    *w = (RetexPackEncoded){.set = set, .effort = quantizer ? EFFORT : LOSSLESS_EFFORT};
    w->packed = calloc((size_t)set->nparts + 1, sizeof *w->packed);
    w->items = calloc((size_t)set->nparts + 1, sizeof *w->items);
    int code = w->packed && w->items ? 0 : no_memory(err);
    if (!code)
        code = retex_pack_plan(w->packed, set, quantizer, nthreads, err);
    for (int i = 0; !code && i < set->nparts; i++) {
        w->items[i].part = &set->parts[i];
        w->items[i].packed = &w->packed[i];
    }
    if (!code)
        code = encode_all(w, nthreads, err);
    if (!code)
        code = encode_picture(w, err);
    return code;
}
