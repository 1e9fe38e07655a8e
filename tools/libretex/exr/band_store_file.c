/* See band_store_file.h. */
#include "exr/band_store_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "io/checksum.h"

static const char MAGIC[8] = "retex\n\032\001"; /* the last byte is the version */

typedef struct Header {
    char magic[8];
    uint32_t order, stats_bytes; /* 0x01020304; sizeof(RetexBandStats) */
    uint64_t key;
    uint32_t width, height;
} Header;

int retex_band_store_probe(const void *begin, size_t bytes)
{
    return bytes >= sizeof MAGIC && memcmp(begin, MAGIC, sizeof MAGIC - 1) == 0;
}

RetexBandStoreImage *retex_band_store_image_new(const RetexBandStore *store, const char *name, const char *letters,
                                                RetexPixelType type)
{
    RetexBandStoreImage *image = calloc(1, sizeof *image + (size_t)store->nbands * sizeof *image->chunks);

    if (!image)
        return NULL;
    snprintf(image->name, sizeof image->name, "%s", name);
    snprintf(image->letters, sizeof image->letters, "%s", letters);
    image->type = type;
    return image;
}

RetexChunkShape retex_band_store_shape(const RetexBandStore *store, const RetexBandStoreImage *image, int band)
{
    const int left = store->height - band * RETEX_BAND_ROWS;

    return (RetexChunkShape){image->letters, image->type, store->width,
                             left < RETEX_BAND_ROWS ? left : RETEX_BAND_ROWS};
}

static uint32_t crc_of(const void *data, size_t bytes)
{
    return retex_crc32(CRC32_OF_NONE, data, bytes);
}

/* The checksum of a record continues that of the record before, so that a missing or repeated record is noticed. */
static uint32_t record_crc(const RetexBandStoreRecord *record, uint32_t last)
{
    return retex_crc32(last, record, offsetof(RetexBandStoreRecord, record_crc));
}

/* --- writing --- */

int retex_band_store_write_at(int descriptor, const void *data, size_t bytes, uint64_t offset)
{
    const unsigned char *from = data;

    while (bytes) {
        const ssize_t written = pwrite(descriptor, from, bytes, (off_t)offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : EIO;
        from += written;
        offset += (uint64_t)written;
        bytes -= (size_t)written;
    }
    return 0;
}

static int fail_write(const RetexBandStore *store, int code, RetexError *err)
{
    return code ? retex_fail(err, RETEX_EIO, "cannot write %s: %s", store->shown, strerror(code)) : 0;
}

static Header header_of(const RetexBandStore *store)
{
    Header header = {.order = 0x01020304,
                     .stats_bytes = sizeof(RetexBandStats),
                     .key = store->key,
                     .width = (uint32_t)store->width,
                     .height = (uint32_t)store->height};

    memcpy(header.magic, MAGIC, sizeof MAGIC);
    return header;
}

int retex_band_store_begin(RetexBandStore *store, RetexError *err)
{
    const Header header = header_of(store);

    store->end = sizeof header;
    store->last_crc = crc_of(&header, sizeof header);
    return fail_write(store, retex_band_store_write_at(store->descriptor, &header, sizeof header, 0), err);
}

int retex_band_store_append(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes, uint64_t *offset,
                            RetexError *err)
{
    record->bytes_crc = crc_of(bytes, record->bytes);
    record->record_crc = record_crc(record, store->last_crc);
    int code = retex_band_store_write_at(store->descriptor, record, sizeof *record, store->end);
    if (!code)
        code = retex_band_store_write_at(store->descriptor, bytes, record->bytes, store->end + sizeof *record);
    if (code)
        return fail_write(store, code, err);
    if (offset)
        *offset = store->end + sizeof *record;
    store->end += sizeof *record + record->bytes;
    store->last_crc = record->record_crc;
    return 0;
}

int retex_band_store_add_image(RetexBandStore *store, RetexBandStoreImage *image, RetexError *err)
{
    RetexBandStoreDescription description = {.type = (uint32_t)image->type};
    RetexBandStoreRecord record = {
        .kind = BAND_STORE_IMAGE, .image = (uint32_t)store->nimages, .bytes = sizeof description};

    if (store->nimages == RETEX_SET_PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "a band store has at most %d images", RETEX_SET_PARTS_MAX);
    memcpy(description.name, image->name, sizeof description.name);
    memcpy(description.letters, image->letters, sizeof description.letters);
    const int code = retex_band_store_append(store, &record, &description, NULL, err);
    if (!code)
        store->images[store->nimages++] = image;
    return code;
}

static void index_chunk(RetexBandStore *store, const RetexBandStoreRecord *record, uint64_t offset)
{
    RetexBandStoreChunk *chunk = &store->images[record->image]->chunks[record->band];

    chunk->offset = offset;
    chunk->bytes = record->bytes;
    chunk->nonzero = record->nonzero;
    chunk->pxr24 = record->kind == BAND_STORE_PXR24;
    chunk->bytes_crc = record->bytes_crc;
    memcpy(chunk->crc, record->crc, sizeof chunk->crc);
}

int retex_band_store_append_chunk(RetexBandStore *store, RetexBandStoreRecord *record, const void *bytes,
                                  RetexError *err)
{
    uint64_t offset;

    pthread_mutex_lock(&store->lock);
    const int code = retex_band_store_append(store, record, bytes, &offset, err);
    if (!code) {
        index_chunk(store, record, offset);
        if (record->nonzero)
            store->images[record->image]->filled = 1;
    }
    pthread_mutex_unlock(&store->lock);
    return code;
}

/* --- reading what another process left --- */

/* Reads exactly so many bytes; 0 where there are fewer. */
static int read_at(int descriptor, void *data, size_t bytes, uint64_t offset)
{
    unsigned char *to = data;

    while (bytes) {
        const ssize_t got = pread(descriptor, to, bytes, (off_t)offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return 0;
        to += got;
        offset += (uint64_t)got;
        bytes -= (size_t)got;
    }
    return 1;
}

static int image_is_sound(const RetexBandStore *store, const RetexBandStoreRecord *record,
                          const RetexBandStoreDescription *d)
{
    return record->bytes == sizeof *d && record->image == (uint32_t)store->nimages &&
           store->nimages < RETEX_SET_PARTS_MAX && memchr(d->name, 0, sizeof d->name) &&
           memchr(d->letters, 0, sizeof d->letters) && retex_name_is_valid(d->name) &&
           retex_letters_are_valid(d->letters) && d->type <= RETEX_FLOAT;
}

static int chunk_is_sound(const RetexBandStore *store, const RetexBandStoreRecord *record)
{
    if (record->image >= (uint32_t)store->nimages || record->band >= (uint32_t)store->nbands)
        return 0;
    const RetexChunkShape shape = retex_band_store_shape(store, store->images[record->image], (int)record->band);
    return record->bytes <= retex_chunk_bytes(&shape);
}

/* Applies a record whose bytes are complete; 0 where its values make no sense. */
static int apply_record(RetexBandStore *store, const RetexBandStoreRecord *record, const void *bytes, uint64_t offset)
{
    RetexBandStoreDescription description;

    switch (record->kind) {
    case BAND_STORE_IMAGE:
        if (record->bytes != sizeof description)
            return 0;
        memcpy(&description, bytes, sizeof description);
        if (!image_is_sound(store, record, &description))
            return 0;
        store->images[store->nimages] =
            retex_band_store_image_new(store, description.name, description.letters, (RetexPixelType)description.type);
        return store->images[store->nimages] ? (store->nimages++, 1) : 0;
    case BAND_STORE_CHUNK:
    case BAND_STORE_PXR24:
        if (!chunk_is_sound(store, record))
            return 0;
        index_chunk(store, record, offset);
        return 1;
    case BAND_STORE_COMMIT:
        if (record->bytes != sizeof(RetexBandStats) || record->band >= (uint32_t)store->nbands)
            return 0;
        memcpy(&store->stats[record->band], bytes, sizeof(RetexBandStats));
        store->committed[record->band] = 1;
        return 1;
    default:
        return 0;
    }
}

/* Reads the bytes of a record, and compares their checksum; 0 where they are not complete. */
static int read_bytes(const RetexBandStore *store, const RetexBandStoreRecord *record, unsigned char *bytes,
                      uint64_t at)
{
    return read_at(store->descriptor, bytes, record->bytes, at) && crc_of(bytes, record->bytes) == record->bytes_crc;
}

/* Reads records up to the first that is not complete. The band store continues at the end of the last commit; *images:
 * the number of images at that point. */
static void read_records(RetexBandStore *store, const Header *header, int *images)
{
    uint32_t last = crc_of(header, sizeof *header);
    uint64_t at = sizeof *header;
    unsigned char *bytes = NULL;
    size_t capacity = 0;
    RetexBandStoreRecord record;

    *images = 0;
    store->end = at;
    store->last_crc = last;
    while (read_at(store->descriptor, &record, sizeof record, at) && record_crc(&record, last) == record.record_crc) {
        if (capacity < record.bytes || !bytes) {
            free(bytes);
            capacity = (size_t)record.bytes + 1;
            bytes = malloc(capacity);
        }
        if (!bytes || !read_bytes(store, &record, bytes, at + sizeof record) ||
            !apply_record(store, &record, bytes, at + sizeof record))
            break;
        at += sizeof record + record.bytes;
        last = record.record_crc;
        if (record.kind == BAND_STORE_COMMIT) {
            store->end = at;
            store->last_crc = last;
            *images = store->nimages;
        }
    }
    free(bytes);
}

/* Forgets chunks of bands that were not committed, and images added after the last commit. */
static void discard_uncommitted(RetexBandStore *store, int images)
{
    while (store->nimages > images)
        free(store->images[--store->nimages]);
    for (int i = 0; i < images; i++)
        for (int band = 0; band < store->nbands; band++) {
            RetexBandStoreChunk *chunk = &store->images[i]->chunks[band];
            if (!store->committed[band])
                *chunk = (RetexBandStoreChunk){0};
            else if (chunk->nonzero)
                store->images[i]->filled = 1;
        }
}

static int check_header(const RetexBandStore *store, const Header *header, RetexError *err)
{
    const Header own = header_of(store);

    if (!retex_band_store_probe(header, sizeof *header))
        return retex_fail(err, RETEX_EFORMAT, "%s is no unfinished render", store->shown);
    if (memcmp(header->magic, own.magic, sizeof own.magic) != 0 || header->order != own.order ||
        header->stats_bytes != own.stats_bytes)
        return retex_fail(err, RETEX_EFORMAT, "%s is of another kind of machine or version", store->shown);
    if (memcmp(header, &own, sizeof own) != 0)
        return retex_fail(err, RETEX_EINVAL, "%s is of another render: other options, another scene or build",
                          store->shown);
    return 0;
}

/* 1 if the file ends before its header does. */
static int has_header_only(const RetexBandStore *store)
{
    const Header own = header_of(store);
    Header header;
    const off_t size = lseek(store->descriptor, 0, SEEK_END);

    return size >= 0 && (size_t)size < sizeof header && read_at(store->descriptor, &header, (size_t)size, 0) &&
           memcmp(&header, &own, (size_t)size) == 0;
}

int retex_band_store_recover(RetexBandStore *store, RetexError *err)
{
    Header header;
    int images, code;

    if (flock(store->descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return retex_fail(err, RETEX_EIO, "%s is in use by another render", store->shown);
    if (has_header_only(store))
        return retex_band_store_begin(store, err);
    if (!read_at(store->descriptor, &header, sizeof header, 0))
        memset(&header, 0, sizeof header);
    code = check_header(store, &header, err);
    if (code)
        return code;
    read_records(store, &header, &images);
    discard_uncommitted(store, images);
    if (ftruncate(store->descriptor, (off_t)store->end) != 0)
        return fail_write(store, errno, err);
    return 0;
}
