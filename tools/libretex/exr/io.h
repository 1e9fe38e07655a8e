/* Multi-part OpenEXR files through OpenEXRCore: writing flat parts, and reading any flat part by channel name.
 *
 * Part 0 of what is written has plain channels (R,G,B), every other part has `NAME.R` and so on; all parts share the
 * display window, each has its own data window beginning at 0,0. */
#ifndef RETEX_EXR_IO_H
#define RETEX_EXR_IO_H

#include <stdint.h>
#include <retex/image.h>
#include <retex/host/band_store.h>
#include <retex/set.h>

#include "exr/color_tag.h"
#include "exr/chunk.h"
#include "io/input.h"
#include "base/value_check.h"

enum {
    RETEX_EXR_PARTS_MAX = 2048,
    RETEX_EXR_NAME_MAX = 192 /* bytes of a part or channel name, with the final NUL */
};

/* How much time compression takes. Nothing is lost by any. */
typedef enum RetexExrCompression {
    RETEX_EXR_PLAIN,  /* none */
    RETEX_EXR_SMALL,  /* for files */
    RETEX_EXR_QUICKLY /* for pipes: larger, in less time */
} RetexExrCompression;

/* A part to write. */
typedef struct RetexExrPart {
    char name[RETEX_EXR_NAME_MAX];           /* unique in the file */
    char letters[RETEX_EXR_LETTERS_MAX + 1]; /* one for each channel of image, in its order */
    RetexPixelType type;                     /* how samples are stored; see base/half.h for what becomes of floats */
    const RetexImage *image;                 /* borrowed until the encoding is freed, as is: */
    const RetexBandStore *store;             /* holds the pixels if image has none, */
    int store_image;                         /* as its image of this number; or */
    const struct RetexExrStored *stored;     /* its chunks in another file, which are copied; only if compressed */
    uint32_t crc;                            /* filled by retex_exr_encode: see RetexPart */
    const RetexColorTag *color;              /* colours for its header, or NULL; borrowed as image is */
} RetexExrPart;

/* All chunks of a file, converted and compressed, in memory or in a band store, so that checksums are known before the
 * header is written. */
typedef struct RetexExrEncoding RetexExrEncoding;

int retex_exr_encode(RetexExrEncoding **encoding, RetexExrPart *parts, int nparts, RetexExrCompression compress,
                     int nthreads, RetexError *err);
/* The same for a file of one part whose rows come later; image->pixels is NULL. Rows may come from any thread and in
 * any order, whole chunks each, every chunk once. The checksum is not computed. */
int retex_exr_encoding_open(RetexExrEncoding **encoding, const RetexExrPart *part, int compress, RetexError *err);
int retex_exr_encode_rows(RetexExrEncoding *encoding, int y0, int y1, const float *rows, RetexError *err);
/* The checksums of bands of a part that was encoded whole: one for each RETEX_CHUNK_LINES lines, computed as
 * RetexPart.crc is. For the caller to free; NULL where memory is short. */
uint32_t *retex_exr_band_crcs(const RetexExrEncoding *encoding, int part);
/* Write to path ("-" = standard output) front to back; attribute (a string of part 0) may be NULL. Consumes encoding:
 * chunks are freed as they are written. width, height: the display window. */
int retex_exr_write(RetexExrEncoding *encoding, int width, int height, const char *attribute, const char *value,
                    const char *path, RetexError *err);
void retex_exr_encoding_free(RetexExrEncoding **encoding);
/* The header of a compressed file of one part, up to its table of chunks of RETEX_CHUNK_LINES lines; to be freed. */
int retex_exr_header(unsigned char **header, size_t *bytes, const RetexExrPart *part, RetexError *err);

/* An EXR file opened for reading. */
typedef struct RetexExr RetexExr;

int retex_exr_probe(const RetexInput *input); /* 1 if it begins like an EXR */
int retex_exr_open(RetexExr **exr, RetexInput *input /* borrowed */, RetexError *err);
void retex_exr_close(RetexExr **exr);
int retex_exr_part_count(const RetexExr *exr);
int retex_exr_find_part(const RetexExr *exr, const char *name);                   /* index or -1 */
void retex_exr_part_size(const RetexExr *exr, int part, int *width, int *height); /* of the data window */
/* 1 if the part can be decoded; else 0, and *reason says why not. */
int retex_exr_part_readable(const RetexExr *exr, int part, const char **reason);
const char *retex_exr_part_name(const RetexExr *exr, int part); /* "" where it has none */
int retex_exr_channel_count(const RetexExr *exr, int part);
const char *retex_exr_channel_name(const RetexExr *exr, int part, int channel); /* in the file's order */
int retex_exr_has_channel(const RetexExr *exr, int part, const char *channel);
int retex_exr_channel_type(const RetexExr *exr, int part, const char *channel, RetexPixelType *type); /* 0: another */
/* Value of a string attribute, owned by exr; NULL where there is none. */
const char *retex_exr_attribute(const RetexExr *exr, int part, const char *name);
/* The colours that the part's header names; all 0 where it names none. */
void retex_exr_color_tag(const RetexExr *exr, int part, RetexColorTag *tag);

/* Channels of one part to read into an image that has the part's size. Channel i of the image receives channels[i];
 * with "" it is not changed. */
typedef struct RetexExrRequest {
    int part;
    RetexImage *image;
    char channels[RETEX_EXR_LETTERS_MAX][RETEX_EXR_NAME_MAX];
    int with_crc; /* 1: also compute crc (see RetexPart) over the channels asked for */
    uint32_t crc;
    uint32_t expected;          /* the expected crc, for the caller and for set/exr_source.c, which also uses: */
    const uint32_t *bands;      /* borrowed: as from retex_exr_band_crcs; NULL: not known */
    RetexAllowedValues allowed; /* other values make the reading fail; default: any */
    int damaged;                /* 1: reading failed at this part */
} RetexExrRequest;

/* Read all requests. image may be NULL where only the crc is wanted. */
int retex_exr_read(RetexExr *exr, RetexExrRequest *requests, int nrequests, int nthreads, RetexError *err);

/* The limit on bytes that the pixels of one file may take in memory. */
#define RETEX_EXR_MEMORY_MAX ((uint64_t)16 << 30)

#endif
