/* What a pack consists of, shared by its writer and its readers; retex-pack(5) describes the format. */
#ifndef RETEX_PACK_FORMAT_H
#define RETEX_PACK_FORMAT_H

#include <retex/pack.h>

#include "pack/jpeg.h"
#include "pack/planes.h"

#define PACK_VERSION 2
#define PACK_MANIFEST "manifest.json"
#define PACK_INDEX "index"
#define PACK_PICTURE "picture.jpg"
#define PACK_MANIFEST_MAX (64u << 20) /* bytes */
enum { PACK_CHANNELS_MAX = 8, PACK_INDEX_ENTRY = 8 /* bytes: size and CRC-32 of a chunk, little-endian */ };

typedef enum PackCodec {
    PACK_ZERO,   /* every sample is +0: no data */
    PACK_PLANES, /* planes/NAME.blk: band by band one chunk a channel */
    PACK_MODEL,  /* planes/NAME.blk: one chunk a band, without loss */
    PACK_COMBINED, /* part 0, as PACK_MODEL: what differs from the recombination of the set's terms */
    PACK_JPEG,   /* radiance/NAME.jpg: header, then a chunk a band; planes/NAME.blk: its mask's bands */
    PACK_CODECS
} PackCodec;

extern const char *const pack_codec_names[PACK_CODECS];

/* How a part is packed. */
typedef struct PackPart {
    PackCodec codec;
    int width, height, channels, nbands;
    RetexPixelType type;
    PackMap maps[PACK_CHANNELS_MAX]; /* planes */
    int present;                     /* planes: the part whose third channel is 0 where this one's mean nothing; -1 */
    int sigma;                       /* with PACK_MAP_LATTICE: the part of their standard deviations; -1 */
    int sigma_first;                 /* planes: code c: multiples of 2^((c - 1 + sigma_first) / per_octave) */
    PackCurve curve;                 /* JPEG */
    double jpeg_step;                /* when writing */
    int masked;                      /* JPEG: 1 = pixels whose bit is set are exactly black */
    int nchunks;
    uint64_t *offsets; /* of chunks in the file, when reading */
    uint32_t *bytes, *crcs;
} PackPart;

/* Set sizes from a part of the set, and nothing else. */
void pack_part_begin(PackPart *packed, const RetexPart *part);
/* Chunks by codec and size; allocates bytes and crcs. */
int pack_part_chunks(PackPart *packed, RetexError *err);
void pack_part_free(PackPart *packed);

int pack_band_rows(const PackPart *packed, int band); /* 64, or fewer in the last one */
/* The shift of a lattice where the standard deviation has this code. */
int pack_lattice_shift(const PackPart *packed, int code, int per_octave);
/* The shift that the rounding of rendered means leaves, where the standard deviation is this. */
int pack_mean_shift(float sigma);
/* Bytes of a mask's row. */
int pack_mask_width(const PackPart *packed);
/* 1: its chunks are bands that a model codes without loss. */
int pack_is_modelled(const PackPart *packed);
/* The file of a part's chunks in the pack; 0: its JPEG, 1: its planes. */
void pack_file_name(char *name, size_t room, const RetexSet *set, int part, int planes);

/* CRC-32 of a part's samples as they are stored: see RetexPart. */
int pack_samples_crc(uint32_t *crc, const RetexPart *part, RetexError *err);

/* The key "pack" of the manifest's text, and back; packed[set->nparts]. kept: what is said of the loss, or NULL. */
char *pack_describe(const char *manifest, const RetexSet *set, const PackPart *packed, const RetexPackKept *kept);
int pack_understand(PackPart *packed, const RetexSet *set, const char *manifest, RetexError *err);
/* What it says of the loss; 1, or 0 where it says nothing, or nothing sound. */
int pack_kept_of(RetexPackKept *kept, const char *manifest);
/* The manifest's version of the format, or 0. */
int pack_version_of(const char *manifest);

#endif
