/* See machine.h. Control groups of version 2 have one tree, those of version 1 one for each resource. */
#include "base/machine.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/budget.h>

/* Reads the beginning of a file as text; "" where there is no file. */
static void read_text(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    const size_t got = file ? fread(text, 1, size - 1, file) : 0;

    text[got] = 0;
    if (file)
        fclose(file);
}

static uint64_t limit_of(const char *folder, const char *file)
{
    char path[PATH_MAX + 64], text[64], *end;

    snprintf(path, sizeof path, "%s/%s", folder, file);
    read_text(path, text, sizeof text);
    const unsigned long long bytes = strtoull(text, &end, 10); /* "max" means no limit */
    return end == text || bytes == 0 ? UINT64_MAX : bytes;
}

/* The lowest limit of a control group and all groups above it, up to the mount point. In a container the path may be
 * that of the host, of which only the root is visible. */
static uint64_t lowest_limit(const char *mount, const char *cgroup, const char *file)
{
    char folder[PATH_MAX];
    uint64_t least = limit_of(mount, file);

    if (snprintf(folder, sizeof folder, "%s%s", mount, cgroup) >= (int)sizeof folder)
        return least;
    for (size_t top = strlen(mount); strlen(folder) > top;) {
        const uint64_t limit = limit_of(folder, file);
        least = limit < least ? limit : least;
        *strrchr(folder, '/') = 0;
    }
    return least;
}

uint64_t retex_machine_cgroup_memory(const char *cgroups, const char *root)
{
    char line[PATH_MAX], mount[PATH_MAX];
    uint64_t least = UINT64_MAX;

    for (const char *at = cgroups, *end; *at; at = *end ? end + 1 : end) {
        end = at + strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)(end - at), at);
        char *kinds = strchr(line, ':'), *cgroup = kinds ? strchr(kinds + 1, ':') : NULL;
        if (!cgroup || cgroup[1] != '/' || strstr(cgroup, "/../"))
            continue;
        *cgroup++ = 0;
        const int unified = kinds[1] == 0;
        if (!unified && strcmp(kinds + 1, "memory") != 0)
            continue;
        snprintf(mount, sizeof mount, "%.*s%s", PATH_MAX - 16, root, unified ? "" : "/memory");
        const uint64_t limit = lowest_limit(mount, cgroup, unified ? "memory.max" : "memory.limit_in_bytes");
        least = limit < least ? limit : least;
    }
    return least;
}

uint64_t retex_machine_memory(void)
{
    char cgroups[4096];
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const uint64_t machine = pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : 0;

    read_text("/proc/self/cgroup", cgroups, sizeof cgroups);
    const uint64_t cgroup = retex_machine_cgroup_memory(cgroups, "/sys/fs/cgroup");
    return cgroup < machine ? cgroup : machine;
}
