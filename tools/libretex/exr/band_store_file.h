/* The file of a band store: a header, then records, each with its bytes. Nothing in it is changed once it is written,
 * and there is one writer at a time, so that it is whole up to some record whenever the process ends. Numbers are the
 * machine's: a checkpoint does not travel between machines of different kinds, and says so. */
#ifndef RETEX_EXR_BAND_STORE_FILE_H
#define RETEX_EXR_BAND_STORE_FILE_H

#include <pthread.h>
#include <stdatomic.h>
#include <retex/band_stats.h>

#include "base/part_name.h"
#include "exr/band_store_chunks.h"
#include "io/temporary.h"

typedef struct RetexBandStoreImage {
    char letters[8], name[RETEX_NAME_MAX];
    RetexPixelType type;
    atomic_int filled;        /* a pixel is not 0 */
    RetexBandStoreChunk chunks[]; /* by band */
} RetexBandStoreImage;

struct RetexBandStore {
    int width, height, nbands;
    uint64_t key;
    int descriptor;
    int plain;           /* 1: bands are not compressed */
    RetexTemporaryName shown; /* what the file is, for messages */
    RetexBandStats *stats;     /* by band, */
    char *committed;           /* where this is 1 */
    pthread_mutex_t lock;
    uint64_t end;                 /* under lock, as is: */
    uint32_t last_crc;            /* of the last record, or of the header */
    struct RetexBandStoreScratch *scratch; /* that no thread uses */
    int nimages;
    RetexBandStoreImage *images[RETEX_SET_PARTS_MAX];
};

enum {
    BAND_STORE_IMAGE = 0x67616d69, /* a RetexBandStoreDescription */
    BAND_STORE_CHUNK = 0x6b6e6863, /* what retex_chunk_compress gives */
    BAND_STORE_COMMIT = 0x646e6162 /* a RetexBandStats; what there is of the band so far is all of it */
};

typedef struct RetexBandStoreRecord {
    uint32_t kind, image, band, bytes, lit;
    uint32_t crc[RETEX_EXR_LETTERS_MAX];
    uint32_t bytes_crc, record_crc; /* of the bytes that follow; of all before it, and the last record's */
} RetexBandStoreRecord;

typedef struct RetexBandStoreDescription {
    char name[RETEX_NAME_MAX], letters[8];
    uint32_t type;
} RetexBandStoreDescription;

RetexBandStoreImage *retex_band_store_image_new(const RetexBandStore *store, const char *name, const char *letters,
                                                RetexPixelType type);
RetexChunkShape retex_band_store_shape(const RetexBandStore *store, const RetexBandStoreImage *image, int band);

/* 0 or what errno says. */
int retex_band_store_write_at(int descriptor, const void *data, size_t bytes, uint64_t offset);

/* The header of a new file. */
int retex_band_store_begin(RetexBandStore *store, RetexError *err);
/* Of a file that may be there: all that was committed. make: write the header of an empty one, cut off the rest. */
int retex_band_store_recover(RetexBandStore *store, int make, RetexError *err);

/* Under the lock: fill in the checksums of a record and append it; *offset (may be NULL) is that of its bytes. */
int retex_band_store_append(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes, uint64_t *offset,
                            RetexError *err);
/* Under the lock: an image that is the band store's from now on. */
int retex_band_store_add_image(RetexBandStore *store, RetexBandStoreImage *image, RetexError *err);
/* A chunk, with its place in the index. */
int retex_band_store_append_chunk(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes,
                                  RetexError *err);

#endif
