/* See beside.h. */
#include "common/beside.h"

#include <string.h>
#include <unistd.h>

int beside_program(char path[PATH_MAX], const char *name)
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    path[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(path, '/');
    if (!slash || strlen(name) >= PATH_MAX - (size_t)(slash + 1 - path))
        return 0;
    strcpy(slash + 1, name);
    return access(path, X_OK) == 0;
}
