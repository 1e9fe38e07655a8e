/* Band stores: temporary files that keep images of one size, band by band as the bands are finished, until the file
 * that the images belong to can be written. Bands are kept as an EXR file stores them, compressed; bands whose pixels
 * are all 0 take no room.
 *
 * A band store with a name is a checkpoint: whenever the process ends, the file is whole up to the last band that was
 * committed, so that another process can go on from there. Everything in it has a checksum; bands behind the first
 * damaged place count as absent. */
#ifndef RETEX_HOST_BAND_STORE_H
#define RETEX_HOST_BAND_STORE_H

#include <stdint.h>
#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_BAND_ROWS 16 /* rows of a band; the last band of an image may have fewer */

typedef struct RetexBandStore RetexBandStore;
typedef struct RetexBandStats RetexBandStats; /* see band_stats.h */

/* Create a band store for images of width x height pixels. Its file has no name and is gone with the process; it lies
 * in the folder of `near`, where that is the path of a file to be written, else in $TMPDIR or /tmp. key: identifies
 * what the images are of. */
int retex_band_store_create(RetexBandStore **store, int width, int height, uint64_t key, const char *near,
                            RetexError *err);
/* Open the checkpoint at path, or create it where there is none; bands that were not committed are cut off. A
 * checkpoint of another size or key, or one that is in use, is refused. */
int retex_band_store_open(RetexBandStore **store, int width, int height, uint64_t key, const char *path,
                          RetexError *err);
/* Do not compress bands from now on, for a file that is not compressed either: faster, and larger. */
void retex_band_store_set_plain(RetexBandStore *store);
/* Compress bands less from now on, for what does not stay: files in pipes, and images that are computed anew before
 * they are written, as retex_set_round does. */
void retex_band_store_set_fast(RetexBandStore *store);
void retex_band_store_close(RetexBandStore **store); /* NULL and pointers to NULL are fine */

/* Give a band store without a name this one, so that it stays after the process. A file of that name is an error. */
int retex_band_store_keep(RetexBandStore *store, const char *path, RetexError *err);

/* Add an image; *image gets its number, from 0. name and letters: as of a RetexPart; type: how samples are stored. If a
 * checkpoint has an image of that name already, *image is the number of that image. */
int retex_band_store_add(RetexBandStore *store, const char *name, const char *letters, RetexPixelType type, int *image,
                         RetexError *err);
/* The name of an image, for instance of one that only a checkpoint has; NULL after the last. The store owns it. */
const char *retex_band_store_image_name(const RetexBandStore *store, int image);

/* Write a band of an image: its rows, interleaved. From any thread; no band of an image twice. */
int retex_band_store_put(RetexBandStore *store, int image, int band, const float *pixels, RetexError *err);

/* Commit a band, of which all images have been put. */
int retex_band_store_commit(RetexBandStore *store, int band, const RetexBandStats *stats, RetexError *err);
/* The stats that a band was committed with; NULL where the band is not committed. */
const RetexBandStats *retex_band_store_committed(const RetexBandStore *store, int band);

/* 1 if all pixels of the image that were put are 0. */
int retex_band_store_is_empty(const RetexBandStore *store, int image);

/* Read one band of an image, with samples rounded to their type: its rows, interleaved. RETEX_EFORMAT, here
 * and where a set is written from a band store, means that the file no longer has what was put into it. */
int retex_band_store_load_band(const RetexBandStore *store, int image, int band, float *pixels, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
