/* Denoising a set; see <retex/denoise.h>. */
#include <retex/denoise.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>
#include <retex/rounding.h>
#include <retex/sample.h>

#include "denoise_footprints.h"
#include "half.h"
#include "set_parts.h"

static int find_guides(int parts[GUIDE_COUNT], const RetexSet *set, RetexError *err)
{
    static const struct {
        const char *name;
        int channels;
    } table[GUIDE_COUNT] = {
        [GUIDE_SEEN_NORMAL] = {"guide_seen_normal", 3}, [GUIDE_SEEN_POSITION] = {"guide_seen_position", 3},
        [GUIDE_SEEN_ALBEDO] = {"guide_seen_albedo", 3}, [GUIDE_SEEN_MATERIAL] = {"guide_seen_material", 3},
        [GUIDE_NORMAL] = {"guide_normal", 3},           [GUIDE_POSITION] = {"guide_position", 3},
        [GUIDE_SPECULAR] = {"guide_specular", 1},
    };
    for (int k = 0; k < GUIDE_COUNT; k++)
        if ((parts[k] = signals_find_part(set, table[k].name, table[k].channels, err)) < 0)
            return parts[k];
    return RETEX_OK;
}

int retex_denoise_has_data(const RetexSet *set)
{
    Signals signals;
    int guides[GUIDE_COUNT];
    if (find_guides(guides, set, NULL) || signals_open(&signals, set, NULL))
        return 0;
    signals_close(&signals);
    return 1;
}

void retex_denoise_drop_data(RetexSet *set)
{
    for (int k = set->nparts - 1; k > 0; k--)
        if (part_is_denoise_data(set, k))
            retex_set_remove_part(set, k);
}

/* ---- bands of tiles ---- */

/* A tile's results lie in a band until no other tile reads what was there. */
typedef struct DenoiseWork {
    Denoiser denoiser;
    TileRoom **rooms; /* by thread */
    int nthreads, tiles_x;
    Band bands[2], *band;
    SignalSums *sums; /* by tile of the band, then signal: added up in order */
    SignalSums *all;  /* by signal */
} DenoiseWork;

static void denoise_job(void *context, int index, int thread)
{
    DenoiseWork *w = context;
    const Denoiser *d = &w->denoiser;
    tile_denoise(d, w->rooms[thread], d->roi.x0 + index * DENOISE_STEP, w->band,
                 w->sums + (size_t)index * (size_t)d->signals.count);
}

static void close_band(Band *band, int nparts)
{
    for (int k = 0; band->parts && k < nparts; k++)
        free(band->parts[k]);
    free(band->parts);
    band->parts = NULL;
}

static int open_band(Band *band, const Denoiser *d, const unsigned char *written, RetexError *err)
{
    const RetexSet *set = d->set;
    band->rows = 0;
    band->parts = calloc((size_t)set->nparts, sizeof *band->parts);
    for (int k = 0; band->parts && k < set->nparts; k++) {
        size_t floats = (size_t)DENOISE_STEP * (size_t)set->width * (size_t)set->parts[k].image.channels;
        if (written[k] && !(band->parts[k] = malloc(floats * sizeof(float))))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    }
    return band->parts ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
}

static int open_bands(DenoiseWork *w, RetexError *err)
{
    const Denoiser *d = &w->denoiser;
    unsigned char *written = calloc((size_t)d->set->nparts, 1);
    int code = written ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int s = 0; s < d->signals.count && !code; s++)
        for (int k = 0; k < d->signals.of[s].nmembers; k++)
            written[d->signals.of[s].members[k].part] = 1;
    if (!code)
        footprints_mark_written(d->footprints, d, written);
    for (int k = 0; k < 2 && !code; k++)
        code = open_band(&w->bands[k], d, written, err);
    free(written);
    return code;
}

/* Into the set. */
static void commit_band(const Band *band, const Denoiser *d)
{
    for (int part = 0; part < d->set->nparts; part++) {
        RetexImage *im = &d->set->parts[part].image;
        size_t channels = (size_t)im->channels, row = (size_t)(d->roi.x1 - d->roi.x0) * channels;
        for (int y = 0; band->parts[part] && y < band->rows; y++)
            memcpy(im->pixels + retex_image_index(im, d->roi.x0, band->first + y),
                   band->parts[part] + ((size_t)y * (size_t)im->width + (size_t)d->roi.x0) * channels,
                   row * sizeof(float));
    }
}

static void add_sums(DenoiseWork *w)
{
    int count = w->denoiser.signals.count;
    for (int k = 0; k < w->tiles_x * count; k++)
        for (int c = 0; c < 3; c++) {
            w->all[k % count].before[c] += w->sums[k].before[c];
            w->all[k % count].after[c] += w->sums[k].after[c];
        }
}

static int open_work(DenoiseWork *w, RetexError *err)
{
    const Denoiser *d = &w->denoiser;
    size_t count = (size_t)d->signals.count;
    int code = RETEX_OK;
    w->tiles_x = (d->roi.x1 - d->roi.x0 + DENOISE_STEP - 1) / DENOISE_STEP;
    w->rooms = calloc((size_t)w->nthreads, sizeof *w->rooms);
    w->sums = calloc((size_t)w->tiles_x * count + 1, sizeof *w->sums);
    w->all = calloc(count + 1, sizeof *w->all);
    if (!w->rooms || !w->sums || !w->all)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < w->nthreads && k < w->tiles_x && !code; k++)
        code = tile_room_create(&w->rooms[k], d, err);
    if (!code)
        code = denoise_footprints_open(&w->denoiser.footprints, d, err);
    return code ? code : open_bands(w, err);
}

static void close_work(DenoiseWork *w)
{
    for (int k = 0; w->rooms && k < w->nthreads; k++)
        tile_room_close(&w->rooms[k]);
    for (int k = 0; k < 2; k++)
        close_band(&w->bands[k], w->denoiser.set->nparts);
    free(w->rooms);
    free(w->sums);
    free(w->all);
    denoise_footprints_close(&w->denoiser.footprints);
    signals_close(&w->denoiser.signals);
}

static void filter(DenoiseWork *w)
{
    const Denoiser *d = &w->denoiser;
    int number = 0;
    for (int y = d->roi.y0; y < d->roi.y1; y += DENOISE_STEP, number++) {
        w->band = &w->bands[number % 2];
        w->band->first = y;
        w->band->rows = d->roi.y1 - y < DENOISE_STEP ? d->roi.y1 - y : DENOISE_STEP;
        memset(w->sums, 0, sizeof *w->sums * (size_t)w->tiles_x * (size_t)d->signals.count);
        retex_parallel(w->nthreads, w->tiles_x, denoise_job, w);
        add_sums(w);
        commit_band(&w->bands[(number + 1) % 2], d); /* nothing reads the band before any more */
        w->bands[(number + 1) % 2].rows = 0;
        if (d->params.progress)
            d->params.progress(d->params.progress_context, (double)(y - d->roi.y0) / (d->roi.y1 - d->roi.y0));
    }
    for (int k = 0; k < 2; k++)
        commit_band(&w->bands[k], d);
}

/* ---- results ---- */

/* Means of all signals are as they were. */
static void restore_means(const DenoiseWork *w, int y)
{
    const Denoiser *d = &w->denoiser;
    for (int s = 0; s < d->signals.count; s++) {
        const SignalSums *sums = &w->all[s];
        float scale[3];
        for (int c = 0; c < 3; c++)
            scale[c] = sums->after[c] > 0 && sums->before[c] > 0 ? (float)(sums->before[c] / sums->after[c]) : 1;
        for (int k = 0; k < d->signals.of[s].nmembers; k++) {
            RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
            float *row = im->pixels + retex_image_index(im, 0, y);
            for (int x = 3 * d->roi.x0; x < 3 * d->roi.x1; x++)
                row[x] *= scale[x % 3];
        }
    }
}

/* The step to which a pixel's coefficients are rounded. */
static double pixel_step(const Denoiser *d, int x, int y)
{
    double white[3] = {0, 0, 0};
    for (int s = 0; s < d->signals.count; s++)
        for (int k = 0; k < d->signals.of[s].nmembers; k++) {
            const RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
            for (int c = 0; c < 3; c++)
                white[c] += im->pixels[retex_image_index(im, x, y) + (size_t)c];
        }
    return retex_coefficient_step(fmax(white[0], fmax(white[1], white[2])));
}

/* As the renderer rounds them; light that no texture multiplies stays as it is. */
static void round_coefficients(const Denoiser *d, int y)
{
    for (int x = d->roi.x0; x < d->roi.x1; x++) {
        const double step = pixel_step(d, x, y);
        for (int s = 0; s < d->signals.count; s++)
            for (int k = 0; k < d->signals.of[s].nmembers && d->signals.of[s].target >= 0; k++) {
                RetexImage *im = &d->set->parts[d->signals.of[s].members[k].part].image;
                float *value = im->pixels + retex_image_index(im, x, y);
                for (int c = 0; c < 3; c++)
                    if (value[c] != 0)
                        value[c] = (float)retex_round_to(value[c], step);
            }
    }
}

/* Halves as they will be stored, so that it does not matter whether the set was written and read in between. */
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

/* One row of all that was written, into numbers that are stored. */
static void finish_job(void *context, int y, int thread)
{
    const DenoiseWork *w = context;
    const Denoiser *d = &w->denoiser;
    (void)thread;
    if (y >= d->roi.y0 && y < d->roi.y1) {
        restore_means(w, y);
        if (strcmp(d->set->layout, "footprints") == 0)
            round_coefficients(d, y);
    }
    for (int k = 0; k < d->set->nparts; k++)
        if (w->bands[0].parts[k])
            round_halves(&d->set->parts[k], y);
}

static int check_params(const RetexDenoiseParams *p, RetexError *err)
{
    if (!(p->strength >= 0.1f && p->strength <= 10))
        return retex_fail(err, RETEX_EINVAL, "the strength of denoising must be 0.1 to 10, not %g", p->strength);
    if (p->radius < 1 || p->radius > DENOISE_RADIUS_MAX)
        return retex_fail(err, RETEX_EINVAL, "the radius of denoising must be 1 to %d, not %d", DENOISE_RADIUS_MAX,
                          p->radius);
    return RETEX_OK;
}

int retex_denoise(RetexSet *set, const RetexDenoiseParams *params, const RetexRoi *roi, int nthreads, RetexError *err)
{
    DenoiseWork work = {.denoiser = {.set = set, .params = RETEX_DENOISE_INIT}, .nthreads = retex_threads(nthreads)};
    Denoiser *d = &work.denoiser;
    if (params)
        memcpy(&d->params, params, params->size < sizeof d->params ? params->size : sizeof d->params);
    int code = check_params(&d->params, err);
    if (!code && set->spp < 2)
        code = retex_fail(err, RETEX_EINVAL, "less than two samples a pixel do not tell noise from picture");
    if (!code)
        code = find_guides(d->guides, set, err);
    if (!code)
        code = signals_open(&d->signals, set, err);
    if (!code)
        code = retex_image_prepare(&set->parts[0].image, set->width, set->height, 3, roi, &d->roi, err);
    if (!code)
        code = open_work(&work, err);
    if (!code) {
        filter(&work);
        retex_parallel(work.nthreads, set->height, finish_job, &work);
    }
    close_work(&work);
    if (!code && set->nterms)
        code = retex_combine(&set->parts[0].image, set, NULL, NULL, roi, nthreads, err);
    if (code)
        return code;
    for (int y = 0; y < set->height; y++)
        round_halves(&set->parts[0], y);
    if (d->params.progress)
        d->params.progress(d->params.progress_context, 1);
    retex_denoise_drop_data(set);
    set->denoised = 1;
    return RETEX_OK;
}
