/* Finishes a filtered set: see filter.h. */
#include "denoise/filter.h"

#include <math.h>

#include <retex/combine.h>
#include <retex/parallel.h>

#include "denoise/residual.h"
#include "denoise/originals.h"
#include "precision/precision.h"
#include "set/parts.h"

/* Noise after filtering, as a share of that before: less than what is left of most light. */
static const double REMAINING_NOISE = 0.3;

/* Light of fireflies that a signal's other pixels share: more would be seen. As a share of the signal's light, and of
 * its noise. */
static const double FIREFLIES = 0.03, FIREFLIES_OF_NOISE = 0.15;

static const double LARGEST = 1e30; /* by which light is multiplied */

/* By what a signal is multiplied so that its sum is what it was, apart from many or large fireflies. */
static float scale_of(const RetexSignalSums *sums, int c)
{
    const double light = sums->before[c], noise = sqrt(sums->lit * sums->variance[c]), after = sums->after[c],
                 before = light + fmin(sums->lost[c], fmin(FIREFLIES * light, FIREFLIES_OF_NOISE * noise));
    return after > 0 && before > 0 && before / after < LARGEST ? (float)(before / after) : 1;
}

/* Multiplies members by the factors of the second pass, and signals so that their means are as before filtering. */
static void restore_means(const RetexDenoiser *d, const RetexDenoiseResult *result, int y)
{
    for (int s = 0; s < d->signals.count; s++) {
        const RetexSignalSums *sums = &result->sums[s];
        const float *factors = retex_denoise_passed_at(d->passed, d, s, 0, y) + DENOISE_PASSED_TOTAL;
        float scale[3];
        for (int c = 0; c < 3; c++)
            scale[c] = scale_of(sums, c);
        for (int k = 0; k < d->signals.of[s].nmembers; k++) {
            if (d->signals.of[s].members[k].corrects)
                continue;
            RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
            float *row = im->pixels + retex_image_index(im, 0, y);
            for (int x = d->roi.x0; x < d->roi.x1; x++)
                for (int c = 0; c < 3; c++)
                    row[3 * x + c] *= factors[DENOISE_PASSED * x + c] * scale[c];
        }
    }
}

typedef struct Finish {
    const RetexDenoiser *denoiser;
    const RetexDenoiseResult *result;
} Finish;

/* Numbers are halves before they are rounded to what they are known to, too: a set that is filtered in strips has had
 * some of them in a band store. */
static void restore_row(void *context, int y, int thread)
{
    const Finish *f = context;
    const RetexDenoiser *d = f->denoiser;
    (void)thread;
    if (y >= d->roi.y0 && y < d->roi.y1) {
        restore_means(d, f->result, y);
        retex_denoise_share_residual(d, y);
    }
    for (int k = 0; k < d->set->nparts; k++)
        if (f->result->written[k])
            retex_part_round_row(&d->set->parts[k], y);
}

static int round_all(const RetexDenoiser *d, int nthreads, RetexError *err)
{
    RetexPrecision *precision = NULL;
    int code = retex_precision_open(&precision, d->set, REMAINING_NOISE, err);
    if (!code)
        code = retex_precision_round(precision, d->set, &d->roi, nthreads, err);
    retex_precision_close(&precision);
    retex_set_round_to_types(d->set, nthreads);
    return code;
}

/* The picture of a term that is one: all light, or one lamp of value 1, as the filtered terms have it. */
static int make_picture(const RetexDenoiser *d, const RetexTerm *picture, int nthreads, RetexError *err)
{
    RetexSet *set = d->set;
    RetexPart *part = &set->parts[picture->radiance];
    RetexCombineParams sum = RETEX_COMBINE_INIT;
    float values[RETEX_PARAMETERS_MAX][3] = {{0}};
    sum.terms_only = 1;
    if (picture->role == RETEX_ROLE_LAMP_PICTURE) {
        for (int c = 0; c < 3; c++)
            values[picture->factors[0].index][c] = 1;
        sum.parameters = values[0];
    }
    const int code = retex_combine(&part->image, set, &sum, &d->roi, nthreads, err);
    for (int y = 0; y < set->height && !code; y++)
        retex_part_round_row(part, y);
    return code;
}

/* Part 0 is one, whether a term says so or not. */
static int make_pictures(const RetexDenoiser *d, int nthreads, RetexError *err)
{
    const RetexTerm all = {.role = RETEX_ROLE_PICTURE, .target = -1};
    const int nterms = d->set->nterms;
    int code = nterms ? make_picture(d, &all, nthreads, err) : RETEX_OK;
    for (int t = 0; t < nterms && !code; t++)
        if (d->set->terms[t].role == RETEX_ROLE_LAMP_PICTURE)
            code = make_picture(d, &d->set->terms[t], nthreads, err);
    for (int y = 0; y < d->set->height && !code && !nterms; y++)
        retex_part_round_row(&d->set->parts[0], y);
    return code;
}

int retex_denoise_finish(const RetexDenoiser *d, const RetexDenoiseResult *result, int nthreads, RetexError *err)
{
    Finish finish = {d, result};
    RetexSet *set = d->set;
    retex_parallel(retex_threads(nthreads), set->height, restore_row, &finish);
    int code = retex_denoise_use_originals(d->originals, set, &d->roi, nthreads, err);
    if (!code && set->nterms && !d->params.full_precision)
        code = round_all(d, nthreads, err);
    return code ? code : make_pictures(d, nthreads, err);
}
