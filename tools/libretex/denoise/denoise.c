/* Denoising a set; see <retex/denoise.h>. */
#include <retex/denoise.h>
#include <retex/host/set_build.h>
#include <retex/set_file.h>

#include <string.h>

#include "base/params.h"
#include "base/image.h"
#include "denoise/filter.h"
#include "denoise/originals.h"
#include "denoise/second.h"
#include "denoise/strips.h"
#include "denoise/totals.h"
#include "set/laid.h"
#include "set/parts.h"

enum { PREVIEW_RADIUS = 2 };

static int find_features(int parts[RETEX_FEATURE_COUNT], const RetexSet *set, RetexError *err)
{
    for (int k = 0; k < RETEX_FEATURE_COUNT; k++)
        if ((parts[k] = retex_signals_find_part(set, retex_feature_info(k)->name,
                                                (int)strlen(retex_feature_info(k)->letters), err)) < 0)
            return parts[k];
    return RETEX_OK;
}

int retex_denoise_has_data(const RetexSet *set)
{
    int features[RETEX_FEATURE_COUNT];
    return !find_features(features, set, NULL) && retex_signals_are_there(set);
}

void retex_denoise_drop_data(RetexSet *set)
{
    for (int k = set->nparts - 1; k > 0; k--)
        if (retex_part_is_denoise_data(set, k))
            retex_set_remove_part(set, k);
    for (int t = 0; t < set->nterms; t++)
        set->terms[t].noise_weight = 0;
}

static int is_preview(const RetexDenoiseParams *p)
{
    return p->quality && strcmp(p->quality, "preview") == 0;
}

static int check_params(const RetexDenoiseParams *p, RetexError *err)
{
    if (!(p->strength >= 0.1f && p->strength <= 10))
        return retex_fail(err, RETEX_EINVAL, "the strength of denoising must be 0.1 to 10, not %g", p->strength);
    if (p->radius < 1 || p->radius > DENOISE_RADIUS_MAX)
        return retex_fail(err, RETEX_EINVAL, "the radius of denoising must be 1 to %d, not %d", DENOISE_RADIUS_MAX,
                          p->radius);
    if (!retex_denoiser_is_known(p->denoiser))
        return retex_fail(err, RETEX_EINVAL, "the denoiser must be nlm, oidn or both, not '%s'", p->denoiser);
    if (p->quality && !is_preview(p) && strcmp(p->quality, "final") != 0)
        return retex_fail(err, RETEX_EINVAL, "the quality of denoising must be preview or final, not '%s'", p->quality);
    return RETEX_OK;
}

static int open_originals(RetexDenoiser *d, int nthreads, RetexError *err)
{
    if (!d->uses_originals)
        return RETEX_OK;
    return retex_denoise_originals_open(&d->originals, d->set, d->params.budget, nthreads, err);
}

/* Leaves out what takes longest for what it gains: the second pass smooths even light without a wide window, too. */
static void simplify(RetexDenoiseParams *p)
{
    p->radius = p->radius < PREVIEW_RADIUS ? p->radius : PREVIEW_RADIUS;
    p->footprints = 0;
    p->full_precision = 1;
}

/* The region of a set in memory. */
static int denoise_in_memory(RetexDenoiser *d, const RetexRoi *roi, int nthreads, RetexError *err)
{
    RetexSet *set = d->set;
    RetexDenoiseResult result = {NULL, NULL};
    RetexDenoisePassed passed = {0};
    int code = retex_image_prepare(&set->parts[0].image, set->width, set->height, 3, roi, &d->roi, err);
    if (!code)
        retex_set_round_to_types(set, nthreads);
    if (!code)
        code = open_originals(d, nthreads, err);
    if (!code)
        code = retex_denoise_result_open(&result, d, err);
    if (!code)
        code = retex_denoise_passed_open(&passed, d, d->roi.y1 - d->roi.y0, err);
    passed.first = d->roi.y0;
    d->passed = &passed;
    RetexDenoiser bundle;
    for (int first = 0, count; !code && (count = retex_denoise_bundle(&bundle, d, first)) > 0; first += count) {
        RetexDenoisePassed own = {passed.first, passed.rows, passed.of + first};
        bundle.passed = &own;
        code = retex_denoise_filter(&bundle, &result, nthreads, err);
        if (!code)
            code = retex_denoise_second(&bundle, &own, result.sums, nthreads, err);
    }
    if (!code)
        code = retex_denoise_finish(d, &result, nthreads, err);
    retex_denoise_passed_close(&passed, d);
    retex_denoise_result_close(&result);
    return code;
}

static int denoise_in_strips(RetexDenoiser *d, int nthreads, RetexError *err)
{
    const int code = open_originals(d, nthreads, err);
    return code ? code : retex_denoise_strips(d, nthreads, err);
}

int retex_denoise(RetexSet *set, const RetexDenoiseParams *params, const RetexRoi *roi, int nthreads, RetexError *err)
{
    RetexDenoiser d = {.set = set, .params = RETEX_DENOISE_INIT};
    int code = RETEX_PARAMS_COPY(&d.params, params, err);
    if (!code)
        code = retex_set_check_bare(set, "a denoised set", err);
    if (!code)
        code = check_params(&d.params, err);
    d.uses_originals = d.params.footprints;
    if (!code && is_preview(&d.params))
        simplify(&d.params);
    if (!code && set->spp < 2)
        code = retex_fail(err, RETEX_EINVAL, "less than two samples a pixel do not tell noise from picture");
    if (!code)
        code = find_features(d.features, set, err);
    if (!code)
        code = retex_signals_open(&d.signals, set, err);
    d.nsignals = d.signals.count;
    const int in_strips = !roi && retex_denoise_can_use_strips(set);
    if (!code && !in_strips)
        code = retex_set_load(set, nthreads, err);
    if (!code)
        code = retex_denoise_totals_open(&d.totals, &d, nthreads, err);
    if (!code)
        code = in_strips ? denoise_in_strips(&d, nthreads, err) : denoise_in_memory(&d, roi, nthreads, err);
    retex_denoise_totals_close(&d.totals);
    retex_denoise_originals_close(&d.originals);
    retex_signals_close(&d.signals);
    if (code)
        return code;
    if (d.params.progress)
        d.params.progress(d.params.progress_context, 1);
    retex_denoise_drop_data(set);
    set->denoised = 1;
    return RETEX_OK;
}
