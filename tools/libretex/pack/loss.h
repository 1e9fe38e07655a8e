/* The distortion of pictures made from a pack against pictures of its set, and the PSNR that a quality promises.
 * Private to libretex; retex-pack(1) states the promise. */
#ifndef RETEX_PACK_LOSS_H
#define RETEX_PACK_LOSS_H

#include <stdint.h>

#include <retex/pack.h>

/* A set's pictures with trial textures, which those of packs are compared with. */
typedef struct RetexPackReference {
    const RetexSet *set;
    double noise;                       /* of the set's picture, mean square of display values, by what denoising
                                           reads; 0 where that is not there, or was used up */
    uint16_t *codes[RETEX_PACK_LOSSES]; /* sRGB-encoded, width x height x 3; NULL: not made */
    uint64_t *squares;                  /* scratch: sums of squared errors by strip */
} RetexPackReference;

/* Which pictures are made: bits 1 << RETEX_PACK_LOSS_*. Those that are promised take half of the time of all; waves
 * lose less than squares. */
#define RETEX_PACK_ALL_PICTURES ((1u << RETEX_PACK_LOSSES) - 1)
#define RETEX_PACK_PROMISED_PICTURES (RETEX_PACK_ALL_PICTURES & ~(1u << RETEX_PACK_LOSS_WAVES))

int retex_pack_reference_open(RetexPackReference *reference, const RetexSet *set, unsigned pictures, int nthreads,
                              RetexError *err);
void retex_pack_reference_close(RetexPackReference *reference); /* one that is all zeros is fine */

/* PSNR of each picture made from a pack, at most 120 dB; 120 for pictures that are not made. Not thread-safe. */
int retex_pack_reference_psnr(double psnr[RETEX_PACK_LOSSES], const RetexPackReference *reference, const RetexSet *pack,
                              int nthreads, RetexError *err);
double retex_pack_worst_psnr(const double psnr[RETEX_PACK_LOSSES]);

/* The least PSNR of the worst picture at a quality of 1 to 100. It is lower with few samples a pixel (spp), which leave
 * noise in footprints that packing removes. noise: RetexPackReference's. */
double retex_pack_promised_psnr(int quality, int spp, double noise);

#endif
