/* See beneath.h. Names are walked part by part, each from the folder before it, which holds on every kernel; openat2(2)
 * would do the same where it is known. */
#include "common/beneath.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FOLDER = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC };

/* Close, and return what was opened, with the errno of that. */
static int instead(int file, int opened)
{
    const int why = errno;
    close(file);
    errno = why;
    return opened;
}

/* flags: of open(2); O_DIRECTORY | O_NOFOLLOW says ENOTDIR of a link, which is told apart here. */
static int open_part(int folder, const char *part, int flags, mode_t mode)
{
    struct stat info;
    const int file = openat(folder, part, flags | O_NOFOLLOW | O_CLOEXEC, mode);
    if (file < 0 && errno == ENOTDIR)
        errno = fstatat(folder, part, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(info.st_mode) ? ELOOP : ENOTDIR;
    return file;
}

int beneath_open_top(const char *path, int may_make)
{
    char plain[PATH_MAX];
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') /* behind which a link would be followed */
        length--;
    if (length == 0 || length >= sizeof plain) {
        errno = length ? ENAMETOOLONG : ENOENT;
        return -1;
    }
    memcpy(plain, path, length);
    plain[length] = 0;
    if (may_make && mkdir(plain, 0777) != 0 && errno != EEXIST)
        return -1;
    return open_part(AT_FDCWD, plain, FOLDER, 0);
}

/* Copy the part that `*at` begins with, and go on behind it. 0: it is none that may be walked, and errno is set. */
static int take_part(const char **at, char part[NAME_MAX + 1])
{
    const size_t length = strcspn(*at, "/");
    if (length > NAME_MAX) {
        errno = ENAMETOOLONG;
        return 0;
    }
    memcpy(part, *at, length);
    part[length] = 0;
    *at += length;
    *at += strspn(*at, "/");
    errno = EXDEV;
    return strcmp(part, "..") != 0;
}

int beneath_open_parent(int top, const char *name, int may_make, const char **last)
{
    char part[NAME_MAX + 1];
    int folder = *name == '/' ? (errno = EXDEV, -1) : openat(top, ".", FOLDER);
    for (const char *at = name; folder >= 0; name = at) {
        if (!take_part(&at, part))
            return instead(folder, -1);
        if (!*at)
            break;
        if (may_make && mkdirat(folder, part, 0777) != 0 && errno != EEXIST)
            return instead(folder, -1);
        folder = instead(folder, open_part(folder, part, FOLDER, 0));
    }
    *last = name;
    return folder;
}

int beneath_open(int top, const char *name, int flags, mode_t mode)
{
    const char *last;
    char part[NAME_MAX + 1];
    const int folder = beneath_open_parent(top, name, 0, &last);
    if (folder < 0)
        return -1;
    /* of `scene/` too: a slash behind a link follows it */
    (void)take_part(&last, part);
    return instead(folder, open_part(folder, *part ? part : ".", flags, mode));
}

/* Takes over the folder. found has `length` bytes already. */
static int find_link(int folder, char found[PATH_MAX], size_t length)
{
    int is_found = 0;
    DIR *list = fdopendir(folder);
    if (!list)
        return instead(folder, -1);
    for (struct dirent *entry; !is_found && (errno = 0, entry = readdir(list));) {
        const char *name = entry->d_name;
        struct stat info;
        if (strcmp(name, ".") == 0 || strcmp(name, "..") == 0)
            continue;
        if (length + strlen(name) + 2 > PATH_MAX) {
            errno = ENAMETOOLONG;
            break;
        }
        sprintf(found + length, "%s%s", length ? "/" : "", name);
        if (fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) != 0)
            continue; /* it has gone meanwhile */
        if (S_ISDIR(info.st_mode)) {
            const int below = open_part(folder, name, FOLDER, 0);
            is_found = below < 0 ? -1 : find_link(below, found, strlen(found));
        } else {
            is_found = S_ISLNK(info.st_mode);
        }
    }
    if (!is_found && errno)
        is_found = -1;
    const int why = errno;
    closedir(list);
    errno = why;
    return is_found;
}

int beneath_find_link(int top, char found[PATH_MAX])
{
    const int folder = openat(top, ".", FOLDER);
    *found = 0;
    return folder < 0 ? -1 : find_link(folder, found, 0);
}
