/* Names and limits of the pack format, shared by its writer and its reader; retex-pack(5) describes the format. */
#ifndef LIBRETEX_PACK_FORMAT_H
#define LIBRETEX_PACK_FORMAT_H

#include <retex/error.h>

#define PACK_VERSION 1
#define PACK_MANIFEST "manifest.json"
#define PACK_FOLDER "parts/"      /* then the part's name and one of: */
#define PACK_DATA ".data"
#define PACK_MASK ".mask"
#define PACK_MANIFEST_MAX (64u << 20) /* bytes */
enum { PACK_FILE_MAX = 192 };         /* bytes of a name, with the final NUL */

/* retex_pack_read and retex_pack_check see bytes only: put the file's name into the error of a failed call; returns
 * code. */
int retex_pack_name_error(int code, const char *name, RetexError *err);

#endif
