/* The list of a tool's input and output files, which finds an output that is also an input or another output: see
 * cli.h. */
#include "common/cli.h"

#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/retex.h>

/* The identity of a file. A missing file is identified by the deepest existing folder of its path and the rest. */
typedef struct Place {
    dev_t device;
    ino_t inode;
    char name[PATH_MAX]; /* path below that folder; "" for an existing file */
} Place;

typedef struct File {
    dev_t device;
    ino_t inode;
    char *name, *path, *what;
    int written;
} File;

static struct {
    File *buckets; /* a hash table with open addressing; a bucket with path NULL is free */
    size_t count, size;
    char *standard[2]; /* the uses of standard input and output, NULL = unused */
} files;

enum { LINKS_MAX = 40 };

/* Replace a dangling link by its target, repeatedly. */
static void follow_links(char path[PATH_MAX])
{
    char target[PATH_MAX], joined[2 * PATH_MAX];
    for (int links = 0; links < LINKS_MAX; links++) {
        ssize_t length = readlink(path, target, sizeof target - 1);
        if (length <= 0)
            return;
        target[length] = '\0';
        const char *slash = target[0] == '/' ? NULL : strrchr(path, '/');
        int used = snprintf(joined, sizeof joined, "%.*s%s", slash ? (int)(slash + 1 - path) : 0, path, target);
        if (used >= PATH_MAX)
            return;
        memcpy(path, joined, (size_t)used + 1);
    }
}

/* Append the components of text to name, without empty ones and `.`. */
static void append_components(char name[PATH_MAX], const char *text)
{
    for (size_t used = strlen(name), length; *text; text += length) {
        text += strspn(text, "/");
        length = strcspn(text, "/");
        if (!length || (length == 1 && *text == '.') || used + length + 2 > PATH_MAX)
            continue;
        name[used++] = '/';
        memcpy(name + used, text, length);
        name[used += length] = '\0';
    }
}

/* Find the deepest existing folder of a path, and the missing rest. */
static int find_missing(Place *place, const char *text)
{
    char path[PATH_MAX];
    struct stat info;
    strcpy(path, text);
    follow_links(path);
    for (size_t end = strlen(path);;) {
        while (end > 0 && path[end - 1] == '/')
            end--;
        while (end > 0 && path[end - 1] != '/')
            end--;
        char folder[PATH_MAX];
        snprintf(folder, sizeof folder, "%.*s", (int)end, path);
        if (stat(end ? folder : ".", &info) == 0) {
            append_components(place->name, path + end);
            place->device = info.st_dev;
            place->inode = info.st_ino;
            return place->name[0] != '\0';
        }
        if (!end)
            return 0;
    }
}

/* Whether path is standard input or output under any of its names. */
static int is_standard(const char *path, int written)
{
    static const char *const names[2][3] = {{"/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"},
                                            {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}};
    for (int k = 0; k < 3; k++)
        if (strcmp(path, names[written][k]) == 0)
            return 1;
    return strcmp(path, "-") == 0;
}

/* Return 0 if nothing can be overwritten: path is a device, a pipe, a folder, or cannot be opened. */
static int find_place(Place *place, const char *path, int written)
{
    struct stat info;
    place->name[0] = '\0';
    int standard = is_standard(path, written);
    if (!path[0] || strlen(path) >= PATH_MAX)
        return 0;
    if (standard ? fstat(written ? STDOUT_FILENO : STDIN_FILENO, &info) : stat(path, &info))
        return !standard && find_missing(place, path);
    place->device = info.st_dev;
    place->inode = info.st_ino;
    return S_ISREG(info.st_mode);
}

static uint64_t hash_place(const Place *place)
{
    uint64_t hash = (uint64_t)place->inode * 0x9e3779b97f4a7c15u ^ (uint64_t)place->device;
    for (const char *c = place->name; *c; c++)
        hash = (hash ^ (unsigned char)*c) * 0x100000001b3u;
    return hash ^ hash >> 32;
}

/* The bucket of that place, or the free bucket for it. */
static File *find_bucket(const Place *place)
{
    for (size_t k = hash_place(place) & (files.size - 1);; k = (k + 1) & (files.size - 1)) {
        File *file = &files.buckets[k];
        if (!file->path ||
            (file->inode == place->inode && file->device == place->device && strcmp(file->name, place->name) == 0))
            return file;
    }
}

static int grow(void)
{
    if (2 * (files.count + 1) <= files.size)
        return 1;
    File *old = files.buckets, *more = calloc(files.size ? 2 * files.size : 64, sizeof *more);
    size_t count = files.size;
    if (!more)
        return 0;
    files.buckets = more;
    files.size = count ? 2 * count : 64;
    for (size_t k = 0; k < count; k++)
        if (old[k].path) {
            Place place = {old[k].device, old[k].inode, ""};
            strcpy(place.name, old[k].name);
            *find_bucket(&place) = old[k];
        }
    free(old);
    return 1;
}

static int out_of_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory for the list of files");
}

/* Standard input and output can be used only once each, whatever they are connected to. */
static int add_standard(const char *what, int written, RetexError *err)
{
    char **user = &files.standard[written];
    if (*user)
        return retex_fail(err, RETEX_EINVAL, "%s and %s cannot both be standard %s", *user, what,
                          written ? "output" : "input");
    *user = strdup(what);
    return *user ? RETEX_OK : out_of_memory(err);
}

static const char *shown(const char *path, int written)
{
    return strcmp(path, "-") ? path : written ? "standard output" : "standard input";
}

static int conflict(const File *old, const char *what, const char *path, int written, RetexError *err)
{
    if (old->written && written)
        return retex_fail(err, RETEX_EINVAL, "%s: %s and %s are the same file", shown(path, 1), old->what, what);
    const char *output = shown(written ? path : old->path, 1), *input = shown(written ? old->path : path, 0);
    int same = strcmp(output, input) == 0;
    return retex_fail(err, RETEX_EINVAL, "%s: %s would replace %s%s%s", output, written ? what : old->what,
                      written ? old->what : what, same ? "" : ", ", same ? "" : input);
}

static int add_file(const char *what, const char *path, int written, RetexError *err)
{
    Place place;
    int code = path && is_standard(path, written) ? add_standard(what, written, err) : RETEX_OK;
    if (code || !path || !find_place(&place, path, written))
        return code;
    if (!grow())
        return out_of_memory(err);
    File *file = find_bucket(&place);
    if (file->path)
        return written || file->written ? conflict(file, what, path, written, err) : RETEX_OK;
    *file = (File){place.device, place.inode, strdup(place.name), strdup(path), strdup(what), written};
    files.count++;
    return file->name && file->path && file->what ? RETEX_OK : out_of_memory(err);
}

int cli_add_input(const char *what, const char *path, RetexError *err)
{
    return add_file(what, path, 0, err);
}

int cli_add_output(const char *what, const char *path, RetexError *err)
{
    int code = add_file("the OpenColorIO configuration", getenv("OCIO"), 0, err); /* an input of every picture */
    return code ? code : add_file(what, path, 1, err);
}

int cli_open_referred(const Cli *cli, RetexSet **samples, const char *path, RetexError *err)
{
    char here[PATH_MAX], beside[PATH_MAX];
    const char *roots[2];
    RetexAccess access = cli->access;
    access.roots = roots;
    if (realpath(".", here))
        roots[access.nroots++] = here;
    if (strcmp(path, "-") != 0 && realpath(path, beside)) {
        char *slash = strrchr(beside, '/');
        slash[slash == beside] = '\0';
        roots[access.nroots++] = beside;
    }
    const int code = retex_set_open_referred(samples, access.safe ? &access : NULL, cli->threads, err);
    return code ? code : cli_add_input("the set", retex_set_reference(*samples), err);
}

void cli_reads(const Cli *cli, const char *what, const char *path)
{
    RetexError err = {0};
    if (cli_add_input(what, path, &err))
        cli_fail(cli, &err);
}

void cli_writes(const Cli *cli, const char *what, const char *path)
{
    RetexError err = {0};
    if (cli_add_output(what, path, &err))
        cli_fail(cli, &err);
}
