/* Denoising a set; see <retex/denoise.h>. */
#include <retex/denoise.h>

#include <string.h>

#include "signals.h"

static int is_denoise_data(const char *name)
{
    return !strncmp(name, "noise_", 6) || !strncmp(name, "guide_", 6);
}

int retex_denoise_has_data(const RetexSet *set)
{
    Signals signals;
    if (signals_open(&signals, set, NULL))
        return 0;
    signals_close(&signals);
    return 1;
}

void retex_denoise_drop_data(RetexSet *set)
{
    for (int k = set->nparts - 1; k > 0; k--)
        if (is_denoise_data(set->parts[k].name))
            retex_set_remove_part(set, k);
}

int retex_denoise(RetexSet *set, const RetexDenoiseParams *params, const RetexRoi *roi, int nthreads, RetexError *err)
{
    Signals signals;
    int code = signals_open(&signals, set, err);
    (void)params, (void)roi, (void)nthreads;
    if (code)
        return code;
    signals_close(&signals);
    retex_denoise_drop_data(set);
    set->denoised = 1;
    return RETEX_OK;
}
