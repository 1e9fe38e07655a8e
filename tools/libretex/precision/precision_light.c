/* See precision_light.h. */
#include "precision/precision_light.h"

#include <math.h>

#include <retex/host/rounding.h>

#include "set/strip.h"
#include "precision/precision_rules.h"
#include "set/set.h"

/* The step of a signal's sum, as a share of what it is a part of. */
static const double SUM_STEP = 1.0 / 128;
/* Albedo that further hits count with where errors go to terms of fewer factors. Errors show most with bright
 * textures. */
static const double CARRIED = 0.8;
/* Corrections of two and more factors have steps that are larger by this: their errors go to those of one factor. */
static const double FURTHER_CORRECTION = 8;
static const double LARGEST = 65504; /* that a half holds */
/* With finishes to choose from a picture is never of all light, which is the mean over all choices: its terms with
 * further hits only guide denoising and compact sets, and have steps that are larger by this. */
static const double MEAN_FURTHER = 8;

double retex_mean_size(const float color[3])
{
    return ((double)fabsf(color[0]) + (double)fabsf(color[1]) + (double)fabsf(color[2])) / 3;
}

static float *radiance_of(const RetexPixelLight *p, int term)
{
    return retex_pixel_at(p->rows, p->rows->terms[term].radiance, p->at);
}

static double largest_channel(const double sum[3])
{
    return (double)(float)fmax(sum[0], fmax(sum[1], sum[2]));
}

static double white_pixel(const RetexPixelLight *p)
{
    double sum[3] = {0, 0, 0};
    for (int t = 0; t < p->nlit; t++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)radiance_of(p, p->lit[t])[c];
    return largest_channel(sum);
}

/* What a signal's light is part of. */
static double white_of(const RetexPixelLight *p, const RetexSignal *signal)
{
    return signal->lamp < 0 ? p->white : p->whites[p->rows->width * signal->lamp];
}

/* ---- light ---- */

/* The unit for a signal's light; 0: it stays as it is. */
static double light_unit(const RetexPixelLight *p, int signal)
{
    const double noise = p->noise[signal], white = white_of(p, &p->signals->of[signal]);
    if (p->has_noise ? !(noise > 0) : p->signals->of[signal].target < 0)
        return 0;
    const RetexPrecisionKind kind = p->has_finishes ? RETEX_PRECISION_CHOICE_LIGHT : RETEX_PRECISION_LIGHT;
    return retex_round_unit(white > 0 ? retex_precision_step(kind, white, noise / white) : 0);
}

/* The unit for the number that closes the sum of a signal. */
static double closing_unit(const RetexPixelLight *p, const RetexSignal *signal, const float light[3], double unit)
{
    const double own = (double)fmaxf(fabsf(light[0]), fmaxf(fabsf(light[1]), fabsf(light[2])));
    const double white = white_of(p, signal), step = SUM_STEP * (signal->target < 0 ? own : white);
    const double finest = retex_precision_step(RETEX_PRECISION_LIGHT, white, 0);
    return fmin(unit, retex_round_unit(fmax(step, finest)));
}

/* Of light that no picture shows: its errors are not carried to the clusters' own light, whose ratios are weights of
 * light that pictures do show. */
static int is_unseen(const RetexPixelLight *p, const RetexSignal *signal, const RetexSignalMember *member)
{
    return p->has_finishes && signal->lamp < 0 && member->hits > 1;
}

/* The brightest member of a signal that pictures show; -1: it has no light. */
static int brightest(const RetexPixelLight *p, const RetexSignal *signal)
{
    int member = -1;
    double most = 0;
    for (int m = 0; m < signal->nmembers; m++) {
        const RetexSignalMember *one = &signal->members[m];
        const double light = (double)one->weight * retex_mean_size(retex_pixel_at(p->rows, one->part, p->at));
        if (light > most && !is_unseen(p, signal, one))
            most = light, member = m;
    }
    return member;
}

/* carried: errors of the numbers before, as light of one factor. */
static void round_member(const RetexPixelLight *p, const RetexSignalMember *member, double unit, double carried[3])
{
    float *light = retex_pixel_at(p->rows, member->part, p->at);
    double weight = 1;
    for (int n = member->hits; n > 1; n--)
        weight *= CARRIED;
    for (int c = 0; c < 3; c++) {
        if (light[c] == 0)
            continue;
        const double wanted = (double)light[c] + carried[c] / weight;
        const double kept = (wanted < 0) == (light[c] < 0) ? retex_round_by(wanted, unit) : 0;
        carried[c] += ((double)light[c] - kept) * weight;
        light[c] = (float)kept + 0.0f;
    }
}

static void round_unseen(const RetexPixelLight *p, const RetexSignal *signal, double unit)
{
    double carried[3] = {0, 0, 0};
    for (int m = 0; m < signal->nmembers; m++)
        if (is_unseen(p, signal, &signal->members[m]))
            round_member(p, &signal->members[m], unit, carried);
}

/* Corrections, which are members too, have a weight of 0. */
static void round_signal(const RetexPixelLight *p, int number)
{
    const RetexSignal *signal = &p->signals->of[number];
    const double unit = light_unit(p, number);
    const int closing = brightest(p, signal);
    double carried[3] = {0, 0, 0};
    if (unit > 0)
        round_unseen(p, signal, MEAN_FURTHER * unit);
    if (!(unit > 0) || closing < 0)
        return;
    for (int m = 0; m < signal->nmembers; m++)
        if (m != closing && signal->members[m].weight > 0 && !is_unseen(p, signal, &signal->members[m]))
            round_member(p, &signal->members[m], unit, carried);
    const RetexSignalMember *last = &signal->members[closing];
    round_member(p, last, closing_unit(p, signal, retex_pixel_at(p->rows, last->part, p->at), unit), carried);
}

/* ---- corrections ---- */

/* The correction that takes the errors of all with as many factors: the largest one that counts in the pixel. */
static int largest_correction(const RetexPixelLight *p, const int *terms, int count)
{
    int largest = -1;
    double most = -1;
    for (int k = 0; k < count; k++) {
        const double size = retex_mean_size(radiance_of(p, terms[k]));
        if (size > most && retex_edited_is_seen(p->rows, &p->rows->terms[terms[k]], p->at))
            most = size, largest = k;
    }
    return largest;
}

/* Round a correction, which takes `lost` if it closes its sum. What it loses is added there. */
static void round_correction(float value[3], int closes, double unit, double lost[3])
{
    for (int c = 0; c < 3; c++) {
        const double wanted = (double)value[c] + (closes ? lost[c] : 0);
        const double kept = fmin(fmax(retex_round_by(wanted, unit), -LARGEST), LARGEST);
        lost[c] = wanted - kept + (closes ? 0 : lost[c]);
        value[c] = (float)kept + 0.0f;
    }
}

/* The corrections of a target with so many factors. lost: what they take as well; afterwards what they did not. */
static void round_corrections(const RetexPixelLight *p, int target, int factors, double unit, double lost[3])
{
    const int *terms, count = retex_edited_terms(p->edited, target, factors, &terms);
    const int closing = largest_correction(p, terms, count);
    for (int k = 0; k < count; k++)
        if (k != closing)
            round_correction(radiance_of(p, terms[k]), 0, unit, lost);
    if (closing >= 0)
        round_correction(radiance_of(p, terms[closing]), 1, unit, lost);
}

static void correct(const RetexPixelLight *p, int target)
{
    const double noise = p->noise[p->signals->count];
    const double unit = retex_round_unit(retex_precision_step(RETEX_PRECISION_CORRECTION, p->white, noise / p->white));
    RetexEditedLight after;
    double lost[3] = {0, 0, 0};
    retex_edited_light(p->edited, p->rows, target, p->at, p->lit, p->nlit, after); /* what is black stays so */
    for (int n = retex_edited_powers(p->edited, target); n >= 0; n--) {
        for (int c = 0; c < 3; c++)
            lost[c] = (n > 0 ? CARRIED : 0) * lost[c] + p->before[target][n][c] - after[n][c];
        round_corrections(p, target, n, n > 1 ? FURTHER_CORRECTION * unit : unit, lost);
    }
}

/* ---- a pixel ---- */

void retex_pixel_light_keep(RetexPixelLight *p)
{
    p->nlit = retex_edited_find_lit(p->edited, p->rows, p->at, p->lit);
    p->white = white_pixel(p);
    for (int t = 0; t < p->rows->ntargets; t++)
        retex_edited_light(p->edited, p->rows, t, p->at, p->lit, p->nlit, p->before[t]);
}

void retex_pixel_light_round(RetexPixelLight *p)
{
    for (int k = 0; k < p->signals->count; k++)
        round_signal(p, k);
    for (int t = 0; t < p->rows->ntargets && p->white > 0; t++)
        correct(p, t);
}
