/* See noise.h. */
#include <stdio.h>
#include "film/noise.h"

int noise_count(const FilmParams *params, int ntargets)
{
    if (!params->noise || params->spp < 2)
        return 0;
    return !params->split ? 1 : 1 + ntargets * (params->paper ? 1 : 2);
}

int noise_create(NoiseImages *images, const FilmParams *params, int ntargets, RetexError *err)
{
    int code = RETEX_OK;
    images->count = noise_count(params, ntargets);
    images->paper = params->paper;
    images->spp = params->spp;
    for (int k = 0; k < images->count && !code; k++)
        code = retex_image_alloc(&images->of[k], params->width, params->height, 3, err);
    return code;
}

void noise_close(NoiseImages *images)
{
    for (int k = 0; k < images->count; k++)
        retex_image_free(&images->of[k]);
}

void noise_store(NoiseImages *images, const SignalTotals *half, const SignalTotals *all, int x, int y)
{
    int first = images->spp / 2, rest = images->spp - first;
    for (int k = 0; k < images->count; k++) {
        const double *h = half->of[k], *a = all->of[k];
        if (a[0] == 0 && a[1] == 0 && a[2] == 0)
            continue; /* memory that is never touched is never taken */
        float *pixel = images->of[k].pixels + retex_image_index(&images->of[k], x, y);
        for (int c = 0; c < 3; c++)
            pixel[c] = (float)((h[c] / first - (a[c] - h[c]) / rest) / 2);
    }
}

/* The signal that a term belongs to, by its first factor. */
static int signal_of(const RetexSet *set, const RetexTerm *term, int paper)
{
    if (!term->nfactors)
        return 0;
    int factor = term->factors[0];
    const RetexFootprint *f =
        &set->footprints[factor < 0 ? set->mixtures[RETEX_MIXTURE(factor)].shares[0].footprint : factor];
    return paper ? 1 + f->target : 1 + 2 * f->target + (f->kind == RETEX_FOOTPRINT_BROAD);
}

static void signal_name(const RetexSet *set, int signal, int paper, char name[RETEX_NAME_MAX])
{
    static const char *const kinds[] = {"sharp", "broad"};
    if (signal == 0)
        snprintf(name, RETEX_NAME_MAX, "noise_%s", set->nterms ? "indep" : "beauty");
    else if (paper)
        snprintf(name, RETEX_NAME_MAX, "noise_%.90s_hit", set->targets[signal - 1].name);
    else
        snprintf(name, RETEX_NAME_MAX, "noise_%.90s_%s", set->targets[(signal - 1) / 2].name, kinds[(signal - 1) % 2]);
}

int noise_finish(NoiseImages *images, RetexSet *set, RetexError *err)
{
    int wanted[NOISE_SIGNALS_MAX] = {!set->nterms}, code = RETEX_OK;
    char name[RETEX_NAME_MAX];
    for (int t = 0; t < set->nterms && images->count; t++)
        wanted[signal_of(set, &set->terms[t], images->paper)] = 1;
    for (int k = 0; k < images->count && !code; k++) {
        if (!wanted[k])
            continue;
        signal_name(set, k, images->paper, name);
        code = film_move_part(set, name, "RGB", RETEX_HALF, &images->of[k], NULL, err);
    }
    return code;
}
