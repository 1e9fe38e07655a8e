/* Input files. Regular files are read by position as needed; everything else is copied first, into memory or, where it
 * is large, into a temporary file, because an EXR cannot be read from front to back only. A mapping would save a copy,
 * but a file that shrinks while it is mapped crashes the process. */
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "base/params.h"
#include "io/input.h"
#include "io/temporary.h"

enum { COPY_INITIAL = 1 << 20, COPY_IN_MEMORY = 64 << 20 }; /* bytes of a pipe that are kept in memory */

/* Larger copies of pipes and larger files to load are refused. */
static const uint64_t SIZE_LIMIT = (uint64_t)16 << 30;

struct RetexInput {
    char name[512];
    int descriptor;      /* -1 once the whole input is in memory */
    int borrowed;        /* 1: standard input, which must not be closed */
    unsigned char *data; /* NULL while the file is read by position */
    int data_borrowed;   /* 1: data belongs to the caller */
    uint64_t size;
    const RetexInput *whole; /* of which it is a window, from this byte on; or NULL */
    uint64_t begin;
    atomic_int failed; /* errno of a read that failed */
};

static int fail_read(const RetexInput *input, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot read %s: %s", input->name, strerror(code));
}

/* Reads at least one byte of a pipe; *got is 0 at its end. */
static int read_some(const RetexInput *input, unsigned char *to, size_t capacity, size_t *got, RetexError *err)
{
    ssize_t count;

    do
        count = read(input->descriptor, to, capacity);
    while (count < 0 && errno == EINTR);
    *got = count > 0 ? (size_t)count : 0;
    return count < 0 ? fail_read(input, errno, err) : 0;
}

/* 1 if the first bytes are those of a known format: OpenEXR, JPEG, ZIP, a checkpoint. Of anything else no more is read:
 * it may have no end. */
static int has_known_format(const RetexInput *input)
{
    static const struct {
        const char *bytes;
        size_t count;
    } beginnings[] = {{"\x76\x2f\x31\x01", 4}, {"\xff\xd8\xff", 3}, {"PK", 2}, {"retex\n", 6}};

    for (size_t i = 0; i < sizeof beginnings / sizeof *beginnings; i++) {
        const size_t count = input->size < beginnings[i].count ? (size_t)input->size : beginnings[i].count;
        if (memcmp(input->data, beginnings[i].bytes, count) == 0)
            return 1;
    }
    return 0;
}

/* Reads a pipe into memory up to the limit; *ended: 1 if that is all of it. */
static int set_in_memory(RetexInput *input, int *ended, RetexError *err)
{
    size_t capacity = 0, got;

    for (*ended = 0; input->size < COPY_IN_MEMORY; input->size += got) {
        if (input->size && !has_known_format(input)) {
            *ended = 1;
            return 0;
        }
        if (input->size == capacity) {
            capacity = capacity ? capacity * 2 : COPY_INITIAL;
            unsigned char *data = realloc(input->data, capacity);
            if (!data)
                return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", input->name);
            input->data = data;
        }
        const int code = read_some(input, input->data + input->size, capacity - input->size, &got, err);
        if (code || got == 0) {
            *ended = 1;
            return code;
        }
    }
    return 0;
}

/* Appends to the temporary file. */
static int append_to_file(RetexInput *input, int file, RetexTemporaryName shown, size_t bytes, RetexError *err)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t written = pwrite(file, input->data + done, bytes - done, (off_t)(input->size + done));
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return retex_fail(err, RETEX_EIO, "cannot write %s: %s", shown, strerror(written < 0 ? errno : EIO));
        done += (size_t)written;
    }
    input->size += bytes;
    return 0;
}

/* Writes the bytes in memory, and all that follow in the pipe, to the temporary file. */
static int set_in_file(RetexInput *input, int file, RetexTemporaryName shown, RetexError *err)
{
    size_t got = (size_t)input->size;
    int code;

    input->size = 0;
    do {
        code = append_to_file(input, file, shown, got, err);
        if (!code)
            code = read_some(input, input->data, COPY_INITIAL, &got, err);
        if (!code && input->size + got > SIZE_LIMIT)
            code = retex_fail(err, RETEX_ELIMIT, "%s gives more than %d GiB", input->name, (int)(SIZE_LIMIT >> 30));
    } while (!code && got);
    free(input->data);
    input->data = NULL;
    return code;
}

static int store(RetexInput *input, RetexError *err)
{
    RetexTemporaryName shown;
    int ended, code = set_in_memory(input, &ended, err);

    if (code || ended)
        return code;
    const int file = retex_temporary_open(NULL, shown);
    if (file < 0)
        return retex_fail(err, RETEX_EIO, "cannot write %s: %s", shown, strerror(errno));
    code = set_in_file(input, file, shown, err);
    if (!input->borrowed)
        close(input->descriptor);
    input->descriptor = file;
    input->borrowed = 0;
    return code;
}

static int open_descriptor(RetexInput *input, const char *path, const RetexAccess *given, RetexError *err)
{
    RetexAccess access = RETEX_ACCESS_INIT;
    struct stat info;

    if (strcmp(path, "-") == 0) {
        input->descriptor = STDIN_FILENO;
        input->borrowed = 1;
    } else {
        int code = RETEX_PARAMS_COPY(&access, given, err);
        if (!code)
            code = retex_access_open(&access, path, &input->descriptor, err);
        if (!code && access.opened)
            code = access.opened(access.context, input->descriptor, err);
        if (code)
            return code;
    }
    if (fstat(input->descriptor, &info) != 0)
        return fail_read(input, errno, err);
    if (S_ISDIR(info.st_mode))
        return fail_read(input, EISDIR, err);
    /* devices may give bytes without end or make the reader wait; /dev/null is an empty file */
    if (S_ISBLK(info.st_mode) ||
        (S_ISCHR(info.st_mode) && info.st_rdev != makedev(1, 3) && !isatty(input->descriptor)))
        return retex_fail(err, RETEX_EIO, "cannot read %s: it is a device", input->name);
    /* standard input may be a file whose beginning somebody has read: then only the rest is the input */
    if (S_ISREG(info.st_mode) && lseek(input->descriptor, 0, SEEK_CUR) == 0) {
        input->size = (uint64_t)info.st_size;
        return 0;
    }
    return store(input, err);
}

int retex_input_open(RetexInput **result, const char *path, RetexError *err)
{
    return retex_input_open_allowed(result, path, NULL, err);
}

int retex_input_open_allowed(RetexInput **result, const char *path, const RetexAccess *access, RetexError *err)
{
    RetexInput *input = calloc(1, sizeof *input);

    *result = NULL;
    if (!input)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", path);
    input->descriptor = -1;
    snprintf(input->name, sizeof input->name, "%s", strcmp(path, "-") == 0 ? "standard input" : path);
    const int code = open_descriptor(input, path, access, err);
    if (code)
        retex_input_close(&input);
    *result = input;
    return code;
}

int retex_input_open_descriptor(RetexInput **result, int descriptor, const char *name, RetexError *err)
{
    struct stat info;
    RetexInput *input = *result = calloc(1, sizeof *input);

    if (!input)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    input->descriptor = descriptor;
    input->borrowed = 1;
    snprintf(input->name, sizeof input->name, "%s", name);
    if (fstat(descriptor, &info) == 0) {
        input->size = (uint64_t)info.st_size;
        return 0;
    }
    const int code = fail_read(input, errno, err);
    retex_input_close(result);
    return code;
}

int retex_input_borrow(RetexInput **result, const void *data, size_t bytes, const char *name, RetexError *err)
{
    static unsigned char nothing;
    RetexInput *input = *result = calloc(1, sizeof *input);

    if (!input)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    input->descriptor = -1;
    input->data = data ? (unsigned char *)data : &nothing; /* never written to */
    input->data_borrowed = 1;
    input->size = bytes;
    snprintf(input->name, sizeof input->name, "%s", name);
    return 0;
}

int retex_input_window(RetexInput **result, const RetexInput *whole, uint64_t offset, uint64_t bytes, const char *name,
                       RetexError *err)
{
    RetexInput *input = *result = calloc(1, sizeof *input);

    if (!input)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    input->descriptor = -1;
    input->whole = whole;
    input->begin = offset;
    input->size = offset > whole->size ? 0 : bytes < whole->size - offset ? bytes : whole->size - offset;
    snprintf(input->name, sizeof input->name, "%s", name);
    return 0;
}

void retex_input_close(RetexInput **result)
{
    RetexInput *input = result ? *result : NULL;

    if (!input)
        return;
    if (input->descriptor >= 0 && !input->borrowed)
        close(input->descriptor);
    if (!input->data_borrowed)
        free(input->data);
    free(input);
    *result = NULL;
}

const char *retex_input_name(const RetexInput *input)
{
    return input->name;
}

uint64_t retex_input_size(const RetexInput *input)
{
    return input->size;
}

int retex_input_descriptor(const RetexInput *input)
{
    return input->descriptor;
}

int64_t retex_input_read(const RetexInput *input, void *buffer, size_t bytes, uint64_t offset)
{
    if (offset >= input->size)
        return 0;
    if (bytes > input->size - offset)
        bytes = (size_t)(input->size - offset);
    if (input->data) {
        memcpy(buffer, input->data + offset, bytes);
        return (int64_t)bytes;
    }
    if (input->whole)
        return retex_input_read(input->whole, buffer, bytes, input->begin + offset);
    size_t done = 0;
    while (done < bytes) {
        const ssize_t got =
            pread(input->descriptor, (unsigned char *)buffer + done, bytes - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            atomic_store(&((RetexInput *)input)->failed, errno); /* the failure is not part of the content, so the
                                                                    input stays const for callers */
            return -1;
        }
        if (got == 0)
            break; /* the file has shrunk since it was opened */
        done += (size_t)got;
    }
    return (int64_t)done;
}

int retex_input_check(const RetexInput *input, int code, RetexError *err)
{
    while (input && input->whole)
        input = input->whole;
    const int failed = input ? atomic_load(&input->failed) : 0;

    return failed && (code == RETEX_OK || code == RETEX_EFORMAT) ? fail_read(input, failed, err) : code;
}

int retex_input_load(RetexInput *input, const void **data, size_t *bytes, RetexError *err)
{
    if (!input->data) {
        unsigned char *whole = input->size <= SIZE_LIMIT ? malloc(input->size ? (size_t)input->size : 1) : NULL;
        if (!whole)
            return retex_fail(err, RETEX_ENOMEM, "%s is too large to be kept in memory", input->name);
        const int64_t got = retex_input_read(input, whole, (size_t)input->size, 0);
        if (got < 0) {
            const int code = errno;
            free(whole);
            return fail_read(input, code, err);
        }
        input->size = (uint64_t)got;
        input->data = whole;
    }
    *data = input->data;
    *bytes = (size_t)input->size;
    return 0;
}
