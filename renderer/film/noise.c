/* See noise.h. */
#include <retex/host/denoise_data.h>
#include "film/noise.h"

int noise_count(const FilmParams *params, int ntargets)
{
    if (!params->noise || params->spp < 2)
        return 0;
    return !params->split ? 1 : (1 + ntargets * params->layout->nsignals) * (1 + params->nkept);
}

static void signal_name(const Scene *scene, const FilmParams *params, int number, char name[RETEX_NAME_MAX])
{
    const FilmLayout *layout = params->layout;
    const int own = params->split ? 1 + scene->ntargets * layout->nsignals : 1;
    const int lamp = number / own - 1, signal = number % own;
    if (lamp >= 0)
        retex_lamp_noise_part_name(name, scene->kept[lamp].name,
                                   signal ? scene->targets[(signal - 1) / layout->nsignals].name : NULL,
                                   signal ? layout->signals[(signal - 1) % layout->nsignals] : RETEX_SIGNAL_INDEP);
    else if (signal == 0)
        retex_noise_part_name(name, NULL, params->split ? RETEX_SIGNAL_INDEP : RETEX_SIGNAL_BEAUTY);
    else
        retex_noise_part_name(name, scene->targets[(signal - 1) / layout->nsignals].name,
                              layout->signals[(signal - 1) % layout->nsignals]);
}

int noise_create(NoiseImages *images, const FilmParams *params, const Scene *scene, Bands *bands, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    int code = RETEX_OK;
    images->count = noise_count(params, scene->ntargets);
    images->prunes = !params->split || params->layout->prunes;
    for (int k = 0; k < images->count && !code; k++) {
        signal_name(scene, params, k, name);
        code = bands_add(bands, name, "RGB", RETEX_HALF, &images->of[k], err);
    }
    return code;
}

void noise_store(const NoiseImages *images, BandRows *rows, const SignalTotals *half, const SignalTotals *all, int spp,
                 int x, int y)
{
    int first = spp / 2, rest = spp - first;
    for (int k = 0; k < images->count; k++) {
        const double *h = half->of[k], *a = all->of[k];
        if (a[0] == 0 && a[1] == 0 && a[2] == 0)
            continue; /* memory that is never touched is never taken */
        float *pixel = bands_pixel(rows, images->of[k], x, y);
        for (int c = 0; c < 3; c++)
            pixel[c] = (float)((h[c] / first - (a[c] - h[c]) / rest) / 2);
    }
}

int noise_finish(const NoiseImages *images, Bands *bands, RetexSet *set, RetexError *err)
{
    int wanted[NOISE_SIGNALS_MAX], code = RETEX_OK;
    for (int k = 0; k < images->count; k++)
        wanted[k] = images->prunes;
    const RetexTerm *term;
    for (int t = 0; !images->prunes && (term = retex_set_term(set, t)); t++)
        wanted[retex_term_hits(term) ? 1 + term->target : 0] = 1;
    for (int k = 0; k < images->count && !code; k++)
        if (wanted[k])
            code = bands_move_part(bands, images->of[k], set, NULL, err);
    return code;
}
