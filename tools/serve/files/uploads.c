/* See uploads.h. */
#include "serve/files/uploads.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/texture.h>

#include "common/beneath.h"
#include "common/picture_kind.h"
#include "serve/files/decoding.h"

enum { MOST_ARRIVING = 64, MOST_IN_MEMORY = 8 /* of the largest size */, LOOK_SECONDS = 5 };

#define INCOMPLETE ".incoming-" /* beginning of names */

struct Uploads {
    UploadsParams params;
    int folder; /* open: what becomes of its name later is no matter */
    RetexAccess access;
    pthread_mutex_t lock; /* protects all below, and the names in the folder */
    int count, arriving;
    size_t in_memory;         /* bytes that are being received */
    uint64_t bytes, reserved; /* of files, and of those that are being checked */
    int nreserved;
    unsigned long serial;
    double looked;
};

/* ---- the folder ---- */

/* Whether this is the name of an upload: other files of the folder are left alone. */
static int is_upload(const char *name)
{
    if (strspn(name, "0123456789abcdef") != UPLOAD_HASH_TEXT - 1 || name[UPLOAD_HASH_TEXT - 1] != '.')
        return 0;
    for (int i = 0; picture_endings[i]; i++)
        if (strcmp(name + UPLOAD_HASH_TEXT, picture_endings[i]) == 0)
            return 1;
    return 0;
}

/* Count the uploads, without those that are too old, which are deleted. The lock is held. */
static int look(Uploads *uploads, int is_start)
{
    const double now = (double)time(NULL), seconds = uploads->params.seconds;
    const int file = beneath_open(uploads->folder, "", O_RDONLY | O_DIRECTORY, 0);
    DIR *folder = file < 0 ? NULL : fdopendir(file);
    if (!folder && file >= 0)
        close(file);
    if (!folder)
        return -1;
    uploads->count = 0;
    uploads->bytes = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        const char *name = entry->d_name;
        struct stat info;
        if (is_start && strncmp(name, INCOMPLETE, sizeof INCOMPLETE - 1) == 0)
            unlinkat(dirfd(folder), name, 0);
        if (!is_upload(name) || fstatat(dirfd(folder), name, &info, AT_SYMLINK_NOFOLLOW) != 0)
            continue;
        if (seconds > 0 && now - (double)info.st_mtime > seconds && unlinkat(dirfd(folder), name, 0) == 0)
            continue;
        uploads->count++;
        uploads->bytes += (uint64_t)info.st_size;
    }
    closedir(folder);
    uploads->looked = retex_clock_seconds();
    return 0;
}

int uploads_open(Uploads **result, const UploadsParams *params, RetexError *err)
{
    Uploads *uploads = *result = calloc(1, sizeof *uploads);
    if (!uploads)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for uploads");
    uploads->params = *params;
    uploads->access = (RetexAccess)RETEX_ACCESS_INIT;
    uploads->access.safe = 1;
    uploads->access.roots = &uploads->params.folder;
    uploads->access.nroots = 1;
    uploads->folder = beneath_open_top(params->folder, 0);
    if (uploads->folder >= 0 && faccessat(uploads->folder, ".", R_OK | W_OK | X_OK, 0) == 0 && look(uploads, 1) == 0) {
        pthread_mutex_init(&uploads->lock, NULL);
        return RETEX_OK;
    }
    retex_fail(err, RETEX_EIO, "--uploads: cannot write to %s: %s", params->folder, strerror(errno));
    if (uploads->folder >= 0)
        close(uploads->folder);
    free(uploads);
    *result = NULL;
    return RETEX_EIO;
}

void uploads_close(Uploads *uploads)
{
    if (!uploads)
        return;
    pthread_mutex_destroy(&uploads->lock);
    close(uploads->folder);
    free(uploads);
}

size_t uploads_most_bytes(const Uploads *uploads)
{
    return uploads->params.most_bytes;
}

int uploads_enter(Uploads *uploads)
{
    pthread_mutex_lock(&uploads->lock);
    const int enters = uploads->arriving < MOST_ARRIVING;
    uploads->arriving += enters;
    pthread_mutex_unlock(&uploads->lock);
    return enters;
}

int uploads_take_memory(Uploads *uploads, size_t bytes)
{
    pthread_mutex_lock(&uploads->lock);
    const int is_there = uploads->in_memory + bytes <= MOST_IN_MEMORY * uploads->params.most_bytes;
    uploads->in_memory += is_there ? bytes : 0;
    pthread_mutex_unlock(&uploads->lock);
    return is_there;
}

void uploads_leave(Uploads *uploads, size_t bytes)
{
    pthread_mutex_lock(&uploads->lock);
    uploads->arriving--;
    uploads->in_memory -= bytes;
    pthread_mutex_unlock(&uploads->lock);
}

void uploads_sweep(Uploads *uploads)
{
    pthread_mutex_lock(&uploads->lock);
    if (retex_clock_seconds() - uploads->looked > LOOK_SECONDS)
        (void)look(uploads, 0);
    pthread_mutex_unlock(&uploads->lock);
}

UploadsCount uploads_count(Uploads *uploads)
{
    pthread_mutex_lock(&uploads->lock);
    const UploadsCount count = {uploads->count, uploads->bytes};
    pthread_mutex_unlock(&uploads->lock);
    return count;
}

/* ---- an upload ---- */

static int has_place(const Uploads *uploads, size_t bytes)
{
    return uploads->count + uploads->nreserved < uploads->params.most &&
           uploads->bytes + uploads->reserved + bytes <= uploads->params.total_bytes;
}

/* Whether an image has a place, which is then reserved. Images that are too old make place. */
static int reserve(Uploads *uploads, size_t bytes)
{
    pthread_mutex_lock(&uploads->lock);
    if (!has_place(uploads, bytes) && retex_clock_seconds() - uploads->looked > 1)
        (void)look(uploads, 0);
    const int has = has_place(uploads, bytes);
    if (has) {
        uploads->nreserved++;
        uploads->reserved += bytes;
    }
    pthread_mutex_unlock(&uploads->lock);
    return has;
}

/* Give a complete file its name, or remove it; its place is no longer reserved. */
static int settle(Uploads *uploads, const char *incomplete, const char *name, size_t bytes, int failed)
{
    pthread_mutex_lock(&uploads->lock);
    uploads->nreserved--;
    uploads->reserved -= bytes;
    failed = failed || renameat(uploads->folder, incomplete, uploads->folder, name) != 0;
    if (failed) {
        unlinkat(uploads->folder, incomplete, 0);
    } else {
        uploads->count++;
        uploads->bytes += bytes;
    }
    pthread_mutex_unlock(&uploads->lock);
    return failed;
}

/* As textures are read: by names, in safe access. */
static int path_of(const Uploads *uploads, const char *name, char path[PATH_MAX])
{
    return snprintf(path, PATH_MAX, "%s/%s", uploads->params.folder, name) < PATH_MAX;
}

static int write_file(const Uploads *uploads, const char *name, const char *data, size_t bytes)
{
    const int file = beneath_open(uploads->folder, name, O_WRONLY | O_CREAT | O_EXCL, 0644);
    size_t done = 0;
    if (file < 0)
        return errno;
    while (done < bytes) {
        const ssize_t written = write(file, data + done, bytes - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            break;
        done += (size_t)written;
    }
    int failed = done == bytes && fsync(file) == 0 ? 0 : errno ? errno : EIO;
    if (close(file) != 0 && !failed)
        failed = errno;
    return failed;
}

static Answer *refuse(int code, double deadline)
{
    if (code == RETEX_ENOMEM || code == RETEX_EIO || retex_clock_seconds() >= deadline)
        return answer_error(503, "the server is busy");
    return code == RETEX_ELIMIT ? answer_error(413, "the image has too many pixels, or takes too much to decode")
                                : answer_error(415, "the image is damaged, or of a kind that is not read");
}

/* Decode the image as a texture, in one thread: 0, or *answer says what is wrong with it. */
static int check(const Uploads *uploads, const char *path, double deadline, int size[2], Answer **answer)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture = NULL;
    RetexError err = {0};
    snprintf(spec.image, sizeof spec.image, "%s", path);
    spec.access = &uploads->access;
    int code = decoding_budget(&spec.budget, uploads->params.budget, deadline, uploads->params.decoding, &err);
    if (!code)
        code = retex_texture_load(&texture, &spec, 1, &err);
    if (!code) {
        retex_texture_size(texture, &size[0], &size[1]);
        retex_texture_close(&texture);
    }
    retex_budget_close(&spec.budget);
    if (!code)
        return 0;
    *answer = refuse(code, deadline);
    if (*answer)
        snprintf((*answer)->reason, sizeof(*answer)->reason, "upload: %.180s", err.message);
    return code;
}

static Answer *tell(const Uploads *uploads, int status, const char *name, size_t bytes, const int size[2])
{
    char expires[32] = "";
    const time_t ends = time(NULL) + (time_t)uploads->params.seconds;
    struct tm parts;
    if (uploads->params.seconds > 0 && gmtime_r(&ends, &parts))
        strftime(expires, sizeof expires, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return answer_json(status, json_pack("{s:s, s:i, s:i, s:I, s:s?}", "texture", name, "width", size[0], "height",
                                         size[1], "bytes", (json_int_t)bytes, "expires", *expires ? expires : NULL));
}

static Answer *full(void)
{
    return answer_error(507, "there is no place for more images");
}

/* A new file. */
static Answer *add(Uploads *uploads, const char *name, const char *data, size_t bytes, double deadline)
{
    char incomplete[64], path[PATH_MAX];
    int size[2] = {0, 0};
    if (!reserve(uploads, bytes))
        return full();
    pthread_mutex_lock(&uploads->lock);
    const unsigned long serial = ++uploads->serial;
    pthread_mutex_unlock(&uploads->lock);
    snprintf(incomplete, sizeof incomplete, INCOMPLETE "%lu.%s", serial, strrchr(name, '.') + 1);
    const int failed = path_of(uploads, incomplete, path) ? write_file(uploads, incomplete, data, bytes) : ENAMETOOLONG;
    Answer *error = NULL;
    const int is_wrong = !failed && check(uploads, path, deadline, size, &error);
    if (!settle(uploads, incomplete, name, bytes, failed || is_wrong))
        return tell(uploads, 201, name, bytes, size);
    return is_wrong                                                  ? error
           : failed == ENOSPC || failed == EDQUOT || failed == EFBIG ? full()
                                                                     : answer_error(500, "the server cannot keep this");
}

Answer *uploads_keep(Uploads *uploads, const char *hash, const void *data, size_t bytes, double deadline)
{
    const PictureKind *kind = picture_kind_of_bytes(data, bytes);
    char name[UPLOAD_HASH_TEXT + 8], path[PATH_MAX];
    int size[2] = {0, 0};
    if (!kind)
        return answer_error(
            415,
            "expected an image, the file itself and no form: JPEG, PNG, OpenEXR, TIFF, BMP, GIF, WebP or Radiance HDR");
    snprintf(name, sizeof name, "%s.%s", hash, kind->ending);
    if (!path_of(uploads, name, path))
        return answer_error(500, "the server cannot keep this");
    if (utimensat(uploads->folder, name, NULL, AT_SYMLINK_NOFOLLOW) != 0)
        return add(uploads, name, data, bytes, deadline);
    Answer *error = NULL;
    return check(uploads, path, deadline, size, &error) ? error : tell(uploads, 200, name, bytes, size);
}
