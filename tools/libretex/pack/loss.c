/* Bytes of a pack by purpose, and its distortion: see loss.h. Pictures are compared as 16-bit integers, so that sums do
 * not depend on their order. */
#include "pack/loss.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/combine.h>

#include "retexture/combine_check.h"
#include "set/manifest.h"
#include "pack/open.h"
#include "picture/srgb_codes.h"
#include "set/noise.h"
#include "set/references.h"

/* --- bytes --- */

const char *retex_pack_use_name(int use)
{
    static const char *const names[RETEX_PACK_USES] = {"picture", "radiance", "gains",     "uv",   "spread",
                                                       "weights", "albedo",   "originals", "other"};
    return use >= 0 && use < RETEX_PACK_USES ? names[use] : NULL;
}

static void assign(void *context, RetexPartUse use, int user, int *part)
{
    static const RetexPackUse of_use[] = {[RETEX_PART_RADIANCE] = RETEX_PACK_RADIANCE,
                                          [RETEX_PART_IMAGE] = RETEX_PACK_GAINS,
                                          [RETEX_PART_UV] = RETEX_PACK_UV,
                                          [RETEX_PART_SPREAD] = RETEX_PACK_SPREAD,
                                          [RETEX_PART_ALBEDO] = RETEX_PACK_ALBEDO,
                                          [RETEX_PART_WEIGHT] = RETEX_PACK_WEIGHTS,
                                          [RETEX_PART_ORIGINAL] = RETEX_PACK_ORIGINALS};
    RetexPackUse *uses = context;
    (void)user;
    if (*part > 0)
        uses[*part] = of_use[use];
}

int retex_pack_bytes(uint64_t *bytes, int nuses, const RetexSet *set, RetexError *err)
{
    const RetexPack *pack = retex_pack_of(set);
    RetexPackUse uses[RETEX_SET_PARTS_MAX];
    memset(bytes, 0, (size_t)nuses * sizeof *bytes);
    if (!pack)
        return retex_fail(err, RETEX_ENOTFOUND, "the set is not that of an open pack");
    for (int i = 0; i < set->nparts; i++)
        uses[i] = i ? RETEX_PACK_OTHER : RETEX_PACK_PICTURE;
    retex_set_visit_const_parts(set, assign, uses);
    for (int i = 0; i < set->nparts; i++)
        if ((int)uses[i] < nuses)
            bytes[uses[i]] += retex_pack_part_bytes(pack, i);
    return 0;
}

/* --- loss --- */

/* For each picture its textures: none, white, smooth waves, and a chequerboard, which has the hardest edges. */
enum { SIDE = 256, WAVES = 4, SQUARES = 16 };
enum { SAMPLES_FULL_PROMISE = 32 }; /* a pixel: of fewer less is promised */

static const double CODE_MAX = 65535;
static const double PSNR_MAX = 120;

/* One picture of a set being made. */
typedef struct PictureWork {
    const RetexSet *set;
    uint16_t *codes;   /* of all of it: to be filled in, or, with squares, to compare with */
    uint64_t *squares; /* by strip; NULL: nothing to compare with */
    uint64_t *noise;   /* by strip, of the set's own; NULL: not wanted */
} PictureWork;

static void fill_trial_texture(RetexImage *image, int picture)
{
    const double turn = 2 * acos(-1) * WAVES / SIDE;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float *pixel = image->pixels + retex_image_index(image, x, y);
            const int dark = (x * SQUARES / SIDE + y * SQUARES / SIDE) % 2;
            for (int c = 0; c < 3; c++)
                pixel[c] = picture == RETEX_PACK_LOSS_WHITE   ? 1
                           : picture == RETEX_PACK_LOSS_WAVES ? (float)(0.5 + 0.4 * sin(turn * (x + c * y)))
                           : dark                             ? 0
                                                              : 1;
        }
}

static uint64_t squared_error(const uint16_t *a, const uint16_t *b, size_t count)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        const int64_t d = (int64_t)a[i] - b[i];
        sum += (uint64_t)(d * d);
    }
    return sum;
}

static int process_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    const PictureWork *work = context;
    const size_t first = 3 * (size_t)work->set->width * (size_t)y0;
    const size_t count = 3 * (size_t)work->set->width * (size_t)(y1 - y0);
    const int strip = y0 / RETEX_PICTURE_STRIP;
    if (!work->squares)
        retex_srgb_codes_16(work->codes + first, rows, count);
    if (!work->squares && !work->noise)
        return RETEX_OK;
    uint16_t *codes = malloc(count * sizeof *codes);
    float *noisy = work->noise ? malloc(count * sizeof *noisy) : NULL;
    int code = codes && (noisy || !work->noise) ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory to compare rows");
    if (!code && noisy) {
        memcpy(noisy, rows, count * sizeof *noisy);
        code = retex_set_add_noise(noisy, work->set, y0, y1, err);
    }
    if (!code)
        retex_srgb_codes_16(codes, noisy ? noisy : rows, count);
    if (!code)
        (noisy ? work->noise : work->squares)[strip] = squared_error(codes, work->codes + first, count);
    free(codes);
    free(noisy);
    return code;
}

/* A picture of a set's terms, with one of the trials' textures on all of its targets. A pack has no exact picture. */
static int measure_picture(const PictureWork *work, int picture, int nthreads, RetexError *err)
{
    RetexTexture *texture = NULL, *textures[RETEX_MAX_TARGETS] = {NULL};
    RetexImage texels = {0};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    PictureWork own = *work;
    int code = RETEX_OK;
    if (picture != RETEX_PACK_LOSS_ORIGINAL) {
        const int side = picture == RETEX_PACK_LOSS_WHITE ? 1 : SIDE;
        code = retex_image_alloc(&texels, side, side, 3, err);
        if (!code) {
            fill_trial_texture(&texels, picture);
            code = retex_texture_create(&texture, &texels, NULL, nthreads, err);
        }
    }
    params.terms_only = 1;
    for (int i = 0; i < work->set->ntargets; i++)
        textures[i] = texture;
    if (!code)
        code = retex_retexture(work->set, textures, &params, process_rows, &own, nthreads, err);
    retex_texture_close(&texture);
    retex_image_free(&texels);
    return code;
}

static int strips_of(const RetexSet *set)
{
    return (set->height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP;
}

/* Mean square, of display values of 0 to 1. */
static double mean_of(const uint64_t *squares, const RetexSet *set)
{
    uint64_t sum = 0;
    for (int i = 0; i < strips_of(set); i++)
        sum += squares[i];
    return (double)sum / (3.0 * set->width * set->height) / (CODE_MAX * CODE_MAX);
}

static double psnr_of(double square)
{
    return fmin(square > 0 ? -10 * log10(square) : PSNR_MAX, PSNR_MAX);
}

void retex_pack_reference_close(RetexPackReference *reference)
{
    for (int k = 0; k < RETEX_PACK_LOSSES; k++)
        free(reference->codes[k]);
    free(reference->squares);
    *reference = (RetexPackReference){0};
}

int retex_pack_reference_open(RetexPackReference *reference, const RetexSet *set, unsigned pictures, int nthreads,
                              RetexError *err)
{
    const size_t count = 3 * (size_t)set->width * (size_t)set->height;
    int code = RETEX_OK;
    *reference =
        (RetexPackReference){.set = set, .squares = calloc((size_t)strips_of(set) + 1, sizeof *reference->squares)};
    if (!reference->squares)
        return retex_fail(err, RETEX_ENOMEM, "no memory to compare pictures");
    for (int k = 0; k < RETEX_PACK_LOSSES && !code; k++) {
        const int noise = k == RETEX_PACK_LOSS_ORIGINAL && !set->denoised;
        if (!(pictures & 1u << k))
            continue;
        reference->codes[k] = malloc(count * sizeof *reference->codes[k]);
        const PictureWork work = {set, reference->codes[k], NULL, noise ? reference->squares : NULL};
        code = reference->codes[k] ? measure_picture(&work, k, nthreads, err)
                                   : retex_fail(err, RETEX_ENOMEM, "no memory to compare pictures");
        if (!code && noise)
            reference->noise = mean_of(reference->squares, set);
    }
    if (code)
        retex_pack_reference_close(reference);
    return code;
}

int retex_pack_reference_psnr(double psnr[RETEX_PACK_LOSSES], const RetexPackReference *reference, const RetexSet *pack,
                              int nthreads, RetexError *err)
{
    const RetexSet *set = reference->set;
    if (pack->width != set->width || pack->height != set->height || pack->ntargets != set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the pack is of another set");
    for (int k = 0; k < RETEX_PACK_LOSSES; k++) {
        const PictureWork work = {pack, reference->codes[k], reference->squares, NULL};
        psnr[k] = PSNR_MAX;
        if (!work.codes)
            continue;
        int code = measure_picture(&work, k, nthreads, err);
        if (code)
            return code;
        psnr[k] = psnr_of(mean_of(reference->squares, set));
    }
    return RETEX_OK;
}

double retex_pack_worst_psnr(const double psnr[RETEX_PACK_LOSSES])
{
    double worst = psnr[0];
    for (int k = 1; k < RETEX_PACK_LOSSES; k++)
        worst = fmin(worst, psnr[k]);
    return worst;
}

/* --- the promise --- */

double retex_pack_promised_psnr(int quality, int spp, double noise)
{
    const double few = spp > 0 ? fmax(10 * log10((double)SAMPLES_FULL_PROMISE / spp), 0) : 0;
    const double psnr = 25 + 0.1 * quality + 1.5 * fmax(quality - 90, 0) - few * fmin((100 - quality) / 10.0, 1);
    return psnr_of(fmax(pow(10, -psnr / 10), (100 - quality) / 100.0 * noise));
}

int retex_pack_loss(double *psnr, int npictures, const RetexSet *pack, const RetexSet *set, int nthreads,
                    RetexError *err)
{
    RetexPackReference reference;
    double all[RETEX_PACK_LOSSES];
    int code = retex_pack_reference_open(&reference, set, RETEX_PACK_ALL_PICTURES, nthreads, err);
    if (!code)
        code = retex_pack_reference_psnr(all, &reference, pack, nthreads, err);
    for (int i = 0; i < npictures && i < RETEX_PACK_LOSSES && !code; i++)
        psnr[i] = all[i];
    retex_pack_reference_close(&reference);
    return code;
}
