/* See <retex/host/band_stats.h>. */
#include <math.h>

#include <retex/host/band_stats.h>

#include "set/set.h"

void retex_band_stats_reset(RetexBandStats *stats)
{
    *stats = (RetexBandStats){.total = 0};
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++)
            stats->uv_low[t][k] = INFINITY, stats->uv_high[t][k] = -INFINITY;
}

static void finish_target(RetexTarget *target, int t, const RetexBandStats *bands, int nbands)
{
    double albedo[3] = {0, 0, 0}, coverage = 0, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};

    for (int b = 0; b < nbands; b++) {
        coverage += bands[b].coverage[t];
        for (int c = 0; c < 3; c++)
            albedo[c] += bands[b].albedo[t][c];
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], bands[b].uv_low[t][k]);
            high[k] = fmax(high[k], bands[b].uv_high[t][k]);
        }
    }
    for (int c = 0; c < 3; c++)
        target->mean_albedo[c] = coverage > 0 ? (float)(albedo[c] / coverage) : 0;
    for (int k = 0; k < 2; k++) {
        const int is_seen = high[k] >= low[k];
        target->uv_min[k] = is_seen ? low[k] : 0;
        target->uv_max[k] = is_seen ? high[k] : 1;
    }
}

void retex_band_stats_finish(RetexSet *set, const RetexBandStats *bands, int nbands)
{
    double total = 0, folded = 0, total_white = 0, folded_white = 0, cut = 0, samples = 0;

    for (int b = 0; b < nbands; b++) {
        samples += (double)bands[b].samples;
        total += bands[b].total, folded += bands[b].folded;
        total_white += bands[b].total_white, folded_white += bands[b].folded_white;
        cut += bands[b].cut;
    }
    if (samples > 0)
        set->spp = (int)(samples / ((double)set->width * set->height) + 0.5);
    set->folded = total > 0 ? folded / total : 0;
    set->depth_cut = total + cut > 0 ? cut / (total + cut) : 0;
    set->folded_white = total_white > 0 ? folded_white / total_white : 0;
    for (int t = 0; t < set->ntargets; t++)
        finish_target(&set->targets[t], t, bands, nbands);
}
