/* See added.h. */
#include "page/added.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int added_note(Added *added, const char *path)
{
    if (access(path, F_OK) == 0 || added->count == ADDED_MOST)
        return 1;
    char *copy = strdup(path);
    if (copy)
        added->paths[added->count++] = copy;
    return !!copy;
}

void added_end(Added *added, int keep)
{
    while (added->count) {
        char *path = added->paths[--added->count];
        if (!keep)
            remove(path);
        free(path);
    }
}
