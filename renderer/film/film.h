/* The film: it sums the contributions of paths, pixel by pixel, and makes a set of them. */
#ifndef RENDERER_FILM_FILM_H
#define RENDERER_FILM_FILM_H

#include "film/params.h"
#include "film/path_hits.h"
#include "scene/scene.h"

typedef struct Film Film;

/* One thread's sums of the current pixel. */
typedef struct FilmPixel FilmPixel;

int film_create(Film **film, const Scene *scene, const FilmParams *params, RetexError *err);
void film_close(Film **film);
int film_pixel_create(FilmPixel **pixel, Film *film, RetexError *err);
void film_pixel_close(FilmPixel **pixel);

void film_drop(FilmPixel *pixel);                             /* count light that is not finite, and is left out */
void film_add_light(FilmPixel *pixel, const double light[3]); /* of a path, all together */
/* The part of it that met folded hits; and what it would be with white targets. */
void film_add_folded(FilmPixel *pixel, Rgb light, Rgb white);
/* A path ends, with the hits that it has where there is a split. A hit and those before it, up to the camera, are at
 * most FilmParams.orders of each target, and of all targets at most what FilmLayout.most_hits says. */
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
/* Once all images are added: read the bands that the band store has already. */
int film_resume(Film *film, RetexError *err);
/* Leave finished bands in a file, for another film of this key to go on from. */
int film_save(Film *film, uint64_t key, const char *path, int replace, RetexError *err);

/* Images beside those of the layout; the caller fills them for the current tile, see bands.h. */
int film_add_image(Film *film, const char *name, const char *letters, RetexPixelType type, int *image, RetexError *err);
float *film_image_pixel(FilmPixel *pixel, int image, int x, int y);
/* After film_finish: make it a part of the set. */
int film_move_image(Film *film, int image, RetexSet *set, RetexError *err);

/* Make the film a set: parts, terms, footprints, folded light; images that are empty are left out. */
int film_finish(Film *film, RetexSet *set, RetexError *err);
/* When all images are in the set: let it have the band store. */
void film_move_store(Film *film, RetexSet *set);
/* Numbers a pixel that the film's images have at least, all together. */
long film_floats(const FilmParams *params, int ntargets);
/* Bytes that they take at least, with a band store or without. */
double film_bytes(const FilmParams *params, int ntargets, int stored);
long film_dropped(const Film *film); /* samples that were not finite */

#endif
