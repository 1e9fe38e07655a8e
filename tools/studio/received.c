/* See received.h. */
#include "received.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "common/json_text.h"
#include "common/output_folder.h"

enum { MOST_PARTS = 8, MOST_OF_PART = 120, MOST_NUMBERS = 1000, COMPARED = 1 << 14 };

/* ---- names ---- */

static int clean_part(const char *part, size_t length, char *clean, size_t size)
{
    char text[MOST_OF_PART + 1];
    length = length < MOST_OF_PART ? length : MOST_OF_PART;
    memcpy(text, part, length);
    text[length] = 0;
    utf8_trim(text);
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127 || strchr("<>:\"|?*", *c))
            *c = '_';
    if (*text == '.' || *text == '-') /* hidden, or an option of a tool */
        *text = '_';
    return snprintf(clean, size, "%s", text) < (int)size;
}

int received_clean_name(const char *name, char *clean, size_t size)
{
    size_t used = 0;
    int parts = 0;
    *clean = 0;
    for (const char *part = name; *part; part += strspn(part, "/\\")) {
        const size_t length = strcspn(part, "/\\");
        const int leads = (length == 1 && part[0] == '.') || (length == 2 && part[0] == '.' && part[1] == '.');
        if (length && !leads && parts++ < MOST_PARTS) {
            if (used && used + 2 < size)
                clean[used++] = '/', clean[used] = 0;
            if (!clean_part(part, length, clean + used, size - used))
                return 0;
            used += strlen(clean + used);
        }
        part += length;
    }
    return used > 0 && parts <= MOST_PARTS && clean[used - 1] != '/';
}

/* ---- receiving ---- */

static int fail_full(RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "the disk is full: the file was not kept");
}

static int fail_system(const Received *received, RetexError *err)
{
    if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)
        return fail_full(err);
    return retex_fail(err, RETEX_EIO, "cannot write below %s: %s", received->folder, strerror(errno));
}

/* The folder and the name of the file; the folder is made. */
static int place(Received *received, const char *folder, const char *name, RetexError *err)
{
    char clean[1024], path[PATH_MAX];
    if (!received_clean_name(name, clean, sizeof clean))
        return retex_fail(err, RETEX_EINVAL, "this is no name of a file");
    if (snprintf(path, sizeof path, "%s/%s", folder, clean) >= (int)sizeof path - 64)
        return retex_fail(err, RETEX_EINVAL, "the name of the file is too long");
    const int code = output_make_folders(path, err);
    if (code)
        return code;
    char *slash = strrchr(path, '/');
    *slash = 0;
    /* a folder below may be a link that somebody else has put there */
    char real[PATH_MAX], top[PATH_MAX];
    if (!realpath(path, real) || !realpath(folder, top) || !output_is_below(real, top))
        return retex_fail(err, RETEX_EACCESS, "the folder of the file lies outside of %s", folder);
    strcpy(received->folder, real);
    snprintf(received->name, sizeof received->name, "%s", slash + 1);
    return RETEX_OK;
}

int received_begin(Received *received, const char *folder, const char *name, uint64_t length, RetexError *err)
{
    struct statvfs disk;
    *received = (Received){0};
    if (length > RECEIVED_MOST)
        return retex_fail(err, RETEX_ELIMIT, "the file is larger than 16 GB");
    int code = place(received, folder, name, err);
    if (code)
        return code;
    if (statvfs(received->folder, &disk) == 0 && length > (uint64_t)disk.f_bavail * disk.f_frsize)
        return fail_full(err);
    static atomic_uint number;
    if (snprintf(received->temporary, PATH_MAX, "%s/.incoming-%d-%u", received->folder, (int)getpid(), number++) >=
        PATH_MAX)
        return retex_fail(err, RETEX_EINVAL, "the name of the file is too long");
    const int file = open(received->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        return fail_system(received, err);
    received->file = file + 1;
    return RETEX_OK;
}

int received_bytes(Received *received, const void *data, size_t bytes, RetexError *err)
{
    received->bytes += bytes;
    if (received->bytes > RECEIVED_MOST)
        return retex_fail(err, RETEX_ELIMIT, "the file is larger than 16 GB");
    for (const char *at = data; bytes;) {
        const ssize_t written = write(received->file - 1, at, bytes);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return fail_system(received, err);
        at += written;
        bytes -= (size_t)written;
    }
    return RETEX_OK;
}

void received_drop(Received *received)
{
    if (!received->file)
        return;
    close(received->file - 1);
    unlink(received->temporary);
    received->file = 0;
}

/* ---- the end ---- */

static int is_same(const char *a, const char *b)
{
    char bytes[2][COMPARED];
    struct stat info[2];
    FILE *in[2] = {fopen(a, "re"), fopen(b, "re")};
    int same = in[0] && in[1] && fstat(fileno(in[0]), &info[0]) == 0 && fstat(fileno(in[1]), &info[1]) == 0 &&
               S_ISREG(info[1].st_mode) && info[0].st_size == info[1].st_size;
    for (size_t count = 1; same && count;) {
        count = fread(bytes[0], 1, COMPARED, in[0]);
        same = fread(bytes[1], 1, COMPARED, in[1]) == count && memcmp(bytes[0], bytes[1], count) == 0;
    }
    for (int i = 0; i < 2; i++)
        if (in[i])
            fclose(in[i]);
    return same;
}

/* Rename without replacing: -1 and EEXIST. */
static int rename_new(const char *from, const char *to)
{
    if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && errno != ENOSYS) /* file systems that cannot */
        return -1;
    if (access(to, F_OK) == 0) {
        errno = EEXIST;
        return -1;
    }
    return rename(from, to);
}

int received_end(Received *received, char path[PATH_MAX], RetexError *err)
{
    const char *dot = strrchr(received->name, '.');
    const int stem = (int)(dot && dot > received->name ? dot - received->name : (long)strlen(received->name));
    const int failed = close(received->file - 1) != 0;
    received->file = 0;
    for (int number = 1; !failed && number < MOST_NUMBERS; number++) {
        char mark[16] = "";
        if (number > 1)
            snprintf(mark, sizeof mark, "-%d", number);
        if (snprintf(path, PATH_MAX, "%s/%.*s%s%s", received->folder, stem, received->name, mark,
                     received->name + stem) >= PATH_MAX)
            break;
        if (rename_new(received->temporary, path) == 0)
            return RETEX_OK;
        if (errno != EEXIST)
            break;
        if (is_same(received->temporary, path)) {
            unlink(received->temporary);
            return RETEX_OK;
        }
    }
    const int code = fail_system(received, err);
    unlink(received->temporary);
    return code;
}
