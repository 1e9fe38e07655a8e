/* Names and limits of the pack format, shared by its writer and its reader; the format is described in retex-pack(5). */
#ifndef LIBRETEX_PACK_FORMAT_H
#define LIBRETEX_PACK_FORMAT_H

#define PACK_VERSION 1
#define PACK_MANIFEST "manifest.json"
#define PACK_FOLDER "parts/"      /* then the part's name and one of: */
#define PACK_DATA ".data"
#define PACK_MASK ".mask"
#define PACK_MANIFEST_MAX (64u << 20) /* bytes */
enum { PACK_FILE_MAX = 192 };         /* bytes of a name, with the final NUL */

#endif
