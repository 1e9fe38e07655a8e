/* See names.h. */
#include "serve/files/names.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "serve/request/name.h"

typedef struct Names {
    char **names;
    size_t count, capacity;
} Names;

static int is_wanted(const char *name, const char *const *endings)
{
    const char *dot = strrchr(name, '.');
    if (!serve_name_is_valid(name) || (!dot && endings))
        return 0;
    if (!endings)
        return 1;
    for (; *endings; endings++)
        if (strcasecmp(dot + 1, *endings) == 0)
            return 1;
    return 0;
}

static int add(Names *names, const char *name, int with_ending)
{
    if (names->count == names->capacity) {
        const size_t capacity = names->capacity ? 2 * names->capacity : 64;
        char **more = realloc(names->names, capacity * sizeof *more);
        if (!more)
            return -1;
        names->names = more;
        names->capacity = capacity;
    }
    const size_t length = with_ending ? strlen(name) : (size_t)(strrchr(name, '.') - name);
    char *copy = strndup(name, length);
    if (copy)
        names->names[names->count++] = copy;
    return copy ? 0 : -1;
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

int names_check_folder(const char *folder, RetexError *err)
{
    struct stat info;
    if (stat(folder, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", folder, strerror(errno));
    return S_ISDIR(info.st_mode) ? RETEX_OK : retex_fail(err, RETEX_EIO, "%s is no folder", folder);
}

int names_list(const char *folder, const char *const *endings, int with_ending,
               void (*tell)(void *context, const char *name), void *context)
{
    Names names = {NULL, 0, 0};
    DIR *directory = opendir(folder);
    int failed = directory ? 0 : -1;
    for (struct dirent *entry; !failed && (entry = readdir(directory));) {
        struct stat info;
        if (is_wanted(entry->d_name, endings) && fstatat(dirfd(directory), entry->d_name, &info, 0) == 0 &&
            (endings ? S_ISREG(info.st_mode) : S_ISDIR(info.st_mode)))
            failed = add(&names, entry->d_name, with_ending);
    }
    if (directory)
        closedir(directory);
    if (names.count)
        qsort(names.names, names.count, sizeof *names.names, compare);
    for (size_t i = 0; !failed && i < names.count; i++)
        if (i == 0 || strcmp(names.names[i], names.names[i - 1]) != 0)
            tell(context, names.names[i]);
    for (size_t i = 0; i < names.count; i++)
        free(names.names[i]);
    free(names.names);
    return failed;
}
