/* See <retex/access.h>. A path is resolved first, and the resolved path is checked as text. Then the file is opened
 * folder by folder from the root without following links: if somebody replaces a folder by a link in between, opening
 * fails and no other file is read. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/access.h>
#include "base/params.h"

static int is_requested(const char *variable)
{
    const char *said = getenv(variable);

    return said && said[0] && strcmp(said, "0") != 0;
}

int retex_access_safe_requested(void)
{
    return is_requested("RETEX_SAFE");
}

int retex_access_damage_accepted(void)
{
    return is_requested("RETEX_ACCEPT_DAMAGED");
}

static int lies_inside(const RetexAccess *access, const char *resolved)
{
    if (!access->roots)
        return 1;
    for (int i = 0; i < access->nroots; i++) {
        const size_t length = strlen(access->roots[i]);
        const int slash = length && access->roots[i][length - 1] == '/'; /* the root of the file system */
        if (strncmp(resolved, access->roots[i], length) == 0 &&
            (slash || resolved[length] == '/' || resolved[length] == '\0'))
            return 1;
    }
    return 0;
}

/* Checks every folder of the path, for safe access: once the path is inside a root it must stay there; the answer does
 * not reveal which files exist outside. done: the length of the beginning of path that is one of the roots. */
static RetexAccessResult check_folders(const RetexAccess *access, const char *path, size_t done)
{
    char begin[PATH_MAX], resolved[PATH_MAX];
    struct stat info;
    int inside = done > 0;

    if (strlen(path) >= sizeof begin)
        return RETEX_ACCESS_ABSENT;
    while (path[done += strspn(path + done, "/")]) {
        const size_t length = strcspn(path + done, "/");
        if (!inside && length == 2 && memcmp(path + done, "..", 2) == 0)
            return RETEX_ACCESS_OUTSIDE;
        done += length;
        memcpy(begin, path, done);
        begin[done] = '\0';
        if (!realpath(begin, resolved))
            return !inside || (lstat(begin, &info) == 0 && S_ISLNK(info.st_mode)) ? RETEX_ACCESS_OUTSIDE
                                                                                  : RETEX_ACCESS_ABSENT;
        const int now = lies_inside(access, resolved);
        if (inside && !now)
            return RETEX_ACCESS_OUTSIDE;
        inside = now;
    }
    return inside ? RETEX_ACCESS_ALLOWED : RETEX_ACCESS_OUTSIDE;
}

RetexAccessResult retex_access_check(const RetexAccess *given, const char *folder, const char *name)
{
    RetexAccess access = RETEX_ACCESS_INIT;
    char path[PATH_MAX], resolved[PATH_MAX];
    const size_t before = name[0] == '/' ? 0 : strlen(folder);
    const int slash = before && folder[before - 1] != '/';
    struct stat info;

    if (RETEX_PARAMS_COPY(&access, given, NULL))
        return RETEX_ACCESS_OUTSIDE;
    if (before + (size_t)slash + strlen(name) + 2 > sizeof path)
        return RETEX_ACCESS_ABSENT;
    memcpy(path, folder, before);
    memcpy(path + before, "/", (size_t)slash);
    strcpy(path + before + slash, name);
    if (access.safe && access.roots) {
        char from_here[PATH_MAX + 2] = "./"; /* so that at least one byte is the folder's */
        const int here = !before && name[0] != '/';
        strcat(from_here, path);
        const RetexAccessResult answer =
            check_folders(&access, here ? from_here : path, here ? 2 : before + (size_t)slash);
        if (answer != RETEX_ACCESS_ALLOWED)
            return answer;
    }
    if (!realpath(path, resolved) || stat(resolved, &info) != 0)
        return RETEX_ACCESS_ABSENT;
    if (!lies_inside(&access, resolved))
        return RETEX_ACCESS_OUTSIDE;
    return S_ISREG(info.st_mode) ? RETEX_ACCESS_ALLOWED : RETEX_ACCESS_IRREGULAR;
}

/* Opens a resolved path; -1 with errno set, as open(2). flags: of what the path names. */
static int open_resolved(const char *resolved, int flags)
{
    char name[NAME_MAX + 1];
    int folder = open("/", O_PATH | O_DIRECTORY | O_CLOEXEC);

    for (const char *at = resolved + 1; folder >= 0;) {
        const size_t length = strcspn(at, "/");
        const int is_last = !at[length];
        if (length > NAME_MAX) {
            close(folder);
            errno = ENAMETOOLONG;
            return -1;
        }
        memcpy(name, at, length);
        name[length] = '\0';
        const int next =
            openat(folder, length ? name : ".", O_NOFOLLOW | O_CLOEXEC | (is_last ? flags : O_PATH | O_DIRECTORY));
        const int why = errno;
        close(folder);
        errno = why;
        if (is_last)
            return next;
        folder = next;
        at += length + 1;
    }
    return -1;
}

static int fail_open(const char *path, int why, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot read %s: %s", path, strerror(why));
}

static int refuse(const char *path, RetexError *err)
{
    return retex_fail(err, RETEX_EACCESS, "%s is a folder, a device or a pipe: only files are read (--safe)", path);
}

static int resolve_safely(const RetexAccess *access, const char *path, char resolved[PATH_MAX], struct stat *info,
                          RetexError *err)
{
    if (!realpath(path, resolved) || stat(resolved, info) != 0)
        return fail_open(path, errno, err);
    if (!lies_inside(access, resolved))
        return retex_fail(err, RETEX_EACCESS, "%s is outside the folders that may be read (--safe)", path);
    return RETEX_OK;
}

static int open_safely(const RetexAccess *access, const char *path, RetexError *err)
{
    char resolved[PATH_MAX];
    struct stat info;
    const int code = resolve_safely(access, path, resolved, &info, err);

    if (code)
        return code;
    if (!S_ISREG(info.st_mode)) /* opening a device may already have an effect */
        return refuse(path, err);
    /* do not wait for the writer of a pipe, and do not acquire a controlling terminal, before the file's type is
     * known */
    const int file = open_resolved(resolved, O_RDONLY | O_NONBLOCK | O_NOCTTY);
    if (file < 0 || fstat(file, &info) != 0) {
        const int why = errno;
        if (file >= 0)
            close(file);
        return fail_open(path, why, err);
    }
    if (S_ISREG(info.st_mode))
        return file;
    close(file);
    return refuse(path, err);
}

int retex_access_open(const RetexAccess *given, const char *path, int *descriptor, RetexError *err)
{
    RetexAccess access = RETEX_ACCESS_INIT;

    if (RETEX_PARAMS_COPY(&access, given, err))
        return *descriptor = RETEX_EINVAL;
    if (access.safe) {
        *descriptor = open_safely(&access, path, err);
        return *descriptor < 0 ? *descriptor : RETEX_OK;
    }
    *descriptor = open(path, O_RDONLY | O_CLOEXEC);
    return *descriptor < 0 ? fail_open(path, errno, err) : RETEX_OK;
}

int retex_access_open_folder(const RetexAccess *given, const char *path, int *descriptor, RetexError *err)
{
    RetexAccess access = RETEX_ACCESS_INIT;
    char resolved[PATH_MAX];
    struct stat info;
    int code = RETEX_PARAMS_COPY(&access, given, err);

    *descriptor = -1;
    if (!code && access.safe)
        code = resolve_safely(&access, path, resolved, &info, err);
    if (code)
        return code;
    *descriptor =
        access.safe ? open_resolved(resolved, O_RDONLY | O_DIRECTORY) : open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    return *descriptor < 0 ? fail_open(path, errno, err) : RETEX_OK;
}
