/* See temporary.h. */
#include "io/temporary.h"
#include "io/pending_files.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Creates the file without a name where the file system can do that, else with a name that is removed at once. */
static int open_in(const char *folder, RetexTemporaryName shown)
{
    char name[PATH_MAX + 16];

    snprintf(shown, sizeof(RetexTemporaryName), "a temporary file in %s", folder);
#ifdef O_TMPFILE
    const int unnamed = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (unnamed >= 0)
        return unnamed;
#endif
    snprintf(name, sizeof name, "%s/.retex-XXXXXX", folder);
    retex_pending_files_lock();
    const int descriptor = mkostemp(name, O_CLOEXEC);
    if (descriptor >= 0)
        unlink(name);
    retex_pending_files_unlock();
    return descriptor;
}

/* The folder of the file at path `near`; "" where that will not be a regular file but standard output, a device or a
 * pipe. */
static void folder_of(const char *near, char folder[PATH_MAX])
{
    struct stat info;
    char path[PATH_MAX];

    folder[0] = 0;
    if (!near || strcmp(near, "-") == 0 || strlen(near) >= PATH_MAX ||
        (stat(near, &info) == 0 && !S_ISREG(info.st_mode)) || strncmp(near, "/dev/", 5) == 0 ||
        strncmp(near, "/proc/", 6) == 0)
        return;
    snprintf(path, sizeof path, "%s", near);
    if (stat(near, &info) == 0 && !realpath(near, path)) /* the target of a symbolic link may be in another folder */
        return;
    char *slash = strrchr(path, '/');
    if (slash)
        slash[slash == path] = 0;
    snprintf(folder, PATH_MAX, "%s", slash ? path : ".");
}

int retex_temporary_open(const char *near, RetexTemporaryName shown)
{
    char folder[PATH_MAX];
    const char *temporary = getenv("TMPDIR");
    int descriptor = -1;

    folder_of(near, folder);
    if (folder[0])
        descriptor = open_in(folder, shown);
    if (descriptor < 0 && temporary && temporary[0])
        descriptor = open_in(temporary, shown);
    return descriptor < 0 ? open_in("/tmp", shown) : descriptor;
}
