/* Input files: regular ones are read by position as needed, everything else is spooled into memory first, because an
 * EXR cannot be read from front to back only. A mapping would save a copy but turns a file that shrinks under us into a
 * crash. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input.h"

/* Spools and packs beyond this are refused rather than swapped. */
static const uint64_t MEMORY_LIMIT = (uint64_t)16 << 30;

struct RetexInput {
    char name[512];
    int descriptor;      /* -1 once all is in memory */
    int borrowed;        /* 1: standard input, which is not ours to close */
    unsigned char *data; /* NULL while the file is read by position */
    int data_borrowed;   /* 1: data is not ours to free */
    uint64_t size;
};

static int fail_read(const RetexInput *input, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot read %s: %s", input->name, strerror(code));
}

static int grow(RetexInput *input, size_t *room, RetexError *err)
{
    const size_t larger = *room ? *room * 2 : (size_t)1 << 20;
    unsigned char *data = larger <= MEMORY_LIMIT ? realloc(input->data, larger) : NULL;

    if (!data)
        return retex_fail(err, RETEX_ENOMEM, "%s is too large to be kept in memory", input->name);
    input->data = data;
    *room = larger;
    return 0;
}

static int spool(RetexInput *input, RetexError *err)
{
    size_t room = 0;

    for (;;) {
        if (input->size == room) {
            const int status = grow(input, &room, err);
            if (status)
                return status;
        }
        const ssize_t got = read(input->descriptor, input->data + input->size, room - input->size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return fail_read(input, errno, err);
        if (got == 0)
            return 0;
        input->size += (size_t)got;
    }
}

static int open_descriptor(RetexInput *input, const char *path, RetexError *err)
{
    struct stat status;

    if (strcmp(path, "-") == 0) {
        input->descriptor = STDIN_FILENO;
        input->borrowed = 1;
    } else {
        input->descriptor = open(path, O_RDONLY | O_CLOEXEC);
    }
    if (input->descriptor < 0 || fstat(input->descriptor, &status) != 0)
        return fail_read(input, errno, err);
    if (S_ISDIR(status.st_mode))
        return fail_read(input, EISDIR, err);
    /* standard input may be a file that someone has read the beginning of: then only the rest is meant */
    if (S_ISREG(status.st_mode) && lseek(input->descriptor, 0, SEEK_CUR) == 0) {
        input->size = (uint64_t)status.st_size;
        return 0;
    }
    return spool(input, err);
}

int retex_input_open(RetexInput **result, const char *path, RetexError *err)
{
    RetexInput *input = calloc(1, sizeof *input);

    *result = NULL;
    if (!input)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", path);
    input->descriptor = -1;
    snprintf(input->name, sizeof input->name, "%s", strcmp(path, "-") == 0 ? "standard input" : path);
    const int status = open_descriptor(input, path, err);
    if (status)
        retex_input_close(&input);
    *result = input;
    return status;
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
    size_t done = 0;
    while (done < bytes) {
        const ssize_t got =
            pread(input->descriptor, (unsigned char *)buffer + done, bytes - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return -1;
        if (got == 0)
            break; /* the file has shrunk since */
        done += (size_t)got;
    }
    return (int64_t)done;
}

int retex_input_load(RetexInput *input, const void **data, size_t *bytes, RetexError *err)
{
    if (!input->data) {
        unsigned char *whole = input->size <= MEMORY_LIMIT ? malloc(input->size ? (size_t)input->size : 1) : NULL;
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
