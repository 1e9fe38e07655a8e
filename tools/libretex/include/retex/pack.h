/* Packing: a set as one small file, `.retex`: a zip with the manifest, light and albedo as JPEG, and footprints rounded
 * to far below what can be seen, all of it in strips of rows that can be read alone. See retex-pack(5). */
#ifndef RETEX_PACK_H
#define RETEX_PACK_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_PACK_INIT. */
typedef struct RetexPackParams {
    size_t size;
    int quality;   /* 1..100, default 90: what pictures made of the pack lose at most, see retex-pack(1) */
    int lossless;  /* 1: every part is packed and keeps its stored bits; default 0 */
    RetexWarn *warn; /* told, in the calling thread, why a set takes more room; default NULL = nobody */
    void *warn_context;
    int levels; /* 1: smaller sets are beside it, for smaller pictures (see retex_set_open_size): of a third, a
                   quarter, a sixth and an eighth of the size, but not less than RETEX_PACK_LEVEL_WIDTH pixels
                   wide. They are made by retex_set_reduce and have the quality of the pack, of a lossless one 90,
                   or up to 20 less, so that they take at most a third of its bytes. Default 0 */
} RetexPackParams;
#define RETEX_PACK_INIT { sizeof(RetexPackParams), 90, 0, NULL, NULL, 0 }
#define RETEX_PACK_LEVEL_WIDTH 160

/* Write set as a pack; "-" is standard output. Unless lossless it is compacted, as retex-pack(5) describes, and is
 * without what only denoising reads (see denoise.h); then pictures are made of it and of the set, and where they differ
 * more than the quality promises it is packed anew, finer. *bytes (may be NULL) gets the pack's size. */
int retex_pack_write(const RetexSet *set, const char *path, const RetexPackParams *params /* NULL = defaults */,
                     size_t *bytes, int nthreads /* 0 = all cores */, RetexError *err);
/* 1 if the bytes begin like a pack (a zip's first local header). */
int retex_pack_probe(const void *data, size_t bytes);

/* What a pack's parts are for. A later version may add uses. */
typedef enum RetexPackUse {
    RETEX_PACK_PICTURE, RETEX_PACK_RADIANCE, RETEX_PACK_GAINS, RETEX_PACK_UV, RETEX_PACK_SPREAD, RETEX_PACK_WEIGHTS,
    RETEX_PACK_ALBEDO, RETEX_PACK_ORIGINALS, RETEX_PACK_OTHER, RETEX_PACK_USES
} RetexPackUse;
/* "picture", "radiance" and so on; NULL where there is no such use. */
const char *retex_pack_use_name(int use);
/* Bytes of the pack's parts by their use, of the first nuses: RETEX_PACK_USES. A zip's directory, the manifest and the
 * like are not among them. RETEX_ENOTFOUND where the set is not that of a pack which retex_set_open opened. */
int retex_pack_bytes(uint64_t *bytes, int nuses, const RetexSet *set, RetexError *err);

/* A smaller set in a pack. A later version may add members at the end. */
typedef struct RetexPackLevel {
    size_t size;       /* sizeof(RetexPackLevel) */
    int width, height; /* pixels */
    int scale;         /* how many times smaller it is: 2 to 8 */
    uint64_t bytes;    /* in the pack */
} RetexPackLevel;
/* Fill what level->size says that the caller knows of smaller set number `index`, the largest first. Returns 1, or 0
 * where there is no such, or the set is not that of a pack which retex_set_open opened. */
int retex_pack_level(RetexPackLevel *level, const RetexSet *set, int index);

/* What a pack with losses says of them: quality, and of the worst picture of those of retex_pack_loss, when it was
 * packed, the PSNR that was promised and what it was. */
typedef struct RetexPackPromise {
    int quality;
    double promised, measured; /* dB */
} RetexPackPromise;
/* RETEX_ENOTFOUND where the set is not that of such a pack which retex_set_open opened, or it does not say. */
int retex_pack_promise(RetexPackPromise *promise, const RetexSet *set, RetexError *err);

/* PSNR (see metrics.h), to 16 bits, of pictures made from a pack against those from the set it was made of: with the
 * original textures, and with all targets white, of smooth waves, and of a black and white chequerboard: of the first
 * npictures of these, RETEX_PACK_LOSSES. A later version may add pictures. */
enum {
    RETEX_PACK_LOSS_ORIGINAL, RETEX_PACK_LOSS_WHITE, RETEX_PACK_LOSS_WAVES, RETEX_PACK_LOSS_SQUARES, RETEX_PACK_LOSSES
};
int retex_pack_loss(double *psnr, int npictures, const RetexSet *pack, const RetexSet *set, int nthreads,
                    RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
