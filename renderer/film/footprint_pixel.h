/* What a pixel gathers while its paths are traced: filled in footprints.c and footprint_clusters.c, stored by
 * footprint_store.c. */
#ifndef RENDERER_FILM_FOOTPRINT_PIXEL_H
#define RENDERER_FILM_FOOTPRINT_PIXEL_H

#include <retex/uv_stats.h>
#include "base/float4.h"
#include "film/footprint_images.h"

#define PATH_HITS_MAX 64

/* Colours are red, green, blue and nothing. */
typedef Float4 Coefficients[PLAN_COEFFICIENTS_MAX];

/* Original albedo of a footprint, weighted by the light it multiplies. */
typedef struct AlbedoSums {
    Float4 light, reflected;
} AlbedoSums;

typedef struct Cluster {
    UvStats uv;
    double squares; /* of the paths' weights */
    AlbedoSums albedo;
    Float4 c;     /* light that meets the target here, and no other after it */
    Float4 again; /* that which does */
} Cluster;

/* A hit of one path, and the light that met it before other hits. */
typedef struct Pending {
    int target;
    int sharp;
    Vec2 position;
    Float4 albedo; /* the original's, there */
    Float4 again;  /* light that meets targets again, with their original albedo */
    double weight; /* of the place, when the path has ended */
    unsigned used; /* bits: coefficients that are not 0; the others are not set */
    Coefficients c;
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

/* A hit of the path in hand. What is weighted has each further hit as an albedo of 1/2. */
typedef struct PathHit {
    Float4 weighing;                 /* its albedo, as it weighs other hits */
    Float4 weighted, later_weighted; /* light that met it first, or after others */
    Float4 met; /* light that met it after others, behind all hits, this one too, with their original albedo */
    Pending first;
} PathHit;

struct FootprintPixel {
    FootprintFilm *film;
    int spp; /* of the pixel, when it is finished */
    double free[3];
    TargetClusters *targets;
    PathHit hits[PATH_HITS_MAX]; /* of the path in hand */
    int nhits;
    PathHit *last[RETEX_MAX_FACTORS]; /* by how many hits came before it; NULL: none */
    LightSums *light;                 /* of what arrives */
    UvRange *range;                   /* of what was met */
};

#endif
