/* The format of packs, shared by writer and readers: codecs, parts, slices, manifest. retex-pack(5) describes it. */
#ifndef RETEX_PACK_FORMAT_H
#define RETEX_PACK_FORMAT_H

#include <jansson.h>

#include <retex/pack.h>

#include "pack/jpeg.h"
#include "pack/planes.h"

#define RETEX_PACK_MANIFEST_NAME "manifest.json"
#define RETEX_PACK_INDEX_NAME "index"
#define RETEX_PACK_PICTURE_NAME "picture.jpg"
#define RETEX_PACK_MANIFEST_MAX (64u << 20) /* bytes */
#define RETEX_PACK_LEVELS_MAX 8
#define RETEX_PACK_LEVEL_SCALE_MAX 8
enum {
    RETEX_PACK_CHANNELS_MAX = 8,
    RETEX_PACK_INDEX_ENTRY_BYTES = 8 /* bytes: size and CRC-32 of a slice, little-endian */
};

typedef enum RetexPackCodec {
    RETEX_PACK_ZERO,   /* every sample is +0: no data */
    RETEX_PACK_PLANES, /* planes/NAME.blk: one slice for each strip and channel */
    RETEX_PACK_JPEG,   /* radiance/NAME.jpg: header, one slice for each strip; planes/NAME.blk: the mask's strips */
    RETEX_PACK_CODECS
} RetexPackCodec;

/* Codec, quantizer and slices of a part. */
typedef struct RetexPackPart {
    RetexPackCodec codec;
    int width, height, channels, nstrips;
    RetexPixelType type;
    RetexPackMap maps[RETEX_PACK_CHANNELS_MAX]; /* planes */
    int present;          /* planes: the part whose third channel (coverage) is 0 where pixels are absent, or -1 */
    int sigma;            /* with RETEX_PACK_MAP_LATTICE: the part of the standard deviations, or -1 */
    int sigma_first;      /* planes: means whose deviation has code c have shift (c - 1 + sigma_first) / per_octave */
    int wraps[2];         /* planes of steps, when reading: whether u and v are periodic */
    RetexPackCurve curve; /* JPEG */
    double jpeg_step;     /* when writing */
    int masked;           /* JPEG: 1 = there is a mask; a set bit means that the pixel is exactly black */
    int nslices;
    uint64_t *offsets; /* of slices in the file, when reading */
    uint32_t *bytes, *crcs;
} RetexPackPart;

/* Initialize with the sizes and the type of a part of the set. */
void retex_pack_part_begin(RetexPackPart *packed, const RetexPart *part);
/* Set nslices by codec and size; allocate bytes and crcs. */
int retex_pack_part_slices(RetexPackPart *packed, RetexError *err);
void retex_pack_part_free(RetexPackPart *packed);

int retex_pack_strip_rows(const RetexPackPart *packed, int strip); /* 64, or fewer in the last one */
/* The lattice's shift for a mean whose standard deviation has this code. */
int retex_pack_lattice_shift(const RetexPackPart *packed, int code, int per_octave);
/* Bytes of a mask's row. */
int retex_pack_mask_width(const RetexPackPart *packed);
/* The name of the ZIP entry with a part's slices. planes: 0 = of its JPEG, 1 = of its planes. */
void retex_pack_file_name(char *name, size_t size, const RetexSet *set, int part, int planes);

/* Fail with RETEX_EFORMAT: what is wrong, and with which part or entry of the file. */
int retex_pack_damaged(RetexError *err, const char *what, const char *name);

/* CRC-32 of a part's samples in their stored type: see RetexPart. */
int retex_pack_samples_crc(uint32_t *crc, const RetexPart *part, RetexError *err);

/* A curve's white in manifests, of pages too: one number, or one for each channel. */
json_t *retex_pack_describe_white(const RetexPackCurve *curve);

/* Smaller sets in a pack: how many times smaller they are, from the largest on, 2..RETEX_PACK_LEVEL_SCALE_MAX. */
typedef struct RetexPackScales {
    int count, of[RETEX_PACK_LEVELS_MAX];
} RetexPackScales;
/* The name of the ZIP entry with a smaller set, a pack. */
void retex_pack_level_name(char *name, size_t size, int scale);

/* Write packed[set->nparts] as the key "pack" into the manifest's text, and parse it. promise: figures of the loss, or
 * NULL. levels: NULL: there are none. */
char *retex_pack_describe(const char *manifest, const RetexSet *set, const RetexPackPart *packed,
                          const RetexPackPromise *promise, const RetexPackScales *levels);
int retex_pack_parse(RetexPackPart *packed, const RetexSet *set, const char *manifest, RetexError *err);
/* Read the figures of the loss from the manifest. Returns 1, or 0 if they are missing or invalid. */
int retex_pack_promise_of(RetexPackPromise *promise, const char *manifest);
/* Read which smaller sets there are. */
int retex_pack_levels_of(RetexPackScales *levels, const char *manifest, RetexError *err);

#endif
