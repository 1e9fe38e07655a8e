/* The film: where light connections of paths are gathered, pixel by pixel, and turned into a set. */
#ifndef RENDERER_FILM_FILM_H
#define RENDERER_FILM_FILM_H

#include "film/bands.h"
#include "film/path_hits.h"
#include "scene/scene.h"

#define FILM_CLUSTERS_MAX 16

typedef struct Film Film;

typedef struct FilmParams {
    int width, height; /* of the picture that is kept */
    int spp;           /* samples a pixel; the most, where tiles say how many */
    int orders;
    int strict_paper;
    int split;        /* 0: the beauty only (plain and replaced renders) */
    int ntiles;       /* of equal rows, BAND_LINES high */
    int paper;        /* layout: 0 footprints, 1 paper */
    int clusters;     /* layout footprints: a pixel and target, of both kinds together, 2..FILM_CLUSTERS_MAX */
    int sharp, broad; /* at most so many of each kind, 1..clusters */
    int periodic[RETEX_MAX_TARGETS][2]; /* targets that close in u, v */
    int noise;                          /* also keep how noisy each signal is, see noise.h; needs two samples */
    RetexSpool *spool; /* where finished bands go, film_create takes it over; or NULL. The beauty stays too */
    int spooled;       /* then: images leave memory for the spool */
} FilmParams;

/* Where on the targets light was met. */
typedef struct UvRange {
    double low[RETEX_MAX_TARGETS][2], high[RETEX_MAX_TARGETS][2]; /* inf, -inf: nowhere */
} UvRange;

void uv_range_reset(UvRange *range);
static inline void uv_range_add(UvRange *range, int target, const double uv[2])
{
    for (int k = 0; k < 2; k++) {
        range->low[target][k] = uv[k] < range->low[target][k] ? uv[k] : range->low[target][k];
        range->high[target][k] = uv[k] > range->high[target][k] ? uv[k] : range->high[target][k];
    }
}
void uv_range_merge(UvRange *into, const UvRange *from);

/* Luminance, summed; as of RetexBandStats. */
typedef struct LightSums {
    double total, folded, total_white, folded_white;
} LightSums;

/* One thread's scratch: sums of the pixel in hand. */
typedef struct FilmPixel FilmPixel;

int film_create(Film **film, const Scene *scene, const FilmParams *params, RetexError *err);
void film_close(Film **film);
int film_pixel_create(FilmPixel **pixel, Film *film, RetexError *err);
void film_pixel_close(FilmPixel **pixel);

void film_drop(FilmPixel *pixel);                             /* count light that is not finite, and is left out */
void film_add_light(FilmPixel *pixel, const double light[3]); /* of a path, all together */
/* Of that, what met hits that are folded; and what it would be with white targets. */
void film_add_folded(FilmPixel *pixel, Rgb light, Rgb white);
/* A path ends, with what it met of the targets, where light is split: behind one another no more hits of a target than
 * there are orders, and of all of them no more than expansion_most_hits. */
void film_path_end(FilmPixel *pixel, const PathHits *hits);
/* Before a tile's first pixel, where its pixels have not as many samples as FilmParams say. */
void film_tile_begin(FilmPixel *pixel, int spp);
Rgb film_pixel_take(FilmPixel *pixel); /* the sum of light so far instead of film_pixel_end: of a film without split */
void film_pixel_end(FilmPixel *pixel, int x, int y); /* store and reset */
void film_tile_end(FilmPixel *pixel, int tile);      /* the last tile of a band finishes it */
int film_failed(const Film *film);                   /* a band could not be kept: film_finish says why */

/* Bands that are finished, and kept. */
int film_bands(const Film *film); /* of all */
int film_bands_done(const Film *film);
int film_band_is_done(const Film *film, int band);
/* When all images are added: take over what the spool holds already. */
int film_resume(Film *film, RetexError *err);
/* Leave finished bands in a file, for another film of this key to go on from. */
int film_keep(Film *film, uint64_t key, const char *path, int replace, RetexError *err);

/* Images beside those of the layout, which others fill for the tile in hand, see bands.h. */
int film_add_image(Film *film, const char *name, const char *letters, RetexPixelType type, int *image, RetexError *err);
float *film_image_pixel(FilmPixel *pixel, int image, int x, int y);
/* After film_finish: make it a part of the set. */
int film_move_image(Film *film, int image, RetexSet *set, RetexError *err);

/* Make all of it a set: parts, terms, footprints, shares of energy; what no pixel has is left out. */
int film_finish(Film *film, RetexSet *set, RetexError *err);
/* When all images are in the set: let it have the spool. */
void film_give_spool(Film *film, RetexSet *set);
/* Numbers a pixel that the film's images have at least, all together. */
long film_floats(const FilmParams *params, int ntargets);
/* Bytes that they take at least, with a spool or without. */
double film_bytes(const FilmParams *params, int ntargets, int spooled);
long film_dropped(const Film *film); /* samples that were not finite */

#endif
