/* What a layout of sets does with the paths of a film: one table of operations each. The film calls them; which images
 * there are, and how light is gathered in them, is the layout's own. Layouts: film/footprints, film/paper. */
#ifndef RENDERER_FILM_LAYOUT_H
#define RENDERER_FILM_LAYOUT_H

#include <retex/host/band_stats.h>
#include "film/bands.h"
#include "film/params.h"
#include "film/target_tree.h"
#include "film/uv_range.h"
#include "scene/scene.h"

#define LAYOUT_SIGNALS_MAX 2 /* of a target */
/* Of all light, and of each lamp and the rest. */
#define NOISE_SIGNALS_MAX ((1 + LAYOUT_SIGNALS_MAX * RETEX_MAX_TARGETS) * (1 + KEPT_MAX))

/* Luminance, summed; as of RetexBandStats. */
typedef struct LightSums {
    double total, folded, total_white, folded_white, cut;
} LightSums;

/* Sums over a pixel's samples so far, by signal: light that no target's texture multiplies (the beauty, where there is
 * no split), then the signals of each target; then as many of each kept light. */
typedef struct SignalTotals {
    double of[NOISE_SIGNALS_MAX][3];
} SignalTotals;

typedef struct FilmLayout {
    const char *name; /* in the set's manifest */
    int nsignals;     /* of each target, that denoising tells apart, 1..LAYOUT_SIGNALS_MAX */
    const char *signals[LAYOUT_SIGNALS_MAX]; /* their names */
    int keeps_white;  /* LightSums has what there would be with white targets too */
    int prunes;       /* all images become parts of the set, and those that are empty leave it again */

    /* Most hits of all targets together that a path keeps apart. */
    int (*most_hits)(int ntargets);
    /* Numbers a pixel that its images have at least. */
    long (*floats)(const FilmParams *params, int ntargets);

    /* One for the film. bands is borrowed. On failure it is closed by the caller. */
    int (*create)(void **layout, const Scene *scene, const FilmParams *params, Bands *bands, RetexError *err);
    void (*close)(void **layout);
    /* Where paths make images, NULL elsewhere: make the image of this name, which an earlier render left in the band
     * store, if it is one that paths make. */
    int (*resume_image)(void *layout, const char *name, RetexError *err);
    /* One thread's sums of the current pixel. light and range are borrowed: light gets the light with white targets,
     * range the UV of hits. */
    int (*pixel_create)(void **pixel, void *layout, LightSums *light, UvRange *range, RetexError *err);
    void (*pixel_close)(void **pixel);

    void (*path_end)(void *pixel, const TargetTree *hits);
    void (*totals)(const void *pixel, SignalTotals *totals); /* between paths */
    void (*pixel_end)(void *pixel, BandRows *rows, int spp, int x, int y); /* store and reset */
    /* Of a finished band: albedo and coverage. */
    void (*band_stats)(const void *layout, const BandRows *rows, RetexBandStats *stats);
    /* Make the images parts, footprints and terms of the set, which knows its targets' names. */
    int (*finish)(void *layout, RetexSet *set, RetexError *err);
} FilmLayout;

#endif
