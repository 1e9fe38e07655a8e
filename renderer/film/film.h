/* The film sums the contributions of paths pixel by pixel. At the end its images become a set. */
#ifndef RENDERER_FILM_FILM_H
#define RENDERER_FILM_FILM_H

#include "film/bands.h"
#include "film/params.h"
#include "film/target_tree.h"
#include "scene/scene.h"

typedef struct Film Film;

/* One thread's sums of the current pixel. */
typedef struct FilmPixel FilmPixel;

int film_create(Film **film, const Scene *scene, const FilmParams *params, RetexError *err);
void film_close(Film **film);
int film_pixel_create(FilmPixel **pixel, Film *film, RetexError *err);
void film_pixel_close(FilmPixel **pixel);

void film_drop(FilmPixel *pixel);                             /* count a sample that is not finite; nothing is added */
void film_add_light(FilmPixel *pixel, const double light[3]); /* the sum of one path's contributions */
/* Of films with a split: how many hits on one target, and on all together, a path may keep apart. */
void film_hit_limits(const FilmPixel *pixel, int *orders, int *most_hits);
/* Luminance that the maximum depth left out of the path. */
void film_add_cut(FilmPixel *pixel, double cut);
/* End a path. hits: its hits on targets, which films with a split read; within film_hit_limits, from the camera to any
 * of them. */
void film_path_end(FilmPixel *pixel, const TargetTree *hits);
/* Begin a tile whose pixels have another number of samples than FilmParams say. */
void film_tile_begin(FilmPixel *pixel, int spp);
void film_pixel_end(FilmPixel *pixel, int x, int y); /* store and reset */
void film_tile_end(FilmPixel *pixel, int tile);      /* the last tile of a band finishes it */
int film_failed(const Film *film); /* 1 if a band could not be stored: film_finish fails and says why */

/* The number of bands, and which of them are finished. */
int film_bands(const Film *film);
int film_bands_done(const Film *film);
int film_band_is_done(const Film *film, int band);
/* Read the bands that the band store already has. Call it after all images have been added. */
int film_resume(Film *film, RetexError *err);
/* Save the finished bands in a checkpoint, from which a render with the same key continues. */
int film_save(Film *film, uint64_t key, const char *path, RetexError *err);

/* Images beside those of the layout are added to these, filled for the current tile, and become parts of a set after
 * film_finish. */
Bands *film_images(const Film *film);
float *film_image_pixel(FilmPixel *pixel, int image, int x, int y);

/* Add the parts, terms and footprints of the film to a set, without empty images. */
int film_finish(Film *film, RetexSet *set, RetexError *err);
/* Give the band store to the set. Call it after all images have been moved to the set. */
int film_move_store(Film *film, RetexSet *set, RetexError *err);
/* The least number of floats for each pixel in all images of the film. */
long film_floats(const FilmParams *params, int ntargets);
/* The least number of bytes that they take in memory. stored: 1 with a band store. */
double film_bytes(const FilmParams *params, int ntargets, int stored);
long film_dropped(const Film *film); /* samples that were not finite */
long film_limited(const Film *film); /* numbers of its images that were replaced, see limits.h */

#endif
