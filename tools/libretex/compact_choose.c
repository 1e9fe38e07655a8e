/* See compact_choose.h. What a choice costs is measured for one thing at a time, all others being as fine as they can;
 * squares of differences add up well enough. From the coarsest of all, whatever gains most for the numbers it adds
 * is made finer until the sum is within bounds, and so is the set with all choices made.
 *
 * Footprints are noisy, those of denoised sets too, and smaller images average that away: a difference from the set
 * that is no loss. Of n, the square of what noise does, a scale of s takes away 1 - 1 / s^2, and hardly more where s is
 * large; what is lost of edges and shades at least doubles from each scale to the next. So the first two tell noise
 * from loss. */
#include "compact_choose.h"

#include <math.h>
#include <string.h>

#include "compact_meter.h"

#define STEPS 4              /* of scales: 1, 2, 4, 8 */
#define NOISE_COUNTS 0.025   /* of a set's own noise, what may be added: 0.1 dB */
#define NOISE_COUNTS_NOT 0.9 /* share of what is taken for noise that is no loss; all else counts */
#define GROUPS_MOST 64
#define KINDS_APART 6 /* more kinds than these, of three or more targets, are chosen for together */

/* One choice: the scale of some kinds' footprints or gains, or whether light that goes on has weights of its own; of
 * sharp ones it always has, for textures show every letter there. */
typedef enum What { CLUSTERS, GAINS, SPLIT } What;

typedef struct Choice {
    What what;
    int kinds[COMPACT_KINDS], nkinds;
    int steps, at;                         /* 0: as fine as can be, to steps - 1 */
    double squares[STEPS][COMPACT_TRIALS]; /* lost */
    double noise[COMPACT_TRIALS];          /* what an infinite scale would take away of it */
    double numbers[STEPS];                 /* stored for each pixel */
} Choice;

typedef struct Choosing {
    const CompactLight *light; /* of the meter's set */
    CompactMeter meter;
    Choice choices[GROUPS_MOST];
    int count, nthreads;
    double least[COMPACT_TRIALS]; /* lost when all is as fine as can be */
} Choosing;

/* ---- choices ---- */

static void apply(CompactScales *scales, const Choice *choice, int step)
{
    for (int i = 0; i < choice->nkinds; i++) {
        const int kind = choice->kinds[i];
        if (choice->what == CLUSTERS)
            scales->clusters[kind] = 1 << step;
        else if (choice->what == GAINS)
            scales->gains[kind] = 1 << step;
        else
            scales->split[kind] = !step;
    }
}

static double numbers_of(const Choosing *work, const Choice *choice, int step)
{
    double numbers = 0;
    for (int i = 0; i < choice->nkinds; i++) {
        const CompactKind *kind = &work->light->kinds[choice->kinds[i]];
        if (choice->what == CLUSTERS)
            numbers += (3 + 7.0 * kind->count) / (1 << (2 * step));
        else if (choice->what == GAINS)
            numbers += 3.0 * (kind->nagain + 1) / (1 << (2 * step));
        else if (!step)
            numbers += kind->count / 16.0; /* of a usual size */
    }
    return numbers;
}

static Choice *find_choice(Choosing *work, What what, const CompactKind *kind)
{
    for (int i = 0; i < work->count; i++) {
        const CompactKind *first = &work->light->kinds[work->choices[i].kinds[0]];
        const int together = kind->kind == RETEX_FOOTPRINT_LATER || work->light->nkinds > KINDS_APART;
        if (work->choices[i].what == what && first->kind == kind->kind && together)
            return &work->choices[i];
    }
    Choice *choice = &work->choices[work->count++];
    *choice = (Choice){.what = what, .steps = what == SPLIT ? 2 : STEPS};
    return choice;
}

static void add_choice(Choosing *work, What what, int kind)
{
    Choice *choice = find_choice(work, what, &work->light->kinds[kind]);
    choice->kinds[choice->nkinds++] = kind;
}

/* Fixed ones are put into scales. */
static void list_choices(Choosing *work, CompactScales *scales, const RetexCompactParams *params)
{
    for (int i = 0; i < work->light->nkinds; i++) {
        const CompactKind *kind = &work->light->kinds[i];
        const int sharp = kind->kind == RETEX_FOOTPRINT_SHARP, later = kind->kind == RETEX_FOOTPRINT_LATER;
        const int wanted = sharp ? 1 : later ? params->later : params->broad;
        scales->clusters[i] = wanted ? wanted : 1;
        scales->gains[i] = params->gain ? params->gain : 1;
        scales->split[i] = 1;
        if (!wanted)
            add_choice(work, CLUSTERS, i);
        if (kind->nagain && !params->gain)
            add_choice(work, GAINS, i);
        if (kind->nagain && kind->count > 1 && !sharp)
            add_choice(work, SPLIT, i);
    }
}

/* ---- trials ---- */

static int try_scales(const Choosing *work, const CompactScales *scales, double squares[COMPACT_TRIALS],
                      RetexError *err)
{
    RetexSet *compact;
    int code = compact_build(&compact, work->light, scales, work->nthreads, err);
    if (!code)
        code = compact_meter_read(&work->meter, compact, squares, work->nthreads, err);
    retex_set_close(&compact);
    return code;
}

static double noise_gone(int step)
{
    return NOISE_COUNTS_NOT * (1 - 1.0 / (1 << (2 * step)));
}

/* The rest is loss. */
static void tell_noise(Choice *choice)
{
    for (int t = 0; t < COMPACT_TRIALS && choice->what != SPLIT; t++) {
        const double *first = choice->squares[1], *second = choice->squares[2];
        const double noise = (2 * first[t] - second[t]) / (2 * (1 - 1.0 / 4) - (1 - 1.0 / 16));
        choice->noise[t] = fmax(noise, 0);
        for (int step = 1; step < choice->steps; step++)
            choice->squares[step][t] = fmax(choice->squares[step][t] - noise_gone(step) * choice->noise[t], 0);
    }
}

/* What each step of each choice loses beyond the least. */
static int measure(Choosing *work, const CompactScales *fine, RetexError *err)
{
    int code = try_scales(work, fine, work->least, err);
    for (int i = 0; i < work->count; i++) {
        Choice *choice = &work->choices[i];
        for (int step = 0; step < choice->steps && !code; step++) {
            CompactScales scales = *fine;
            choice->numbers[step] = numbers_of(work, choice, step);
            if (!step)
                continue;
            apply(&scales, choice, step);
            code = try_scales(work, &scales, choice->squares[step], err);
            for (int t = 0; t < COMPACT_TRIALS; t++)
                choice->squares[step][t] = fmax(choice->squares[step][t] - work->least[t], 0);
        }
        tell_noise(choice);
        choice->at = choice->steps - 1;
    }
    return code;
}

/* The trial that loses most, all choices as they are. */
static int worst_trial(const Choosing *work, double *squares)
{
    int worst = 0;
    for (int t = 0; t < COMPACT_TRIALS; t++) {
        double sum = work->least[t];
        for (int i = 0; i < work->count; i++)
            sum += work->choices[i].squares[work->choices[i].at][t];
        if (!t || sum > *squares)
            *squares = sum, worst = t;
    }
    return worst;
}

/* One choice finer: where that gains most for a trial. 0: there is none. */
static int refine(Choosing *work, int trial)
{
    Choice *best = NULL;
    double most = -1;
    for (int i = 0; i < work->count; i++) {
        Choice *choice = &work->choices[i];
        for (int to = choice->at - 1; to >= 0; to--) { /* over a step that gains little */
            const double gained = choice->squares[choice->at][trial] - choice->squares[to][trial];
            const double rate = gained / (choice->numbers[to] - choice->numbers[choice->at] + 1e-9);
            if (rate > most)
                most = rate, best = choice;
        }
    }
    if (best)
        best->at--;
    return best != NULL;
}

static void apply_all(const Choosing *work, CompactScales *scales)
{
    for (int i = 0; i < work->count; i++)
        apply(scales, &work->choices[i], work->choices[i].at);
}

/* By what was measured of each; then, where they do not add up so, by all of them together. */
static int settle(Choosing *work, CompactScales *scales, double bound, RetexError *err)
{
    double squares;
    for (int trial = worst_trial(work, &squares); squares > bound && refine(work, trial);)
        trial = worst_trial(work, &squares);
    for (;;) {
        double lost[COMPACT_TRIALS];
        int worst = 0;
        apply_all(work, scales);
        int code = try_scales(work, scales, lost, err);
        if (code)
            return code;
        for (int t = 0; t < COMPACT_TRIALS; t++) {
            for (int i = 0; i < work->count; i++)
                lost[t] -= noise_gone(work->choices[i].at) * work->choices[i].noise[t];
            worst = lost[t] > lost[worst] ? t : worst;
        }
        if (lost[worst] <= bound || !refine(work, worst))
            return RETEX_OK;
    }
}

int compact_choose(CompactScales *scales, const CompactLight *light, const RetexCompactParams *params, int nthreads,
                   RetexError *err)
{
    Choosing work = {.light = light, .nthreads = nthreads};
    CompactLight small;
    int understood;
    *scales = (CompactScales){0};
    list_choices(&work, scales, params);
    if (!work.count)
        return RETEX_OK;
    int code = compact_meter_open(&work.meter, light->set, nthreads, err);
    if (code)
        return code;
    code = compact_light_open(&small, work.meter.set, &understood, err);
    work.light = &small;
    if (!code)
        code = measure(&work, scales, err);
    if (!code)
        code = settle(&work, scales, fmax(pow(10, -params->psnr / 10), NOISE_COUNTS * work.meter.noise), err);
    compact_light_close(&small);
    compact_meter_close(&work.meter);
    return code;
}
