/* A set as the library sees it. Private to libretex: <retex/set.h> has what others see. */
#ifndef RETEX_SET_SET_H
#define RETEX_SET_SET_H

#include <retex/host/band_store.h>
#include <retex/set.h>

typedef struct RetexSetSource RetexSetSource; /* an open file, see set/source.h */

/* RetexSetInfo says what its members mean. */
struct RetexSet {
    int width, height;
    char layout[16], filter[16], scene[RETEX_SCENE_MAX], generator[64];
    int orders, spp, max_depth;
    uint32_t seed, id;
    double folded, folded_white;
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
    RetexBandStore *store;  /* owned; where parts with a store_image are, or NULL */
    RetexSetSource *source; /* owned; where all other parts without pixels are, or NULL: see retex_set_open */
};

#endif
