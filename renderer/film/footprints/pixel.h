/* The sums of one pixel: filled in footprints.c and clusters.c while its paths end, stored by store.c. */
#ifndef RENDERER_FILM_FOOTPRINTS_PIXEL_H
#define RENDERER_FILM_FOOTPRINTS_PIXEL_H

#include <retex/host/uv_stats.h>
#include "base/color4.h"
#include "film/footprints/images.h"

typedef struct FootprintPixel FootprintPixel;

#define INTERREFLECTED_WEIGHT 1e-3f /* in a footprint's albedo, of light that goes on to targets */

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
    Float4 c;              /* light without further hits */
    Float4 interreflected; /* light with further hits, with their original albedos */
} Cluster;

/* Light by the number of a target's hits, 0 to CORRECTION_POWERS and more: with the original albedos of all hits on
 * other targets. */
typedef Float4 Powers[CORRECTION_POWERS + 1];

/* Light as a polynomial in the textures of further hits, by the coefficients of the plan; and the sum of all its terms
 * but the first, with each further hit's original albedo and with 1/2, and where each target alone is edited. */
typedef struct HitLight {
    Coefficients c; /* [0], and those in use; the others are not set */
    Float4 original, half;
    unsigned used;                    /* bits, of those after the first; 0: there is nothing but c[0] */
    Powers edited[RETEX_MAX_TARGETS]; /* of corrected targets, where `used` is not 0; the others are not set */
} HitLight;

/* A hit of one path as the first hit of monomials, and their light. */
typedef struct FirstHit {
    int target, sharp, direct;
    int is_rest; /* it is not in the quadrants that may cover the pixel */
    double uv[2];
    double weight;
    Float4 albedo; /* the original's, there */
    const HitLight *light;
} FirstHit;

/* A hit of one path as a further hit of monomials. */
typedef struct Interreflection {
    int target;
    double uv[2], weight;
    Float4 light, albedo; /* light, with the original albedos of the path's other hits; its own albedo */
} Interreflection;

/* Clusters of one kind, and the interreflected light of all of them, by the coefficients of the plan: [0] stays
 * empty. */
typedef struct Clusters {
    int count;
    unsigned used;      /* bits: coefficients of `interreflected` that are not 0 */
    double merge_bound; /* merging any two of them costs at least this; -inf: not known */
    unsigned changed;   /* bits: clusters that are not as `costs` were computed */
    double costs[FILM_CLUSTERS_MAX][FILM_CLUSTERS_MAX]; /* of merging [i][k], i < k */
    Cluster of[FILM_CLUSTERS_MAX];
    Cluster rest[FILM_CLUSTERS_MAX]; /* of each, the hits that are not in quadrants; only the weight is set if 0 */
    Coefficients interreflected;
} Clusters;

/* A cluster of further hits on a target. */
typedef struct InterreflectionCluster {
    RetexUvStats uv; /* weight 0: none */
    double varies;   /* retex_uv_stats_variation */
    double squares;  /* of the paths' weights */
    AlbedoSums albedo;
} InterreflectionCluster;

/* Sums over the paths of a pixel whose camera rays met one target, of where in the pixel they are and of UV there: each
 * path counts 1, whatever its light. Places are from the pixel's middle, UV from the first path's. */
typedef struct PlaceSums {
    double n, place[2], uv[2];
    double places[3], mixed[2][2], uvs[3]; /* xx, xy, yy; [x, y][u, v]; uu, uv, vv */
} PlaceSums;

/* The part of a pixel's light that comes directly from a quarter of it. */
typedef struct Quadrant {
    int paths;
    Float4 c, interreflected; /* as of a cluster */
} Quadrant;

/* A target that all camera rays of a pixel met first, so far: the UV as a map from the place in the pixel, and the
 * light of each quarter. */
typedef struct Quadrants {
    int target; /* -1: no path yet; -2: some ray met something else */
    double origin[2];
    PlaceSums sums;
    double weight, squares; /* of the paths' weights */
    AlbedoSums albedo;
    Quadrant of[RETEX_QUADRANTS];
} Quadrants;

#define QUADRANTS_NONE (-1)
#define QUADRANTS_MIXED (-2)

/* What a pixel sees of a surface if its UV change evenly: the middle, and du/dx, dv/dx, du/dy, dv/dy. */
typedef struct PixelMap {
    double uv[2], axes[4];
} PixelMap;

/* Light that meets a target, where that target alone is edited: with the original albedos of all other hits, by kind
 * of the first hit on the target. Light of one target's clusters without further hits is left out. */
typedef struct EditedLight {
    Float4 without;
    Powers with[CORRECTION_KINDS]; /* [kind][n - 1] of n hits */
} EditedLight;

/* The clusters of one pixel on one target. */
typedef struct TargetClusters {
    Clusters sharp, broad;
    int specular; /* a mirror or glass shows it: there may be extra sharp clusters */
    InterreflectionCluster interreflections[INTERREFLECTION_GATHERED];
    double interreflections_bound; /* as merge_bound of Clusters, of interreflections, */
    unsigned interreflections_changed; /* changed, */
    double interreflections_costs[INTERREFLECTION_GATHERED][INTERREFLECTION_GATHERED]; /* and costs */
    EditedLight edited;            /* of corrected targets */
} TargetClusters;

/* Add a hit of a path as the first one to the light of edited targets. */
void corrections_add(FootprintPixel *pixel, const FirstHit *hit);
/* Store what the light of edited targets differs from that of the stored images, with the mean albedos of other
 * targets; before the clusters are reset. unit: to which it is rounded. */
void corrections_store(FootprintPixel *pixel, BandRows *rows, double unit, int x, int y);

/* Add the albedo of a cluster's own light; interreflected light counts where there is no other. */
static inline void add_hit_albedo(AlbedoSums *sums, const FirstHit *hit)
{
    const Float4 light = hit->light->c[0] + hit->light->original * splat(INTERREFLECTED_WEIGHT);
    sums->light += light, sums->reflected += light * hit->albedo;
}

/* Begin a path, with what its camera ray met. */
void quadrants_start_path(Quadrants *quadrants, const SeenTarget *seen, const int periodic[][2]);
/* Add light that comes directly from there. */
void quadrants_add(Quadrants *quadrants, const SeenTarget *seen, const FirstHit *hit);
/* Whether the quadrants stand for all that the pixel sees directly; then *map is where. */
int quadrants_find_map(const Quadrants *quadrants, const int periodic[][2], PixelMap *map);
/* The light of a quadrant, by the means of their paths, whose numbers differ; that of all is kept. */
Float4 quadrants_light(const Quadrants *quadrants, int k, int interreflected);
/* Remove hits that are in quadrants. */
void clusters_keep_rest(Clusters *clusters);

/* Add a hit of a path to the clusters of its target. */
void clusters_add(TargetClusters *target, const FirstHit *hit, const FilmParams *params);
/* Merge extra sharp clusters of target t, once it has all hits, where the pixel is expected to change little by that.
 * light: of the pixel, in the units of the hits' weights. */
void clusters_merge_extra(TargetClusters *target, int t, const FilmParams *params, double light);
/* Merge broad clusters of target t, once it has all hits, down to as many as are kept; but extra ones only where the
 * pixel is expected to change little by that, or by less than its noise. light: as above; spp: its paths. */
void clusters_merge_broad(TargetClusters *target, int t, const FilmParams *params, double light, int spp);
void clusters_add_interreflection(TargetClusters *target, const Interreflection *hit, const int periodic[2]);
/* Merge interreflections of target t in the same way; the first of the array remain. */
void clusters_merge_interreflections(TargetClusters *target, int t, const FilmParams *params, double light, int spp);

/* A hit of the current path; see target_tree.h. */
typedef struct Node {
    HitLight dependent,
        independent; /* its light, that of further hits too: what its texture multiplies, and the rest */
    Float4 white;    /* all of that, were the targets of white paint */
    Float4 albedo;   /* of the original, as it weighs other hits */
    /* What the hits before it do to light that comes from it: none of their textures; all, with the original albedos;
     * all, with 1/2. */
    Float4 none, original, half;
} Node;

/* Light of a hit in all combinations of finishes: as the first hit, and as an interreflection. */
typedef struct CombinedHit {
    HitLight first;
    Interreflection further;
} CombinedHit;

struct FootprintPixel {
    FootprintFilm *film;
    int spp; /* of the pixel, when it is finished */
    double indep[3];
    TargetClusters *targets;
    struct LampPixel *lamps; /* NULL where the scene keeps no light apart */
    CombinedHit *combined;   /* of the current path; NULL where there are no combinations */
    Quadrants quadrants;
    Node nodes[TARGET_NODES_MAX];
    LightSums *light; /* of contributions */
    UvRange *range;   /* of the hits */
};

#endif
