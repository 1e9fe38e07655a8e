/* What a pack consists of, shared by its writer and its readers; retex-pack(5) describes the format. */
#ifndef RETEX_PACK_FORMAT_H
#define RETEX_PACK_FORMAT_H

#include <retex/pack.h>

#include "pack/jpeg.h"
#include "pack/planes.h"

#define RETEX_PACK_VERSION 2
#define RETEX_PACK_MANIFEST_NAME "manifest.json"
#define RETEX_PACK_INDEX_NAME "index"
#define RETEX_PACK_PICTURE_NAME "picture.jpg"
#define RETEX_PACK_MANIFEST_MAX (64u << 20) /* bytes */
enum {
    RETEX_PACK_CHANNELS_MAX = 8,
    RETEX_PACK_INDEX_ENTRY_BYTES = 8 /* bytes: size and CRC-32 of a chunk, little-endian */
};

typedef enum RetexPackCodec {
    RETEX_PACK_ZERO,     /* every sample is +0: no data */
    RETEX_PACK_PLANES,   /* planes/NAME.blk: band by band one chunk a channel */
    RETEX_PACK_MODEL,    /* planes/NAME.blk: one chunk a band, without loss */
    RETEX_PACK_COMBINED, /* part 0, as RETEX_PACK_MODEL: what differs from the recombination of the set's terms */
    RETEX_PACK_JPEG,     /* radiance/NAME.jpg: header, then a chunk a band; planes/NAME.blk: its mask's bands */
    RETEX_PACK_CODECS
} RetexPackCodec;

extern const char *const retex_pack_codec_names[RETEX_PACK_CODECS];

/* How a part is packed. */
typedef struct RetexPackPart {
    RetexPackCodec codec;
    int width, height, channels, nbands;
    RetexPixelType type;
    RetexPackMap maps[RETEX_PACK_CHANNELS_MAX]; /* planes */
    int present;          /* planes: the part whose third channel is 0 where this one's mean nothing; -1 */
    int sigma;            /* with RETEX_PACK_MAP_LATTICE: the part of their standard deviations; -1 */
    int sigma_first;      /* planes: code c: multiples of 2^((c - 1 + sigma_first) / per_octave) */
    RetexPackCurve curve; /* JPEG */
    double jpeg_step;     /* when writing */
    int masked;           /* JPEG: 1 = pixels whose bit is set are exactly black */
    int nchunks;
    uint64_t *offsets; /* of chunks in the file, when reading */
    uint32_t *bytes, *crcs;
} RetexPackPart;

/* Set sizes from a part of the set, and nothing else. */
void retex_pack_part_begin(RetexPackPart *packed, const RetexPart *part);
/* Chunks by codec and size; allocates bytes and crcs. */
int retex_pack_part_chunks(RetexPackPart *packed, RetexError *err);
void retex_pack_part_free(RetexPackPart *packed);

int retex_pack_band_rows(const RetexPackPart *packed, int band); /* 64, or fewer in the last one */
/* The shift of a lattice where the standard deviation has this code. */
int retex_pack_lattice_shift(const RetexPackPart *packed, int code, int per_octave);
/* The shift that the rounding of rendered means leaves, where the standard deviation is this. */
int retex_pack_mean_shift(float sigma);
/* Bytes of a mask's row. */
int retex_pack_mask_width(const RetexPackPart *packed);
/* 1: its chunks are bands that a model codes without loss. */
int retex_pack_is_modelled(const RetexPackPart *packed);
/* The file of a part's chunks in the pack; 0: its JPEG, 1: its planes. */
void retex_pack_file_name(char *name, size_t size, const RetexSet *set, int part, int planes);

/* CRC-32 of a part's samples as they are stored: see RetexPart. */
int retex_pack_samples_crc(uint32_t *crc, const RetexPart *part, RetexError *err);

/* The key "pack" of the manifest's text, and back; packed[set->nparts]. kept: what is said of the loss, or NULL. */
char *retex_pack_describe(const char *manifest, const RetexSet *set, const RetexPackPart *packed,
                          const RetexPackKept *kept);
int retex_pack_parse(RetexPackPart *packed, const RetexSet *set, const char *manifest, RetexError *err);
/* What it says of the loss; 1, or 0 where it says nothing, or nothing sound. */
int retex_pack_kept_of(RetexPackKept *kept, const char *manifest);
/* The manifest's version of the format, or 0. */
int retex_pack_version_of(const char *manifest);

#endif
