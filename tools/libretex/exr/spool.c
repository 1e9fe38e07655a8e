/* The spool: see <retex/spool.h>. The file is described in spool_file.h. */
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
#include "exr/spool_file.h"
#include "io/pending_files.h"

/* What one thread works with; kept for the next. */
typedef struct SpoolScratch {
    RetexChunkScratch chunk;
    unsigned char *packed;
    size_t packed_bytes;
    struct SpoolScratch *next;
} SpoolScratch;

static int fail_system(const RetexSpool *spool, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot write %s: %s", spool->shown, strerror(code));
}

static int fail_damaged(const RetexSpool *spool, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "%s is damaged: a checksum is wrong", spool->shown);
}

/* --- the file ------------------------------------------------------------------------------------------------ */

static RetexSpool *spool_new(int width, int height, uint64_t key)
{
    RetexSpool *spool = calloc(1, sizeof *spool);

    if (!spool)
        return NULL;
    spool->width = width;
    spool->height = height;
    spool->nbands = (height + RETEX_SPOOL_LINES - 1) / RETEX_SPOOL_LINES;
    spool->key = key;
    spool->descriptor = -1;
    spool->stats = calloc((size_t)spool->nbands, sizeof *spool->stats);
    spool->committed = calloc((size_t)spool->nbands, 1);
    pthread_mutex_init(&spool->lock, NULL);
    if (!spool->stats || !spool->committed)
        retex_spool_close(&spool);
    return spool;
}

int retex_spool_create(RetexSpool **result, int width, int height, uint64_t key, const char *near, RetexError *err)
{
    RetexSpool *spool = *result = spool_new(width, height, key);

    if (!spool)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a spool");
    spool->descriptor = retex_temporary_open(near, spool->shown);
    const int status = spool->descriptor < 0 ? fail_system(spool, errno, err) : spool_begin(spool, err);
    if (status)
        retex_spool_close(result);
    return status;
}

int retex_spool_open(RetexSpool **result, int width, int height, uint64_t key, const char *path, int make,
                     RetexError *err)
{
    RetexSpool *spool = *result = spool_new(width, height, key);

    if (!spool)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a spool");
    snprintf(spool->shown, sizeof spool->shown, "%s", path);
    spool->descriptor = open(path, (make ? O_RDWR | O_CREAT : O_RDONLY) | O_CLOEXEC, 0666);
    int status = spool->descriptor < 0 ? retex_fail(err, RETEX_EIO, "cannot open %s: %s", path, strerror(errno))
                                       : spool_recover(spool, make, err);
    if (status)
        retex_spool_close(result);
    return status;
}

void retex_spool_set_plain(RetexSpool *spool)
{
    spool->plain = 1;
}

void retex_spool_close(RetexSpool **result)
{
    RetexSpool *spool = result ? *result : NULL;

    if (!spool)
        return;
    if (spool->descriptor >= 0)
        close(spool->descriptor);
    for (int i = 0; i < spool->nimages; i++)
        free(spool->images[i]);
    free(spool->stats);
    free(spool->committed);
    for (SpoolScratch *scratch = spool->scratch, *next; scratch; scratch = next) {
        next = scratch->next;
        retex_chunk_free(&scratch->chunk);
        free(scratch->packed);
        free(scratch);
    }
    pthread_mutex_destroy(&spool->lock);
    free(spool);
    *result = NULL;
}

/* Linux gives a file that was made without a name one where it was made; elsewhere its bytes are copied. */
static int link_to(const RetexSpool *spool, const char *path)
{
    char descriptor[64];

    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", spool->descriptor);
    return linkat(AT_FDCWD, descriptor, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

/* Under the lock of names; hidden, where there is one, is what path becomes a name of. */
static int rename_hidden(const char *hidden, const char *path)
{
    const int code = hidden && rename(hidden, path) != 0 ? errno : 0;

    if (code)
        unlink(hidden);
    return code;
}

static int link_in_place(const RetexSpool *spool, const char *path, const char *hidden)
{
    retex_pending_files_lock();
    int code = link_to(spool, hidden ? hidden : path);
    if (!code)
        code = rename_hidden(hidden, path);
    retex_pending_files_unlock();
    return code;
}

static int copy_bytes(const RetexSpool *spool, int copy)
{
    unsigned char buffer[65536];
    int code = 0;

    for (uint64_t done = 0; done < spool->end && !code;) {
        const ssize_t got = pread(spool->descriptor, buffer, sizeof buffer, (off_t)done);
        if (got <= 0)
            code = got < 0 ? errno : EIO;
        else
            code = spool_write_at(copy, buffer, (size_t)got, done);
        done += got > 0 ? (uint64_t)got : 0;
    }
    return close(copy) != 0 && !code ? errno : code;
}

static int copy_in_place(const RetexSpool *spool, const char *path, const char *hidden)
{
    const char *name = hidden ? hidden : path;
    RetexPendingFile unfinished;

    retex_pending_files_lock();
    const int copy = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    int code = copy < 0 ? errno : 0;
    if (!code)
        retex_pending_files_add(&unfinished, name);
    retex_pending_files_unlock();
    if (code)
        return code;
    code = copy_bytes(spool, copy);
    retex_pending_files_lock();
    if (code)
        unlink(name);
    else
        code = rename_hidden(hidden, path);
    retex_pending_files_drop(&unfinished);
    retex_pending_files_unlock();
    return code;
}

int retex_spool_keep(RetexSpool *spool, const char *path, int replace, RetexError *err)
{
    char hidden[PATH_MAX];

    snprintf(hidden, sizeof hidden, "%s.tmp%08x", path, (unsigned)getpid());
    int code = link_in_place(spool, path, replace ? hidden : NULL);
    if (code && code != EEXIST)
        code = copy_in_place(spool, path, replace ? hidden : NULL);
    return code ? retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(code)) : 0;
}

static int find_image(const RetexSpool *spool, const char *name)
{
    for (int i = 0; i < spool->nimages; i++)
        if (strcmp(spool->images[i]->name, name) == 0)
            return i;
    return -1;
}

static int add_image(RetexSpool *spool, SpoolImage *added, int *image, RetexError *err)
{
    const int there = find_image(spool, added->name);

    if (there >= 0) {
        const SpoolImage *old = spool->images[there];
        if (old->type != added->type || strcmp(old->letters, added->letters) != 0)
            return retex_fail(err, RETEX_EFORMAT, "%s has another image %s", spool->shown, added->name);
        free(added);
        *image = there;
        return 0;
    }
    const int status = spool_add_image(spool, added, err);
    if (!status)
        *image = spool->nimages - 1;
    return status;
}

int retex_spool_add(RetexSpool *spool, const char *name, const char *letters, RetexPixelType type, int *image,
                    RetexError *err)
{
    if (!retex_name_is_valid(name) || !retex_letters_are_valid(letters))
        return retex_fail(err, RETEX_EINVAL, "\"%s\" with channels \"%s\" is no image", name, letters);
    SpoolImage *added = spool_image_new(spool, name, letters, type);
    if (!added)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a spool");
    pthread_mutex_lock(&spool->lock);
    const int status = add_image(spool, added, image, err);
    pthread_mutex_unlock(&spool->lock);
    if (status)
        free(added);
    return status;
}

/* --- bands --------------------------------------------------------------------------------------------------- */

static SpoolScratch *take_scratch(RetexSpool *spool)
{
    pthread_mutex_lock(&spool->lock);
    SpoolScratch *scratch = spool->scratch;
    if (scratch)
        spool->scratch = scratch->next;
    pthread_mutex_unlock(&spool->lock);
    return scratch ? scratch : calloc(1, sizeof *scratch);
}

static void return_scratch(RetexSpool *spool, SpoolScratch *scratch)
{
    if (!scratch)
        return;
    pthread_mutex_lock(&spool->lock);
    scratch->next = spool->scratch;
    spool->scratch = scratch;
    pthread_mutex_unlock(&spool->lock);
}

/* Room for a chunk. */
static int prepare(SpoolScratch *scratch, const RetexChunkShape *shape)
{
    const size_t bytes = retex_chunk_bytes(shape);

    if (!scratch || !retex_chunk_need(&scratch->chunk, shape))
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

/* Keep the band that scratch holds. One whose pixels are so dark that all are stored as 0 leaves a record without
 * bytes. */
static int put_chunk(RetexSpool *spool, int number, int band, size_t bytes, int lit, SpoolScratch *scratch,
                     RetexError *err)
{
    SpoolRecord record = {.kind = SPOOL_CHUNK, .image = (uint32_t)number, .band = (uint32_t)band, .lit = (uint32_t)lit};
    RetexSpoolChunk *chunk = &spool->images[number]->chunks[band];

    memcpy(record.crc, chunk->crc, sizeof record.crc);
    if (!all_zero(scratch->chunk.raw, bytes))
        record.bytes = spool->plain
                           ? (uint32_t)bytes
                           : (uint32_t)retex_chunk_pack(&scratch->chunk, scratch->chunk.raw, bytes, scratch->packed);
    return spool_append_chunk(spool, &record, spool->plain ? scratch->chunk.raw : scratch->packed, err);
}

int retex_spool_put(RetexSpool *spool, int number, int band, const float *pixels, RetexError *err)
{
    SpoolImage *image = spool->images[number];
    const RetexChunkShape shape = spool_shape(spool, image, band);
    const int lit = any_light(pixels, (size_t)shape.width * (size_t)shape.lines * strlen(shape.letters));
    SpoolScratch *scratch = take_scratch(spool);
    int status = 0;

    if (prepare(scratch, &shape)) {
        const size_t bytes = retex_chunk_bytes(&shape);
        retex_chunk_store(&scratch->chunk, &shape, pixels, scratch->chunk.raw, image->chunks[band].crc);
        if (lit || !all_zero(scratch->chunk.raw, bytes)) /* a zero may have a sign */
            status = put_chunk(spool, number, band, bytes, lit, scratch, err);
    } else {
        status = retex_fail(err, RETEX_ENOMEM, "no memory to store a part of the picture");
    }
    return_scratch(spool, scratch);
    return status;
}

int retex_spool_commit(RetexSpool *spool, int band, const RetexBandStats *stats, RetexError *err)
{
    SpoolRecord record = {.kind = SPOOL_COMMIT, .band = (uint32_t)band, .bytes = sizeof *stats};

    pthread_mutex_lock(&spool->lock);
    const int status = spool_append(spool, &record, stats, NULL, err);
    if (!status) {
        spool->stats[band] = *stats;
        spool->committed[band] = 1;
    }
    pthread_mutex_unlock(&spool->lock);
    return status;
}

const RetexBandStats *retex_spool_committed(const RetexSpool *spool, int band)
{
    return spool->committed[band] ? &spool->stats[band] : NULL;
}

static int copy_chunk(RetexSpool *spool, const RetexSpool *from, int number, int band, RetexError *err)
{
    const SpoolImage *image = from->images[number];
    const RetexSpoolChunk *chunk = &image->chunks[band];
    const int to = find_image(spool, image->name);
    SpoolRecord record = {
        .kind = SPOOL_CHUNK, .band = (uint32_t)band, .bytes = chunk->bytes, .lit = chunk->lit, .image = (uint32_t)to};

    if (!chunk->bytes && !chunk->lit)
        return 0;
    if (to < 0 || spool->images[to]->type != image->type || strcmp(spool->images[to]->letters, image->letters) != 0)
        return retex_fail(err, RETEX_EFORMAT, "%s has an image %s that this render has not", from->shown, image->name);
    unsigned char *packed = malloc((size_t)chunk->bytes + 1);
    if (!packed)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a part of the picture");
    memcpy(record.crc, chunk->crc, sizeof record.crc);
    int status = retex_spool_read(from, chunk, packed, err);
    if (!status)
        status = spool_append_chunk(spool, &record, packed, err);
    free(packed);
    return status;
}

int retex_spool_copy_band(RetexSpool *spool, const RetexSpool *from, int band, RetexError *err)
{
    int status = 0;

    for (int i = 0; i < from->nimages && !status; i++)
        status = copy_chunk(spool, from, i, band, err);
    return status ? status : retex_spool_commit(spool, band, &from->stats[band], err);
}

int retex_spool_is_empty(const RetexSpool *spool, int image)
{
    return !spool->images[image]->filled;
}

/* --- reading ------------------------------------------------------------------------------------------------- */

const RetexSpoolChunk *retex_spool_chunk(const RetexSpool *spool, int image, int band)
{
    return &spool->images[image]->chunks[band];
}

int retex_spool_read(const RetexSpool *spool, const RetexSpoolChunk *chunk, unsigned char *packed, RetexError *err)
{
    for (size_t done = 0; done < chunk->bytes;) {
        const ssize_t got = pread(spool->descriptor, packed + done, chunk->bytes - done, (off_t)(chunk->offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return retex_fail(err, RETEX_EIO, "cannot read back %s: %s", spool->shown,
                              got < 0 ? strerror(errno) : "it has become shorter");
        done += (size_t)got;
    }
    return retex_crc32(CRC32_OF_NONE, packed, chunk->bytes) == chunk->bytes_crc ? 0 : fail_damaged(spool, err);
}

static int load_band(const RetexSpool *spool, const RetexSpoolChunk *chunk, const RetexChunkShape *shape,
                     SpoolScratch *scratch, float *pixels, RetexError *err)
{
    const size_t bytes = retex_chunk_bytes(shape);

    if (!prepare(scratch, shape))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a part of the picture");
    const int status = retex_spool_read(spool, chunk, scratch->packed, err);
    if (status)
        return status;
    if (!retex_chunk_unpack(&scratch->chunk, scratch->packed, chunk->bytes, scratch->chunk.raw, bytes))
        return fail_damaged(spool, err);
    retex_chunk_fetch(&scratch->chunk, shape, scratch->chunk.raw, pixels);
    return 0;
}

int retex_spool_load_band(const RetexSpool *spool, int number, int band, float *pixels, RetexError *err)
{
    const SpoolImage *image = spool->images[number];
    const RetexChunkShape shape = spool_shape(spool, image, band);
    SpoolScratch scratch = {.packed = NULL};
    int status = 0;

    if (image->chunks[band].bytes)
        status = load_band(spool, &image->chunks[band], &shape, &scratch, pixels, err);
    else
        memset(pixels, 0, (size_t)shape.width * (size_t)shape.lines * strlen(image->letters) * sizeof *pixels);
    retex_chunk_free(&scratch.chunk);
    free(scratch.packed);
    return status;
}
