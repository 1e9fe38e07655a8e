/* Finishes a filtered set: see filter.h. */
#include "denoise/filter.h"

#include <math.h>
#include <string.h>

#include <retex/combine.h>
#include <retex/parallel.h>
#include <retex/rounding.h>

#include "base/half.h"

#define LIKE_SAMPLES 16 /* a filtered pixel knows as much as one of so many times as many samples */

/* Scales signals so that their means are as before filtering. */
static void restore_means(const RetexDenoiser *d, const RetexDenoiseResult *result, int y)
{
    for (int s = 0; s < d->signals.count; s++) {
        const RetexSignalSums *sums = &result->sums[s];
        float scale[3];
        for (int c = 0; c < 3; c++)
            scale[c] = sums->after[c] > 0 && sums->before[c] > 0 ? (float)(sums->before[c] / sums->after[c]) : 1;
        for (int k = 0; k < d->signals.of[s].nmembers; k++) {
            if (retex_signal_corrects(d->set, &d->signals.of[s].members[k]))
                continue;
            RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
            float *row = im->pixels + retex_image_index(im, 0, y);
            for (int x = 3 * d->roi.x0; x < 3 * d->roi.x1; x++)
                row[x] *= scale[x % 3];
        }
    }
}

/* The unit to which a pixel's coefficients are rounded. */
static double pixel_unit(const RetexDenoiser *d, int x, int y)
{
    double white[3] = {0, 0, 0};
    for (int s = 0; s < d->signals.count; s++)
        for (int k = 0; k < d->signals.of[s].nmembers; k++) {
            if (retex_signal_corrects(d->set, &d->signals.of[s].members[k]))
                continue;
            const RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
            for (int c = 0; c < 3; c++)
                white[c] += im->pixels[retex_image_index(im, x, y) + (size_t)c];
        }
    return retex_coefficient_unit(fmax(white[0], fmax(white[1], white[2])));
}

static void round_member(const RetexDenoiser *d, const RetexSignalMember *m, int x, int y, double unit)
{
    RetexImage *im = &d->set->parts[m->part].image;
    float *value = im->pixels + retex_image_index(im, x, y);
    for (int c = 0; c < 3; c++)
        if (value[c] != 0)
            value[c] = (float)retex_round_by(value[c], unit);
}

/* Rounds as the renderer does: corrections, and coefficients of layout footprints. Light that no texture multiplies is
 * not rounded. */
static void round_coefficients(const RetexDenoiser *d, int y)
{
    const int all = strcmp(d->set->layout, "footprints") == 0;
    for (int x = d->roi.x0; x < d->roi.x1; x++) {
        const double unit = pixel_unit(d, x, y), correction = retex_correction_unit(unit, LIKE_SAMPLES * d->set->spp);
        for (int s = 0; s < d->signals.count; s++)
            for (int k = 0; k < d->signals.of[s].nmembers; k++) {
                const RetexSignalMember *m = &d->signals.of[s].members[k];
                if (retex_signal_corrects(d->set, m))
                    round_member(d, m, x, y, correction);
                else if (all && d->signals.of[s].target >= 0)
                    round_member(d, m, x, y, unit);
            }
    }
}

/* Rounds to halves as the file will, so that it does not matter whether the set is written and read in between. */
static void round_halves(const RetexPart *part, int y)
{
    const RetexImage *im = &part->image;
    float *row = im->pixels + retex_image_index(im, 0, y);
    size_t count = (size_t)im->width * (size_t)im->channels;
    uint16_t halves[256];
    for (size_t i = 0; i < count && part->type == RETEX_HALF; i += 256) {
        size_t n = count - i < 256 ? count - i : 256;
        retex_half_from_float(halves, row + i, n);
        retex_half_to_float(row + i, halves, n);
    }
}

typedef struct Finish {
    const RetexDenoiser *denoiser;
    const RetexDenoiseResult *result;
} Finish;

static void finish_row(void *context, int y, int thread)
{
    const Finish *f = context;
    const RetexDenoiser *d = f->denoiser;
    (void)thread;
    if (y >= d->roi.y0 && y < d->roi.y1) {
        restore_means(d, f->result, y);
        round_coefficients(d, y);
    }
    for (int k = 0; k < d->set->nparts; k++)
        if (f->result->written[k])
            round_halves(&d->set->parts[k], y);
}

int retex_denoise_finish(const RetexDenoiser *d, const RetexDenoiseResult *result, int nthreads, RetexError *err)
{
    Finish finish = {d, result};
    RetexSet *set = d->set;
    int code = RETEX_OK;
    retex_parallel(retex_threads(nthreads), set->height, finish_row, &finish);
    const int exact = set->exact_picture;
    set->exact_picture = 0; /* until it is made of the filtered terms */
    if (set->nterms)
        code = retex_combine(&set->parts[0].image, set, NULL, NULL, &d->roi, nthreads, err);
    set->exact_picture = exact;
    for (int y = 0; y < set->height && !code; y++)
        round_halves(&set->parts[0], y);
    return code;
}
