/* The film: where light connections of paths are gathered, pixel by pixel, and turned into a set. */
#ifndef RENDERER_FILM_FILM_H
#define RENDERER_FILM_FILM_H

#include "film/expansion.h"
#include "scene/scene.h"

typedef struct Film Film;

typedef struct FilmParams {
    int width, height;      /* of the picture that is kept */
    int spp, orders;
    int strict_paper;
    int split;              /* 0: the beauty only (plain and replaced renders) */
    int ntiles;
} FilmParams;

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
long film_dropped(const Film *film); /* samples that were not finite */

#endif
