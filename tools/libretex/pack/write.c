/* Writing a pack: the set is made compact and encoded, finely enough for the PSNR that the quality promises, and its
 * parts are written in order after a manifest and an index. The bytes depend on the set and the parameters only, not on
 * dates or threads. */
#include <retex/pack.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/reduce.h>
#include <retex/set_file.h>

#include "base/params.h"
#include "retexture/combine_check.h"
#include "compact/build.h"
#include "compact/compact.h"
#include "io/output.h"
#include "pack/open.h"
#include "pack/encode.h"
#include "pack/loss.h"
#include "pack/zip.h"
#include "reduce/plan.h"
#include "set/laid.h"
#include "set/set.h"

/* dB by which compacting alone aims above the whole, because its errors and those of coding add up. The margin grows by
 * this factor from quality 95 to 100, where coding is finer. */
static const double COMPACTING_MARGIN = 3, COMPACTING_MARGIN_GROWS = 3;

/* Qualities to aim at after a promise was not kept. Less noise is removed from 90 on; above 110 only lossless coding is
 * finer. */
static const double AIMS[] = {50, 70, 92, 94, 96, 98, 100, 105, 110, INFINITY};

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
}

/* --- the file --- */

/* Smaller sets, each a pack of its own. */
typedef struct Levels {
    RetexPackScales scales;
    void *data[RETEX_PACK_LEVELS_MAX];
    size_t bytes[RETEX_PACK_LEVELS_MAX];
} Levels;

static const Levels no_levels;

static int write_manifest(char **text, const RetexPackEncoded *w, const RetexPackPromise *promise, const Levels *levels,
                          RetexError *err)
{
    RetexSet described = *w->set;
    char *json = NULL;
    described.parts = malloc((size_t)described.nparts * sizeof *described.parts);
    if (!described.parts)
        return no_memory(err);
    for (int i = 0; i < described.nparts; i++) {
        described.parts[i] = w->set->parts[i];
        described.parts[i].crc = w->items[i].crc;
    }
    int code = retex_set_manifest(&described, &json, err);
    free(described.parts);
    if (!code && !(*text = retex_pack_describe(json, w->set, w->packed, promise, &levels->scales)))
        code = no_memory(err);
    free(json);
    return code;
}

static unsigned char *make_index(const RetexPackEncoded *w, size_t *bytes)
{
    *bytes = 0;
    for (int i = 0; i < w->set->nparts; i++)
        *bytes += (size_t)w->packed[i].nslices * RETEX_PACK_INDEX_ENTRY_BYTES;
    unsigned char *index = malloc(*bytes + 1), *at = index;
    for (int i = 0; index && i < w->set->nparts; i++)
        for (int k = 0; k < w->packed[i].nslices; k++)
            for (int b = 0; b < RETEX_PACK_INDEX_ENTRY_BYTES; b++)
                *at++ = (unsigned char)((b < 4 ? w->packed[i].bytes[k] : w->packed[i].crcs[k]) >> 8 * (b % 4) & 255);
    return index;
}

/* Slices first to first + count as one file of the zip; none where they are empty. */
static int write_slices(RetexOutput *output, RetexZipList *list, const RetexPackEncoded *w, int part, int planes,
                        int first, int count, uint64_t *written, RetexError *err)
{
    const RetexPackPart *p = &w->packed[part];
    size_t *bytes = calloc((size_t)count + 1, sizeof *bytes), total = 0;
    char name[RETEX_PACK_NAME_MAX];
    int code = bytes ? 0 : no_memory(err);
    for (int k = 0; !code && k < count; k++)
        total += bytes[k] = p->bytes[first + k];
    retex_pack_file_name(name, sizeof name, w->set, part, planes);
    if (!code && total)
        code = retex_zip_entry_write(output, list, name, (const void *const *)w->items[part].slices + first, bytes,
                                     count, written, err);
    free(bytes);
    return code;
}

static int write_levels(RetexOutput *output, RetexZipList *list, const Levels *levels, uint64_t *written,
                        RetexError *err)
{
    int code = 0;
    for (int i = 0; i < levels->scales.count && !code; i++) {
        const void *data = levels->data[i];
        char name[RETEX_PACK_NAME_MAX];
        retex_pack_level_name(name, sizeof name, levels->scales.of[i]);
        code = retex_zip_entry_write(output, list, name, &data, &levels->bytes[i], 1, written, err);
    }
    return code;
}

static int write_entries(RetexOutput *output, RetexZipList *list, const RetexPackEncoded *w, const char *manifest,
                         const Levels *levels, uint64_t *written, RetexError *err)
{
    size_t bytes;
    const void *text = manifest;
    unsigned char *index = make_index(w, &bytes);
    const void *index_bytes = index, *picture = w->picture.data;
    if (!index)
        return no_memory(err);
    const size_t length = strlen(manifest);
    int code = retex_zip_entry_write(output, list, RETEX_PACK_MANIFEST_NAME, &text, &length, 1, written, err);
    if (!code)
        code = retex_zip_entry_write(output, list, RETEX_PACK_INDEX_NAME, &index_bytes, &bytes, 1, written, err);
    free(index);
    if (!code && picture)
        code =
            retex_zip_entry_write(output, list, RETEX_PACK_PICTURE_NAME, &picture, &w->picture.bytes, 1, written, err);
    for (int planes = 0; planes < 2; planes++)
        for (int i = 0; !code && i < w->set->nparts; i++) {
            const RetexPackPart *p = &w->packed[i];
            const int jpeg = p->codec == RETEX_PACK_JPEG ? 1 + p->nstrips : 0;
            if (planes ? p->nslices > jpeg : jpeg)
                code = write_slices(output, list, w, i, planes, planes ? jpeg : 0, planes ? p->nslices - jpeg : jpeg,
                                    written, err);
        }
    if (!code)
        code = write_levels(output, list, levels, written, err);
    return code ? code : retex_zip_directory_write(output, list, written, err);
}

/* promise: what the manifest says of the loss, or NULL. */
static int write_all(RetexOutput *output, const RetexPackEncoded *w, const RetexPackPromise *promise,
                     const Levels *levels, uint64_t *written, RetexError *err)
{
    RetexZipList list = {0};
    char *manifest = NULL;
    *written = 0;
    int code = write_manifest(&manifest, w, promise, levels, err);
    if (!code)
        code = write_entries(output, &list, w, manifest, levels, written, err);
    retex_zip_list_free(&list);
    free(manifest);
    return code;
}

/* --- the promise --- */

/* A set encoded for a quality that is aimed at, which may be above 100. */
typedef struct Attempt {
    RetexSet *compact;
    RetexPackEncoded encoded;
} Attempt;

static void attempt_free(Attempt *attempt)
{
    retex_pack_encoded_free(&attempt->encoded);
    retex_set_close(&attempt->compact);
    *attempt = (Attempt){0};
}

static double compacting_margin(double aim)
{
    const double finest = fmax(fmin((aim - 95) / 5, 1), 0);
    return COMPACTING_MARGIN * (1 + (COMPACTING_MARGIN_GROWS - 1) * finest);
}

/* params: NULL, or who is told what cannot be made compact. */
static int attempt_make(Attempt *attempt, const RetexSet *set, double aim, const RetexPackParams *params, int nthreads,
                        RetexError *err)
{
    const int exact = isinf(aim);
    const RetexPackQuantizer quantizer = retex_pack_quantizer(exact ? 0 : retex_pack_quality_psnr(aim));
    RetexCompactParams compacting = RETEX_COMPACT_INIT;
    compacting.psnr = exact ? 0 : retex_pack_quality_psnr(aim) + compacting_margin(aim);
    compacting.noise = pow(fmax(fmin((100 - aim) / 10, 1), 0), 2);
    if (params)
        compacting.warn = params->warn, compacting.warn_context = params->warn_context;
    int code = exact ? retex_compact_copy_set(&attempt->compact, set, err)
                     : retex_set_compact(&attempt->compact, set, &compacting, nthreads, err);
    return code ? code
                : retex_pack_encode(&attempt->encoded, attempt->compact, exact ? NULL : &quantizer, nthreads, err);
}

/* The PSNR of its worst picture, made from the very bytes that will be written. */
static int attempt_measure(double *worst, const Attempt *attempt, const RetexPackReference *reference, int nthreads,
                           RetexError *err)
{
    RetexOutput *output = NULL;
    RetexInput *input = NULL;
    RetexSet *pack = NULL;
    double psnr[RETEX_PACK_LOSSES];
    uint64_t written;
    void *data = NULL;
    size_t bytes;
    int code = retex_output_open_memory(&output, err);
    if (!code)
        code = write_all(output, &attempt->encoded, NULL, &no_levels, &written, err);
    if (!code)
        code = retex_output_take(&output, &data, &bytes, err);
    if (!code)
        code = retex_input_borrow(&input, data, bytes, "the pack", err);
    if (!code)
        code = retex_pack_open(&pack, &input, err);
    if (!code)
        code = retex_pack_reference_psnr(psnr, reference, pack, nthreads, err);
    *worst = code ? 0 : retex_pack_worst_psnr(psnr);
    retex_set_close(&pack);
    retex_input_close(&input);
    retex_output_abandon(&output);
    free(data);
    return code;
}

static double next_aim(double least)
{
    int i = 0;
    while (AIMS[i] < least)
        i++;
    return AIMS[i];
}

/* Attempts, each finer than the last, until what is promised holds; without loss it does. */
static int keep_promise(Attempt *attempt, RetexPackPromise *promise, const RetexSet *set,
                        const RetexPackReference *reference, const RetexPackParams *params, int nthreads,
                        RetexError *err)
{
    double aim = promise->quality;
    for (;;) {
        int code = attempt_make(attempt, set, aim, params, nthreads, err);
        params = NULL; /* once is enough */
        if (!code)
            code = attempt_measure(&promise->measured, attempt, reference, nthreads, err);
        if (code || promise->measured >= promise->promised || isinf(aim))
            return code;
        attempt_free(attempt);
        aim = next_aim(aim + promise->promised - promise->measured);
    }
}

/* 1: pictures can be made of the set with other textures. Sets that have no terms, or not what they need, are packed
 * without a promise. Or RETEX_ENOMEM. */
static int is_comparable(const RetexSet *set, RetexError *err)
{
    int sound = set->nterms > 0 ? retex_combine_check(set, err) : 0;
    for (int t = 0; t < set->ntargets && sound > 0; t++) {
        sound = 0;
        for (int i = 0; i < set->nfootprints; i++)
            sound |= set->footprints[i].target == t;
    }
    return sound;
}

/* A set encoded, and what its manifest says of the loss. */
typedef struct Packed {
    Attempt attempt;
    RetexPackPromise promise;
    int has_promise;
} Packed;

static int encode(Packed *packed, const RetexSet *set, const RetexPackParams *params, int nthreads, RetexError *err)
{
    RetexPackReference reference = {0};
    const int comparable = params->lossless ? 0 : is_comparable(set, err);
    *packed = (Packed){.promise = {.quality = params->quality}, .has_promise = comparable};
    if (comparable < 0)
        return comparable;
    int code = comparable ? retex_pack_reference_open(&reference, set, RETEX_PACK_PROMISED_PICTURES, nthreads, err) : 0;
    packed->promise.promised = retex_pack_promised_psnr(params->quality, set->spp, reference.noise);
    if (!code && params->lossless)
        code = retex_pack_encode(&packed->attempt.encoded, set, NULL, nthreads, err);
    else if (!code && comparable)
        code = keep_promise(&packed->attempt, &packed->promise, set, &reference, params, nthreads, err);
    else if (!code)
        code = attempt_make(&packed->attempt, set, params->quality, params, nthreads, err);
    retex_pack_reference_close(&reference);
    return code;
}

static int write_packed(RetexOutput *output, const Packed *packed, const Levels *levels, uint64_t *written,
                        RetexError *err)
{
    return write_all(output, &packed->attempt.encoded, packed->has_promise ? &packed->promise : NULL, levels, written,
                     err);
}

static uint64_t bytes_of(const Packed *packed)
{
    const RetexPackEncoded *w = &packed->attempt.encoded;
    uint64_t bytes = w->picture.bytes;
    for (int i = 0; i < w->set->nparts; i++)
        for (int k = 0; k < w->packed[i].nslices; k++)
            bytes += w->packed[i].bytes[k];
    return bytes;
}

/* --- levels --- */

/* Half of the size is left out: it would take more bytes than all others. */
static const int LEVELS[] = {3, 4, 6, 8};
enum {
    LEVELS_COUNT = sizeof LEVELS / sizeof *LEVELS,
    LEVEL_QUALITY = 90, /* of levels of a lossless pack */
    LEVEL_QUALITIES = 3,
    LEVEL_QUALITY_STEP = 10
};
#define LEVELS_SHARE (1 / 3.0) /* of the pack's bytes, that all levels may take */

static int pack_level(void **data, size_t *bytes, const RetexSet *reduced, int quality, int nthreads, RetexError *err)
{
    RetexPackParams params = RETEX_PACK_INIT;
    RetexOutput *output = NULL;
    Packed packed;
    uint64_t written;
    params.quality = quality > 1 ? quality : 1;
    int code = encode(&packed, reduced, &params, nthreads, err);
    if (!code)
        code = retex_output_open_memory(&output, err);
    if (!code)
        code = write_packed(output, &packed, &no_levels, &written, err);
    if (!code)
        code = retex_output_take(&output, data, bytes, err);
    retex_output_abandon(&output);
    attempt_free(&packed.attempt);
    return code;
}

/* Make a level of the highest quality at which it takes at most so many bytes; of the lowest if it never does. */
static int make_level(void **data, size_t *bytes, const RetexSet *set, int scale, double most, int quality,
                      int nthreads, RetexError *err)
{
    RetexSet *reduced = NULL;
    int code = retex_set_reduce(&reduced, set, scale, nthreads, err);
    for (int i = 0; i < LEVEL_QUALITIES && !code; i++) {
        free(*data);
        *data = NULL;
        code = pack_level(data, bytes, reduced, quality - i * LEVEL_QUALITY_STEP, nthreads, err);
        if ((double)*bytes <= most)
            break;
    }
    retex_set_close(&reduced);
    return code;
}

/* Which levels a set has. */
static RetexPackScales find_scales(const RetexSet *set)
{
    RetexPackScales scales = {0};
    for (int i = 0; i < LEVELS_COUNT && (set->width + LEVELS[i] - 1) / LEVELS[i] >= RETEX_PACK_LEVEL_WIDTH; i++)
        scales.of[scales.count++] = LEVELS[i];
    return scales;
}

/* A level's part of the bytes is its part of the pixels of all that are not made yet, the smallest being first. */
static int make_levels(Levels *levels, const RetexSet *set, double bytes, const RetexPackParams *params, int nthreads,
                       RetexError *err)
{
    const int quality = params->lossless ? LEVEL_QUALITY : params->quality;
    double most = LEVELS_SHARE * bytes, pixels = 0;
    int code = 0;
    for (int i = 0; i < levels->scales.count; i++)
        pixels += pow(levels->scales.of[i], -2);
    for (int i = levels->scales.count - 1; i >= 0 && !code; i--) {
        const double own = pow(levels->scales.of[i], -2);
        code = make_level(&levels->data[i], &levels->bytes[i], set, levels->scales.of[i], most * own / pixels, quality,
                          nthreads, err);
        most -= (double)levels->bytes[i], pixels -= own;
    }
    return code;
}

static void free_levels(Levels *levels)
{
    for (int i = 0; i < levels->scales.count; i++)
        free(levels->data[i]);
}

/* Whether the set can be reduced is known before all work. */
static int begin_levels(Levels *levels, const RetexSet *set, const RetexPackParams *params, RetexError *err)
{
    RetexReducePlan plan;
    if (!params->levels)
        return RETEX_OK;
    levels->scales = find_scales(set);
    if (!levels->scales.count && params->warn) {
        char text[160];
        snprintf(text, sizeof text, "the set has no levels: that of a third would be less than %d pixels wide",
                 RETEX_PACK_LEVEL_WIDTH);
        params->warn(params->warn_context, text);
    }
    const int code = retex_reduce_plan_open(&plan, set, RETEX_PACK_LEVEL_SCALE_MAX, err);
    if (!code) {
        retex_set_close(&plan.reduced);
        retex_reduce_plan_close(&plan);
    }
    return code;
}

int retex_pack_write(const RetexSet *set, const char *path, const RetexPackParams *given, size_t *bytes, int nthreads,
                     RetexError *err)
{
    RetexPackParams params = RETEX_PACK_INIT;
    RetexOutput *output = NULL;
    Levels levels = {0};
    Packed packed = {0};
    uint64_t written = 0;
    if (RETEX_PARAMS_COPY(&params, given, err))
        return RETEX_EINVAL;
    if (params.quality < 1 || params.quality > 100)
        return retex_fail(err, RETEX_EINVAL, "quality is 1 to 100, not %d", params.quality);
    int code = retex_set_check_bare(set, "a pack", err);
    if (!code)
        code = begin_levels(&levels, set, &params, err);
    if (!code)
        code = encode(&packed, set, &params, nthreads, err);
    if (!code)
        code = make_levels(&levels, set, (double)bytes_of(&packed), &params, nthreads, err);
    if (!code)
        code = retex_output_open(&output, path, err);
    if (!code)
        code = write_packed(output, &packed, &levels, &written, err);
    if (!code)
        code = retex_output_commit(&output, err);
    retex_output_abandon(&output);
    attempt_free(&packed.attempt);
    free_levels(&levels);
    if (!code && bytes)
        *bytes = (size_t)written;
    return code;
}
