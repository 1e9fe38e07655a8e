/* See choose.h. The table is fitted: its figures make the scales, by the mean over rooms of several makers, those of a
 * search that made pictures at all scales; docs/storage.md has what is kept. */
#include "compact/choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compact/detail.h"
#include "compact/gains.h"
#include "set/set.h"

/* What an image loses of what detail.h says of it: of its detail, which interpolation between blocks and most textures
 * show less of, or more, where they are brighter; and of its noise, in textures of several colours. */
typedef enum ImageKind { CLUSTERS, INTERREFLECTION, GAINS, BROAD_GAINS, LAMP_GAINS, IMAGE_KINDS } ImageKind;
static const struct {
    double detail, noise;
} LOST[IMAGE_KINDS] = {[CLUSTERS] = {0.035, 0.06},
                       [INTERREFLECTION] = {3, 4},
                       [GAINS] = {6, 20},
                       [BROAD_GAINS] = {20, 30},
                       [LAMP_GAINS] = {35, 35}};
static const double LOST_MIXED[] = {[RETEX_FOOTPRINT_SHARP] = 120, [RETEX_FOOTPRINT_BROAD] = 700};

#define NOISE_KEPT                                                                                                     \
    0.25 /* of less taken away, footprints of broad light are not averaged: detail.h sees no noise there */
#define NOISE_ALLOWED 0.025 /* what may be lost, as a share of the picture's own noise */
#define NOISE_IGNORED_OF_LAMPS                                                                                         \
    0.5              /* of noise that averaging removes: denoised light is uneven, and more hid blotches */
#define LAMP_LOSS 12 /* dB that the picture by a single lamp may lose more: it has more noise */

/* The coarsest scale that loses at most `most`. ignored: the share of the noise that is no loss. */
static int coarsest(const RetexCompactDetail *of, ImageKind kind, double ignored, double most)
{
    int step = RETEX_COMPACT_STEPS - 1;
    for (; step > 0; step--) {
        const double noise = of->noise * (1 - pow(4, -step)), detail = fmax(of->squares[step] - noise, 0);
        if (LOST[kind].detail * detail + LOST[kind].noise * (1 - ignored) * noise <= most)
            break;
    }
    return 1 << step;
}

/* The gains of single lamps are the same whether other light is mixed or not, but for their places. */
static int place_apart(const RetexCompactLight *light, const RetexCompactKind *kind, RetexCompactMixed mixed, int place)
{
    const RetexCompactGain *gain = &kind->gains[mixed][place - light->nlamps];
    int other = 0;
    if (place < light->nlamps)
        return place;
    while (kind->gains[RETEX_COMPACT_APART][other].lamps != gain->lamps ||
           kind->gains[RETEX_COMPACT_APART][other].term.nfactors != gain->term.nfactors ||
           memcmp(kind->gains[RETEX_COMPACT_APART][other].term.factors, gain->term.factors,
                  (size_t)gain->term.nfactors * sizeof *gain->term.factors) != 0)
        other++;
    return light->nlamps + other;
}

static int choose_lamps(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactDetails *details,
                        const RetexCompactParams *params, RetexError *err)
{
    const double most = pow(10, -(params->lamps > 0 ? params->lamps : params->psnr - LAMP_LOSS) / 10);
    const double ignored = params->noise * NOISE_IGNORED_OF_LAMPS;
    const int places = retex_compact_most_places(light);
    const size_t count = (size_t)(light->nkinds * places + light->set->nparameters);
    if (!retex_set_has_role(light->set, RETEX_ROLE_LAMP))
        return RETEX_OK;
    scales->lamps = malloc(count + 1);
    if (!scales->lamps)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for lamps");
    memset(scales->lamps, params->gain ? params->gain : 1, count);
    for (int k = 0; k < light->nkinds * places && !params->gain; k++) {
        const int number = k / places, place = k % places;
        const RetexCompactKind *kind = &light->kinds[number];
        const RetexCompactMixed mixed = scales->mixed[number];
        if (place < light->nlamps + kind->ngains[mixed] &&
            light->lamps[retex_compact_term_lamps(light, kind, mixed, place)].alone)
            scales->lamps[k] = (unsigned char)coarsest(
                &details->lamps[number * places + place_apart(light, kind, mixed, place)], LAMP_GAINS, ignored, most);
    }
    for (int p = 0; p < light->set->nparameters && !params->gain; p++)
        *retex_compact_share_scale(scales, light, p) =
            (unsigned char)coarsest(&details->lamps[light->nkinds * places + p], LAMP_GAINS, ignored, most);
    return RETEX_OK;
}

/* Footprints of further hits have one scale for all targets. */
static int choose_interreflection(const RetexCompactLight *light, const RetexCompactDetails *details, double ignored,
                                  double most)
{
    RetexCompactDetail all = {{0}, 0};
    for (int i = 0; i < light->nkinds; i++) {
        const RetexCompactDetail *one = &details->clusters[i];
        if (light->kinds[i].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            continue;
        all.noise += one->noise;
        for (int step = 1; step < RETEX_COMPACT_STEPS; step++)
            all.squares[step] += one->squares[step];
    }
    return coarsest(&all, INTERREFLECTION, ignored, most);
}

/* most: what may be lost. */
static int broad_scale(const RetexCompactDetail *clusters, const RetexCompactParams *params, double most)
{
    if (params->broad)
        return params->broad;
    return params->noise <= NOISE_KEPT ? 1 : coarsest(clusters, CLUSTERS, params->noise, most);
}

static void choose_kinds(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactDetails *details,
                         const RetexCompactParams *params)
{
    const double most = fmax(pow(10, -params->psnr / 10), params->noise * NOISE_ALLOWED * details->noise);
    const int chosen = choose_interreflection(light, details, params->noise, most);
    const int further = params->interreflection  ? params->interreflection
                        : chosen > params->least ? chosen
                                                 : params->least;
    /* With finishes to choose from no picture is of all light. */
    const int unseen = retex_set_has_finishes(light->set);
    for (int i = 0; i < light->nkinds; i++) {
        const RetexCompactKind *kind = &light->kinds[i];
        const RetexCompactDetail *gains = &details->gains[i];
        const int sharp = kind->kind == RETEX_FOOTPRINT_SHARP;
        /* gains of noisy light move noise from one term to another, whose texture may be brighter */
        const double ignored = light->set->denoised ? params->noise : 0;
        scales->clusters[i] = sharp ? 1
                              : kind->kind == RETEX_FOOTPRINT_INTERREFLECTION
                                  ? further
                                  : broad_scale(&details->clusters[i], params, most);
        scales->gains[i] = params->gain ? params->gain
                           : unseen     ? 1 << (RETEX_COMPACT_STEPS - 1)
                                        : coarsest(gains, sharp ? GAINS : BROAD_GAINS, ignored, most);
        const int few = kind->ngains[RETEX_COMPACT_MIXED] < kind->ngains[RETEX_COMPACT_APART];
        scales->mixed[i] = few && (unseen || LOST_MIXED[kind->kind] * details->mixed[i] <= most) ? RETEX_COMPACT_MIXED
                                                                                                 : RETEX_COMPACT_APART;
    }
}

int retex_compact_choose(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactParams *params,
                         int nthreads, RetexError *err)
{
    RetexCompactDetails details = {0};
    *scales = (RetexCompactScales){0};
    int code = params->broad && params->interreflection && params->gain
                   ? RETEX_OK
                   : retex_compact_details_open(&details, light, nthreads, err);
    if (!code)
        choose_kinds(scales, light, &details, params);
    if (!code)
        code = choose_lamps(scales, light, &details, params, err);
    retex_compact_details_close(&details);
    return code;
}
