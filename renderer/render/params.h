/* What a render is asked for, and what it counts. */
#ifndef RENDERER_RENDER_PARAMS_H
#define RENDERER_RENDER_PARAMS_H

#include <stdint.h>
#include <retex/budget.h>
#include <retex/host/aov.h>
#include "scene/variant.h"

/* Begin with RENDER_PARAMS_INIT. */
typedef struct RenderParams {
    size_t size;
    int width, height;       /* of the whole picture; 0 = the scene's own */
    int crop[4];             /* x, y, width, height of the part to render; width 0 = all. The result has this size */
    int spp;                 /* samples a pixel, 1..2^20; default 64 */
    double noise;            /* above 0: tiles get as many samples, up to spp, as bring their noise down to this, see
                                adaptive.h; default 0: all get spp */
    uint32_t seed;           /* default 0 */
    int max_depth;           /* segments of a path, 1..256, camera and shadow rays included; default 16 */
    int gaussian;            /* pixel filter: 0 box of one pixel (default), 1 Gaussian of sigma 0.5 pixel */
    int paper;               /* layout: 0 footprints (default), 1 paper */
    int clusters;            /* layout footprints: clusters kept a pixel and target, 2..16; default 6 */
    int sharp, broad;        /* at most so many of what is seen sharply and of the rest, 1..clusters; default 4, 2 */
    int extra;               /* so many more sharp ones where mirrors or glass show the target; default 8 */
    int no_quadrants;        /* layout footprints: 1: no parallelograms, see film/footprints/quadrants.c; default 0 */
    int orders;              /* most hits of each target kept, 1..6; default 6; of all together 12, in paper 8 */
    int strict_paper;        /* drop mixed terms of four and more hits, as the supplement does; default 0 */
    int plain;               /* beauty only, no set; default 0 */
    unsigned aovs;           /* RETEX_AOV_BIT(…) of each AOV that the set is to have: of the first hit of the ray
                                through the pixel's centre, unfiltered; irradiance by spp paths from there */
    int nthreads;            /* 0 = all cores */
    void (*progress)(void *context, double done); /* 0..1, from the calling thread; NULL = none */
    void *progress_context;
    const RenderVariant *variants; /* textures instead of the originals; NULL = none. render_scene takes the first */
    int nvariants;           /* 0..VARIANTS_MAX */
    int control_data;        /* 1, 2: also what later control variates read, of so many parts of the samples: two are
                                independent, so that the picture is another one than without; default 0 */
    int denoise_data;        /* 1: also what denoising reads, see <retex/host/denoise_data.h>; nothing where spp is 1,
                                which does not tell how noisy it is; default 0 */
    int stored;             /* 1: render_scene leaves parts of the set in a band store (retex/host/band_store.h), for
                                retex_set_write or retex_set_load; default 0 */
    int rounded;             /* 1: the set will be rounded (retex_set_round), so that its images are compressed again:
                                until then they are compressed fast; default 0 */
    const char *output;      /* what the result will be written to, so that the band store is near it; NULL = nothing */
    uint64_t key;            /* tells this render from others: of the files below those with another are refused */
    const char *checkpoint;     /* where finished rows are kept when the render is stopped; NULL (default) = nowhere */
    int resume;              /* 1: they are kept there all the time, and those that are there are taken over */
    double light_share;      /* least share of direct-light samples that the lamps of a scene with lamps have together,
                                each as much, 0..1; default 0.1 */
    RetexBudget *budget;     /* where it says stop, nothing more is traced and the render fails; NULL = never */
    int caustics_guide;      /* photons show paths where caustics come from, see caustics.h: 0 (default) those of light
                                sources and, where it pays, of small emitters, 1 of all emitters too, -1 none */
    double unit;             /* metres of a scene unit, > 0; default 1 */
} RenderParams;
#define RENDER_PARAMS_INIT \
    { .size = sizeof(RenderParams), .spp = 64, .max_depth = 16, .clusters = 6, .sharp = 4, .broad = 2, .extra = 8, \
      .orders = 6, .light_share = 0.1, .unit = 1 }

typedef struct RenderStats {
    double build_seconds, render_seconds;
    long paths, segments, shadow_rays;
    long dropped; /* contributions that were not finite */
    long limited; /* numbers of images that were not finite or too large, see film/limits.h */
    long lights, primitives, triangles;
} RenderStats;

#endif
