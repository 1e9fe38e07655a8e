/* How one part of a set becomes bytes inside a pack, and back. Private to libretex; described in retex-pack(5). */
#ifndef LIBRETEX_PACK_CODEC_H
#define LIBRETEX_PACK_CODEC_H

#include <stdint.h>
#include <retex/set.h>

typedef enum RetexPackCodec {
    RETEX_PACK_ZERO,   /* every sample is +0: no data */
    RETEX_PACK_PLANES, /* the stored samples, channel by channel, bytes regrouped by significance, deflated */
    RETEX_PACK_LOG,    /* JPEG of log2(1 + x/scale) / log2(1 + max/scale) */
    RETEX_PACK_SRGB,   /* JPEG of sRGB-encoded values; all in [0,1] */
    RETEX_PACK_CODECS
} RetexPackCodec;

extern const char *const retex_pack_codec_names[RETEX_PACK_CODECS]; /* as in the manifest */

/* A part, encoded. data and mask are malloc'ed by encode; decode borrows them. */
typedef struct RetexPacked {
    RetexPackCodec codec;
    unsigned char *data;
    size_t bytes;
    unsigned char *mask; /* JPEGs: one bit a pixel, 1 = all channels are exactly 0, deflated; NULL where none is */
    size_t mask_bytes;
    double scale, max;   /* RETEX_PACK_LOG */
    uint32_t crc;        /* of the stored samples that were encoded (see RetexPart) */
    double gain[3];      /* JPEGs: what decoded channels are multiplied by, so that their means are kept */
} RetexPacked;

/* Encode with the codec wanted; where it does not suit the part (channels, range, size) another that loses nothing is
 * taken instead, and *packed says so. quality: of the JPEGs. mean: RETEX_PACK_LOG need not resolve values far below
 * this mean, which is that of the picture the part is one summand of; 0 = that of the part alone. */
int retex_pack_encode(RetexPacked *packed, const RetexPart *part, RetexPackCodec wanted, int quality, double mean,
                      RetexError *err);
/* Mean of all samples that are not 0; 0 where there are none or some are negative or not finite. */
double retex_pack_mean(const RetexImage *im);
void retex_packed_free(RetexPacked *packed);

/* Decode into part, whose name, letters, type and image size are set and whose image is allocated and zeroed. Sets
 * part->crc, of the stored samples. */
int retex_pack_decode(RetexPart *part, const RetexPacked *packed, RetexError *err);

/* The smallest number of encoded bytes that could hold a part of this size: less is damage (or an attempt to make the
 * reader allocate). */
size_t retex_pack_least_bytes(RetexPackCodec codec, const RetexPart *part, int width, int height);

#endif
