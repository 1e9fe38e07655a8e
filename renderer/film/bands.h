/* The images of a film, in bands of 16 rows. A band is in memory while its tiles are rendered, and is written to the
 * band store after the last of them. Whole images may be kept in memory instead; then the band store, if there is one,
 * gets a copy. */
#ifndef RENDERER_FILM_BANDS_H
#define RENDERER_FILM_BANDS_H

#include <retex/host/band_stats.h>
#include <retex/host/band_store.h>

#define BAND_LINES RETEX_BAND_ROWS
#define BAND_IMAGES_MAX 1536 /* as many as a set may have parts */

typedef struct Bands Bands;
/* The rows of one band, of all images. */
typedef struct BandRows BandRows;

/* store: owned by bands from now on; may be NULL where images are kept whole. */
int bands_create(Bands **bands, int width, int height, RetexBandStore *store, int whole, RetexError *err);
void bands_close(Bands **bands); /* NULL and pointers to NULL are fine */

/* Add an image of zeros; from any thread. *image is its number, from 0. */
int bands_add(Bands *bands, const char *name, const char *letters, RetexPixelType type, int *image, RetexError *err);

int bands_count(const Bands *bands); /* the number of bands */
/* Open a band for writing, from any thread; NULL where memory is short. */
BandRows *bands_open(Bands *bands, int band);
/* A pixel of an image, for writing. Never NULL. */
float *bands_pixel(BandRows *rows, int image, int x, int y);
/* Replace numbers that a set may not hold, as film/limits.h says, in a band that no thread writes to any more. Returns
 * how many. */
long bands_limit(BandRows *rows);
/* Add the original albedos of a footprint's pixels, weighted by coverage, to the statistics of a target. */
void bands_add_albedo(const BandRows *rows, int uv, int albedo, RetexBandStats *stats, int target);
/* Store a band that is complete. No thread may write to it any more. */
int bands_finish(BandRows *rows, RetexError *err);
/* Use a band that the band store already has. */
int bands_resume(Bands *bands, int band, RetexError *err);
/* Copy a finished band of whole images to another band store, which gets images of the same names. */
int bands_copy(const Bands *bands, int band, RetexBandStore *store, RetexError *err);
RetexBandStore *bands_store(const Bands *bands); /* borrowed, or NULL */

int bands_find(const Bands *bands, const char *name); /* an image, or -1 */
int bands_is_empty(const Bands *bands, int image); /* 1 if all pixels are 0 */
/* Make the image a part of a set that will own the band store. The film no longer has the image. */
int bands_move_part(Bands *bands, int image, RetexSet *set, int *part, RetexError *err);
RetexBandStore *bands_take_store(Bands *bands); /* call it after that; NULL where images were kept whole */

#endif
