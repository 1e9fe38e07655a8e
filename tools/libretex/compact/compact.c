/* Makes compact sets: see compact.h. light.h sorts terms and footprints by target and kind. choose.h chooses the
 * scales by what detail.h tells of the set. For each kind, clusters.h makes new footprints, and gains.h turns its terms
 * into one radiance with gains. build.h puts the new set together. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/rounding.h>
#include <retex/host/set_build.h>

#include "compact/build.h"
#include "compact/choose.h"
#include "compact/compact.h"
#include "set/parts.h"

#define CORRECTION_STEP 8  /* steps of corrections, in RMS errors of a picture of mean 1 */
#define CORRECTION_PSNR 45 /* a compact set of less has no corrections, as they do not show */

int retex_compact_copy_set(RetexSet **result, const RetexSet *set, RetexError *err)
{
    RetexSetView view;
    char *kept = malloc((size_t)set->nparts + 1);
    if (!kept)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a set");
    for (int i = 0; i < set->nparts; i++)
        kept[i] = !retex_part_is_denoise_data(set, i);
    int code = retex_set_view_make(&view, set, kept, err);
    free(kept);
    if (code)
        return code;
    code = retex_compact_copy_head(result, &view.set, err);
    for (int i = 0; i < view.set.nparts && !code; i++) {
        int index;
        code = retex_compact_copy_part(*result, set, view.source[i], &index, err);
    }
    if (!code)
        code = retex_compact_copy_terms(*result, &view.set, err);
    retex_set_view_free(&view);
    return code;
}

/* The mean of the picture's colours that is not negative. */
static double picture_mean(const RetexImage *picture)
{
    const size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += fmax((double)picture->pixels[i], 0);
    return sum / (double)(count ? count : 1);
}

/* Round a correction to steps. Returns 1 if nothing is left of it. */
static int round_correction(RetexImage *image, double step)
{
    int empty = 1;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height * (size_t)image->channels; i++) {
        image->pixels[i] = (float)retex_round_to((double)image->pixels[i], step) + 0.0f; /* no -0 */
        empty = empty && image->pixels[i] == 0;
    }
    return empty;
}

/* Corrections are stored without loss, so they are rounded to what the compact set is off by, of white as of what is
 * mean in a picture of usual brightness. Those that are 0 everywhere are removed. */
static void round_corrections(RetexSet *set, double psnr)
{
    const double step = CORRECTION_STEP * picture_mean(&set->parts[0].image) * pow(10, -psnr / 20);
    for (int t = set->nterms - 1; t >= 0; t--) {
        const int part = set->terms[t].radiance;
        if (set->terms[t].role != RETEX_ROLE_CORRECTION ||
            (psnr >= CORRECTION_PSNR && !round_correction(&set->parts[part].image, step)))
            continue;
        memmove(&set->terms[t], &set->terms[t + 1], sizeof *set->terms * (size_t)(set->nterms - t - 1));
        set->nterms--;
        if (!retex_part_is_used(set, part))
            retex_set_remove_part(set, part);
    }
}

static int check_scale(int scale, const char *name, RetexError *err)
{
    if (scale == 0 || scale == 1 || scale == 2 || scale == 4 || scale == 8)
        return RETEX_OK;
    return retex_fail(err, RETEX_EINVAL, "the scale of %s is 1, 2, 4 or 8, not %d", name, scale);
}

static int check_params(const RetexCompactParams *params, RetexError *err)
{
    int code = check_scale(params->broad, "broad footprints", err);
    if (!code)
        code = check_scale(params->interreflection, "interreflections", err);
    if (!code)
        code = check_scale(params->gain, "gains", err);
    if (!code && !(params->psnr >= 20 && params->psnr <= 120))
        code = retex_fail(err, RETEX_EINVAL, "a compact set keeps 20 to 120 dB, not %g", params->psnr);
    if (!code && !(params->noise >= 0 && params->noise <= 1))
        code = retex_fail(err, RETEX_EINVAL, "what may be taken away of noise is 0 to 1, not %g", params->noise);
    return code;
}

static int is_compact(const RetexSet *set)
{
    int images = 0;
    for (int t = 0; t < set->nterms; t++)
        images |= retex_term_image(&set->terms[t]) >= 0;
    return images;
}

static void tell_unknown(const RetexCompactParams *params, const char *unknown)
{
    char text[256];
    snprintf(text, sizeof text, "the set cannot be made compact and takes more room: %s", unknown);
    params->warn(params->warn_context, text);
}

int retex_set_compact(RetexSet **compact, const RetexSet *set, const RetexCompactParams *params, int nthreads,
                      RetexError *err)
{
    static const RetexCompactParams defaults = RETEX_COMPACT_INIT;
    RetexCompactParams chosen = params ? *params : defaults;
    RetexCompactScales scales = {0};
    RetexCompactLight light = {0};
    const int sortable = strcmp(set->layout, "footprints") == 0 && !is_compact(set);
    const char *unknown = NULL;
    *compact = NULL;
    int code = check_params(&chosen, err);
    if (!code && sortable)
        code = retex_compact_light_open(&light, set, chosen.noise, &unknown, err);
    if (!code && unknown && chosen.warn)
        tell_unknown(&chosen, unknown);
    if (!code && sortable && !unknown) {
        code = retex_compact_choose(&scales, &light, &chosen, nthreads, err);
        if (!code)
            code = retex_compact_build(compact, &light, &scales, nthreads, err);
    } else if (!code) {
        code = retex_compact_copy_set(compact, set, err);
    }
    free(scales.lamps);
    retex_compact_light_close(&light);
    if (!code)
        round_corrections(*compact, chosen.psnr);
    if (code)
        retex_set_close(compact);
    return code;
}
