/* The spool: where images of one size go, band by band as they are finished, until the file that they belong to can be
 * written. Bands are kept as an EXR file stores them, compressed, in a temporary file; those without light cost
 * nothing.
 *
 * With a name it is a journal: whole up to the last band that was committed, whenever the process ends, so that another
 * one can go on from there. Everything in it has a checksum; bands behind the first damaged place count as not there.
 */
#ifndef RETEX_SPOOL_H
#define RETEX_SPOOL_H

#include <stdint.h>
#include <retex/image.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_SPOOL_LINES 16 /* of a band; the last one may have fewer */

typedef struct RetexSpool RetexSpool;
typedef struct RetexBandStats RetexBandStats; /* see band_stats.h */

/* Images of width x height. The file has no name and is gone with the process; it lies in the folder of `near`, where
 * that is the path of a file to be, else in $TMPDIR or /tmp. key: tells what the images are of. */
int retex_spool_create(RetexSpool **spool, int width, int height, uint64_t key, const char *near, RetexError *err);
/* The journal at path, made where there is none: 1 = make. What was not committed is cut off. Refused where it is of
 * other images or in use. With make = 0 nothing is changed, and only reading is possible. */
int retex_spool_open(RetexSpool **spool, int width, int height, uint64_t key, const char *path, int make,
                     RetexError *err);
/* Bands that are put from now on are not compressed, for a file that is not: faster, and larger. */
void retex_spool_set_plain(RetexSpool *spool);
void retex_spool_close(RetexSpool **spool); /* NULL and pointers to NULL are fine */

/* Give a spool without a name this one, so that it stays. A file of that name is replaced where replace is 1, else it
 * is an error. */
int retex_spool_keep(RetexSpool *spool, const char *path, int replace, RetexError *err);

/* One more image; *image gets its number, from 0. name and letters: as of a RetexPart; type: how samples are kept. One
 * that a journal has under that name is that one. */
int retex_spool_add(RetexSpool *spool, const char *name, const char *letters, RetexPixelType type, int *image,
                    RetexError *err);

/* Keep a band of an image: its rows, interleaved. From any thread; no band of an image twice. */
int retex_spool_put(RetexSpool *spool, int image, int band, const float *pixels, RetexError *err);

/* All images of the band are put. */
int retex_spool_commit(RetexSpool *spool, int band, const RetexBandStats *stats, RetexError *err);
/* What was said of a band that is committed, or NULL. */
const RetexBandStats *retex_spool_committed(const RetexSpool *spool, int band);
/* Put and commit a band as another spool has it, all of whose images must be there. */
int retex_spool_copy_band(RetexSpool *spool, const RetexSpool *from, int band, RetexError *err);

/* Whether no pixel that was put is other than 0. */
int retex_spool_is_empty(const RetexSpool *spool, int image);

/* One band of an image, as it would be read from a file: its rows, interleaved. Here, where bands are copied and where
 * a set is written from a spool, RETEX_EFORMAT says that the file no longer has what was put into it. */
int retex_spool_load_band(const RetexSpool *spool, int image, int band, float *pixels, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
