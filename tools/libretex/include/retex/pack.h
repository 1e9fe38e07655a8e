/* Packing: a set as one small file, `.retex`: a zip with the manifest, light and albedo as JPEG, and footprints rounded
 * to far below what can be seen, all of it in bands of rows that can be read alone. See retex-pack(5). */
#ifndef RETEX_PACK_H
#define RETEX_PACK_H

#include <retex/set.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_PACK_INIT. */
typedef struct RetexPackParams {
    size_t size;
    int quality;   /* 1..100: pictures made of the pack have 20 + 0.4 * quality dB against the set's; default 90 */
    int lossless;  /* 1: every part is packed and keeps its stored bits; default 0 */
    int nthreads;  /* 0 = all cores */
} RetexPackParams;
#define RETEX_PACK_INIT { sizeof(RetexPackParams), 90, 0, 0 }

/* Write set as a pack; "-" is standard output. Unless lossless it is compacted (see compact.h), and is without what
 * only denoising reads (see denoise.h). *bytes (may be NULL) gets the pack's size. */
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
