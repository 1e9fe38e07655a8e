/* What a set says of the picture as a whole, kept band by band while it is rendered: sums are then the same to the bit
 * however bands were spread over threads, or renders. */
#ifndef RETEX_BAND_STATS_H
#define RETEX_BAND_STATS_H

#include <retex/set.h>

#ifdef __cplusplus
extern "C" {
#endif

struct RetexBandStats {
    /* Luminance, summed: all light, and that whose surplus hits had to take their original albedo; as it is, and as it
     * would be with white targets. */
    double total, folded, total_white, folded_white;
    double uv_low[RETEX_MAX_TARGETS][2], uv_high[RETEX_MAX_TARGETS][2]; /* by target; inf, -inf: not met */
    double albedo[RETEX_MAX_TARGETS][3], coverage[RETEX_MAX_TARGETS];   /* originals times coverage, coverage */
    long dropped; /* samples that were not finite */
    long samples; /* of all pixels */
};

void retex_band_stats_reset(RetexBandStats *stats); /* of nothing */

/* Fill spp (the mean, for the set's size), folded, folded_white, and uv_min, uv_max and mean_albedo of the targets from
 * all bands, from the top. */
void retex_band_stats_finish(RetexSet *set, const RetexBandStats *bands, int nbands);

#ifdef __cplusplus
}
#endif
#endif
