/* See output_folder.h. */
#include "common/output_folder.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int fail_system(const char *path, int code, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(code));
}

/* Remove the last component of a path and the slashes before it, and return it. An empty rest becomes ".". */
static const char *cut_component(char path[PATH_MAX], char component[PATH_MAX])
{
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/')
        path[--end] = '\0';
    char *slash = strrchr(path, '/');
    strcpy(component, slash ? slash + 1 : path);
    if (!slash)
        strcpy(path, ".");
    else
        slash[slash == path] = '\0';
    return component;
}

/* Put a component in front of rest. */
static int prepend(char rest[PATH_MAX], const char *component)
{
    size_t length = strlen(component), used = strlen(rest);
    if (length + used + 2 > PATH_MAX)
        return 0;
    memmove(rest + length + 1, rest, used + 1);
    rest[0] = '/';
    memcpy(rest + 1, component, length);
    return 1;
}

/* Replace folder by its deepest existing part, resolved. The missing components are put in front of rest. */
static int resolve_folder(char folder[PATH_MAX], char rest[PATH_MAX], int *missing, const char *shown, RetexError *err)
{
    char real[PATH_MAX], component[PATH_MAX];
    struct stat info;
    while (!realpath(folder, real)) {
        if (errno != ENOENT)
            return fail_system(shown, errno, err);
        if (lstat(folder, &info) == 0)
            return retex_fail(err, RETEX_EIO, "cannot write %s: %s is a link that leads nowhere", shown, folder);
        cut_component(folder, component);
        if (strcmp(component, "..") == 0)
            return retex_fail(err, RETEX_EIO, "cannot write %s: '..' in a folder that is not there", shown);
        if (strcmp(component, ".") == 0)
            continue;
        ++*missing;
        if (!prepend(rest, component))
            return fail_system(shown, ENAMETOOLONG, err);
    }
    if (stat(real, &info) != 0)
        return fail_system(shown, errno, err);
    if (!S_ISDIR(info.st_mode))
        return fail_system(shown, ENOTDIR, err);
    strcpy(folder, real);
    return RETEX_OK;
}

int output_resolve(char real[PATH_MAX], int *missing, const char *path, const char *shown, RetexError *err)
{
    char folder[PATH_MAX], name[PATH_MAX], rest[PATH_MAX] = "";
    const size_t length = strlen(path);
    *missing = 0;
    if (length == 0 || length + 1 >= PATH_MAX)
        return fail_system(shown, length ? ENAMETOOLONG : ENOENT, err);
    if (realpath(path, real))
        return RETEX_OK;
    if (errno != ENOENT)
        return fail_system(shown, errno, err);
    strcpy(folder, path);
    cut_component(folder, name);
    if (path[length - 1] == '/' || strcmp(name, ".") == 0 || strcmp(name, "..") == 0)
        return fail_system(shown, EISDIR, err);
    strcpy(rest, "/");
    strcat(rest, name); /* fits: shorter than path */
    int code = resolve_folder(folder, rest, missing, shown, err);
    if (code)
        return code;
    const char *base = strcmp(folder, "/") == 0 ? "" : folder;
    if (strlen(base) + strlen(rest) >= PATH_MAX)
        return fail_system(shown, ENAMETOOLONG, err);
    strcpy(real, base);
    strcat(real, rest);
    return RETEX_OK;
}

int output_is_below(const char *real, const char *folder)
{
    const size_t length = strlen(folder);
    return strcmp(folder, "/") == 0 ||
           (strncmp(real, folder, length) == 0 && (real[length] == '/' || real[length] == '\0'));
}

int output_make_folders(const char *path, RetexError *err)
{
    char folder[PATH_MAX];
    struct stat info;
    for (const char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
        const size_t length = (size_t)(slash - path);
        if (length >= PATH_MAX)
            return fail_system(path, ENAMETOOLONG, err);
        memcpy(folder, path, length);
        folder[length] = '\0';
        if (length && stat(folder, &info) != 0 && mkdir(folder, 0777) != 0 && errno != EEXIST)
            return retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
    }
    return RETEX_OK;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info, (void)kind, (void)where;
    remove(path);
    return 0;
}

void output_remove_folder(const char *path)
{
    nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS | FTW_MOUNT);
}
