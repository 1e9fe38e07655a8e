/* What a pixel gathers while its paths are traced: filled in footprints.c and footprint_clusters.c, stored by
 * footprint_store.c. */
#ifndef RENDERER_FILM_FOOTPRINT_PIXEL_H
#define RENDERER_FILM_FOOTPRINT_PIXEL_H

#include <retex/uv_stats.h>
#include "film/footprint_images.h"

#define PENDING_MAX 64

typedef float Coefficients[PLAN_COEFFICIENTS_MAX][3];

/* Original albedo of a footprint, weighted by the light it multiplies. */
typedef struct AlbedoSums {
    float light[3], reflected[3];
} AlbedoSums;

typedef struct Cluster {
    UvStats uv;
    AlbedoSums albedo;
    double squares; /* of the paths' weights */
    float c[3];     /* light that meets the target here, and no other after it */
    float again;    /* luminance of that which does */
} Cluster;

/* One path's light by the hit that comes first. */
typedef struct Pending {
    int target;
    int sharp;
    Vec2 position;
    Rgb albedo;    /* the original's, there */
    Rgb again;     /* light that meets targets again, with their original albedo */
    double weight; /* of the place, when the path has ended */
    unsigned used; /* bits: coefficients that are not 0; the others are not set */
    Coefficients c;
} Pending;

/* One path's light by a further hit. */
typedef struct PendingLater {
    int target;
    double uv[2], weight;
    Rgb light, albedo; /* that reaches it, with the original albedo of the path's other hits; its own */
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
    UvStats uv;     /* weight 0: none */
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

struct FootprintPixel {
    FootprintFilm *film;
    int spp; /* of the pixel, when it is finished */
    double free[3];
    TargetClusters *targets;
    Pending pending[PENDING_MAX];
    int npending;
    PendingLater later[PENDING_MAX];
    int nlater;
    /* The last entry for a path's hit of each order, counted from 1; 0: none. */
    unsigned char pending_of[RETEX_MAX_FACTORS], later_of[RETEX_MAX_FACTORS];
    LightSums *light; /* of what arrives */
    UvRange *range;   /* of what was met */
};

#endif
