/* What pictures made from a pack lose against those of the set it was made of, and what the quality promises of that.
 * Private to libretex; retex-pack(1) states the promise. */
#ifndef RETEX_PACK_LOSS_H
#define RETEX_PACK_LOSS_H

#include <stdint.h>

#include <retex/pack.h>

/* A set's pictures with the textures of trials, to compare those of packs with. */
typedef struct RetexPackReference {
    const RetexSet *set;
    double noise;                       /* of the set's picture, mean square of display values, by what denoising
                                           reads; 0 where that is not there, or was used up */
    uint16_t *codes[RETEX_PACK_LOSSES]; /* sRGB-encoded, width x height x 3; NULL: not made */
    uint64_t *squares;                  /* room for sums by band */
} RetexPackReference;

/* Which pictures are made: bits 1 << RETEX_PACK_LOSS_*. Those that are promised take half of the time of all; waves
 * lose less than squares. */
#define RETEX_PACK_ALL_PICTURES ((1u << RETEX_PACK_LOSSES) - 1)
#define RETEX_PACK_PROMISED_PICTURES (RETEX_PACK_ALL_PICTURES & ~(1u << RETEX_PACK_LOSS_WAVES))

int retex_pack_reference_open(RetexPackReference *reference, const RetexSet *set, unsigned pictures, int nthreads,
                              RetexError *err);
void retex_pack_reference_close(RetexPackReference *reference); /* one that is all zeros is fine */

/* Decibels of each picture made from a pack, at most 120, which those have that are not made; not from two threads at
 * once. */
int retex_pack_reference_psnr(double psnr[RETEX_PACK_LOSSES], const RetexPackReference *reference, const RetexSet *pack,
                              int nthreads, RetexError *err);
double retex_pack_worst_psnr(const double psnr[RETEX_PACK_LOSSES]);

/* Decibels that the worst of these pictures has at least, at a quality of 1 to 100; spp: samples a pixel, of which few
 * leave noise in footprints, denoised or not, that packing takes away; noise: RetexPackReference's. */
double retex_pack_promised_psnr(int quality, int spp, double noise);

#endif
