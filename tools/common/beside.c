/* See beside.h. */
#include "common/beside.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

void beside_folder(char folder[PATH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    folder[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(folder, '/');
    if (slash)
        *slash = '\0';
}

int beside_program(char path[PATH_MAX], const char *name)
{
    char folder[PATH_MAX];
    beside_folder(folder);
    return snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX && access(path, X_OK) == 0;
}
