/* Access: which files may be read where the name comes from somebody else, such as a scene or a request.
 *
 * A file is in a folder if its path is, after links and `..` are resolved. Safe access, for scenes and names from
 * strangers, is narrower: regular files only; of pictures only PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP and
 * Radiance HDR, recognised by their content (TGA has no signature: by its name and a plausible header, or by its
 * footer), each read by its own decoder only, in a process of its own that is limited and confined; and the file that
 * is read is the one that was checked, even if its name is changed meanwhile. */
#ifndef RETEX_ACCESS_H
#define RETEX_ACCESS_H

#include <stddef.h>
#include <retex/error.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Called with a file that was opened, before anything of it is decoded. It neither closes the descriptor nor moves its
 * position. What it returns, 0 or an error, is that of the call that reads. */
typedef int RetexOpened(void *context, int descriptor, RetexError *err);

/* Begin with RETEX_ACCESS_INIT, which allows every file, as NULL does. */
typedef struct RetexAccess {
    size_t size;              /* of this struct */
    int safe;                 /* 1: safe access, as above; 2: the same, where this process is confined and may crash: it
                                 decodes pictures itself; default 0 */
    const char *const *roots; /* folders as realpath(3) gives them, outside of which nothing is read; default NULL =
                                 anywhere, for names that the user said */
    int nroots;
    int accept_damaged; /* 1: pictures that are damaged are read as far as they can be, and their readers are warned;
                           default 0: they are refused */
    RetexOpened *opened; /* told which files are opened; default NULL = nobody */
    void *context; /* handed to it; default NULL */
} RetexAccess;
#define RETEX_ACCESS_INIT { sizeof(RetexAccess), 0, NULL, 0, 0, NULL, NULL }

typedef enum RetexAccessResult {
    RETEX_ACCESS_ALLOWED,
    RETEX_ACCESS_ABSENT,   /* there is no such file */
    RETEX_ACCESS_OUTSIDE,  /* it lies outside the folders; of a safe access this tells nothing of what is there */
    RETEX_ACCESS_IRREGULAR /* a folder, a device or a pipe */
} RetexAccessResult;

/* 1 if the environment asks for safe access: RETEX_SAFE is set, and neither empty nor 0. */
int retex_access_safe_requested(void);
/* The same of damaged pictures: RETEX_ACCEPT_DAMAGED. */
int retex_access_damage_accepted(void);

/* Check whether a file may be read. `name` is relative to `folder` (one of the roots, in any spelling; "" = the current
 * folder) unless it begins with /. Safe access refuses names that leave the folders even if they come back, so that
 * they reveal nothing about other folders. */
RetexAccessResult retex_access_check(const RetexAccess *access, const char *folder, const char *name);

/* Open a file for reading; the caller closes *descriptor. RETEX_EACCESS where it may not be read. */
int retex_access_open(const RetexAccess *access, const char *path, int *descriptor, RetexError *err);
/* The same of a folder, to list what is in it. A file that is found there is opened by the call above, by its path. */
int retex_access_open_folder(const RetexAccess *access, const char *path, int *descriptor, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
