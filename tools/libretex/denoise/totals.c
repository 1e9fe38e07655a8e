/* See totals.h. All that is read is in rows of the set's parts, so that sets in memory and open ones are the same. */
#include "denoise/totals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "base/jobs.h"
#include "denoise/features.h"
#include "denoise/picture_denoiser.h"
#include "set/rows.h"
#include "set/set.h"

enum { BAND = 64 }; /* rows of a job */

/* The values of params.denoiser. share: of the other denoiser's total, the rest is ours. */
static const struct Choice {
    const char *name;
    const RetexPictureDenoiser *denoiser;
    float share;
} choices[] = {{"nlm", NULL, 0}, {"oidn", &retex_oidn, 1}, {"both", &retex_oidn, 0.5f}};

static const struct Choice *find_choice(const char *name)
{
    for (size_t k = 0; name && k < sizeof choices / sizeof *choices; k++)
        if (strcmp(choices[k].name, name) == 0)
            return &choices[k];
    return name ? NULL : &choices[0];
}

int retex_denoiser_is_known(const char *name)
{
    return find_choice(name) != NULL;
}

/* ---- what is filtered ---- */

typedef struct Pictures {
    const RetexDenoiser *of;
    const RetexSignal *signal;
    float *color, *albedo, *normal; /* three floats a pixel */
    RetexRowReader **readers;       /* by thread */
    int nthreads;
} Pictures;

/* Add a part's row, times weight; a part of one channel counts for all three. */
static int add_row(float *to, const Pictures *p, int thread, int part, float weight, int y, RetexError *err)
{
    const RetexImage *im = &p->of->set->parts[part].image;
    const int each = im->channels == 1 ? 3 : 1;
    const float *row = NULL;
    const int code = retex_row_reader_get(p->readers[thread], part, y, &row, err);
    for (int i = 0; row && !code && i < 3 * im->width; i++)
        to[i] += weight * retex_denoise_finite(row[i / each]);
    return code;
}

static int load_color(const Pictures *p, int thread, int y, RetexError *err)
{
    const size_t length = 3 * (size_t)p->of->set->width;
    float *to = p->color + (size_t)y * length;
    int code = RETEX_OK;
    memset(to, 0, length * sizeof *to);
    for (int k = 0; k < p->signal->nmembers && !code; k++)
        if (p->signal->members[k].bright != 0)
            code = add_row(to, p, thread, p->signal->members[k].part, p->signal->members[k].bright, y, err);
    return code;
}

/* What tile.c takes for the modulation, but exactly 0 where a target is not seen: edges of the target show there. */
static int load_albedo(const Pictures *p, int thread, int y, RetexError *err)
{
    const RetexDenoiser *d = p->of;
    const size_t length = 3 * (size_t)d->set->width;
    float *to = p->albedo + (size_t)y * length;
    int code = RETEX_OK;
    const int of_target = p->signal->target >= 0, sharp = of_target && p->signal->kind == RETEX_FOOTPRINT_SHARP,
              any = of_target && p->signal->kind == RETEX_FOOTPRINT_HIT;
    for (size_t i = 0; i < length; i++)
        to[i] = any ? 1 : 0;
    if (sharp)
        code = add_row(to, p, thread, p->signal->cover, 1, y, err);
    else if (!any)
        code = add_row(to, p, thread, d->features[RETEX_FEATURE_SEEN_ALBEDO], 1, y, err);
    for (int t = 0; t < d->set->ntargets && !sharp && !any && !code; t++)
        if (d->signals.covers[t] >= 0)
            code = add_row(to, p, thread, d->signals.covers[t], DENOISE_TARGET_BRIGHTNESS - 1, y, err);
    for (size_t i = 0; i < length; i++)
        to[i] = fminf(fmaxf(to[i], 0), 1);
    return code;
}

static int load_normal(const Pictures *p, int thread, int y, RetexError *err)
{
    const size_t length = 3 * (size_t)p->of->set->width;
    memset(p->normal + (size_t)y * length, 0, length * sizeof(float));
    return add_row(p->normal + (size_t)y * length, p, thread, p->of->features[RETEX_FEATURE_SEEN_NORMAL], 1, y, err);
}

/* A band of rows. The normals are the same for all signals: they are loaded with no signal. */
static int load_band(void *context, int index, int thread, RetexError *err)
{
    const Pictures *p = context;
    const int height = p->of->set->height, end = (index + 1) * BAND < height ? (index + 1) * BAND : height;
    int code = retex_budget_check(p->of->params.budget, err);
    if (!code && !p->readers[thread])
        code = retex_row_reader_open(&p->readers[thread], p->of->set, err);
    for (int y = index * BAND; y < end && !code; y++) {
        code = p->signal ? load_color(p, thread, y, err) : load_normal(p, thread, y, err);
        if (!code && p->signal)
            code = load_albedo(p, thread, y, err);
    }
    return code;
}

static int load_pictures(Pictures *p, const RetexSignal *signal, RetexError *err)
{
    p->signal = signal;
    return retex_jobs_run(p->nthreads, (p->of->set->height + BAND - 1) / BAND, load_band, p, err);
}

static float *allocate(const RetexSet *set)
{
    return calloc(3 * (size_t)set->width * (size_t)set->height, sizeof(float));
}

static void close_pictures(Pictures *p)
{
    for (int k = 0; p->readers && k < p->nthreads; k++)
        retex_row_reader_close(&p->readers[k]);
    free(p->readers);
    free(p->color);
    free(p->albedo);
    free(p->normal);
}

static int open_pictures(Pictures *p, RetexError *err)
{
    const RetexSet *set = p->of->set;
    p->readers = calloc((size_t)p->nthreads, sizeof *p->readers);
    p->color = allocate(set), p->albedo = allocate(set), p->normal = allocate(set);
    if (!p->readers || !p->color || !p->albedo || !p->normal)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise whole pictures");
    return load_pictures(p, NULL, err);
}

/* ---- filtering ---- */

static int is_black(const float *pixels, size_t count)
{
    size_t i = 0;
    while (i < count && pixels[i] == 0)
        i++;
    return i == count;
}

static int check_result(float *result, size_t count, const RetexPictureDenoiser *denoiser, RetexError *err)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(result[i]))
            return retex_fail(err, RETEX_EUNSUPPORTED, "the result of %s has a number that is not finite",
                              denoiser->name);
        result[i] = fmaxf(result[i], 0);
    }
    return RETEX_OK;
}

/* Black light stays as it is. */
static int filter_signal(Pictures *p, float *result, const RetexPictureDenoiser *denoiser, void *state, RetexError *err)
{
    const RetexSet *set = p->of->set;
    const size_t count = 3 * (size_t)set->width * (size_t)set->height;
    const RetexDenoiserImages images = {set->width, set->height, p->color, p->albedo, p->normal, result};
    if (is_black(p->color, count))
        return RETEX_OK;
    const int code = denoiser->filter(state, &images, err);
    return code ? code : check_result(result, count, denoiser, err);
}

static int filter_all(RetexDenoiseTotals *totals, Pictures *p, const RetexPictureDenoiser *denoiser, void *state,
                      RetexError *err)
{
    int code = open_pictures(p, err);
    for (int s = 0; s < totals->count && !code; s++) {
        code = load_pictures(p, &p->of->signals.of[s], err);
        if (!code && !(totals->of[s] = allocate(p->of->set)))
            code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise whole pictures");
        if (!code)
            code = filter_signal(p, totals->of[s], denoiser, state, err);
    }
    return code;
}

/* Images of all signals, and three that are filtered with. */
static int check_memory(const RetexDenoiser *d, const char *name, RetexError *err)
{
    const uint64_t bytes = 12 * (uint64_t)d->set->width * (uint64_t)d->set->height * (uint64_t)(d->signals.count + 3);
    if (bytes <= retex_budget_left(d->params.budget))
        return RETEX_OK;
    return retex_fail(err, RETEX_ELIMIT, "%s filters whole pictures: that takes more than the %.0f MB of --max-memory",
                      name, (double)retex_budget_memory(d->params.budget) / (1 << 20));
}

int retex_denoise_totals_open(RetexDenoiseTotals **out, const RetexDenoiser *d, int nthreads, RetexError *err)
{
    const struct Choice *choice = find_choice(d->params.denoiser);
    Pictures pictures = {.of = d, .nthreads = retex_threads(nthreads)};
    void *state = NULL;
    *out = NULL;
    if (!choice->denoiser)
        return RETEX_OK;
    int code = check_memory(d, choice->denoiser->name, err);
    if (code)
        return code;
    RetexDenoiseTotals *totals = *out = calloc(1, sizeof *totals);
    if (totals)
        *totals = (RetexDenoiseTotals){.share = choice->share,
                                       .count = d->signals.count,
                                       .width = (size_t)d->set->width,
                                       .of = calloc((size_t)d->signals.count + 1, sizeof *totals->of)};
    if (!totals || !totals->of)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise whole pictures");
    if (!code)
        code = choice->denoiser->open(&state, nthreads, d->params.budget, err);
    if (!code)
        code = filter_all(totals, &pictures, choice->denoiser, state, err);
    choice->denoiser->close(&state);
    close_pictures(&pictures);
    if (code)
        retex_denoise_totals_close(out);
    return code;
}

void retex_denoise_totals_close(RetexDenoiseTotals **out)
{
    RetexDenoiseTotals *totals = out ? *out : NULL;
    if (!totals)
        return;
    for (int s = 0; totals->of && s < totals->count; s++)
        free(totals->of[s]);
    free(totals->of);
    free(totals);
    *out = NULL;
}

void retex_denoise_mix_total(float total[3], const RetexDenoiser *d, int signal, int x, int y)
{
    const RetexDenoiseTotals *totals = d->totals;
    if (!totals || (total[0] == 0 && total[1] == 0 && total[2] == 0))
        return;
    const float *other =
        totals->of[d->first_signal + signal] + 3 * ((size_t)(d->first_row + y) * totals->width + (size_t)x);
    for (int c = 0; c < 3; c++)
        total[c] = (1 - totals->share) * total[c] + totals->share * other[c];
}
