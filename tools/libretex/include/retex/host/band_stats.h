/* Statistics of the whole picture, kept band by band while it is rendered, so that the sums are the same to the bit
 * however bands are distributed over threads, or renders. */
#ifndef RETEX_HOST_BAND_STATS_H
#define RETEX_HOST_BAND_STATS_H

#include <retex/host/band_store.h>
#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

struct RetexBandStats {
    /* Sums of luminance: of all light, and of the light whose hits beyond the set's orders kept their original albedo;
     * as rendered, and as with white targets. */
    double total, folded, total_white, folded_white;
    double cut; /* the same of the light that the maximum depth left out */
    double uv_low[RETEX_MAX_TARGETS][2], uv_high[RETEX_MAX_TARGETS][2]; /* by target; inf, -inf: the target was not
                                                                           met */
    double albedo[RETEX_MAX_TARGETS][3], coverage[RETEX_MAX_TARGETS];   /* sum of original albedo times coverage, sum
                                                                           of coverage */
    long dropped; /* samples that were not finite */
    long samples; /* of all pixels */
};

void retex_band_stats_reset(RetexBandStats *stats); /* to those of an empty band */

/* Fill spp (the mean, for the set's size), folded, folded_white, depth_cut, and uv_min, uv_max and mean_albedo of the
 * targets from all bands, from the top. */
void retex_band_stats_finish(RetexSet *set, const RetexBandStats *bands, int nbands);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
