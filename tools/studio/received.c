/* See received.h. */
#include "received.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "common/beneath.h"
#include "common/json_text.h"

#define INCOMING ".incoming-" /* of files that are not complete */

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

static void close_folders(Received *received)
{
    close(received->top);
    if (received->parent >= 0)
        close(received->parent);
}

/* The folder and the name of the file; the folder is made. */
static int place(Received *received, const char *folder, const char *name, RetexError *err)
{
    char clean[1024];
    const char *last;
    if (!received_clean_name(name, clean, sizeof clean))
        return retex_fail(err, RETEX_EINVAL, "this is no name of a file");
    if (strlen(folder) + strlen(clean) + 64 > PATH_MAX)
        return retex_fail(err, RETEX_EINVAL, "the name of the file is too long");
    received->parent = beneath_open_parent(received->top, clean, 1, &last);
    if (received->parent < 0 && (errno == ELOOP || errno == ENOTDIR))
        return retex_fail(err, RETEX_EACCESS, "the folder of the file is a link, or no folder");
    const int below = (int)(last - clean);
    snprintf(received->folder, PATH_MAX, "%s%s%.*s", folder, below ? "/" : "", below ? below - 1 : 0, clean);
    snprintf(received->name, sizeof received->name, "%s", last);
    return received->parent < 0 ? fail_system(received, err) : RETEX_OK;
}

/* Whoever has a lock on it is still writing. */
static int open_temporary(Received *received)
{
    static atomic_uint number;
    snprintf(received->temporary, sizeof received->temporary, INCOMING "%d-%u", (int)getpid(), number++);
    const int file =
        openat(received->top, received->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0)
        (void)flock(file, LOCK_EX | LOCK_NB);
    return file;
}

static int begin(Received *received, const char *folder, const char *name, uint64_t length, RetexError *err)
{
    struct statvfs disk;
    if (length > RECEIVED_MOST)
        return retex_fail(err, RETEX_ELIMIT, "the file is larger than 16 GB");
    const int code = place(received, folder, name, err);
    if (code)
        return code;
    if (fstatvfs(received->top, &disk) == 0 && length > (uint64_t)disk.f_bavail * disk.f_frsize)
        return fail_full(err);
    const int file = open_temporary(received);
    if (file < 0)
        return fail_system(received, err);
    received->file = file + 1;
    return RETEX_OK;
}

int received_begin(Received *received, int top, const char *folder, const char *name, uint64_t length, RetexError *err)
{
    *received = (Received){.top = top, .parent = -1};
    const int code = begin(received, folder, name, length, err);
    if (code)
        close_folders(received);
    return code;
}

void received_tidy(int top)
{
    const int folder = openat(top, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = folder >= 0 ? fdopendir(folder) : NULL;
    for (struct dirent *entry; list && (entry = readdir(list));) {
        if (strncmp(entry->d_name, INCOMING, strlen(INCOMING)) != 0)
            continue;
        const int file = openat(top, entry->d_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0)
            unlinkat(top, entry->d_name, 0);
        if (file >= 0)
            close(file);
    }
    if (list)
        closedir(list);
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

/* The file has ended, one way or the other. */
static void forget(Received *received)
{
    unlinkat(received->top, received->temporary, 0); /* nothing, where it has got its name */
    close_folders(received);
    received->file = 0;
}

void received_drop(Received *received)
{
    if (!received->file)
        return;
    close(received->file - 1);
    forget(received);
}

/* ---- the end ---- */

static FILE *open_again(int folder, const char *name)
{
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    return file >= 0 ? fdopen(file, "r") : NULL;
}

/* Whether a file of the folder has the same content. */
static int is_same(const Received *received, const char *name)
{
    char bytes[2][COMPARED];
    struct stat info[2];
    FILE *in[2] = {open_again(received->top, received->temporary), open_again(received->parent, name)};
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
static int rename_new(const Received *received, const char *name)
{
    if (renameat2(received->top, received->temporary, received->parent, name, RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && errno != ENOSYS) /* file systems that cannot */
        return -1;
    if (faccessat(received->parent, name, F_OK, AT_SYMLINK_NOFOLLOW) == 0) {
        errno = EEXIST;
        return -1;
    }
    return renameat(received->top, received->temporary, received->parent, name);
}

/* Give it the first name that is free, or that the same content has. 0: it has none, and errno is set. */
static int take_name(const Received *received, char path[PATH_MAX])
{
    const char *dot = strrchr(received->name, '.');
    const int stem = (int)(dot && dot > received->name ? dot - received->name : (long)strlen(received->name));
    for (int number = 1; number < MOST_NUMBERS; number++) {
        char mark[16] = "", name[NAME_MAX + 20];
        if (number > 1)
            snprintf(mark, sizeof mark, "-%d", number);
        snprintf(name, sizeof name, "%.*s%s%s", stem, received->name, mark, received->name + stem);
        if (snprintf(path, PATH_MAX, "%s/%s", received->folder, name) >= PATH_MAX) {
            errno = ENAMETOOLONG;
            return 0;
        }
        if (rename_new(received, name) == 0)
            return 1;
        if (errno != EEXIST)
            return 0;
        if (is_same(received, name))
            return 1;
    }
    return 0;
}

int received_end(Received *received, char path[PATH_MAX], RetexError *err)
{
    const int is_kept = close(received->file - 1) == 0 && take_name(received, path);
    const int code = is_kept ? RETEX_OK : fail_system(received, err);
    forget(received);
    return code;
}
