/* The images of a film, in bands of 16 rows: a band is in memory while its tiles are rendered, and goes to the band
 * store when the last of them is finished. Or images are kept whole, and the band store, if there is one, has a
 * copy. */
#ifndef RENDERER_FILM_BANDS_H
#define RENDERER_FILM_BANDS_H

#include <retex/band_stats.h>

#define BAND_LINES RETEX_BAND_ROWS
#define BAND_IMAGES_MAX 1536 /* as many as a set may have parts */

typedef struct Bands Bands;
/* The rows of one band, of all images. */
typedef struct BandRows BandRows;

/* store: taken over; may be NULL where images are kept whole. */
int bands_create(Bands **bands, int width, int height, RetexBandStore *store, int whole, RetexError *err);
void bands_close(Bands **bands); /* NULL and pointers to NULL are fine */

/* One more image, of zeros; from any thread. Its number counts from 0. */
int bands_add(Bands *bands, const char *name, const char *letters, RetexPixelType type, int *image, RetexError *err);

int bands_count(const Bands *bands); /* of bands */
/* Rows to write to, for any thread that works on the band; NULL where memory is short. */
BandRows *bands_open(Bands *bands, int band);
/* A pixel of an image, that will get some value. Never NULL. */
float *bands_pixel(BandRows *rows, int image, int x, int y);
/* Add the original albedos of a footprint's pixels, weighted by coverage, to the statistics of a target. */
void bands_add_albedo(const BandRows *rows, int uv, int albedo, RetexBandStats *stats, int target);
/* Nobody will write to the band any more: keep it. */
int bands_finish(BandRows *rows, RetexError *err);
/* Take over a band that the band store has already. */
int bands_resume(Bands *bands, int band, RetexError *err);
/* Put a finished band of whole images into another band store, which gets images of the same names. */
int bands_copy(const Bands *bands, int band, RetexBandStore *store, RetexError *err);
RetexBandStore *bands_store(const Bands *bands); /* borrowed, or NULL */

int bands_find(const Bands *bands, const char *name); /* an image, or -1 */
int bands_is_empty(const Bands *bands, int image); /* whether no pixel is other than 0 */
/* Make the image a part of a set that will own the band store. It is nothing to the film any more. */
int bands_move_part(Bands *bands, int image, RetexSet *set, int *part, RetexError *err);
RetexBandStore *bands_take_store(Bands *bands); /* after that; NULL where images were kept whole */

#endif
