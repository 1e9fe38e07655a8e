/* See strips.h. It goes over the set three times. First, strips are filtered into a band store, and what the second
 * pass reads goes into another. Then the factors of the second pass are found. When the change of the signals' means is
 * known, rows of the band store and of the file are finished into the last band store. */
#include "denoise/strips.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/band_store.h>
#include <retex/host/denoise_data.h>

#include "denoise/filter.h"
#include "denoise/second.h"
#include "base/jobs.h"
#include "set/strip.h"
#include "set/parts.h"
#include "set/source.h"

enum { STRIP = 2 * DENOISE_STEP, FINISHED = 4 * RETEX_BAND_ROWS };

_Static_assert(STRIP % RETEX_BAND_ROWS == 0, "strips are whole bands of the band store");

static const double FILTERED = 0.75, SECOND = 0.9; /* share of the work that is done, for progress */

/* Rows to be written to a band store. */
typedef struct StoreJob {
    RetexBandStore *store;
    const RetexSet *rows;
    const int *images; /* by part: its number in the band store, or -1 */
    int from, count;   /* the rows of the set to be written */
    int band;          /* the band that begins with these rows */
} StoreJob;

static int is_whole(const RetexSet *set, int part)
{
    return set->parts[part].image.width == set->width && set->parts[part].image.height == set->height;
}

static int is_light(const RetexDenoiser *d, int part)
{
    for (int s = 0; s < d->signals.count; s++)
        for (int k = 0; k < d->signals.of[s].nmembers; k++)
            if (d->signals.of[s].members[k].part == part)
                return 1;
    return 0;
}

/* Creates a band store with an image for each part that is wanted. is_between: it is read again by the next pass only.
 * Its light is yet to be scaled and therefore not rounded to halves, and compressing it would take longer than writing
 * it does. */
static int open_store(RetexBandStore **store, int *images, const RetexDenoiser *d, const unsigned char *wanted,
                      int is_between, RetexError *err)
{
    const RetexSet *set = d->set;
    int code = retex_band_store_create(store, set->width, set->height, set->id, d->params.near, err);
    if (!code && is_between)
        retex_band_store_set_plain(*store);
    for (int k = 0; k < set->nparts; k++) {
        const RetexPart *part = &set->parts[k];
        images[k] = -1;
        if (!code && wanted[k])
            code = retex_band_store_add(*store, part->name, part->letters,
                                        is_between && is_light(d, k) ? RETEX_FLOAT : part->type, &images[k], err);
    }
    return code;
}

static int store_part(void *context, int part, int thread, RetexError *err)
{
    const StoreJob *s = context;
    const RetexImage *im = &s->rows->parts[part].image;
    int code = RETEX_OK;
    (void)thread;
    if (s->images[part] < 0 || !im->pixels)
        return RETEX_OK;
    for (int y = 0; y < s->count && !code; y += RETEX_BAND_ROWS)
        code = retex_band_store_put(s->store, s->images[part], s->band + y / RETEX_BAND_ROWS,
                                    im->pixels + retex_image_index(im, 0, s->from + y), err);
    return code;
}

/* Writes count rows of `rows`, beginning at from, which is row y of the picture. */
static int store_rows(RetexBandStore *store, const int *images, const RetexSet *rows, int from, int count, int y,
                      int nthreads, RetexError *err)
{
    StoreJob job = {.store = store, .rows = rows, .images = images, .from = from, .count = count};
    job.band = y / RETEX_BAND_ROWS;
    return retex_jobs_run(nthreads, rows->nparts, store_part, &job, err);
}

/* State of all passes. */
typedef struct Strips {
    const RetexDenoiser *denoiser;
    RetexDenoiseResult result;
    RetexSet filtered; /* the set with what was filtered, which is in: */
    RetexSetSource *between;
    RetexPassedStore passed;
    RetexBandStore *stores[2]; /* filtered, finished */
    int *images[2];            /* by part: number of its image in each band store, or -1 */
    unsigned char *wanted;     /* by part: scratch */
    int nthreads;
} Strips;

static void show_progress(const Strips *s, double done)
{
    const RetexDenoiseParams *params = &s->denoiser->params;
    if (params->progress)
        params->progress(params->progress_context, done);
}

/* As denoiser, for the strip from row y on, loaded with the rows around it that a pass reads. */
static int load_strip(RetexDenoiser *strip, const Strips *s, const RetexDenoiser *denoiser, RetexSetStrip *loaded,
                      int y, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    const int end = y + STRIP < set->height ? y + STRIP : set->height;
    const int first = y > DENOISE_REACH ? y - DENOISE_REACH : 0;
    const int last = end + DENOISE_REACH < set->height ? end + DENOISE_REACH : set->height;
    *strip = *denoiser;
    strip->roi = (RetexRoi){0, y - first, set->width, end - first, 0, 3};
    strip->first_row = first;
    strip->params.progress = NULL;
    return retex_set_strip_load(&strip->set, loaded, first, last - first, s->nthreads, err);
}

static int filter_strip(Strips *s, const RetexDenoiser *bundle, RetexSetStrip *loaded, int y, RetexError *err)
{
    RetexDenoiser strip;
    RetexDenoisePassed passed = {0};
    int code = load_strip(&strip, s, bundle, loaded, y, err);
    const int from = strip.roi.y0, count = strip.roi.y1 - from;
    if (!code)
        code = retex_denoise_passed_open(&passed, &strip, count, err);
    strip.passed = &passed, passed.first = from;
    if (!code)
        code = retex_denoise_filter(&strip, &s->result, s->nthreads, err);
    if (!code && !s->stores[0])
        code = open_store(&s->stores[0], s->images[0], s->denoiser, s->result.written, 1, err);
    if (!code)
        code = store_rows(s->stores[0], s->images[0], strip.set, from, count, y, s->nthreads, err);
    for (int k = 0; k < PASSED_FACTOR && !code; k++)
        code = retex_passed_store_put(&s->passed, &strip, &passed, (RetexPassedImage)k, 0, count, y, err);
    retex_denoise_passed_close(&passed, &strip);
    return code;
}

/* A set with the parts for which wanted is 1; parts are to be freed. */
static int open_view(RetexSet *view, const RetexSet *set, const unsigned char *wanted, RetexError *err)
{
    *view = *set;
    view->parts = malloc(sizeof *set->parts * (size_t)set->nparts);
    if (!view->parts)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    memcpy(view->parts, set->parts, sizeof *set->parts * (size_t)set->nparts);
    for (int k = 0; k < set->nparts; k++)
        if (!wanted[k])
            view->parts[k].image = (RetexImage){0};
    return RETEX_OK;
}

static void mark_features(unsigned char *wanted, const RetexSet *set)
{
    for (int k = 0; k < set->nparts; k++)
        wanted[k] = retex_name_is_feature(set->parts[k].name) != 0;
}

static void mark_signals(unsigned char *wanted, const RetexSignals *signals, unsigned char mark)
{
    retex_signals_mark_members(signals, wanted, mark);
    for (int s = 0; s < signals->count; s++)
        wanted[signals->of[s].noise] = mark;
}

/* What the first pass reads for a bundle: light of lamps only the lamp's own, footprints only all light. */
static void mark_read(unsigned char *wanted, const RetexDenoiser *bundle, const RetexDenoiser *all)
{
    const RetexSet *set = all->set;
    mark_features(wanted, set);
    if (bundle->signals.of[0].lamp < 0) {
        memset(wanted, 1, (size_t)set->nparts);
        for (int t = 0; t < set->nterms; t++)
            if (set->terms[t].role == RETEX_ROLE_LAMP_PICTURE)
                wanted[set->terms[t].radiance] = 0;
        mark_signals(wanted, &all->signals, 0);
    }
    mark_signals(wanted, &bundle->signals, 1);
}

static int filter_bundle(Strips *s, const RetexDenoiser *bundle, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    const double begin = bundle->first_signal, count = bundle->signals.count;
    RetexSetStrip *loaded = NULL;
    RetexSet view = {0};
    mark_read(s->wanted, bundle, s->denoiser);
    int code = open_view(&view, set, s->wanted, err);
    if (!code)
        code = retex_set_strip_open(&loaded, &view, STRIP + 2 * DENOISE_REACH, 1, err);
    for (int y = 0; y < set->height && !code; y += STRIP) {
        show_progress(s, FILTERED * (begin + count * y / set->height) / bundle->nsignals);
        code = filter_strip(s, bundle, loaded, y, err);
    }
    retex_set_strip_close(&loaded);
    free(view.parts);
    return code;
}

static int filter_all(Strips *s, RetexError *err)
{
    RetexDenoiser bundle;
    int code = retex_passed_store_open(&s->passed, s->denoiser, err);
    for (int first = 0, count; !code && (count = retex_denoise_bundle(&bundle, s->denoiser, first)) > 0; first += count)
        code = filter_bundle(s, &bundle, err);
    return code;
}

static int second_bundle(Strips *s, RetexDenoiser *strip, int y, RetexError *err)
{
    RetexDenoisePassed passed = {0};
    const int from = strip->roi.y0, count = strip->roi.y1 - from;
    int code = retex_denoise_passed_open(&passed, strip, strip->set->height, err);
    for (int k = 0; k < PASSED_FACTOR && !code; k++)
        code = retex_passed_store_load(&s->passed, strip, &passed, (RetexPassedImage)k, strip->first_row, err);
    if (!code)
        code = retex_denoise_second(strip, &passed, s->result.sums, s->nthreads, err);
    if (!code)
        code = retex_passed_store_put(&s->passed, strip, &passed, PASSED_FACTOR, from, count, y, err);
    retex_denoise_passed_close(&passed, strip);
    return code;
}

static int second_strip(Strips *s, RetexSetStrip *loaded, int y, RetexError *err)
{
    RetexDenoiser strip, bundle;
    int code = load_strip(&strip, s, s->denoiser, loaded, y, err);
    for (int first = 0, count; !code && (count = retex_denoise_bundle(&bundle, &strip, first)) > 0; first += count)
        code = second_bundle(s, &bundle, y, err);
    return code;
}

static int second_all(Strips *s, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    RetexSetStrip *loaded = NULL;
    RetexSet features;
    mark_features(s->wanted, set);
    int code = open_view(&features, set, s->wanted, err);
    if (!code)
        code = retex_set_strip_open(&loaded, &features, STRIP + 2 * DENOISE_REACH, 1, err);
    for (int y = 0; y < set->height && !code; y += STRIP) {
        show_progress(s, FILTERED + (SECOND - FILTERED) * y / set->height);
        code = second_strip(s, loaded, y, err);
    }
    retex_set_strip_close(&loaded);
    free(features.parts);
    return code;
}

/* The set after filtering: written parts are in the band store, others in the source; without the data that only
 * denoising reads. */
static int open_filtered(Strips *s, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    if (s->stores[0]) {
        const int code = retex_store_source_open(&s->between, s->stores[0], err);
        s->stores[0] = NULL;
        if (code)
            return code;
    }
    s->filtered = *set;
    s->filtered.parts = malloc(sizeof *set->parts * (size_t)set->nparts);
    if (!s->filtered.parts)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    memcpy(s->filtered.parts, set->parts, sizeof *set->parts * (size_t)set->nparts);
    for (int k = 0; k < set->nparts; k++)
        if (retex_part_is_denoise_data(set, k) && !retex_name_is_noise(set->parts[k].name)) /* rounding reads noise */
            s->filtered.parts[k].image = (RetexImage){0};
        else if (s->images[0][k] >= 0) {
            s->filtered.parts[k].image.pixels = NULL;
            s->filtered.parts[k].source = s->between, s->filtered.parts[k].source_part = s->images[0][k];
        }
    return RETEX_OK;
}

static int finish_rows(Strips *s, RetexSetStrip *loaded, int y, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    const int count = set->height - y < FINISHED ? set->height - y : FINISHED;
    RetexDenoiser rows = *s->denoiser;
    RetexDenoisePassed passed;
    int code = retex_denoise_passed_open(&passed, s->denoiser, count, err);
    if (!code)
        code = retex_set_strip_load(&rows.set, loaded, y, count, s->nthreads, err);
    if (!code)
        code = retex_passed_store_load(&s->passed, s->denoiser, &passed, PASSED_FACTOR, y, err);
    rows.roi = (RetexRoi){0, 0, set->width, count, 0, 3};
    rows.passed = &passed;
    if (!code)
        code = retex_denoise_finish(&rows, &s->result, s->nthreads, err);
    if (!code)
        code = store_rows(s->stores[1], s->images[1], rows.set, 0, count, y, s->nthreads, err);
    retex_denoise_passed_close(&passed, s->denoiser);
    return code;
}

static int finish_all(Strips *s, RetexError *err)
{
    const RetexSet *set = s->denoiser->set;
    RetexSetStrip *loaded = NULL;
    int code = open_filtered(s, err);
    for (int k = 0; k < set->nparts; k++)
        s->wanted[k] = is_whole(set, k) && !retex_part_is_denoise_data(set, k);
    if (!code)
        code = open_store(&s->stores[1], s->images[1], s->denoiser, s->wanted, 0, err);
    if (!code)
        code = retex_set_strip_open(&loaded, &s->filtered, FINISHED, 1, err);
    for (int y = 0; y < set->height && !code; y += FINISHED) {
        show_progress(s, SECOND + (1 - SECOND) * y / set->height);
        code = finish_rows(s, loaded, y, err);
    }
    retex_set_strip_close(&loaded);
    return code;
}

/* Makes the finished rows those of the set, loads parts of another size into memory, and closes the source. */
static int take_over(Strips *s, RetexError *err)
{
    RetexSet *set = s->denoiser->set;
    for (int k = 0; k < set->nparts; k++) {
        RetexImage image = {0}, *to = &set->parts[k].image;
        if (s->images[1][k] >= 0 || to->pixels || retex_part_is_denoise_data(set, k))
            continue;
        int code = retex_image_alloc(&image, to->width, to->height, to->channels, err);
        if (!code)
            code = retex_set_part_rows(&image, set, k, 0, err);
        if (code) {
            retex_image_free(&image);
            return code;
        }
        *to = image;
    }
    RetexSetSource *finished;
    const int code = retex_store_source_open(&finished, s->stores[1], err);
    s->stores[1] = NULL;
    if (code)
        return code;
    for (int k = 0; k < set->nparts; k++) {
        const int is_stored = s->images[1][k] >= 0;
        if (is_stored) {
            free(set->parts[k].image.pixels);
            set->parts[k].image.pixels = NULL;
        }
        retex_part_set_source(&set->parts[k], is_stored ? finished : NULL, is_stored ? s->images[1][k] : 0);
    }
    retex_source_release(&finished);
    return RETEX_OK;
}

int retex_denoise_can_use_strips(const RetexSet *set)
{
    return set->nparts && set->parts[0].source && !retex_part_store(&set->parts[0]);
}

int retex_denoise_strips(const RetexDenoiser *denoiser, int nthreads, RetexError *err)
{
    Strips s = {.denoiser = denoiser, .nthreads = nthreads};
    int code = retex_denoise_result_open(&s.result, denoiser, err);
    for (int k = 0; k < 2; k++)
        s.images[k] = malloc(sizeof *s.images[k] * ((size_t)denoiser->set->nparts + 1));
    for (int k = 0; s.images[0] && k < denoiser->set->nparts; k++)
        s.images[0][k] = -1; /* of a set without light nothing is filtered */
    s.wanted = calloc((size_t)denoiser->set->nparts + 1, 1);
    if (!code && (!s.images[0] || !s.images[1] || !s.wanted))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    if (!code)
        code = filter_all(&s, err);
    if (!code)
        code = second_all(&s, err);
    if (!code)
        code = finish_all(&s, err);
    if (!code)
        code = take_over(&s, err);
    for (int k = 0; k < 2; k++) {
        retex_band_store_close(&s.stores[k]);
        free(s.images[k]);
    }
    retex_passed_store_close(&s.passed);
    free(s.filtered.parts);
    retex_source_release(&s.between);
    free(s.wanted);
    retex_denoise_result_close(&s.result);
    return code;
}
