/* The codecs of a pack: byte planes with deflate for what must keep its bits, JPEG for what is radiance or albedo.
 *
 * A JPEG has 8 bits, radiance has ten decades: it is encoded by its logarithm, per image, from a scale well below the
 * image's mean. Black is exact (a mask), and the mean of every channel is (a gain); so what JPEG rounds neither adds
 * light where there was none nor loses energy. */
#include "pack_codec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <turbojpeg.h>
#include <zlib.h>

#include "half.h"

enum { JPEG_SIDE_MAX = 65500, DEFLATE_LEVEL = 6, DEFLATE_RATIO_MAX = 1032 };

const char *const retex_pack_codec_names[RETEX_PACK_CODECS] = {"zero", "planes", "jpeg-log", "jpeg-srgb"};

static size_t pixel_count(const RetexPart *part)
{
    return (size_t)part->image.width * (size_t)part->image.height;
}

static size_t sample_bytes(const RetexPart *part)
{
    return part->type == RETEX_HALF ? 2 : 4;
}

static int out_of_memory(const RetexPart *part, RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to pack part '%s'", part->name);
}

static int damaged(const RetexPart *part, const char *what, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "part '%s' of the pack is damaged: %s", part->name, what);
}

/* --- byte planes --- */

/* Channel c's samples as stored: little-endian, rows from the top. */
static void store_channel(unsigned char *raw, float *plane, uint16_t *halves, const RetexPart *part, int c)
{
    size_t n = pixel_count(part), channels = (size_t)part->image.channels;
    for (size_t i = 0; i < n; i++)
        plane[i] = part->image.pixels[i * channels + (size_t)c];
    if (part->type == RETEX_HALF) {
        retex_half_from_float(halves, plane, n);
        for (size_t i = 0; i < n; i++) {
            raw[2 * i] = (unsigned char)(halves[i] & 255);
            raw[2 * i + 1] = (unsigned char)(halves[i] >> 8);
        }
        return;
    }
    for (size_t i = 0; i < n; i++) {
        uint32_t bits;
        memcpy(&bits, &plane[i], sizeof bits);
        for (size_t k = 0; k < 4; k++)
            raw[4 * i + k] = (unsigned char)(bits >> (8 * k) & 255);
    }
}

static void load_channel(const unsigned char *raw, float *plane, uint16_t *halves, RetexPart *part, int c)
{
    size_t n = pixel_count(part), channels = (size_t)part->image.channels;
    if (part->type == RETEX_HALF) {
        for (size_t i = 0; i < n; i++)
            halves[i] = (uint16_t)(raw[2 * i] | raw[2 * i + 1] << 8);
        retex_half_to_float(plane, halves, n);
    } else {
        for (size_t i = 0; i < n; i++) {
            uint32_t bits = raw[4 * i] | (uint32_t)raw[4 * i + 1] << 8 | (uint32_t)raw[4 * i + 2] << 16 |
                            (uint32_t)raw[4 * i + 3] << 24;
            memcpy(&plane[i], &bits, sizeof bits);
        }
    }
    for (size_t i = 0; i < n; i++)
        part->image.pixels[i * channels + (size_t)c] = plane[i];
}

/* Room to take one channel apart. */
typedef struct PlaneScratch {
    unsigned char *raw, *shuffled; /* one channel; all channels */
    float *plane;
    uint16_t *halves;
} PlaneScratch;

static void plane_scratch_free(PlaneScratch *s)
{
    free(s->raw);
    free(s->shuffled);
    free(s->plane);
    free(s->halves);
}

static int plane_scratch_alloc(PlaneScratch *s, const RetexPart *part)
{
    size_t n = pixel_count(part), channels = (size_t)part->image.channels;
    s->raw = malloc(n * sample_bytes(part));
    s->shuffled = malloc(n * sample_bytes(part) * channels);
    s->plane = malloc(n * sizeof *s->plane);
    s->halves = malloc(n * sizeof *s->halves);
    if (s->raw && s->shuffled && s->plane && s->halves)
        return 1;
    plane_scratch_free(s);
    return 0;
}

/* The crc of a part's samples as they are stored. */
static int stored_crc(uint32_t *crc, const RetexPart *part, RetexError *err)
{
    PlaneScratch s;
    if (!plane_scratch_alloc(&s, part))
        return out_of_memory(part, err);
    uLong sum = crc32(0, NULL, 0);
    for (int c = 0; c < part->image.channels; c++) {
        store_channel(s.raw, s.plane, s.halves, part, c);
        sum = crc32_z(sum, s.raw, pixel_count(part) * sample_bytes(part));
    }
    plane_scratch_free(&s);
    *crc = (uint32_t)sum;
    return 0;
}

static int encode_planes(RetexPacked *packed, const RetexPart *part, RetexError *err)
{
    PlaneScratch s;
    if (!plane_scratch_alloc(&s, part))
        return out_of_memory(part, err);
    size_t n = pixel_count(part), width = sample_bytes(part), total = n * width * (size_t)part->image.channels;
    unsigned char *to = s.shuffled;
    for (int c = 0; c < part->image.channels; c++) {
        store_channel(s.raw, s.plane, s.halves, part, c);
        for (size_t k = 0; k < width; k++)
            for (size_t i = 0; i < n; i++)
                *to++ = s.raw[i * width + k];
    }
    uLongf bytes = compressBound(total);
    packed->codec = RETEX_PACK_PLANES;
    packed->data = malloc(bytes);
    int failed = !packed->data || compress2(packed->data, &bytes, s.shuffled, total, DEFLATE_LEVEL) != Z_OK;
    plane_scratch_free(&s);
    if (failed)
        return out_of_memory(part, err);
    packed->bytes = bytes;
    return 0;
}

static int decode_planes(RetexPart *part, const RetexPacked *packed, RetexError *err)
{
    PlaneScratch s;
    if (!plane_scratch_alloc(&s, part))
        return out_of_memory(part, err);
    size_t n = pixel_count(part), width = sample_bytes(part), total = n * width * (size_t)part->image.channels;
    uLongf bytes = total;
    int ok = uncompress(s.shuffled, &bytes, packed->data, packed->bytes) == Z_OK && bytes == total;
    const unsigned char *from = s.shuffled;
    uLong crc = crc32(0, NULL, 0);
    for (int c = 0; ok && c < part->image.channels; c++) {
        for (size_t k = 0; k < width; k++)
            for (size_t i = 0; i < n; i++)
                s.raw[i * width + k] = *from++;
        crc = crc32_z(crc, s.raw, n * width);
        load_channel(s.raw, s.plane, s.halves, part, c);
    }
    plane_scratch_free(&s);
    if (!ok)
        return damaged(part, "its planes do not inflate to its size", err);
    part->crc = (uint32_t)crc;
    return 0;
}

/* --- the mask of black pixels --- */

static int is_black(const float *rgb)
{
    return rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0;
}

/* 1 with the mask in packed, 0 with none needed, or an error. */
static int encode_mask(RetexPacked *packed, const RetexPart *part, RetexError *err)
{
    size_t n = pixel_count(part), size = (n + 7) / 8, black = 0;
    unsigned char *bits = calloc(size, 1);
    if (!bits)
        return out_of_memory(part, err);
    for (size_t i = 0; i < n; i++)
        if (is_black(part->image.pixels + 3 * i)) {
            bits[i / 8] |= (unsigned char)(1u << i % 8);
            black++;
        }
    uLongf bytes = compressBound(size);
    packed->mask = black ? malloc(bytes) : NULL;
    int failed = black && (!packed->mask || compress2(packed->mask, &bytes, bits, size, 9) != Z_OK);
    free(bits);
    if (failed)
        return out_of_memory(part, err);
    packed->mask_bytes = black ? bytes : 0;
    return black > 0;
}

static int apply_mask(RetexPart *part, const RetexPacked *packed, RetexError *err)
{
    size_t n = pixel_count(part), size = (n + 7) / 8;
    if (!packed->mask)
        return 0;
    unsigned char *bits = malloc(size);
    if (!bits)
        return out_of_memory(part, err);
    uLongf bytes = size;
    int ok = uncompress(bits, &bytes, packed->mask, packed->mask_bytes) == Z_OK && bytes == size;
    for (size_t i = 0; ok && i < n; i++)
        if (bits[i / 8] >> i % 8 & 1)
            memset(part->image.pixels + 3 * i, 0, 3 * sizeof(float));
    free(bits);
    return ok ? 0 : damaged(part, "its mask does not inflate to its size", err);
}

/* --- JPEG --- */

static double srgb_encode(double v)
{
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static double srgb_decode(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* The value of each of the 256 codes. */
static void code_values(float value[256], const RetexPacked *packed)
{
    double range = log2(1 + packed->max / packed->scale);
    for (int i = 0; i < 256; i++)
        value[i] = (float)(packed->codec == RETEX_PACK_SRGB ? srgb_decode(i / 255.0)
                                                            : packed->scale * (exp2(i / 255.0 * range) - 1));
}

static unsigned char code_of(double v, const RetexPacked *packed)
{
    double t = packed->codec == RETEX_PACK_SRGB ? srgb_encode(v)
                                                : log2(1 + v / packed->scale) / log2(1 + packed->max / packed->scale);
    return (unsigned char)lrint(255 * fmin(fmax(t, 0), 1));
}

/* Black pixels come back from the mask, so their codes are free: the mean of the others of their 8 x 8 block costs
 * least and keeps edges between light and black from ringing. */
static void fill_black(unsigned char *codes, const RetexImage *im)
{
    for (int by = 0; by < im->height; by += 8)
        for (int bx = 0; bx < im->width; bx += 8) {
            unsigned sum[3] = {0}, lit = 0;
            for (int pass = 0; pass < 2; pass++)
                for (int y = by; y < by + 8 && y < im->height; y++)
                    for (int x = bx; x < bx + 8 && x < im->width; x++) {
                        size_t i = retex_image_index(im, x, y);
                        int black = is_black(im->pixels + i);
                        for (int c = 0; c < 3; c++)
                            if (pass == 0 && !black)
                                sum[c] += codes[i + (size_t)c];
                            else if (pass == 1 && black && lit)
                                codes[i + (size_t)c] = (unsigned char)((sum[c] + lit / 2) / lit);
                        lit += pass == 0 && !black;
                    }
        }
}

/* The largest value and, over what is not black, the mean; 0 where some value is negative or not finite. */
static int radiance_range(const RetexPart *part, double *mean, double *max)
{
    size_t n = pixel_count(part), lit = 0;
    double sum = 0;
    *max = 0;
    for (size_t i = 0; i < n; i++) {
        const float *p = part->image.pixels + 3 * i;
        for (int c = 0; c < 3; c++) {
            if (!(p[c] >= 0) || isinf(p[c]) || (p[c] == 0 && signbit(p[c])))
                return 0;
            sum += (double)p[c];
            *max = fmax(*max, (double)p[c]);
        }
        lit += !is_black(p);
    }
    *mean = lit ? sum / (3.0 * (double)lit) : 0;
    return 1;
}

static int decode_jpeg_image(RetexPart *part, const RetexPacked *packed, RetexError *err)
{
    size_t n = pixel_count(part);
    int width, height, subsampling, colorspace, ok = 0;
    unsigned char *codes = malloc(3 * n);
    tjhandle jpeg = tjInitDecompress();
    if (codes && jpeg)
        ok = tjDecompressHeader3(jpeg, packed->data, packed->bytes, &width, &height, &subsampling, &colorspace) == 0 &&
             width == part->image.width && height == part->image.height &&
             tjDecompress2(jpeg, packed->data, packed->bytes, codes, width, 0, height, TJPF_RGB,
                           TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) == 0;
    if (jpeg)
        tjDestroy(jpeg);
    if (ok) {
        float value[256];
        code_values(value, packed);
        for (size_t i = 0; i < 3 * n; i++)
            part->image.pixels[i] = value[codes[i]] * (float)packed->gain[i % 3];
    }
    free(codes);
    return ok ? 0 : damaged(part, "its JPEG cannot be decoded", err);
}

/* Decode what was just encoded and set the gain that gives every channel its mean back. */
static int measure_gain(RetexPacked *packed, const RetexPart *part, RetexError *err)
{
    RetexPart copy = *part;
    memset(&copy.image, 0, sizeof copy.image);
    for (int c = 0; c < 3; c++)
        packed->gain[c] = 1;
    int code = retex_image_alloc(&copy.image, part->image.width, part->image.height, 3, err);
    if (!code)
        code = decode_jpeg_image(&copy, packed, err);
    if (!code)
        code = apply_mask(&copy, packed, err);
    for (size_t c = 0; !code && c < 3; c++) {
        double before = 0, after = 0;
        for (size_t i = 0; i < pixel_count(part); i++) {
            before += (double)part->image.pixels[3 * i + c];
            after += (double)copy.image.pixels[3 * i + c];
        }
        packed->gain[c] = before > 0 && after > 0 ? (double)(float)fmin(fmax(before / after, 0.5), 2) : 1;
    }
    retex_image_free(&copy.image);
    return code;
}

static int encode_jpeg(RetexPacked *packed, const RetexPart *part, int quality, RetexError *err)
{
    size_t n = pixel_count(part);
    unsigned char *codes = malloc(3 * n), *jpeg = NULL;
    unsigned long bytes = 0;
    if (!codes)
        return out_of_memory(part, err);
    for (size_t i = 0; i < 3 * n; i++)
        codes[i] = code_of((double)part->image.pixels[i], packed);
    int masked = encode_mask(packed, part, err);
    if (masked == 1)
        fill_black(codes, &part->image);
    tjhandle compressor = tjInitCompress();
    int failed = masked < 0 || !compressor ||
                 tjCompress2(compressor, codes, part->image.width, 0, part->image.height, TJPF_RGB, &jpeg, &bytes,
                             TJSAMP_444, quality, TJFLAG_ACCURATEDCT) != 0;
    packed->data = failed ? NULL : malloc(bytes);
    if (packed->data)
        memcpy(packed->data, jpeg, packed->bytes = bytes);
    if (compressor)
        tjDestroy(compressor);
    tjFree(jpeg);
    free(codes);
    if (masked < 0)
        return masked;
    return packed->data ? measure_gain(packed, part, err) : out_of_memory(part, err);
}

/* --- choice --- */

static int all_zero(const RetexPart *part)
{
    size_t n = pixel_count(part) * (size_t)part->image.channels;
    for (size_t i = 0; i < n; i++)
        if (part->image.pixels[i] != 0 || signbit(part->image.pixels[i]))
            return 0;
    return 1;
}

double retex_pack_mean(const RetexImage *im)
{
    RetexPart part = {.image = *im};
    double mean = 0, max = 0;
    return im->channels == 3 && radiance_range(&part, &mean, &max) ? mean : 0;
}

int retex_pack_encode(RetexPacked *packed, const RetexPart *part, RetexPackCodec wanted, int quality, double mean,
                      RetexError *err)
{
    memset(packed, 0, sizeof *packed);
    int code = stored_crc(&packed->crc, part, err);
    if (code)
        return code;
    if (all_zero(part)) {
        packed->codec = RETEX_PACK_ZERO;
        return 0;
    }
    double own_mean = 0, max = 0;
    int lossy = wanted == RETEX_PACK_LOG || wanted == RETEX_PACK_SRGB;
    int fits = part->image.channels == 3 && part->image.width <= JPEG_SIDE_MAX && part->image.height <= JPEG_SIDE_MAX;
    if (!lossy || !fits || !radiance_range(part, &own_mean, &max))
        return encode_planes(packed, part, err);
    packed->codec = wanted == RETEX_PACK_SRGB && max <= 1 ? RETEX_PACK_SRGB : RETEX_PACK_LOG;
    packed->scale = fmax(own_mean, mean) / 32;
    packed->max = max;
    code = encode_jpeg(packed, part, quality, err);
    if (code)
        retex_packed_free(packed);
    return code;
}

void retex_packed_free(RetexPacked *packed)
{
    free(packed->data);
    free(packed->mask);
    memset(packed, 0, sizeof *packed);
}

int retex_pack_decode(RetexPart *part, const RetexPacked *packed, RetexError *err)
{
    if (packed->codec == RETEX_PACK_PLANES)
        return decode_planes(part, packed, err);
    if (packed->codec != RETEX_PACK_ZERO) {
        if (part->image.channels != 3)
            return damaged(part, "a JPEG where there are not three channels", err);
        int code = decode_jpeg_image(part, packed, err);
        if (!code)
            code = apply_mask(part, packed, err);
        if (code)
            return code;
    }
    return stored_crc(&part->crc, part, err);
}

size_t retex_pack_least_bytes(RetexPackCodec codec, const RetexPart *part, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    if (codec == RETEX_PACK_PLANES)
        return pixels * sample_bytes(part) * strlen(part->letters) / DEFLATE_RATIO_MAX;
    if (codec == RETEX_PACK_ZERO)
        return 0;
    return pixels / 64 / 8; /* a JPEG spends at least a bit on each block */
}
