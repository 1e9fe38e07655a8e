/* The band store: see <retex/host/band_store.h>. The file is described in band_store_file.h. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/checksum.h"
#include "exr/band_store_file.h"
#include "io/pending_files.h"

/* Scratch memory of one thread; kept for the next thread. */
typedef struct RetexBandStoreScratch {
    RetexChunkScratch chunk;
    unsigned char *packed;
    size_t packed_bytes;
    struct RetexBandStoreScratch *next;
} RetexBandStoreScratch;

static int fail_system(const RetexBandStore *store, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot write %s: %s", store->shown, strerror(code));
}

static int fail_damaged(const RetexBandStore *store, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "%s is damaged: a checksum is wrong", store->shown);
}

/* --- the file ------------------------------------------------------------------------------------------------ */

static RetexBandStore *band_store_new(int width, int height, uint64_t key)
{
    RetexBandStore *store = calloc(1, sizeof *store);

    if (!store)
        return NULL;
    store->width = width;
    store->height = height;
    store->nbands = (height + RETEX_BAND_ROWS - 1) / RETEX_BAND_ROWS;
    store->key = key;
    store->descriptor = -1;
    store->stats = calloc((size_t)store->nbands, sizeof *store->stats);
    store->committed = calloc((size_t)store->nbands, 1);
    store->pool = calloc(1, sizeof *store->pool);
    pthread_mutex_init(&store->lock, NULL);
    if (store->pool)
        pthread_mutex_init(&store->pool->lock, NULL);
    if (!store->stats || !store->committed || !store->pool)
        retex_band_store_close(&store);
    return store;
}

int retex_band_store_create(RetexBandStore **result, int width, int height, uint64_t key, const char *near,
                            RetexError *err)
{
    RetexBandStore *store = *result = band_store_new(width, height, key);

    if (!store)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a band store");
    store->descriptor = retex_temporary_open(near, store->shown);
    const int code = store->descriptor < 0 ? fail_system(store, errno, err) : retex_band_store_begin(store, err);
    if (code)
        retex_band_store_close(result);
    return code;
}

int retex_band_store_open(RetexBandStore **result, int width, int height, uint64_t key, const char *path,
                          RetexError *err)
{
    RetexBandStore *store = *result = band_store_new(width, height, key);

    if (!store)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a band store");
    snprintf(store->shown, sizeof store->shown, "%s", path);
    store->descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    int code = store->descriptor < 0 ? retex_fail(err, RETEX_EIO, "cannot open %s: %s", path, strerror(errno))
                                       : retex_band_store_recover(store, err);
    if (code)
        retex_band_store_close(result);
    return code;
}

void retex_band_store_set_plain(RetexBandStore *store)
{
    store->plain = 1;
}

void retex_band_store_set_fast(RetexBandStore *store)
{
    store->fast = 1;
}

static void close_pool(RetexBandStorePool *pool)
{
    if (!pool)
        return;
    for (RetexBandStoreScratch *scratch = pool->unused, *next; scratch; scratch = next) {
        next = scratch->next;
        retex_chunk_free(&scratch->chunk);
        free(scratch->packed);
        free(scratch);
    }
    pthread_mutex_destroy(&pool->lock);
    free(pool);
}

void retex_band_store_close(RetexBandStore **result)
{
    RetexBandStore *store = result ? *result : NULL;

    if (!store)
        return;
    if (store->descriptor >= 0)
        close(store->descriptor);
    for (int i = 0; i < store->nimages; i++)
        free(store->images[i]);
    free(store->stats);
    free(store->committed);
    close_pool(store->pool);
    pthread_mutex_destroy(&store->lock);
    free(store);
    *result = NULL;
}

/* Links a file without a name to a path, which Linux can do on the same file system; elsewhere its bytes are copied. */
static int link_to(const RetexBandStore *store, const char *path)
{
    char descriptor[64];

    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", store->descriptor);
    return linkat(AT_FDCWD, descriptor, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

static int link_in_place(const RetexBandStore *store, const char *path)
{
    retex_pending_files_lock();
    const int code = link_to(store, path);
    retex_pending_files_unlock();
    return code;
}

static int copy_bytes(const RetexBandStore *store, int copy)
{
    unsigned char buffer[65536];
    int code = 0;

    for (uint64_t done = 0; done < store->end && !code;) {
        const ssize_t got = pread(store->descriptor, buffer, sizeof buffer, (off_t)done);
        if (got <= 0)
            code = got < 0 ? errno : EIO;
        else
            code = retex_band_store_write_at(copy, buffer, (size_t)got, done);
        done += got > 0 ? (uint64_t)got : 0;
    }
    return close(copy) != 0 && !code ? errno : code;
}

static int copy_in_place(const RetexBandStore *store, const char *path)
{
    RetexPendingFile pending;

    retex_pending_files_lock();
    const int copy = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    int code = copy < 0 ? errno : 0;
    if (!code)
        retex_pending_files_add(&pending, path);
    retex_pending_files_unlock();
    if (code)
        return code;
    code = copy_bytes(store, copy);
    retex_pending_files_lock();
    if (code)
        unlink(path);
    retex_pending_files_drop(&pending);
    retex_pending_files_unlock();
    return code;
}

int retex_band_store_keep(RetexBandStore *store, const char *path, RetexError *err)
{
    int code = link_in_place(store, path);
    if (code && code != EEXIST)
        code = copy_in_place(store, path);
    return code ? retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(code)) : 0;
}

static int find_image(const RetexBandStore *store, const char *name)
{
    for (int i = 0; i < store->nimages; i++)
        if (strcmp(store->images[i]->name, name) == 0)
            return i;
    return -1;
}

static int add_image(RetexBandStore *store, RetexBandStoreImage *added, int *image, RetexError *err)
{
    const int there = find_image(store, added->name);

    if (there >= 0) {
        const RetexBandStoreImage *old = store->images[there];
        if (old->type != added->type || strcmp(old->letters, added->letters) != 0)
            return retex_fail(err, RETEX_EFORMAT, "%s has another image %s", store->shown, added->name);
        free(added);
        *image = there;
        return 0;
    }
    const int code = retex_band_store_add_image(store, added, err);
    if (!code)
        *image = store->nimages - 1;
    return code;
}

int retex_band_store_add(RetexBandStore *store, const char *name, const char *letters, RetexPixelType type, int *image,
                         RetexError *err)
{
    if (!retex_name_is_valid(name) || !retex_letters_are_valid(letters))
        return retex_fail(err, RETEX_EINVAL, "\"%s\" with channels \"%s\" is no image", name, letters);
    RetexBandStoreImage *added = retex_band_store_image_new(store, name, letters, type);
    if (!added)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a band store");
    pthread_mutex_lock(&store->lock);
    const int code = add_image(store, added, image, err);
    pthread_mutex_unlock(&store->lock);
    if (code)
        free(added);
    return code;
}

const char *retex_band_store_image_name(const RetexBandStore *store, int image)
{
    return image < store->nimages ? store->images[image]->name : NULL;
}

/* --- bands --------------------------------------------------------------------------------------------------- */

static RetexBandStoreScratch *acquire_scratch(RetexBandStorePool *pool)
{
    pthread_mutex_lock(&pool->lock);
    RetexBandStoreScratch *scratch = pool->unused;
    if (scratch)
        pool->unused = scratch->next;
    pthread_mutex_unlock(&pool->lock);
    return scratch ? scratch : calloc(1, sizeof *scratch);
}

static void release_scratch(RetexBandStorePool *pool, RetexBandStoreScratch *scratch)
{
    if (!scratch)
        return;
    pthread_mutex_lock(&pool->lock);
    scratch->next = pool->unused;
    pool->unused = scratch;
    pthread_mutex_unlock(&pool->lock);
}

/* Allocates the memory for a chunk. */
static int prepare(const RetexBandStore *store, RetexBandStoreScratch *scratch, const RetexChunkShape *shape)
{
    const size_t bytes = retex_chunk_bytes(shape);

    if (scratch)
        scratch->chunk.zip.zlib.effort = store->fast ? RETEX_ZLIB_HURRY : RETEX_ZLIB_SMALL;
    if (!scratch || !retex_chunk_reserve(&scratch->chunk, shape))
        return 0;
    if (scratch->packed_bytes < bytes) {
        free(scratch->packed);
        scratch->packed = malloc(bytes);
        scratch->packed_bytes = scratch->packed ? bytes : 0;
    }
    return scratch->packed != NULL;
}

static int all_zero(const unsigned char *bytes, size_t count)
{
    return count == 0 || (bytes[0] == 0 && memcmp(bytes, bytes + 1, count - 1) == 0);
}

static int any_light(const float *pixels, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (pixels[i] != 0)
            return 1;
    return 0;
}

/* Appends the band in scratch. A band whose pixels are so dark that all are stored as 0 has a record without bytes. */
static int put_chunk(RetexBandStore *store, int number, int band, const RetexChunkShape *shape, int nonzero,
                     RetexBandStoreScratch *scratch, RetexError *err)
{
    const size_t bytes = retex_chunk_bytes(shape);
    const int pxr24 = !store->plain && !store->fast && retex_chunk_fits_pxr24(shape, scratch->chunk.raw);
    RetexBandStoreRecord record = {.kind = pxr24 ? BAND_STORE_PXR24 : BAND_STORE_CHUNK,
                                   .image = (uint32_t)number,
                                   .band = (uint32_t)band,
                                   .nonzero = (uint32_t)nonzero};
    RetexBandStoreChunk *chunk = &store->images[number]->chunks[band];

    memcpy(record.crc, chunk->crc, sizeof record.crc);
    if (!all_zero(scratch->chunk.raw, bytes))
        record.bytes = store->plain ? (uint32_t)bytes
                                    : (uint32_t)retex_chunk_compress(&scratch->chunk, shape, pxr24, scratch->chunk.raw,
                                                                     scratch->packed);
    return retex_band_store_append_chunk(store, &record, store->plain ? scratch->chunk.raw : scratch->packed, err);
}

int retex_band_store_put(RetexBandStore *store, int number, int band, const float *pixels, RetexError *err)
{
    RetexBandStoreImage *image = store->images[number];
    const RetexChunkShape shape = retex_band_store_shape(store, image, band);
    const int nonzero = any_light(pixels, (size_t)shape.width * (size_t)shape.lines * strlen(shape.letters));
    RetexBandStoreScratch *scratch = acquire_scratch(store->pool);
    int code = 0;

    if (prepare(store, scratch, &shape)) {
        const size_t bytes = retex_chunk_bytes(&shape);
        retex_chunk_encode(&scratch->chunk, &shape, pixels, scratch->chunk.raw, image->chunks[band].crc);
        if (nonzero || !all_zero(scratch->chunk.raw, bytes)) /* -0 is not all zero bits */
            code = put_chunk(store, number, band, &shape, nonzero, scratch, err);
    } else {
        code = retex_fail(err, RETEX_ENOMEM, "no memory to store a part of the picture");
    }
    release_scratch(store->pool, scratch);
    return code;
}

int retex_band_store_commit(RetexBandStore *store, int band, const RetexBandStats *stats, RetexError *err)
{
    RetexBandStoreRecord record = {.kind = BAND_STORE_COMMIT, .band = (uint32_t)band, .bytes = sizeof *stats};

    pthread_mutex_lock(&store->lock);
    const int code = retex_band_store_append(store, &record, stats, NULL, err);
    if (!code) {
        store->stats[band] = *stats;
        store->committed[band] = 1;
    }
    pthread_mutex_unlock(&store->lock);
    return code;
}

const RetexBandStats *retex_band_store_committed(const RetexBandStore *store, int band)
{
    return store->committed[band] ? &store->stats[band] : NULL;
}

int retex_band_store_is_empty(const RetexBandStore *store, int image)
{
    return !store->images[image]->filled;
}

/* --- reading ------------------------------------------------------------------------------------------------- */

const RetexBandStoreChunk *retex_band_store_chunk(const RetexBandStore *store, int image, int band)
{
    return &store->images[image]->chunks[band];
}

int retex_band_store_read(const RetexBandStore *store, const RetexBandStoreChunk *chunk, unsigned char *packed,
                          RetexError *err)
{
    for (size_t done = 0; done < chunk->bytes;) {
        const ssize_t got = pread(store->descriptor, packed + done, chunk->bytes - done, (off_t)(chunk->offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return retex_fail(err, RETEX_EIO, "cannot read back %s: %s", store->shown,
                              got < 0 ? strerror(errno) : "it has become shorter");
        done += (size_t)got;
    }
    return retex_crc32(CRC32_OF_NONE, packed, chunk->bytes) == chunk->bytes_crc ? 0 : fail_damaged(store, err);
}

static int load_band(const RetexBandStore *store, const RetexBandStoreChunk *chunk, const RetexChunkShape *shape,
                     RetexBandStoreScratch *scratch, float *pixels, RetexError *err)
{
    if (!prepare(store, scratch, shape))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a part of the picture");
    const int code = retex_band_store_read(store, chunk, scratch->packed, err);
    if (code)
        return code;
    if (!retex_chunk_decompress(&scratch->chunk, shape, chunk->pxr24, scratch->packed, chunk->bytes,
                                scratch->chunk.raw))
        return fail_damaged(store, err);
    retex_chunk_decode(&scratch->chunk, shape, scratch->chunk.raw, pixels);
    return 0;
}

int retex_band_store_load_band(const RetexBandStore *store, int number, int band, float *pixels, RetexError *err)
{
    const RetexBandStoreImage *image = store->images[number];
    const RetexChunkShape shape = retex_band_store_shape(store, image, band);

    if (!image->chunks[band].bytes) {
        memset(pixels, 0, (size_t)shape.width * (size_t)shape.lines * strlen(image->letters) * sizeof *pixels);
        return 0;
    }
    RetexBandStoreScratch *scratch = acquire_scratch(store->pool);
    const int code = load_band(store, &image->chunks[band], &shape, scratch, pixels, err);
    release_scratch(store->pool, scratch);
    return code;
}
