/* Packing: a set as one small file, `.retex`: a zip with the manifest, radiance and albedo as JPEG, and
 * footprints rounded to far below what can be seen. See retex-pack(5). */
#ifndef RETEX_PACK_H
#define RETEX_PACK_H

#include <retex/set.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_PACK_INIT. */
typedef struct RetexPackParams {
    size_t size;
    int quality;   /* of the JPEGs, 1..100; default 98 */
    int lossless;  /* 1: every part that is packed keeps its stored bits; default 0 */
    int nthreads;  /* 0 = all cores */
} RetexPackParams;
#define RETEX_PACK_INIT { sizeof(RetexPackParams), 98, 0, 0 }

/* Write set as a pack, without what only denoising reads (see denoise.h); "-" is standard output. *bytes (may be NULL)
 * gets the pack's size. */
int retex_pack_write(const RetexSet *set, const char *path, const RetexPackParams *params /* NULL = defaults */,
                     size_t *bytes, RetexError *err);
/* Read a pack from memory (the whole file). retex_set_read calls it when it finds a pack. */
int retex_pack_read(const void *data, size_t bytes, RetexSet **set, int nthreads, RetexError *err);
/* 1 if the bytes begin like a pack (a zip's first local header). */
int retex_pack_probe(const void *data, size_t bytes);
/* Compare the checksums inside a pack with its data. */
int retex_pack_check(const void *data, size_t bytes, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
