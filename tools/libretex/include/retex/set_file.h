/* Files of sets and samples. A set in a file may stay there and be read row by row, so that it need not fit into
 * memory. */
#ifndef RETEX_SET_FILE_H
#define RETEX_SET_FILE_H

#include <retex/access.h>
#include <retex/laid.h>
#include <retex/shrink.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* How a set is written. Begin with RETEX_STORE_INIT. */
typedef struct RetexStoreParams {
    size_t size;
    int compress; /* 1 (default): EXR ZIP or PXR24, without loss; to "-" in less time and somewhat larger; 0: none */
} RetexStoreParams;
#define RETEX_STORE_INIT                                                                                               \
    {                                                                                                                  \
        sizeof(RetexStoreParams), 1                                                                                    \
    }

/* Read a set from a file or "-". *.retex packs are recognised by content. RETEX_EFORMAT where the file is no set, a
 * checksum of what is read is wrong, or a value is not finite; the part "depth" alone may be infinite. */
int retex_set_read(const char *path, RetexSet **set, int nthreads, RetexError *err);

/* As retex_set_read, but the set's parts stay in the file until they are read from there row by row, by
 * retex_retexture, retex_combine, retex_estimate_error, retex_sample_textures or retex_set_write, or all at once by
 * retex_set_load; every other function that looks at pixels needs them loaded. Checksums are compared when rows are
 * read, so that all of these functions may return RETEX_EFORMAT. The file must stay as it is until the set is closed,
 * and so must parts that retex_set_preload brought into memory: a pack may make its picture from them. Of a pipe that
 * gives more than 64 MiB all is in a temporary file, in $TMPDIR or /tmp. */
int retex_set_open(const char *path, RetexSet **set, int nthreads, RetexError *err);

/* As retex_set_open, but the file may also be one of samples, as retex_set_write_samples writes it: see is_samples of
 * RetexSetInfo. Such a set can be laid on another (retex_set_lay), replaced by the one that it names
 * (retex_set_open_referred), written, described and closed. */
int retex_set_open_any(const char *path, RetexSet **set, int nthreads, RetexError *err);

/* Which level (retex_pack_level) of an open pack is the smallest from which a cut of the picture can be averaged as
 * from the whole set: that has a whole number of pixels for each of the cut's, or at least three times as many to each
 * side. *own is the cut in pixels of that level. -1: there is none, and *own is the cut. */
int retex_set_find_level(const RetexSet *set, const RetexCut *cut, RetexCut *own);
/* The open set becomes that level of it; after a failure it is closed. */
int retex_set_take_level(RetexSet **set, int level, RetexError *err);
/* Open a set for pictures of width x height pixels: the level of it, or where it has none that serves, the whole set,
 * as retex_set_open opens it. */
int retex_set_open_size(const char *path, int width, int height, RetexSet **set, int nthreads, RetexError *err);

/* Bring all parts of a set into memory, and close the files where they were. */
int retex_set_load(RetexSet *set, int nthreads, RetexError *err);
/* Bytes that all parts take in memory. */
uint64_t retex_set_bytes(const RetexSet *set);
/* Load the parts that recombination reads, for several pictures one after the other, if they take at most most_bytes;
 * else they stay where they are. */
int retex_set_preload(RetexSet *set, const int *corrected /* by target: 1: its corrections too; NULL: those of all */,
                      uint64_t most_bytes, int nthreads, RetexError *err);
/* Bytes of the set's parts that retex_set_preload loads with the same `corrected`. */
uint64_t retex_set_preload_bytes(const RetexSet *set, const int *corrected);

/* Write a set under a temporary name renamed when complete, or to "-". CRCs are computed and kept. Of a set with
 * textures laid on it only what recombination needs is written: beauty, terms, what the textures show, and the
 * footprints that have none. Pixels that are still in an open file go through a temporary file near path. But to "-"
 * chunks of an open EXR file are copied as they are stored, with their checksums, which whoever reads the pipe
 * compares. */
int retex_set_write(RetexSet *set, const char *path, const RetexStoreParams *params /* NULL = defaults */,
                    int nthreads /* 0 = all cores */, RetexError *err);
/* Write what the textures show that are laid on a set, without the set: a file of samples. */
int retex_set_write_samples(const RetexSet *set, const char *path, const RetexStoreParams *params /* NULL = defaults */,
                            int nthreads /* 0 = all cores */, RetexError *err);

/* Write the layers of a set, all of which is in memory, as one flat EXR part with channels NAME.R, NAME.G and so on,
 * for programs that do not read files of several parts: every part of the picture's size, but for what denoising reads
 * and for what is 0 everywhere. Mean UV has u in R, v in G, and in B 1 where coverage is above 0. Layers of two
 * channels get a third one of zeros. */
int retex_set_write_layers(const RetexSet *set, const char *path, int nthreads /* 0 = all cores */, RetexError *err);

/* One row of a part's image as retex_set_write would store it: samples of that type in the order of letters, pixel by
 * pixel, in this machine's byte order. Halves are rounded to the nearest; finite values beyond 65504 become 65504. */
void retex_image_stored_row(const RetexImage *image, RetexPixelType type, int y, void *samples);

/* Compute the checksums of parts, all of which are in memory, as retex_set_write does, for rows that are stored by
 * other means with the manifest of retex_set_manifest. */
int retex_set_checksum(RetexSet *set, int nthreads /* 0 = all cores */, RetexError *err);

/* Compare every part's stored CRC with its data, and the manifest's own CRC with its text: 0, or RETEX_EFORMAT naming
 * the first damaged part. */
int retex_set_check(const char *path, int nthreads, RetexError *err);

/* The manifest as JSON text; the caller frees it with free(). */
int retex_set_manifest(const RetexSet *set, char **json, RetexError *err);
/* The manifest of the set with another picture as part 0, of floats. The checksums of the other parts are known. */
int retex_set_picture_manifest(const RetexSet *set, const RetexImage *picture, char **json,
                               int nthreads /* 0 = all cores */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
