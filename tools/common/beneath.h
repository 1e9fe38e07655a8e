/* Folders that somebody else may have filled, such as one of an archive: what lies below is reached from the open
 * folder, and no link is followed on the way, whatever names say. Names are relative, without parts `..`.
 *
 * Calls return -1 and set errno, as those of the system do. ELOOP or ENOTDIR: a link, or a file, stands where a folder
 * should; EXDEV: the name leads out. */
#ifndef RETEX_BENEATH_H
#define RETEX_BENEATH_H

#include <limits.h>
#include <sys/types.h>

/* Open the folder itself. Links above it are the user's; its last part must not be one. may_make: it is made where it
 * is not there. */
int beneath_open_top(const char *path, int may_make);
/* Open a file or folder below; "" is the folder itself. flags and mode as of open(2). */
int beneath_open(int top, const char *name, int flags, mode_t mode);
/* Open the folder that a file is in, for openat(2), renameat(2) and so on with `*last`, its name there, which is a
 * part of `name`. may_make: missing folders are made. */
int beneath_open_parent(int top, const char *name, int may_make, const char **last);
/* Look for a link among all that is below: 1, and its name; 0: there is none. */
int beneath_find_link(int top, char found[PATH_MAX]);

#endif
