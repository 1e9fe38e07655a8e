/* The spool: where images of one size go, band by band as they are finished, until the file that they belong to can be
 * written. Bands are kept as an EXR file stores them, compressed, in a temporary file; those without light cost
 * nothing. */
#ifndef RETEX_SPOOL_H
#define RETEX_SPOOL_H

#include <retex/image.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_SPOOL_LINES 16 /* of a band; the last one may have fewer */

typedef struct RetexSpool RetexSpool;

/* Images of width x height. The file has no name and is gone with the process; it lies in the folder of `near`, where
 * that is the path of a file to be, else in $TMPDIR or /tmp. */
int retex_spool_create(RetexSpool **spool, int width, int height, const char *near, RetexError *err);
void retex_spool_close(RetexSpool **spool); /* NULL and pointers to NULL are fine */

/* One more image; *image gets its number, from 0. name and letters: as of a RetexPart; type: how samples are kept. */
int retex_spool_add(RetexSpool *spool, const char *name, const char *letters, RetexPixelType type, int *image,
                    RetexError *err);

/* Keep a band of an image: its rows, interleaved. From any thread; no band of an image twice. */
int retex_spool_put(RetexSpool *spool, int image, int band, const float *pixels, RetexError *err);

/* Whether no pixel that was put is other than 0. */
int retex_spool_is_empty(const RetexSpool *spool, int image);

/* The image as it would be read from a file; dst is unallocated. */
int retex_spool_load(const RetexSpool *spool, int image, RetexImage *dst, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
