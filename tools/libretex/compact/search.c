/* See search.h. A rate-distortion search. First the distortion of each choice is measured alone, all others at their
 * finest step. Squared errors of different choices add up approximately: so the combination with the lowest rate
 * (numbers stored for each pixel) whose sum of distortions is within bounds is taken and measured. The bounds are then
 * scaled by the ratio of the predicted to the measured distortion, and the search is repeated.
 *
 * Footprints are noisy, in denoised sets too. Smaller images average noise away: the pictures change, but are no worse.
 * If n is the mean square of the noise, a scale s removes n (1 - 1 / s^2), which hardly grows with large s, whereas the
 * error at edges and gradients at least doubles from one scale to the next. So the differences at the first two scales
 * separate noise from distortion. */
#include "compact/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compact/lamps.h"
#include "set/set.h"

#define STEPS RETEX_COMPACT_STEPS
#define NOISE_ALLOWED 0.025   /* distortion allowed, as a share of the set's own noise: 0.1 dB */
#define NOISE_IGNORED 0.9     /* share of the noise estimate that is not counted as distortion, times params->noise */
#define NEGLIGIBLE_SHARE 0.03 /* share of the bound below which only the coarsest scale of gains is measured */
#define EXCESS_SHARE 0.25     /* share of the finest scales' distortion that may be added, if above the bound */
#define BOUND_GROWTH_MAX 4    /* largest factor by which a bound is scaled */
#define MEASURED_MAX 8        /* combinations measured at most */
#define LAMP_LOSS 12          /* dB that the picture by a single lamp may lose more: it has more noise */
#define CHOICES_MAX 64
#define SEPARATE_KINDS_MAX 6 /* with more kinds than these, the kinds of all targets share their choices */

/* One choice: the scale of some kinds' footprints or gains, or whether terms of three and more interreflections use
 * one mixture for all targets. */
typedef enum ChoiceSubject { CLUSTERS, GAINS, MIXED } ChoiceSubject;

typedef struct Choice {
    ChoiceSubject subject;
    int kinds[RETEX_COMPACT_KINDS], nkinds;
    int steps, step, measured_step;              /* step: the current one, 0 is the finest */
    double squares[STEPS][RETEX_COMPACT_TRIALS]; /* by step and trial: distortion */
    double noise[RETEX_COMPACT_TRIALS];          /* by trial: noise that an infinite scale would remove */
    double numbers[STEPS];                       /* by step: rate, in numbers for each pixel */
} Choice;

/* A kind's trial pictures, and the scales they were made with. */
typedef struct TrialPictures {
    int clusters, gains, mixed, interreflection;
    RetexImage pictures[RETEX_COMPACT_TRIALS];
} TrialPictures;

typedef struct Search {
    const RetexCompactLight *light; /* of the reference's set */
    RetexCompactReference reference;
    RetexCompactCache *cache;
    TrialPictures trials[RETEX_COMPACT_KINDS][2]; /* at the finest scales, and at those last measured */
    RetexImage rest[RETEX_COMPACT_TRIALS];        /* pictures of terms without factors */
    Choice choices[CHOICES_MAX];
    int count, nthreads;
    double bound;
    double finest[RETEX_COMPACT_TRIALS]; /* distortion when all choices are at their finest */
} Search;

/* ---- choices ---- */

static void apply(RetexCompactScales *scales, const Choice *choice, int step)
{
    for (int i = 0; i < choice->nkinds; i++) {
        const int kind = choice->kinds[i];
        if (choice->subject == CLUSTERS)
            scales->clusters[kind] = 1 << step;
        else if (choice->subject == GAINS)
            scales->gains[kind] = 1 << step;
        else
            scales->mixed[kind] = step ? RETEX_COMPACT_MIXED : RETEX_COMPACT_APART;
    }
}

/* How many lamps have radiance of their own; how many gains of interreflections a kind has. Those of single lamps do
 * not count: they have other scales. */
static int lamp_count(const RetexCompactLight *light)
{
    int count = 0;
    for (int i = 0; i < light->nlamps; i++)
        count += !light->lamps[i].alone;
    return count;
}

static int gain_count(const RetexCompactLight *light, const RetexCompactKind *kind, RetexCompactMixed mixed)
{
    int count = 0;
    for (int i = 0; i < kind->ngains[mixed]; i++)
        count += !light->lamps[kind->gains[mixed][i].lamps].alone;
    return count;
}

static double numbers_of(const Search *work, const Choice *choice, int step)
{
    double numbers = 0;
    for (int i = 0; i < choice->nkinds; i++) {
        const RetexCompactKind *kind = &work->light->kinds[choice->kinds[i]];
        if (choice->subject == CLUSTERS)
            numbers += (3 + 7.0 * kind->count) / (1 << (2 * step));
        else if (choice->subject == GAINS)
            numbers += 3.0 * (gain_count(work->light, kind, RETEX_COMPACT_MIXED) + lamp_count(work->light)) /
                       (1 << (2 * step));
        else if (!step)
            numbers += 3.0 / 16 *
                       (gain_count(work->light, kind, RETEX_COMPACT_APART) -
                        gain_count(work->light, kind, RETEX_COMPACT_MIXED)); /* gains of a typical scale */
    }
    return numbers;
}

static Choice *find_choice(Search *work, ChoiceSubject subject, const RetexCompactKind *kind)
{
    for (int i = 0; i < work->count; i++) {
        const RetexCompactKind *first = &work->light->kinds[work->choices[i].kinds[0]];
        const int together = kind->kind == RETEX_FOOTPRINT_INTERREFLECTION || work->light->nkinds > SEPARATE_KINDS_MAX;
        if (work->choices[i].subject == subject && first->kind == kind->kind && together)
            return &work->choices[i];
    }
    Choice *choice = &work->choices[work->count++];
    *choice = (Choice){.subject = subject, .steps = subject == MIXED ? 2 : STEPS};
    return choice;
}

static void add_choice(Search *work, ChoiceSubject subject, int kind)
{
    Choice *choice = find_choice(work, subject, &work->light->kinds[kind]);
    choice->kinds[choice->nkinds++] = kind;
}

/* List the choices to search. Scales that the parameters fix are set here and are no choices. */
static void list_choices(Search *work, RetexCompactScales *scales, const RetexCompactParams *params)
{
    for (int i = 0; i < work->light->nkinds; i++) {
        const RetexCompactKind *kind = &work->light->kinds[i];
        const int sharp = kind->kind == RETEX_FOOTPRINT_SHARP,
                  interreflection = kind->kind == RETEX_FOOTPRINT_INTERREFLECTION;
        const int wanted = sharp ? 1 : interreflection ? params->interreflection : params->broad;
        scales->clusters[i] = wanted ? wanted : 1;
        scales->gains[i] = params->gain ? params->gain : 1;
        if (!wanted)
            add_choice(work, CLUSTERS, i);
        if (kind->ninterreflections && !params->gain)
            add_choice(work, GAINS, i);
        if (kind->ngains[RETEX_COMPACT_MIXED] < kind->ngains[RETEX_COMPACT_APART])
            add_choice(work, MIXED, i);
    }
}

/* ---- trials ---- */

static void free_pictures(TrialPictures *trials)
{
    for (int t = 0; t < RETEX_COMPACT_TRIALS; t++)
        retex_image_free(&trials->pictures[t]);
}

/* The scale of interreflection footprints, which all targets share. */
static int interreflection_scale(const RetexCompactLight *light, const RetexCompactScales *scales)
{
    for (int i = 0; i < light->nkinds; i++)
        if (light->kinds[i].kind == RETEX_FOOTPRINT_INTERREFLECTION)
            return scales->clusters[i];
    return 1;
}

static int pictures_of_kind(Search *work, int kind, const RetexCompactScales *scales, const RetexImage **pictures,
                            RetexError *err)
{
    const TrialPictures wanted = {.clusters = scales->clusters[kind],
                                  .gains = scales->gains[kind],
                                  .mixed = (int)scales->mixed[kind],
                                  .interreflection = interreflection_scale(work->light, scales)};
    int place = 0;
    for (; place < 2 && work->trials[kind][place].pictures[0].pixels; place++) {
        const TrialPictures *trials = &work->trials[kind][place];
        *pictures = trials->pictures;
        if (trials->clusters == wanted.clusters && trials->gains == wanted.gains && trials->mixed == wanted.mixed &&
            trials->interreflection == wanted.interreflection)
            return RETEX_OK;
    }
    TrialPictures *trials = &work->trials[kind][place < 1 ? 0 : 1];
    free_pictures(trials);
    *trials = wanted;
    *pictures = trials->pictures;
    return retex_compact_trial_pictures(trials->pictures, work->light, kind, scales, work->cache, work->nthreads, err);
}

static int measure_scales(Search *work, const RetexCompactScales *scales, double squares[RETEX_COMPACT_TRIALS],
                          RetexError *err)
{
    const RetexImage *parts[RETEX_COMPACT_KINDS + 1] = {work->rest};
    int count = 1, code = RETEX_OK;
    if (!work->rest[0].pixels)
        code = retex_compact_trial_pictures(work->rest, work->light, -1, scales, work->cache, work->nthreads, err);
    for (int i = 0; i < work->light->nkinds && !code; i++)
        if (work->light->kinds[i].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            code = pictures_of_kind(work, i, scales, &parts[count++], err);
    return code ? code : retex_compact_distortions(&work->reference, parts, count, squares, work->nthreads, err);
}

static double noise_removed(const Search *work, int step)
{
    return work->light->noise * NOISE_IGNORED * (1 - 1.0 / (1 << (2 * step)));
}

/* Subtract the noise that averaging removes. Gains of noisy sets are excepted: smooth gains move noise from one term
 * to another, whose texture may be brighter, so all of their error counts as distortion. */
static void separate_noise(const Search *work, Choice *choice)
{
    const int denoised = work->light->set->denoised;
    const int averages = choice->subject == CLUSTERS || (choice->subject == GAINS && denoised);
    for (int t = 0; t < RETEX_COMPACT_TRIALS && averages; t++) {
        const double *first = choice->squares[1], *second = choice->squares[2];
        const double noise = (2 * first[t] - second[t]) / (2 * (1 - 1.0 / 4) - (1 - 1.0 / 16));
        choice->noise[t] = fmax(noise, 0);
        for (int step = 1; step < choice->steps; step++)
            choice->squares[step][t] = fmax(choice->squares[step][t] - noise_removed(work, step) * choice->noise[t], 0);
    }
}

static int measure_step(Search *work, Choice *choice, int step, const RetexCompactScales *fine, RetexError *err)
{
    RetexCompactScales scales = *fine;
    apply(&scales, choice, step);
    int code = measure_scales(work, &scales, choice->squares[step], err);
    for (int t = 0; t < RETEX_COMPACT_TRIALS; t++)
        choice->squares[step][t] = fmax(choice->squares[step][t] - work->finest[t], 0);
    return code;
}

static double worst(const double squares[RETEX_COMPACT_TRIALS])
{
    double most = squares[0];
    for (int t = 1; t < RETEX_COMPACT_TRIALS; t++)
        most = fmax(most, squares[t]);
    return most;
}

/* Measure the distortion that each step of each choice adds to that of the finest scales. */
static int measure(Search *work, const RetexCompactScales *fine, RetexError *err)
{
    int code = measure_scales(work, fine, work->finest, err);
    for (int i = 0; i < work->count && !code; i++) {
        Choice *choice = &work->choices[i];
        const int last = choice->steps - 1;
        for (int step = 0; step <= last; step++)
            choice->numbers[step] = numbers_of(work, choice, step);
        code = measure_step(work, choice, last, fine, err);
        const int negligible =
            choice->subject == GAINS && worst(choice->squares[last]) < NEGLIGIBLE_SHARE * work->bound;
        for (int step = 1; step < last && !code; step++)
            if (negligible)
                memcpy(choice->squares[step], choice->squares[last], sizeof choice->squares[last]);
            else
                code = measure_step(work, choice, step, fine, err);
        if (!negligible)
            separate_noise(work, choice);
    }
    return code;
}

/* ---- choosing ---- */

/* Branch and bound over choices from `first` on: find the combination of lowest rate whose sums of distortion are
 * within bounds. best and *numbers change only if one has a lower rate than *numbers. */
static void search(Search *work, int first, const double sums[RETEX_COMPACT_TRIALS],
                   const double bounds[RETEX_COMPACT_TRIALS], double so_far, double *numbers, int best[CHOICES_MAX])
{
    if (so_far >= *numbers)
        return;
    if (first == work->count) {
        *numbers = so_far;
        for (int i = 0; i < work->count; i++)
            best[i] = work->choices[i].step;
        return;
    }
    Choice *choice = &work->choices[first];
    for (int step = choice->steps - 1; step >= 0; step--) {
        double with[RETEX_COMPACT_TRIALS];
        int within = 1;
        for (int t = 0; t < RETEX_COMPACT_TRIALS; t++) {
            with[t] = sums[t] + choice->squares[step][t];
            within &= with[t] <= bounds[t];
        }
        choice->step = step;
        if (within)
            search(work, first + 1, with, bounds, so_far + choice->numbers[step], numbers, best);
    }
}

/* Most distortion of a trial: that of the finest scales, plus what choices may add. */
static double bound_of(const Search *work, int trial)
{
    return work->finest[trial] + fmax(work->bound, EXCESS_SHARE * work->light->noise * work->finest[trial]);
}

/* Search with bounds scaled by factors. Returns 1 if the combination differs from the last one. *numbers: in, the upper
 * limit of the rate; out, the rate. */
static int search_within(Search *work, const double factors[RETEX_COMPACT_TRIALS], double *numbers)
{
    double bounds[RETEX_COMPACT_TRIALS];
    int best[CHOICES_MAX], others = 0;
    for (int i = 0; i < work->count; i++)
        best[i] = work->choices[i].measured_step;
    for (int t = 0; t < RETEX_COMPACT_TRIALS; t++)
        bounds[t] = fmax(factors[t] * bound_of(work, t), work->finest[t]);
    search(work, 0, work->finest, bounds, 0, numbers, best);
    for (int i = 0; i < work->count; i++) {
        Choice *choice = &work->choices[i];
        others |= best[i] != choice->measured_step;
        choice->step = choice->measured_step = best[i];
    }
    return others;
}

/* Measure the combination: *within = 1 if its distortion is within bounds. factors: for each trial, predicted over
 * measured distortion. The measured distortion is taken to be at least that of the worst choice alone. */
static int measure_all(Search *work, RetexCompactScales *scales, double factors[RETEX_COMPACT_TRIALS], int *within,
                       RetexError *err)
{
    double lost[RETEX_COMPACT_TRIALS];
    for (int i = 0; i < work->count; i++)
        apply(scales, &work->choices[i], work->choices[i].step);
    int code = measure_scales(work, scales, lost, err);
    *within = 1;
    for (int t = 0; t < RETEX_COMPACT_TRIALS && !code; t++) {
        double sum = work->finest[t], most = work->finest[t];
        for (int i = 0; i < work->count; i++) {
            const Choice *choice = &work->choices[i];
            lost[t] -= noise_removed(work, choice->step) * choice->noise[t];
            most = fmax(most, choice->squares[choice->step][t]);
            sum += choice->squares[choice->step][t];
        }
        lost[t] = fmax(lost[t], most);
        *within &= lost[t] <= bound_of(work, t);
        factors[t] = lost[t] > 0 ? fmin(sum / lost[t], BOUND_GROWTH_MAX) : 1;
    }
    return code;
}

static int search_measured(Search *work, RetexCompactScales *scales, RetexError *err)
{
    RetexCompactScales good = *scales; /* all choices at their finest step */
    double factors[RETEX_COMPACT_TRIALS], fewest = INFINITY;
    int code = RETEX_OK;
    for (int i = 0; i < work->count; i++)
        work->choices[i].measured_step = -1;
    for (int t = 0; t < RETEX_COMPACT_TRIALS; t++)
        factors[t] = 1;
    for (int tried = 0; tried < MEASURED_MAX && !code; tried++) {
        double numbers = fewest;
        int within;
        if (!search_within(work, factors, &numbers))
            break;
        code = measure_all(work, scales, factors, &within, err);
        if (!code && within)
            good = *scales, fewest = numbers;
    }
    *scales = good;
    return code;
}

static void search_close(Search *work)
{
    for (int i = 0; i < 2 * RETEX_COMPACT_KINDS; i++)
        free_pictures(&work->trials[i / 2][i % 2]);
    for (int t = 0; t < RETEX_COMPACT_TRIALS; t++)
        retex_image_free(&work->rest[t]);
    if (work->cache)
        retex_compact_cache_free(work->cache, work->light);
    free(work->cache);
    retex_compact_reference_close(&work->reference);
}

int retex_compact_search(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactParams *params,
                         int nthreads, RetexError *err)
{
    Search work = {.light = light, .nthreads = nthreads};
    RetexCompactLight small = {0};
    const char *unknown = NULL;
    *scales = (RetexCompactScales){0};
    list_choices(&work, scales, params);
    if (!work.count)
        return retex_compact_lamps_fixed(scales, light, params->gain ? params->gain : 1, err);
    int code = retex_compact_reference_open(&work.reference, light, nthreads, err);
    if (!code)
        code = retex_compact_light_open(&small, work.reference.set, params->noise, &unknown, err);
    work.light = &small;
    work.bound = fmax(pow(10, -params->psnr / 10), params->noise * NOISE_ALLOWED * work.reference.noise);
    work.cache = calloc(1, sizeof *work.cache);
    if (!code && !work.cache)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for trials");
    if (!code)
        code = measure(&work, scales, err);
    if (!code)
        code = search_measured(&work, scales, err);
    if (!code)
        code = retex_compact_lamps_choose(scales, &work.reference, &small,
                                          pow(10, -(params->lamps > 0 ? params->lamps : params->psnr - LAMP_LOSS) / 10),
                                          nthreads, err);
    search_close(&work);
    retex_compact_light_close(&small);
    return code;
}
