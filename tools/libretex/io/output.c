/* Output files. The file at a path is either the old one or the complete new one, never a part of it. The new file is
 * made without a name (O_TMPFILE) where the file system allows that, so that even a killed process leaves nothing
 * behind; elsewhere under a hidden name in the same folder. Both end in a rename, which replaces the old file in one
 * step. Every error that the system may report is checked, that of the last close included, which may be the first sign
 * of a full disk. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/image.h>
#include <retex/output_file.h>

#include "io/output.h"
#include "base/clock.h"
#include "io/pending_files.h"

enum { BUFFER_BYTES = 1 << 18, NAME_ATTEMPTS = 100 };

struct RetexOutput {
    char shown[512];                     /* the path as the user knows it, for messages */
    char path[PATH_MAX];                 /* what will be replaced; symbolic links resolved */
    char folder[PATH_MAX];               /* of path, with the final '/', or "" for the current one */
    char temporary[PATH_MAX + NAME_MAX]; /* hidden name, or "" while the file has none */
    RetexPendingFile pending;            /* entry in the list of pending files while the file is called temporary */
    int descriptor;
    int direct;   /* 1: no temporary file, straight to a device, pipe or standard output */
    int borrowed; /* 1: standard output, which must not be closed */
    FILE *memory; /* used instead of a descriptor, with the data it writes to; or NULL */
    char *data;
    size_t bytes;
    size_t buffered;
    unsigned char *buffer;
};

static int fail_system(const RetexOutput *output, int code, RetexError *err)
{
    return retex_fail(err, code == EPIPE ? RETEX_EPIPE : RETEX_EIO, "cannot write %s: %s", output->shown,
                      strerror(code));
}

/* Makes a hidden name in the folder of path. */
static void hidden_name(RetexOutput *output)
{
    static atomic_uint counter;
    const char *base = output->path + strlen(output->folder);
    const unsigned salt =
        (unsigned)retex_clock_nanoseconds() ^ (unsigned)getpid() << 10 ^ atomic_fetch_add(&counter, 1) << 24;
    /* the base is cut so that the whole stays a legal file name */
    snprintf(output->temporary, sizeof output->temporary, "%s.%.200s.tmp%08x", output->folder, base, salt);
}

static int open_hidden(RetexOutput *output)
{
    for (int attempt = 0; attempt < NAME_ATTEMPTS; attempt++) {
        hidden_name(output);
        retex_pending_files_lock();
        output->descriptor = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        const int code = output->descriptor >= 0 ? 0 : errno;
        if (!code)
            retex_pending_files_add(&output->pending, output->temporary);
        retex_pending_files_unlock();
        if (!code)
            return 0;
        output->temporary[0] = 0;
        if (code != EEXIST)
            return code;
    }
    return EEXIST;
}

static int open_nameless(RetexOutput *output)
{
#ifdef O_TMPFILE
    output->descriptor = open(output->folder[0] ? output->folder : ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    return output->descriptor >= 0;
#else
    return (void)output, 0;
#endif
}

static int names_a_descriptor(const char *path)
{
    return strncmp(path, "/dev/", 5) == 0 || strncmp(path, "/proc/", 6) == 0;
}

/* Finds out what path is: sets direct, path and folder, and *mode to the old file's permissions or -1. */
static int resolve(RetexOutput *output, const char *path, int *mode, RetexError *err)
{
    struct stat info;

    *mode = -1;
    if (strlen(path) >= sizeof output->path || !path[0])
        return fail_system(output, path[0] ? ENAMETOOLONG : ENOENT, err);
    strcpy(output->path, path);
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode))
            return fail_system(output, EISDIR, err);
        output->direct = !S_ISREG(info.st_mode) || names_a_descriptor(path);
        *mode = info.st_mode & 0777;
        if (!output->direct && !realpath(path, output->path))
            return fail_system(output, errno, err);
        /* a file without write permission is not replaced either, though the folder's permissions would allow it */
        if (!output->direct && access(output->path, W_OK) != 0)
            return fail_system(output, errno, err);
    } else if (errno != ENOENT) {
        return fail_system(output, errno, err);
    }
    const char *slash = strrchr(output->path, '/');
    if (slash)
        snprintf(output->folder, sizeof output->folder, "%.*s", (int)(slash + 1 - output->path), output->path);
    return 0;
}

static RetexOutput *output_new(const char *path, RetexError *err)
{
    RetexOutput *output = calloc(1, sizeof *output);

    if (output) {
        output->descriptor = -1;
        output->buffer = malloc(BUFFER_BYTES);
    }
    if (!output || !output->buffer) {
        free(output);
        retex_fail(err, RETEX_ENOMEM, "no memory to write %s", path);
        return NULL;
    }
    snprintf(output->shown, sizeof output->shown, "%s", strcmp(path, "-") == 0 ? "standard output" : path);
    return output;
}

static int open_file(RetexOutput *output, const char *path, RetexError *err)
{
    int mode, code = 0;
    int status = resolve(output, path, &mode, err);

    if (status)
        return status;
    if (output->direct) {
        output->descriptor = open(path, O_WRONLY | O_CLOEXEC | O_TRUNC);
        return output->descriptor < 0 ? fail_system(output, errno, err) : 0;
    }
    if (!open_nameless(output))
        code = open_hidden(output);
    if (code)
        return fail_system(output, code, err);
    if (mode >= 0)
        (void)!fchmod(output->descriptor, (mode_t)mode); /* best effort: not every file system has permissions */
    return 0;
}

int retex_output_open(RetexOutput **result, const char *path, RetexError *err)
{
    RetexOutput *output = output_new(path, err);
    int code = 0;

    *result = NULL;
    if (!output)
        return RETEX_ENOMEM;
    if (strcmp(path, "-") == 0) {
        output->descriptor = STDOUT_FILENO;
        output->direct = output->borrowed = 1;
    } else {
        code = open_file(output, path, err);
    }
    if (code)
        retex_output_abandon(&output);
    *result = output;
    return code;
}

int retex_output_open_memory(RetexOutput **result, RetexError *err)
{
    RetexOutput *output = *result = output_new("memory", err);

    if (!output)
        return RETEX_ENOMEM;
    output->memory = open_memstream(&output->data, &output->bytes);
    if (output->memory)
        return 0;
    retex_output_abandon(result);
    return retex_fail(err, RETEX_ENOMEM, "no memory to write into");
}

int retex_output_check(const char *path, RetexError *err)
{
    RetexOutput *output = NULL;
    int mode, code = 0;

    if (strcmp(path, "-") == 0)
        return 0;
    output = output_new(path, err);
    if (!output)
        return RETEX_ENOMEM;
    code = resolve(output, path, &mode, err);
    if (!code && access(output->direct ? path : output->folder[0] ? output->folder : ".", W_OK) != 0)
        code = fail_system(output, errno, err);
    retex_output_abandon(&output);
    return code;
}

static int write_all(RetexOutput *output, const unsigned char *data, size_t bytes, RetexError *err)
{
    if (output->memory)
        return fwrite(data, 1, bytes, output->memory) == bytes ? 0 : fail_system(output, ENOMEM, err);
    while (bytes) {
        /* below the 2 GiB that one call takes at most */
        const ssize_t written = write(output->descriptor, data, bytes < (1u << 30) ? bytes : (1u << 30));
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return fail_system(output, written < 0 ? errno : EIO, err);
        data += written;
        bytes -= (size_t)written;
    }
    return 0;
}

static int flush(RetexOutput *output, RetexError *err)
{
    const size_t bytes = output->buffered;

    output->buffered = 0;
    return write_all(output, output->buffer, bytes, err);
}

int retex_output_write(RetexOutput *output, const void *data, size_t bytes, RetexError *err)
{
    if (!bytes) /* data may be NULL */
        return 0;
    if (output->buffered + bytes > BUFFER_BYTES) {
        const int code = flush(output, err);
        if (code)
            return code;
    }
    if (bytes >= BUFFER_BYTES)
        return write_all(output, data, bytes, err);
    memcpy(output->buffer + output->buffered, data, bytes);
    output->buffered += bytes;
    return 0;
}

int retex_output_is_file(const char *path)
{
    RetexOutput output = {.descriptor = -1};
    int mode;

    return strcmp(path, "-") != 0 && !resolve(&output, path, &mode, NULL) && !output.direct;
}

int retex_output_patch(RetexOutput *output, uint64_t at, const void *data, size_t bytes, RetexError *err)
{
    const unsigned char *from = data;
    const int code = flush(output, err);

    if (code)
        return code;
    if (output->memory) {
        if (fflush(output->memory) != 0 || at > output->bytes || bytes > output->bytes - at)
            return fail_system(output, ENOMEM, err);
        memcpy(output->data + at, data, bytes);
        return 0;
    }
    while (bytes) {
        const ssize_t written = pwrite(output->descriptor, from, bytes, (off_t)at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return fail_system(output, written < 0 ? errno : EIO, err);
        from += written;
        at += (uint64_t)written;
        bytes -= (size_t)written;
    }
    return 0;
}

/* Links a file without a name to its path, in one step where there is no old file. Otherwise under a hidden name, which
 * is renamed at once: a link cannot replace the old file, a rename can. */
static int link_nameless(RetexOutput *output)
{
    char descriptor[64];

    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", output->descriptor);
    int code = linkat(AT_FDCWD, descriptor, AT_FDCWD, output->path, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
    if (code != EEXIST)
        return code;
    for (int attempt = 0; attempt < NAME_ATTEMPTS && code == EEXIST; attempt++) {
        hidden_name(output);
        code = linkat(AT_FDCWD, descriptor, AT_FDCWD, output->temporary, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
    }
    if (code)
        output->temporary[0] = 0;
    else
        retex_pending_files_add(&output->pending, output->temporary);
    return code;
}

/* Some file systems report a failed write only when a descriptor is closed. So a duplicate is closed first, while the
 * file can still be removed. */
static int close_checked(RetexOutput *output, RetexError *err)
{
    const int other = dup(output->descriptor);

    return other < 0 || (close(other) != 0 && errno != EINTR) ? fail_system(output, errno, err) : 0;
}

/* Puts the complete file at its path. */
static int put_in_place(RetexOutput *output)
{
    int code = 0;

    retex_pending_files_lock();
    if (!output->temporary[0])
        code = link_nameless(output);
    if (!code && output->temporary[0] && rename(output->temporary, output->path) != 0)
        code = errno;
    if (!code) {
        retex_pending_files_drop(&output->pending);
        output->temporary[0] = 0;
    }
    retex_pending_files_unlock();
    return code;
}

static int finish(RetexOutput *output, RetexError *err)
{
    int status = flush(output, err);

    if (!status && !output->borrowed)
        status = close_checked(output, err);
    if (status || output->direct)
        return status;
    const int code = put_in_place(output);
    return code ? fail_system(output, code, err) : 0;
}

int retex_output_commit(RetexOutput **output, RetexError *err)
{
    const int code = finish(*output, err);

    retex_output_abandon(output); /* frees the output; removes a file that is not at its path */
    return code;
}

int retex_output_take(RetexOutput **result, void **data, size_t *bytes, RetexError *err)
{
    RetexOutput *output = *result;
    int code = flush(output, err);

    if (fclose(output->memory) != 0 && !code)
        code = fail_system(output, ENOMEM, err);
    output->memory = NULL; /* fclose has set data */
    *data = code ? NULL : output->data;
    *bytes = code ? 0 : output->bytes;
    if (!code)
        output->data = NULL;
    retex_output_abandon(result);
    return code;
}

void retex_output_abandon(RetexOutput **result)
{
    RetexOutput *output = result ? *result : NULL;

    if (!output)
        return;
    if (output->descriptor >= 0 && !output->borrowed)
        close(output->descriptor);
    if (output->temporary[0]) {
        retex_pending_files_lock();
        unlink(output->temporary);
        retex_pending_files_drop(&output->pending);
        retex_pending_files_unlock();
    }
    if (output->memory)
        fclose(output->memory);
    free(output->data);
    free(output->buffer);
    free(output);
    *result = NULL;
}

int retex_file_write(const char *path, const void *data, size_t bytes, RetexError *err)
{
    RetexOutput *output = NULL;
    int code = retex_output_open(&output, path, err);

    if (code)
        return code;
    code = retex_output_write(output, data, bytes, err);
    if (!code)
        return retex_output_commit(&output, err);
    retex_output_abandon(&output);
    return code;
}
