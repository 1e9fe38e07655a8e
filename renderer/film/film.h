/* The film: where light connections of paths are gathered, pixel by pixel, and turned into a set. */
#ifndef RENDERER_FILM_FILM_H
#define RENDERER_FILM_FILM_H

#include "film/expansion.h"
#include "scene/scene.h"

#define FILM_CLUSTERS_MAX 16

typedef struct Film Film;

typedef struct FilmParams {
    int width, height;      /* of the picture that is kept */
    int spp, orders;
    int strict_paper;
    int split;              /* 0: the beauty only (plain and replaced renders) */
    int ntiles;
    int paper;              /* layout: 0 footprints, 1 paper */
    int clusters;           /* layout footprints: a pixel and target, of both kinds together, 2..FILM_CLUSTERS_MAX */
    int sharp, broad;       /* at most so many of each kind, 1..clusters */
    int periodic[RETEX_MAX_TARGETS][2]; /* targets that close in u, v */
    int noise;              /* also keep how noisy each signal is, see noise.h; needs two samples */
} FilmParams;

/* Where on the targets light was met. */
typedef struct UvRange {
    double low[RETEX_MAX_TARGETS][2], high[RETEX_MAX_TARGETS][2]; /* inf, -inf: nowhere */
} UvRange;

void uv_range_reset(UvRange *range);
void uv_range_add(UvRange *range, int target, const double uv[2]);
void uv_range_merge(UvRange *into, const UvRange *from);

/* Luminance, summed: all light, and that whose surplus hits had to take their original albedo; as it is, and as it
 * would be with white targets. */
typedef struct LightSums {
    double total, folded, total_white, folded_white;
} LightSums;

/* One thread's scratch: sums of the pixel in hand. */
typedef struct FilmPixel FilmPixel;

int film_create(Film **film, const Scene *scene, const FilmParams *params, RetexError *err);
void film_close(Film **film);
int film_pixel_create(FilmPixel **pixel, Film *film, RetexError *err);
void film_pixel_close(FilmPixel **pixel);

/* Light that arrived: beauty is its whole contribution. With a split film, outside is the part of the throughput that
 * no recorded target hit made, times the light, and expansion holds the hits; folded: hits beyond the order kept
 * their albedo. Samples that are not finite are counted and dropped. */
void film_connect(FilmPixel *pixel, Rgb beauty, Rgb outside, const Expansion *expansion, int folded);
/* A path ends: hits of targets that connected enter the footprints, each once for every connection behind it. */
void film_path_end(FilmPixel *pixel);
void film_pixel_end(FilmPixel *pixel, int x, int y);   /* store and reset */
void film_tile_end(FilmPixel *pixel, int tile);        /* energy sums, kept by tile so that their order is fixed */

/* Move everything into a set: parts, terms, footprints, shares of energy. The film is empty afterwards. */
int film_finish(Film *film, RetexSet *set, RetexError *err);
/* For the layouts: hand an image over to a new part of the set. */
int film_move_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, RetexImage *image,
                   int *index, RetexError *err);
/* Numbers a pixel that the film holds at least. */
long film_floats(const FilmParams *params, int ntargets);
long film_dropped(const Film *film); /* samples that were not finite */

#endif
