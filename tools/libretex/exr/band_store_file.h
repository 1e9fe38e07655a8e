/* The file of a band store: a header, then records, each followed by its bytes. Nothing in the file is changed once it
 * is written, and there is one writer at a time, so that the file is complete up to some record whenever the process
 * ends. Numbers are in the machine's byte order: a checkpoint cannot be used on a machine of another kind, and is
 * refused there. */
#ifndef RETEX_EXR_BAND_STORE_FILE_H
#define RETEX_EXR_BAND_STORE_FILE_H

#include <pthread.h>
#include <stdatomic.h>
#include <retex/host/band_stats.h>

#include "base/part_name.h"
#include "exr/band_store_chunks.h"
#include "io/temporary.h"

typedef struct RetexBandStoreImage {
    char letters[8], name[RETEX_NAME_MAX];
    RetexPixelType type;
    atomic_int filled;        /* 1: some pixel is not 0 */
    RetexBandStoreChunk chunks[]; /* by band */
} RetexBandStoreImage;

/* What threads compress and decompress with, which is no part of what a store has. */
typedef struct RetexBandStorePool {
    pthread_mutex_t lock;
    struct RetexBandStoreScratch *unused; /* a list, under lock */
} RetexBandStorePool;

struct RetexBandStore {
    int width, height, nbands;
    uint64_t key;
    int descriptor;
    int plain;           /* 1: bands are not compressed */
    int fast;            /* 1: they are compressed fast, by ZIP */
    RetexTemporaryName shown; /* the file's name, for messages */
    RetexBandStorePool *pool;
    RetexBandStats *stats;     /* by band, valid */
    char *committed;           /* where committed is 1 */
    pthread_mutex_t lock;
    uint64_t end;                 /* end of the file; under lock, as are: */
    uint32_t last_crc;            /* of the last record, or of the header */
    int nimages;
    RetexBandStoreImage *images[RETEX_SET_PARTS_MAX];
};

enum {
    BAND_STORE_IMAGE = 0x67616d69, /* a RetexBandStoreDescription */
    BAND_STORE_CHUNK = 0x6b6e6863, /* what retex_chunk_compress gives, by ZIP */
    BAND_STORE_PXR24 = 0x34327270, /* the same, by PXR24 */
    BAND_STORE_COMMIT = 0x646e6162 /* followed by a RetexBandStats; commits the band with all its chunks so far */
};

typedef struct RetexBandStoreRecord {
    uint32_t kind, image, band, bytes, nonzero;
    uint32_t crc[RETEX_EXR_LETTERS_MAX];
    uint32_t bytes_crc, record_crc; /* bytes_crc: of the bytes that follow; record_crc: of all members before it,
                                       continuing that of the last record */
} RetexBandStoreRecord;

typedef struct RetexBandStoreDescription {
    char name[RETEX_NAME_MAX], letters[8];
    uint32_t type;
} RetexBandStoreDescription;

RetexBandStoreImage *retex_band_store_image_new(const RetexBandStore *store, const char *name, const char *letters,
                                                RetexPixelType type);
RetexChunkShape retex_band_store_shape(const RetexBandStore *store, const RetexBandStoreImage *image, int band);

/* Write all bytes; returns 0 or an errno. */
int retex_band_store_write_at(int descriptor, const void *data, size_t bytes, uint64_t offset);

/* Write the header of a new file. */
int retex_band_store_begin(RetexBandStore *store, RetexError *err);
/* Read what was committed. Writes the header if the file is empty, and cuts off bands that were not committed. */
int retex_band_store_recover(RetexBandStore *store, RetexError *err);

/* Fill in the checksums of a record and append it, under the lock; *offset (may be NULL) receives the position of its
 * bytes. */
int retex_band_store_append(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes, uint64_t *offset,
                            RetexError *err);
/* Add an image, which the band store owns from now on; under the lock. */
int retex_band_store_add_image(RetexBandStore *store, RetexBandStoreImage *image, RetexError *err);
/* Append a chunk and enter it into the index. */
int retex_band_store_append_chunk(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes,
                                  RetexError *err);

#endif
