/* What a pixel gathers while its paths are traced: filled in footprints.c and clusters.c, stored by
 * store.c. */
#ifndef RENDERER_FILM_FOOTPRINTS_PIXEL_H
#define RENDERER_FILM_FOOTPRINTS_PIXEL_H

#include <retex/uv_stats.h>
#include "base/color4.h"
#include "film/footprints/images.h"

/* Colours are red, green, blue and nothing. */
typedef Float4 Coefficients[PLAN_COEFFICIENTS_MAX];

/* Original albedo of a footprint, weighted by the light it multiplies. */
typedef struct AlbedoSums {
    Float4 light, reflected;
} AlbedoSums;

typedef struct Cluster {
    RetexUvStats uv;
    double varies;  /* retex_uv_stats_variation */
    double squares; /* of the paths' weights */
    AlbedoSums albedo;
    Float4 c;     /* light that meets the target here, and no other after it */
    Float4 again; /* that which does */
} Cluster;

/* Light as a polynomial in the textures of further hits, by the coefficients of the plan; and what those but the first
 * come to, with each further hit's original albedo and with 1/2. */
typedef struct HitLight {
    Coefficients c; /* [0], and those in use; the others are not set */
    Float4 original, half;
    unsigned used; /* bits, of those after the first */
} HitLight;

/* A place of one path, and the light that met it before other hits. */
typedef struct Pending {
    int target, sharp;
    double uv[2];
    double weight;
    Float4 albedo; /* the original's, there */
    const HitLight *light;
} Pending;

/* The same after other hits. */
typedef struct PendingLater {
    int target;
    double uv[2], weight;
    Float4 light, albedo; /* that reaches it, with the original albedo of the path's other hits; its own */
} PendingLater;

/* Clusters of one kind, and the light of all of them that meets targets again: [0] stays empty. */
typedef struct Clusters {
    int count;
    unsigned used; /* bits: coefficients of `again` that are not 0 */
    double apart;  /* no two of them merge for less; -inf: not known */
    Cluster of[FILM_CLUSTERS_MAX];
    Coefficients again;
} Clusters;

/* Further hits of a target. */
typedef struct Later {
    RetexUvStats uv;     /* weight 0: none */
    double varies;  /* retex_uv_stats_variation */
    double squares; /* of the paths' weights */
    AlbedoSums albedo;
} Later;

/* The clusters of one pixel on one target. */
typedef struct TargetClusters {
    Clusters sharp, broad;
    Later later[LATER_COUNT];
    double later_apart; /* as of clusters */
} TargetClusters;

/* Of a path: its light by first hit, of some weight, and its further hits. */
void clusters_add(TargetClusters *target, const Pending *pending, const FilmParams *params);
void clusters_add_later(TargetClusters *target, const PendingLater *pending, const int periodic[2]);

/* A hit of the path in hand; see path_hits.h. */
typedef struct Node {
    HitLight dependent,
        independent; /* that came by it, from further hits too: what its texture multiplies, and the rest */
    Float4 white;    /* all of that, were the targets of white paint */
    Float4 albedo;   /* of the original, as it weighs other hits */
    /* What the hits before it do to light that comes from it: none of their textures; all, with the original albedos;
     * all, with 1/2. */
    Float4 none, original, half;
} Node;

typedef struct FootprintPixel {
    FootprintFilm *film;
    int spp; /* of the pixel, when it is finished */
    double free[3];
    TargetClusters *targets;
    Node nodes[PATH_HITS_MAX];
    LightSums *light; /* of what arrives */
    UvRange *range;   /* of what was met */
} FootprintPixel;

#endif
