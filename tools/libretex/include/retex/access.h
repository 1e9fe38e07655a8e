/* Which files may be read where somebody else says which: a scene, or a name that a stranger asks for.
 *
 * A file lies in a folder when its path does once links and `..` are resolved. Safe access, for scenes and names of
 * strangers, is narrower: regular files only; of pictures only PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF and Radiance
 * HDR, known by their content (TGA has no mark: by its name and a plausible header, or by its footer), each read by its
 * own decoder and no other; and what is read is the very file that was looked at, whatever its name stands for
 * since. */
#ifndef RETEX_ACCESS_H
#define RETEX_ACCESS_H

#include <stddef.h>
#include <retex/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_ACCESS_INIT, which allows everything. NULL in place of one does, too. */
typedef struct RetexAccess {
    size_t size;              /* of this struct */
    int safe;                 /* 1: safe access, as above; default 0 */
    const char *const *roots; /* folders as realpath(3) gives them, outside of which nothing is read; default NULL =
                                 anywhere, for names that the user said */
    int nroots;
} RetexAccess;
#define RETEX_ACCESS_INIT { sizeof(RetexAccess), 0, NULL, 0 }

typedef enum RetexAccessAnswer {
    RETEX_ACCESS_ALLOWED,
    RETEX_ACCESS_ABSENT,   /* there is no such file */
    RETEX_ACCESS_OUTSIDE,  /* it lies outside the folders; of a safe access this tells nothing of what is there */
    RETEX_ACCESS_IRREGULAR /* a folder, a device or a pipe */
} RetexAccessAnswer;

/* 1: $RETEX_SAFE asks for safe access: it is set, and neither empty nor 0. */
int retex_access_safe_wanted(void);

/* Whether the file `name`, taken from `folder` (one of the roots, in any spelling; "" = the current folder) unless it
 * begins with /, may be read. A safe access refuses names that leave the folders on their way, even if they come back:
 * nobody shall find out by them what there is elsewhere. */
RetexAccessAnswer retex_access_ask(const RetexAccess *access, const char *folder, const char *name);

/* Open a file to read; the caller closes *descriptor. RETEX_EACCESS where it may not be read. */
int retex_access_open(const RetexAccess *access, const char *path, int *descriptor, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
