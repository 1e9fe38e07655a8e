/* A set as the library sees it. Private to libretex: <retex/set.h> has what others see. */
#ifndef RETEX_SET_SET_H
#define RETEX_SET_SET_H

#include <retex/set.h>

/* The file of a set, with the checksum of its manifest, which has those of all parts. */
typedef struct RetexSetReference {
    char path[4096]; /* absolute; "": none */
    uint64_t bytes;
    uint32_t crc;
} RetexSetReference;

enum { RETEX_SET_FOOTPRINTS_MAX = 512 }; /* of a set, in files */

/* RetexSetInfo says what its members mean. */
struct RetexSet {
    int width, height;
    char layout[16], filter[16], scene[RETEX_SCENE_MAX], generator[64];
    int orders, spp, max_depth;
    uint32_t seed, id;
    double folded, folded_white, unit, depth_cut, exposure;
    int further_hits;
    float further_ratio[3];
    int denoised, strict_paper;
    int ntargets;
    RetexTarget targets[RETEX_MAX_TARGETS];
    int nfootprints, nterms, nparts;
    RetexFootprint *footprints;
    RetexTerm *terms;
    RetexPart *parts;
    int nmixtures;
    RetexMixture mixtures[RETEX_MIXTURES_MAX];
    int nparameters;
    RetexParameter parameters[RETEX_PARAMETERS_MAX];
    int is_samples;
    RetexSetReference refers; /* the set that it names, see retex_set_refer */
    uint64_t file_bytes; /* of the file that the set was read from, and */
    uint32_t file_sum;   /* the checksum of its manifest; 0: of no file */
};

/* The channels of a footprint's part `spread`: 2, 3, or RETEX_AXES; 2 where it is none of these, or absent. */
int retex_set_spread_channels(const RetexSet *set, int part);
/* Where a footprint is in a pixel, of a set in memory: mean UV and coverage; standard deviations and their correlation,
 * of a parallelogram those of the ellipse with the same covariance. Its spread has two channels, three, or axes. */
void retex_footprint_ellipse(const RetexSet *set, const RetexFootprint *footprint, size_t pixel, float uv[3],
                             float spread[3]);
/* Whether a footprint is a parallelogram: its spread are axes. */
static inline int retex_footprint_has_axes(const RetexSet *set, const RetexFootprint *footprint)
{
    return retex_set_spread_channels(set, footprint->spread) == RETEX_AXES;
}

#endif
