/* The spool: see <retex/spool.h>.
 *
 * The file is a sequence of records, each a header and its bytes. Nothing in it is changed once it is written. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "manifest.h"
#include "spool_chunks.h"

typedef struct SpoolImage {
    char letters[8], name[RETEX_NAME_MAX];
    RetexPixelType type;
    atomic_int filled;        /* a pixel is not 0 */
    RetexSpoolChunk chunks[]; /* by band */
} SpoolImage;

/* What one thread works with; kept for the next. */
typedef struct SpoolScratch {
    RetexChunkScratch chunk;
    unsigned char *packed;
    size_t packed_bytes;
    struct SpoolScratch *next;
} SpoolScratch;

struct RetexSpool {
    int width, height, nbands;
    int descriptor;
    char shown[PATH_MAX + 32]; /* what the file is, for messages */
    pthread_mutex_t lock;
    uint64_t end;          /* under lock, as is: */
    SpoolScratch *scratch; /* that no thread uses */
    int nimages;
    SpoolImage *images[RETEX_SET_PARTS_MAX];
};

/* Of a chunk. */
typedef struct Record {
    uint32_t magic, image, band, bytes, crc[RETEX_EXR_LETTERS_MAX];
} Record;
enum { RECORD_CHUNK = 0x6b6e6863 };

static int fail_system(const RetexSpool *spool, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot write %s: %s", spool->shown, strerror(code));
}

/* --- the file ------------------------------------------------------------------------------------------------ */

/* Without a name where the file system can do that, else with one that is taken away at once. */
static int open_in(RetexSpool *spool, const char *folder)
{
    char name[PATH_MAX + 16];

    snprintf(spool->shown, sizeof spool->shown, "a temporary file in %s", folder);
#ifdef O_TMPFILE
    spool->descriptor = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (spool->descriptor >= 0)
        return 1;
#endif
    snprintf(name, sizeof name, "%s/.retex-XXXXXX", folder);
    spool->descriptor = mkostemp(name, O_CLOEXEC);
    if (spool->descriptor < 0)
        return 0;
    unlink(name);
    return 1;
}

/* The folder of a file to be, or "" where it is none: standard output, a device, a pipe. */
static void folder_of(const char *near, char folder[PATH_MAX])
{
    struct stat status;
    char path[PATH_MAX];

    folder[0] = 0;
    if (!near || strcmp(near, "-") == 0 || strlen(near) >= PATH_MAX ||
        (stat(near, &status) == 0 && !S_ISREG(status.st_mode)) || strncmp(near, "/dev/", 5) == 0 ||
        strncmp(near, "/proc/", 6) == 0)
        return;
    snprintf(path, sizeof path, "%s", near);
    if (stat(near, &status) == 0 && !realpath(near, path)) /* a link's file is in a folder of its own */
        return;
    char *slash = strrchr(path, '/');
    if (slash)
        slash[slash == path] = 0;
    snprintf(folder, PATH_MAX, "%s", slash ? path : ".");
}

static int open_file(RetexSpool *spool, const char *near, RetexError *err)
{
    char folder[PATH_MAX];
    const char *temporary = getenv("TMPDIR");

    folder_of(near, folder);
    if (folder[0] && open_in(spool, folder))
        return 0;
    if (temporary && temporary[0] && open_in(spool, temporary))
        return 0;
    return open_in(spool, "/tmp") ? 0 : fail_system(spool, errno, err);
}

int retex_spool_create(RetexSpool **result, int width, int height, const char *near, RetexError *err)
{
    RetexSpool *spool = *result = calloc(1, sizeof *spool);

    if (!spool)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a spool");
    spool->width = width;
    spool->height = height;
    spool->nbands = (height + RETEX_SPOOL_LINES - 1) / RETEX_SPOOL_LINES;
    spool->descriptor = -1;
    pthread_mutex_init(&spool->lock, NULL);
    const int status = open_file(spool, near, err);
    if (status)
        retex_spool_close(result);
    return status;
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

int retex_spool_add(RetexSpool *spool, const char *name, const char *letters, RetexPixelType type, int *image,
                    RetexError *err)
{
    if (!retex_name_is_valid(name) || !retex_letters_are_valid(letters))
        return retex_fail(err, RETEX_EINVAL, "\"%s\" with channels \"%s\" is no image", name, letters);
    SpoolImage *added = calloc(1, sizeof *added + (size_t)spool->nbands * sizeof *added->chunks);
    if (!added)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a spool");
    snprintf(added->name, sizeof added->name, "%s", name);
    snprintf(added->letters, sizeof added->letters, "%s", letters);
    added->type = type;
    pthread_mutex_lock(&spool->lock);
    const int full = spool->nimages == RETEX_SET_PARTS_MAX;
    if (!full) {
        *image = spool->nimages;
        spool->images[spool->nimages++] = added;
    }
    pthread_mutex_unlock(&spool->lock);
    if (!full)
        return 0;
    free(added);
    return retex_fail(err, RETEX_ELIMIT, "a spool has at most %d images", RETEX_SET_PARTS_MAX);
}

/* --- bands --------------------------------------------------------------------------------------------------- */

static RetexChunkShape band_shape(const RetexSpool *spool, const SpoolImage *image, int band)
{
    const int left = spool->height - band * RETEX_SPOOL_LINES;

    return (RetexChunkShape){image->letters, image->type, spool->width,
                             left < RETEX_SPOOL_LINES ? left : RETEX_SPOOL_LINES};
}

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

/* Room for the header of a record and a chunk after it. */
static int prepare(SpoolScratch *scratch, const RetexChunkShape *shape)
{
    const size_t bytes = sizeof(Record) + retex_chunk_bytes(shape);

    if (!scratch || !retex_chunk_need(&scratch->chunk, shape))
        return 0;
    if (scratch->packed_bytes < bytes) {
        free(scratch->packed);
        scratch->packed = malloc(bytes);
        scratch->packed_bytes = scratch->packed ? bytes : 0;
    }
    return scratch->packed != NULL;
}

static int write_at(int descriptor, const unsigned char *data, size_t bytes, uint64_t offset)
{
    while (bytes) {
        const ssize_t written = pwrite(descriptor, data, bytes, (off_t)offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : EIO;
        data += written;
        offset += (uint64_t)written;
        bytes -= (size_t)written;
    }
    return 0;
}

/* One writer at a time, so that the file is whole up to some point whenever the process ends. */
static int append(RetexSpool *spool, const unsigned char *data, size_t bytes, uint64_t *offset, RetexError *err)
{
    pthread_mutex_lock(&spool->lock);
    *offset = spool->end;
    const int code = write_at(spool->descriptor, data, bytes, spool->end);
    if (!code)
        spool->end += bytes;
    pthread_mutex_unlock(&spool->lock);
    return code ? fail_system(spool, code, err) : 0;
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
static int put_chunk(RetexSpool *spool, int number, int band, size_t bytes, SpoolScratch *scratch, RetexError *err)
{
    RetexSpoolChunk *chunk = &spool->images[number]->chunks[band];
    Record record = {RECORD_CHUNK, (uint32_t)number, (uint32_t)band, 0, {0}};
    uint64_t offset;

    if (!all_zero(scratch->chunk.raw, bytes))
        record.bytes =
            (uint32_t)retex_chunk_pack(&scratch->chunk, scratch->chunk.raw, bytes, scratch->packed + sizeof record);
    memcpy(record.crc, chunk->crc, sizeof record.crc);
    memcpy(scratch->packed, &record, sizeof record);
    const int status = append(spool, scratch->packed, sizeof record + record.bytes, &offset, err);
    if (status)
        return status;
    chunk->offset = offset + sizeof record;
    chunk->bytes = record.bytes;
    return 0;
}

int retex_spool_put(RetexSpool *spool, int number, int band, const float *pixels, RetexError *err)
{
    SpoolImage *image = spool->images[number];
    const RetexChunkShape shape = band_shape(spool, image, band);
    const int lit = any_light(pixels, (size_t)shape.width * (size_t)shape.lines * strlen(shape.letters));
    SpoolScratch *scratch = take_scratch(spool);
    int status = 0;

    if (prepare(scratch, &shape)) {
        const size_t bytes = retex_chunk_bytes(&shape);
        retex_chunk_store(&scratch->chunk, &shape, pixels, scratch->chunk.raw, image->chunks[band].crc);
        if (lit || !all_zero(scratch->chunk.raw, bytes)) /* a zero may have a sign */
            status = put_chunk(spool, number, band, bytes, scratch, err);
        if (lit)
            image->filled = 1;
    } else {
        status = retex_fail(err, RETEX_ENOMEM, "no memory to store a part of the picture");
    }
    return_scratch(spool, scratch);
    return status;
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
    return 0;
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
        return retex_fail(err, RETEX_EFORMAT, "%s is damaged", spool->shown);
    retex_chunk_fetch(&scratch->chunk, shape, scratch->chunk.raw, pixels);
    return 0;
}

int retex_spool_load(const RetexSpool *spool, int number, RetexImage *dst, RetexError *err)
{
    const SpoolImage *image = spool->images[number];
    SpoolScratch scratch = {.packed = NULL};
    int status = retex_image_alloc(dst, spool->width, spool->height, (int)strlen(image->letters), err);

    for (int band = 0; band < spool->nbands && !status; band++) {
        const RetexChunkShape shape = band_shape(spool, image, band);
        const RetexSpoolChunk *chunk = &image->chunks[band];
        if (chunk->bytes)
            status = load_band(spool, chunk, &shape, &scratch,
                               dst->pixels + retex_image_index(dst, 0, band * RETEX_SPOOL_LINES), err);
    }
    retex_chunk_free(&scratch.chunk);
    free(scratch.packed);
    if (status)
        retex_image_free(dst);
    return status;
}
