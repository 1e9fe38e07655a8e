/* See beside.h. */
#include "picture/beside.h"

#include <dlfcn.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* In a folder below the one of `file`, or of one above it. */
static int find_near(RetexBesidePath path, const char *name, const char *file, int levels, const char *below)
{
    char folder[PATH_MAX];
    if (snprintf(folder, sizeof folder, "%s", file) >= (int)sizeof folder)
        return 0;
    for (; levels > 0; levels--) {
        char *slash = strrchr(folder, '/');
        if (!slash)
            return 0;
        *slash = '\0';
        if (snprintf(path, sizeof(RetexBesidePath), "%s/%s%s", folder, below, name) < (int)sizeof(RetexBesidePath) &&
            access(path, R_OK) == 0)
            return 1;
    }
    return 0;
}

/* Beside the shared library that this code is in: libretex.so.2, whatever program uses it, or a plugin, which is in
 * PREFIX/lib/retex/plugins, or in build/plugins. Its symbolic links are followed only where that finds nothing. */
static int find_near_library(RetexBesidePath path, const char *name)
{
    static const char here;
    Dl_info info;
    struct link_map *map = NULL;
    if (!dladdr1(&here, &info, (void **)&map, RTLD_DL_LINKMAP) || !map || !map->l_name[0])
        return 0; /* it is in the program itself */
    if (find_near(path, name, map->l_name, 3, "") || find_near(path, name, map->l_name, 2, "lib/"))
        return 1;
    char *resolved = realpath(map->l_name, NULL);
    const int found = resolved && find_near(path, name, resolved, 3, "");
    free(resolved);
    return found;
}

/* Beside the program that contains the library: PREFIX/bin/retex-x -> PREFIX/lib, and the same for a program run from
 * build/. A program deeper in the tree (a unit test) is served by the folders above. */
static int find_near_program(RetexBesidePath path, const char *name)
{
    char program[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0)
        return 0;
    program[length] = '\0';
    return find_near(path, name, program, 3, "lib/");
}

int retex_beside_find(RetexBesidePath path, const char *name)
{
    if (find_near_library(path, name) || find_near_program(path, name))
        return 1;
#ifdef RETEX_BRIDGE_FOLDER
    snprintf(path, sizeof(RetexBesidePath), "%s/%s", RETEX_BRIDGE_FOLDER, name);
    return access(path, R_OK) == 0;
#else
    return 0;
#endif
}
