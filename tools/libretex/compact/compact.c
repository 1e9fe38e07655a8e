/* Makes compact sets: see retex/compact.h. light.h sorts terms and footprints by target and kind. search.h chooses the
 * scales by measuring distortion. For each kind, clusters.h makes new footprints, and gains.h turns its terms into one
 * radiance with gains. build.h puts the new set together. */
#include <retex/compact.h>

#include <stdlib.h>
#include <string.h>

#include "compact/build.h"
#include "compact/search.h"
#include "set/parts.h"

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
    for (int i = 0; i < view.set.nfootprints && !code; i++)
        code = retex_set_add_footprint(*result, &view.set.footprints[i], NULL, err);
    for (int i = 0; i < view.set.nmixtures && !code; i++)
        code = retex_set_add_mixture(*result, &view.set.mixtures[i], NULL, err);
    for (int i = 0; i < view.set.nterms && !code; i++)
        code = retex_set_add_term(*result, &view.set.terms[i], NULL, err);
    retex_set_view_free(&view);
    return code;
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

int retex_set_compact(RetexSet **compact, const RetexSet *set, const RetexCompactParams *params, int nthreads,
                      RetexError *err)
{
    static const RetexCompactParams defaults = RETEX_COMPACT_INIT;
    RetexCompactParams chosen = params ? *params : defaults;
    RetexCompactScales scales;
    RetexCompactLight light = {0};
    int understood = 0;
    *compact = NULL;
    int code = check_params(&chosen, err);
    if (!code && strcmp(set->layout, "footprints") == 0)
        code = retex_compact_light_open(&light, set, chosen.noise, &understood, err);
    if (!code && understood) {
        code = retex_compact_search(&scales, &light, &chosen, nthreads, err);
        if (!code)
            code = retex_compact_build(compact, &light, &scales, nthreads, err);
    } else if (!code) {
        code = retex_compact_copy_set(compact, set, err);
    }
    retex_compact_light_close(&light);
    if (code)
        retex_set_close(compact);
    return code;
}
