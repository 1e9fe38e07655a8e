/* See spool_file.h. */
#include "exr/spool_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "io/checksum.h"

static const char MAGIC[8] = "retex\n\032\002"; /* the last one is the version */

typedef struct Header {
    char magic[8];
    uint32_t order, stats_bytes; /* 0x01020304; sizeof(RetexBandStats) */
    uint64_t key;
    uint32_t width, height;
} Header;

int retex_spool_probe(const void *begin, size_t bytes)
{
    return bytes >= sizeof MAGIC && memcmp(begin, MAGIC, sizeof MAGIC - 1) == 0;
}

SpoolImage *spool_image_new(const RetexSpool *spool, const char *name, const char *letters, RetexPixelType type)
{
    SpoolImage *image = calloc(1, sizeof *image + (size_t)spool->nbands * sizeof *image->chunks);

    if (!image)
        return NULL;
    snprintf(image->name, sizeof image->name, "%s", name);
    snprintf(image->letters, sizeof image->letters, "%s", letters);
    image->type = type;
    return image;
}

RetexChunkShape spool_shape(const RetexSpool *spool, const SpoolImage *image, int band)
{
    const int left = spool->height - band * RETEX_SPOOL_LINES;

    return (RetexChunkShape){image->letters, image->type, spool->width,
                             left < RETEX_SPOOL_LINES ? left : RETEX_SPOOL_LINES};
}

static uint32_t crc_of(const void *data, size_t bytes)
{
    return retex_crc32(CRC32_OF_NONE, data, bytes);
}

/* It goes on from the record before, so that none can be missing or come twice. */
static uint32_t record_crc(const SpoolRecord *record, uint32_t last)
{
    return retex_crc32(last, record, offsetof(SpoolRecord, record_crc));
}

/* --- writing --- */

int spool_write_at(int descriptor, const void *data, size_t bytes, uint64_t offset)
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

static int fail_write(const RetexSpool *spool, int code, RetexError *err)
{
    return code ? retex_fail(err, RETEX_EIO, "cannot write %s: %s", spool->shown, strerror(code)) : 0;
}

static Header header_of(const RetexSpool *spool)
{
    Header header = {.order = 0x01020304,
                     .stats_bytes = sizeof(RetexBandStats),
                     .key = spool->key,
                     .width = (uint32_t)spool->width,
                     .height = (uint32_t)spool->height};

    memcpy(header.magic, MAGIC, sizeof MAGIC);
    return header;
}

int spool_begin(RetexSpool *spool, RetexError *err)
{
    const Header header = header_of(spool);

    spool->end = sizeof header;
    spool->last_crc = crc_of(&header, sizeof header);
    return fail_write(spool, spool_write_at(spool->descriptor, &header, sizeof header, 0), err);
}

int spool_append(RetexSpool *spool, SpoolRecord *record, const void *bytes, uint64_t *offset, RetexError *err)
{
    record->bytes_crc = crc_of(bytes, record->bytes);
    record->record_crc = record_crc(record, spool->last_crc);
    int code = spool_write_at(spool->descriptor, record, sizeof *record, spool->end);
    if (!code)
        code = spool_write_at(spool->descriptor, bytes, record->bytes, spool->end + sizeof *record);
    if (code)
        return fail_write(spool, code, err);
    if (offset)
        *offset = spool->end + sizeof *record;
    spool->end += sizeof *record + record->bytes;
    spool->last_crc = record->record_crc;
    return 0;
}

int spool_add_image(RetexSpool *spool, SpoolImage *image, RetexError *err)
{
    SpoolDescription description = {.type = (uint32_t)image->type};
    SpoolRecord record = {.kind = SPOOL_IMAGE, .image = (uint32_t)spool->nimages, .bytes = sizeof description};

    if (spool->nimages == RETEX_SET_PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "a spool has at most %d images", RETEX_SET_PARTS_MAX);
    memcpy(description.name, image->name, sizeof description.name);
    memcpy(description.letters, image->letters, sizeof description.letters);
    const int status = spool_append(spool, &record, &description, NULL, err);
    if (!status)
        spool->images[spool->nimages++] = image;
    return status;
}

static void note_chunk(RetexSpool *spool, const SpoolRecord *record, uint64_t offset)
{
    RetexSpoolChunk *chunk = &spool->images[record->image]->chunks[record->band];

    chunk->offset = offset;
    chunk->bytes = record->bytes;
    chunk->lit = record->lit;
    chunk->bytes_crc = record->bytes_crc;
    memcpy(chunk->crc, record->crc, sizeof chunk->crc);
}

int spool_append_chunk(RetexSpool *spool, SpoolRecord *record, const void *bytes, RetexError *err)
{
    uint64_t offset;

    pthread_mutex_lock(&spool->lock);
    const int status = spool_append(spool, record, bytes, &offset, err);
    if (!status) {
        note_chunk(spool, record, offset);
        if (record->lit)
            spool->images[record->image]->filled = 1;
    }
    pthread_mutex_unlock(&spool->lock);
    return status;
}

/* --- reading what another process left --- */

/* Exactly so many bytes, or 0. */
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

static int image_is_sound(const RetexSpool *spool, const SpoolRecord *record, const SpoolDescription *d)
{
    return record->bytes == sizeof *d && record->image == (uint32_t)spool->nimages &&
           spool->nimages < RETEX_SET_PARTS_MAX && memchr(d->name, 0, sizeof d->name) &&
           memchr(d->letters, 0, sizeof d->letters) && retex_name_is_valid(d->name) &&
           retex_letters_are_valid(d->letters) && d->type <= RETEX_FLOAT;
}

static int chunk_is_sound(const RetexSpool *spool, const SpoolRecord *record)
{
    if (record->image >= (uint32_t)spool->nimages || record->band >= (uint32_t)spool->nbands)
        return 0;
    const RetexChunkShape shape = spool_shape(spool, spool->images[record->image], (int)record->band);
    return record->bytes <= retex_chunk_bytes(&shape);
}

/* Take in a record whose bytes are there and whole; 0 where it makes no sense. */
static int take_record(RetexSpool *spool, const SpoolRecord *record, const void *bytes, uint64_t offset)
{
    SpoolDescription description;

    switch (record->kind) {
    case SPOOL_IMAGE:
        if (record->bytes != sizeof description)
            return 0;
        memcpy(&description, bytes, sizeof description);
        if (!image_is_sound(spool, record, &description))
            return 0;
        spool->images[spool->nimages] =
            spool_image_new(spool, description.name, description.letters, (RetexPixelType)description.type);
        return spool->images[spool->nimages] ? (spool->nimages++, 1) : 0;
    case SPOOL_CHUNK:
        if (!chunk_is_sound(spool, record))
            return 0;
        note_chunk(spool, record, offset);
        return 1;
    case SPOOL_COMMIT:
        if (record->bytes != sizeof(RetexBandStats) || record->band >= (uint32_t)spool->nbands)
            return 0;
        memcpy(&spool->stats[record->band], bytes, sizeof(RetexBandStats));
        spool->committed[record->band] = 1;
        return 1;
    default:
        return 0;
    }
}

/* Read records up to the first that is not whole. The spool goes on from the end of the last commit; *images: how many
 * there are then. */
static void read_records(RetexSpool *spool, const Header *header, int *images)
{
    uint32_t last = crc_of(header, sizeof *header);
    uint64_t at = sizeof *header;
    unsigned char *bytes = NULL;
    size_t room = 0;
    SpoolRecord record;

    *images = 0;
    spool->end = at;
    spool->last_crc = last;
    while (read_at(spool->descriptor, &record, sizeof record, at) && record_crc(&record, last) == record.record_crc) {
        if (room < record.bytes || !bytes) {
            free(bytes);
            room = (size_t)record.bytes + 1;
            bytes = malloc(room);
        }
        if (!bytes || !read_at(spool->descriptor, bytes, record.bytes, at + sizeof record) ||
            crc_of(bytes, record.bytes) != record.bytes_crc || !take_record(spool, &record, bytes, at + sizeof record))
            break;
        at += sizeof record + record.bytes;
        last = record.record_crc;
        if (record.kind == SPOOL_COMMIT) {
            spool->end = at;
            spool->last_crc = last;
            *images = spool->nimages;
        }
    }
    free(bytes);
}

/* Forget what is not of a committed band. */
static void drop_the_rest(RetexSpool *spool, int images)
{
    while (spool->nimages > images)
        free(spool->images[--spool->nimages]);
    for (int i = 0; i < images; i++)
        for (int band = 0; band < spool->nbands; band++) {
            RetexSpoolChunk *chunk = &spool->images[i]->chunks[band];
            if (!spool->committed[band])
                *chunk = (RetexSpoolChunk){0};
            else if (chunk->lit)
                spool->images[i]->filled = 1;
        }
}

static int check_header(const RetexSpool *spool, const Header *header, RetexError *err)
{
    const Header own = header_of(spool);

    if (!retex_spool_probe(header, sizeof *header))
        return retex_fail(err, RETEX_EFORMAT, "%s is no unfinished render", spool->shown);
    if (memcmp(header->magic, own.magic, sizeof own.magic) != 0 || header->order != own.order ||
        header->stats_bytes != own.stats_bytes)
        return retex_fail(err, RETEX_EFORMAT, "%s is of another kind of machine or version", spool->shown);
    if (memcmp(header, &own, sizeof own) != 0)
        return retex_fail(err, RETEX_EINVAL, "%s is of another render: other options, another scene or version",
                          spool->shown);
    return 0;
}

/* Whether the file ends before its header does. */
static int is_begun_only(const RetexSpool *spool)
{
    const Header own = header_of(spool);
    Header header;
    const off_t size = lseek(spool->descriptor, 0, SEEK_END);

    return size >= 0 && (size_t)size < sizeof header && read_at(spool->descriptor, &header, (size_t)size, 0) &&
           memcmp(&header, &own, (size_t)size) == 0;
}

int spool_recover(RetexSpool *spool, int make, RetexError *err)
{
    Header header;
    int images, status;

    if (flock(spool->descriptor, (make ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return retex_fail(err, RETEX_EIO, "%s is in use by another render", spool->shown);
    if (make && is_begun_only(spool))
        return spool_begin(spool, err);
    if (!read_at(spool->descriptor, &header, sizeof header, 0))
        memset(&header, 0, sizeof header);
    status = check_header(spool, &header, err);
    if (status)
        return status;
    read_records(spool, &header, &images);
    drop_the_rest(spool, images);
    if (make && ftruncate(spool->descriptor, (off_t)spool->end) != 0)
        return fail_write(spool, errno, err);
    return 0;
}
