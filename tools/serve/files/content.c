/* See content.h. */
#include "serve/files/content.h"

#include <errno.h>
#include <fcntl.h>
#include <nettle/sha2.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/clock.h>

#include "http/hash.h"

enum {
    BUCKETS = 4096,            /* a newer content takes the place of an older one */
    READ_BYTES = 65536,      /* at once */
    TICK_MILLISECONDS = 100, /* more than the ticks of a kernel's clock */
    COARSE_SECONDS = 2       /* of file systems that know no fractions */
};

struct Contents {
    pthread_mutex_t lock;
    Content buckets[BUCKETS]; /* by hash of the identity; unused ones are not settled */
};

int contents_open(Contents **contents, RetexError *err)
{
    *contents = calloc(1, sizeof **contents);
    if (!*contents)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for digests of files");
    pthread_mutex_init(&(*contents)->lock, NULL);
    return RETEX_OK;
}

void contents_close(Contents *contents)
{
    if (!contents)
        return;
    pthread_mutex_destroy(&contents->lock);
    free(contents);
}

const char *content_text(const Content *content, char text[2 * CONTENT_DIGEST + 1])
{
    for (int i = 0; i < CONTENT_DIGEST; i++)
        snprintf(text + 2 * i, 3, "%02x", content->digest[i]);
    return text;
}

static Content *bucket_of(Contents *contents, const FileId *id)
{
    return &contents->buckets[hash_bytes(HASH_BEGIN, id, sizeof *id) % BUCKETS];
}

int contents_find(Contents *contents, const FileId *id, Content *content)
{
    pthread_mutex_lock(&contents->lock);
    const Content *bucket = bucket_of(contents, id);
    const int is_known = bucket->is_settled && file_id_is_same(&bucket->id, id);
    if (is_known)
        *content = *bucket;
    pthread_mutex_unlock(&contents->lock);
    return is_known;
}

static void remember(Contents *contents, const Content *content)
{
    pthread_mutex_lock(&contents->lock);
    *bucket_of(contents, &content->id) = *content;
    pthread_mutex_unlock(&contents->lock);
}

/* Whether a change now would give the file another time than it has. */
static int is_settled(const FileId *id)
{
    const struct timespec now = retex_clock_time_after(0);
    const double age =
        (double)(now.tv_sec - id->change_seconds) + 1e-9 * (double)(now.tv_nsec - id->change_nanoseconds);
    return age > (id->change_nanoseconds ? 1e-3 * TICK_MILLISECONDS : COARSE_SECONDS);
}

static int fail_changed(RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "the file was changed while it was read");
}

static int digest_file(int file, unsigned char digest[CONTENT_DIGEST], RetexError *err)
{
    struct sha256_ctx sum;
    unsigned char *bytes = malloc(READ_BYTES);
    ssize_t got = -1;
    if (!bytes)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to read a file");
    sha256_init(&sum);
    for (off_t at = 0; (got = pread(file, bytes, READ_BYTES, at)) > 0 || (got < 0 && errno == EINTR); at += got) {
        got = got < 0 ? 0 : got;
        sha256_update(&sum, (size_t)got, bytes);
    }
    free(bytes);
    sha256_digest(&sum, CONTENT_DIGEST, digest);
    return got < 0 ? retex_fail(err, RETEX_EIO, "cannot read the file: %s", strerror(errno)) : RETEX_OK;
}

int content_read(void *context, int descriptor, RetexError *err)
{
    ContentReading *reading = context;
    Content content = {.is_settled = 0};
    if (file_id_of_descriptor(&content.id, descriptor))
        return retex_fail(err, RETEX_EIO, "this is no file");
    for (int i = 0; i < reading->count; i++)
        if (file_id_is_same(&content.id, &reading->read[i].id)) /* it is opened once more */
            return RETEX_OK;
    if (reading->count == reading->most)
        return fail_changed(err);
    if (!contents_find(reading->contents, &content.id, &content)) {
        const int code = digest_file(descriptor, content.digest, err);
        if (code)
            return code;
        content.is_settled = is_settled(&content.id);
    }
    const int file = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    if (file < 0)
        return retex_fail(err, RETEX_EIO, "cannot keep a file open: %s", strerror(errno));
    reading->read[reading->count] = content;
    reading->files[reading->count++] = file;
    return RETEX_OK;
}

/* Whether a file holds what it did; remembers its content, and closes it. */
static int end_file(Contents *contents, Content *content, int file, RetexError *err)
{
    unsigned char digest[CONTENT_DIGEST];
    FileId id;
    int code = file_id_of_descriptor(&id, file) ? fail_changed(err) : RETEX_OK;
    if (!code && !file_id_is_same(&id, &content->id))
        content->is_settled = 0; /* it was renamed, for example */
    if (!code && !content->is_settled) {
        code = digest_file(file, digest, err);
        if (!code && memcmp(digest, content->digest, CONTENT_DIGEST) != 0)
            code = fail_changed(err);
    }
    if (!code && content->is_settled)
        remember(contents, content);
    close(file);
    return code;
}

int content_end(ContentReading *reading, RetexError *err)
{
    int code = reading->count ? RETEX_OK : fail_changed(err);
    for (int i = 0; i < reading->count; i++) {
        const int failed = end_file(reading->contents, &reading->read[i], reading->files[i], code ? NULL : err);
        code = code ? code : failed;
    }
    return code;
}
