/* The images of layout `footprints`: filled in store.c, made parts of a set in finish.c. */
#ifndef RENDERER_FILM_FOOTPRINTS_IMAGES_H
#define RENDERER_FILM_FOOTPRINTS_IMAGES_H

#include "film/corrections.h"
#include "film/layout.h"
#include "film/footprints/plan.h"

#define INTERREFLECTION_CLUSTERS 2 /* footprints of further hits, of each target */
#define INTERREFLECTION_MOST 4     /* with extra ones */
#define INTERREFLECTION_GATHERED 8 /* such clusters of a pixel, until it is complete */
#define EXTRA_BROAD 2              /* more broad clusters in pixels where merging them shows */
#define BROAD_GATHERED 4           /* broad clusters of a pixel beyond those that are kept, until it is complete */

/* Images of one footprint: their numbers in the film's bands. */
typedef struct FootprintImages {
    int uv, spread, albedo;
    int light; /* of clusters */
    int share; /* in the light of its mixture; where there are further hits */
} FootprintImages;

/* Images of the clusters of one kind on a target. */
typedef struct KindImages {
    FootprintImages of[FILM_CLUSTERS_MAX];
    int interreflected[PLAN_COEFFICIENTS_MAX];
} KindImages;

/* Images of what a pixel sees directly of a target that covers it: its parallelogram, and the light of each quarter. */
#define QUADRANT_IMAGES (3 + 2 * RETEX_QUADRANTS)
typedef struct QuadrantImages {
    int uv, axes, albedo;
    int light[RETEX_QUADRANTS], share[RETEX_QUADRANTS];
} QuadrantImages;

#define CORRECTION_KINDS 3 /* of the first hit on the edited target: sharp, broad, an interreflection */

/* Images of the corrections of a target: without its texture, and by kind and number of hits. */
typedef struct CorrectionImages {
    int without, with[CORRECTION_KINDS][CORRECTION_POWERS];
} CorrectionImages;

/* Images of a target. */
typedef struct TargetImages {
    KindImages kinds[2];      /* sharp, broad */
    QuadrantImages quadrants; /* of the sharp ones, where the film has them */
    FootprintImages interreflections[INTERREFLECTION_MOST];
    CorrectionImages corrections; /* where there are several targets */
} TargetImages;

typedef struct FootprintFilm {
    const Scene *scene;
    FilmParams params;
    Bands *bands; /* borrowed */
    Plan plan, lamp_plan; /* of all light; of each lamp: the same, or a smaller one */
    int quadrants;        /* it has them */
    int indep;     /* C0 */
    TargetImages *targets;
    struct LampImages *lamps; /* NULL where the scene has none */
} FootprintFilm;

/* Most clusters of a kind that a pixel may have on a target, extra ones too: sharp (kind 0) or broad (1). */
static inline int most_of_kind(const FilmParams *p, int kind)
{
    return kind ? p->broad + p->extra_broad : p->sharp + p->extra;
}

/* So many broad ones are gathered until the pixel is complete: only then is it known how narrow each is, and what a
 * texture may change by merging it. Where sharp and broad ones share a number, no more are gathered than are kept. */
static inline int most_gathered_broad(const FilmParams *p)
{
    const int more = p->clusters < p->sharp + p->broad ? 0 : BROAD_GATHERED;
    return p->broad + more < FILM_CLUSTERS_MAX ? p->broad + more : FILM_CLUSTERS_MAX;
}

/* Footprints of interreflections that a target may have: none where no further hit is kept. */
static inline int most_interreflections(const FootprintFilm *film)
{
    return film->plan.count > 1 ? INTERREFLECTION_CLUSTERS + film->params.extra_interreflections : 0;
}

/* ---- store.c and finish.c: operations of the layout, see film/layout.h ---- */

int footprints_create(void **layout, const Scene *scene, const FilmParams *params, Bands *bands, RetexError *err);
void footprints_close(void **layout);
long footprints_floats(const FilmParams *params, int ntargets);
void footprints_pixel_end(void *pixel, BandRows *rows, int spp, int x, int y);
void footprints_band_stats(const void *layout, const BandRows *rows, RetexBandStats *stats);
int footprints_finish(void *layout, RetexSet *set, RetexError *err);

#endif
