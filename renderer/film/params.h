/* What a film is made for. */
#ifndef RENDERER_FILM_PARAMS_H
#define RENDERER_FILM_PARAMS_H

#include <retex/host/band_store.h>
#include <retex/set.h>

#define FILM_CLUSTERS_MAX 16

typedef struct FilmParams {
    int width, height;               /* of the picture that is kept */
    int spp;                         /* samples a pixel; the most, where tiles say how many */
    int orders;                      /* most hits of each target that are kept apart */
    int strict_paper;                /* layout paper: only the terms of the supplement, without corrections */
    int split;                       /* 0: the beauty only (plain and replaced renders) */
    int ntiles;                      /* each band has the same number, as high as itself */
    const struct FilmLayout *layout; /* where there is a split; see layout.h */
    int clusters;     /* layout footprints: a pixel and target, of both kinds together, 2..FILM_CLUSTERS_MAX */
    int sharp, broad; /* at most so many of each kind, 1..clusters */
    int extra;        /* so many more sharp ones in pixels where mirrors or glass show the target, 0.. */
    int extra_broad, extra_interreflections; /* so many more of these in pixels where merging them shows, 0.. */
    int periodic[RETEX_MAX_TARGETS][2]; /* targets that close in u, v */
    float brightness[RETEX_MAX_TARGETS]; /* of targets, 1/2..1: what their further hits weigh where noise is kept */
    int quadrants; /* layout footprints: keep quarters of pixels apart, where paths say where in the pixel they are */
    int nkept;     /* of the scene: its kept light */
    int noise;     /* also keep how noisy each signal is, see noise.h; needs two samples */
    RetexBandStore *store; /* where finished bands go, film_create takes it over; or NULL. The beauty stays too */
    int stored;            /* 1: images leave memory for the store */
} FilmParams;

#endif
